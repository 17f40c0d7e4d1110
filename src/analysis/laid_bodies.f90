!> Temperatures with which bodies that come in an operation begin at nodes that they share with bodies that were there (ASLEEP).
!>
!> A body that is laid down has the temperature of START, a shared node that of what was there. It gets the one at which both have
!> together the heat that they had apart, sum_g m_g (h_g(T) - h_g(T_g)) = 0 with m_g the volume of the node in the elements of g: as
!> two bodies that touch, of one effusivity. So what is laid brings the heat of its whole volume on any mesh. Points that were there
!> are free of strains at the new temperature, as those that come are: the strain of cooling down is that of the heat too.
module laid_bodies
  use elem_pl8tm, only: functions_of, functions_t
  use fields, only: find_field, has_corners_only
  use kinds, only: eps, wp
  use law_api, only: driver_count, driver_temperature, heat_law, law_t
  use point_temperatures, only: temperature_field
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: host_of, is_solid, scene_t
  use sections, only: thickness_at
  use solution, only: solution_t
  implicit none
  private
  public :: share_heat

  integer, parameter :: most_halvings = 200

contains

  !> Temperatures of shared nodes at the beginning of an operation.
  subroutine share_heat(old, scene, laws, solution)
    type(scene_t), intent(in) :: old       !! of the operation before
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)     !! (nlaw)
    type(solution_t), intent(inout) :: solution
    real(wp) :: volume(size(scene%mesh%coordinates, 2), size(scene%groups))
    real(wp) :: temperature(size(volume, 1), size(volume, 2))
    logical :: has_heat(size(scene%groups)), laid(size(scene%groups)), comes, stays
    integer :: f, g, e, k

    f = find_field(solution%fields, temperature_field)
    if (f == 0) return
    if (.not. solution%fields(f)%declared) return
    do g = 1, size(scene%groups)
      laid(g) = .not. any([(is_solid(old%groups(k)) .and. old%groups(k)%name == scene%groups(host_of(scene, g))%name, &
                            k=1, size(old%groups))])
      has_heat(g) = scene%groups(g)%material > 0
      if (has_heat(g)) has_heat(g) = laws(scene%materials(scene%groups(g)%material)%law_id)%kind == heat_law
    end do
    if (.not. (any(has_heat .and. laid) .and. any(has_heat .and. .not. laid))) return
    volume = 0
    do g = 1, size(scene%groups)
      if (.not. has_heat(g)) cycle
      temperature(:, g) = solution%fields(f)%value(1, :)
      if (laid(g)) temperature(:, g) = laid_at(scene, f, scene%groups(host_of(scene, g))%name)
      call add_volumes(scene, g, has_corners_only(solution%fields(f)), volume(:, g))
    end do
    do k = 1, size(volume, 1)
      comes = any(abs(volume(k, :)) > 0 .and. laid)
      stays = any(abs(volume(k, :)) > 0 .and. .not. laid)
      if (comes .and. stays) solution%fields(f)%value(1, k) = common_temperature(scene, laws, abs(volume(k, :)), temperature(k, :))
    end do
    if (.not. has_corners_only(solution%fields(f))) return
    do g = 1, size(scene%groups)
      if (.not. has_heat(g)) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (nodes => scene%groups(g)%connectivity(:, e), value => solution%fields(f)%value(1, :))
          value(nodes(5:8)) = 0.5_wp*(value(nodes(1:4)) + value(nodes([2, 3, 4, 1])))
        end associate
      end do
    end do
  end subroutine share_heat

  !> What START gives to a body (nnode); 0 where there is none.
  pure function laid_at(scene, field, body) result(values)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: field   !! place in the scene's list
    character(len=*), intent(in) :: body
    real(wp) :: values(size(scene%mesh%coordinates, 2))   !! [temperature]
    integer :: k

    values = 0
    if (.not. allocated(scene%starts)) return
    do k = 1, size(scene%starts)
      associate (start => scene%starts(k))
        if (start%field == field .and. (len(start%body) == 0 .or. start%body == body)) values = start%values
      end associate
    end do
  end function laid_at

  !> Volumes of the nodes in the elements of a group: integrals of their functions.
  subroutine add_volumes(scene, g, at_corners, volume)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    logical, intent(in) :: at_corners
    real(wp), intent(inout) :: volume(:)   !! (nnode) [volume]
    type(quad8_rule_t) :: rule
    type(functions_t) :: own
    real(wp) :: x(2, 8), nx(8), ny(8), detj, dv
    integer :: e, p

    call quad8_rule(scene%groups(g)%rule%n, rule)
    call functions_of(at_corners, rule, own)
    do e = 1, size(scene%groups(g)%connectivity, 2)
      associate (nodes => scene%groups(g)%connectivity(:, e))
        x = scene%mesh%coordinates(:, nodes)
        do p = 1, rule%npoint
          call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
          dv = detj*rule%weight(p)*thickness_at(scene%section, matmul(x, rule%phi(:, p)))
          volume(nodes(:own%n)) = volume(nodes(:own%n)) + own%phi(:own%n, p)*dv
        end do
      end associate
    end do
  end subroutine add_volumes

  !> The temperature at which groups have together the heat that they have at their own, by bisection.
  function common_temperature(scene, laws, volume, temperature) result(common)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    real(wp), intent(in) :: volume(:)        !! (ngroup) of the node [volume]
    real(wp), intent(in) :: temperature(:)   !! (ngroup), used where there is a volume [temperature]
    real(wp) :: common
    real(wp) :: low, high, heat
    integer :: k, g

    low = minval(temperature, mask=volume > 0)
    high = maxval(temperature, mask=volume > 0)
    do k = 1, most_halvings
      common = 0.5_wp*(low + high)
      if (high - low <= eps*max(abs(low), abs(high))) return
      heat = 0
      do g = 1, size(volume)
        if (volume(g) > 0) heat = heat + volume(g)*taken_up(temperature(g))
      end do
      if (heat > 0) then
        high = common
      else
        low = common
      end if
    end do

  contains

    !> By a volume of the group between its own temperature and this one.
    function taken_up(own) result(taken)
      real(wp), intent(in) :: own
      real(wp) :: taken

      associate (material => scene%materials(scene%groups(g)%material))
        block
          real(wp) :: before(driver_count(laws(material%law_id)), 1), now(driver_count(laws(material%law_id)), 1)
          real(wp) :: each(1), capacity(1)

          before = 0
          now = 0
          before(driver_temperature, 1) = own
          now(driver_temperature, 1) = common
          call laws(material%law_id)%store(material, before, now, each, capacity)
          taken = each(1)
        end block
      end associate
    end function taken_up

  end function common_temperature

end module laid_bodies
