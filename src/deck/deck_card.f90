!> A deck as its reader delivers it: cards, rows, fields.
module deck_card
  use deck_field, only: deck_field_t, letters
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: wp
  use text, only: nearest_word, string_t
  implicit none
  private
  public :: deck_field_t, row_t, card_t, deck_t, refuse_other_kind, refuse_unknown, fingerprint_text
  public :: of_scene, of_point, of_steels

  !> What a file of cards may be: each has a card that the others have not, and a way to be read.
  integer, parameter :: of_scene = 1, of_point = 2, of_steels = 3
  character(len=*), parameter :: marks(3) = ['STATE', 'PATH ', 'STEEL']
  character(len=28), parameter :: kinds(3) = [character(len=28) :: 'a deck of a scene', 'a deck of one point of a law', &
                                              'a file of steels']
  character(len=21), parameter :: calls(3) = [character(len=21) :: 'lagamine DECK', 'lagamine --point DECK', 'lagamine --met FILE']

  !> The fields of one line, the keyword left out.
  type :: row_t
    type(deck_field_t), allocatable :: fields(:)
    integer :: file = 0
    integer :: line = 0
  end type row_t

  !> A keyword, the fields after it, and its data rows.
  type :: card_t
    character(len=:), allocatable :: keyword
    type(row_t) :: head
    type(row_t), allocatable :: rows(:)
    !> A cursor has been opened on it.
    logical :: taken = .false.
    !> It belongs to another operation than the one that is read, and has no keyword here.
    logical :: elsewhere = .false.
  end type card_t

  !> A deck: its cards, and the text from which the same cards can be read again.
  type :: deck_t
    character(len=:), allocatable :: path
    !> Included files in place, overrides at the head, comments gone.
    character(len=:), allocatable :: text
    type(card_t), allocatable :: cards(:)
    !> False when a file could not be read: nothing is reported then of names that are missing.
    logical :: complete = .true.
  end type deck_t

contains

  !> One error where the file is of another kind than what is read: what it lacks of this one is not reported.
  subroutine refuse_other_kind(deck, kind, diagnostics, refused)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: kind   !! what is read
    type(diagnostics_t), intent(inout) :: diagnostics
    logical, intent(out) :: refused
    integer :: i, k, found

    refused = .false.
    found = 0
    do i = size(deck%cards), 1, -1
      do k = 1, size(marks)
        if (deck%cards(i)%keyword /= marks(k)) cycle
        if (k == kind) return
        found = i
      end do
    end do
    if (found == 0) return
    refused = .true.
    do k = 1, size(marks)
      if (deck%cards(found)%keyword == marks(k)) &
        call diagnostics%add(location_t(deck%cards(found)%head%file, deck%cards(found)%head%line, 1), trim(marks(k)), &
                             'this is '//trim(kinds(k))//', expected '//trim(kinds(kind))//'; '''//trim(calls(k)) &
                             //''' reads it')
    end do
  end subroutine refuse_other_kind

  !> An error for each card whose keyword is none of the known.
  subroutine refuse_unknown(deck, known_keywords, diagnostics)
    type(deck_t), intent(in) :: deck
    type(string_t), intent(in) :: known_keywords(:)   !! (nkeyword)
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: i, k

    do i = 1, size(deck%cards)
      if (deck%cards(i)%elsewhere) cycle
      do k = 1, size(known_keywords)
        if (known_keywords(k)%s == deck%cards(i)%keyword) exit
      end do
      if (k <= size(known_keywords)) cycle
      call diagnostics%add(location_t(deck%cards(i)%head%file, deck%cards(i)%head%line, 1), deck%cards(i)%keyword, &
                           'there is no such card'//advice_on(deck%cards(i)%keyword, known_keywords))
    end do
  end subroutine refuse_unknown

  !> What was meant by a keyword that is none: a data row, a card of another kind of file, a known one misspelt.
  pure function advice_on(keyword, known_keywords) result(advice)
    character(len=*), intent(in) :: keyword
    type(string_t), intent(in) :: known_keywords(:)   !! (nkeyword)
    character(len=:), allocatable :: advice
    integer :: k

    if (scan(keyword(1:1), letters) == 0) then
      advice = '; a data row begins with a blank'
      return
    end if
    do k = 1, size(marks)
      if (keyword /= marks(k)) cycle
      advice = ' here; it makes '//trim(kinds(k))//', which '''//trim(calls(k))//''' reads'
      return
    end do
    advice = nearest_word(keyword, known_keywords)
    if (advice /= '') advice = '; nearest: '''//advice//''''
  end function advice_on

  !> What the cards say and nothing else, for a fingerprint which does not change with comments, blanks,
  !> file names or the way a number is written. One line per row; numbers with all their digits.
  subroutine fingerprint_text(deck, text)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable, intent(out) :: text
    integer :: pass, length, i, j

    do pass = 1, 2
      length = 0
      do i = 1, size(deck%cards)
        call put(deck%cards(i)%keyword)
        call put_row(deck%cards(i)%head)
        do j = 1, size(deck%cards(i)%rows)
          call put_row(deck%cards(i)%rows(j))
        end do
      end do
      if (pass == 1) allocate (character(len=length) :: text)
    end do

  contains

    subroutine put_row(row)
      type(row_t), intent(in) :: row
      ! Sign, one digit, point, 16 digits, exponent: every number has this width.
      character(len=24) :: number
      integer :: k

      do k = 1, size(row%fields)
        if (row%fields(k)%numeric) then
          ! Adding zero makes -0 the same as 0.
          if (pass == 2) write (number, '(es24.16e3)') row%fields(k)%value + 0.0_wp
          call put(' '//number)
        else
          call put(' '''//row%fields(k)%text//'''')
        end if
      end do
      call put(new_line('a'))
    end subroutine put_row

    subroutine put(one)
      character(len=*), intent(in) :: one

      if (pass == 2) text(length + 1:length + len(one)) = one
      length = length + len(one)
    end subroutine put

  end subroutine fingerprint_text

end module deck_card
