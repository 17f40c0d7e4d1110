!> Integration points along a contact interval, on the old sides and on the new ones.
module interval_points
  use arcs, only: arc_t
  use boundary_curves, only: arc_length_at, boundary_length
  use boundary_sides, only: loop_t
  use contact_intervals, only: contact_interval_t, is_before_corner, side_point_t
  use corner_weights, only: corner_weight, place_within, share_of_corner
  use kinds, only: wp
  use new_scene, only: middle_position
  use offset_parabolas, only: length_between
  use part_contour, only: contour_t
  use quadrature, only: line_rule, rule_control
  use scene, only: axisymmetric, scene_t
  use shape_functions, only: line3
  use state_variables, only: find_variable
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: interval_points_t, new_row, old_row, round_off, status_row, surface

  !> Integration points of an interval in sequence: arc length from its start, length each represents, point and element.
  type :: interval_points_t
    real(wp) :: length = 0.0_wp                !! of the interval [length]
    real(wp), allocatable :: s(:), weight(:)   !! [length], times the radius when axisymmetric
    integer, allocatable :: point(:), element(:)
    !> What is added to the numbers of components: 0, or for a corner of the die those of its own state.
    integer, allocatable :: offset(:)
    !> How far beside a corner of the die the node is that it shares its force with, below 0 where there is none [length].
    real(wp), allocatable :: reach(:)
  end type interval_points_t

  !> Arc lengths from the start of an interval are equal to this share of it.
  real(wp), parameter :: round_off = 1.0e-9_wp

