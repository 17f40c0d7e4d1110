!> Geometry of the 8-node quadrilateral at its integration points.
!>
!> Sums over the nodes are made for `lanes` points at once: in loops of fixed length, which compilers turn into vector instructions.
module quad8_geometry
  use kinds, only: wp
  use quadrature, only: square_rule
  use shape_functions, only: quad8
  implicit none
  private
  public :: quad8_rule_t, quad8_rule, derivatives, determinant, places, slopes

  integer, parameter, public :: max_points = 9
  !> Points summed at once, and how often that covers all of them.
  integer, parameter :: lanes = 4
  integer, parameter :: max_sweeps = (max_points + lanes - 1)/lanes

  !> Shape functions and parent derivatives at the points of a rule.
  type :: quad8_rule_t
    integer :: npoint = 0
    real(wp) :: phi(8, max_points) = 0.0_wp, dphi(2, 8, max_points) = 0.0_wp, weight(max_points) = 0.0_wp
    !> Shape functions (0) and parent derivatives by xi (1) and eta (2) by lanes; the last point stands in lanes that are left over.
    real(wp), private :: of_lane(lanes, 8, max_sweeps, 0:2) = 0.0_wp
  end type quad8_rule_t

contains

  !> Rule of 1, 4 or 9 Gauss points.
  pure subroutine quad8_rule(npoint, rule)
    integer, intent(in) :: npoint
    type(quad8_rule_t), intent(out) :: rule
    real(wp), allocatable :: xi(:, :), weight(:)
    integer :: p, k, lane

    call square_rule(npoint, xi, weight)
    rule%npoint = npoint
    do p = 1, npoint
      call quad8(xi(1, p), xi(2, p), rule%phi(:, p), rule%dphi(:, :, p))
      rule%weight(p) = weight(p)
    end do
    do k = 1, (npoint + lanes - 1)/lanes
      do lane = 1, lanes
        p = min((k - 1)*lanes + lane, npoint)
        rule%of_lane(lane, :, k, 0) = rule%phi(:, p)
        rule%of_lane(lane, :, k, 1) = rule%dphi(1, :, p)
        rule%of_lane(lane, :, k, 2) = rule%dphi(2, :, p)
      end do
    end do
  end subroutine quad8_rule

  !> Values of two nodal quantities at all points.
  pure subroutine places(rule, a, b, at)
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: a(8), b(8)           !! [unit of each]
    real(wp), intent(out) :: at(max_points, 2)   !! those of a, of b [the same]

    call sum_lanes(rule%npoint, rule%of_lane(:, :, :, 0), a, b, at)
  end subroutine places

  !> Parent derivatives of two nodal quantities at all points.
  pure subroutine slopes(rule, a, b, of)
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: a(8), b(8)           !! [unit of each]
    real(wp), intent(out) :: of(max_points, 4)   !! of a and b by xi, of a and b by eta [the same]

    call sum_lanes(rule%npoint, rule%of_lane(:, :, :, 1), a, b, of(:, 1:2))
    call sum_lanes(rule%npoint, rule%of_lane(:, :, :, 2), a, b, of(:, 3:4))
  end subroutine slopes

  !> Sums over the nodes of two quantities at all points.
  pure subroutine sum_lanes(npoint, of_lane, a, b, at)
    integer, intent(in) :: npoint
    real(wp), intent(in) :: of_lane(lanes, 8, max_sweeps)   !! factors of the nodes [-]
    real(wp), intent(in) :: a(8), b(8)           !! [unit of each]
    real(wp), intent(out) :: at(max_points, 2)   !! sums of a, of b [the same]
    real(wp) :: sums(lanes, 2)
    integer :: i, k, l, left

    do k = 1, (npoint + lanes - 1)/lanes
      sums = 0
      do i = 1, 8
        do l = 1, lanes
          sums(l, 1) = sums(l, 1) + of_lane(l, i, k)*a(i)
          sums(l, 2) = sums(l, 2) + of_lane(l, i, k)*b(i)
        end do
      end do
      left = min(lanes, max_points - (k - 1)*lanes)
      at((k - 1)*lanes + 1:(k - 1)*lanes + left, :) = sums(:left, :)
    end do
  end subroutine sum_lanes

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

  !> The determinant alone, the same to the last bit.
  pure function determinant(dphi, x) result(detj)
    real(wp), intent(in) :: dphi(2, 8)   !! [-]
    real(wp), intent(in) :: x(2, 8)      !! nodes [length]
    real(wp) :: detj                     !! [length^2]

    detj = dot_product(dphi(1, :), x(1, :))*dot_product(dphi(2, :), x(2, :)) &
           - dot_product(dphi(1, :), x(2, :))*dot_product(dphi(2, :), x(1, :))
  end function determinant

end module quad8_geometry
