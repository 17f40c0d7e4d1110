!> Zones with a corner that lies flat on the contour, divided into three.
!>
!> No quadrilateral has a corner of 180 degrees. A zone whose corner D has become flat is a triangle ABC, and D a point of its long
!> side BC. Around a point M inside, with new points on AB and CA, it becomes (A, AB, M, CA), (B, D, M, AB) and (C, CA, M, D).
!> Zones beyond AB and CA are divided in two, from side to opposite side, up to the contour. Sets of sides between blocks are kept
!> on the parts of their sides; those on the contour follow the contour.
module flat_corners
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, joint_after, point_on, position_at_arc_length, &
                             position_t, turn_at
  use kinds, only: pi, wp
  use part_contour, only: contour_t
  use vectors, only: length_of
  use zone_point_coordinates, only: coordinates
  use zones, only: as_found, plan_t, zone_point_t, zone_t
  implicit none
  private
  public :: divide_flat_zones

  !> A corner where the contour turns by less is flat: 35 degrees, a scaled Jacobian of 0.57.
  real(wp), parameter :: flat_turn = 35*pi/180
  !> Zones created by a division are divided again only where their elements would be refused: 12 degrees, 0.2.
  real(wp), parameter :: useless_turn = 12*pi/180
  !> Samples along the contour, of which the one farthest out is taken.
  integer, parameter :: samples = 200

