!> The table of a cycle, `cycle.csv`: a row for every try at a new mesh. What was refused at a stop is not tried
!> again there. No cell holds a comma or a quote.
module cycle_table
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: try_row_t, table_heading, number_of_columns, parse_table, line_of_cells
  public :: way_deck, way_transfer, way_finer, way_mesher, way_coarser, way_earlier, way_old_mesh, way_agreed, way_anew
  public :: agreed_way, any_agreed, first_reason, first_step_of, number_refused, was_refused, has_new_mesh, keeps_old_mesh, &
            transfer_is_responsible, mesh_is_responsible, took_earlier

  !> What is done for a new mesh, as the column `action` names it: as the deck says, another state transfer, finer or coarser
  !> elements, the free mesher instead of the deck's zones, from the checkpoint one save earlier; the old mesh goes on for a while;
  !> the best of several tries, refused by the force of a die alone and agreed on it, is made again and taken up; or the first mesh
  !> is made again as the errors of the run on it want it, and the scene begins anew.
  character(len=*), parameter :: way_deck = 'as the deck says', way_transfer = 'other transfer', way_finer = 'finer', &
                                 way_mesher = 'without zones', way_coarser = 'coarser', way_earlier = 'earlier', &
                                 way_old_mesh = 'old mesh', way_agreed = 'agreed force', way_anew = 'first mesh again'

  character(len=*), parameter :: table_heading = &
    'generation [-],try [-],stop_step [-],stop_time [time],step [-],trigger,action,result,accepted,stage,'// &
    'old_elements [-],new_elements [-],error_before [%],error_after [%],first_residual [-],iterations [-],force_change [%],'// &
    'energy_change [%],depth_change [-],least_step_ratio [-],first_step_force_change [%],laps [-],'// &
    'lap_depth [length],removed_volume [volume],force_over_limit [-],remdata [s],restart [s],reason'
  !> Numbers of columns in it.
  integer, parameter :: at_generation = 1, at_stop_step = 3, at_stop_time = 4, at_step = 5, at_action = 7, at_accepted = 9, &
                        at_stage = 10, at_error_after = 14, at_force = 25, at_reason = 28
  integer, parameter :: number_of_columns = 28
  !> So many tries that were refused by the force of a die alone are several. They agree when their changes of the force differ by
  !> no more than its limit.
  integer, parameter :: several = 3
  real(wp), parameter :: agree_within = 1.0_wp

  !> Times are the same up to this share: the table has all their digits.
  real(wp), parameter :: same_time = 1.0e-12_wp

  !> The columns of a row that decisions depend on.
  type :: try_row_t
    integer :: generation = 0                !! of the new mesh
    integer :: stop_step = 0                 !! step at which the old mesh stopped
    real(wp) :: stop_time = 0.0_wp           !! [time]
    integer :: step = 0                      !! of the state that was remeshed
    character(len=:), allocatable :: action  !! one of the ways above
    character(len=:), allocatable :: stage   !! responsible, '' when accepted
    character(len=:), allocatable :: reason  !! why it was refused, for the user
    logical :: accepted = .false.
    !> Estimated error of the stress on the new mesh [%]; the change of the force of a die over its limit, negative where it becomes
    !> smaller, where nothing else speaks against the mesh; each 0 where it is not known.
    real(wp) :: error_after = 0.0_wp, force = 0.0_wp
  end type try_row_t

