!> Functions of the temperature as steels are given by: a constant, a table, a polynomial.
!>
!> A table is linear between its temperatures, or linear in the logarithm of its values (times of transformation, which range over
!> decades), and constant outside. A polynomial holds at any temperature; where it may be used is stated with what uses it.
module temperature_curves
  use ascending, only: count_up_to
  use dual_numbers, only: dual_t, exp, operator(*), operator(+)
  use kinds, only: wp
  implicit none
  private
  public :: temperature_curve_t, curve_at, curve_integral, dual_curve_at, is_given, same_curve
  public :: curve_none, curve_constant, curve_table, curve_polynomial

  integer, parameter :: curve_none = 0, curve_constant = 1, curve_table = 2, curve_polynomial = 3

  type :: temperature_curve_t
    integer :: form = curve_none
    !> Temperatures of a table, ascending, and its values; of a constant, one value; of a polynomial its coefficients, from the
    !> constant one on.
    real(wp), allocatable :: t(:), v(:)
    !> The values are logarithms: the function is their exponential.
    logical :: logarithmic = .false.
  end type temperature_curve_t

contains

  !> A curve has been given.
  pure elemental function is_given(curve) result(yes)
    type(temperature_curve_t), intent(in) :: curve
    logical :: yes

    yes = curve%form /= curve_none
  end function is_given

  !> Two curves are given by the same numbers, or neither is given.
  pure function same_curve(one, other) result(yes)
    type(temperature_curve_t), intent(in) :: one, other
    logical :: yes

    yes = one%form == other%form .and. (one%logarithmic .eqv. other%logarithmic)
    if (.not. yes .or. one%form == curve_none) return
    yes = same_numbers(one%v, other%v)
    if (yes .and. one%form == curve_table) yes = same_numbers(one%t, other%t)
  end function same_curve

  pure function same_numbers(a, b) result(yes)
    real(wp), intent(in) :: a(:), b(:)
    logical :: yes

    yes = size(a) == size(b)
    if (yes) yes = .not. any(abs(a - b) > 0)
  end function same_numbers

  !> Value at a temperature, 0 where there is no curve.
  pure function curve_at(curve, temperature) result(value)
    type(temperature_curve_t), intent(in) :: curve
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp) :: value
    type(dual_t) :: both

    both = dual_curve_at(curve, dual_t(temperature, 0.0_wp))
    value = both%value
  end function curve_at

  !> Value and derivative at a temperature that depends on something.
  pure function dual_curve_at(curve, temperature) result(value)
    type(temperature_curve_t), intent(in) :: curve
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: value
    integer :: k
    real(wp) :: slope

    select case (curve%form)
    case (curve_constant)
      value%value = curve%v(1)
    case (curve_polynomial)
      do k = size(curve%v), 1, -1
        value = value*temperature + curve%v(k)
      end do
    case (curve_table)
      associate (t => curve%t, v => curve%v, n => size(curve%t))
        if (temperature%value <= t(1)) then
          value%value = v(1)
        else if (temperature%value >= t(n)) then
          value%value = v(n)
        else
          k = interval_of(t, temperature%value)
          slope = (v(k + 1) - v(k))/(t(k + 1) - t(k))
          value = dual_t(v(k) + slope*(temperature%value - t(k)), slope*temperature%slope)
        end if
      end associate
    end select
    if (curve%logarithmic) value = exp(value)
  end function dual_curve_at

  !> Exact integral from a temperature to another; of a curve that is not logarithmic.
  pure function curve_integral(curve, from, to) result(integral)
    type(temperature_curve_t), intent(in) :: curve
    real(wp), intent(in) :: from, to   !! [degC]
    real(wp) :: integral
    real(wp) :: a, b, low, high
    integer :: k, n

    integral = 0
    select case (curve%form)
    case (curve_constant)
      integral = curve%v(1)*(to - from)
    case (curve_polynomial)
      do k = size(curve%v), 1, -1
        integral = integral + curve%v(k)/k*(to**k - from**k)
      end do
    case (curve_table)
      low = min(from, to)
      high = max(from, to)
      associate (t => curve%t, v => curve%v)
        n = size(t)
        integral = v(1)*max(0.0_wp, min(high, t(1)) - low) + v(n)*max(0.0_wp, high - max(low, t(n)))
        do k = 1, n - 1
          a = max(low, t(k))
          b = min(high, t(k + 1))
          if (b > a) integral = integral + (b - a)*(v(k) + (v(k + 1) - v(k))*(0.5_wp*(a + b) - t(k))/(t(k + 1) - t(k)))
        end do
      end associate
      if (to < from) integral = -integral
    end select
  end function curve_integral

  !> The interval k of an ascending table with t(k) <= x < t(k+1), for x between its ends.
  pure function interval_of(t, x) result(k)
    real(wp), intent(in) :: t(:), x
    integer :: k

    k = 1 + count_up_to(t(2:size(t) - 1), x)
  end function interval_of

end module temperature_curves
