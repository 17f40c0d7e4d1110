!> Arcs of the contour: a range of a parabola of the part, or of a die at a given depth.
!>
!> A point of an arc is X(xi) = Y(xi) + d(xi) n(xi): Y is the isoparametric parabola through three points (annex 2, eq. 1, with the
!> sign of its first term corrected), n its unit normal to the right, which is the inner normal of a die, and d the depth, linear in
!> xi along the arc and zero on the part's own parabolas. Part and die are both traversed with the part on the left, so that xi
!> increases along the contour on either.
module arcs
  use kinds, only: eps, wp
  use quadrature, only: gauss_line
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: arc_t, point_at, tangent_at, depth_at, cut, straight, length_between, xi_at_length, closest_xi, exact_point
  public :: cross, second_of

  type :: arc_t
    !> Points of the parabola (2, 3) [length].
    real(wp) :: points(2, 3) = 0.0_wp
    !> First and last parent coordinate, and the depth at each [length].
    real(wp) :: range(2) = [-1.0_wp, 1.0_wp]
    real(wp) :: depth(2) = 0.0_wp
    !> Middle node of the part's side, 0 on a die.
    integer :: middle = 0
    !> Side of the loop that the arc is part of, or the first side of the loop that it replaces.
    integer :: side = 0
    !> Die and piece of it, 0 on the part; contact group and contact interval (contact_intervals), 0 on free sides.
    integer :: die = 0, piece = 0, group = 0, interval = 0
  end type arc_t

  !> A length is converged when Gauss's rule on the halves and on the whole agree to this share.
  real(wp), parameter :: length_accuracy = 16*eps
  integer, parameter :: most_halvings = 12

contains

  pure function depth_at(arc, xi) result(depth)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: xi
    real(wp) :: depth

    depth = arc%depth(1) + (xi - arc%range(1))*depth_slope(arc)
  end function depth_at

  pure function depth_slope(arc) result(slope)
    type(arc_t), intent(in) :: arc
    real(wp) :: slope

    slope = 0
    if (abs(arc%depth(2) - arc%depth(1)) > 0) &
      slope = (arc%depth(2) - arc%depth(1))/(arc%range(2) - arc%range(1))
  end function depth_slope

  pure function has_depth(arc) result(yes)
    type(arc_t), intent(in) :: arc
    logical :: yes

    yes = any(abs(arc%depth) > 0)
  end function has_depth

  !> Point of an arc [length].
  pure function point_at(arc, xi) result(point)
    type(arc_t), intent(in) :: arc
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
    type(arc_t), intent(in) :: arc
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
    type(arc_t), intent(in) :: arc
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
    type(arc_t), intent(in) :: arc
    real(wp) :: second(2)

    second = (arc%points(:, 1) - arc%points(:, 2)) + (arc%points(:, 3) - arc%points(:, 2))
  end function second_of

  !> The same curve between other ends; its depth is extrapolated linearly.
  pure function cut(arc, first, last) result(shorter)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: first, last
    type(arc_t) :: shorter

    shorter = arc
    shorter%range = [first, last]
    shorter%depth = [depth_at(arc, first), depth_at(arc, last)]
  end function cut

  !> A straight arc between two points.
  pure function straight(from, to) result(arc)
    real(wp), intent(in) :: from(2), to(2)   !! [length]
    type(arc_t) :: arc

    arc%points(:, 1) = from
    arc%points(:, 2) = 0.5_wp*(from + to)
    arc%points(:, 3) = to
  end function straight

  !> Arc length between two parent coordinates [length]: Gauss's rule, with bisection until it converges.
  pure function length_between(arc, from, to) result(length)
    type(arc_t), intent(in) :: arc
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
    type(arc_t), intent(in) :: arc
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

  !> Parent coordinate of the point closest to a target. On the parabola itself (Y - target).Y' = 0 is a cubic, monotone
  !> between its extremes; a constant depth does not change its roots, a variable one shifts them slightly.
  pure function closest_xi(arc, target) result(best)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: target(2)   !! [length]
    real(wp) :: best
    real(wp) :: a(2), b(2), d(2), c(0:3), bounds(4), delta, q, candidates(5)
    integer :: i, n

    a = 0.5_wp*second_of(arc)
    b = 0.5_wp*(arc%points(:, 3) - arc%points(:, 1))
    d = arc%points(:, 2) - target
    c = [dot_product(d, b), dot_product(b, b) + 2*dot_product(d, a), 3*dot_product(a, b), 2*dot_product(a, a)]
    bounds = arc%range([1, 1, 2, 2])
    delta = c(2)**2 - 3*c(3)*c(1)
    if (delta > 0) then
      q = -(c(2) + sign(sqrt(delta), c(2)))
      if (abs(q) > 0) bounds(2:3) = c(1)/q
      if (c(3) > 16*eps*dot_product(b, b)) bounds(3) = q/(3*c(3))
      bounds(2:3) = min(max([minval(bounds(2:3)), maxval(bounds(2:3))], bounds(1)), bounds(4))
    end if
    candidates(1:2) = arc%range
    n = 2
    do i = 1, 3
      if (.not. bounds(i + 1) > bounds(i) .or. derivative(bounds(i))*derivative(bounds(i + 1)) > 0) cycle
      n = n + 1
      candidates(n) = closest_at_depth(arc, target, root(bounds(i), bounds(i + 1)))
    end do
    best = candidates(1)
    do i = 2, n
      if (length_of(point_at(arc, candidates(i)) - target) < length_of(point_at(arc, best) - target)) best = candidates(i)
    end do

  contains

    pure function derivative(x) result(value)
      real(wp), intent(in) :: x
      real(wp) :: value

      value = c(0) + x*(c(1) + x*(c(2) + x*c(3)))
    end function derivative

    pure function root(left, right) result(x)
      real(wp), intent(in) :: left, right
      real(wp) :: x
      real(wp) :: low, high
      integer :: halving

      low = left
      high = right
      do halving = 1, digits(1.0_wp) + 2
        x = 0.5_wp*(low + high)
        if (derivative(x)*derivative(left) > 0) then
          low = x
        else
          high = x
        end if
      end do
    end function root

  end function closest_xi

  !> Closest point on the parabola moved to the closest point on the arc at its depth: Gauss-Newton method for least squares.
  pure function closest_at_depth(arc, target, start) result(xi)
    type(arc_t), intent(in) :: arc
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

  !> Unit vector to the right of a direction.
  pure function right_of(v) result(n)
    real(wp), intent(in) :: v(2)
    real(wp) :: n(2)

    n = [v(2), -v(1)]/length_of(v)
  end function right_of

  pure function cross(a, b) result(c)
    real(wp), intent(in) :: a(2), b(2)   !! of one unit, e.g. [length]
    real(wp) :: c

    c = a(1)*b(2) - a(2)*b(1)
  end function cross

end module arcs
