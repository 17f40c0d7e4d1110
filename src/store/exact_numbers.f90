!> Reals as the shortest decimal text that reads back as the very same number.
module exact_numbers
  use kinds, only: i8, wp
  use text, only: to_text
  implicit none
  private
  public :: exact_text, is_finite

contains

  !> Neither infinite nor NaN. Reads the exponent's bits (IEEE 754), since comparing a NaN is what
  !> the debug build traps.
  elemental function is_finite(value)
    real(wp), intent(in) :: value
    logical :: is_finite

    is_finite = ibits(transfer(value, 0_i8), 52, 11) /= 2047_i8
  end function is_finite

  !> `0.1`, `2.5`, `-1.25e-7`, `nan`, `inf`, `-inf`: valid in JSON (the finite ones), CSV and Fortran.
  !> There is always a point or an exponent, so that a reader takes it for a real.
  function exact_text(value) result(s)
    real(wp), intent(in) :: value
    character(len=:), allocatable :: s

    if (is_finite(value)) then
      s = finite_text(value)
    else if (ibits(transfer(value, 0_i8), 0, 52) /= 0_i8) then
      s = 'nan'
    else if (transfer(value, 0_i8) < 0) then
      s = '-inf'
    else
      s = 'inf'
    end if
  end function exact_text

  !> The text of a finite real.
  function finite_text(value) result(s)
    real(wp), intent(in) :: value
    character(len=:), allocatable :: s
    character(len=25) :: buffer
    character(len=17) :: digit
    integer :: n, exponent

    call shortest_digits(value, buffer)
    ! buffer: sign, digit, point, 16 digits, 'E', sign of the exponent, three digits.
    digit = buffer(2:2)//buffer(4:19)
    read (buffer(21:24), '(i4)') exponent
    n = max(verify(digit, '0', back=.true.), 1)
    if (exponent >= 16 .or. exponent < -4) then
      s = digit(1:1)
      if (n > 1) s = s//'.'//digit(2:n)
      s = s//'e'//to_text(exponent)
    else if (exponent >= 0) then
      s = digit(:exponent + 1)//'.'//digit(exponent + 2:max(n, exponent + 2))
    else
      s = '0.'//repeat('0', -exponent - 1)//digit(:n)
    end if
    if (buffer(1:1) == '-') s = '-'//s
  end function finite_text

  !> Scientific notation in 17 digits, of which as many as possible are trailing zeros: 15 digits
  !> often suffice to find a double again, 17 always do.
  subroutine shortest_digits(value, buffer)
    real(wp), intent(in) :: value
    character(len=25), intent(out) :: buffer
    ! Above this, rounding to 15 digits may give a decimal beyond the largest double.
    real(wp), parameter :: roundable = 1.7e308_wp
    character(len=11), parameter :: form(15:17) = ['(es24.14e3)', '(es24.15e3)', '(es24.16e3)']
    character(len=24) :: trial
    real(wp) :: back
    integer :: digits, letter

    do digits = merge(15, 17, abs(value) < roundable), 17
      write (trial, form(digits)) value
      trial = adjustl(trial)
      read (trial, *) back
      if (transfer(back, 0_i8) == transfer(value, 0_i8)) exit
    end do
    buffer = trial
    if (trial(1:1) /= '-') buffer = ' '//trial
    letter = index(buffer, 'E')
    buffer = buffer(:letter - 1)//repeat('0', 20 - letter)//buffer(letter:letter + 4)
  end subroutine shortest_digits

end module exact_numbers