contains

  !> Number of the component that is the status of a group's points; 0 where there is none.
  pure function status_row(scene, g) result(row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! group
    integer :: row

    row = find_variable(scene%groups(g)%variables, 'contact_status')
    if (row > 0) row = scene%groups(g)%variables(row)%first
  end function status_row

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

    share = 1 - share_of_corner(corner%xi, of_body=.false.)
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
    real(wp) :: place, on_side, weight

    associate (variables => scene%groups(g)%variables, of_body => scene%groups(g)%pairs > 0)
      if (find_variable(variables, 'corner_place') == 0) return
      place = state(variables(find_variable(variables, 'corner_place'))%first, p, e)
      ! zero when open
      if (nint(state(variables(find_variable(variables, 'corner_contact_status'))%first, p, e)) == 0) return
      ! at an end of the side it is the state of a node on the axis, which has no surface; an edge beyond it acts at the node
      if (.not. (of_body .or. abs(place) < 1)) return
      on_side = place_within(place)
      if (on_side < part%range(1) .or. on_side > part%range(2)) return
      weight = corner_weight(xi, p, place, of_body)*line_jacobian(nodes, on_side, scene%plane_state == axisymmetric)
      call add_point(row%length + length_between(part, part%range(1), on_side), weight, p, e, row, &
                     variables(find_variable(variables, 'corner_pressure'))%first &
                     - variables(find_variable(variables, 'pressure'))%first)
      if (share_of_corner(place, of_body) < 1) row%reach(size(row%reach)) = &
        length_between(part, min(on_side, sign(1.0_wp, place)), max(on_side, sign(1.0_wp, place)))
    end associate
  end subroutine add_corner

  !> The integration point of an adjacent side in the node where the interval begins or ends.
  pure subroutine add_neighbour(scene, g, loop, x, side, at, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, side
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :), at
    type(interval_points_t), intent(inout) :: row
    real(wp), allocatable :: xi(:), weight(:)
    integer :: n, e, p

    n = modulo(side - 1, size(loop%sides, 2)) + 1
    e = findloc(scene%groups(g)%connectivity(2, :), loop%sides(2, n), 1)
    if (e == 0) return
    call line_rule(scene%groups(g)%rule, xi, weight)
    do p = 1, size(xi)
      if (abs(xi(p) - at) > 0) cycle
      call add_point(row%length, surface(scene, g, x(:, loop%sides(:, n)), xi, weight, p), p, e, row)
    end do
  end subroutine add_neighbour

  !> Points of other sides of the group in the nodes where the sides of an interval begin and end.
  pure subroutine add_neighbours(scene, g, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(interval_points_t), intent(inout) :: row
    real(wp), allocatable :: xi(:), weight(:)
    logical :: inside(size(scene%groups(g)%connectivity, 2))
    real(wp) :: at, limits(2)
    integer :: ends(2), k, e, p

    call line_rule(scene%groups(g)%rule, xi, weight)
    limits = [minval(row%s), maxval(row%s)]
    associate (sides => scene%groups(g)%connectivity)
      ends(1) = sides(1, row%element(minloc(row%s, 1)))
      ends(2) = sides(3, row%element(maxloc(row%s, 1)))
      inside = .false.
      inside(row%element) = .true.
      do e = 1, size(inside)
        do k = 1, 2
          if (inside(e) .or. sides(5 - 2*k, e) /= ends(k)) cycle
          at = 3 - 2*k
          do p = 1, size(xi)
            if (abs(xi(p) - at) > 0) cycle
            call add_point(limits(k), surface(scene, g, scene%mesh%coordinates(:, sides(:, e)), xi, weight, p), p, e, row)
          end do
        end do
      end do
    end associate
  end subroutine add_neighbours

  !> Surface that a point of a side stands for: its weight, or with a control point the integral of its Bernstein polynomial by
  !> Simpson's rule, as the solver has it.
  pure function surface(scene, g, x, xi, weight, p) result(area)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, p                !! group, point
    real(wp), intent(in) :: x(2, 3)            !! nodes of the side [length]
    real(wp), intent(in) :: xi(:), weight(:)   !! (npoint) of the rule [-]
    real(wp) :: area                           !! [length], times the radius when axisymmetric
    logical :: round

    round = scene%plane_state == axisymmetric
    if (scene%groups(g)%rule%family /= rule_control) then
      area = weight(p)*line_jacobian(x, xi(p), round)
    else if (p == 2) then
      area = 2*line_jacobian(x, 0.0_wp, round)/3
    else
      area = (line_jacobian(x, xi(p), round) + line_jacobian(x, 0.0_wp, round))/3
    end if
  end function surface

  !> d(length)/d(xi), times the radius.
  pure function line_jacobian(x, xi, round) result(jacobian)
    real(wp), intent(in) :: x(2, 3), xi
    logical, intent(in) :: round
    real(wp) :: jacobian
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    jacobian = length_of(matmul(x, dphi))
    if (round) jacobian = jacobian*dot_product(x(1, :), phi)
  end function line_jacobian

  pure subroutine add_point(s, weight, point, element, row, offset)
    real(wp), intent(in) :: s, weight
    integer, intent(in) :: point, element
    type(interval_points_t), intent(inout) :: row
    integer, intent(in), optional :: offset
    integer :: added

    row%s = [row%s, s]
    row%weight = [row%weight, weight]
    row%point = [row%point, point]
    row%element = [row%element, element]
    added = 0
    if (present(offset)) added = offset
    row%offset = [row%offset, added]
    row%reach = [row%reach, -1.0_wp]
  end subroutine add_point

  !> New points of a group on the arcs of an interval.
  pure subroutine new_row(scene, g, contours, c, interval, mesh, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                     !! group
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    integer, intent(in) :: c, interval           !! contour, and its contact interval
    type(new_mesh_t), intent(in) :: mesh
    type(interval_points_t), intent(out) :: row
    type(interval_points_t) :: unsorted
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: start, from, to, total
    integer, allocatable :: order(:)
    logical :: taken((size(mesh%sides) + 2)*scene%groups(g)%rule%n)
    integer :: k, e, p

    allocate (unsorted%s(0), unsorted%weight(0), unsorted%point(0), unsorted%element(0), unsorted%offset(0), unsorted%reach(0))
    call line_rule(scene%groups(g)%rule, xi, weight)
    associate (boundary => contours(c)%boundary, contact => contours(c)%contacts(interval))
      total = boundary_length(boundary)
      start = boundary%arc_length(contact%first - 1)
      row%length = modulo(boundary%arc_length(contact%next - 1) - start, total)
      if (.not. row%length > 0) row%length = total
      unsorted%length = row%length
      do k = 1, size(mesh%sides)
        if (mesh%sides(k)%boundary /= c) cycle
        associate (position => middle_position(contours, mesh%sides(k)))
          if (boundary%arcs(position%arc)%interval /= interval) cycle
        end associate
        e = findloc(scene%groups(g)%connectivity(2, :), mesh%sides(k)%nodes(2), 1)
        if (e == 0) cycle
        from = modulo(arc_length_at(boundary, mesh%sides(k)%from) - start, total)
        to = modulo(arc_length_at(boundary, mesh%sides(k)%to) - start, total)
        if (from > row%length) from = from - total
        if (.not. to > from) to = to + total
        if (abs(from) <= round_off*row%length) from = 0
        if (abs(to - row%length) <= round_off*row%length) to = row%length
        do p = 1, size(xi)
          call add_point(from + 0.5_wp*(1 + xi(p))*(to - from), &
                         surface(scene, g, mesh%coordinates(:, mesh%sides(k)%nodes), xi, weight, p), p, e, unsorted)
        end do
      end do
    end associate
    if (size(unsorted%s) > 0) call add_neighbours(scene, g, unsorted)
    ! a side may begin before the interval or end behind it, where an end of contact was too close to another end of sides
    taken(:size(unsorted%s)) = unsorted%s < 0 .or. unsorted%s > row%length
    if (all(taken(:size(unsorted%s)))) taken(:size(unsorted%s)) = .false.
    allocate (order(count(.not. taken(:size(unsorted%s)))))
    do k = 1, size(order)
      order(k) = minloc(unsorted%s, 1, mask=.not. taken(:size(unsorted%s)))
      taken(order(k)) = .true.
    end do
    row%s = unsorted%s(order)
    row%weight = unsorted%weight(order)
    row%point = unsorted%point(order)
    row%element = unsorted%element(order)
    row%offset = unsorted%offset(order)
    row%reach = unsorted%reach(order)
  end subroutine new_row

end module interval_points
