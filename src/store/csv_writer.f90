!> Tables that grow by a row at a time, such as `history.csv`: a header of `name [unit]`, then rows
!> of numbers. Reals are the shortest text that reads back as the same number. The file is open only
!> while a row is added, so that other programs can read it and a killed run loses nothing.
!>
!> A table taken up again with `resume` is cut after the step of the checkpoint, so that an
!> interrupted run leaves the very file of an uninterrupted one.
module csv_writer
  use atomic, only: read_text, refuse_place, write_text
  use csv_text, only: first_line, header, kept_length
  use errors, only: error_t, exit_bug, exit_input, exit_machine, fail
  use exact_numbers, only: exact_text
  use kinds, only: i8, wp
  use system, only: file_exists, flush_to_disk
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: csv_t

  !> In columns that a row has no value for: readers of numbers take it.
  character(len=*), parameter :: empty_cell = 'nan'

  !> A table open for writing. It keeps its first error; later calls then do nothing.
  type :: csv_t
    private
    character(len=:), allocatable :: path
    character(len=:), allocatable :: row   !! the cells of the row in the making
    integer :: ncolumn = 0
    integer :: ncell = 0
    !> Columns of the cells of a row where others stay empty; not allocated where rows have all cells.
    integer, allocatable :: places(:)
    integer(i8) :: length = 0   !! of the file so far, in bytes
    logical :: ready = .false.
    type(error_t), allocatable :: first_error
  contains
    procedure :: create
    procedure :: resume
    procedure :: take_columns
    procedure :: end_row
    procedure :: flush_rows
    procedure :: status
    procedure :: close => close_table
    !> `put(value)`: the next cell of the row, or several cells from an array.
    generic :: put => put_real, put_integer, put_reals, put_integers
    procedure, private :: put_real
    procedure, private :: put_integer
    procedure, private :: put_reals
    procedure, private :: put_integers
    procedure, private :: put_cell
    procedure, private :: get_ready
    procedure, private :: append
    procedure, private :: record
  end type csv_t

