!> What an action changes in the folder of a cycle: rows of the table, checkpoints that are kept, tries that are removed. Every
!> file is written whole, in an order that leaves a situation `cycle_decision` knows, wherever the cycle is killed.
module cycle_bookkeeping
  use atomic, only: previous_name, read_text, temporary_name, write_text
  use cycle_action, only: act_accept, act_keep_end, act_keep_old_mesh, act_refuse, act_remesh, act_resume, act_roll_back, action_t
  use cycle_folder, only: most_tries
  use cycle_situation, only: checkpoint_file_t, current_name, due_reason, is_read, mesh_name, situation_t, try_name
  use cycle_table, only: line_of_cells, number_of_columns, table_heading
  use cycle_tries, only: first_step_of, has_new_mesh
  use cycle_ways, only: old_state
  use errors, only: error_t
  use exact_numbers, only: exact_text
  use first_step_force, only: first_step_change
  use json_lookup, only: json_number, json_text, read_json
  use kinds, only: wp
  use system, only: file_exists, join_path, remove_file, rename_file
  use text, only: string_t, to_text
  implicit none
  private
  public :: carry_out

  !> Table of the run's steps, in the folder of its results.
  character(len=*), parameter :: history_name = 'history.csv'

contains

  !> Carry out the action in the folder. `line` is for the user; '' for nothing.
  subroutine carry_out(s, action, line, error)
    type(situation_t), intent(in) :: s
    type(action_t), intent(in) :: action
    character(len=:), allocatable, intent(out) :: line
    type(error_t), allocatable, intent(out) :: error

    line = action%say
    select case (action%kind)
    case (act_roll_back)
      call copy(s, previous_name(current_name), current_name, error)
    case (act_keep_end)
      call keep_end(s, error)
    case (act_accept)
      call enter_new_mesh(s, action, line, error)
    case (act_refuse)
      if (action%back) call copy(s, action%from, current_name, error)
      if (.not. allocated(error)) call add_row(s, action, 'n', error)
      if (.not. allocated(error)) call remove_try(s, s%new%number, error)
      if (.not. allocated(error)) call remove_judgement(s, error)
    case (act_keep_old_mesh)
      call add_row(s, action, 'y', error)
    case (act_remesh)
      call remove_try(s, s%new%number, error)
    case (act_resume)
      if (action%from /= current_name) call remove_judgement(s, error)
    end select
    if (allocated(error)) error%advice = 'the checkpoint is '//s%stem//'.'//current_name
  end subroutine carry_out

  !> The checkpoint where the old mesh stops, and first the save before it: that of another stop must not stay.
  subroutine keep_end(s, error)
    type(situation_t), intent(in) :: s
    type(error_t), allocatable, intent(out) :: error

    associate (generation => s%current%facts%generation)
      call remove_file(s%stem//'.'//mesh_name(generation, 'end.1.h5'), error)
      if (allocated(error)) return
      if (file_exists(s%stem//'.'//previous_name(current_name))) &
        call copy(s, previous_name(current_name), mesh_name(generation, 'end.1.h5'), error)
      if (.not. allocated(error)) call copy(s, current_name, mesh_name(generation, 'end.h5'), error)
    end associate
  end subroutine keep_end

  !> A row, once; the try becomes the mesh's start. Its checkpoint goes last: as long as it is there, all of this is made again.
  subroutine enter_new_mesh(s, action, line, error)
    type(situation_t), intent(in) :: s
    type(action_t), intent(in) :: action
    character(len=:), allocatable, intent(inout) :: line
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: made, start
    integer :: k

    associate (new => s%new)
      made = s%stem//'.'//try_name(new%generation, new%number)
      start = s%stem//'.'//mesh_name(new%generation, 'start.h5')
      do k = 1, most_tries(s%rows, new%generation)
        if (k == new%number .and. is_read(new%old_end)) cycle
        call remove_try(s, k, error)
        if (allocated(error)) return
      end do
      if (.not. (is_read(new%old_end) .and. new%made%found)) return
      if (.not. has_new_mesh(s%rows, new%generation)) then
        line = accepted_line(s, action)
        call add_row(s, action, 'y', error)
      end if
      if (new%has_facts .and. .not. allocated(error)) call rename_file(made//'.json', start//'.json', error)
      if (.not. allocated(error)) call rename_file(made, start, error)
    end associate
  end subroutine enter_new_mesh

  subroutine remove_try(s, number, error)
    type(situation_t), intent(in) :: s
    integer, intent(in) :: number
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: path

    path = s%stem//'.'//try_name(s%new%generation, number)
    call remove_file(temporary_name(path), error)   ! of a remesher that crashed
    if (.not. allocated(error)) call remove_file(path//'.json', error)
    if (.not. allocated(error)) call remove_file(path, error)
  end subroutine remove_try

  !> Remove the solver's reports on an earlier try at the same mesh.
  subroutine remove_judgement(s, error)
    type(situation_t), intent(in) :: s
    type(error_t), allocatable, intent(out) :: error

    call remove_file(s%stem//'.'//mesh_name(s%new%generation, 'restart.json'), error)
    if (.not. allocated(error)) call remove_file(s%stem//'.'//mesh_name(s%new%generation, 'probation.json'), error)
  end subroutine remove_judgement

  !> Copy a checkpoint; names as they end.
  subroutine copy(s, from, to, error)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: from, to
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: bytes

    call read_text(s%stem//'.'//from, bytes, error)
    if (.not. allocated(error)) call write_text(s%stem//'.'//to, bytes, error)
  end subroutine copy

  subroutine add_row(s, action, accepted, error)
    type(situation_t), intent(in) :: s
    type(action_t), intent(in) :: action
    character(len=*), intent(in) :: accepted
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: table

    if (file_exists(s%table)) then
      call read_text(s%table, table, error)
      if (allocated(error)) return
    else
      table = table_heading//new_line('a')
    end if
    call write_text(s%table, table//row_of(s, action, accepted)//new_line('a'), error)
  end subroutine add_row

  !> The try at hand as a line of the table, in the order of its heading.
  function row_of(s, action, accepted) result(line)
    type(situation_t), intent(in) :: s
    type(action_t), intent(in) :: action
    character(len=*), intent(in) :: accepted
    character(len=:), allocatable :: line
    character(len=:), allocatable :: made, restart, steps
    type(string_t) :: cells(number_of_columns)
    type(checkpoint_file_t) :: old
    logical :: judged

    old = old_state(s, action%way)
    judged = action%kind /= act_keep_old_mesh
    made = facts_of(s, try_name(s%new%generation, s%new%number)//'.json', judged)
    restart = facts_of(s, mesh_name(s%new%generation, 'restart.json'), judged .and. action%with_restart)
    steps = facts_of(s, mesh_name(s%new%generation, 'probation.json'), judged)
    cells(1)%s = to_text(s%new%generation)
    cells(2)%s = to_text(s%new%number)
    cells(3)%s = to_text(s%new%old_end%facts%step)
    cells(4)%s = exact_text(s%new%old_end%facts%time)
    cells(5)%s = to_text(old%facts%step)
    cells(6)%s = due_reason(s%new%old_end%facts)
    cells(7)%s = action%way
    cells(8)%s = action%result
    cells(9)%s = accepted
    cells(10)%s = action%stage
    cells(11)%s = to_text(old%facts%elements)
    cells(12)%s = json_text(made, 'new_elements')
    if (.not. judged) cells(12)%s = cells(11)%s
    cells(13)%s = error_of(old)
    cells(14)%s = scaled(restart, 'error_stress_pct', 1.0_wp)
    cells(15)%s = json_text(restart, 'first_residual')
    cells(16)%s = json_text(restart, 'iterations')
    cells(17)%s = scaled(restart, 'force_change', 100.0_wp)
    cells(18)%s = scaled(restart, 'energy_change', 100.0_wp)
    cells(19)%s = json_text(restart, 'depth_change')
    cells(20)%s = json_text(steps, 'least_step_ratio')
    cells(21)%s = ''
    if (judged .and. accepted == 'y') cells(21)%s = force_change_of(s, old%facts%step)
    cells(22)%s = json_text(made, 'laps')
    cells(23)%s = json_text(made, 'lap_depth')
    cells(24)%s = json_text(made, 'removed_volume')
    cells(25)%s = ''
    if (accepted == 'n') cells(25)%s = scaled(restart, 'force_over_limit', 1.0_wp)
    cells(26)%s = json_text(made, 'wall_s')
    cells(27)%s = json_text(restart, 'wall_s')
    cells(28)%s = action%reason
    line = line_of_cells(cells)
  end function row_of

  !> Change of the largest die force at the first full step on the new mesh in percent; '' where it says nothing.
  function force_change_of(s, step) result(digits)
    type(situation_t), intent(in) :: s
    integer, intent(in) :: step   !! the last one of the old mesh
    character(len=:), allocatable :: digits
    character(len=:), allocatable :: history
    type(error_t), allocatable :: error
    real(wp) :: change
    logical :: known

    digits = ''
    if (file_exists(join_path(s%folder, history_name))) call read_text(join_path(s%folder, history_name), history, error)
    if (.not. allocated(history) .or. allocated(error)) return
    call first_step_change(history, first_step_of(s%rows, s%new%generation - 1), step, change, known)
    if (known) digits = to_text(100*change, 4)
  end function force_change_of

  !> The line for the user that a mesh is accepted.
  function accepted_line(s, action) result(line)
    type(situation_t), intent(in) :: s
    type(action_t), intent(in) :: action
    character(len=:), allocatable :: line
    character(len=:), allocatable :: made, restart, removed
    type(checkpoint_file_t) :: old

    old = old_state(s, action%way)
    made = facts_of(s, try_name(s%new%generation, s%new%number)//'.json', .true.)
    restart = facts_of(s, mesh_name(s%new%generation, 'restart.json'), .true.)
    removed = json_text(made, 'removed_volume')
    if (removed /= '') removed = 'volume '//to_text(json_number(made, 'removed_volume', 0.0_wp), 6)//' removed; '
    line = 'mesh '//to_text(s%new%generation)//'  step '//to_text(old%facts%step)//'  time '//to_text(old%facts%time)//': ' &
           //due_reason(s%new%old_end%facts)//'; '//removed//to_text(old%facts%elements)//' -> '//json_text(made, 'new_elements') &
           //' elements; error '//or_dash(error_of(old))//' -> '//or_dash(scaled(restart, 'error_stress_pct', 1.0_wp)) &
           //' %; residual '//to_text(json_number(restart, 'first_residual', 0.0_wp), 3)//'; ' &
           //to_text(json_number(made, 'wall_s', 0.0_wp) + json_number(restart, 'wall_s', 0.0_wp), 2)//' s'
  end function accepted_line

  !> The text of a JSON file, '' where it is not wanted.
  function facts_of(s, name, wanted) result(json)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: name
    logical, intent(in) :: wanted
    character(len=:), allocatable :: json

    json = ''
    if (wanted) call read_json(s%stem//'.'//name, json)
  end function facts_of

  !> Four digits of a number in a JSON text, times `factor`; '' where there is none.
  pure function scaled(json, name, factor) result(digits)
    character(len=*), intent(in) :: json, name
    real(wp), intent(in) :: factor
    character(len=:), allocatable :: digits

    digits = json_text(json, name)
    if (digits /= '') digits = to_text(factor*json_number(json, name, 0.0_wp), 4)
  end function scaled

  !> Estimated error of the stress in percent; '' where it was not asked for.
  pure function error_of(file) result(digits)
    type(checkpoint_file_t), intent(in) :: file
    character(len=:), allocatable :: digits

    digits = ''
    if (file%facts%error_stress >= 0) digits = to_text(100*file%facts%error_stress, 4)
  end function error_of

  pure function or_dash(digits) result(shown)
    character(len=*), intent(in) :: digits
    character(len=:), allocatable :: shown

    shown = digits
    if (shown == '') shown = '-'
  end function or_dash

end module cycle_bookkeeping
