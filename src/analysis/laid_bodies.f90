!> Temperatures with which bodies that come in an operation begin at nodes that they share with bodies that were there (ASLEEP).
!>
!> A body that is laid down has the temperature of START, a shared node that of what was there. It gets the one at which both have
!> together the heat that they had apart, sum_g m_g (h_g(T) - h_g(T_g)) = 0 with m_g the volume of the node in the elements of g: as
!> two bodies that touch, of one effusivity. So what is laid brings the heat of its whole volume on any mesh. Temperatures on eight
!> nodes have their heat at the points, where heat capacities by temperature are those of no node: all shared nodes are then moved
!> by one share of the difference between their bodies, at which the heat of all is what it was. Points that were there
!> are free of strains at the new temperature, as those that come are: the strain of cooling down is that of the heat too.
module laid_bodies
  use fields, only: find_field, has_corners_only
  use heat_points, only: functions_of, functions_t
  use heat_record, only: heat_record_t
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

  integer, parameter :: most_halvings = 200, most_doublings = 10

contains

  !> Temperatures of shared nodes at the beginning of an operation.
  subroutine share_heat(old, scene, laws, solution)
    type(scene_t), intent(in) :: old       !! of the operation before
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)     !! (nlaw)
    type(solution_t), intent(inout) :: solution
    real(wp) :: volume(size(scene%mesh%coordinates, 2), size(scene%groups))
    real(wp) :: temperature(size(volume, 1), size(volume, 2)), apart(size(volume, 1))
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
    apart = 0
    do k = 1, size(volume, 1)
      comes = any(abs(volume(k, :)) > 0 .and. laid)
      stays = any(abs(volume(k, :)) > 0 .and. .not. laid)
      if (.not. (comes .and. stays)) cycle
      solution%fields(f)%value(1, k) = common_temperature(scene, laws, abs(volume(k, :)), temperature(k, :))
      apart(k) = maxval(temperature(k, :), mask=abs(volume(k, :)) > 0) - minval(temperature(k, :), mask=abs(volume(k, :)) > 0)
    end do
    if (.not. has_corners_only(solution%fields(f))) then
      call keep_whole_heat(scene, laws, has_heat, temperature, apart, solution%fields(f)%value(1, :))
      return
    end if
    do g = 1, size(scene%groups)
      if (.not. has_heat(g)) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (nodes => scene%groups(g)%connectivity(:, e), value => solution%fields(f)%value(1, :))
          value(nodes(5:8)) = 0.5_wp*(value(nodes(1:4)) + value(nodes([2, 3, 4, 1])))
        end associate
      end do
    end do
    if (size(solution%heat%finer) > 0) &
      call note_joints(scene, has_heat, temperature, apart, solution%fields(f)%value(1, :), solution%heat)
  end subroutine share_heat

  !> What the temperatures of the joint draw out over an element, at middles of its sides and at its centre, where a finer mesh has
  !> those of the bodies: errors in space (space_error) that begin there. Contents follow of the temperatures, in the first step.
  pure subroutine note_joints(scene, has_heat, temperature, apart, values, heat)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: has_heat(:)          !! (ngroup)
    real(wp), intent(in) :: temperature(:, :)   !! (nnode, ngroup) their own [temperature]
    real(wp), intent(in) :: apart(:)            !! (nnode) difference at shared nodes, 0 elsewhere [temperature]
    real(wp), intent(in) :: values(:)           !! (nnode) now [temperature]
    type(heat_record_t), intent(inout) :: heat
    integer :: seen_by(size(values))   ! the last group, -1 where there are more
    logical :: noted(size(values))
    real(wp) :: drawn(4)               ! at the corners
    integer :: g, e, k, n

    seen_by = 0
    do g = 1, size(scene%groups)
      if (.not. has_heat(g)) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (nodes => scene%groups(g)%connectivity(:, e))
          where (seen_by(nodes) == 0 .or. seen_by(nodes) == g)
            seen_by(nodes) = g
          else where
            seen_by(nodes) = -1
          end where
        end associate
      end do
    end do
    noted = .false.
    do g = 1, size(scene%groups)
      if (.not. has_heat(g)) cycle
      n = size(values) + sum([(size(scene%groups(k)%connectivity, 2), k=1, host_of(scene, g) - 1)], &
                             mask=[(is_solid(scene%groups(k)), k=1, host_of(scene, g) - 1)])
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (nodes => scene%groups(g)%connectivity(:, e))
          if (.not. any(apart(nodes(:4)) > 0)) cycle
          drawn = values(nodes(:4)) - temperature(nodes(:4), g)
          do k = 1, 4
            if (seen_by(nodes(4 + k)) /= g .or. noted(nodes(4 + k))) cycle
            heat%finer(nodes(4 + k)) = heat%finer(nodes(4 + k)) - 0.5_wp*(drawn(k) + drawn(mod(k, 4) + 1))
            noted(nodes(4 + k)) = .true.
          end do
          heat%finer(n + e) = heat%finer(n + e) - 0.25_wp*sum(drawn)
        end associate
      end do
    end do
    heat%finer_content = 0
  end subroutine note_joints

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

  !> Move the temperatures of shared nodes by one share of their difference, so that all bodies together have the heat that they
  !> have at their own temperatures, by bisection: heat rises with the temperature.
  subroutine keep_whole_heat(scene, laws, has_heat, temperature, apart, values)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical, intent(in) :: has_heat(:)          !! (ngroup)
    real(wp), intent(in) :: temperature(:, :)   !! (nnode, ngroup) their own [temperature]
    real(wp), intent(in) :: apart(:)            !! (nnode) difference at shared nodes, 0 elsewhere [temperature]
    real(wp), intent(inout) :: values(:)        !! (nnode) [temperature]
    real(wp) :: low, high, share, least, most   ! least, most: heat at both ends
    integer :: k

    if (.not. any(apart > 0)) return
    ! functions of eight nodes are negative in places: their temperatures may have to lie beyond those of both bodies
    high = 1
    do k = 1, most_doublings
      least = heat_of(values - high*apart)
      most = heat_of(values + high*apart)
      if (least <= 0 .and. most >= 0) exit
      high = 2*high
    end do
    low = -high
    do k = 1, most_halvings
      share = 0.5_wp*(low + high)
      if (high - low <= eps) exit
      if (heat_of(values + share*apart) > 0) then
        high = share
      else
        low = share
      end if
    end do
    values = values + share*apart

  contains

    !> Taken up by all bodies from their own temperatures to these, shared nodes alone having others.
    function heat_of(shared) result(heat)
      real(wp), intent(in) :: shared(:)   !! (nnode) [temperature]
      real(wp) :: heat
      real(wp) :: own(8), now(8)
      type(quad8_rule_t) :: rule
      real(wp) :: x(2, 8), nx(8), ny(8), detj
      integer :: g, e, p

      heat = 0
      do g = 1, size(has_heat)
        if (.not. has_heat(g)) cycle
        call quad8_rule(scene%groups(g)%rule%n, rule)
        do e = 1, size(scene%groups(g)%connectivity, 2)
          associate (nodes => scene%groups(g)%connectivity(:, e))
            if (.not. any(apart(nodes) > 0)) cycle
            own = temperature(nodes, g)
            now = merge(shared(nodes), own, apart(nodes) > 0)
            x = scene%mesh%coordinates(:, nodes)
          end associate
          do p = 1, rule%npoint
            call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
            heat = heat + detj*rule%weight(p)*thickness_at(scene%section, matmul(x, rule%phi(:, p))) &
                   *taken_up(scene, laws, g, dot_product(rule%phi(:, p), own), dot_product(rule%phi(:, p), now))
          end do
        end do
      end do
    end function heat_of

  end subroutine keep_whole_heat

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
        if (volume(g) > 0) heat = heat + volume(g)*taken_up(scene, laws, g, temperature(g), common)
      end do
      if (heat > 0) then
        high = common
      else
        low = common
      end if
    end do
  end function common_temperature

  !> Heat that a volume of a group takes up between two temperatures.
  function taken_up(scene, laws, g, from, to) result(taken)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g            !! number of the group
    real(wp), intent(in) :: from, to    !! [temperature]
    real(wp) :: taken                   !! [energy/length^3]
    real(wp), allocatable :: before(:, :), now(:, :)
    real(wp) :: each(1), capacity(1)

    associate (material => scene%materials(scene%groups(g)%material))
      allocate (before(driver_count(laws(material%law_id)), 1), now(driver_count(laws(material%law_id)), 1), source=0.0_wp)
      before(driver_temperature, 1) = from
      now(driver_temperature, 1) = to
      call laws(material%law_id)%store(material, before, now, each, capacity)
    end associate
    taken = each(1)
  end function taken_up

end module laid_bodies
