!> Zones with a corner that lies flat on the contour, divided into three.
!>
!> No quadrilateral has a corner of 180 degrees. A zone whose corner D has become flat is a triangle ABC, and D a point of its long
!> side BC. Around a point M inside, with new points on AB and CA, it becomes (A, AB, M, CA), (B, D, M, AB) and (C, CA, M, D).
!> Zones beyond AB and CA are divided in two, from side to opposite side, as far as the contour. Sets of sides between blocks go
!> with the parts of their sides; those on the contour go with it.
module flat_corners
  use contour_chain, only: arc_at, chain_length, chain_t, joint_after, place_at_arc, place_t, point_on, turn_at
  use kinds, only: pi, wp
  use part_contour, only: contour_t
  use vectors, only: length_of
  use zone_places, only: coordinates
  use zones, only: as_found, plan_t, zone_point_t, zone_t
  implicit none
  private
  public :: divide_flat_zones

  !> A corner where the contour turns by less is flat: 35 degrees, a scaled Jacobian of 0.57.
  real(wp), parameter :: flat_turn = 35*pi/180
  !> Zones that come of a division are divided again only where their elements would be refused: 12 degrees, 0.2.
  real(wp), parameter :: useless_turn = 12*pi/180
  !> Places along the contour of which the one farthest out is taken.
  integer, parameter :: looks = 200

contains

  !> Divide the zones of a plan, counter-clockwise, that have flat corners.
  pure subroutine divide_flat_zones(contours, plan)
    type(contour_t), intent(in) :: contours(:)
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

  !> The flattest corner of a zone that no other zone has, with the contour on both hands; 0 when none is flat.
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
        if (point%chain == 0 .or. point%stays) cycle
        turn = turn_of(contours(point%chain)%chain, point%place)
      end associate
      if (.not. turn < least) cycle
      if (any([leads_back(plan, z, corners(modulo(k + [1, 2] - 1, 4) + 1)), &
               leads_back(plan, z, corners(modulo(k + [2, 3] - 1, 4) + 1))])) cycle
      least = turn
      corner = k
    end do
  end function flat_corner

  !> What the contour turns by at a place; nothing inside a stretch.
  pure function turn_of(chain, place) result(turn)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: place
    real(wp) :: turn

    turn = 0
    associate (range => chain%stretches(place%stretch)%range)
      if (.not. place%xi > range(1)) then
        turn = abs(turn_at(chain, place%stretch))
      else if (.not. place%xi < range(2)) then
        turn = abs(turn_at(chain, joint_after(chain, place%stretch)))
      end if
    end associate
  end function turn_of

  !> The zone on the other hand of a side that is walked from one point to another, 0 where there is none.
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

  !> Whether zones divided from side to opposite side, beginning beyond one of this zone's sides, come back to it.
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

  !> The side of the zone beyond that lies opposite, as that zone walks it.
  pure function opposite(zone, ends) result(side)
    type(zone_t), intent(in) :: zone
    integer, intent(in) :: ends(2)
    integer :: side(2)
    integer :: k

    k = findloc(zone%corners, ends(1), 1)
    side = zone%corners(modulo(k + [1, 2] - 1, 4) + 1)
  end function opposite

  !> From AB to B and from C to CA it is half the shorter of the sides AB and CA, so that in a flat disc only its rim is divided in
  !> this way; M stands opposite to A, a third of the way to D.
  pure subroutine split_in_three(contours, z, flat, plan)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: z, flat
    type(plan_t), intent(inout) :: plan
    real(wp) :: half, ways(2)
    integer :: corners(4), sets(4), ab, ca, m

    corners = plan%zones(z)%corners(modulo(flat + [1, 2, 3, 4], 4) + 1)
    sets = inner_sets(plan, z)
    sets = sets(modulo(flat + [1, 2, 3, 4], 4) + 1)
    associate (a => corners(1), b => corners(2), d => corners(3), c => corners(4))
      if (plan%points(d)%by_shape) call go_farthest(contours, plan%points(b), plan%points(c), plan%points(d))
      ways = [way_of(contours, plan, [a, b]), way_of(contours, plan, [c, a])]
      half = 0.5_wp*minval(ways)
      call divide_side(contours, [a, b], 1 - half/ways(1), plan, ab)
      call divide_side(contours, [c, a], half/ways(2), plan, ca)
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

  !> A point on a side, at a share of its way; the zones beyond are divided there and at the same share of their opposite sides.
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
      ! the zone before it is divided already, so that they share no side
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
        new%chain = from%chain
        associate (chain => contours(new%chain)%chain)
          new%place = place_at_arc(chain, arc_at(chain, from%place) + share*way_along(chain, from%place, to%place))
          new%x = point_on(chain, new%place)
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

  !> A zone like another one, between other points, with other sets of sides.
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
  pure function way_of(contours, plan, side) result(way)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    integer, intent(in) :: side(2)
    real(wp) :: way

    associate (from => plan%points(side(1)), to => plan%points(side(2)))
      if (zone_beyond(plan, side) > 0) then
        way = length_of(coordinates(contours, to) - coordinates(contours, from))
      else
        way = way_along(contours(from%chain)%chain, from%place, to%place)
      end if
    end associate
  end function way_of

  !> Length of the contour from one place to another [length].
  pure function way_along(chain, from, to) result(way)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from, to
    real(wp) :: way

    way = modulo(arc_at(chain, to) - arc_at(chain, from), chain_length(chain))
  end function way_along

  !> The point of the contour from one point to another that is farthest out from the line between them.
  pure subroutine go_farthest(contours, from, to, point)
    type(contour_t), intent(in) :: contours(:)
    type(zone_point_t), intent(in) :: from, to
    type(zone_point_t), intent(inout) :: point
    type(place_t) :: place
    real(wp) :: start(2), line(2), arm(2), way, out, farthest
    integer :: k

    associate (chain => contours(point%chain)%chain)
      start = point_on(chain, from%place)
      line = point_on(chain, to%place) - start
      way = way_along(chain, from%place, to%place)
      farthest = 0
      do k = 1, looks - 1
        place = place_at_arc(chain, arc_at(chain, from%place) + way*k/looks)
        arm = point_on(chain, place) - start
        out = line(2)*arm(1) - line(1)*arm(2)   ! to the right, where the part is not
        if (.not. out > farthest) cycle
        farthest = out
        point%place = place
      end do
      point%x = point_on(chain, point%place)
    end associate
  end subroutine go_farthest

end module flat_corners
