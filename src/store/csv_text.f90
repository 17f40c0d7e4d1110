!> Text of a table of numbers: its header, and its rows up to a step.
module csv_text
  use text, only: join, string_t
  implicit none
  private
  public :: first_line, header, kept_length

  !> The column of the step, which `resume` reads; the first one is the time.
  integer, parameter :: step_column = 2

contains

  !> The titles in one line, in quotes where they hold a comma or a quote (RFC 4180).
  pure function header(columns) result(line)
    type(string_t), intent(in) :: columns(:)
    character(len=:), allocatable :: line
    type(string_t) :: titles(size(columns))
    integer :: i, j

    do i = 1, size(columns)
      if (scan(columns(i)%s, ',"') == 0) then
        titles(i)%s = columns(i)%s
        cycle
      end if
      titles(i)%s = '"'
      do j = 1, len(columns(i)%s)
        titles(i)%s = titles(i)%s//repeat(columns(i)%s(j:j), merge(2, 1, columns(i)%s(j:j) == '"'))
      end do
      titles(i)%s = titles(i)%s//'"'
    end do
    line = join(titles, ',')//new_line('a')
  end function header

  !> Length of the text of the header and the whole rows up to `step`, line ends included.
  pure function kept_length(text, ncolumn, step) result(length)
    character(len=*), intent(in) :: text
    integer, intent(in) :: ncolumn, step
    integer :: length, line, row_step

    length = 0
    do
      line = index(text(length + 1:), new_line('a'))
      if (line == 0) return
      if (length > 0) then
        row_step = step_of(text(length + 1:length + line - 1), ncolumn)
        if (row_step < 0 .or. row_step > step) return
      end if
      length = length + line
    end do
  end function kept_length

  !> The step of a row, -1 when it is not a whole row.
  pure function step_of(row, ncolumn) result(step)
    character(len=*), intent(in) :: row
    integer, intent(in) :: ncolumn
    integer :: step, i, ncell, first, last, flag

    step = -1
    ncell = 1
    first = 1
    last = len(row)
    do i = 1, len(row)
      if (row(i:i) /= ',') cycle
      if (ncell == step_column) last = i - 1
      ncell = ncell + 1
      if (ncell == step_column) first = i + 1
    end do
    if (ncell /= ncolumn .or. last < first) return
    if (verify(row(first:last), '0123456789') /= 0) return
    read (row(first:last), *, iostat=flag) step
    if (flag /= 0) step = -1
  end function step_of

  !> The text up to its first line end.
  pure function first_line(text) result(line)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: line

    line = text(:index(text//new_line('a'), new_line('a')) - 1)
  end function first_line

end module csv_text
