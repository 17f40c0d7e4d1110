!> An expression that is being read: how far, its numbers, and the first mistake.
module expression_parser
  use deck_field, only: digits
  use expression_forms, only: name_letters
  use kinds, only: wp
  implicit none
  private
  public :: parser_t, next_is, take, skip, expected, stop_at, read_number

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
      ! more than one letter: a name of a steel or of a file, such as 42CrMo4 or 42crmo4.met, rather than a number
      if (len(whole) > 0 .and. len(part) > 1 .and. .not. (scan(part, '.') == 1 .or. scan(part, '.') == len(part))) &
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

end module expression_parser
