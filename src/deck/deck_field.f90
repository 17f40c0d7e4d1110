!> Blank-separated fields of one line: where they begin, quotes, bytes that do not belong there.
!>
!> A quote, single or double, may only open a field: `'a b'`. What it holds is always a word and is taken as
!> it stands. TITLE has no quotes, so that an apostrophe may be written there.
module deck_field
  use kinds, only: wp
  use diagnostics, only: diagnostics_t, location_t
  use foreign_characters, only: foreign_words, is_letter, letter_length
  use text, only: upper_case
  implicit none
  private
  public :: deck_field_t, scan_fields, first_word, comment_column, is_title, keyword_letters, letters, digits

  character(len=*), parameter :: digits = '0123456789'
  character(len=*), parameter :: upper_letters = 'ABCDEFGHIJKLMNOPQRSTUVWXYZ'
  character(len=*), parameter :: letters = upper_letters//'abcdefghijklmnopqrstuvwxyz'
  character(len=*), parameter :: keyword_letters = upper_letters//digits
  character(len=*), parameter :: quotes = '''"'

  !> One field, a word or a number.
  type :: deck_field_t
    !> As written, without quotes; the word itself where a parameter stands for a word.
    character(len=:), allocatable :: text
    logical :: numeric = .false.
    logical :: quoted = .false.
    !> Its mistake is already recorded: reading it reports no other one.
    logical :: faulty = .false.
    real(wp) :: value = 0
    !> An expression in x and y, parameters filled in; not allocated for others.
    character(len=:), allocatable :: formula
    integer :: column = 0
  end type deck_field_t

contains

  !> The keyword of a line which is a card, empty for a data row.
  pure function first_word(line) result(word)
    character(len=*), intent(in) :: line
    character(len=:), allocatable :: word

    word = line(:index(line//' ', ' ') - 1)
  end function first_word

  !> Whether the line is a TITLE card, where quotes mean nothing (small letters are refused elsewhere).
  pure function is_title(line) result(title)
    character(len=*), intent(in) :: line
    logical :: title

    title = .false.
    if (len(line) < 5) return
    if (upper_case(line(:5)) /= 'TITLE') return
    title = len(line) == 5 .or. index(' !', line(6:min(6, len(line)))) > 0
  end function is_title

  !> Column of the `!` which starts a comment, or one past the end.
  pure function comment_column(line) result(column)
    character(len=*), intent(in) :: line
    integer :: column
    integer :: closing
    logical :: title, at_start

    title = is_title(line)
    at_start = .true.
    column = 1
    do while (column <= len(line))
      if (line(column:column) == '!') return
      if (at_start .and. .not. title .and. scan(line(column:column), quotes) == 1) then
        closing = index(line(column + 1:), line(column:column))
        if (closing == 0) then
          column = len(line)
        else
          column = column + closing
        end if
      end if
      at_start = line(column:column) == ' '
      column = column + 1
    end do
  end function comment_column

  !> All fields of `line` from column `start` on; no comment, no tabs. Mistakes are recorded at once.
  !> (`fields` is not intent(out): gfortran 12 warns of the caller's empty array then.)
  subroutine scan_fields(line, start, where, keyword, fields, diagnostics)
    character(len=*), intent(in) :: line, keyword
    integer, intent(in) :: start
    type(location_t), intent(in) :: where
    type(deck_field_t), allocatable, intent(inout) :: fields(:)   !! (nfield)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(deck_field_t), allocatable :: longer(:)
    integer :: n, first, last, i

    if (allocated(fields)) deallocate (fields)
    allocate (fields(8))
    n = 0
    first = start
    do
      do while (first <= len(line))
        if (line(first:first) /= ' ') exit
        first = first + 1
      end do
      if (first > len(line)) exit
      if (n == size(fields)) then
        allocate (longer(2*n))
        longer(:n) = fields
        call move_alloc(longer, fields)
      end if
      n = n + 1
      call scan_one(line, first, where, keyword, fields(n), last, diagnostics)
      first = last + 1
    end do
    allocate (longer(n))
    do i = 1, n
      longer(i) = fields(i)
    end do
    call move_alloc(longer, fields)
  end subroutine scan_fields

  !> The field which begins at column `first`; `last` is its last column.
  subroutine scan_one(line, first, where, keyword, field, last, diagnostics)
    character(len=*), intent(in) :: line, keyword
    integer, intent(in) :: first
    type(location_t), intent(in) :: where
    type(deck_field_t), intent(out) :: field
    integer, intent(out) :: last
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: closing, i, code

    field%column = first
    field%quoted = scan(line(first:first), quotes) == 1
    last = first + index(line(first:)//' ', ' ') - 2
    if (field%quoted) then
      closing = index(line(first + 1:), line(first:first))
      if (closing == 0) then
        last = len(line)
        field%text = line(first + 1:)
        call record(first, 'the quote is not closed on this line')
        return
      end if
      closing = first + closing
      field%text = line(first + 1:closing - 1)
      last = closing + index(line(closing + 1:)//' ', ' ') - 1
      if (last > closing) then
        call record(closing + 1, 'expected a blank after the closing quote, found '''//line(closing + 1:closing + 1)//'''')
        return
      else if (closing == first + 1) then
        call record(first, 'the quotes hold nothing')
        return
      end if
    else
      field%text = line(first:last)
    end if
    i = first - 1
    do while (i < last)
      i = i + 1
      code = ichar(line(i:i))
      if (code < 32 .or. code > 126) then
        ! names of files and texts may have letters of any script, which numbers and names have not
        if (field%quoted .and. letter_length(line, i) > 0) then
          i = i + letter_length(line, i) - 1
          cycle
        end if
        call record(i, foreign_words(line, i)//trim(merge(': the name of a file with it stands in quotes', &
                                                          '                                             ', is_letter(line, i))))
        return
      end if
      if (i > first .and. .not. field%quoted .and. scan(line(i:i), quotes) == 1) then
        call record(i, 'a quote may only stand at the begin and at the end of a field')
        return
      end if
    end do

  contains

    subroutine record(column, message)
      integer, intent(in) :: column
      character(len=*), intent(in) :: message

      field%faulty = .true.
      call diagnostics%add(location_t(where%file, where%line, column), keyword, message)
    end subroutine record

  end subroutine scan_one

end module deck_field
