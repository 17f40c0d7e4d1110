!> Shape functions on the parent square and the parent line.
!>
!> Node order of the 8-node quadrilateral: corners counter-clockwise from (-1,-1), then the
!> mid-side nodes 5 (between 1 and 2) ... 8 (between 4 and 1). Serendipity functions:
!> O.C. Zienkiewicz, The Finite Element Method, 3rd ed., ch. 7.
!> Line of three nodes: 1 and 3 at the ends, 2 in the middle (seed, annex 2, eq. 1, with the sign
!> of its first term corrected).
module shape_functions
  use kinds, only: wp
  implicit none
  private
  public :: quad8, line3, quad4, quad8_corner, quad8_side

  !> Parent coordinates of the corners.
  real(wp), parameter :: quad8_corner(2, 4) = reshape([-1.0_wp, -1.0_wp, 1.0_wp, -1.0_wp, 1.0_wp, 1.0_wp, -1.0_wp, 1.0_wp], [2, 4])
  !> Local nodes of the four sides: first end, middle, second end, counterclockwise.
  integer, parameter :: quad8_side(3, 4) = reshape([1, 5, 2, 2, 6, 3, 3, 7, 4, 4, 8, 1], [3, 4])

contains

  !> Values and parent derivatives at (xi, eta).
  pure subroutine quad8(xi, eta, phi, dphi)
    real(wp), intent(in) :: xi, eta
    real(wp), intent(out) :: phi(8)       !! [-]
    real(wp), intent(out) :: dphi(2, 8)   !! [-]
    integer :: i
    real(wp) :: a, b

    do i = 1, 4
      a = quad8_corner(1, i)
      b = quad8_corner(2, i)
      phi(i) = 0.25_wp*(1 + a*xi)*(1 + b*eta)*(a*xi + b*eta - 1)
      dphi(1, i) = 0.25_wp*a*(1 + b*eta)*(2*a*xi + b*eta)
      dphi(2, i) = 0.25_wp*b*(1 + a*xi)*(2*b*eta + a*xi)
    end do
    do i = 5, 7, 2
      b = real(i - 6, wp)
      phi(i) = 0.5_wp*(1 - xi*xi)*(1 + b*eta)
      dphi(1, i) = -xi*(1 + b*eta)
      dphi(2, i) = 0.5_wp*b*(1 - xi*xi)
    end do
    do i = 6, 8, 2
      a = real(7 - i, wp)
      phi(i) = 0.5_wp*(1 - eta*eta)*(1 + a*xi)
      dphi(1, i) = 0.5_wp*a*(1 - eta*eta)
      dphi(2, i) = -eta*(1 + a*xi)
    end do
  end subroutine quad8

  !> Bilinear values at (xi, eta), corners in the order of `quad8`.
  pure subroutine quad4(xi, eta, phi)
    real(wp), intent(in) :: xi, eta
    real(wp), intent(out) :: phi(4)   !! [-]

    phi = 0.25_wp*(1 + quad8_corner(1, :)*xi)*(1 + quad8_corner(2, :)*eta)
  end subroutine quad4

  !> Values and derivatives at xi on the line.
  pure subroutine line3(xi, phi, dphi)
    real(wp), intent(in) :: xi
    real(wp), intent(out) :: phi(3), dphi(3)   !! [-]

    phi = [0.5_wp*xi*(xi - 1), 1 - xi*xi, 0.5_wp*xi*(xi + 1)]
    dphi = [xi - 0.5_wp, -2*xi, xi + 0.5_wp]
  end subroutine line3

end module shape_functions
