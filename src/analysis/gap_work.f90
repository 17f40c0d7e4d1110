!> Work that the trapezoidal rule sees across gaps that open in a step, where there is none.
!>
!> By that rule a force f(n) that is gone at the end does f(n).du/2 on the whole motion of the step. Where a side leaves what it
!> lay on, the motion du of the die goes on without it: on the motion of the die against the side contact took
!> -f(n).(du_die - du_side)/2 by the rule, and in truth what its penalties gave back (contact_work). The difference belongs to
!> neither the part nor its contact. Without it the work of a die that lifts off grows with the length of the step.
!>
!> f is the force that acted: of a point beyond a corner of its die what is left of its pressure there (corner_release), that may be
!> a thousandth of it.
module gap_work
  use axis_contact, only: area_at_corner
  use closest_point, only: closest_point_t
  use contact_areas, only: area_of_point
  use contact_point, only: penalties
  use contact_state, only: at_between, at_piece, at_pressure, at_status, at_tau, at_xi, contact_block
  use contact_work, only: kept_work
  use control_point_contact, only: control_shares
  use corner_release, only: release_t, slide_beyond, slide_past_corner
  use corner_weights, only: corner_length
  use dies, only: is_deformable
  use edge_states, only: interval_at_start
  use element_loop, only: group_geometry
  use equations, only: equations_t
  use fields, only: displacement_field, pilot_field, section_field
  use kinds, only: wp
  use law_api, only: contact_open
  use parabolas, only: tangent_on
  use plane_vectors, only: turned
  use quadrature, only: is_control_point, line_rule
  use scene, only: group_t, role_contact, scene_t
  use shape_functions, only: line3
  use side_points, only: side_length
  use solution, only: solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: work_across_gaps

