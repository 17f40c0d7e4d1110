!> Tables that `csv_writer` has written, read back: titles `name [unit]` and rows of numbers.
module csv_reader
  use atomic, only: read_text
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_csv

contains

  !> The whole table. A row that is not whole, as a killed run may leave the last one, ends it.
  subroutine read_csv(path, titles, values, error)
    character(len=*), intent(in) :: path
    type(string_t), allocatable, intent(out) :: titles(:)   !! (ncolumn)
    real(wp), allocatable, intent(out) :: values(:, :)      !! (ncolumn, nrow) [unit of each column]
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    real(wp), allocatable :: all(:, :)
    integer :: first, last, nrow, status

    call read_text(path, text, error)
    if (allocated(error)) return
    first = index(text, new_line('a')) + 1
    if (first == 1) then
      call fail(error, exit_input, "'"//path//"' is no table: it has no line")
      return
    end if
    call split_titles(text(:first - 2), titles)
    allocate (all(size(titles), count_lines(text(first:))))
    nrow = 0
    do while (first <= len(text))
      last = first + index(text(first:), new_line('a')) - 2
      if (last < first) exit
      read (text(first:last), *, iostat=status) all(:, nrow + 1)
      if (status /= 0) exit
      nrow = nrow + 1
      first = last + 2
    end do
    allocate (values, source=all(:, :nrow))
    if (nrow == 0) call fail(error, exit_input, "'"//path//"' has no row of "//to_text(size(titles))//' numbers')
  end subroutine read_csv

  !> Titles between commas; in quotes where they hold one (RFC 4180).
  pure subroutine split_titles(line, titles)
    character(len=*), intent(in) :: line
    type(string_t), allocatable, intent(out) :: titles(:)   !! (n)
    type(string_t) :: one(1)
    logical :: quoted
    integer :: i

    allocate (titles(0))
    quoted = .false.
    one(1)%s = ''
    do i = 1, len(line) + 1
      if (i > len(line)) then
        titles = [titles, one]
      else if (line(i:i) == '"') then
        quoted = .not. quoted
      else if (line(i:i) == ',' .and. .not. quoted) then
        titles = [titles, one]
        one(1)%s = ''
      else
        one(1)%s = one(1)%s//line(i:i)
      end if
    end do
  end subroutine split_titles

  pure function count_lines(text) result(n)
    character(len=*), intent(in) :: text
    integer :: n
    integer :: i

    n = 0
    do i = 1, len(text)
      if (text(i:i) == new_line('a')) n = n + 1
    end do
  end function count_lines

end module csv_reader
