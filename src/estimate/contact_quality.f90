!> Fit of the sides of a mesh to the dies they touch.
!>
!> Two things that no pressure corrects: a side whose parabola is deeper in the die between its points than at them, or, with ALONG,
!> spans a bend of the die from one place in contact to another, and a corner of the die that sticks into a side. All are measured
!> over the penetration that the side's law allows. Where a body faces itself neither is known: the depth of a side below its own
!> body's contour says nothing (own_contact), and is left out as it is of `max_penetration_sampled`.
module contact_quality
  use contact_penalties, only: allowed_penetration
  use contact_scan, only: deepest_sample, is_near, widest_gap
  use contact_state, only: at_penetration, at_status, contact_block
  use dies, only: die_t, in_pilot_axes, present_die
  use fields, only: pilot_field
  use kinds, only: wp
  use quadrature, only: is_control_point, rule_along, rule_t
  use law_api, only: contact_open
  use own_contact, only: faces_itself
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: misfit_t, measure_misfit, misfit_of_sides

  !> The worst of a group, over the allowed penetration, and the sides where it is (0: none).
  type :: misfit_t
    real(wp) :: between = 0.0_wp, corner = 0.0_wp
    integer :: between_side = 0, corner_side = 0
  end type misfit_t

  !> What is nearer to a die than this share of the side touches it: multipliers hold points as much above it as below.
  real(wp), parameter :: touching = 5.0e-4_wp

contains

  !> Misfit of the sides of a contact group; none where its law states no penetration.
  pure function measure_misfit(scene, g, solution) result(misfit)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                   !! a group that faces a die
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    type(misfit_t) :: misfit
    real(wp) :: of_sides(2, size(scene%groups(g)%connectivity, 2)), allowed
    integer :: e

    allowed = allowed_penetration(scene%materials(scene%groups(g)%material))
    if (.not. allowed > 0) return
    of_sides = misfit_of_sides(scene, g, solution)/allowed
    do e = 1, size(of_sides, 2)
      call keep(of_sides(1, e), e, misfit%between, misfit%between_side)
      call keep(of_sides(2, e), e, misfit%corner, misfit%corner_side)
    end do
  end function measure_misfit

  !> The depth of each side over its length: between its points, and at a corner of the die.
  pure function misfit_of_sides(scene, g, solution) result(of_sides)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                   !! a group that faces a die
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    real(wp) :: of_sides(2, size(scene%groups(g)%connectivity, 2))   !! [-]
    type(die_t) :: die
    real(wp) :: side(2, 3), x(2, size(scene%mesh%coordinates, 2)), length, known, deep
    logical :: corners
    integer :: e, n

    of_sides = 0
    if (faces_itself(scene, scene%groups(g))) return
    corners = find_variable(scene%groups(g)%variables, 'corner_place') > 0
    x = present_coordinates(scene, solution)
    die = present_die(scene%dies(scene%groups(g)%die), x)
    do e = 1, size(scene%groups(g)%connectivity, 2)
      associate (nodes => scene%groups(g)%connectivity(:, e), state => solution%groups(g)%committed(:, :, e))
        side = in_pilot_axes(x(:, nodes), solution%fields(pilot_field)%value(:, scene%groups(g)%die))
        length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
        if (.not. is_near(die, side, length)) cycle
        n = contact_block(corners, size(state, 1))
        known = depth_of(state(:n, :), rule=scene%groups(g)%rule)
        if (corners) then
          deep = depth_of(state(n + 1:2*n, :))
          of_sides(2, e) = deep/length
          known = max(known, deep)
        end if
        deep = deepest_sample(die, side, length) - known
        if (scene%groups(g)%rule%family == rule_along) deep = max(deep, widest_gap(die, side, length, touching*length))
        of_sides(1, e) = deep/length
      end associate
    end do
  end function misfit_of_sides

  !> Largest penetration of points in contact, of a rule or of corners [length].
  pure function depth_of(state, rule) result(depth)
    real(wp), intent(in) :: state(:, :)   !! (nstate, npoint) of contact_point
    type(rule_t), intent(in), optional :: rule
    real(wp) :: depth
    integer :: p

    depth = 0
    do p = 1, size(state, 2)
      if (nint(state(at_status, p)) == contact_open) cycle
      if (present(rule)) then
        if (is_control_point(rule, p)) cycle
      end if
      depth = max(depth, state(at_penetration, p))
    end do
  end function depth_of

  pure subroutine keep(value, side, worst, worst_side)
    real(wp), intent(in) :: value
    integer, intent(in) :: side
    real(wp), intent(inout) :: worst
    integer, intent(inout) :: worst_side

    if (.not. value > worst) return
    worst = value
    worst_side = side
  end subroutine keep

end module contact_quality
