!> Gauss and Gauss-Lobatto points on the parent line, Gauss points on the parent square.
!> Source: Abramowitz and Stegun, Handbook of Mathematical Functions, tables 25.4 and 25.6.
module quadrature
  use kinds, only: wp
  implicit none
  private
  public :: line_rule, square_rule

contains

  !> Gauss points (n = 1 ... 4), Lobatto points (n = -3), or Simpson's rule on 2, 4, 8 equal parts
  !> (n = -5, -9, -17); weights sum to 2.
  pure subroutine line_rule(n, xi, weight)
    integer, intent(in) :: n
    real(wp), allocatable, intent(out) :: xi(:), weight(:)
    real(wp) :: a, b, wa, wb
    integer :: i

    select case (n)
    case (1)
      xi = [0.0_wp]
      weight = [2.0_wp]
    case (2)
      a = 1/sqrt(3.0_wp)
      xi = [-a, a]
      weight = [1.0_wp, 1.0_wp]
    case (3)
      a = sqrt(0.6_wp)
      xi = [-a, 0.0_wp, a]
      weight = [5.0_wp, 8.0_wp, 5.0_wp]/9
    case (4)
      a = sqrt(3.0_wp/7 - 2.0_wp/7*sqrt(1.2_wp))
      b = sqrt(3.0_wp/7 + 2.0_wp/7*sqrt(1.2_wp))
      wa = (18 + sqrt(30.0_wp))/36
      wb = (18 - sqrt(30.0_wp))/36
      xi = [-b, -a, a, b]
      weight = [wb, wa, wa, wb]
    case (-3)
      xi = [-1.0_wp, 0.0_wp, 1.0_wp]
      weight = [1.0_wp, 4.0_wp, 1.0_wp]/3
    case (-5, -9, -17)
      allocate (xi(-n), weight(-n))
      do i = 1, -n
        xi(i) = -1 + 2*real(i - 1, wp)/(-n - 1)
        weight(i) = merge(8, 4, mod(i, 2) == 0)/(3*real(-n - 1, wp))
      end do
      weight([1, -n]) = 0.5_wp*weight([1, -n])
    case default
      allocate (xi(0), weight(0))
    end select
  end subroutine line_rule

  !> Product Gauss rule of `npoint` = 1, 4, 9 or 16 points; xi runs fastest. Weights sum to 4.
  pure subroutine square_rule(npoint, xi, weight)
    integer, intent(in) :: npoint
    real(wp), allocatable, intent(out) :: xi(:, :), weight(:)
    real(wp), allocatable :: x(:), w(:)
    integer :: i, j, k, n

    n = nint(sqrt(real(npoint, wp)))
    call line_rule(n, x, w)
    allocate (xi(2, npoint), weight(npoint))
    k = 0
    do j = 1, n
      do i = 1, n
        k = k + 1
        xi(:, k) = [x(i), x(j)]
        weight(k) = w(i)*w(j)
      end do
    end do
  end subroutine square_rule

end module quadrature
