!> A range of a parabola, or of the curve beside it at a given depth.
!>
!> A point is X(xi) = Y(xi) + d(xi) n(xi): Y is the isoparametric parabola through three points (annex 2, eq. 1, with the
!> sign of its first term corrected), n its unit normal to the right, which is the inner normal of a die, and d the depth,
!> linear in xi and zero on the parabola itself.
module offset_parabolas
  use closest_point, only: stationary_points
  use kinds, only: eps, wp
  use parabolas, only: bend_of, point_on, tangent_on
  use plane_vectors, only: cross, right_of
  use quadrature, only: gauss_line
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: offset_parabola_t, point_at, exact_point, tangent_at, second_of, depth_at, length_between, xi_at_length, closest_xi

  type :: offset_parabola_t
    !> Points of the parabola (2, 3) [length].
    real(wp) :: points(2, 3) = 0.0_wp
    !> First and last parent coordinate, and the depth at each [length].
    real(wp) :: range(2) = [-1.0_wp, 1.0_wp]
    real(wp) :: depth(2) = 0.0_wp
  end type offset_parabola_t

  !> A length is converged when Gauss's rule on the halves and on the whole agree to this share.
  real(wp), parameter :: length_accuracy = 16*eps
  integer, parameter :: most_halvings = 12

contains

  pure function depth_at(arc, xi) result(depth)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: xi
    real(wp) :: depth

    depth = arc%depth(1) + (xi - arc%range(1))*depth_slope(arc)
  end function depth_at

  pure function depth_slope(arc) result(slope)
    class(offset_parabola_t), intent(in) :: arc
    real(wp) :: slope

    slope = 0
    if (abs(arc%depth(2) - arc%depth(1)) > 0) &
      slope = (arc%depth(2) - arc%depth(1))/(arc%range(2) - arc%range(1))
  end function depth_slope

  pure function has_depth(arc) result(yes)
    class(offset_parabola_t), intent(in) :: arc
    logical :: yes

    yes = any(abs(arc%depth) > 0)
  end function has_depth

  !> Point of an arc [length].
  pure function point_at(arc, xi) result(point)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: xi
    real(wp) :: point(2)
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    point = matmul(arc%points, phi)
    if (has_depth(arc)) point = point + depth_at(arc, xi) &
                                    *right_of(0.5_wp*(arc%points(:, 3) - arc%points(:, 1)) + xi*second_of(arc))
  end function point_at

  !> The same; an arc along X or Y keeps its other coordinate to the last bit, as axes and symmetry lines must.
  pure function exact_point(arc, xi) result(x)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: xi
    real(wp) :: x(2)
    integer :: i

    x = point_at(arc, xi)
    if (any(abs(arc%depth) > 0)) return
    do i = 1, 2
      if (maxval(arc%points(i, :)) > minval(arc%points(i, :))) cycle
      x(i) = arc%points(i, 1)
    end do
  end function exact_point

  !> dX/dxi. The normal turns against the tangent: dn/dxi = (Y' x Y'')/|Y'|**3 Y'.
  pure function tangent_at(arc, xi) result(tangent)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: xi
    real(wp) :: tangent(2)
    real(wp) :: first(2)

    ! by differences of the points, to avoid cancellation on a side far from the origin
    tangent = 0.5_wp*(arc%points(:, 3) - arc%points(:, 1)) + xi*second_of(arc)
    if (.not. has_depth(arc)) return
    first = tangent
    tangent = first*(1 + depth_at(arc, xi)*cross(first, second_of(arc))/length_of(first)**3) &
              + depth_slope(arc)*right_of(first)
  end function tangent_at

  pure function second_of(arc) result(second)
    class(offset_parabola_t), intent(in) :: arc
    real(wp) :: second(2)

    second = (arc%points(:, 1) - arc%points(:, 2)) + (arc%points(:, 3) - arc%points(:, 2))
  end function second_of

  !> Arc length between two parent coordinates [length]: Gauss's rule, with bisection until it converges.
  pure function length_between(arc, from, to) result(length)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: from, to
    real(wp) :: length
    real(wp), allocatable :: x(:), w(:)

    call gauss_line(4, x, w)
    length = measured(from, to, by_rule(from, to), most_halvings)

  contains

    pure recursive function measured(a, b, whole, halvings) result(sum)
      real(wp), intent(in) :: a, b, whole
      integer, intent(in) :: halvings
      real(wp) :: sum
      real(wp) :: middle, left, right

      middle = 0.5_wp*(a + b)
      left = by_rule(a, middle)
      right = by_rule(middle, b)
      sum = left + right
      if (abs(sum - whole) <= length_accuracy*sum .or. halvings == 0) return
      sum = measured(a, middle, left, halvings - 1) + measured(middle, b, right, halvings - 1)
    end function measured

    pure function by_rule(a, b) result(sum)
      real(wp), intent(in) :: a, b
      real(wp) :: sum
      integer :: i

      sum = 0
      do i = 1, size(x)
        sum = sum + 0.5_wp*(b - a)*w(i)*length_of(tangent_at(arc, 0.5_wp*(a + b) + 0.5_wp*(b - a)*x(i)))
      end do
    end function by_rule

  end function length_between

  !> Parent coordinate at a given arc length from the start: Newton's method safeguarded by a bracket.
  pure function xi_at_length(arc, length) result(xi)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: length
    real(wp) :: xi
    real(wp) :: low, high, excess, speed
    integer :: iteration
    integer, parameter :: most_iterations = 80   ! halving alone reaches round-off in 54

    low = arc%range(1)
    high = arc%range(2)
    xi = low + (high - low)*min(max(length/length_between(arc, low, high), 0.0_wp), 1.0_wp)
    do iteration = 1, most_iterations
      excess = length_between(arc, arc%range(1), xi) - length
      if (excess > 0) then
        high = xi
      else
        low = xi
      end if
      speed = length_of(tangent_at(arc, xi))
      if (abs(excess) <= 2*eps*speed .or. high - low <= 2*eps) return
      xi = xi - excess/speed
      if (.not. (xi >= low .and. xi <= high)) xi = 0.5_wp*(low + high)
    end do
  end function xi_at_length

  !> Parent coordinate of the point closest to a target. A constant depth does not change the stationary points of the parabola
  !> itself, a variable one shifts them slightly.
  pure function closest_xi(arc, target) result(best)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: target(2)   !! [length]
    real(wp) :: best
    real(wp) :: xi(3), candidates(5)
    integer :: i, n

    candidates(1:2) = arc%range
    call stationary_points(arc%points, target, arc%range, n, xi)
    do i = 1, n
      candidates(i + 2) = closest_at_depth(arc, target, refined(xi(i)))
    end do
    best = candidates(1)
    do i = 2, n + 2
      if (length_of(point_at(arc, candidates(i)) - target) < length_of(point_at(arc, best) - target)) best = candidates(i)
    end do
  contains

    !> A stationary point of a parabola that is nearly a segment is found to first order in its curvature: Newton's method.
    pure function refined(start) result(x)
      real(wp), intent(in) :: start
      real(wp) :: x
      real(wp) :: second
      integer :: iteration
      integer, parameter :: iterations = 2   ! from 1e-8, the square root of what counts as a segment, to round-off

      x = start
      do iteration = 1, iterations
        associate (y => point_on(arc%points, x), first => tangent_on(arc%points, x))
          second = dot_product(first, first) + dot_product(y - target, bend_of(arc%points))
          if (.not. second > 0) return
          x = min(max(x - dot_product(y - target, first)/second, arc%range(1)), arc%range(2))
        end associate
      end do
    end function refined

  end function closest_xi

  !> Closest point on the parabola moved to the closest point on the arc at its depth: Gauss-Newton method for least squares.
  pure function closest_at_depth(arc, target, start) result(xi)
    class(offset_parabola_t), intent(in) :: arc
    real(wp), intent(in) :: target(2), start
    real(wp) :: xi
    real(wp) :: tangent(2), step
    integer :: iteration
    integer, parameter :: most_iterations = 30

    xi = start
    if (.not. abs(arc%depth(2) - arc%depth(1)) > 0) return
    do iteration = 1, most_iterations
      tangent = tangent_at(arc, xi)
      step = dot_product(target - point_at(arc, xi), tangent)/dot_product(tangent, tangent)
      xi = min(max(xi + step, arc%range(1)), arc%range(2))
      if (abs(step) <= 2*eps) return
    end do
  end function closest_at_depth

end module offset_parabolas
