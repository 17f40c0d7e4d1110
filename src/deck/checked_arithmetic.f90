!> Operators and functions of expressions: overflow, division by zero and what a function does not take are found before they
!> happen, since debug builds trap them. `mistake` is empty where there is none; otherwise the value is 0.
module checked_arithmetic
  use kinds, only: wp
  implicit none
  private
  public :: apply_operator, apply_function, functions

  character(len=*), parameter :: functions(10) = &
    ['sqrt', 'exp ', 'log ', 'sin ', 'cos ', 'tan ', 'atan', 'abs ', 'min ', 'max ']
  character(len=*), parameter :: too_large = 'the result is too large'
  !> exp() of more than this overflows: ln(huge) = 709.78.
  real(wp), parameter :: largest_exponent = 709.0_wp

contains

  !> x operator y, the operator being one of + - * / ^.
  pure subroutine apply_operator(operator, x, y, value, mistake)
    character(len=1), intent(in) :: operator
    real(wp), intent(in) :: x, y
    real(wp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: mistake

    value = 0
    mistake = ''
    select case (operator)
    case ('+', '-')
      call add(x, merge(-y, y, operator == '-'), value, mistake)
    case ('*', '/')
      if (operator == '/' .and. abs(y) <= 0) then
        mistake = 'division by zero'
      else if (overflows(operator, x, y)) then
        mistake = too_large
      else if (operator == '*') then
        value = x*y
      else
        value = x/y
      end if
    case ('^')
      call raise(x, y, value, mistake)
    end select
  end subroutine apply_operator

  pure subroutine add(x, y, value, mistake)
    real(wp), intent(in) :: x, y
    real(wp), intent(inout) :: value
    character(len=:), allocatable, intent(inout) :: mistake

    if (abs(0.5_wp*x + 0.5_wp*y) > 0.5_wp*huge(value)) then
      mistake = too_large
    else
      value = x + y
    end if
  end subroutine add

  pure subroutine raise(base, exponent, value, mistake)
    real(wp), intent(in) :: base, exponent
    real(wp), intent(inout) :: value
    character(len=:), allocatable, intent(inout) :: mistake

    if (abs(base) <= 0) then
      if (exponent < 0) mistake = 'division by zero'
      value = merge(1.0_wp, 0.0_wp, abs(exponent) <= 0)
    else if (base < 0 .and. abs(exponent - anint(exponent)) > 0) then
      mistake = 'a negative number has no broken power'
    else if (abs(exponent) > huge(base)*1.0e-3_wp) then
      mistake = too_large
    else if (exponent*log(abs(base)) > largest_exponent) then
      mistake = too_large
    else
      value = abs(base)**exponent
      if (base < 0 .and. abs(mod(exponent, 2.0_wp)) > 0.5_wp) value = -value
    end if
  end subroutine raise

  !> Value of a function of one number, or of two (min, max).
  pure subroutine apply_function(name, x, y, value, mistake)
    character(len=*), intent(in) :: name   !! one of `functions`
    real(wp), intent(in) :: x, y
    real(wp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: mistake

    value = 0
    mistake = ''
    select case (name)
    case ('sqrt')
      if (x < 0) then
        mistake = 'square root of a negative number'
      else
        value = sqrt(x)
      end if
    case ('exp')
      if (x > largest_exponent) then
        mistake = too_large
      else
        value = exp(x)
      end if
    case ('log')
      if (x <= 0) then
        mistake = 'logarithm of a number which is not positive'
      else
        value = log(x)
      end if
    case ('sin')
      value = sin(x)
    case ('cos')
      value = cos(x)
    case ('tan')
      value = tan(x)
    case ('atan')
      value = atan(x)
    case ('abs')
      value = abs(x)
    case ('min')
      value = min(x, y)
    case ('max')
      value = max(x, y)
    end select
  end subroutine apply_function

  !> Whether x*y or x/y goes past the largest number.
  pure function overflows(operator, x, y) result(yes)
    character(len=1), intent(in) :: operator
    real(wp), intent(in) :: x, y
    logical :: yes
    real(wp) :: m
    integer :: e

    yes = .false.
    if (abs(x) <= 0 .or. abs(y) <= 0) return
    if (operator == '*') then
      m = fraction(x)*fraction(y)
      e = exponent(x) + exponent(y)
    else
      m = fraction(x)/fraction(y)
      e = exponent(x) - exponent(y)
    end if
    yes = e + exponent(m) > maxexponent(x)
  end function overflows

end module checked_arithmetic
