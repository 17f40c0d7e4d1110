!> Points of a structured grid inside its four sides: transfinite interpolation, then elliptic smoothing.
!>
!> The lines solve Winslow's equations with control by the density w = 1/h,
!> alpha (x,aa + P x,a) - 2 beta x,ab + gamma (x,bb + Q x,b) = 0, alpha = x,b.x,b, beta = x,a.x,b, gamma = x,a.x,a,
!> P = (ln w),a and Q = (ln w),b: along a line alone this is w |x,a| = constant.
!> Sources: A.M. Winslow, J. Comput. Phys. 1 (1966) 149-172; J.F. Thompson, Z.U.A. Warsi, C.W. Mastin, Numerical Grid
!> Generation (1985), ch. VI. Solved from coarse grids to finer ones (F.A. Bornemann, P. Deuflhard, Numer. Math. 75 (1996)
!> 135-152), with the correction of the transfinite grid passed on, so that the cost grows with the number of points.
module grid_lines
  use kinds, only: wp
  use vectors, only: length_of
  implicit none
  private
  public :: interpolate_inside, smooth_inside, relaxed

  !> Grids with so few divisions are not coarsened, and get so many times the passes of the others.
  integer, parameter :: coarsest = 6, coarse_passes = 8
  !> Control of one line over the next: sizes up to a ratio of three.
  real(wp), parameter :: strongest = 1.0_wp

