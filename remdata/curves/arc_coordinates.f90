!> Where the coordinate X or Y has a given value on an arc: the quadratic of annex 2, section 3 c, eq. 1.
!>
!> An arc is divided at the points where its tangent is perpendicular to the axis; between two of them the coordinate is monotone
!> and has one root at most. Only roots in the arc's own range of xi count: near an end of contact this is the comparison of xi with
!> that of the end on the parabola of the part and on that of the die (fig. 5).
module arc_coordinates
  use arcs, only: arc_t
  use kinds, only: eps, wp
  use offset_parabolas, only: exact_point, point_at, second_of, tangent_at
  implicit none
  private
  public :: turning_points, xi_at_coordinate, crossings_of_arc, most_crossings

  !> A depth bends an arc so little that this many intervals separate its turning points.
  integer, parameter :: intervals = 8
  !> Turning points of an arc, and crossings with a line: two for each part between them.
  integer, parameter :: most_turning_points = 3, most_crossings = 2*(most_turning_points + 1)

contains

  !> Where an arc meets the line on which a coordinate has a value; where it lies on the line, both ends of the part that does.
  pure subroutine crossings_of_arc(arc, axis, value, slack, n, xi)
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: axis      !! 1: X, 2: Y
    real(wp), intent(in) :: value    !! [length]
    real(wp), intent(in) :: slack    !! tolerance at the ends of a part [length]
    integer, intent(out) :: n        !! number of crossings; a simple one is listed twice
    real(wp), intent(out) :: xi(:)   !! (most_crossings) parent coordinates [-]
    real(wp) :: turns(most_turning_points), bounds(most_turning_points + 2), ends(2, 2), low, high
    integer :: i, nturn

    n = 0
    call turning_points(arc, axis, nturn, turns)
    bounds(1) = arc%range(1)
    bounds(2:nturn + 1) = turns(:nturn)
    bounds(nturn + 2) = arc%range(2)
    do i = 1, nturn + 1
      ends(:, 1) = exact_point(arc, bounds(i))
      ends(:, 2) = exact_point(arc, bounds(i + 1))
      low = minval(ends(axis, :))
      high = maxval(ends(axis, :))
      if (value < low - slack .or. value > high + slack) cycle
      xi(n + 1:n + 2) = bounds(i:i + 1)
      if (high - low > slack) &
        xi(n + 1:n + 2) = xi_at_coordinate(arc, axis, min(max(value, low), high), bounds(i), bounds(i + 1))
      n = n + 2
    end do
  end subroutine crossings_of_arc

  !> Points inside an arc at which its tangent is perpendicular to an axis (1: X, 2: Y), where this coordinate turns back, in order.
  pure subroutine turning_points(arc, axis, n, xi)
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: axis
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(:)   !! (most_turning_points) parent coordinates [-]
    real(wp) :: t(2), a, b, middle
    integer :: i, halving

    n = 0
    if (.not. any(abs(arc%depth) > 0)) then
      associate (p => arc%points(axis, :), second => second_of(arc))
        if (abs(second(axis))*maxval(abs(arc%range)) <= 0.5_wp*abs(p(3) - p(1))) return
        xi(1) = -0.5_wp*(p(3) - p(1))/second(axis)
      end associate
      if (xi(1) > arc%range(1) .and. xi(1) < arc%range(2)) n = 1
      return
    end if
    do i = 1, intervals
      a = arc%range(1) + (arc%range(2) - arc%range(1))*(i - 1)/intervals
      b = arc%range(1) + (arc%range(2) - arc%range(1))*i/intervals
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

      tangent = tangent_at(arc, x)
      value = tangent(axis)
    end function slope

  end subroutine turning_points

  pure function coordinate(arc, axis, xi) result(value)
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: axis
    real(wp), intent(in) :: xi
    real(wp) :: value
    real(wp) :: point(2)

    point = point_at(arc, xi)
    value = point(axis)
  end function coordinate

  !> Parent coordinate between two others where a coordinate, monotone between them, has a value: the quadratic of annex 2, eq. 1,
  !> with the sign of its first term corrected; at a depth its root is the start of Newton's method safeguarded by a bracket.
  pure function xi_at_coordinate(arc, axis, value, first, last) result(xi)
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: axis     !! 1: X, 2: Y
    real(wp), intent(in) :: value   !! [length]
    real(wp), intent(in) :: first, last
    real(wp) :: xi
    real(wp) :: c(0:2), second(2), q, roots(2), low, high, excess, tangent(2), rise
    integer :: iteration
    integer, parameter :: most_iterations = 80   ! halving alone reaches round-off in 54

    second = second_of(arc)
    c = [arc%points(axis, 2) - value, 0.5_wp*(arc%points(axis, 3) - arc%points(axis, 1)), 0.5_wp*second(axis)]
    q = -0.5_wp*(c(1) + sign(sqrt(max(c(1)**2 - 4*c(2)*c(0), 0.0_wp)), c(1)))
    roots = huge(roots)
    if (abs(q) > 0) roots(1) = c(0)/q
    if (abs(q) < huge(q)*min(abs(c(2)), 1.0_wp)) roots(2) = q/c(2)
    xi = roots(merge(1, 2, outside(roots(1)) <= outside(roots(2))))
    xi = min(max(xi, first), last)
    if (.not. any(abs(arc%depth) > 0)) return
    rise = sign(1.0_wp, coordinate(arc, axis, last) - coordinate(arc, axis, first))
    low = first
    high = last
    do iteration = 1, most_iterations
      excess = rise*(coordinate(arc, axis, xi) - value)
      if (excess > 0) then
        high = xi
      else
        low = xi
      end if
      tangent = rise*tangent_at(arc, xi)
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

end module arc_coordinates