contains

  !> Divide the zones of a plan, counter-clockwise, that have flat corners.
  pure subroutine divide_flat_zones(contours, plan)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(plan_t), intent(inout) :: plan
    integer :: z, k, n

    n = size(plan%zones)
    z = 1
    do while (z <= size(plan%zones))
      k = flat_corner(contours, plan, z, merge(flat_turn, useless_turn, z <= n))
      if (k > 0) call split_in_three(contours, z, k, plan)
      z = z + 1
    end do
  end subroutine divide_flat_zones

  !> The flattest corner of a zone that no other zone shares, with the contour on either side; 0 when none is flat.
  pure function flat_corner(contours, plan, z, flat) result(corner)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: z
    real(wp), intent(in) :: flat   !! turn of the contour below which a corner is [radian]
    integer :: corner
    real(wp) :: turn, least
    integer :: corners(0:5), k

    corner = 0
    least = flat
    corners = plan%zones(z)%corners([4, 1, 2, 3, 4, 1])
    do k = 1, 4
      if (zone_beyond(plan, corners(k - 1:k)) > 0 .or. zone_beyond(plan, corners(k:k + 1)) > 0) cycle
      associate (point => plan%points(corners(k)))
        if (point%boundary == 0 .or. point%stays) cycle
        turn = turn_of(contours(point%boundary)%boundary, point%position)
      end associate
      if (.not. turn < least) cycle
      if (any([leads_back(plan, z, corners(modulo(k + [1, 2] - 1, 4) + 1)), &
               leads_back(plan, z, corners(modulo(k + [2, 3] - 1, 4) + 1))])) cycle
      least = turn
      corner = k
    end do
  end function flat_corner

  !> Angle the contour turns by at a position; zero inside an arc.
  pure function turn_of(boundary, position) result(turn)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: position
    real(wp) :: turn

    turn = 0
    associate (range => boundary%arcs(position%arc)%range)
      if (.not. position%xi > range(1)) then
        turn = abs(turn_at(boundary, position%arc))
      else if (.not. position%xi < range(2)) then
        turn = abs(turn_at(boundary, joint_after(boundary, position%arc)))
      end if
    end associate
  end function turn_of

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

  !> Whether zones divided from side to opposite side, beginning beyond one of this zone's sides, lead back to it.
  pure function leads_back(plan, zone, side) result(back)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: zone, side(2)
    logical :: back
    integer :: ends(2), z, step

    back = .false.
    ends = side
    do step = 1, size(plan%zones)
      z = zone_beyond(plan, ends)
      back = z == zone
      if (back .or. z == 0) return
      ends = opposite(plan%zones(z), ends)
    end do
    back = .true.
  end function leads_back

  !> The opposite side in the adjacent zone, in the direction of that zone.
  pure function opposite(zone, ends) result(side)
    type(zone_t), intent(in) :: zone
    integer, intent(in) :: ends(2)
    integer :: side(2)
    integer :: k

    k = findloc(zone%corners, ends(1), 1)
    side = zone%corners(modulo(k + [1, 2] - 1, 4) + 1)
  end function opposite

  !> The distances from AB to B and from C to CA are half the shorter of the sides AB and CA, so that in a flat disc only the rim is
  !> divided in this way; M is opposite to A, at a third of the distance to D.
  pure subroutine split_in_three(contours, z, flat, plan)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: z, flat
    type(plan_t), intent(inout) :: plan
    real(wp) :: half, lengths(2)
    integer :: corners(4), sets(4), ab, ca, m

    corners = plan%zones(z)%corners(modulo(flat + [1, 2, 3, 4], 4) + 1)
    sets = inner_sets(plan, z)
    sets = sets(modulo(flat + [1, 2, 3, 4], 4) + 1)
    associate (a => corners(1), b => corners(2), d => corners(3), c => corners(4))
      if (plan%points(d)%by_shape) call move_to_farthest(contours, plan%points(b), plan%points(c), plan%points(d))
      lengths = [length_of_side(contours, plan, [a, b]), length_of_side(contours, plan, [c, a])]
      half = 0.5_wp*minval(lengths)
      call divide_side(contours, [a, b], 1 - half/lengths(1), plan, ab)
      call divide_side(contours, [c, a], half/lengths(2), plan, ca)
      plan%points = [plan%points, zone_point_t(x=(2*(placed(ab) + placed(ca) - placed(a)) + placed(d))/3)]
      m = size(plan%points)
      plan%zones(z)%form = as_found
      call add_zone(z, [b, d, m, ab], [0, 0, 0, sets(1)], plan)
      call add_zone(z, [c, ca, m, d], [sets(4), 0, 0, 0], plan)
      plan%zones(z)%corners = [a, ab, m, ca]
      plan%sets(:, z) = [sets(1), 0, 0, sets(4)]
    end associate

  contains

    pure function placed(p) result(x)
      integer, intent(in) :: p
      real(wp) :: x(2)

      x = coordinates(contours, plan%points(p))
    end function placed

  end subroutine split_in_three

  !> A point on a side, at a share of its length; the zones beyond are divided there and at the same share of their opposite sides.
  pure subroutine divide_side(contours, side, share, plan, point)
    type(contour_t), intent(in) :: contours(:)
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
        new%x = (1 - share)*coordinates(contours, from) + share*coordinates(contours, to)
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

  !> Length of a side: along the contour, or straight where two zones share it [length].
  pure function length_of_side(contours, plan, side) result(length)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: side(2)
    real(wp) :: length

    associate (from => plan%points(side(1)), to => plan%points(side(2)))
      if (zone_beyond(plan, side) > 0) then
        length = length_of(coordinates(contours, to) - coordinates(contours, from))
      else
        length = length_along(contours(from%boundary)%boundary, from%position, to%position)
      end if
    end associate
  end function length_of_side

  !> Length of the contour from one position to another [length].
  pure function length_along(boundary, from, to) result(length)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: from, to
    real(wp) :: length

    length = modulo(arc_length_at(boundary, to) - arc_length_at(boundary, from), boundary_length(boundary))
  end function length_along

  !> The point of the contour from one point to another that is farthest out from the line between them.
  pure subroutine move_to_farthest(contours, from, to, point)
    type(contour_t), intent(in) :: contours(:)
    type(zone_point_t), intent(in) :: from, to
    type(zone_point_t), intent(inout) :: point
    type(position_t) :: position
    real(wp) :: start(2), line(2), arm(2), length, out, farthest
    integer :: k

    associate (boundary => contours(point%boundary)%boundary)
      start = point_on(boundary, from%position)
      line = point_on(boundary, to%position) - start
      length = length_along(boundary, from%position, to%position)
      farthest = 0
      do k = 1, samples - 1
        position = position_at_arc_length(boundary, arc_length_at(boundary, from%position) + length*k/samples)
        arm = point_on(boundary, position) - start
        out = line(2)*arm(1) - line(1)*arm(2)   ! to the right, where the part is not
        if (.not. out > farthest) cycle
        farthest = out
        point%position = position
      end do
      point%x = point_on(boundary, point%position)
    end associate
  end subroutine move_to_farthest

end module flat_corners
