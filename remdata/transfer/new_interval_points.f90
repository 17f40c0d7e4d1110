!> Integration points of the new mesh on the arcs of a contact interval, in sequence.
module new_interval_points
  use boundary_curves, only: arc_length_at, boundary_length
  use corrected_contours, only: contour_t
  use interval_points, only: add_point, interval_points_t, surface
  use kinds, only: wp
  use new_scene, only: middle_position
  use quadrature, only: line_rule
  use scene, only: scene_t
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: new_row, round_off

  !> Arc lengths from the start of an interval are equal to this share of it.
  real(wp), parameter :: round_off = 1.0e-9_wp

contains

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

end module new_interval_points
