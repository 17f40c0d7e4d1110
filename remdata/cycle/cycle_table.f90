!> The table of a cycle, `cycle.csv`: a row for every try at a new mesh. No cell holds a comma or a quote.
module cycle_table
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: try_row_t, table_heading, number_of_columns, parse_table, line_of_cells
  public :: way_deck, way_transfer, way_finer, way_mesher, way_coarser, way_earlier, way_old_mesh, way_agreed, way_anew

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
  !> What whole numbers and others are written with.
  character(len=*), parameter :: digits = '0123456789', in_numbers = digits//'+-.eE'

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
    if (.not. all(is_made_of([cells(at_generation), cells(at_stop_step), cells(at_step)], digits))) return
    if (.not. is_made_of(cells(at_stop_time), in_numbers)) return
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
    call read_known(cells(at_error_after), row%error_after, status)
    if (status == 0) call read_known(cells(at_force), row%force, status)
    if (status /= 0) return
    good = row%accepted .or. cells(at_accepted)%s == 'n'
  end subroutine parse_row

  !> A number, 0 for an empty cell.
  pure subroutine read_known(cell, value, status)
    type(string_t), intent(in) :: cell
    real(wp), intent(out) :: value
    integer, intent(out) :: status

    value = 0
    status = 0
    if (cell%s == '') return
    status = 1
    if (is_made_of(cell, in_numbers)) read (cell%s, *, iostat=status) value
    if (status /= 0) value = 0
  end subroutine read_known

  !> Whether a cell has these characters and no others. A list-directed read takes more for a number: `/` ends it and leaves the
  !> value as it was, `2*5` is two of them, and what follows a blank is not seen.
  elemental function is_made_of(cell, characters) result(yes)
    type(string_t), intent(in) :: cell
    character(len=*), intent(in) :: characters
    logical :: yes

    yes = len(cell%s) > 0 .and. verify(cell%s, characters) == 0
  end function is_made_of

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

end module cycle_table
