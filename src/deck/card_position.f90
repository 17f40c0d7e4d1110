!> Where the reading of one card stands: its rows and fields, what comes next, and the first mistake.
!>
!> After the first mistake the position is silent: it gives no more fields or rows.
!> It is a view: the card and the diagnostics belong to the caller, who declares them `target`.
module card_position
  use deck_card, only: card_t, row_t
  use deck_field, only: deck_field_t, keyword_letters
  use diagnostics, only: diagnostics_t, location_t
  use text, only: to_text, upper_case
  implicit none
  private
  public :: card_position_t

  type :: card_position_t
    private
    type(card_t), pointer :: card => null()
    type(diagnostics_t), pointer :: diagnostics => null()
    !> Row and field last read; row 0 is the line of the keyword.
    integer :: row = 0
    integer :: field = 0
    logical :: silent = .true.
  contains
    procedure :: open => open_card
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
    procedure :: take
    procedure :: expected
    procedure, private :: nfield
  end type card_position_t

contains

  !> Stand before the first field after the keyword, and mark the card as taken.
  subroutine open_card(self, card, diagnostics)
    class(card_position_t), intent(inout) :: self
    type(card_t), intent(inout), target :: card
    type(diagnostics_t), intent(inout), target :: diagnostics

    self%card => card
    self%diagnostics => diagnostics
    self%row = 0
    self%field = 0
    self%silent = .false.
    card%taken = .true.
  end subroutine open_card

  !> Fields are left in this row.
  pure function more(self) result(yes)
    class(card_position_t), intent(in) :: self
    logical :: yes

    yes = .false.
    if (.not. self%silent) yes = self%field < self%nfield()
  end function more

  !> The next field in capital letters; empty when there is none or it is a number.
  pure function peek_word(self) result(word)
    class(card_position_t), intent(in) :: self
    character(len=:), allocatable :: word

    word = upper_case(self%peek_name())
  end function peek_word

  !> The same as it is written.
  pure function peek_name(self) result(name)
    class(card_position_t), intent(in) :: self
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
    class(card_position_t), intent(in) :: self
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
    class(card_position_t), intent(inout) :: self
    type(deck_field_t) :: field

    if (.not. self%more()) return
    call self%take('', field)
    if (.not. self%silent) call self%expected('the end of the line', field)
  end subroutine end_row

  !> Data rows are left on this card.
  pure function more_rows(self) result(yes)
    class(card_position_t), intent(in) :: self
    logical :: yes

    yes = .false.
    if (.not. self%silent) yes = self%row < size(self%card%rows)
  end function more_rows

  !> The first field of the next data row in capital letters; empty when there is none or it is a number.
  pure function peek_row(self) result(word)
    class(card_position_t), intent(in) :: self
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
    class(card_position_t), intent(inout) :: self
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
    class(card_position_t), intent(inout) :: self
    type(deck_field_t) :: field

    call self%end_row()
    if (.not. self%more_rows()) return
    self%row = self%row + 1
    self%field = 0
    call self%take('', field)
    if (self%silent) return
    call self%expected('no more data rows', field)
  end subroutine end_card

  !> A mistake of the caller's own finding, at the field last read.
  subroutine fail_here(self, message)
    class(card_position_t), intent(inout) :: self
    character(len=*), intent(in) :: message

    if (.not. self%silent) call self%diagnostics%add(self%where(), self%card%keyword, message)
    self%silent = .true.
  end subroutine fail_here

  !> Judge no more of this card: what it means is not known, because of mistakes on other cards.
  subroutine leave(self)
    class(card_position_t), intent(inout) :: self

    self%silent = .true.
  end subroutine leave

  !> A mistake on this card has been recorded, or it was left because of others.
  pure function failed(self) result(yes)
    class(card_position_t), intent(in) :: self
    logical :: yes

    yes = self%silent
  end function failed

  !> Place of the field last read; of the line when none is.
  pure function place_of_last(self) result(where)
    class(card_position_t), intent(in) :: self
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
    class(card_position_t), intent(in) :: self
    integer :: n

    if (self%row == 0) then
      n = size(self%card%head%fields)
    else
      n = size(self%card%rows(self%row)%fields)
    end if
  end function nfield

  !> Step onto the next field. One which is missing is reported; one whose mistake is known turns the cursor silent.
  subroutine take(self, what, field)
    class(card_position_t), intent(inout) :: self
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
    class(card_position_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    type(deck_field_t), intent(in) :: field
    character(len=*), intent(in), optional :: hint
    character(len=:), allocatable :: message, advice

    message = 'expected '//what//', found '''//field%text//''''
    if (field%numeric .and. verify(field%text, '0123456789+-.eEdD') > 0) message = message//' (= '//to_text(field%value)//')'
    advice = ''
    if (present(hint)) then
      advice = hint
    else if (allocated(field%formula) .and. len(field%text) > 1) then
      advice = ': x and y are not known here'
    end if
    if (advice == '' .and. self%row > 0 .and. self%field == 1 .and. is_like_keyword(field)) &
      advice = '; should it be a card, it begins in column 1'
    call self%fail(message//advice)
  end subroutine expected

  !> A field that may be the keyword of a card.
  pure function is_like_keyword(field) result(yes)
    type(deck_field_t), intent(in) :: field
    logical :: yes

    yes = len(field%text) > 2 .and. verify(field%text, keyword_letters) == 0 .and. .not. field%numeric
  end function is_like_keyword

end module card_position
