!> Arithmetic in a field: `+ - * / ^ ( )`, functions, `pi`, parameters `$name`; no blanks.
!>
!>     sum     = term   { (+|-) term }
!>     term    = signed { (*|/) signed }
!>     signed  = (+|-) signed | power
!>     power   = primary [ ^ signed ]                so -2^2 = -4, 2^3^2 = 2^9, 2^-1 = 0.5
!>     primary = number | $name | pi | x | y | function(sum [, sum]) | (sum)
!>
!> The place, x and y, is known where a formula is evaluated at one.
module deck_expression
  use checked_arithmetic, only: apply_function, apply_operator, functions
  use deck_field, only: digits, letters
  use deck_parameters, only: parameters_t
  use expression_forms, only: name_letters
  use expression_parser, only: expected, next_is, parser_t, read_number, skip, stop_at, take
  use kinds, only: pi, wp
  use text, only: nearest_word, string_t
  implicit none
  private
  public :: evaluate, fill_in

  !> Brackets, signs and powers within one another; deeper is no typing error but a damaged file.
  integer, parameter :: deepest = 60

contains

  !> Value of an expression. On failure `message` states the cause at character `position`;
  !> it is empty when the cause is a parameter whose own mistake is known already.
  subroutine evaluate(expression, parameters, value, failed, message, position, place)
    character(len=*), intent(in) :: expression
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    logical, intent(out) :: failed
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: position
    real(wp), intent(in), optional :: place(2)   !! x and y [length]
    type(parser_t) :: p

    p%s = expression
    p%message = ''
    p%placed = present(place)
    if (present(place)) p%place = place
    call read_sum(p, parameters, value)
    if (.not. p%failed .and. p%at <= len(p%s)) then
      if (p%s(p%at:p%at) == ',') then
        call expected(p, 'a decimal point or an operator')
      else
        call expected(p, 'an operator')
      end if
    end if
    failed = p%failed
    message = p%message
    position = p%failed_at
    if (failed) value = 0
  end subroutine evaluate

  !> A formula with the values of its parameters in their places. On failure as `evaluate`.
  subroutine fill_in(formula, parameters, filled, failed, message, position)
    character(len=*), intent(in) :: formula
    type(parameters_t), intent(in) :: parameters
    character(len=:), allocatable, intent(out) :: filled
    logical, intent(out) :: failed
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: position
    type(parser_t) :: p
    character(len=40) :: digits_of
    real(wp) :: value
    integer :: next

    p%s = formula
    p%message = ''
    filled = ''
    do while (p%at <= len(p%s) .and. .not. p%failed)
      if (next_is(p, '$')) then
        call read_parameter(p, parameters, value)
        write (digits_of, '(es25.17e3)') value
        filled = filled//'('//trim(adjustl(digits_of))//')'
      else
        next = index(p%s(p%at:)//'$', '$') + p%at - 1
        filled = filled//p%s(p%at:next - 1)
        p%at = next
      end if
    end do
    failed = p%failed
    message = p%message
    position = p%failed_at
  end subroutine fill_in

  recursive subroutine read_sum(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    real(wp) :: right
    character(len=1) :: operator
    integer :: at

    call read_term(p, parameters, value)
    do while (next_is(p, '+-'))
      at = p%at
      operator = p%s(at:at)
      p%at = at + 1
      call read_term(p, parameters, right)
      call combine(p, at, operator, right, value)
      if (p%failed) return
    end do
  end subroutine read_sum

  recursive subroutine read_term(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    real(wp) :: right
    character(len=1) :: operator
    integer :: at

    call read_signed(p, parameters, value)
    do while (next_is(p, '*/'))
      at = p%at
      operator = p%s(at:at)
      p%at = at + 1
      if (operator == '*' .and. next_is(p, '*')) call stop_at(p, at, 'a power is written ''^'', not ''**''')
      if (p%failed) return
      call read_signed(p, parameters, right)
      call combine(p, at, operator, right, value)
      if (p%failed) return
    end do
  end subroutine read_term

  recursive subroutine read_signed(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    logical :: minus

    value = 0
    if (p%failed) return
    if (p%depth >= deepest) then
      call stop_at(p, p%at, 'the expression is nested too deeply')
      return
    end if
    p%depth = p%depth + 1
    if (next_is(p, '+-')) then
      minus = next_is(p, '-')
      p%at = p%at + 1
      call read_signed(p, parameters, value)
      if (minus) value = -value
    else
      call read_power(p, parameters, value)
    end if
    p%depth = p%depth - 1
  end subroutine read_signed

  recursive subroutine read_power(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    real(wp) :: exponent
    integer :: at

    call read_primary(p, parameters, value)
    if (.not. next_is(p, '^')) return
    at = p%at
    p%at = at + 1
    call read_signed(p, parameters, exponent)
    call combine(p, at, '^', exponent, value)
  end subroutine read_power

  !> The value becomes that of the operator with what stands right of it.
  subroutine combine(p, at, operator, right, value)
    type(parser_t), intent(inout) :: p
    integer, intent(in) :: at   !! character of the operator
    character(len=1), intent(in) :: operator
    real(wp), intent(in) :: right
    real(wp), intent(inout) :: value
    character(len=:), allocatable :: mistake
    real(wp) :: left

    if (p%failed) return
    left = value
    call apply_operator(operator, left, right, value, mistake)
    if (mistake /= '') call stop_at(p, at, mistake)
  end subroutine combine

  recursive subroutine read_primary(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value

    value = 0
    if (p%failed) return
    if (next_is(p, digits//'.')) then
      call read_number(p, value)
    else if (next_is(p, '$')) then
      call read_parameter(p, parameters, value)
    else if (next_is(p, '(')) then
      p%at = p%at + 1
      call read_sum(p, parameters, value)
      call skip(p, ')')
    else if (next_is(p, letters)) then
      call read_function(p, parameters, value)
    else
      call expected(p, 'a number')
    end if
  end subroutine read_primary

  subroutine read_parameter(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    character(len=:), allocatable :: name, message
    integer :: first, i

    value = 0
    first = p%at
    p%at = first + 1
    call take(p, name_letters, name)
    if (name == '') then
      call expected(p, 'the name of a parameter after ''$''')
      return
    end if
    i = parameters%find(name)
    if (i == 0) then
      call parameters%unknown(name, message)
      call stop_at(p, first, message)
    else if (parameters%items(i)%faulty) then
      call stop_at(p, first, '')
    else if (.not. parameters%items(i)%numeric) then
      call stop_at(p, first, 'expected a number, but parameter ''$'//name//''' is the word '''//parameters%items(i)%text//'''')
    else
      value = parameters%items(i)%value
    end if
  end subroutine read_parameter

  recursive subroutine read_function(p, parameters, value)
    type(parser_t), intent(inout) :: p
    type(parameters_t), intent(in) :: parameters
    real(wp), intent(out) :: value
    character(len=:), allocatable :: name, nearest, mistake
    type(string_t) :: known(size(functions))
    real(wp) :: x, y
    integer :: first, i

    value = 0
    first = p%at
    call take(p, name_letters, name)
    if (.not. next_is(p, '(')) then
      if (name == 'pi') then
        value = pi
      else if (p%placed .and. name == 'x') then
        value = p%place(1)
      else if (p%placed .and. name == 'y') then
        value = p%place(2)
      else
        call stop_at(p, first, 'expected a number, found '''//name//'''; a parameter is written $name')
      end if
      return
    end if
    if (all(functions /= name)) then
      do i = 1, size(functions)
        known(i)%s = trim(functions(i))
      end do
      nearest = nearest_word(name, known)
      if (nearest /= '') nearest = '; nearest: '''//nearest//''''
      call stop_at(p, first, 'unknown function '''//name//''''//nearest)
      return
    end if
    p%at = p%at + 1
    call read_sum(p, parameters, x)
    y = 0
    if (name == 'min' .or. name == 'max') then
      call skip(p, ',')
      if (.not. p%failed) call read_sum(p, parameters, y)
    end if
    call skip(p, ')')
    if (p%failed) return
    call apply_function(name, x, y, value, mistake)
    if (mistake /= '') call stop_at(p, first, mistake)
  end subroutine read_function

end module deck_expression
