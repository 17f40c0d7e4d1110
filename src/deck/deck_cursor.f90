!> Typed reading of the fields of one card, with messages that state what is expected.
!>
!>     call cursor%open(deck%cards(i), diagnostics)
!>     call cursor%name('the name of a die', dies, die)
!>     call cursor%real('the penetration', value, lower=0.0_wp, strict_lower=.true.)
!>     call cursor%end_card()
!>
!> After the first mistake on a card the cursor is silent: it gives harmless values, and no more rows.
module deck_cursor
  use card_position, only: card_position_t
  use deck_field, only: deck_field_t
  use kinds, only: eps, wp
  use text, only: join, nearest_word, string_t, to_text
  implicit none
  private
  public :: cursor_t

  !> An expression such as 0.1*30 misses its integer by a few roundings; no typing error is that small.
  real(wp), parameter :: integer_tolerance = 8*eps
  !> As many known words are listed when none is near.
  integer, parameter :: most_listed = 8

  type, extends(card_position_t) :: cursor_t
  contains
    procedure :: word => read_word
    procedure :: name => read_name
    procedure :: real => read_real
    procedure :: real_or_formula => read_real_or_formula
    procedure :: integer => read_integer
    procedure :: text => read_text
  end type cursor_t

contains

  !> The next field, which must be a word. `what` completes 'expected ...'.
  subroutine read_word(self, what, value)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    character(len=:), allocatable, intent(out) :: value
    type(deck_field_t) :: field

    value = ''
    call self%take(what, field)
    if (self%failed()) return
    if (field%numeric) then
      call self%expected(what, field)
    else
      value = field%text
    end if
  end subroutine read_word

  !> The next field, which must be one of `known`: its index there, 0 after a mistake. The message proposes those that are `meant`.
  subroutine read_name(self, what, known, index, meant)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    type(string_t), intent(in) :: known(:)   !! (nknown)
    integer, intent(out) :: index
    type(string_t), intent(in), optional :: meant(:)   !! (n) all where it is not present
    type(deck_field_t) :: field

    index = 0
    call self%take(what, field)
    if (self%failed()) return
    if (.not. field%numeric) then
      do index = 1, size(known)
        if (known(index)%s == field%text) return
      end do
    end if
    index = 0
    if (present(meant)) then
      call self%expected(what, field, proposal(what, field, meant))
    else
      call self%expected(what, field, proposal(what, field, known))
    end if
  end subroutine read_name

  !> The nearest of some names, or all of them where they are few and `what` does not list them.
  pure function proposal(what, field, names) result(words)
    character(len=*), intent(in) :: what
    type(deck_field_t), intent(in) :: field
    type(string_t), intent(in) :: names(:)   !! (n)
    character(len=:), allocatable :: words

    words = nearest_word(field%text, names)
    if (field%numeric .and. words == field%text) then
      words = ', a number: write the name in quotes'
    else if (words /= '') then
      words = '; nearest: '''//words//''''
    else if (size(names) == 0) then
      words = '; there is none yet'
    else if (size(names) <= most_listed .and. index(what, 'one of ') /= 1) then
      words = '; known: '''//join(names, ''' ''')//''''
    end if
  end function proposal

  !> The next field, which must be a number within [lower, upper]; a strict bound itself is refused.
  !> `unit` only goes into the message.
  subroutine read_real(self, what, value, lower, upper, strict_lower, strict_upper, unit)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    real(wp), intent(out) :: value
    real(wp), intent(in), optional :: lower, upper
    logical, intent(in), optional :: strict_lower, strict_upper
    character(len=*), intent(in), optional :: unit
    character(len=:), allocatable :: wanted
    type(deck_field_t) :: field
    logical :: above, below, outside

    above = .false.
    below = .false.
    if (present(strict_lower)) above = strict_lower
    if (present(strict_upper)) below = strict_upper
    wanted = what//''
    if (present(unit)) wanted = what//' ('//unit//')'
    call add_bounds(wanted, lower, upper, above, below)
    call self%take(wanted, field)
    if (.not. self%failed()) then
      outside = .not. field%numeric
      if (present(lower)) outside = outside .or. field%value < lower .or. (above .and. field%value <= lower)
      if (present(upper)) outside = outside .or. field%value > upper .or. (below .and. field%value >= upper)
      value = field%value
      if (outside) call self%expected(wanted, field)
    end if
    if (self%failed()) value = harmless(lower, upper, above, below)
  end subroutine read_real

  !> The next field, which must be a number, or an expression in x and y (deck_expression): then `formula` is not empty.
  subroutine read_real_or_formula(self, what, value, formula, unit)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    real(wp), intent(out) :: value
    character(len=:), allocatable, intent(out) :: formula
    character(len=*), intent(in) :: unit
    type(deck_field_t) :: field

    value = 0
    formula = ''
    call self%take(what//' ('//unit//')', field)
    if (self%failed()) return
    if (field%numeric) then
      value = field%value
    else if (allocated(field%formula)) then
      formula = field%formula
    else
      call self%expected(what//' ('//unit//')', field)
    end if
  end subroutine read_real_or_formula

  !> The next field, which must be a whole number within [lower, upper].
  subroutine read_integer(self, what, value, lower, upper)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    integer, intent(out) :: value
    integer, intent(in), optional :: lower, upper
    character(len=:), allocatable :: wanted
    type(deck_field_t) :: field
    real(wp) :: rounded, low, high
    logical :: outside

    low = -huge(low)
    high = huge(high)
    if (present(lower)) low = real(lower, wp)
    if (present(upper)) high = real(upper, wp)
    wanted = what//', a whole number'
    call add_bounds(wanted, low, high, .false., .false.)

    value = 0
    if (present(upper)) value = min(value, upper)
    if (present(lower)) value = lower
    call self%take(wanted, field)
    if (self%failed()) return
    rounded = anint(field%value)
    outside = .not. field%numeric .or. abs(rounded) > real(huge(value), wp) &
      .or. abs(field%value - rounded) > integer_tolerance*max(1.0_wp, abs(rounded))
    if (outside .or. rounded < low .or. rounded > high) then
      call self%expected(wanted, field)
    else
      value = nint(rounded)
    end if
  end subroutine read_integer

  !> The one text of a TITLE card.
  subroutine read_text(self, what, value)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    character(len=:), allocatable, intent(out) :: value
    type(deck_field_t) :: field

    value = ''
    call self%take(what, field)
    if (.not. self%failed()) value = field%text
  end subroutine read_text

  !> Complete 'expected ...' with the bounds, if there are any.
  pure subroutine add_bounds(wanted, lower, upper, strict_lower, strict_upper)
    character(len=:), allocatable, intent(inout) :: wanted
    real(wp), intent(in), optional :: lower, upper
    logical, intent(in) :: strict_lower, strict_upper
    character(len=:), allocatable :: separator

    separator = ', '
    if (present(lower)) then
      if (lower > -huge(lower)) then
        wanted = wanted//separator//trim(merge('above   ', 'at least', strict_lower))//' '//to_text(lower, 10)
        separator = ' and '
      end if
    end if
    if (present(upper)) then
      if (upper < huge(upper)) wanted = wanted//separator//trim(merge('below  ', 'at most', strict_upper))//' '//to_text(upper, 10)
    end if
  end subroutine add_bounds

  !> A number within the bounds, so that a mistake causes no further ones.
  pure function harmless(lower, upper, strict_lower, strict_upper) result(value)
    real(wp), intent(in), optional :: lower, upper
    logical, intent(in) :: strict_lower, strict_upper
    real(wp) :: value

    value = 0
    if (present(upper)) value = min(value, upper - merge(1, 0, strict_upper))
    if (present(lower)) value = lower + merge(1, 0, strict_lower)
    if (present(lower) .and. present(upper)) then
      value = lower
      if (strict_lower) value = 0.5_wp*(lower + upper)
    end if
  end function harmless

end module deck_cursor