contains

  !> To be added to the work from outside: of rigid dies, and of supports where the die is of sides; before the state is committed,
  !> after fields have moved.
  subroutine work_across_gaps(scene, equations, solution, of_dies, of_supports)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(out) :: of_dies, of_supports   !! per radian when axisymmetric [energy]
    real(wp) :: work
    integer :: g

    of_dies = 0
    of_supports = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_contact .or. scene%groups(g)%material == 0) cycle
      if (.not. any(opens(solution%groups(g)%committed(at_status, :, :), solution%groups(g)%trial(at_status, :, :)))) cycle
      call work_of_group(scene, equations, solution, g, work)
      if (is_deformable(scene%dies(scene%groups(g)%die))) then
        of_supports = of_supports + work
      else
        of_dies = of_dies + work
      end if
    end do
  end subroutine work_across_gaps

  !> In contact at the start of the step, and no longer at its end.
  elemental function opens(before, after) result(yes)
    real(wp), intent(in) :: before, after   !! status
    logical :: yes

    yes = nint(before) /= contact_open .and. nint(after) == contact_open
  end function opens

  subroutine work_of_group(scene, equations, solution, g, work)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g           !! place of the group
    real(wp), intent(out) :: work      !! per radian when axisymmetric [energy]
    real(wp), allocatable :: xi(:), weight(:), x(:, :, :)
    real(wp) :: du(2, 3), area
    integer :: e, p, n
    logical :: corners

    work = 0
    associate (group => scene%groups(g), u => solution%fields(displacement_field), before => solution%groups(g)%committed, &
               after => solution%groups(g)%trial)
      call line_rule(group%rule, xi, weight)
      call group_geometry(scene, group, equations%elems(group%elem_id), u%value, x)
      corners = find_variable(group%variables, 'corner_place') > 0
      n = contact_block(corners, size(before, 1))
      do e = 1, size(x, 3)
        du = u%last_increment(:, group%connectivity(1:3, e))
        if (scene%finite) x(:, :3, e) = x(:, :3, e) - du
        do p = 1, size(xi)
          area = area_of_point(group%rule, xi, weight, p, solution%fields(section_field)%value(:, 1), x(:, :3, e))
          if (is_control_point(group%rule, p)) then
            call add_point(before(:n, p, e), after(:n, p, e), xi(p), area, 1.0_wp, shares=control_shares)
          else
            call add_point(before(:n, p, e), after(:n, p, e), xi(p), area, 1.0_wp)
          end if
          if (.not. corners) cycle
          if (group%pairs > 0) then
            if (interval_at_start(before(:, :, e), after(:, :, e), p) == 0) cycle
          end if
          call add_point(before(n + 1:2*n, p, e), after(n + 1:2*n, p, e), before(2*n + 1, p, e), &
                         area_at_corner(before(2*n + 1, p, e), corner_length(xi, p, group%pairs > 0), &
                                        solution%fields(section_field)%value(:, 1), x(:, :3, e), &
                                        side_length(scene, group%connectivity(:, e))), &
                         before(2*n + 2, p, e))
        end do
      end do
    end associate

  contains

    subroutine add_point(old, now, place, area, share, shares)
      real(wp), intent(in) :: old(:), now(:), place, area
      real(wp), intent(in) :: share                 ! of the pressure and friction of a corner that acted
      real(wp), intent(in), optional :: shares(3)   ! of the nodes in its motion
      real(wp) :: phi(3), dphi(3), tangent(2), traction(2), penalty(2), side, acted

      if (.not. opens(old(at_status), now(at_status))) return
      associate (group => scene%groups(g), side_of => x(:, :3, e))
        call line3(place, phi, dphi)
        side = side_length(scene, group%connectivity(:, e))
        acted = share*released_share(scene, solution, group, old, matmul(side_of, phi), side, present(shares))
        if (present(shares)) phi = shares
        tangent = tangent_of_die(scene, solution, group, old, matmul(side_of, dphi))
        ! walking along the die the part is on the left: the inner normal of the die is on the right
        traction = acted*((old(at_pressure) - old(at_between))*[tangent(2), -tangent(1)] + old(at_tau)*tangent)
        penalty = penalties(scene%materials(group%material), group, side, solution%penalty_share)
        work = work + area &
               *(0.5_wp*dot_product(traction, motion_of_die(scene, solution, group, old, matmul(side_of, phi)) - matmul(du, phi)) &
                 + kept_work(old, now, penalty, [share, share]))
      end associate
    end subroutine add_point

  end subroutine work_of_group

  !> Share of its pressure that a point of a side had at the start of the step, beyond a corner of its rigid die; 1 where it was on
  !> a face, or was a corner itself. (With dies of sides hardly any pressure is left at the end of that way: edge_release.)
  pure function released_share(scene, solution, group, state, x, length, of_control_point) result(share)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:)   !! (nstate) of the point at the start of the step [unit of each component]
    real(wp), intent(in) :: x(2)       !! then; of the middle node for a control point [length]
    real(wp), intent(in) :: length     !! of the side [length]
    logical, intent(in) :: of_control_point
    real(wp) :: share
    real(wp) :: y(2), pilot(3)
    type(closest_point_t) :: closest
    type(release_t) :: release

    share = 1
    if (is_deformable(scene%dies(group%die)) .or. nint(state(at_piece)) == 0) return
    pilot = solution%fields(pilot_field)%value(:, group%die) - solution%fields(pilot_field)%last_increment(:, group%die)
    y = turned(x - pilot(1:2), -pilot(3))
    if (of_control_point) then
      closest%piece = nint(state(at_piece))
      call slide_beyond(scene%dies(group%die), y, length, closest, release)
    else
      call slide_past_corner(scene%dies(group%die), y, [0.0_wp, 0.0_wp], length, state, closest, release)
    end if
    share = release%share
  end function released_share

  !> Unit tangent of a die where a point of a side lay on it at the start of the step: pressure and friction act along its normal
  !> and along it. At the end of a piece, where the normal may be any, that of the side.
  pure function tangent_of_die(scene, solution, group, state, along_side) result(tangent)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:)        !! (nstate) of the point at the start of the step [unit of each component]
    real(wp), intent(in) :: along_side(2)   !! tangent of the side there, the part on the left [length]
    real(wp) :: tangent(2), angle
    integer :: piece

    piece = nint(state(at_piece))
    tangent = along_side
    if (piece > 0 .and. abs(state(at_xi)) < 1) then
      associate (die => scene%dies(group%die), u => solution%fields(displacement_field), pilots => solution%fields(pilot_field))
        if (is_deformable(die)) then
          associate (nodes => die%nodes(:, piece))
            tangent = tangent_on(scene%mesh%coordinates(:, nodes) + u%value(:, nodes) - u%last_increment(:, nodes), state(at_xi))
          end associate
        else
          angle = pilots%value(3, group%die) - pilots%last_increment(3, group%die)
          tangent = turned(tangent_on(die%pieces(:, :, piece), state(at_xi)), angle)
        end if
      end associate
    end if
    tangent = tangent/length_of(tangent)
  end function tangent_of_die

  !> Motion in the step of the place of a die that a point of a side lay on.
  pure function motion_of_die(scene, solution, group, state, x) result(motion)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:)   !! (nstate) of the point at the start of the step [unit of each component]
    real(wp), intent(in) :: x(2)       !! then [length]
    real(wp) :: motion(2)              !! [length]
    real(wp) :: phi(3), dphi(3), arm(2)
    integer :: piece

    piece = nint(state(at_piece))
    motion = 0
    if (is_deformable(scene%dies(group%die))) then
      if (piece == 0) return
      call line3(state(at_xi), phi, dphi)
      motion = matmul(solution%fields(displacement_field)%last_increment(:, scene%dies(group%die)%nodes(:, piece)), phi)
    else
      associate (pilot => solution%fields(pilot_field)%value(:, group%die), &
                 step => solution%fields(pilot_field)%last_increment(:, group%die))
        arm = x - (pilot(1:2) - step(1:2))
        motion = step(1:2) + turned(arm, step(3)) - arm
      end associate
    end if
  end function motion_of_die

end module gap_work
