!> Typed reading of the fields of one card, with messages that state what is expected.
!>
!>     call cursor%open(deck%cards(i), diagnostics)
!>     call cursor%name('the name of a die', dies, die)
!>     call cursor%real('the penetration', value, lower=0.0_wp, strict_lower=.true.)
!>     call cursor%end_card()
!>
!> After the first mistake on a card the cursor is silent: it gives harmless values, and no more rows.
!> It is a view: the card and the diagnostics belong to the caller, who declares them `target`.
module deck_cursor
  use deck_card, only: card_t, row_t
  use deck_field, only: deck_field_t
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: eps, wp
  use text, only: nearest_word, string_t, to_text, upper_case
  implicit none
  private
  public :: cursor_t

  !> An expression such as 0.1*30 misses its integer by a few roundings; no typing error is that small.
  real(wp), parameter :: integer_tolerance = 8*eps
  !> As many known words are listed when none is near.
  integer, parameter :: most_listed = 8

  type :: cursor_t
    private
    type(card_t), pointer :: card => null()
    type(diagnostics_t), pointer :: diagnostics => null()
    !> Row and field last read; row 0 is the line of the keyword.
    integer :: row = 0
    integer :: field = 0
    logical :: silent = .true.
  contains
    procedure :: open => open_card
    procedure :: word => read_word
    procedure :: name => read_name
    procedure :: real => read_real
    procedure :: real_or_formula => read_real_or_formula
    procedure :: integer => read_integer
    procedure :: text => read_text
    procedure :: more
    procedure :: peek_word
    procedure :: peek_name
    procedure :: next_is_number
    procedure :: end_row
    procedure :: more_rows
    procedure :: peek_row
    procedure :: next_row
    procedure :: end_card
    procedure :: fail => fail_here
    procedure :: leave
    procedure :: failed
    procedure :: where => place_of_last
    procedure, private :: nfield
    procedure, private :: take
    procedure, private :: expected
  end type cursor_t

