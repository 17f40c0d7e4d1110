!> Transfer of the contact state to the new sides: along each contact interval, from its beginning to its end.
module contact_carry
  use arcs, only: arc_t
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, position_at_arc_length, position_t
  use boundary_sides, only: loop_t
  use contact_intervals, only: contact_interval_t, is_before_corner, side_point_t
  use contour_assembly, only: contact_t
  use corner_weights, only: corner_weight, place_within, share_of_corner
  use kinds, only: wp
  use new_scene, only: middle_position
  use offset_parabolas, only: length_between
  use part_contour, only: contour_t
  use quadrature, only: line_rule, rule_control
  use scene, only: axisymmetric, role_heat_contact, scene_t
  use shape_functions, only: line3
  use solution, only: present_coordinates, solution_t
  use state_variables, only: component_names, find_variable, kind_contact => transfer_contact
  use text, only: string_t
  use transfer_contact, only: carry_along
  use transfer_report, only: carried_quantity_t
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: interval_points_t
  public :: add_integrals, carry_contacts, list_carried, old_row, status_row, surface

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

  !> Contact variables and status of all groups of the new solution; open outside of contact intervals. Their integrals along all
  !> intervals before and after are reported.
  pure subroutine carry_contacts(old, from, contours, mesh, new, to, rows)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: from
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(new_mesh_t), intent(in) :: mesh
    type(solution_t), intent(inout) :: to
    type(carried_quantity_t), allocatable, intent(out) :: rows(:)   !! (nrow) integrals; over the length, or per radian
    real(wp) :: x(2, size(old%mesh%coordinates, 2))
    type(interval_points_t) :: row_old, row_new, row_of_points
    integer, allocatable :: carried(:)
    logical, allocatable :: conserved(:)
    integer :: c, k, g, h, i

    allocate (rows(0))
    x = present_coordinates(old, from)
    do c = 1, size(contours)
      do k = 1, size(contours(c)%contacts)
        g = contours(c)%contacts(k)%interval%group
        call old_row(old, g, contours(c)%loop, contours(c)%contacts(k)%interval, x, from%groups(g)%committed, .true., row_old)
        call old_row(old, g, contours(c)%loop, contours(c)%contacts(k)%interval, x, from%groups(g)%committed, .false., &
                     row_of_points)
        call new_row(new, g, contours, c, k, mesh, row_new)
        ! the group, and heat through its points
        do h = 1, size(old%groups)
          if (h /= g .and. .not. (old%groups(h)%role == role_heat_contact .and. old%groups(h)%host == g)) cycle
          if (h /= g) row_old = row_of_points
          call list_carried(old, h, carried, conserved)
          call carry_interval(carried, conserved, row_old, row_new, from%groups(h)%committed, status_row(old, h), &
                              to%groups(h)%committed)
          if (h == g) call place_on_die(new, g, contours(c)%boundary, contours(c)%contacts(k), row_new, to%groups(g)%committed)
          call add_integrals(old, h, carried(pack([(i, i=1, size(carried))], conserved)), row_old, from%groups(h)%committed, &
                             row_new, to%groups(h)%committed, rows)
        end do
      end do
    end do
    do g = 1, size(to%groups)
      to%groups(g)%trial = to%groups(g)%committed
    end do
  end subroutine carry_contacts

  !> Where on the die the points of an interval are: one that slides past a corner in the very first step is on the face it comes
  !> from (corner_release), and loses its pressure on a way, not at once.
  pure subroutine place_on_die(scene, g, boundary, contact, row, state)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(boundary_curve_t), intent(in) :: boundary
    type(contact_t), intent(in) :: contact
    type(interval_points_t), intent(in) :: row   !! of the new mesh
    real(wp), intent(inout) :: state(:, :, :)    !! (nstate, npoint, nside) [unit of each component]
    type(position_t) :: position
    integer :: p, first, last, piece, xi

    piece = find_variable(scene%groups(g)%variables, 'die_piece')
    if (piece == 0 .or. status_row(scene, g) == 0) return
    piece = scene%groups(g)%variables(piece)%first
    xi = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, 'die_xi'))%first
    first = contact%first
    last = modulo(contact%next - 2, size(boundary%arcs)) + 1
    do p = 1, size(row%s)
      ! at the ends of the interval other arcs begin
      if (row%s(p) <= 0) then
        position = position_t(first, boundary%arcs(first)%range(1))
      else if (row%s(p) >= row%length) then
        position = position_t(last, boundary%arcs(last)%range(2))
      else
        position = position_at_arc_length(boundary, modulo(boundary%arc_length(first - 1) + row%s(p), boundary_length(boundary)))
      end if
      associate (point => state(:, row%point(p), row%element(p)), arc => boundary%arcs(position%arc))
        if (nint(point(status_row(scene, g))) == 0 .or. arc%die /= contact%number) cycle
        point([piece, xi]) = [real(arc%piece, wp), min(max(position%xi, -1.0_wp), 1.0_wp)]
      end associate
    end do
  end subroutine place_on_die

  !> Number of the component that is the status of a group's points; 0 where there is none.
  pure function status_row(scene, g) result(row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! group
    integer :: row

    row = find_variable(scene%groups(g)%variables, 'contact_status')
    if (row > 0) row = scene%groups(g)%variables(row)%first
  end function status_row

  !> Components that are transferred along the contour, and the depth; those of die corners inside sides, which have the same names,
  !> are found again by the solver.
  pure subroutine list_carried(scene, g, carried, conserved)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                            !! group
    integer, allocatable, intent(out) :: carried(:)     !! (n) numbers of components
    logical, allocatable, intent(out) :: conserved(:)   !! (n) their integrals along an interval are kept
    integer :: v, i

    allocate (carried(0), conserved(0))
    do v = 1, size(scene%groups(g)%variables)
      associate (variable => scene%groups(g)%variables(v))
        if (find_variable(scene%groups(g)%variables, variable%name) < v) cycle
        ! the depth results from the contour, and is compared with the old one
        if (variable%transfer /= kind_contact .and. variable%name /= 'penetration') cycle
        carried = [carried, (variable%first + i, i=0, variable%ncomp - 1)]
        ! forces and work are integrals along the interval, a slip is not
        conserved = [conserved, spread(variable%unit /= 'length', 1, variable%ncomp)]
      end associate
    end do
  end subroutine list_carried

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
    integer, intent(in) :: g, c, interval
    type(contour_t), intent(in) :: contours(:)
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

  pure subroutine carry_interval(carried, conserved, row_old, row_new, before, status, after)
    integer, intent(in) :: carried(:)
    logical, intent(in) :: conserved(:)   !! the integral along the interval is kept
    type(interval_points_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :)
    integer, intent(in) :: status
    real(wp), intent(inout) :: after(:, :, :)
    real(wp) :: old(size(carried), size(row_old%s)), new(size(carried), size(row_new%s)), change(size(carried))
    integer :: p, v, nearest

    if (size(row_old%s) == 0) return
    do p = 1, size(row_old%s)
      old(:, p) = before(carried + row_old%offset(p), row_old%point(p), row_old%element(p))
    end do
    call share_forces(row_old, old)
    do v = 1, size(carried)
      call carry_along(row_old%length, row_old%s, old(v:v, :), row_old%weight, row_new%length, row_new%s, row_new%weight, 2, &
                       conserved(v), new(v:v, :), change(v:v))
    end do
    do p = 1, size(row_new%s)
      after(carried, row_new%point(p), row_new%element(p)) = new(:, p)
      if (status == 0) cycle
      nearest = minloc(abs(row_old%s*row_new%length - row_new%s(p)*row_old%length), 1)
      after(status, row_new%point(p), row_new%element(p)) = before(status + row_old%offset(nearest), &
                                                                     row_old%point(nearest), row_old%element(nearest))
    end do
  end subroutine carry_interval

  !> A corner of the die beside a node has a part of its weight, and the larger a pressure for it (corner_weights): both have the
  !> mean over the length that they stand for, be the points of the node those of an interval before, which the node hands over, or
  !> on the face beyond the corner.
  pure subroutine share_forces(row, values)
    type(interval_points_t), intent(in) :: row
    real(wp), intent(inout) :: values(:, :)   !! (component, npoint) [unit of each component]
    logical :: same(size(row%s))
    integer :: p, v

    do p = 1, size(row%s)
      if (row%reach(p) < 0) cycle
      same = row%offset == 0 .and. abs(row%s - row%s(p)) <= row%reach(p) + round_off*row%length
      same(p) = .true.
      if (count(same) < 2 .or. .not. sum(row%weight, mask=same) > 0) cycle
      do v = 1, size(values, 1)
        values(v, :) = merge(sum(values(v, :)*row%weight, mask=same)/sum(row%weight, mask=same), values(v, :), same)
      end do
    end do
  end subroutine share_forces

  !> Add the integrals of the variables of an interval, each to the row of its name.
  pure subroutine add_integrals(scene, g, components, row_old, before, row_new, after, rows)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g               !! group
    integer, intent(in) :: components(:)   !! (n) numbers of components
    type(interval_points_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :)       !! (component, point, element), old [unit of each component]
    real(wp), intent(in) :: after(:, :, :)        !! (component, point, element), new [unit of each component]
    type(carried_quantity_t), allocatable, intent(inout) :: rows(:)   !! (nrow)
    type(string_t), allocatable :: names(:)
    type(carried_quantity_t) :: row
    integer :: k, r

    call component_names(scene%groups(g)%variables, names)
    do k = 1, size(components)
      associate (component => components(k))
        row%name = 'contact '//names(component)%s
        row%transfer = kind_contact
        r = row_of(rows, row%name)
        if (r > size(rows)) rows = [rows, row]
        rows(r)%before = rows(r)%before + sum_along(row_old, component, before)
        rows(r)%after = rows(r)%after + sum_along(row_new, component, after)
        rows(r)%carried = rows(r)%after
        rows(r)%limited = rows(r)%after
        rows(r)%magnitude = rows(r)%magnitude + sum_along(row_old, component, abs(before))
        rows(r)%largest_before = max(rows(r)%largest_before, largest_along(row_old, component, before))
        rows(r)%largest_after = max(rows(r)%largest_after, largest_along(row_new, component, after))
      end associate
    end do
  end subroutine add_integrals

  !> Row of a name, one more than there are when it is not among them.
  pure function row_of(rows, name) result(r)
    type(carried_quantity_t), intent(in) :: rows(:)
    character(len=*), intent(in) :: name
    integer :: r

    do r = 1, size(rows)
      if (rows(r)%name == name) return
    end do
  end function row_of

  pure function sum_along(row, component, values) result(total)
    type(interval_points_t), intent(in) :: row
    integer, intent(in) :: component
    real(wp), intent(in) :: values(:, :, :)   !! (component, point, element)
    real(wp) :: total
    integer :: p

    total = 0
    do p = 1, size(row%s)
      total = total + row%weight(p)*values(component + row%offset(p), row%point(p), row%element(p))
    end do
  end function sum_along

  pure function largest_along(row, component, values) result(largest)
    type(interval_points_t), intent(in) :: row
    integer, intent(in) :: component
    real(wp), intent(in) :: values(:, :, :)   !! (component, point, element)
    real(wp) :: largest
    integer :: p

    largest = 0
    do p = 1, size(row%s)
      largest = max(largest, abs(values(component + row%offset(p), row%point(p), row%element(p))))
    end do
  end function largest_along

end module contact_carry
