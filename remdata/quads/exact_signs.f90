!> Signs of geometric determinants without round-off.
!>
!> Points are integers on a grid of 2^29 steps. Differences take 30 bits, the determinant of an orientation 60, that of the circle
!> test 120: both fit the integers used here, so that signs are exact, not estimated. The tests are those of J. R. Shewchuk,
!> Adaptive precision floating-point arithmetic and fast robust geometric predicates, Discrete Comput. Geom. 18 (1997) 305-363.
module exact_signs
  use kinds, only: wp
  implicit none
  private
  public :: grid, grid_width, grid_frame_t, set_up_frame, on_grid, orientation, in_circle

  !> Integers of at least 58 bits, and of at least 120.
  integer, parameter :: grid = selected_int_kind(18), long = selected_int_kind(37)
  !> Steps of the grid; the body covers half of it, in the middle.
  integer(grid), parameter :: grid_width = 2_grid**29

  !> Position and scale of the grid.
  type :: grid_frame_t
    real(wp) :: low(2) = 0.0_wp   !! [length]
    real(wp) :: step = 1.0_wp     !! [length]
  end type grid_frame_t

contains

  !> The grid around points.
  pure subroutine set_up_frame(points, frame)
    real(wp), intent(in) :: points(:, :)   !! (2, n) [length]
    type(grid_frame_t), intent(out) :: frame
    real(wp) :: middle(2), width

    width = maxval(maxval(points, 2) - minval(points, 2))
    middle = 0.5_wp*(maxval(points, 2) + minval(points, 2))
    if (width > 0) frame%step = 2*width/real(grid_width, wp)
    frame%low = middle - 0.5_wp*real(grid_width, wp)*frame%step
  end subroutine set_up_frame

  !> The nearest point of the grid; one beyond its border is moved there.
  pure function on_grid(frame, x) result(p)
    type(grid_frame_t), intent(in) :: frame
    real(wp), intent(in) :: x(2)   !! [length]
    integer(grid) :: p(2)

    p = nint(min(max((x - frame%low)/frame%step, 1.0_wp), real(grid_width - 1, wp)), grid)
  end function on_grid

  !> 1 when c is on the left of the line from a to b, -1 on its right, 0 on it.
  pure function orientation(a, b, c) result(sign)
    integer(grid), intent(in) :: a(2), b(2), c(2)   !! [steps of the grid]
    integer :: sign
    integer(grid) :: det

    det = (b(1) - a(1))*(c(2) - a(2)) - (b(2) - a(2))*(c(1) - a(1))
    sign = merge(1, merge(-1, 0, det < 0), det > 0)
  end function orientation

  !> 1 when d is inside the circle through the counter-clockwise a, b, c, -1 outside, 0 on it.
  pure function in_circle(a, b, c, d) result(sign)
    integer(grid), intent(in) :: a(2), b(2), c(2), d(2)   !! [steps of the grid]
    integer :: sign
    integer(grid) :: u(2), v(2), w(2)
    integer(long) :: det

    u = a - d
    v = b - d
    w = c - d
    det = product_of(sum(u*u), v(1)*w(2) - v(2)*w(1)) + product_of(sum(v*v), w(1)*u(2) - w(2)*u(1)) &
          + product_of(sum(w*w), u(1)*v(2) - u(2)*v(1))
    sign = merge(1, merge(-1, 0, det < 0), det > 0)
  end function in_circle

  pure function product_of(a, b) result(c)
    integer(grid), intent(in) :: a, b
    integer(long) :: c

    c = int(a, long)*int(b, long)
  end function product_of

end module exact_signs
