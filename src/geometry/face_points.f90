!> Closest points on one face of a curve: the pieces that follow one another without a corner.
!>
!> Where the closest point would be beyond a corner, or an end of the curve, the face goes on along its tangent there.
module face_points
  use closest_point, only: closest_at_vertex, closest_point_t, closest_within_piece, distance_slope, end_slack, stationary_points, &
                           whole_piece
  use kinds, only: wp
  use parabolas, only: tangent_on
  use piecewise_curves, only: adjacent_piece, blunt, piecewise_curve_t
  use plane_vectors, only: cross, right_of
  use vectors, only: length_of
  implicit none
  private
  public :: closest_on_face

contains

  !> Closest point on the face of a position on a curve, from there on as long as the distance decreases.
  pure subroutine closest_on_face(curve, point, piece, xi, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)   !! in the curve's axes [length]
    integer, intent(in) :: piece       !! of the position
    real(wp), intent(in) :: xi         !! on it [-]
    type(closest_point_t), intent(out) :: closest
    real(wp) :: here, roots(3)
    integer :: k, next, way, n, steps

    k = piece
    here = xi
    way = merge(-1, 1, distance_slope(curve%pieces(:, :, k), point, here) > 0)
    do steps = 1, size(curve%pieces, 3)
      call stationary_points(curve%pieces(:, :, k), point, whole_piece, n, roots)
      if (any(way*(roots(:n) - here) >= -end_slack)) then
        here = way*minval(way*roots(:n), mask=way*(roots(:n) - here) >= -end_slack)
        call closest_within_piece(curve%pieces(:, :, k), point, here, closest)
        if (closest%piece > 0) closest%piece = k
        return
      end if
      next = adjacent_piece(curve, k, way)
      if (next == 0) exit
      if (is_corner(curve, k, next, way)) exit
      if (way*distance_slope(curve%pieces(:, :, next), point, -real(way, wp)) >= 0) then
        if (way < 0) k = next
        call closest_at_vertex(curve%pieces(:, :, k), curve%pieces(:, :, adjacent_piece(curve, k, 1)), point, closest)
        if (closest%piece > 0) closest%piece = k
        return
      end if
      k = next
      here = -way
    end do
    closest = along_tangent(curve%pieces(:, :, k), real(way, wp), point)
    closest%piece = k
  end subroutine closest_on_face

  !> Two pieces meet in a corner: the second follows the first (way 1) or precedes it (-1).
  pure function is_corner(curve, first, second, way) result(yes)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: first, second, way
    logical :: yes
    real(wp) :: t1(2), t2(2)

    t1 = tangent_on(curve%pieces(:, :, first), real(way, wp))
    t2 = tangent_on(curve%pieces(:, :, second), -real(way, wp))
    yes = abs(cross(t1, t2)) > blunt*length_of(t1)*length_of(t2) .or. dot_product(t1, t2) < 0
  end function is_corner

  !> A point beside the tangent of a piece at one end.
  pure function along_tangent(piece, xi, point) result(closest)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: xi            !! -1 or 1
    real(wp), intent(in) :: point(2)      !! [length]
    type(closest_point_t) :: closest
    integer :: k

    k = merge(1, 3, xi < 0)
    closest%xi = xi
    closest%normal = right_of(tangent_on(piece, xi))
    closest%d = dot_product(point - piece(:, k), closest%normal)
  end function along_tangent

end module face_points