contains

  !> The rows of a table. One that is damaged is refused by its line: tries that are forgotten would be made again.
  pure subroutine parse_table(text, path, rows, error)
    character(len=*), intent(in) :: text, path
    type(try_row_t), allocatable, intent(out) :: rows(:)   !! (ntry)
    type(error_t), allocatable, intent(out) :: error
    type(try_row_t) :: row
    integer :: first, last, line
    logical :: good

    allocate (rows(0))
    first = 1
    line = 0
    do while (first <= len(text))
      line = line + 1
      last = first + index(text(first:)//new_line('a'), new_line('a')) - 2
      if (line == 1) then
        good = text(first:last) == table_heading
      else
        call parse_row(text(first:last), row, good)
        if (good) rows = [rows, row]
      end if
      if (.not. good) then
        call fail(error, exit_input, path//':'//to_text(line)//': damaged: no row of '//to_text(number_of_columns)// &
                  ' cells as lagacycle writes them', 'lagacycle --fresh begins anew')
        return
      end if
      first = last + 2
    end do
  end subroutine parse_table

  pure subroutine parse_row(line, row, good)
    character(len=*), intent(in) :: line
    type(try_row_t), intent(out) :: row
    logical, intent(out) :: good
    type(string_t) :: cells(number_of_columns)
    integer :: k, first, last, status

    good = .false.
    first = 1
    do k = 1, number_of_columns
      last = first + index(line(first:)//',', ',') - 2
      if ((last == len(line)) .neqv. (k == number_of_columns)) return
      cells(k)%s = line(first:last)
      first = last + 2
    end do
    read (cells(at_generation)%s, *, iostat=status) row%generation
    if (status /= 0) return
    read (cells(at_stop_step)%s, *, iostat=status) row%stop_step
    if (status /= 0) return
    read (cells(at_stop_time)%s, *, iostat=status) row%stop_time
    if (status /= 0) return
    read (cells(at_step)%s, *, iostat=status) row%step
    if (status /= 0) return
    row%action = cells(at_action)%s
    row%accepted = cells(at_accepted)%s == 'y'
    row%stage = cells(at_stage)%s
    row%reason = cells(at_reason)%s
    call read_known(cells(at_error_after)%s, row%error_after, status)
    if (status == 0) call read_known(cells(at_force)%s, row%force, status)
    if (status /= 0) return
    good = row%accepted .or. cells(at_accepted)%s == 'n'
  end subroutine parse_row

  !> A number, 0 for an empty cell.
  pure subroutine read_known(cell, value, status)
    character(len=*), intent(in) :: cell
    real(wp), intent(out) :: value
    integer, intent(out) :: status

    value = 0
    status = 0
    if (cell == '') return
    read (cell, *, iostat=status) value
    if (status /= 0) value = 0
  end subroutine read_known

  !> Cells as a line of the table; characters that would separate cells are replaced.
  pure function line_of_cells(cells) result(line)
    type(string_t), intent(in) :: cells(:)   !! (ncell)
    character(len=:), allocatable :: line
    type(string_t) :: clean(size(cells))
    integer :: k, i

    do k = 1, size(cells)
      clean(k)%s = cells(k)%s
      do i = 1, len(clean(k)%s)
        select case (clean(k)%s(i:i))
        case (',')
          clean(k)%s(i:i) = ';'
        case (new_line('a'), '"')
          clean(k)%s(i:i) = ' '
        end select
      end do
    end do
    line = join(clean, ',')
  end function line_of_cells

  !> Tries at mesh `generation` that were refused at the stop after `stop_step`.
  pure function number_refused(rows, generation, stop_step) result(number)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    integer :: number

    number = count(is_refused(rows, generation, stop_step))
  end function number_refused

  !> A try at this mesh, at this stop, that was refused.
  elemental function is_refused(row, generation, stop_step) result(refused)
    type(try_row_t), intent(in) :: row
    integer, intent(in) :: generation, stop_step
    logical :: refused

    refused = row%generation == generation .and. row%stop_step == stop_step .and. .not. row%accepted
  end function is_refused

  !> Was this way refused at this stop?
  pure function was_refused(rows, generation, stop_step, way) result(refused)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    character(len=*), intent(in) :: way
    logical :: refused
    integer :: k

    refused = .false.
    do k = 1, size(rows)
      if (is_refused(rows(k), generation, stop_step)) refused = refused .or. rows(k)%action == way
    end do
  end function was_refused

  !> Why the first try was refused at this stop, '' where it is not known.
  pure function first_reason(rows, generation, stop_step) result(reason)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    character(len=:), allocatable :: reason
    integer :: k

    reason = ''
    do k = 1, size(rows)
      if (.not. is_refused(rows(k), generation, stop_step)) cycle
      if (allocated(rows(k)%reason)) reason = rows(k)%reason
      return
    end do
  end function first_reason

  !> Step at which mesh `generation` began; 0 for the first.
  pure function first_step_of(rows, generation) result(step)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    integer :: step
    integer :: k

    step = 0
    do k = 1, size(rows)
      if (rows(k)%generation == generation .and. rows(k)%accepted .and. rows(k)%action /= way_old_mesh) step = rows(k)%step
    end do
  end function first_step_of

  !> Is there a row of mesh `generation` as an accepted one?
  pure function has_new_mesh(rows, generation) result(has)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    logical :: has
    integer :: k

    has = .false.
    do k = 1, size(rows)
      if (rows(k)%generation == generation .and. rows(k)%accepted) has = has .or. rows(k)%action /= way_old_mesh
    end do
  end function has_new_mesh

  !> Was it decided that the old mesh goes on, before mesh `generation` could be made: at this stop, or at any?
  pure function keeps_old_mesh(rows, generation, stop_step) result(keeps)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    integer, intent(in), optional :: stop_step
    logical :: keeps
    integer :: k

    keeps = .false.
    do k = 1, size(rows)
      if (rows(k)%generation /= generation .or. rows(k)%action /= way_old_mesh) cycle
      if (present(stop_step)) then
        keeps = keeps .or. rows(k)%stop_step == stop_step
      else
        keeps = .true.
      end if
    end do
  end function keeps_old_mesh

  !> Was a try at this stop refused by the transfer or a later stage? Another method of transfer cannot repair an earlier stage.
  pure function transfer_is_responsible(rows, generation, stop_step) result(can)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    logical :: can
    integer :: k

    can = .false.
    do k = 1, size(rows)
      if (is_refused(rows(k), generation, stop_step)) &
        can = can .or. all(rows(k)%stage /= [character(len=10) :: 'contour', 'mesh', 'checkpoint'])
    end do
  end function transfer_is_responsible

  !> Was a try refused at this stop because no good mesh came of it?
  pure function mesh_is_responsible(rows, generation, stop_step) result(is)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    logical :: is
    integer :: k

    is = .false.
    do k = 1, size(rows)
      if (is_refused(rows(k), generation, stop_step)) is = is .or. rows(k)%stage == 'mesh'
    end do
  end function mesh_is_responsible

  !> The way of the best of several tries at this stop that were refused by the force of a die alone and agree on it: then the old
  !> mesh was wrong. The best is that with the least error of the stress; '' where there are not several, or they do not agree.
  pure function agreed_way(rows, generation, stop_step) result(way)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    character(len=:), allocatable :: way
    real(wp) :: least, largest, best
    integer :: k, n

    way = ''
    least = huge(least)
    largest = -huge(largest)
    best = huge(best)
    n = 0
    do k = 1, size(rows)
      associate (row => rows(k))
        if (.not. is_refused(row, generation, stop_step)) cycle
        ! all from one state of the old mesh
        if (.not. abs(row%force) > 0 .or. row%step /= stop_step .or. row%action == way_agreed) cycle
        n = n + 1
        least = min(least, row%force)
        largest = max(largest, row%force)
        if (.not. row%error_after < best) cycle
        best = row%error_after
        way = row%action
      end associate
    end do
    if (n < several) then
      way = ''
    else if (least*largest < 0 .or. largest - least > agree_within) then
      way = ''
    end if
  end function agreed_way

  !> Was a mesh taken up on which several tries agreed?
  pure function any_agreed(rows) result(any)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    logical :: any
    integer :: k

    any = .false.
    do k = 1, size(rows)
      if (rows(k)%accepted) any = any .or. rows(k)%action == way_agreed
    end do
  end function any_agreed

  !> Was a mesh made from the save before a stop at this time, or at a later one?
  pure function took_earlier(rows, time) result(took)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    real(wp), intent(in) :: time
    logical :: took
    integer :: k

    took = .false.
    do k = 1, size(rows)
      if (rows(k)%accepted .and. rows(k)%stop_time >= time*(1 - same_time)) took = took .or. rows(k)%action == way_earlier
    end do
  end function took_earlier

end module cycle_table
