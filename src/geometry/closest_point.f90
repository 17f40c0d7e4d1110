!> Closest points on the pieces of a curve and at the vertices between them: where the distance of a point has a minimum.
!>
!> With n the normal to the right of the curve at the closest point Y, the inner normal of a die, d = (X - Y).n is the depth of
!> the point X, negative for a gap. At a vertex the curve may turn away from a point and leave it in the fan of the vertex, between
!> the normals of both pieces: then Y is the vertex and n points along X - Y.
module closest_point
  use kinds, only: eps, wp
  use parabolas, only: curvature_on, point_on, tangent_on
  use plane_vectors, only: cross, right_of
  use vectors, only: length_of
  implicit none
  private
  public :: closest_point_t, stationary_points, closest_within_piece, closest_at_vertex, distance_slope, sense_of_turn, &
            whole_piece, end_slack, past_end

  !> Closest point on a curve; on a die, in the pilot's axes.
  type :: closest_point_t
    !> Its piece, 0 where there is none, and parent coordinate.
    integer :: piece = 0
    real(wp) :: xi = 0.0_wp
    !> Depth of the point, negative for a gap [length].
    real(wp) :: d = 0.0_wp
    !> Unit normal to the right of the curve there.
    real(wp) :: normal(2) = 0.0_wp
    !> Turn of the normal as the point moves along the tangent: dn = turn (t.dX) t [1/length].
    real(wp) :: turn = 0.0_wp
    !> It is the vertex behind its piece, not a point within it.
    logical :: at_vertex = .false.
  end type closest_point_t

  !> Ends of pieces belong to both neighbours, within round-off of xi: coordinates may be 1e5 times a piece.
  real(wp), parameter :: end_slack = 1.0e-10_wp, whole_piece(2) = [-1 - end_slack, 1 + end_slack]
  !> Parent coordinate of what is kept on a piece beyond its end.
  real(wp), parameter :: past_end = 1 + 2*end_slack
  !> Pieces are one smooth curve where their tangents turn by less than this sine: `end_slack` covers the fan.
  real(wp), parameter :: smooth_turn = 1.0e-12_wp

