!> Stretches of the contour: a range of the part's parabola, or of a die's at a depth.
!>
!> A point of a stretch is X(xi) = Y(xi) + d(xi) n(xi): Y is the isoparametric parabola through three points (annex 2, eq. 1,
!> with the sign of its first term corrected), n its unit normal to the right, which is the inner normal of a die, and d the
!> depth, linear in xi along the stretch and zero on the part's own parabolas. Part and die are both walked with the part
!> on the left, so xi runs with the contour on either.
module stretches
  use kinds, only: eps, wp
  use quadrature, only: line_rule
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: stretch_t, point_at, tangent_at, depth_at, cut, straight, length_between, xi_at_length, turning_places, closest_xi
  public :: cross, second_of

  type :: stretch_t
    !> Points of the parabola (2, 3) [length].
    real(wp) :: points(2, 3) = 0.0_wp
    !> First and last parent coordinate, and the depth at each [length].
    real(wp) :: range(2) = [-1.0_wp, 1.0_wp]
    real(wp) :: depth(2) = 0.0_wp
    !> Middle node of the part's side, 0 on a die.
    integer :: middle = 0
    !> Side of the loop: the one it is a part of, or the first one it stands for.
    integer :: side = 0
    !> Die and piece of it, 0 on the part; contact group and run of contact (contact_runs), 0 on free sides.
    integer :: die = 0, piece = 0, group = 0, run = 0
  end type stretch_t

  !> Gauss's rule on halves and on the whole agree to this share when a length is taken for exact.
  real(wp), parameter :: length_accuracy = 16*eps
  integer, parameter :: most_halvings = 12
  !> A depth bends a stretch so little that this many intervals separate the places where it turns.
  integer, parameter :: intervals = 8

