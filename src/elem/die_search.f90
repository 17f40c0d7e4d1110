!> The point of a die closest to a point of the part.
!>
!> The die's chain is oriented, so the side a point is on is known: with n the die's inner normal at
!> the closest point Y, d = (X - Y).n is the penetration, negative for a gap. Depth so measured is
!> continuous wherever the part's side turns, and linear in front of a flat die; the original
!> (annex 3, figs. 3-5) looks along the part's own normal instead, where a foot can appear at any
!> depth and several may compete. Only feet that face the part count (true contact, eq. 11): with
!> e_R the part's inner normal, e_R.n must be below `facing`.
!>
!> At a vertex the chain may turn away from a point and leave it in the fan of the vertex: then Y is
!> the vertex and n points along X - Y. Beyond the ends of the chain there is no die.
module die_search
  use dies, only: die_t
  use kinds, only: eps, wp
  implicit none
  private
  public :: foot_t, find_foot, find_foot_on, box_distance

  !> Foot of a point on a die, in the pilot's axes.
  type :: foot_t
    !> Piece met, 0 when none is; its parent coordinate.
    integer :: piece = 0
    real(wp) :: xi = 0.0_wp
    !> Penetration, negative for a gap [length].
    real(wp) :: d = 0.0_wp
    !> Inner normal of the die there.
    real(wp) :: normal(2) = 0.0_wp
    !> Turn of the normal as the point moves along the tangent: dn = turn (t.dX) t [1/length].
    real(wp) :: turn = 0.0_wp
  end type foot_t

  !> A side that faces away by less than this cosine may still lie on the die: a side that folds.
  real(wp), parameter :: facing = 0.9_wp
  !> Ends of pieces belong to both neighbours, within round-off of xi: coordinates may be 1e5 times a piece.
  real(wp), parameter :: end_slack = 1.0e-10_wp
  !> Pieces are one smooth curve where their tangents turn by less than this sine: `end_slack` covers the fan.
  real(wp), parameter :: smooth_turn = 1.0e-12_wp