contains

  !> A new table with these column titles, `name [unit]`, replacing an older one.
  subroutine create(self, path, columns, error)
    class(csv_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(string_t), intent(in) :: columns(:)   !! (ncolumn)
    type(error_t), allocatable, intent(out) :: error

    call begin(self, path, columns)
    call write_text(path, header(columns), error)
    call self%get_ready(error)
  end subroutine create

  !> Go on with a table after `step`: rows of later steps, and a row half written, are removed. The
  !> columns must be those of the file; where there is no file, a new one begins.
  subroutine resume(self, path, columns, step, error)
    class(csv_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(string_t), intent(in) :: columns(:)   !! (ncolumn)
    integer, intent(in) :: step
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: old
    integer :: length

    if (.not. file_exists(path)) then
      call self%create(path, columns, error)
      return
    end if
    call begin(self, path, columns)
    call refuse_place(path, error)
    if (.not. allocated(error)) call read_text(path, old, error)
    if (.not. allocated(error)) then
      if (index(old, header(columns)) == 1) then
        length = kept_length(old, size(columns), step)
        if (length < len(old)) call write_text(path, old(:length), error)
      else
        call fail(error, exit_input, "'"//path//"' has other columns than this run, which would go on with it: "// &
          first_line(old), advice='move it away, or write the results into another directory')
      end if
    end if
    call self%get_ready(error)
  end subroutine resume

  subroutine put_real(self, value)
    class(csv_t), intent(inout) :: self
    real(wp), intent(in) :: value

    call self%put_cell(exact_text(value))
  end subroutine put_real

  subroutine put_integer(self, value)
    class(csv_t), intent(inout) :: self
    integer, intent(in) :: value

    call self%put_cell(to_text(value))
  end subroutine put_integer

  subroutine put_reals(self, values)
    class(csv_t), intent(inout) :: self
    real(wp), intent(in) :: values(:)   !! (n) [unit of each column]
    integer :: i

    do i = 1, size(values)
      call self%put_cell(exact_text(values(i)))
    end do
  end subroutine put_reals

  subroutine put_integers(self, values)
    class(csv_t), intent(inout) :: self
    integer, intent(in) :: values(:)   !! (n)
    integer :: i

    do i = 1, size(values)
      call self%put_cell(to_text(values(i)))
    end do
  end subroutine put_integers

  subroutine put_cell(self, cell)
    class(csv_t), intent(inout) :: self
    character(len=*), intent(in) :: cell

    if (.not. self%ready) return
    if (self%ncell > 0) self%row = self%row//','
    self%row = self%row//cell
    self%ncell = self%ncell + 1
  end subroutine put_cell

  !> The row is complete: add it to the file.
  subroutine end_row(self)
    class(csv_t), intent(inout) :: self

    if (.not. self%ready .or. allocated(self%first_error)) return
    if (allocated(self%places)) call spread_cells(self)
    if (self%ncell == self%ncolumn) then
      call self%append(self%row//new_line('a'))
    else
      call self%record(exit_bug, "'"//self%path//"': a row of "//to_text(self%ncell)//' cells, '//to_text(self%ncolumn)//' wanted')
    end if
    self%row = ''
    self%ncell = 0
  end subroutine end_row

  !> Rows that follow have cells for these columns of the table, in this order; the other cells are `nan`.
  subroutine take_columns(self, places)
    class(csv_t), intent(inout) :: self
    integer, intent(in) :: places(:)   !! (n) numbers of columns

    self%places = places
  end subroutine take_columns

  !> Put the cells of the row into their columns.
  subroutine spread_cells(self)
    class(csv_t), intent(inout) :: self
    type(string_t) :: cells(self%ncolumn)
    integer :: k, first, length

    if (self%ncell /= size(self%places) .or. any(self%places < 1 .or. self%places > self%ncolumn)) return
    do k = 1, self%ncolumn
      cells(k)%s = empty_cell
    end do
    first = 1
    do k = 1, self%ncell
      length = index(self%row(first:)//',', ',') - 1
      cells(self%places(k))%s = self%row(first:first + length - 1)
      first = first + length + 1
    end do
    self%row = join(cells, ',')
    self%ncell = self%ncolumn
  end subroutine spread_cells

  !> Add a line to the file. gfortran's flush and close do not report a full disk, its `inquire` of
  !> the length of a closed file shows it.
  subroutine append(self, line)
    class(csv_t), intent(inout) :: self
    character(len=*), intent(in) :: line
    character(len=200) :: why
    integer(i8) :: length
    integer :: unit, flag

    open (newunit=unit, file=self%path, status='old', action='write', access='stream', form='unformatted', position='append', &
      iostat=flag, iomsg=why)
    if (flag == 0) then
      write (unit, iostat=flag, iomsg=why) line
      close (unit)
    end if
    if (flag == 0) then
      self%length = self%length + len(line, i8)
      inquire (file=self%path, size=length)
      flag = merge(0, 1, length == self%length)
      why = 'disk full?'
    end if
    if (flag /= 0) call self%record(exit_machine, "cannot write '"//self%path//"': "//trim(why))
  end subroutine append

  !> Wait until the rows so far would survive a power cut.
  subroutine flush_rows(self, error)
    class(csv_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error

    if (self%ready) call flush_to_disk(self%path, error)
  end subroutine flush_rows

  !> The first error so far; unallocated when there was none.
  pure subroutine status(self, error)
    class(csv_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error

    if (allocated(self%first_error)) allocate (error, source=self%first_error)
  end subroutine status

  !> The table is finished: deliver the first error since it was opened.
  subroutine close_table(self, error)
    class(csv_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error

    self%ready = .false.
    call self%status(error)
  end subroutine close_table

  !> Clear the object.
  subroutine begin(self, path, columns)
    class(csv_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(string_t), intent(in) :: columns(:)

    self%ready = .false.
    if (allocated(self%first_error)) deallocate (self%first_error)
    self%path = path
    self%row = ''
    self%ncolumn = size(columns)
    self%ncell = 0
    if (allocated(self%places)) deallocate (self%places)
  end subroutine begin

  !> The table is open for rows, unless there was an error.
  subroutine get_ready(self, error)
    class(csv_t), intent(inout) :: self
    type(error_t), allocatable, intent(in) :: error

    self%ready = .not. allocated(error)
    if (self%ready) then
      inquire (file=self%path, size=self%length)
    else
      call self%record(error%code, error%message)
    end if
  end subroutine get_ready

  !> Keep the first error.
  pure subroutine record(self, code, message)
    class(csv_t), intent(inout) :: self
    integer, intent(in) :: code
    character(len=*), intent(in) :: message

    if (.not. allocated(self%first_error)) call fail(self%first_error, code, message)
  end subroutine record

end module csv_writer