contains

  !> Stand before the first field after the keyword, and mark the card as taken.
  subroutine open_card(self, card, diagnostics)
    class(cursor_t), intent(inout) :: self
    type(card_t), intent(inout), target :: card
    type(diagnostics_t), intent(inout), target :: diagnostics

    self%card => card
    self%diagnostics => diagnostics
    self%row = 0
    self%field = 0
    self%silent = .false.
    card%taken = .true.
  end subroutine open_card

  !> The next field, which must be a word. `what` completes 'expected ...'.
  subroutine read_word(self, what, value)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    character(len=:), allocatable, intent(out) :: value
    type(deck_field_t) :: field

    value = ''
    call self%take(what, field)
    if (self%silent) return
    if (field%numeric) then
      call self%expected(what, field)
    else
      value = field%text
    end if
  end subroutine read_word

  !> The next field, which must be one of `known`: its index there, 0 after a mistake.
  subroutine read_name(self, what, known, index)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    type(string_t), intent(in) :: known(:)   !! (nknown)
    integer, intent(out) :: index
    type(deck_field_t) :: field
    character(len=:), allocatable :: nearest
    integer :: i

    index = 0
    call self%take(what, field)
    if (self%silent) return
    if (.not. field%numeric) then
      do index = 1, size(known)
        if (known(index)%s == field%text) return
      end do
    end if
    index = 0
    nearest = nearest_word(field%text, known)
    if (field%numeric .and. nearest == field%text) then
      nearest = ', a number: write the name in quotes'
    else if (nearest /= '') then
      nearest = '; nearest: '''//nearest//''''
    else if (size(known) == 0) then
      nearest = '; there is none yet'
    else if (size(known) <= most_listed) then
      nearest = '; known:'
      do i = 1, size(known)
        nearest = nearest//' '''//known(i)%s//''''
      end do
    end if
    call self%expected(what, field, nearest)
  end subroutine read_name

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
    if (.not. self%silent) then
      outside = .not. field%numeric
      if (present(lower)) outside = outside .or. field%value < lower .or. (above .and. field%value <= lower)
      if (present(upper)) outside = outside .or. field%value > upper .or. (below .and. field%value >= upper)
      value = field%value
      if (outside) call self%expected(wanted, field)
    end if
    if (self%silent) value = harmless(lower, upper, above, below)
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
    if (self%silent) return
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
    if (self%silent) return
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
    if (.not. self%silent) value = field%text
  end subroutine read_text

  !> Fields are left in this row.
  pure function more(self) result(yes)
    class(cursor_t), intent(in) :: self
    logical :: yes

    yes = .false.
    if (.not. self%silent) yes = self%field < self%nfield()
  end function more

  !> The next field in capital letters; empty when there is none or it is a number.
  pure function peek_word(self) result(word)
    class(cursor_t), intent(in) :: self
    character(len=:), allocatable :: word

    word = upper_case(self%peek_name())
  end function peek_word

  !> The same as it is written.
  pure function peek_name(self) result(name)
    class(cursor_t), intent(in) :: self
    character(len=:), allocatable :: name

    name = ''
    if (.not. self%more()) return
    if (self%row == 0) then
      if (.not. self%card%head%fields(self%field + 1)%numeric) name = self%card%head%fields(self%field + 1)%text
    else
      if (.not. self%card%rows(self%row)%fields(self%field + 1)%numeric) name = self%card%rows(self%row)%fields(self%field + 1)%text
    end if
  end function peek_name

  pure function next_is_number(self) result(yes)
    class(cursor_t), intent(in) :: self
    logical :: yes

    yes = .false.
    if (.not. self%more()) return
    if (self%row == 0) then
      yes = self%card%head%fields(self%field + 1)%numeric
    else
      yes = self%card%rows(self%row)%fields(self%field + 1)%numeric
    end if
  end function next_is_number

  !> Refuse fields that are left in this row.
  subroutine end_row(self)
    class(cursor_t), intent(inout) :: self
    type(deck_field_t) :: field

    if (.not. self%more()) return
    call self%take('', field)
    if (.not. self%silent) call self%expected('the end of the line', field)
  end subroutine end_row

  !> Data rows are left on this card.
  pure function more_rows(self) result(yes)
    class(cursor_t), intent(in) :: self
    logical :: yes

    yes = .false.
    if (.not. self%silent) yes = self%row < size(self%card%rows)
  end function more_rows

  !> The first field of the next data row in capital letters; empty when there is none or it is a number.
  pure function peek_row(self) result(word)
    class(cursor_t), intent(in) :: self
    character(len=:), allocatable :: word

    word = ''
    if (.not. self%more_rows()) return
    associate (fields => self%card%rows(self%row + 1)%fields)
      if (size(fields) == 0) return
      if (.not. fields(1)%numeric) word = upper_case(fields(1)%text)
    end associate
  end function peek_row

  !> Go to the next data row, which must be there; the row before must be read to its end.
  subroutine next_row(self, what)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what

    call self%end_row()
    if (self%silent) return
    if (self%more_rows()) then
      self%row = self%row + 1
      self%field = 0
    else
      call self%fail('expected a data row with '//what//', found no more rows')
    end if
  end subroutine next_row

  !> Refuse fields and rows that are left.
  subroutine end_card(self)
    class(cursor_t), intent(inout) :: self
    type(deck_field_t) :: field

    call self%end_row()
    if (.not. self%more_rows()) return
    self%row = self%row + 1
    self%field = 0
    call self%take('', field)
    if (self%silent) return
    if (len(field%text) > 2 .and. verify(field%text, 'ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789') == 0 .and. .not. field%numeric) then
      call self%expected('no more data rows', field, '; should it be a card, it begins in column 1')
    else
      call self%expected('no more data rows', field)
    end if
  end subroutine end_card

  !> A mistake of the caller's own finding, at the field last read.
  subroutine fail_here(self, message)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: message

    if (.not. self%silent) call self%diagnostics%add(self%where(), self%card%keyword, message)
    self%silent = .true.
  end subroutine fail_here

  !> Judge no more of this card: what it means is not known, because of mistakes on other cards.
  subroutine leave(self)
    class(cursor_t), intent(inout) :: self

    self%silent = .true.
  end subroutine leave

  !> A mistake on this card has been recorded, or it was left because of others.
  pure function failed(self) result(yes)
    class(cursor_t), intent(in) :: self
    logical :: yes

    yes = self%silent
  end function failed

  !> Place of the field last read; of the line when none is.
  pure function place_of_last(self) result(where)
    class(cursor_t), intent(in) :: self
    type(location_t) :: where

    if (.not. associated(self%card)) return
    if (self%row == 0) then
      call locate(self%card%head)
    else
      call locate(self%card%rows(self%row))
    end if

  contains

    pure subroutine locate(row)
      type(row_t), intent(in) :: row

      where = location_t(row%file, row%line, 1)
      if (self%field > 0) where%column = row%fields(self%field)%column
    end subroutine locate

  end function place_of_last

  pure function nfield(self) result(n)
    class(cursor_t), intent(in) :: self
    integer :: n

    if (self%row == 0) then
      n = size(self%card%head%fields)
    else
      n = size(self%card%rows(self%row)%fields)
    end if
  end function nfield

  !> Step onto the next field. One which is missing is reported; one whose mistake is known turns the cursor silent.
  subroutine take(self, what, field)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    type(deck_field_t), intent(out) :: field

    if (self%silent) return
    if (.not. self%more()) then
      call self%fail('expected '//what//', found the end of the line')
      return
    end if
    self%field = self%field + 1
    if (self%row == 0) then
      field = self%card%head%fields(self%field)
    else
      field = self%card%rows(self%row)%fields(self%field)
    end if
    self%silent = field%faulty
  end subroutine take

  !> 'expected ..., found ...' at the field; an expression is shown with its value.
  subroutine expected(self, what, field, hint)
    class(cursor_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    type(deck_field_t), intent(in) :: field
    character(len=*), intent(in), optional :: hint
    character(len=:), allocatable :: message

    message = 'expected '//what//', found '''//field%text//''''
    if (field%numeric .and. verify(field%text, '0123456789+-.eEdD') > 0) message = message//' (= '//to_text(field%value)//')'
    if (present(hint)) then
      message = message//hint
    else if (allocated(field%formula) .and. len(field%text) > 1) then
      message = message//': x and y are not known here'
    end if
    call self%fail(message)
  end subroutine expected

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
