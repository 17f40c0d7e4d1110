!> Situations of a cycle for its tests: as `cycle_folder` would read them.
module cycle_cases
  use cycle_situation, only: checkpoint_file_t, ended_check, ended_lagamine, ended_remdata, situation_t
  use cycle_table, only: parse_table, table_heading, try_row_t
  use errors, only: error_t
  use kinds, only: wp
  use text, only: string_t, to_text
  implicit none
  private
  public :: fresh_folder, on_the_way, at_a_stop, at_first_mesh, on_first_mesh, on_new_mesh
  public :: with_try, whole, broken, ended_as, with_rows, row_text, row

contains

  !> Nothing is there, nothing was called.
  function fresh_folder() result(s)
    type(situation_t) :: s

    s%stem = 'out/case'
    s%folder = 'out'
    s%table = 'out/cycle.csv'
    s%ended%from = ''
    s%ended%said = 'lagamine: exit code 0'
    s%new%made_stage = ''
    s%new%restart_stage = ''
    s%new%steps_stage = ''
    allocate (s%rows(0))
  end function fresh_folder

  !> Mesh 1 after step 4, in the middle of the scene; the deck was checked.
  function on_the_way() result(s)
    type(situation_t) :: s

    s = fresh_folder()
    s%ended%program = ended_check
    s%ended%from = 'ckp.h5'
    s%current = whole(1, 4)
    s%new%generation = 2
  end function on_the_way

  !> Mesh 1 has stopped after step 6 for mesh 2; the checkpoint is kept, the save before it is of step 4.
  function at_a_stop(trigger) result(s)
    character(len=*), intent(in), optional :: trigger
    type(situation_t) :: s

    s = on_the_way()
    s%current = whole(1, 6)
    s%current%facts%triggers = [string_t('time')]
    if (present(trigger)) s%current%facts%triggers = [string_t(trigger)]
    s%current%facts%values = [0.1_wp]
    s%current%facts%limits = [0.1_wp]
    s%end_is_kept = .true.
    s%new%old_end = s%current
    s%new%old_earlier = whole(1, 4)
    call set_ended(s, ended_lagamine, 4, 'ckp.h5')
  end function at_a_stop

  !> A body given by its contour waits for its first mesh.
  function at_first_mesh() result(s)
    type(situation_t) :: s

    s = at_a_stop()
    s%current = whole(1, 0)
    s%current%facts%elements = 0
    s%new%old_end = s%current
    s%new%old_earlier = checkpoint_file_t()
  end function at_first_mesh

  !> A first mesh, made from contours, has stopped after step 6.
  function on_first_mesh(trigger) result(s)
    character(len=*), intent(in) :: trigger
    type(situation_t) :: s

    s = at_a_stop(trigger)
    s%current%facts%generation = 2
    s%new%generation = 3
    s%new%old_end = s%current
    s%new%old_earlier = checkpoint_file_t()
    s%new%old_source = whole(1, 0)
    s%new%old_source%facts%elements = 0
  end function on_first_mesh

  !> The run is on mesh 2 after step 8, and its try is still there; so many of its first steps are to come.
  function on_new_mesh(steps_to_come) result(s)
    integer, intent(in) :: steps_to_come
    type(situation_t) :: s

    s = at_a_stop()
    s%current = whole(2, 8)
    s%current%facts%probation = steps_to_come
    s%end_is_kept = .false.
    s%new%made = whole(2, 6)
    s%new%has_facts = .true.
    s%new%has_tries = .true.
    call set_ended(s, ended_lagamine, 3, 'ckp.h5')
  end function on_new_mesh

  !> The same situation with a whole try at mesh 2, made from the state after `step`.
  function with_try(s, step) result(with)
    type(situation_t), intent(in) :: s
    integer, intent(in) :: step
    type(situation_t) :: with

    with = s
    with%new%made = whole(2, step)
    with%new%made%facts%unbalanced = .true.
    with%new%has_facts = .true.
    with%new%has_tries = .true.
  end function with_try

  !> A checkpoint that is whole, at time step/60.
  function whole(generation, step) result(file)
    integer, intent(in) :: generation, step
    type(checkpoint_file_t) :: file

    file%found = .true.
    file%facts%generation = generation
    file%facts%remeshings = generation - 1
    file%facts%step = step
    file%facts%elements = 12*generation
    file%facts%time = step/60.0_wp
    file%facts%transfer = 1
    file%facts%tries = 5
  end function whole

  function broken(name) result(file)
    character(len=*), intent(in) :: name
    type(checkpoint_file_t) :: file

    file%found = .true.
    file%refused = 'out/case.'//name//': cut short'
  end function broken

  !> The same situation after a program has ended: 'lagamine' (begun with `from`) or 'remdata'.
  function ended_as(s, program, code, from, said, late) result(after)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: program
    integer, intent(in) :: code
    character(len=*), intent(in), optional :: from, said
    integer, intent(in), optional :: late
    type(situation_t) :: after

    after = s
    call set_ended(after, merge(ended_remdata, ended_lagamine, program == 'remdata'), code, '')
    if (present(from)) after%ended%from = from
    if (present(said)) after%ended%said = said
    if (present(late)) after%ended%late = late
  end function ended_as

  subroutine set_ended(s, program, code, from)
    type(situation_t), intent(inout) :: s
    integer, intent(in) :: program, code
    character(len=*), intent(in) :: from

    s%ended%program = program
    s%ended%code = code
    s%ended%from = from
    s%ended%said = 'note: a note'//new_line('a')//'why it failed'
  end subroutine set_ended

  !> A line of cycle.csv.
  function row_text(generation, stop_step, action, accepted, stage) result(line)
    integer, intent(in) :: generation, stop_step
    character(len=*), intent(in) :: action, accepted, stage
    character(len=:), allocatable :: line

    line = to_text(generation)//',1,'//to_text(stop_step)//','//to_text(stop_step/60.0_wp, 17)//',6,time,'//action//',result,' &
           //accepted//','//stage//',12,,,,,,,,,,,,,,,,,why'
  end function row_text

  !> A row by the way of the table's text.
  function row(generation, stop_step, action, accepted, stage) result(parsed)
    integer, intent(in) :: generation, stop_step
    character(len=*), intent(in) :: action, accepted, stage
    type(try_row_t) :: parsed
    type(try_row_t), allocatable :: rows(:)
    type(error_t), allocatable :: error

    call parse_table(table_heading//new_line('a')//row_text(generation, stop_step, action, accepted, stage)//new_line('a'), &
                     'out/cycle.csv', rows, error)
    parsed = rows(1)
  end function row

  !> The same situation when these tries were made, each at mesh 2 at the stop after step 6: `ways` refused for `stage`.
  function with_rows(s, ways, stage) result(with)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: ways(:), stage
    type(situation_t) :: with
    integer :: k

    with = s
    do k = 1, size(ways)
      with%rows = [with%rows, row(2, s%new%old_end%facts%step, trim(ways(k)), 'n', stage)]
    end do
    with%new%number = size(ways) + 1
  end function with_rows

end module cycle_cases
