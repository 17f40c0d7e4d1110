!> Gauss and Gauss-Lobatto points on the parent line, Gauss points on the parent square.
!> Source: Abramowitz and Stegun, Handbook of Mathematical Functions, tables 25.4 and 25.6.
module quadrature
  use kinds, only: wp
  implicit none
  private
  public :: rule_t, rule_gauss, rule_equidistant, rule_along, rule_control
  public :: line_rule, gauss_line, square_rule, rule_number, rule_of_number, rule_name, is_control_point

  !> Families of rules: Gauss; points at equal distances, the ends among them (Lobatto's with 3, then Simpson's on equal parts);
  !> the nodes of a side that is in contact between them too (ALONG), and those of one whose contact is that of its ends and its
  !> control point (BEZIER), 3 as Lobatto's.
  integer, parameter :: rule_gauss = 1, rule_equidistant = 2, rule_along = 3, rule_control = 4

  !> A rule: family, and number of points in all.
  type :: rule_t
    integer :: family = rule_gauss
    integer :: n = 0
  end type rule_t

contains

  !> A rule as cards and files have it: the number of points, negative for points at equal distances that a card asked for.
  elemental function rule_number(rule) result(number)
    type(rule_t), intent(in) :: rule
    integer :: number

    number = merge(rule%n, -rule%n, rule%family == rule_gauss)
  end function rule_number

  elemental function rule_of_number(number) result(rule)
    integer, intent(in) :: number
    type(rule_t) :: rule

    rule = rule_t(merge(rule_equidistant, rule_gauss, number < 0), abs(number))
  end function rule_of_number

  !> What the places of a rule are, in words.
  pure function rule_name(rule) result(name)
    type(rule_t), intent(in) :: rule
    character(len=:), allocatable :: name

    select case (rule%family)
    case (rule_gauss)
      name = 'Gauss'
    case (rule_control)
      name = 'control point'
    case default
      name = 'equidistant'
    end select
  end function rule_name

  !> A place of a rule is no point of the side, but its control point: its depth is none of the side.
  elemental function is_control_point(rule, p) result(yes)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p   !! place
    logical :: yes

    yes = rule%family == rule_control .and. p == 2
  end function is_control_point

  !> Gauss points (1 to 4), or points at equal distances: 3 (Lobatto), or 5, 9, 13, 17 (Simpson's rule on 2, 4, 6, 8 equal
  !> parts), or 33, 65, 129 (Gregory's rule, for functions with kinks anywhere); weights sum to 2.
  pure subroutine line_rule(rule, xi, weight)
    type(rule_t), intent(in) :: rule
    real(wp), allocatable, intent(out) :: xi(:)       !! (rule%n) parent coordinates [-]
    real(wp), allocatable, intent(out) :: weight(:)   !! (rule%n) [-]
    integer :: i
    ! trapezoidal rule with its ends corrected (Gregory), exact for cubics
    real(wp), parameter :: corrected(3) = [9.0_wp, 28.0_wp, 23.0_wp]/24

    if (rule%family == rule_gauss) then
      call gauss_line(rule%n, xi, weight)
      return
    end if
    associate (n => rule%n)
      select case (n)
      case (3)
        xi = [-1.0_wp, 0.0_wp, 1.0_wp]
        weight = [1.0_wp, 4.0_wp, 1.0_wp]/3
      case (5, 9, 13, 17)
        allocate (xi(n), weight(n))
        do i = 1, n
          xi(i) = -1 + 2*real(i - 1, wp)/(n - 1)
          weight(i) = merge(8, 4, mod(i, 2) == 0)/(3*real(n - 1, wp))
        end do
        weight([1, n]) = 0.5_wp*weight([1, n])
      case (33, 65, 129)
        allocate (xi(n), weight(n))
        do i = 1, n
          xi(i) = -1 + 2*real(i - 1, wp)/(n - 1)
        end do
        weight = 2.0_wp/(n - 1)
        weight(1:3) = weight(1:3)*corrected
        weight(n:n - 2:-1) = weight(1:3)
      case default
        allocate (xi(0), weight(0))
      end select
    end associate
  end subroutine line_rule

  !> Gauss points of the line, 1 to 4; weights sum to 2.
  pure subroutine gauss_line(n, xi, weight)
    integer, intent(in) :: n
    real(wp), allocatable, intent(out) :: xi(:)       !! (n) parent coordinates [-]
    real(wp), allocatable, intent(out) :: weight(:)   !! (n) [-]
    real(wp) :: a, b, wa, wb

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
    case default
      allocate (xi(0), weight(0))
    end select
  end subroutine gauss_line

  !> Product Gauss rule of `npoint` = 1, 4, 9 or 16 points; xi runs fastest. Weights sum to 4.
  pure subroutine square_rule(npoint, xi, weight)
    integer, intent(in) :: npoint
    real(wp), allocatable, intent(out) :: xi(:, :)    !! (2, npoint) parent coordinates [-]
    real(wp), allocatable, intent(out) :: weight(:)   !! (npoint) [-]
    real(wp), allocatable :: x(:), w(:)
    integer :: i, j, k, n

    n = nint(sqrt(real(npoint, wp)))
    call gauss_line(n, x, w)
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