contains

  !> Foot of a point, within `reach`.
  pure subroutine find_foot(die, point, e_r, reach, foot)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)     !! inner normal of the part, in the pilot's axes
    real(wp), intent(in) :: reach      !! [length]
    type(foot_t), intent(out) :: foot
    type(foot_t) :: candidate
    real(wp) :: xi(3), best
    integer :: k, r, n, npiece

    best = reach
    npiece = size(die%pieces, 3)
    do k = 1, npiece
      if (any(die%boxes(1:2, k) - best > point) .or. any(die%boxes(3:4, k) + best < point)) cycle
      call projections(die%pieces(:, :, k), point, n, xi)
      do r = 1, n
        call foot_inside(die%pieces(:, :, k), point, xi(r), candidate)
        call take(candidate, k, e_r, best, foot)
      end do
      if (k == npiece) cycle
      call foot_at_vertex(die%pieces(:, :, k), die%pieces(:, :, k + 1), point, candidate)
      call take(candidate, k, e_r, best, foot)
    end do
  end subroutine find_foot

  !> Foot of a point on one piece, or up to `beyond` outside its ends; sought from the end of the piece nearest to `from`.
  pure subroutine find_foot_on(die, piece, point, from, beyond, foot)
    type(die_t), intent(in) :: die
    integer, intent(in) :: piece
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: from, beyond   !! parent coordinates
    type(foot_t), intent(out) :: foot
    real(wp) :: xi, step, way(2), first(2), second(2), y(2)
    integer :: iteration
    integer, parameter :: max_iterations = 20   ! quadratic convergence from close by takes four or five

    xi = min(max(from, -1.0_wp), 1.0_wp)
    associate (x => die%pieces(:, :, piece))
      second = x(:, 1) - 2*x(:, 2) + x(:, 3)
      do iteration = 1, max_iterations
        first = tangent_at(x, xi)
        y = 0.5_wp*xi*(xi - 1)*x(:, 1) + (1 - xi*xi)*x(:, 2) + 0.5_wp*xi*(xi + 1)*x(:, 3)
        way = y - point
        step = -dot_product(way, first)/(dot_product(first, first) + dot_product(way, second))
        xi = xi + step
        if (.not. abs(xi) <= 1 + beyond) return
        if (abs(step) <= 4*eps) exit
      end do
      if (iteration > max_iterations .and. abs(step) > end_slack) return
      call foot_inside(x, point, xi, foot)
    end associate
    if (foot%piece > 0) foot%piece = piece
  end subroutine find_foot_on

  !> The nearer of two feet that face the part.
  pure subroutine take(candidate, piece, e_r, best, foot)
    type(foot_t), intent(in) :: candidate
    integer, intent(in) :: piece
    real(wp), intent(in) :: e_r(2)
    real(wp), intent(inout) :: best
    type(foot_t), intent(inout) :: foot

    if (candidate%piece == 0) return
    if (abs(candidate%d) >= best .or. dot_product(candidate%normal, e_r) > facing) return
    best = abs(candidate%d)
    foot = candidate
    foot%piece = piece
  end subroutine take

  !> Parent coordinates in [-1, 1] where (Y(xi) - point).Y'(xi) = 0, a cubic.
  pure subroutine projections(piece, point, n, xi)
    real(wp), intent(in) :: piece(2, 3), point(2)
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(3)
    real(wp) :: a(2), b(2), d(2), c(0:3), knots(4), delta, q
    integer :: i

    a = 0.5_wp*(piece(:, 1) + piece(:, 3)) - piece(:, 2)
    b = 0.5_wp*(piece(:, 3) - piece(:, 1))
    d = piece(:, 2) - point
    c = [dot_product(d, b), dot_product(b, b) + 2*dot_product(d, a), 3*dot_product(a, b), 2*dot_product(a, a)]
    n = 0
    if (c(3) <= 16*eps*dot_product(b, b)) then
      ! a segment, to round-off
      if (abs(c(0)) > (1 + end_slack)*dot_product(b, b)) return
      n = 1
      xi(1) = -c(0)/dot_product(b, b)
      return
    end if
    ! the cubic is monotone between its extremes: a root in each such interval with a change of sign
    knots = [-1 - end_slack, -1 - end_slack, 1 + end_slack, 1 + end_slack]
    delta = c(2)**2 - 3*c(3)*c(1)
    if (delta > 0) then
      q = -(c(2) + sign(sqrt(delta), c(2)))
      knots(2) = min(q/(3*c(3)), c(1)/q)
      knots(3) = max(q/(3*c(3)), c(1)/q)
      knots(2:3) = min(max(knots(2:3), knots(1)), knots(4))
    end if
    do i = 1, 3
      if (.not. knots(i + 1) > knots(i)) cycle
      if (cubic(knots(i))*cubic(knots(i + 1)) > 0) cycle
      n = n + 1
      xi(n) = root_between(knots(i), knots(i + 1))
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

  end subroutine projections

  !> Foot on a piece.
  pure subroutine foot_inside(piece, point, xi, foot)
    real(wp), intent(in) :: piece(2, 3), point(2), xi
    type(foot_t), intent(out) :: foot
    real(wp) :: y(2), first(2), second(2), curvature

    y = 0.5_wp*xi*(xi - 1)*piece(:, 1) + (1 - xi*xi)*piece(:, 2) + 0.5_wp*xi*(xi + 1)*piece(:, 3)
    first = tangent_at(piece, xi)
    second = piece(:, 1) - 2*piece(:, 2) + piece(:, 3)
    curvature = cross(first, second)/norm2(first)**3
    foot%piece = 1
    foot%xi = xi
    foot%normal = right_of(first)
    foot%d = dot_product(point - y, foot%normal)
    ! the closest point is a minimum of the distance: not beyond the centre of curvature
    if (1 + curvature*foot%d <= 0) foot%piece = 0
    if (foot%piece > 0) foot%turn = curvature/(1 + curvature*foot%d)
  end subroutine foot_inside

  !> Foot at the vertex between two pieces, when the point lies in its fan.
  pure subroutine foot_at_vertex(before, after, point, foot)
    real(wp), intent(in) :: before(2, 3), after(2, 3), point(2)
    type(foot_t), intent(out) :: foot
    real(wp) :: t1(2), t2(2), way(2), turn, side

    t1 = tangent_at(before, 1.0_wp)
    t2 = tangent_at(after, -1.0_wp)
    turn = cross(t1, t2)/(norm2(t1)*norm2(t2))
    if (abs(turn) <= smooth_turn) return
    way = point - before(:, 3)
    if (dot_product(way, t1) < 0 .or. dot_product(way, t2) > 0 .or. .not. norm2(way) > 0) return
    ! a die that turns left (towards the part) has its fan inside, one that turns right outside
    side = sign(1.0_wp, turn)
    foot%piece = 1
    foot%xi = 1
    foot%d = side*norm2(way)
    foot%normal = way/foot%d
    foot%turn = 1/foot%d
  end subroutine foot_at_vertex

  pure function tangent_at(piece, xi) result(tangent)
    real(wp), intent(in) :: piece(2, 3), xi
    real(wp) :: tangent(2)

    tangent = (xi - 0.5_wp)*piece(:, 1) - 2*xi*piece(:, 2) + (xi + 0.5_wp)*piece(:, 3)
  end function tangent_at

  !> Unit vector to the right of a direction: the die's inner normal.
  pure function right_of(v) result(n)
    real(wp), intent(in) :: v(2)
    real(wp) :: n(2)

    n = [v(2), -v(1)]/norm2(v)
  end function right_of

  pure function cross(a, b) result(c)
    real(wp), intent(in) :: a(2), b(2)
    real(wp) :: c

    c = a(1)*b(2) - a(2)*b(1)
  end function cross

  !> Distance from a box (xmin, ymin, xmax, ymax) to the boxes of a die, in the pilot's axes; 0 when they meet.
  pure function box_distance(die, box) result(distance)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: box(4)
    real(wp) :: distance
    integer :: k

    distance = huge(1.0_wp)
    do k = 1, size(die%boxes, 2)
      distance = min(distance, norm2(max(die%boxes(1:2, k) - box(3:4), box(1:2) - die%boxes(3:4, k), 0.0_wp)))
    end do
  end function box_distance

end module die_search
