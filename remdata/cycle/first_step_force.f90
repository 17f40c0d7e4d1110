!> Change of the largest die force at the first full step on a new mesh, against what the old mesh's last steps foretell.
!>
!> The die is the rigid one with the largest force at the last step of the old mesh: a die of sides may be the body itself, whose
!> force says how it folds and not how it is formed; it is taken where no die is rigid. The force in the last four steps is fitted
!> by a straight line in time (least squares). The first full step is the first one that ends half a step of the old mesh, or more,
!> after the remesh: what is shorter has hardly left the equilibrium of the restart. tests/cycle/force_changes.py does the same for
!> all steps of a run. Steps of several operations foretell nothing: each has forces of its own.
module first_step_force
  use kinds, only: wp
  implicit none
  private
  public :: first_step_change

  !> Steps that foretell, and those of the new mesh that are looked at: as many as it is on probation.
  integer, parameter :: steps_before = 4, steps_after = 5
  !> A full step is at least this share of the mean of the last steps.
  real(wp), parameter :: full_step = 0.5_wp
  !> Below this share of the largest force of the run so far a force says nothing about the mesh.
  real(wp), parameter :: least_share = 0.2_wp
  !> The column of a force on a die begins so.
  character(len=*), parameter :: along = 'force_x_'

contains

  !> `known` is false where the old mesh has made too few steps, the new one none, the force is low before or after the remesh, or
  !> the table is not to be read.
  pure subroutine first_step_change(table, first, last, change, known)
    character(len=*), intent(in) :: table   !! text of history.csv
    integer, intent(in) :: first, last      !! step at which the old mesh began, and its last one
    real(wp), intent(out) :: change         !! relative to the force foretold [-]
    logical, intent(out) :: known
    real(wp), allocatable :: force(:)
    real(wp) :: time(-steps_before:steps_after), forces(-steps_before:steps_after), now, largest, foretold
    integer, allocatable :: columns(:)
    integer :: line, next, step, die, after, k
    character(len=:), allocatable :: operation
    logical :: good

    change = 0
    known = .false.
    if (last - first < steps_before) return
    next = 1
    call next_line(table, next, line)
    call find_columns(table(line:next - 2), columns)
    if (size(columns) < 4) return
    ! the die is known at the last step, the largest force in the steps up to it
    largest = 0
    die = 0
    do while (next <= len(table) .and. die == 0)
      call next_line(table, next, line)
      call read_row(table(line:next - 2), columns, step, now, force, good)
      if (.not. good) return
      largest = max(largest, maxval(force))
      if (step == last) die = maxloc(force, 1)
    end do
    if (die == 0) return
    if (force(die) < least_share*largest) return
    after = -huge(1)
    next = 1
    call next_line(table, next, line)
    do while (next <= len(table))
      call next_line(table, next, line)
      call read_row(table(line:next - 2), columns, step, now, force, good)
      if (.not. good) return
      k = step - last
      ! steps up to the last are numbered -3 to 0
      if (k <= -steps_before .or. k > steps_after) cycle
      if (.not. allocated(operation)) operation = operation_of(table, table(line:next - 2))
      if (operation_of(table, table(line:next - 2)) /= operation) then
        if (k <= 0) return
        exit
      end if
      time(k) = now
      forces(k) = force(die)
      after = k
    end do
    if (after < 1) return
    do k = 1, after - 1
      if (time(k) - time(0) >= full_step*(time(0) - time(1 - steps_before))/(steps_before - 1)) exit
    end do
    associate (t => time(1 - steps_before:0), f => forces(1 - steps_before:0))
      foretold = line_at(t, f, time(k))
    end associate
    ! a die that has left says nothing either
    known = foretold > 0 .and. .not. forces(k) < least_share*largest
    if (known) change = forces(k)/foretold - 1
  end subroutine first_step_change

  !> The straight line through points at x, by least squares.
  pure function line_at(t, f, x) result(value)
    real(wp), intent(in) :: t(:), f(:)   !! (npoint) [time]; (npoint) [force]
    real(wp), intent(in) :: x            !! [time]
    real(wp) :: value
    real(wp) :: mean

    mean = sum(t)/size(t)
    value = sum(f)/size(f) + (x - mean)*sum((t - mean)*f)/sum((t - mean)**2)
  end function line_at

  !> The line that begins at `next`, without its end, is text(line:next - 2).
  pure subroutine next_line(text, next, line)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: next
    integer, intent(out) :: line
    integer :: length

    line = next
    length = index(text(line:), new_line('a')) - 1
    if (length < 0) length = len(text) - line + 1
    next = line + length + 1
  end subroutine next_line

  !> Columns of the time, the step, and of both forces of each rigid die, in this order, of every die where none is rigid; none
  !> where one is missing. A die of sides has no columns of motion (history_columns).
  pure subroutine find_columns(heading, columns)
    character(len=*), intent(in) :: heading
    integer, allocatable, intent(out) :: columns(:)
    integer, allocatable :: of_sides(:)
    character(len=:), allocatable :: title
    integer :: k

    allocate (columns(0), of_sides(0))
    if (index(cell(heading, 1), 'time ') /= 1 .or. index(cell(heading, 2), 'step ') /= 1) return
    columns = [1, 2]
    do k = 3, number_of_cells(heading) - 1
      title = cell(heading, k)
      if (index(title, along) /= 1 .or. index(cell(heading, k + 1), 'force_y_') /= 1) cycle
      if (index(heading, ',displacement_x_'//title(len(along) + 1:index(title//' [', ' [') - 1)//' [') > 0) then
        columns = [columns, k, k + 1]
      else
        of_sides = [of_sides, k, k + 1]
      end if
    end do
    if (size(columns) == 2) columns = [columns, of_sides]
  end subroutine find_columns

  !> What stands in the column of the operation, if there is one.
  pure function operation_of(table, row) result(text)
    character(len=*), intent(in) :: table, row
    character(len=:), allocatable :: text

    text = ''
    if (index(cell(table(:index(table, new_line('a')) - 1), 3), 'operation ') == 1) text = cell(row, 3)
  end function operation_of

  !> Time, step and the size of the force on each die.
  pure subroutine read_row(row, columns, step, time, force, good)
    character(len=*), intent(in) :: row
    integer, intent(in) :: columns(:)   !! (2 + 2*ndie) of `find_columns`
    integer, intent(out) :: step
    real(wp), intent(out) :: time
    real(wp), allocatable, intent(out) :: force(:)   !! (ndie) [force]
    logical, intent(out) :: good
    real(wp) :: parts(2)
    integer :: k, c, status
    character(len=:), allocatable :: text

    allocate (force(size(columns)/2 - 1))
    force = 0
    step = 0
    time = 0
    good = number_of_cells(row) >= maxval(columns)
    if (.not. good) return
    text = cell(row, columns(1))
    read (text, *, iostat=status) time
    good = status == 0
    text = cell(row, columns(2))
    read (text, *, iostat=status) step
    good = good .and. status == 0
    do k = 1, size(force)
      do c = 1, 2
        text = cell(row, columns(2*k + c))
        ! a die of another operation
        if (text == 'nan') text = '0'
        read (text, *, iostat=status) parts(c)
        good = good .and. status == 0
      end do
      if (good) force(k) = norm2(parts)
    end do
  end subroutine read_row

  pure function number_of_cells(line) result(number)
    character(len=*), intent(in) :: line
    integer :: number
    integer :: k

    number = 1 + count([(line(k:k) == ',', k=1, len(line))])
  end function number_of_cells

  !> Where the k-th cell of a line begins; it has so many.
  pure function cell_start(line, k) result(start)
    character(len=*), intent(in) :: line
    integer, intent(in) :: k
    integer :: start
    integer :: passed

    start = 1
    do passed = 1, k - 1
      start = start + index(line(start:), ',')
    end do
  end function cell_start

  pure function cell(line, k) result(text)
    character(len=*), intent(in) :: line
    integer, intent(in) :: k
    character(len=:), allocatable :: text

    text = ''
    if (k > number_of_cells(line)) return
    text = line(cell_start(line, k):)
    text = text(:index(text//',', ',') - 1)
  end function cell

end module first_step_force