contains

  !> Parent coordinates between two others where the distance of a point is stationary: (Y(xi) - point).Y'(xi) = 0, a cubic.
  pure subroutine stationary_points(piece, point, range, n, xi)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: point(2)      !! [length]
    real(wp), intent(in) :: range(2)      !! least and largest parent coordinate [-]
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(3)   !! the first n, in ascending order [-]
    real(wp) :: a(2), b(2), d(2), c(0:3), bounds(4), delta, q
    integer :: i

    a = 0.5_wp*(piece(:, 1) + piece(:, 3)) - piece(:, 2)
    b = 0.5_wp*(piece(:, 3) - piece(:, 1))
    d = piece(:, 2) - point
    c = [dot_product(d, b), dot_product(b, b) + 2*dot_product(d, a), 3*dot_product(a, b), 2*dot_product(a, a)]
    n = 0
    if (c(3) <= 16*eps*dot_product(b, b)) then
      ! a segment, to round-off
      if (c(0) > -range(1)*dot_product(b, b) .or. -c(0) > range(2)*dot_product(b, b)) return
      n = 1
      xi(1) = -c(0)/dot_product(b, b)
      return
    end if
    ! the cubic is monotone between its extremes: a root in each such interval with a change of sign
    bounds = range([1, 1, 2, 2])
    delta = c(2)**2 - 3*c(3)*c(1)
    if (delta > 0) then
      q = -(c(2) + sign(sqrt(delta), c(2)))
      bounds(2) = min(q/(3*c(3)), c(1)/q)
      bounds(3) = max(q/(3*c(3)), c(1)/q)
      bounds(2:3) = min(max(bounds(2:3), bounds(1)), bounds(4))
    end if
    do i = 1, 3
      if (.not. bounds(i + 1) > bounds(i)) cycle
      if (cubic(bounds(i))*cubic(bounds(i + 1)) > 0) cycle
      n = n + 1
      xi(n) = root_between(bounds(i), bounds(i + 1))
    end do

  contains

    pure function cubic(x) result(value)
      real(wp), intent(in) :: x
      real(wp) :: value

      value = c(0) + x*(c(1) + x*(c(2) + x*c(3)))
    end function cubic

    !> Newton's method kept in the bracket.
    pure function root_between(left, right) result(x)
      real(wp), intent(in) :: left, right
      real(wp) :: x
      real(wp) :: low, high, value, derivative
      integer :: iteration
      integer, parameter :: max_iterations = 80   ! bisection alone reaches round-off in 54

      low = left
      high = right
      x = 0.5_wp*(low + high)
      do iteration = 1, max_iterations
        value = cubic(x)
        if (value*cubic(low) > 0) then
          low = x
        else
          high = x
        end if
        if (high - low <= 2*eps) return
        derivative = c(1) + x*(2*c(2) + 3*c(3)*x)
        if (abs(value) <= 2*eps*abs(derivative)) return
        if (abs(derivative) > 0) x = x - value/derivative
        if (.not. (x > low .and. x < high)) x = 0.5_wp*(low + high)
      end do
    end function root_between

  end subroutine stationary_points

  !> Closest point at a stationary point of a piece; its piece is 0 where the distance has a maximum there.
  pure subroutine closest_within_piece(piece, point, xi, closest)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: point(2)      !! [length]
    real(wp), intent(in) :: xi            !! [-]
    type(closest_point_t), intent(out) :: closest
    real(wp) :: curvature

    curvature = curvature_on(piece, xi)
    closest%piece = 1
    closest%xi = xi
    closest%normal = right_of(tangent_on(piece, xi))
    closest%d = dot_product(point - point_on(piece, xi), closest%normal)
    ! the closest point is a minimum of the distance: not beyond the centre of curvature
    if (1 + curvature*closest%d <= 0) closest%piece = 0
    if (closest%piece > 0) closest%turn = curvature/(1 + curvature*closest%d)
  end subroutine closest_within_piece

  !> Closest point at the vertex between two pieces, when the point lies in its fan.
  pure subroutine closest_at_vertex(before, after, point, closest)
    real(wp), intent(in) :: before(2, 3), after(2, 3)   !! points of the pieces [length]
    real(wp), intent(in) :: point(2)                    !! [length]
    type(closest_point_t), intent(out) :: closest
    real(wp) :: t1(2), t2(2), way(2), side

    t1 = tangent_on(before, 1.0_wp)
    t2 = tangent_on(after, -1.0_wp)
    way = point - before(:, 3)
    if (dot_product(way, t1) < 0 .or. dot_product(way, t2) > 0 .or. .not. length_of(way) > 0) return
    side = sense_of_turn(before, after)
    if (.not. abs(side) > 0) return
    ! a die that turns left (towards the part) has its fan inside, one that turns right outside
    closest%piece = 1
    closest%xi = 1
    closest%at_vertex = .true.
    closest%d = side*length_of(way)
    closest%normal = way/closest%d
    closest%turn = 1/closest%d
  end subroutine closest_at_vertex

  !> The curve turns left (1) or right (-1) at the vertex between two pieces, or goes on smoothly (0).
  !> Where it turns back on itself the curvature of its pieces decides: a slot lies between them when the second is on the left of
  !> the first, else a rib; pieces on one line are a rib without thickness.
  pure function sense_of_turn(before, after) result(sense)
    real(wp), intent(in) :: before(2, 3), after(2, 3)
    real(wp) :: sense
    real(wp) :: t1(2), t2(2), turn

    t1 = tangent_on(before, 1.0_wp)
    t2 = tangent_on(after, -1.0_wp)
    turn = cross(t1, t2)/(length_of(t1)*length_of(t2))
    sense = 0
    if (abs(turn) > smooth_turn) then
      sense = sign(1.0_wp, turn)
    else if (dot_product(t1, t2) < 0) then
      t1 = before(:, 3) - before(:, 2)
      t2 = after(:, 2) - after(:, 1)
      turn = cross(t1, t2)/(length_of(t1)*length_of(t2))
      sense = -1
      if (turn > smooth_turn) sense = 1
    end if
  end function sense_of_turn

  !> Half the derivative of the squared distance along a piece [length^2]: above zero, the distance decreases backwards.
  pure function distance_slope(piece, point, xi) result(slope)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: point(2)      !! [length]
    real(wp), intent(in) :: xi            !! [-]
    real(wp) :: slope

    slope = dot_product(point_on(piece, xi) - point, tangent_on(piece, xi))
  end function distance_slope

end module closest_point
