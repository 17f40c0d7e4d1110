!> Arithmetic in a field: `+ - * / ^ ( )`, functions, `pi`, parameters `$name`; no blanks.
!>
!>     sum     = term   { (+|-) term }
!>     term    = signed { (*|/) signed }
!>     signed  = (+|-) signed | power
!>     power   = primary [ ^ signed ]                so -2^2 = -4, 2^3^2 = 2^9, 2^-1 = 0.5
!>     primary = number | $name | pi | x | y | function(sum [, sum]) | (sum)
!>
!> The place, x and y, is known where a formula is evaluated at one.
!> Overflow and division by zero are found before they happen, since debug builds trap them.
module deck_expression
  use kinds, only: pi, wp
  use deck_field, only: digits, letters
  use deck_parameters, only: parameters_t
  use text, only: nearest_word, string_t
  implicit none
  private
  public :: evaluate, fill_in, is_formula, looks_numeric

  !> Brackets, signs and powers within one another; deeper is no typing error but a damaged file.
  integer, parameter :: deepest = 60
  character(len=*), parameter :: name_letters = letters//digits//'_'
  character(len=*), parameter :: operators = '+-*/^'
  character(len=*), parameter :: functions(10) = &
    ['sqrt', 'exp ', 'log ', 'sin ', 'cos ', 'tan ', 'atan', 'abs ', 'min ', 'max ']
  character(len=*), parameter :: too_large = 'the result is too large'
  !> exp() of more than this overflows: ln(huge) = 709.78.
  real(wp), parameter :: largest_exponent = 709.0_wp

  !> An expression, how far it is read, and what is wrong with it.
  type :: parser_t
    character(len=:), allocatable :: s
    integer :: at = 1
    integer :: depth = 0
    logical :: failed = .false.
    integer :: failed_at = 0
    character(len=:), allocatable :: message
    !> x and y are known.
    logical :: placed = .false.
    real(wp) :: place(2) = 0.0_wp
  end type parser_t

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

  !> Whether a field that is not quoted is meant as a number. `pi` is one, `./file` is none;
  !> a lone `$name` is for the caller to decide.
  pure function looks_numeric(s) result(numeric)
    character(len=*), intent(in) :: s
    logical :: numeric
    integer :: n

    numeric = .false.
    if (len(s) == 0) return
    if (scan(s(1:1), digits//'+-.($') == 1) then
      numeric = index(s, './') /= 1 .and. index(s, '../') /= 1
      return
    end if
    n = verify(s//' ', name_letters) - 1
    if (n == 0) return
    if (n == len(s)) then
      numeric = s == 'pi'
    else
      numeric = s(n + 1:n + 1) == '(' .or. (s(:n) == 'pi' .and. scan(s(n + 1:n + 1), operators) == 1)
    end if
  end function looks_numeric

  !> Whether a field that is not quoted is an expression in x and y.
  pure function is_formula(s) result(yes)
    character(len=*), intent(in) :: s
    logical :: yes
    integer :: first, n

    yes = looks_numeric(s)
    if (.not. yes .and. len(s) > 0) then
      ! x or y alone, or before an operator
      yes = scan(s(1:1), 'xy') == 1
      if (yes .and. len(s) > 1) yes = scan(s(2:2), operators) == 1
    end if
    if (.not. yes) return
    first = 1
    do while (first <= len(s))
      n = verify(s(first:)//' ', name_letters//'.$') - 1
      if (n == 1) then
        if (scan(s(first:first), 'xy') == 1) return
      end if
      first = first + max(n, 1)
    end do
    yes = .false.
  end function is_formula

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
      if (p%failed) return
      if (operator == '-') right = -right
      if (abs(0.5_wp*value + 0.5_wp*right) > 0.5_wp*huge(value)) then
        call stop_at(p, at, too_large)
        return
      end if
      value = value + right
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
      if (p%failed) return
      if (operator == '/' .and. abs(right) <= 0) then
        call stop_at(p, at, 'division by zero')
      else if (overflows(operator, value, right)) then
        call stop_at(p, at, too_large)
      else if (operator == '*') then
        value = value*right
      else
        value = value/right
      end if
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
    real(wp) :: base, exponent
    integer :: at

    call read_primary(p, parameters, value)
    if (.not. next_is(p, '^')) return
    at = p%at
    p%at = at + 1
    base = value
    call read_signed(p, parameters, exponent)
    if (p%failed) return
    if (abs(base) <= 0) then
      if (exponent < 0) call stop_at(p, at, 'division by zero')
      value = merge(1.0_wp, 0.0_wp, abs(exponent) <= 0)
    else if (base < 0 .and. abs(exponent - anint(exponent)) > 0) then
      call stop_at(p, at, 'a negative number has no broken power')
    else if (abs(exponent) > huge(base)*1.0e-3_wp) then
      call stop_at(p, at, too_large)
    else if (exponent*log(abs(base)) > largest_exponent) then
      call stop_at(p, at, too_large)
    else
      value = abs(base)**exponent
      if (base < 0 .and. abs(mod(exponent, 2.0_wp)) > 0.5_wp) value = -value
    end if
  end subroutine read_power

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

  !> Fortran's forms: 1 1. .5 1.5 1.E-3 1.D-3 1e3.
  subroutine read_number(p, value)
    type(parser_t), intent(inout) :: p
    real(wp), intent(out) :: value
    character(len=:), allocatable :: whole, part, scale, hint
    integer :: first, power, lead, status

    value = 0
    first = p%at
    call take(p, digits, whole)
    part = ''
    if (next_is(p, '.')) then
      p%at = p%at + 1
      call take(p, digits, part)
    end if
    scale = '0'
    if (next_is(p, 'eEdD')) call read_scale(p, scale)
    if (len(whole) + len(part) == 0 .or. next_is(p, name_letters//'.')) then
      call take(p, name_letters//'.', part)
      hint = ''
      ! more than one letter: a name of a steel, such as 42CrMo4, rather than a number
      if (len(whole) > 0 .and. len(part) > 1 .and. scan(part, '.') == 0) &
        hint = ' (a name that begins with a digit stands in quotes)'
      call stop_at(p, first, 'malformed number '''//p%s(first:p%at - 1)//''''//hint)
      return
    end if
    ! The power of ten is checked before the conversion, which would trap on an overflow.
    lead = verify(whole//part, '0')
    if (lead == 0) return
    power = 9999
    if (len(scale) <= 5) then
      read (scale, *, iostat=status) power
      if (status /= 0) power = 9999
    end if
    power = power + len(whole) - lead
    if (abs(power) > 307) then
      call stop_at(p, first, 'the number '''//p%s(first:p%at - 1)//''' is out of the range of the machine')
      return
    end if
    if (whole == '') whole = '0'
    if (part == '') part = '0'
    whole = whole//'.'//part//'e'//scale
    read (whole, *, iostat=status) value
    if (status /= 0) call stop_at(p, first, 'malformed number '''//p%s(first:p%at - 1)//'''')
  end subroutine read_number

  !> Digits after the exponent letter, with their sign; nothing is taken when there are none.
  subroutine read_scale(p, scale)
    type(parser_t), intent(inout) :: p
    character(len=:), allocatable, intent(inout) :: scale
    character(len=:), allocatable :: sign
    integer :: letter

    letter = p%at
    p%at = letter + 1
    sign = ''
    if (next_is(p, '+-')) then
      sign = p%s(p%at:p%at)
      p%at = p%at + 1
    end if
    if (next_is(p, digits)) then
      call take(p, digits, scale)
      do while (len(scale) > 1 .and. scale(1:1) == '0')
        scale = scale(2:)
      end do
      scale = sign//scale
    else
      p%at = letter
    end if
  end subroutine read_scale

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
    character(len=:), allocatable :: name, nearest
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
    call apply(p, first, name, x, y, value)
  end subroutine read_function

  subroutine apply(p, first, name, x, y, value)
    type(parser_t), intent(inout) :: p
    integer, intent(in) :: first
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: x, y
    real(wp), intent(out) :: value

    value = 0
    select case (name)
    case ('sqrt')
      if (x < 0) then
        call stop_at(p, first, 'square root of a negative number')
      else
        value = sqrt(x)
      end if
    case ('exp')
      if (x > largest_exponent) then
        call stop_at(p, first, too_large)
      else
        value = exp(x)
      end if
    case ('log')
      if (x <= 0) then
        call stop_at(p, first, 'logarithm of a number which is not positive')
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
  end subroutine apply

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

  pure function next_is(p, set) result(yes)
    type(parser_t), intent(in) :: p
    character(len=*), intent(in) :: set
    logical :: yes

    yes = .false.
    if (.not. p%failed .and. p%at <= len(p%s)) yes = index(set, p%s(p%at:p%at)) > 0
  end function next_is

  !> The run of characters of `set` from here on, perhaps empty.
  pure subroutine take(p, set, run)
    type(parser_t), intent(inout) :: p
    character(len=*), intent(in) :: set
    character(len=:), allocatable, intent(out) :: run
    integer :: n

    n = verify(p%s(p%at:), set) - 1
    if (n < 0) n = len(p%s) - p%at + 1
    run = p%s(p%at:p%at + n - 1)
    p%at = p%at + n
  end subroutine take

  pure subroutine skip(p, mark)
    type(parser_t), intent(inout) :: p
    character(len=1), intent(in) :: mark

    if (p%failed) return
    if (next_is(p, mark)) then
      p%at = p%at + 1
    else
      call expected(p, ''''//mark//'''')
    end if
  end subroutine skip

  pure subroutine expected(p, what)
    type(parser_t), intent(inout) :: p
    character(len=*), intent(in) :: what

    if (p%at > len(p%s)) then
      call stop_at(p, len(p%s) + 1, 'expected '//what//' at the end of '''//p%s//'''')
    else
      call stop_at(p, p%at, 'expected '//what//', found '''//p%s(p%at:p%at)//''' in '''//p%s//'''')
    end if
  end subroutine expected

  !> The first mistake of an expression is the one to report.
  pure subroutine stop_at(p, at, message)
    type(parser_t), intent(inout) :: p
    integer, intent(in) :: at
    character(len=*), intent(in) :: message

    if (p%failed) return
    p%failed = .true.
    p%failed_at = at
    p%message = message
  end subroutine stop_at

end module deck_expression
