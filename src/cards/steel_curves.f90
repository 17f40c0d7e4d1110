!> Functions of the temperature on cards of steels: `value`, `TABLE T v T v ...` or `POLY a0 a1 ...`.
module steel_curves
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use temperature_curves, only: curve_constant, curve_polynomial, temperature_curve_t, curve_table
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_curve, make_table

  !> A table, or a polynomial, longer than this is an error of input.
  integer, parameter :: most_points = 1000

contains

  !> What is left of a row, and rows after it that begin with a number where it is a table. With `positive` all values of a table
  !> or a constant must be above 0, and a table is linear in their logarithms.
  subroutine read_curve(cursor, what, curve, positive, abscissa)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what   !! name and unit of the function
    type(temperature_curve_t), intent(out) :: curve
    logical, intent(in), optional :: positive
    character(len=*), intent(in), optional :: abscissa   !! what the table is over; a temperature by default
    type(string_t) :: words(2)
    real(wp) :: value
    integer :: k
    logical :: above

    above = .false.
    if (present(positive)) above = positive
    if (cursor%next_is_number()) then
      call read_value(cursor, what, above, value)
      if (cursor%failed()) return
      if (cursor%more()) then
        call cursor%fail(what//': expected one number, TABLE or POLY')
        return
      end if
      curve%form = curve_constant
      curve%v = [value]
    else
      words(1)%s = 'TABLE'
      words(2)%s = 'POLY'
      call cursor%name(what//': a number, TABLE or POLY', words, k)
      if (k == 1) call read_table(cursor, what, above, curve, abscissa)
      if (k == 2 .and. above) call cursor%fail(what//' takes a number or a TABLE, no POLY')
      if (k == 2) call read_polynomial(cursor, what, curve)
    end if
    if (cursor%failed()) return
    curve%logarithmic = above
    if (above) curve%v = log(curve%v)
  end subroutine read_curve

  subroutine read_value(cursor, what, above, value)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what
    logical, intent(in) :: above
    real(wp), intent(out) :: value

    if (above) then
      call cursor%real(what, value, lower=0.0_wp, strict_lower=.true.)
    else
      call cursor%real(what, value)
    end if
  end subroutine read_value

  subroutine read_table(cursor, what, above, curve, abscissa)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what
    logical, intent(in) :: above
    type(temperature_curve_t), intent(inout) :: curve
    character(len=*), intent(in), optional :: abscissa
    real(wp) :: t(most_points), v(most_points)
    character(len=:), allocatable :: over
    integer :: n

    over = 'a temperature (degC)'
    if (present(abscissa)) over = abscissa
    n = 0
    do
      do while (cursor%more() .and. n < most_points)
        n = n + 1
        if (n == 1) call cursor%real(over, t(n))
        if (n > 1) call cursor%real(over, t(n), lower=t(n - 1), strict_lower=.true.)
        call read_value(cursor, what, above, v(n))
      end do
      if (cursor%failed()) return
      if (n == most_points .and. cursor%more()) then
        call cursor%fail(what//': a table has at most '//to_text(most_points)//' points')
        return
      end if
      if (.not. continued(cursor)) exit
      call cursor%next_row('more points of the table')
    end do
    if (n < 2) then
      call cursor%fail(what//': a table has two points at least')
      return
    end if
    call make_table(t(:n), v(:n), curve)
  end subroutine read_table

  !> The next row begins with a number.
  function continued(cursor) result(yes)
    type(cursor_t), intent(in) :: cursor
    logical :: yes

    yes = cursor%more_rows()
    if (yes) yes = cursor%peek_row() == ''
  end function continued

  subroutine read_polynomial(cursor, what, curve)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what
    type(temperature_curve_t), intent(inout) :: curve
    real(wp) :: a(20)
    integer :: n

    n = 0
    do while (cursor%more() .and. n < size(a))
      n = n + 1
      call cursor%real('a coefficient of '//what, a(n))
    end do
    if (cursor%failed()) return
    if (n == 0 .or. cursor%more()) then
      call cursor%fail(what//': a polynomial has 1 to '//to_text(size(a))//' coefficients')
      return
    end if
    curve%form = curve_polynomial
    curve%v = a(:n)
  end subroutine read_polynomial

  !> A table from its points.
  pure subroutine make_table(t, v, curve)
    real(wp), intent(in) :: t(:), v(:)   !! (npoint) ascending [degC], values [unit of the curve]
    type(temperature_curve_t), intent(inout) :: curve

    curve%form = curve_table
    allocate (curve%t, source=t)
    allocate (curve%v, source=v)
  end subroutine make_table

end module steel_curves
