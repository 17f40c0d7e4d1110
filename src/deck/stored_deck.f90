!> A deck as one text, with its included files in place and the overrides in force: written, and read back without touching a file.
!>
!> In such a text `!@file "name" line` gives the place of the line that follows, and `!@param NAME=VALUE` is an override.
module stored_deck
  use deck_field, only: digits
  use diagnostics, only: diagnostics_t, location_t
  use source_lines, only: append_line, end_of_line, line_feed, source_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: load_text, write_text

  character(len=*), parameter :: file_mark = '!@file "', param_mark = '!@param '

contains

  !> Lines of a text that `write_text` made, or of a deck without INCLU held in memory.
  subroutine load_text(content, path, source, diagnostics)
    character(len=*), intent(in) :: content, path
    type(source_t), intent(out) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: first, past, line, file

    allocate (source%lines(64))
    call take_overrides(content, source%overrides)
    call diagnostics%register(path, file)
    source%last%file = file
    line = 0
    first = 1
    do while (first <= len(content))
      past = end_of_line(content, first)
      if (index(content(first:past - 1), file_mark) == 1) then
        call read_place(content(first:past - 1), file, line, diagnostics)
      else if (index(content(first:past - 1), param_mark) /= 1) then
        line = line + 1
        call append_line(source, content(first:past - 1), file, line)
        if (file == source%last%file) source%last%line = line
      end if
      first = past + 1
    end do
  end subroutine load_text

  !> The canonical text of a source and the overrides in force.
  subroutine write_text(source, overrides, diagnostics, content)
    type(source_t), intent(in) :: source
    type(string_t), intent(in) :: overrides(:)   !! (noverride)
    type(diagnostics_t), intent(in) :: diagnostics
    character(len=:), allocatable, intent(out) :: content
    integer :: pass, length, i, file, line

    ! First the length is counted, then the text is filled in.
    do pass = 1, 2
      length = 0
      do i = 1, size(overrides)
        call put(param_mark//trim(overrides(i)%s))
      end do
      file = 0
      line = 0
      do i = 1, source%nline
        if (source%lines(i)%file /= file .or. source%lines(i)%line /= line + 1) &
          call put(file_mark//diagnostics%place(location_t(source%lines(i)%file))//'" '//to_text(source%lines(i)%line))
        file = source%lines(i)%file
        line = source%lines(i)%line
        call put(source%lines(i)%text)
      end do
      if (pass == 1) allocate (character(len=length) :: content)
    end do

  contains

    subroutine put(one)
      character(len=*), intent(in) :: one

      if (pass == 2) content(length + 1:length + len(one) + 1) = one//line_feed
      length = length + len(one) + 1
    end subroutine put

  end subroutine write_text

  !> The `!@param` lines, which stand at the head of a stored text.
  subroutine take_overrides(content, overrides)
    character(len=*), intent(in) :: content
    type(string_t), allocatable, intent(out) :: overrides(:)
    integer :: pass, first, past, n

    do pass = 1, 2
      n = 0
      first = 1
      do while (first <= len(content))
        past = end_of_line(content, first)
        if (index(content(first:past - 1), param_mark) /= 1) exit
        n = n + 1
        if (pass == 2) overrides(n)%s = content(first + len(param_mark):past - 1)
        first = past + 1
      end do
      if (pass == 1) allocate (overrides(n))
    end do
  end subroutine take_overrides

  !> Place from `!@file "name" line`: that of the line which follows. Any other mark is a comment.
  subroutine read_place(mark, file, line, diagnostics)
    character(len=*), intent(in) :: mark
    integer, intent(inout) :: file, line
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: closing, last, number, status

    closing = index(mark, '" ', back=.true.)
    if (closing <= len(file_mark)) return
    last = len_trim(mark)
    if (verify(mark(closing + 2:last), digits) > 0 .or. last < closing + 2 .or. last > closing + 10) return
    read (mark(closing + 2:last), *, iostat=status) number
    if (status /= 0 .or. number < 1) return
    line = number - 1
    call diagnostics%register(mark(len(file_mark) + 1:closing - 1), file)
  end subroutine read_place

end module stored_deck
