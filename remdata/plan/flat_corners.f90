!> Zones with a corner that lies flat on the contour, divided into three.
!>
!> No quadrilateral has a corner of 180 degrees. A zone whose corner D has become flat is a triangle ABC, and D a point of its long
!> side BC. Around a point M inside, with new points on AB and CA, it becomes (A, AB, M, CA), (B, D, M, AB) and (C, CA, M, D).
!> Zones beyond AB and CA are divided in two, from side to opposite side, up to the contour (zone_division).
module flat_corners
  use boundary_curves, only: arc_length_at, boundary_curve_t, joint_after, point_on, position_at_arc_length, position_t, turn_at
  use corrected_contours, only: contour_t
  use kinds, only: pi, wp
  use vectors, only: length_of
  use zone_division, only: add_zone, divide_side, inner_sets, length_along, opposite, zone_beyond
  use zones, only: as_found, coordinates_of, plan_t, zone_point_t
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

      x = coordinates_of(contours%boundary, plan%points(p))
    end function placed

  end subroutine split_in_three

  !> Length of a side: along the contour, or straight where two zones share it [length].
  pure function length_of_side(contours, plan, side) result(length)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: side(2)
    real(wp) :: length

    associate (from => plan%points(side(1)), to => plan%points(side(2)))
      if (zone_beyond(plan, side) > 0) then
        length = length_of(coordinates_of(contours%boundary, to) - coordinates_of(contours%boundary, from))
      else
        length = length_along(contours(from%boundary)%boundary, from%position, to%position)
      end if
    end associate
  end function length_of_side

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
