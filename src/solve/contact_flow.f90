!> The flow stress of the body behind each point of a contact side: what friction by the constant-factor law m is bounded by.
!>
!> It is that of the accepted state, the mean over the two integration points of the element nearest to the side, and holds for
!> the step that follows.
module contact_flow
  use fields, only: find_field
  use kinds, only: wp
  use kinematics_api, only: first_history
  use law_api, only: find_parameter, law_t
  use loads, only: multiplier_at
  use quadrature, only: square_rule
  use scene, only: group_t, is_solid, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: bodies_t, find_bodies, update_flow_stress

  !> For every side of a group, the body behind it.
  type :: bodies_t
    !> Group, element, and side 1 to 4 of the element (nside); not allocated for groups that do not need the flow stress.
    integer, allocatable :: group(:), element(:), side(:)
  end type bodies_t

contains

  !> Bodies behind the sides of all contacts whose friction factor M is given.
  subroutine find_bodies(scene, laws, bodies)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(bodies_t), allocatable, intent(out) :: bodies(:)
    integer :: owner(3, size(scene%mesh%coordinates, 2))
    integer :: g, e, k

    allocate (bodies(size(scene%groups)))
    owner = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 4
          owner(:, scene%groups(g)%connectivity(4 + k, e)) = [g, e, k]
        end do
      end do
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (find_variable(group%variables, 'flow_stress') == 0) cycle
        associate (material => scene%materials(group%material))
          k = find_parameter(laws(material%law_id), 'M')
          if (.not. material%values(k) < huge(1.0_wp)) cycle
        end associate
        bodies(g)%group = owner(1, group%connectivity(2, :))
        bodies(g)%element = owner(2, group%connectivity(2, :))
        bodies(g)%side = owner(3, group%connectivity(2, :))
      end associate
    end do
  end subroutine find_bodies

  !> Write the flow stress of the committed state of the bodies into that of the contacts.
  subroutine update_flow_stress(scene, laws, bodies, solution)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(bodies_t), intent(in) :: bodies(:)
    type(solution_t), intent(inout) :: solution
    real(wp) :: flow, temperature
    integer :: g, s, at, near(2), p

    do g = 1, size(bodies)
      if (.not. allocated(bodies(g)%group)) cycle
      at = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, 'flow_stress'))%first
      do s = 1, size(bodies(g)%group)
        associate (body => scene%groups(bodies(g)%group(s)))
          associate (material => scene%materials(body%material))
            flow = 0
            if (associated(laws(material%law_id)%flow_stress)) then
              near = nearest_points(body%npoint, bodies(g)%side(s))
              temperature = temperature_of(scene, solution, body, bodies(g)%element(s))
              do p = 1, 2
                flow = flow + 0.5_wp*laws(material%law_id)%flow_stress(material, temperature, &
                                     solution%groups(bodies(g)%group(s))%committed(first_history:, near(p), bodies(g)%element(s)))
              end do
            end if
          end associate
        end associate
        solution%groups(g)%committed(at, :, s) = flow
        solution%groups(g)%trial(at, :, s) = flow
      end do
    end do
  end subroutine update_flow_stress

  !> What a TEMPE card gives, or the mean of the field over the corners of the element.
  pure function temperature_of(scene, solution, body, element) result(temperature)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(group_t), intent(in) :: body
    integer, intent(in) :: element
    real(wp) :: temperature   !! [temperature]
    integer :: f

    temperature = 0
    f = find_field(solution%fields, 'temperature')
    if (f > 0) temperature = 0.25_wp*sum(solution%fields(f)%value(1, body%connectivity(1:4, element)))
    if (body%temperature_multiplier == 0) return
    temperature = body%temperature_amplitude*multiplier_at(scene%multipliers(body%temperature_multiplier), solution%time)
  end function temperature_of

  !> The two integration points of the square nearest to a side (1: eta = -1, 2: xi = 1, 3: eta = 1, 4: xi = -1), apart from the
  !> middle one of a row of three.
  pure function nearest_points(npoint, side) result(near)
    integer, intent(in) :: npoint, side
    integer :: near(2)
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: depth(npoint), along(npoint)

    call square_rule(npoint, xi, weight)
    depth = merge(-1, 1, side == 1 .or. side == 4)*xi(merge(2, 1, mod(side, 2) == 1), :)
    along = xi(merge(1, 2, mod(side, 2) == 1), :)
    near = [maxloc(depth + 0.1_wp*along, 1), maxloc(depth - 0.1_wp*along, 1)]
  end function nearest_points

end module contact_flow
