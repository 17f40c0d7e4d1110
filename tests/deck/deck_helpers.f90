!> Short ways to read decks in tests: `|` ends a line.
module deck_helpers
  use deck_reader, only: deck_t, read_deck, read_deck_text
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use text, only: string_t
  implicit none
  private
  public :: told, told_of_file, value_of, read_lines, lines, strings, write_file, delete_file, all_told

contains

  !> All that is reported of a deck called `d`, `|` between the lines; '' when nothing is wrong.
  function told(deck_lines, overrides) result(message)
    character(len=*), intent(in) :: deck_lines
    type(string_t), intent(in), optional :: overrides(:)
    character(len=:), allocatable :: message
    type(deck_t) :: deck
    type(diagnostics_t) :: diagnostics

    call read_lines(deck_lines, deck, diagnostics, overrides)
    call all_told(diagnostics, message)
  end function told

  function told_of_file(path) result(message)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: message
    type(deck_t) :: deck
    type(diagnostics_t) :: diagnostics
    type(string_t) :: none(0)

    call read_deck(path, none, deck, diagnostics)
    call all_told(diagnostics, message)
  end function told_of_file

  !> First field after the keyword of the first card, as text: `12.5`, `word word` or what is reported.
  function value_of(field) result(shown)
    character(len=*), intent(in) :: field
    character(len=:), allocatable :: shown
    character(len=40) :: buffer
    type(deck_t) :: deck
    type(diagnostics_t) :: diagnostics

    call read_lines('PARAM n 4|PARAM w steel|CARD '//field//' $n $w|END', deck, diagnostics)
    call all_told(diagnostics, shown)
    if (shown /= '') return
    if (deck%cards(1)%head%fields(1)%numeric) then
      write (buffer, '(f0.10)') deck%cards(1)%head%fields(1)%value
      shown = trim(adjustl(buffer))
      shown = shown(:verify(shown, '0', back=.true.))
    else
      shown = 'word '//deck%cards(1)%head%fields(1)%text
    end if
  end function value_of

  subroutine read_lines(deck_lines, deck, diagnostics, overrides)
    character(len=*), intent(in) :: deck_lines
    type(deck_t), intent(out) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics
    type(string_t), intent(in), optional :: overrides(:)
    type(string_t) :: none(0)

    if (present(overrides)) then
      call read_deck_text(lines(deck_lines), 'd', overrides, deck, diagnostics)
    else
      call read_deck_text(lines(deck_lines), 'd', none, deck, diagnostics)
    end if
  end subroutine read_lines

  subroutine all_told(diagnostics, message)
    type(diagnostics_t), intent(in) :: diagnostics
    character(len=:), allocatable, intent(out) :: message
    type(error_t), allocatable :: error
    integer :: i

    message = ''
    call diagnostics%error(error)
    if (.not. allocated(error)) return
    message = error%message
    do i = 1, len(message)
      if (message(i:i) == new_line('a')) message(i:i) = '|'
    end do
  end subroutine all_told

  function lines(marked) result(text)
    character(len=*), intent(in) :: marked
    character(len=len(marked)) :: text
    integer :: i

    text = marked
    do i = 1, len(text)
      if (text(i:i) == '|') text(i:i) = new_line('a')
    end do
  end function lines

  !> Blank-separated words.
  function strings(words) result(list)
    character(len=*), intent(in) :: words
    type(string_t), allocatable :: list(:)
    integer :: pass, n, first, past

    do pass = 1, 2
      n = 0
      first = 1
      do while (first <= len(words))
        past = first + index(words(first:)//' ', ' ') - 1
        n = n + 1
        if (pass == 2) list(n)%s = words(first:past - 1)
        first = past + 1
      end do
      if (pass == 1) allocate (list(n))
    end do
  end function strings

  subroutine write_file(path, content)
    character(len=*), intent(in) :: path, content
    integer :: unit

    open (newunit=unit, file=path, access='stream', form='unformatted', status='replace', action='write')
    write (unit) content
    close (unit)
  end subroutine write_file

  subroutine delete_file(path)
    character(len=*), intent(in) :: path
    integer :: unit

    open (newunit=unit, file=path, status='old')
    close (unit, status='delete')
  end subroutine delete_file

end module deck_helpers
