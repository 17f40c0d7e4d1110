!> Positions of points of the old loop on the corrected contour: points of a side are located where contact replaced it.
!>
!> On free sides xi is the same on both. Inside a contact interval a point is mapped to the closest position in that interval, never
!> to the opposite face of a thin part.
module contour_match
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t, position_t
  use boundary_sides, only: loop_t
  use contour_contacts, only: contact_t
  use kinds, only: wp
  use loop_intervals, only: along, side_point_t
  use offset_parabolas, only: closest_xi, point_at
  use vectors, only: length_of
  implicit none
  private
  public :: position_of_side_point

contains

  !> Position of a point of an old side on the corrected contour.
  pure function position_of_side_point(loop, boundary, contacts, x, side, xi) result(position)
    type(loop_t), intent(in) :: loop
    type(boundary_curve_t), intent(in) :: boundary   !! corrected
    type(contact_t), intent(in) :: contacts(:)       !! (ncontact)
    real(wp), intent(in) :: x(:, :)                  !! nodes before the correction (2, nnode) [length]
    integer, intent(in) :: side                      !! of the loop
    real(wp), intent(in) :: xi
    type(position_t) :: position
    type(arc_t) :: old
    real(wp) :: here, distance, least, point(2)
    integer :: k, interval

    interval = interval_at(loop, contacts, side, xi)
    old%points = x(:, loop%sides(:, side))
    point = point_at(old, xi)
    least = huge(least)
    do k = 1, size(boundary%arcs)
      associate (one => boundary%arcs(k))
        if (one%interval /= interval .or. interval == 0 .and. one%side /= side) cycle
        here = xi
        ! a free side may follow the die over a part of its length
        if (one%middle == 0) here = closest_xi(one, point)
        if (here < one%range(1) .or. here > one%range(2)) cycle
        distance = length_of(point_at(one, here) - point)
        if (.not. distance < least) cycle
        least = distance
        position = position_t(k, here)
      end associate
    end do
  end function position_of_side_point

  !> Contact interval that contains a point of an old side, 0 for none.
  pure function interval_at(loop, contacts, side, xi) result(interval)
    type(loop_t), intent(in) :: loop
    type(contact_t), intent(in) :: contacts(:)
    integer, intent(in) :: side
    real(wp), intent(in) :: xi
    integer :: interval
    integer :: k
    real(wp) :: s

    interval = 0
    do k = 1, size(contacts)
      s = along(side_point_t(side, xi))
      if (s < along(contacts(k)%interval%from)) s = s + size(loop%sides, 2)
      if (s <= along(contacts(k)%interval%to)) interval = k
    end do
  end function interval_at

end module contour_match