contains

  !> Fill the inside from the sides, each point at the intersection of the lines that join equal shares of opposite sides.
  !> Sources: W.J. Gordon, C.A. Hall, Int. J. Num. Meth. Engng 7 (1973) 461-477; B.K. Soni, AIAA 85-1526 (crossing).
  pure subroutine interpolate_inside(x)
    real(wp), intent(inout) :: x(:, 0:, 0:)   !! (2, 0:n, 0:m) coordinates, those of the sides given [length]
    real(wp) :: a(0:ubound(x, 2), 2), b(0:ubound(x, 3), 2), s, t
    integer :: i, j, n, m

    n = ubound(x, 2)
    m = ubound(x, 3)
    call shares(x(:, :, 0), a(:, 1))
    call shares(x(:, :, m), a(:, 2))
    call shares(x(:, 0, :), b(:, 1))
    call shares(x(:, n, :), b(:, 2))
    do j = 1, m - 1
      do i = 1, n - 1
        associate (da => a(i, 2) - a(i, 1), db => b(j, 2) - b(j, 1))
          s = (a(i, 1) + b(j, 1)*da)/(1 - da*db)
          t = (b(j, 1) + a(i, 1)*db)/(1 - da*db)
        end associate
        x(:, i, j) = (1 - t)*x(:, i, 0) + t*x(:, i, m) + (1 - s)*x(:, 0, j) + s*x(:, n, j) &
                     - (1 - s)*((1 - t)*x(:, 0, 0) + t*x(:, 0, m)) - s*((1 - t)*x(:, n, 0) + t*x(:, n, m))
      end do
    end do
  end subroutine interpolate_inside

  !> Share of the length of a line at each of its points, from 0 to 1.
  pure subroutine shares(line, share)
    real(wp), intent(in) :: line(:, 0:)
    real(wp), intent(out) :: share(0:)
    integer :: i

    share(0) = 0
    do i = 1, ubound(line, 2)
      share(i) = share(i - 1) + length_of(line(:, i) - line(:, i - 1))
    end do
    share = share/share(ubound(share, 1))
  end subroutine shares

  !> Smooth the inside of a grid that was interpolated.
  pure recursive subroutine smooth_inside(log_density, passes, x)
    real(wp), intent(in) :: log_density(0:, 0:)   !! (0:n, 0:m) logarithm of 1/h [-]
    integer, intent(in) :: passes                 !! on each grid
    real(wp), intent(inout) :: x(:, 0:, 0:)       !! (2, 0:n, 0:m) [length]
    real(wp), allocatable :: coarse(:, :, :), before(:, :, :), density(:, :)
    real(wp) :: around(2, 9)
    integer :: n(2), half(2), i, j, pass, times

    n = ubound(log_density)
    half = max((n + 1)/2, min(n, coarsest))
    times = passes*coarse_passes
    if (any(half < n)) then
      times = passes
      allocate (coarse(2, 0:half(1), 0:half(2)), before(2, 0:half(1), 0:half(2)), density(0:half(1), 0:half(2)))
      do j = 0, half(2)
        do i = 0, half(1)
          before(:, i, j) = [sampled(x(1, :, :), scaled_index(i, half(1), n(1)), scaled_index(j, half(2), n(2))), &
                             sampled(x(2, :, :), scaled_index(i, half(1), n(1)), scaled_index(j, half(2), n(2)))]
          density(i, j) = sampled(log_density, scaled_index(i, half(1), n(1)), scaled_index(j, half(2), n(2)))
        end do
      end do
      call interpolate_inside(before)
      coarse = before
      call smooth_inside(density, passes, coarse)
      coarse = coarse - before
      do j = 1, n(2) - 1
        do i = 1, n(1) - 1
          x(:, i, j) = x(:, i, j) + [sampled(coarse(1, :, :), scaled_index(i, n(1), half(1)), scaled_index(j, n(2), half(2))), &
                                     sampled(coarse(2, :, :), scaled_index(i, n(1), half(1)), scaled_index(j, n(2), half(2)))]
        end do
      end do
    end if
    do pass = 1, times
      do j = 1, n(2) - 1
        do i = 1, n(1) - 1
          around(:, 1:3) = x(:, i - 1:i + 1, j - 1)
          around(:, 4:6) = x(:, i - 1:i + 1, j)
          around(:, 7:9) = x(:, i - 1:i + 1, j + 1)
          x(:, i, j) = relaxed(around, 0.5_wp*(log_density(i + 1, j) - log_density(i - 1, j)), &
                               0.5_wp*(log_density(i, j + 1) - log_density(i, j - 1)))
        end do
      end do
    end do
  end subroutine smooth_inside

  !> Line i of a grid of `here` divisions in a grid of `there` divisions.
  pure function scaled_index(i, here, there) result(scaled)
    integer, intent(in) :: i, here, there
    real(wp) :: scaled

    scaled = real(i, wp)*there/here
  end function scaled_index

  !> Bilinear value between the points of a grid.
  pure function sampled(value, a, b) result(v)
    real(wp), intent(in) :: value(0:, 0:), a, b
    real(wp) :: v
    real(wp) :: s, t
    integer :: i, j

    i = min(int(a), ubound(value, 1) - 1)
    j = min(int(b), ubound(value, 2) - 1)
    s = a - i
    t = b - j
    v = (1 - t)*((1 - s)*value(i, j) + s*value(i + 1, j)) + t*((1 - s)*value(i, j + 1) + s*value(i + 1, j + 1))
  end function sampled

  !> Position of a point relative to its eight neighbours, given row by row with itself.
  pure function relaxed(x, p, q) result(new)
    real(wp), intent(in) :: x(2, 9)   !! [length]
    real(wp), intent(in) :: p, q      !! control along the rows and across them
    real(wp) :: new(2)
    real(wp) :: xa(2), xb(2), alpha, beta, gamma

    xa = 0.5_wp*(x(:, 6) - x(:, 4))
    xb = 0.5_wp*(x(:, 8) - x(:, 2))
    alpha = dot_product(xb, xb)
    beta = dot_product(xa, xb)
    gamma = dot_product(xa, xa)
    new = (alpha*(x(:, 4) + x(:, 6) + max(-strongest, min(strongest, p))*xa) &
           + gamma*(x(:, 2) + x(:, 8) + max(-strongest, min(strongest, q))*xb) &
           - 0.5_wp*beta*(x(:, 9) - x(:, 7) - x(:, 3) + x(:, 1)))/(2*(alpha + gamma))
  end function relaxed

end module grid_lines
