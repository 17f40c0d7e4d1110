!> Points on a part of the contour: by their priority coordinate (annex 2, section 3 c) or by their share of the length.
!>
!> The quadratic of annex 2, eq. 1, is solved on each stretch, and the root counts that lies in the stretch's own range of xi:
!> near a beginning or an end of contact this is the comparison of xi with that of the end on both parabolas (fig. 5). Where
!> the priority coordinate turns back there may be several roots, or none: then the one whose share of the length is nearest
!> to the wanted share is taken, or the place at that share itself.
module contour_places
  use contour_chain, only: arc_at, chain_length, chain_t, joint_after, place_at_arc, place_t, point_on
  use kinds, only: eps, wp
  use stretches, only: cut, length_between, point_at, second_of, stretch_t, tangent_at, turning_places
  implicit none
  private
  public :: priority_axis, place_at_coordinate, place_at_share, length_of_part, coordinate_is_monotone, xi_at_coordinate

contains

  !> Coordinate that tells points of a part of the contour apart: 1 (X) where it runs nearer to the horizontal, else 2 (Y).
  pure function priority_axis(chain, from, to) result(axis)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from, to
    integer :: axis
    real(wp) :: way(2)

    way = abs(point_on(chain, to) - point_on(chain, from))
    axis = merge(1, 2, way(1) >= way(2))
  end function priority_axis

  !> Length along the chain from one place to another; all around when they are one place [length].
  pure function length_of_part(chain, from, to) result(length)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from, to
    real(wp) :: length

    length = arc_at(chain, to) - arc_at(chain, from)
    if (.not. length > 0) length = length + chain_length(chain)
  end function length_of_part

  !> Place at a share of the length between two places.
  pure function place_at_share(chain, from, to, share) result(place)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from, to
    real(wp), intent(in) :: share   !! 0 at `from`, 1 at `to`
    type(place_t) :: place

    if (.not. share > 0) then
      place = from
    else if (.not. share < 1) then
      place = to
    else
      place = place_at_arc(chain, arc_at(chain, from) + share*length_of_part(chain, from, to))
    end if
  end function place_at_share

  !> Place between two others where a coordinate has a value.
  pure function place_at_coordinate(chain, from, to, axis, value, share) result(place)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from, to
    integer, intent(in) :: axis       !! 1: X, 2: Y
    real(wp), intent(in) :: value     !! [length]
    real(wp), intent(in) :: share     !! of the length where the point is wanted
    type(place_t) :: place
    type(stretch_t) :: one
    real(wp) :: total, before, length, off, least, xi, turns(3), knots(5), values(2)
    integer :: k, i, n

    total = length_of_part(chain, from, to)
    place = place_at_share(chain, from, to, share)
    least = huge(least)
    before = 0
    k = from%stretch
    do
      call part_of_stretch(chain, k, from, to, before > 0, one)
      length = length_between(one, one%range(1), one%range(2))
      call turning_places(one, axis, n, turns)
      knots(1) = one%range(1)
      knots(2:n + 1) = turns(:n)
      knots(n + 2) = one%range(2)
      do i = 1, n + 1
        values = [coordinate(one, axis, knots(i)), coordinate(one, axis, knots(i + 1))]
        if (value < minval(values) .or. value > maxval(values)) cycle
        xi = xi_at_coordinate(one, axis, value, knots(i), knots(i + 1))
        off = abs((before + length_between(one, one%range(1), xi))/total - share)
        if (off >= least) cycle
        least = off
        place = place_t(k, xi)
      end do
      before = before + length
      if (before >= total*(1 - 64*eps)) exit
      k = joint_after(chain, k)
    end do
  end function place_at_coordinate

  !> What of stretch k lies between two places.
  pure subroutine part_of_stretch(chain, k, from, to, later, one)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: k
    type(place_t), intent(in) :: from, to
    logical, intent(in) :: later       !! the walk is past the stretch it began on
    type(stretch_t), intent(out) :: one
    real(wp) :: range(2)

    range = chain%stretches(k)%range
    if (k == from%stretch .and. .not. later) range(1) = from%xi
    if (k == to%stretch .and. to%xi > range(1)) range(2) = to%xi
    one = cut(chain%stretches(k), range(1), range(2))
  end subroutine part_of_stretch

  !> The priority coordinate does not turn back between two places.
  pure function coordinate_is_monotone(chain, from, to, axis) result(monotone)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from, to
    integer, intent(in) :: axis
    logical :: monotone
    type(stretch_t) :: one
    real(wp) :: total, before, turns(3), way, first_way
    integer :: k, n

    monotone = .true.
    total = length_of_part(chain, from, to)
    before = 0
    first_way = 0
    k = from%stretch
    do
      call part_of_stretch(chain, k, from, to, before > 0, one)
      call turning_places(one, axis, n, turns)
      way = coordinate(one, axis, one%range(2)) - coordinate(one, axis, one%range(1))
      if (.not. abs(first_way) > 0) first_way = way
      monotone = monotone .and. n == 0 .and. way*first_way > 0
      before = before + length_between(one, one%range(1), one%range(2))
      if (before >= total*(1 - 64*eps) .or. .not. monotone) exit
      k = joint_after(chain, k)
    end do
  end function coordinate_is_monotone

  pure function coordinate(stretch, axis, xi) result(value)
    type(stretch_t), intent(in) :: stretch
    integer, intent(in) :: axis
    real(wp), intent(in) :: xi
    real(wp) :: value
    real(wp) :: point(2)

    point = point_at(stretch, xi)
    value = point(axis)
  end function coordinate

  !> Parent coordinate between two others where a coordinate has a value that it passes there once: the quadratic of annex 2,
  !> eq. 1 with the sign of its first term corrected; at a depth Newton's method kept in the bracket goes on from its root.
  pure function xi_at_coordinate(stretch, axis, value, first, last) result(xi)
    type(stretch_t), intent(in) :: stretch
    integer, intent(in) :: axis          !! 1: X, 2: Y
    real(wp), intent(in) :: value        !! [length]
    real(wp), intent(in) :: first, last
    real(wp) :: xi
    real(wp) :: c(0:2), second(2), q, roots(2), low, high, excess, tangent(2), rise
    integer :: iteration
    integer, parameter :: most_iterations = 80   ! halving alone reaches round-off in 54

    second = second_of(stretch)
    c = [stretch%points(axis, 2) - value, 0.5_wp*(stretch%points(axis, 3) - stretch%points(axis, 1)), 0.5_wp*second(axis)]
    q = -0.5_wp*(c(1) + sign(sqrt(max(c(1)**2 - 4*c(2)*c(0), 0.0_wp)), c(1)))
    roots = huge(roots)
    if (abs(q) > 0) roots(1) = c(0)/q
    if (abs(q) < huge(q)*min(abs(c(2)), 1.0_wp)) roots(2) = q/c(2)
    xi = roots(merge(1, 2, outside(roots(1)) <= outside(roots(2))))
    xi = min(max(xi, first), last)
    if (.not. any(abs(stretch%depth) > 0)) return
    rise = sign(1.0_wp, coordinate(stretch, axis, last) - coordinate(stretch, axis, first))
    low = first
    high = last
    do iteration = 1, most_iterations
      excess = rise*(coordinate(stretch, axis, xi) - value)
      if (excess > 0) then
        high = xi
      else
        low = xi
      end if
      tangent = rise*tangent_at(stretch, xi)
      if (abs(excess) <= 2*eps*abs(tangent(axis)) .or. high - low <= 2*eps) return
      xi = xi - excess/tangent(axis)
      if (.not. (xi >= low .and. xi <= high)) xi = 0.5_wp*(low + high)
    end do

  contains

    !> How far a root lies outside the bracket.
    pure function outside(root) result(off)
      real(wp), intent(in) :: root
      real(wp) :: off

      off = max(first - root, root - last, 0.0_wp)
    end function outside

  end function xi_at_coordinate

end module contour_places
