!> Geometry of the 8-node quadrilateral at its integration points.
module quad8_geometry
  use kinds, only: wp
  use quadrature, only: square_rule
  use shape_functions, only: quad8
  implicit none
  private
  public :: quad8_rule_t, quad8_rule, derivatives

  integer, parameter :: max_points = 9

  !> Shape functions and parent derivatives at the points of a rule.
  type :: quad8_rule_t
    integer :: npoint = 0
    real(wp) :: phi(8, max_points) = 0.0_wp, dphi(2, 8, max_points) = 0.0_wp, weight(max_points) = 0.0_wp
  end type quad8_rule_t

contains

  !> Rule of 1, 4 or 9 Gauss points.
  pure subroutine quad8_rule(npoint, rule)
    integer, intent(in) :: npoint
    type(quad8_rule_t), intent(out) :: rule
    real(wp), allocatable :: xi(:, :), weight(:)
    integer :: p

    call square_rule(npoint, xi, weight)
    rule%npoint = npoint
    do p = 1, npoint
      call quad8(xi(1, p), xi(2, p), rule%phi(:, p), rule%dphi(:, :, p))
      rule%weight(p) = weight(p)
    end do
  end subroutine quad8_rule

  !> Cartesian derivatives and the determinant of the Jacobian.
  pure subroutine derivatives(dphi, x, nx, ny, detj)
    real(wp), intent(in) :: dphi(2, 8)      !! [-]
    real(wp), intent(in) :: x(2, 8)         !! nodes [length]
    real(wp), intent(out) :: nx(8), ny(8)   !! [1/length]
    real(wp), intent(out) :: detj           !! [length^2]
    real(wp) :: j11, j12, j21, j22

    j11 = dot_product(dphi(1, :), x(1, :))
    j12 = dot_product(dphi(1, :), x(2, :))
    j21 = dot_product(dphi(2, :), x(1, :))
    j22 = dot_product(dphi(2, :), x(2, :))
    detj = j11*j22 - j12*j21
    if (detj > 0) then
      nx = (j22*dphi(1, :) - j12*dphi(2, :))/detj
      ny = (j11*dphi(2, :) - j21*dphi(1, :))/detj
    else
      nx = 0
      ny = 0
    end if
  end subroutine derivatives

end module quad8_geometry
