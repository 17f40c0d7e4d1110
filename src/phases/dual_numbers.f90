!> Numbers with their derivative by one variable: whatever is computed with them brings its exact derivative along.
!>
!> Source: forward differentiation by dual numbers, A. Griewank, A. Walther, Evaluating Derivatives (2008), ch. 3.
module dual_numbers
  use kinds, only: wp
  implicit none
  private
  public :: dual_t, operator(+), operator(-), operator(*), operator(/), exp, log

  !> A value and its derivative.
  type :: dual_t
    real(wp) :: value = 0.0_wp
    real(wp) :: slope = 0.0_wp
  end type dual_t

  interface operator(+)
    module procedure :: add, add_real, add_to_real
  end interface operator(+)

  interface operator(-)
    module procedure :: subtract, subtract_real, subtract_from_real, negative
  end interface operator(-)

  interface operator(*)
    module procedure :: multiply, multiply_real
  end interface operator(*)

  interface operator(/)
    module procedure :: divide, divide_real, divide_into_real
  end interface operator(/)

  interface exp
    module procedure :: exponential
  end interface exp

  interface log
    module procedure :: logarithm
  end interface log

contains

  elemental function add(a, b) result(c)
    type(dual_t), intent(in) :: a, b
    type(dual_t) :: c

    c = dual_t(a%value + b%value, a%slope + b%slope)
  end function add

  elemental function add_real(a, b) result(c)
    type(dual_t), intent(in) :: a
    real(wp), intent(in) :: b
    type(dual_t) :: c

    c = dual_t(a%value + b, a%slope)
  end function add_real

  elemental function add_to_real(a, b) result(c)
    real(wp), intent(in) :: a
    type(dual_t), intent(in) :: b
    type(dual_t) :: c

    c = dual_t(a + b%value, b%slope)
  end function add_to_real

  elemental function subtract(a, b) result(c)
    type(dual_t), intent(in) :: a, b
    type(dual_t) :: c

    c = dual_t(a%value - b%value, a%slope - b%slope)
  end function subtract

  elemental function subtract_real(a, b) result(c)
    type(dual_t), intent(in) :: a
    real(wp), intent(in) :: b
    type(dual_t) :: c

    c = dual_t(a%value - b, a%slope)
  end function subtract_real

  elemental function subtract_from_real(a, b) result(c)
    real(wp), intent(in) :: a
    type(dual_t), intent(in) :: b
    type(dual_t) :: c

    c = dual_t(a - b%value, -b%slope)
  end function subtract_from_real

  elemental function negative(a) result(c)
    type(dual_t), intent(in) :: a
    type(dual_t) :: c

    c = dual_t(-a%value, -a%slope)
  end function negative

  elemental function multiply(a, b) result(c)
    type(dual_t), intent(in) :: a, b
    type(dual_t) :: c

    c = dual_t(a%value*b%value, a%slope*b%value + a%value*b%slope)
  end function multiply

  elemental function multiply_real(a, b) result(c)
    real(wp), intent(in) :: a
    type(dual_t), intent(in) :: b
    type(dual_t) :: c

    c = dual_t(a*b%value, a*b%slope)
  end function multiply_real

  elemental function divide(a, b) result(c)
    type(dual_t), intent(in) :: a, b
    type(dual_t) :: c

    c%value = a%value/b%value
    c%slope = (a%slope - c%value*b%slope)/b%value
  end function divide

  elemental function divide_real(a, b) result(c)
    type(dual_t), intent(in) :: a
    real(wp), intent(in) :: b
    type(dual_t) :: c

    c = dual_t(a%value/b, a%slope/b)
  end function divide_real

  elemental function divide_into_real(a, b) result(c)
    real(wp), intent(in) :: a
    type(dual_t), intent(in) :: b
    type(dual_t) :: c

    c%value = a/b%value
    c%slope = -c%value*b%slope/b%value
  end function divide_into_real

  elemental function exponential(a) result(c)
    type(dual_t), intent(in) :: a
    type(dual_t) :: c

    c%value = exp(a%value)
    c%slope = c%value*a%slope
  end function exponential

  elemental function logarithm(a) result(c)
    type(dual_t), intent(in) :: a
    type(dual_t) :: c

    c = dual_t(log(a%value), a%slope/a%value)
  end function logarithm

end module dual_numbers
