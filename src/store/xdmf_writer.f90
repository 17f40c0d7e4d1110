!> The one file that ParaView opens: `NAME.xdmf`, a collection in time of the grids saved in the HDF5
!> files of all mesh generations (what both the XDMF 2 and the XDMF 3 reader of ParaView 5 understand).
module xdmf_writer
  use atomic, only: read_text, write_text
  use errors, only: error_t, exit_input, fail
  use exact_numbers, only: exact_text
  use kinds, only: wp
  use system, only: file_exists
  use text, only: string_t
  use xdmf_grid, only: escaped, grid_text, nl, xdmf_grid_t
  implicit none
  private
  public :: xdmf_t

  !> The collection; each grid is kept as its text.
  type :: xdmf_t
    private
    type(string_t), allocatable :: grids(:)
  contains
    procedure :: add
    procedure :: add_together
    procedure :: resume
    procedure :: write_file
    procedure :: size => number_of_grids
  end type xdmf_t

  character(len=*), parameter :: head = '<?xml version="1.0" encoding="UTF-8"?>'//nl// &
    '<Xdmf Version="3.0">'//nl//' <Domain>'//nl// &
    '  <Grid Name="history" GridType="Collection" CollectionType="Temporal">'//nl
  character(len=*), parameter :: tail = '  </Grid>'//nl//' </Domain>'//nl//'</Xdmf>'//nl
  !> Beginning and end of each instant in the files written here; `resume` searches for them. Grids within one begin further right.
  character(len=*), parameter :: grid_head = '   <Grid Name="'
  character(len=*), parameter :: time_mark = '    <Time Value="'
  character(len=*), parameter :: grid_foot = '   </Grid>'//nl

contains

  !> Add the grid of a saved step.
  subroutine add(self, grid, error)
    class(xdmf_t), intent(inout) :: self
    type(xdmf_grid_t), intent(in) :: grid
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: s

    call grid_text(grid, '   ', time_line(grid%time), s, error)
    if (.not. allocated(error)) call append(self, s)
  end subroutine add

  !> Add several grids of one saved step.
  subroutine add_together(self, label, grids, error)
    class(xdmf_t), intent(inout) :: self
    character(len=*), intent(in) :: label
    type(xdmf_grid_t), intent(in) :: grids(:)   !! (ngrid), at least one, of one time
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: s, one
    integer :: i

    s = grid_head//escaped(label)//'" GridType="Collection" CollectionType="Spatial">'//nl//time_line(grids(1)%time)
    do i = 1, size(grids)
      call grid_text(grids(i), '    ', '', one, error)
      if (allocated(error)) return
      s = s//one
    end do
    call append(self, s//grid_foot)
  end subroutine add_together

  subroutine append(self, s)
    type(xdmf_t), intent(inout) :: self
    character(len=*), intent(in) :: s

    if (.not. allocated(self%grids)) allocate (self%grids(0))
    self%grids = [self%grids, string_t(s)]
  end subroutine append

  function time_line(time) result(s)
    real(wp), intent(in) :: time
    character(len=:), allocatable :: s

    s = time_mark//exact_text(time)//'"/>'//nl
  end function time_line

  !> Take over the grids of an older file of this system up to `time`, and before the first that has its mesh in `until`; without
  !> a file there are no grids.
  subroutine resume(self, path, time, until, error)
    class(xdmf_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    real(wp), intent(in) :: time
    character(len=*), intent(in) :: until   !! name of a mesh's HDF5 file, NAME.gNN.h5; its instants are in NAME.gNN/
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: old
    real(wp) :: grid_time
    integer :: first, last, number, flag

    if (allocated(self%grids)) deallocate (self%grids)
    allocate (self%grids(0))
    if (.not. file_exists(path)) return
    call read_text(path, old, error)
    if (allocated(error)) return
    if (index(old, head) /= 1) then
      call fail(error, exit_input, "'"//path//"' is not an XDMF file of this system")
      return
    end if
    first = len(head) + 1
    do while (index(old(first:), grid_head) == 1)
      last = first - 1 + index(old(first:), nl//grid_foot) + len(grid_foot)
      number = first - 1 + index(old(first:), time_mark) + len(time_mark)
      read (old(number:number + index(old(number:), '"') - 2), *, iostat=flag) grid_time
      if (flag /= 0) exit
      if (grid_time > time) exit
      if (index(old(first:last), '>'//escaped(until)//':') > 0) exit
      if (index(old(first:last), '>'//escaped(until(:len(until) - len('.h5')))//'/') > 0) exit
      self%grids = [self%grids, string_t(old(first:last))]
      first = last + 1
    end do
  end subroutine resume

  !> Write all grids into the file `path`, in one step.
  subroutine write_file(self, path, error)
    class(xdmf_t), intent(in) :: self
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: s
    integer :: i, n

    n = len(head) + len(tail)
    do i = 1, self%size()
      n = n + len(self%grids(i)%s)
    end do
    allocate (character(len=n) :: s)
    s(:len(head)) = head
    n = len(head)
    do i = 1, self%size()
      s(n + 1:n + len(self%grids(i)%s)) = self%grids(i)%s
      n = n + len(self%grids(i)%s)
    end do
    s(n + 1:) = tail
    call write_text(path, s, error)
  end subroutine write_file

  !> How many grids there are.
  pure function number_of_grids(self) result(n)
    class(xdmf_t), intent(in) :: self
    integer :: n

    n = 0
    if (allocated(self%grids)) n = size(self%grids)
  end function number_of_grids

end module xdmf_writer
