!> Where a straight path goes through an oriented curve of parabolas: what a point has passed that moved too far for the closest
!> points of its start and its end to tell.
module path_crossings
  use closest_point, only: closest_point_t, whole_piece
  use curve_boxes, only: box_gap
  use curve_search, only: closest_facing_point
  use kinds, only: eps, wp
  use parabolas, only: point_on, tangent_on
  use piecewise_curves, only: piecewise_curve_t
  use plane_vectors, only: cross, right_of
  implicit none
  private
  public :: share_before_passing

  !> A point where a path meets a curve: share of the path, and the curve's inner normal there.
  type :: crossing_t
    real(wp) :: share = 2.0_wp
    real(wp) :: normal(2) = 0.0_wp
  end type crossing_t

contains

  !> Share of a path after which it goes into the body behind a curve and is lost there: it comes out through another wall, or it
  !> ends where no closest point within reach gives its depth. 1 where nothing is passed.
  !>
  !> A path that cuts off a bend of the curve comes out through the same wall: its normals there point the same way.
  pure function share_before_passing(curve, from, to, e_r, reach) result(share)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: from(2), to(2)   !! ends of the path, in the curve's axes [length]
    real(wp), intent(in) :: e_r(2)           !! inner normal of the part at the end [-]
    real(wp), intent(in) :: reach            !! [length]
    real(wp) :: share
    type(crossing_t) :: entry, exit
    type(closest_point_t) :: closest

    share = 1
    entry = first_crossing(curve, from, to, 1.0_wp, -1.0_wp)
    if (entry%share > 1) return
    exit = first_crossing(curve, from, to, -1.0_wp, entry%share)
    if (exit%share > 1) then
      call closest_facing_point(curve, to, e_r, reach, closest)
      if (closest%piece > 0 .and. closest%d > 0) return
    else if (dot_product(entry%normal, exit%normal) > 0) then
      return
    end if
    share = entry%share
  end function share_before_passing

  !> First crossing behind a share of the path, inwards (way 1) or outwards (way -1); share 2 where there is none.
  pure function first_crossing(curve, from, to, way, behind) result(first)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: from(2), to(2), way, behind
    type(crossing_t) :: first
    real(wp) :: along(2), xi(2), share, normal(2)
    integer :: k, n, r

    along = to - from
    do k = 1, size(curve%pieces, 3)
      if (box_gap(curve%boxes(:, k), [min(from, to), max(from, to)]) > 0) cycle
      call meet_line(curve%pieces(:, :, k), from, along, n, xi)
      do r = 1, n
        share = dot_product(point_on(curve%pieces(:, :, k), xi(r)) - from, along)/dot_product(along, along)
        if (share < 0 .or. share > 1 .or. .not. share > behind .or. .not. share < first%share) cycle
        normal = right_of(tangent_on(curve%pieces(:, :, k), xi(r)))
        if (way*dot_product(normal, along) > 0) first = crossing_t(share, normal)
      end do
    end do
  end function first_crossing

  !> Parent coordinates where a parabola meets a line through a point: along x (Y(xi) - from) = 0, a quadratic.
  pure subroutine meet_line(piece, from, along, n, xi)
    real(wp), intent(in) :: piece(2, 3), from(2), along(2)
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(2)   !! the first n
    real(wp) :: a, b, c, root, q, found(2)
    integer :: k

    a = cross(along, 0.5_wp*(piece(:, 1) + piece(:, 3)) - piece(:, 2))
    b = cross(along, 0.5_wp*(piece(:, 3) - piece(:, 1)))
    c = cross(along, piece(:, 2) - from)
    n = 0
    root = b*b - 4*a*c
    if (root < 0) return
    q = -0.5_wp*(b + sign(sqrt(root), b))
    found = 2*whole_piece(2)
    if (abs(a) > eps*abs(b)) found(1) = q/a
    if (abs(q) > 0) found(2) = c/q
    do k = 1, 2
      if (found(k) < whole_piece(1) .or. found(k) > whole_piece(2)) cycle
      n = n + 1
      xi(n) = found(k)
    end do
  end subroutine meet_line

end module path_crossings
