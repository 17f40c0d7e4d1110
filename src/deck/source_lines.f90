!> Lines of a deck: comments and line ends go, every line keeps its place.
module source_lines
  use deck_field, only: comment_column
  use diagnostics, only: location_t
  use text, only: string_t
  implicit none
  private
  public :: line_t, source_t, append_line, end_of_line, line_feed

  character(len=1), parameter :: tab = achar(9), line_feed = achar(10), carriage_return = achar(13)

  !> A line that is not blank, without comment and trailing blanks.
  type :: line_t
    character(len=:), allocatable :: text
    integer :: file = 0
    integer :: line = 0
  end type line_t

  !> A deck with its included files in place.
  type :: source_t
    type(line_t), allocatable :: lines(:)
    integer :: nline = 0
    !> Overrides found in a stored text.
    type(string_t), allocatable :: overrides(:)
    !> False when a file could not be read.
    logical :: complete = .true.
    !> Last line of the deck's own file.
    type(location_t) :: last
    !> END is passed.
    logical :: ended = .false.
  end type source_t

contains

  !> A line in its plain form, unless there is nothing on it.
  subroutine append_line(source, raw, file, line)
    type(source_t), intent(inout) :: source
    character(len=*), intent(in) :: raw
    integer, intent(in) :: file, line
    type(line_t), allocatable :: longer(:)
    character(len=len(raw)) :: text
    integer :: i, n

    text = raw
    n = len(raw)
    if (n > 0) then
      if (text(n:n) == carriage_return) n = n - 1
    end if
    do i = 1, n
      if (text(i:i) == tab) text(i:i) = ' '
    end do
    n = len_trim(text(:comment_column(text(:n)) - 1))
    if (n == 0) return
    if (source%nline == size(source%lines)) then
      allocate (longer(2*source%nline))
      do i = 1, source%nline
        call move_alloc(source%lines(i)%text, longer(i)%text)
        longer(i)%file = source%lines(i)%file
        longer(i)%line = source%lines(i)%line
      end do
      call move_alloc(longer, source%lines)
    end if
    source%nline = source%nline + 1
    source%lines(source%nline)%text = text(:n)
    source%lines(source%nline)%file = file
    source%lines(source%nline)%line = line
  end subroutine append_line

  !> Column of the line feed of the line which begins at `first`, or one past the end.
  pure function end_of_line(content, first) result(past)
    character(len=*), intent(in) :: content
    integer, intent(in) :: first
    integer :: past

    past = index(content(first:), line_feed) + first - 1
    if (past < first) past = len(content) + 1
  end function end_of_line

end module source_lines
