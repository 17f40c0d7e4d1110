!> A side of a zone divided by a point, and with it the zones beyond, from side to opposite side, up to the contour.
!>
!> Sets of sides between blocks are kept on the parts of their sides; those on the contour follow the contour.
module zone_division
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, point_on, position_at_arc_length, position_t
  use corrected_contours, only: contour_t
  use kinds, only: wp
  use zones, only: as_found, coordinates_of, plan_t, zone_point_t, zone_t
  implicit none
  private
  public :: zone_beyond, opposite, divide_side, inner_sets, add_zone, length_along

contains

  !> The zone on the other side of a zone side from one point to another, 0 where there is none.
  pure function zone_beyond(plan, ends) result(beyond)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: ends(2)
    integer :: beyond
    integer :: k

    do beyond = 1, size(plan%zones)
      associate (corners => plan%zones(beyond)%corners)
        do k = 1, 4
          if (corners(k) == ends(2) .and. corners(modulo(k, 4) + 1) == ends(1)) return
        end do
      end associate
    end do
    beyond = 0
  end function zone_beyond

  !> The opposite side in the adjacent zone, in the direction of that zone.
  pure function opposite(zone, ends) result(side)
    type(zone_t), intent(in) :: zone
    integer, intent(in) :: ends(2)
    integer :: side(2)
    integer :: k

    k = findloc(zone%corners, ends(1), 1)
    side = zone%corners(modulo(k + [1, 2] - 1, 4) + 1)
  end function opposite

  !> A point on a side, at a share of its length; the zones beyond are divided there and at the same share of their opposite sides.
  pure subroutine divide_side(contours, side, share, plan, point)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    integer, intent(in) :: side(2)
    real(wp), intent(in) :: share
    type(plan_t), intent(inout) :: plan
    integer, intent(out) :: point
    integer :: ends(2), far(2), sets(4), z, here, next, first

    ends = side
    call add_point(contours, ends, share, plan, point)
    here = point
    do
      z = zone_beyond(plan, ends)
      if (z == 0) return
      far = opposite(plan%zones(z), ends)
      first = findloc(plan%zones(z)%corners, ends(2), 1)
      sets = inner_sets(plan, z)
      ! the previous zone is divided already, so that they share no side
      sets(first) = plan%sets(first, z)
      sets = sets(modulo(first + [0, 1, 2, 3] - 1, 4) + 1)
      call add_point(contours, far, share, plan, next)
      plan%zones(z)%form = as_found
      call add_zone(z, [here, ends(1), far(1), next], [sets(1:3), 0], plan)
      plan%zones(z)%corners = [ends(2), here, next, far(2)]
      plan%sets(:, z) = [sets(1), 0, sets(3), sets(4)]
      ends = far
      here = next
    end do
  end subroutine divide_side

  pure subroutine add_point(contours, side, share, plan, point)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: side(2)
    real(wp), intent(in) :: share
    type(plan_t), intent(inout) :: plan
    integer, intent(out) :: point
    type(zone_point_t) :: new

    associate (from => plan%points(side(1)), to => plan%points(side(2)))
      if (zone_beyond(plan, side) > 0) then
        new%x = (1 - share)*coordinates_of(contours%boundary, from) + share*coordinates_of(contours%boundary, to)
      else
        new%boundary = from%boundary
        associate (boundary => contours(new%boundary)%boundary)
          new%position = position_at_arc_length(boundary, arc_length_at(boundary, from%position) &
                                                + share*length_along(boundary, from%position, to%position))
          new%x = point_on(boundary, new%position)
        end associate
      end if
    end associate
    plan%points = [plan%points, new]
    point = size(plan%points)
  end subroutine add_point

  !> Sets of those sides of a zone that another zone shares, 0 for the others.
  pure function inner_sets(plan, z) result(sets)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: z
    integer :: sets(4)
    integer :: k

    sets = plan%sets(:, z)
    do k = 1, 4
      if (zone_beyond(plan, plan%zones(z)%corners([k, mod(k, 4) + 1])) == 0) sets(k) = 0
    end do
  end function inner_sets

  !> Copy a zone with other corners and other sets of sides.
  pure subroutine add_zone(like, corners, sides, plan)
    integer, intent(in) :: like, corners(4), sides(4)
    type(plan_t), intent(inout) :: plan
    type(zone_t) :: zone
    integer, allocatable :: sets(:, :)

    zone = plan%zones(like)
    zone%corners = corners
    plan%zones = [plan%zones, zone]
    plan%group = [plan%group, plan%group(like)]
    allocate (sets(4, size(plan%zones)), source=0)
    sets(:, :size(plan%sets, 2)) = plan%sets
    sets(:, size(plan%zones)) = sides
    call move_alloc(sets, plan%sets)
  end subroutine add_zone

  !> Length of the contour from one position to another [length].
  pure function length_along(boundary, from, to) result(length)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: from, to
    real(wp) :: length

    length = modulo(arc_length_at(boundary, to) - arc_length_at(boundary, from), boundary_length(boundary))
  end function length_along

end module zone_division