contains

  pure function depth_at(stretch, xi) result(depth)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: xi
    real(wp) :: depth

    depth = stretch%depth(1) + (xi - stretch%range(1))*depth_slope(stretch)
  end function depth_at

  pure function depth_slope(stretch) result(slope)
    type(stretch_t), intent(in) :: stretch
    real(wp) :: slope

    slope = 0
    if (abs(stretch%depth(2) - stretch%depth(1)) > 0) &
      slope = (stretch%depth(2) - stretch%depth(1))/(stretch%range(2) - stretch%range(1))
  end function depth_slope

  pure function has_depth(stretch) result(yes)
    type(stretch_t), intent(in) :: stretch
    logical :: yes

    yes = any(abs(stretch%depth) > 0)
  end function has_depth

  !> Point of a stretch [length].
  pure function point_at(stretch, xi) result(point)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: xi
    real(wp) :: point(2)
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    point = matmul(stretch%points, phi)
    if (has_depth(stretch)) point = point + depth_at(stretch, xi) &
                                    *right_of(0.5_wp*(stretch%points(:, 3) - stretch%points(:, 1)) + xi*second_of(stretch))
  end function point_at

  !> dX/dxi. The normal turns against the tangent: dn/dxi = (Y' x Y'')/|Y'|**3 Y'.
  pure function tangent_at(stretch, xi) result(tangent)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: xi
    real(wp) :: tangent(2)
    real(wp) :: first(2)

    ! by differences of the points, so that a side far from the origin keeps its digits
    tangent = 0.5_wp*(stretch%points(:, 3) - stretch%points(:, 1)) + xi*second_of(stretch)
    if (.not. has_depth(stretch)) return
    first = tangent
    tangent = first*(1 + depth_at(stretch, xi)*cross(first, second_of(stretch))/length_of(first)**3) &
              + depth_slope(stretch)*right_of(first)
  end function tangent_at

  pure function second_of(stretch) result(second)
    type(stretch_t), intent(in) :: stretch
    real(wp) :: second(2)

    second = (stretch%points(:, 1) - stretch%points(:, 2)) + (stretch%points(:, 3) - stretch%points(:, 2))
  end function second_of

  !> The same curve between other ends; its depth goes on in a straight line.
  pure function cut(stretch, first, last) result(shorter)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: first, last
    type(stretch_t) :: shorter

    shorter = stretch
    shorter%range = [first, last]
    shorter%depth = [depth_at(stretch, first), depth_at(stretch, last)]
  end function cut

  !> A straight stretch between two points.
  pure function straight(from, to) result(stretch)
    real(wp), intent(in) :: from(2), to(2)
    type(stretch_t) :: stretch

    stretch%points(:, 1) = from
    stretch%points(:, 2) = 0.5_wp*(from + to)
    stretch%points(:, 3) = to
  end function straight

  !> Arc length from one place to a later one [length]: Gauss's rule, halved until it no longer changes.
  pure function length_between(stretch, from, to) result(length)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: from, to
    real(wp) :: length
    real(wp), allocatable :: x(:), w(:)

    call line_rule(4, x, w)
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
        sum = sum + 0.5_wp*(b - a)*w(i)*length_of(tangent_at(stretch, 0.5_wp*(a + b) + 0.5_wp*(b - a)*x(i)))
      end do
    end function by_rule

  end function length_between

  !> Parent coordinate at a length from the start of the stretch: Newton's method kept in the bracket.
  pure function xi_at_length(stretch, length) result(xi)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: length
    real(wp) :: xi
    real(wp) :: low, high, excess, speed
    integer :: iteration
    integer, parameter :: most_iterations = 80   ! halving alone reaches round-off in 54

    low = stretch%range(1)
    high = stretch%range(2)
    xi = low + (high - low)*min(max(length/length_between(stretch, low, high), 0.0_wp), 1.0_wp)
    do iteration = 1, most_iterations
      excess = length_between(stretch, stretch%range(1), xi) - length
      if (excess > 0) then
        high = xi
      else
        low = xi
      end if
      speed = length_of(tangent_at(stretch, xi))
      if (abs(excess) <= 2*eps*speed .or. high - low <= 2*eps) return
      xi = xi - excess/speed
      if (.not. (xi >= low .and. xi <= high)) xi = 0.5_wp*(low + high)
    end do
  end function xi_at_length

  !> Places inside the stretch where it runs across the axis (1: X, 2: Y), so that this coordinate turns back, in order.
  pure subroutine turning_places(stretch, axis, n, xi)
    type(stretch_t), intent(in) :: stretch
    integer, intent(in) :: axis
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(:)   !! (3) at least
    real(wp) :: t(2), a, b, middle
    integer :: i, halving

    n = 0
    if (.not. has_depth(stretch)) then
      associate (p => stretch%points(axis, :), second => second_of(stretch))
        if (abs(second(axis))*maxval(abs(stretch%range)) <= 0.5_wp*abs(p(3) - p(1))) return
        xi(1) = -0.5_wp*(p(3) - p(1))/second(axis)
      end associate
      if (xi(1) > stretch%range(1) .and. xi(1) < stretch%range(2)) n = 1
      return
    end if
    do i = 1, intervals
      a = stretch%range(1) + (stretch%range(2) - stretch%range(1))*(i - 1)/intervals
      b = stretch%range(1) + (stretch%range(2) - stretch%range(1))*i/intervals
      if (.not. slope(a)*slope(b) < 0 .or. n == size(xi)) cycle
      t = [a, b]
      do halving = 1, digits(1.0_wp)
        middle = 0.5_wp*(t(1) + t(2))
        t(merge(1, 2, slope(middle)*slope(a) > 0)) = middle
      end do
      n = n + 1
      xi(n) = 0.5_wp*(t(1) + t(2))
    end do

  contains

    pure function slope(x) result(value)
      real(wp), intent(in) :: x
      real(wp) :: value
      real(wp) :: tangent(2)

      tangent = tangent_at(stretch, x)
      value = tangent(axis)
    end function slope

  end subroutine turning_places

  !> Parent coordinate of the point closest to a target. On the parabola itself (Y - target).Y' = 0 is a cubic, monotone
  !> between its extremes; a constant depth leaves its roots where they are, one that varies moves them a little.
  pure function closest_xi(stretch, target) result(best)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: target(2)
    real(wp) :: best
    real(wp) :: a(2), b(2), d(2), c(0:3), knots(4), delta, q, candidates(5)
    integer :: i, n

    a = 0.5_wp*second_of(stretch)
    b = 0.5_wp*(stretch%points(:, 3) - stretch%points(:, 1))
    d = stretch%points(:, 2) - target
    c = [dot_product(d, b), dot_product(b, b) + 2*dot_product(d, a), 3*dot_product(a, b), 2*dot_product(a, a)]
    knots = stretch%range([1, 1, 2, 2])
    delta = c(2)**2 - 3*c(3)*c(1)
    if (delta > 0) then
      q = -(c(2) + sign(sqrt(delta), c(2)))
      if (abs(q) > 0) knots(2:3) = c(1)/q
      if (c(3) > 16*eps*dot_product(b, b)) knots(3) = q/(3*c(3))
      knots(2:3) = min(max([minval(knots(2:3)), maxval(knots(2:3))], knots(1)), knots(4))
    end if
    candidates(1:2) = stretch%range
    n = 2
    do i = 1, 3
      if (.not. knots(i + 1) > knots(i) .or. climb(knots(i))*climb(knots(i + 1)) > 0) cycle
      n = n + 1
      candidates(n) = settled(stretch, target, root(knots(i), knots(i + 1)))
    end do
    best = candidates(1)
    do i = 2, n
      if (length_of(point_at(stretch, candidates(i)) - target) < length_of(point_at(stretch, best) - target)) best = candidates(i)
    end do

  contains

    pure function climb(x) result(value)
      real(wp), intent(in) :: x
      real(wp) :: value

      value = c(0) + x*(c(1) + x*(c(2) + x*c(3)))
    end function climb

    pure function root(left, right) result(x)
      real(wp), intent(in) :: left, right
      real(wp) :: x
      real(wp) :: low, high
      integer :: halving

      low = left
      high = right
      do halving = 1, digits(1.0_wp) + 2
        x = 0.5_wp*(low + high)
        if (climb(x)*climb(left) > 0) then
          low = x
        else
          high = x
        end if
      end do
    end function root

  end function closest_xi

  !> A foot on the parabola moved to where the stretch with its depth is closest: Gauss and Newton's method for least squares.
  pure function settled(stretch, target, start) result(xi)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: target(2), start
    real(wp) :: xi
    real(wp) :: tangent(2), step
    integer :: iteration
    integer, parameter :: most_iterations = 30

    xi = start
    if (.not. abs(stretch%depth(2) - stretch%depth(1)) > 0) return
    do iteration = 1, most_iterations
      tangent = tangent_at(stretch, xi)
      step = dot_product(target - point_at(stretch, xi), tangent)/dot_product(tangent, tangent)
      xi = min(max(xi + step, stretch%range(1)), stretch%range(2))
      if (abs(step) <= 2*eps) return
    end do
  end function settled

  !> Unit vector to the right of a direction.
  pure function right_of(v) result(n)
    real(wp), intent(in) :: v(2)
    real(wp) :: n(2)

    n = [v(2), -v(1)]/length_of(v)
  end function right_of

  pure function cross(a, b) result(c)
    real(wp), intent(in) :: a(2), b(2)
    real(wp) :: c

    c = a(1)*b(2) - a(2)*b(1)
  end function cross

end module stretches
