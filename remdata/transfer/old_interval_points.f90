!> Integration points of the old mesh in a contact interval, in sequence, with the corners of the die that press between them.
module old_interval_points
  use arcs, only: arc_t
  use boundary_sides, only: loop_t
  use corner_weights, only: corner_length, place_within, share_at_node
  use interval_points, only: add_neighbour, add_point, interval_points_t, line_jacobian, status_row, surface
  use kinds, only: wp
  use loop_intervals, only: contact_interval_t, is_before_corner, side_point_t
  use offset_parabolas, only: length_between
  use quadrature, only: line_rule, rule_control
  use scene, only: axisymmetric, scene_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: old_row

contains

  !> Old points of a group in an interval, and corners of the die that press between them.
  pure subroutine old_row(scene, g, loop, interval, x, state, with_corners, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(loop_t), intent(in) :: loop
    type(contact_interval_t), intent(in) :: interval
    real(wp), intent(in) :: x(:, :)           !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: state(:, :, :)    !! (component, point, element) of the group [unit of each component]
    logical, intent(in) :: with_corners
    type(interval_points_t), intent(out) :: row
    real(wp), allocatable :: xi(:), weight(:)
    type(arc_t) :: part
    integer :: side, number, e, p

    allocate (row%s(0), row%weight(0), row%point(0), row%element(0), row%offset(0), row%reach(0))
    call line_rule(scene%groups(g)%rule, xi, weight)
    if (.not. interval%from%xi > -1) call add_neighbour(scene, g, loop, x, interval%from%side - 1, 1.0_wp, row)
    call add_control_point(scene, g, loop, interval%from, -1, x, state, row)
    if (with_corners .and. interval%to_corner(1)) call add_released(scene, g, loop, x, interval%from, -1, row)
    do side = interval%from%side, interval%to%side
      number = modulo(side - 1, size(loop%sides, 2)) + 1
      associate (nodes => x(:, loop%sides(:, number)))
        part%points = nodes
        part%range = [-1.0_wp, 1.0_wp]
        if (side == interval%from%side) part%range(1) = interval%from%xi
        if (side == interval%to%side) part%range(2) = interval%to%xi
        e = findloc(scene%groups(g)%connectivity(2, :), loop%sides(2, number), 1)
        do p = 1, size(xi)
          if (e > 0 .and. with_corners) call add_corner(scene, g, nodes, part, xi, p, e, state, row)
          if (e == 0 .or. xi(p) < part%range(1) .or. xi(p) > part%range(2)) cycle
          if (is_before_corner(interval, side_point_t(side, xi(p)))) cycle
          call add_point(row%length + length_between(part, part%range(1), xi(p)), &
                         surface(scene, g, nodes, xi, weight, p), p, e, row)
        end do
      end associate
      row%length = row%length + length_between(part, part%range(1), part%range(2))
    end do
    if (.not. interval%to%xi < 1) call add_neighbour(scene, g, loop, x, interval%to%side + 1, -1.0_wp, row)
    call add_control_point(scene, g, loop, interval%to, 1, x, state, row)
    if (with_corners .and. interval%to_corner(2)) call add_released(scene, g, loop, x, interval%to, 1, row)
  end subroutine old_row

  !> Control point of the side within which an interval begins (towards = -1) or ends (1): where the side leaves the die at its
  !> end, the control point presses on that end (contact_contour).
  pure subroutine add_control_point(scene, g, loop, limit, towards, x, state, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, towards
    type(loop_t), intent(in) :: loop
    type(side_point_t), intent(in) :: limit
    real(wp), intent(in) :: x(:, :), state(:, :, :)
    type(interval_points_t), intent(inout) :: row
    real(wp), allocatable :: xi(:), weight(:)
    integer :: number, e

    if (scene%groups(g)%rule%family /= rule_control .or. .not. towards*limit%xi < 0) return
    number = modulo(limit%side - 1, size(loop%sides, 2)) + 1
    e = findloc(scene%groups(g)%connectivity(2, :), loop%sides(2, number), 1)
    if (e == 0) return
    if (nint(state(status_row(scene, g), 2, e)) == 0) return
    call line_rule(scene%groups(g)%rule, xi, weight)
    call add_point(row%length, surface(scene, g, x(:, loop%sides(:, number)), xi, weight, 2), 2, e, row)
  end subroutine add_control_point

  !> The points of the node that hands its force over to the corner in which an interval begins (-1) or ends (1): the pressure of
  !> their state acts there with what the corner has not taken yet (corner_release).
  pure subroutine add_released(scene, g, loop, x, corner, towards, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, towards
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)
    type(side_point_t), intent(in) :: corner
    type(interval_points_t), intent(inout) :: row
    real(wp) :: share
    integer :: n

    share = 1 - share_at_node(corner%xi)
    if (.not. (share > 0 .and. towards*corner%xi > 0)) return
    n = size(row%s)
    call add_neighbour(scene, g, loop, x, corner%side, real(towards, wp), row)
    call add_neighbour(scene, g, loop, x, corner%side + towards, -real(towards, wp), row)
    row%weight(n + 1:) = share*row%weight(n + 1:)
  end subroutine add_released

  !> The corner of the die in contact in the interval before a point, where it is on a part of a side.
  pure subroutine add_corner(scene, g, nodes, part, xi, p, e, state, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, p, e
    real(wp), intent(in) :: nodes(2, 3), xi(:), state(:, :, :)
    type(arc_t), intent(in) :: part
    type(interval_points_t), intent(inout) :: row
    real(wp) :: place, on_side, weight, share

    associate (variables => scene%groups(g)%variables, of_body => scene%groups(g)%pairs > 0)
      if (find_variable(variables, 'corner_place') == 0) return
      place = state(variables(find_variable(variables, 'corner_place'))%first, p, e)
      ! zero when open
      if (nint(state(variables(find_variable(variables, 'corner_contact_status'))%first, p, e)) == 0) return
      ! at an end of the side it is the state of a node on the axis, which has no surface; an edge beyond it acts at the node
      if (.not. (of_body .or. abs(place) < 1)) return
      on_side = place_within(place)
      if (on_side < part%range(1) .or. on_side > part%range(2)) return
      share = state(variables(find_variable(variables, 'corner_share'))%first, p, e)
      weight = corner_length(xi, p, of_body)*share*line_jacobian(nodes, on_side, scene%plane_state == axisymmetric)
      call add_point(row%length + length_between(part, part%range(1), on_side), weight, p, e, row, &
                     variables(find_variable(variables, 'corner_pressure'))%first &
                     - variables(find_variable(variables, 'pressure'))%first)
      if (share < 1) row%reach(size(row%reach)) = &
        length_between(part, min(on_side, sign(1.0_wp, place)), max(on_side, sign(1.0_wp, place)))
    end associate
  end subroutine add_corner

end module old_interval_points
