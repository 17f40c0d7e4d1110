!> The situation of a cycle, read from the files in its folder. Each of them is whole or missing.
module cycle_folder
  use atomic, only: previous_name, read_text, write_text
  use cycle_options, only: cycle_options_t
  use cycle_situation, only: checkpoint_file_t, current_name, ended_lagamine, ended_nothing, ended_remdata, ended_t, first_line, &
    is_due, is_first_mesh, is_read, mesh_name, made_mesh_t, situation_t, try_name
  use cycle_table, only: parse_table, try_row_t
  use cycle_tries, only: number_refused
  use errors, only: error_t, exit_done, exit_machine, exit_no_convergence, exit_remesh
  use exchange, only: checkpoint_facts_t, read_facts, read_facts_alone
  use json_lookup, only: json_number, json_text, read_json
  use kinds, only: wp
  use system, only: directory_of, file_exists, join_path, remove_file
  implicit none
  private
  public :: read_situation, seen_files_t, most_tries

  !> A checkpoint that was found whole.
  type :: seen_file_t
    character(len=:), allocatable :: bytes
    type(checkpoint_facts_t) :: facts
  end type seen_file_t

  !> Checkpoints that were found whole, so that none is checked again that has the same bytes, under its name or another.
  type :: seen_files_t
    type(seen_file_t), allocatable :: file(:)   !! (nfile)
    !> Programs of this cycle have just written them: what is in them is not doubted, if their hash is right.
    logical :: are_ours = .false.
  end type seen_files_t

contains

  !> Only what the decision may ask for is read: checkpoints are large, and every one is checked as a whole.
  subroutine read_situation(options, seen, s, error)
    type(cycle_options_t), intent(in) :: options
    type(seen_files_t), intent(inout) :: seen
    type(situation_t), intent(out) :: s
    type(error_t), allocatable, intent(out) :: error

    s%stem = options%stem
    s%folder = directory_of(s%stem)
    s%table = join_path(s%folder, 'cycle.csv')
    s%tries = options%tries
    s%fresh = options%fresh
    s%ended = options%ended
    seen%are_ours = (s%ended%program == ended_lagamine .and. any(s%ended%code == [exit_done, exit_remesh])) .or. &
                    (s%ended%program == ended_remdata .and. s%ended%code == exit_done)
    allocate (s%rows(0))
    s%new = no_mesh()
    call look(s%stem//'.'//current_name, seen, s%current)
    if (.not. is_read(s%current)) call look(s%stem//'.'//previous_name(current_name), seen, s%previous)
    if (s%ended%program == ended_nothing .or. .not. is_read(s%current)) return
    call read_table(s%table, s%rows, error)
    if (allocated(error)) return
    call read_new_mesh(seen, s)
    call read_summary(s)
    if (s%ended%program == ended_remdata .and. s%ended%code == exit_machine) s%has_room = room_for_mesh(s%stem)
  end subroutine read_situation

  !> A checkpoint: is it there, is it whole, what does it hold?
  subroutine look(path, seen, file)
    character(len=*), intent(in) :: path
    type(seen_files_t), intent(inout) :: seen
    type(checkpoint_file_t), intent(out) :: file
    type(seen_file_t) :: new
    type(error_t), allocatable :: error
    integer :: k

    file%found = file_exists(path)
    if (.not. file%found) return
    if (.not. allocated(seen%file)) allocate (seen%file(0))
    call read_text(path, new%bytes, error)
    if (.not. allocated(error)) then
      do k = 1, size(seen%file)
        if (len(seen%file(k)%bytes) /= len(new%bytes)) cycle
        if (seen%file(k)%bytes /= new%bytes) cycle
        file%facts = seen%file(k)%facts
        return
      end do
    end if
    if (seen%are_ours) then
      call read_facts_alone(path, file%facts, error)
    else
      call read_facts(path, file%facts, error)
    end if
    if (allocated(error)) then
      file%refused = first_line(error%message)
    else
      if (.not. allocated(new%bytes)) return
      new%facts = file%facts
      seen%file = [seen%file, new]
    end if
  end subroutine look

  subroutine read_table(path, rows, error)
    character(len=*), intent(in) :: path
    type(try_row_t), allocatable, intent(out) :: rows(:)   !! (ntry)
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text

    text = ''
    if (file_exists(path)) call read_text(path, text, error)
    if (.not. allocated(error)) call parse_table(text, path, rows, error)
  end subroutine read_table

  !> The mesh that the run is on while its try is still there: its first steps are done, or the run failed in them.
  !> Otherwise the one that is due.
  subroutine read_new_mesh(seen, s)
    type(seen_files_t), intent(inout) :: seen
    type(situation_t), intent(inout) :: s
    logical :: due, has_tries, judged

    due = is_due(s%current%facts)
    associate (generation => s%current%facts%generation, new => s%new)
      judged = s%current%facts%probation == 0 .or. failed(s%ended)
      has_tries = generation > 1 .and. judged
      new%generation = generation
      if (has_tries) call find_tries(s, seen, new%generation, has_tries)
      new%has_tries = has_tries
      if (has_tries) then
        call look(s%stem//'.'//mesh_name(new%generation - 1, 'end.h5'), seen, new%old_end)
      else
        new%generation = generation + 1
        if (due) s%end_is_kept = is_same(s%stem//'.'//current_name, s%stem//'.'//mesh_name(generation, 'end.h5'))
        if (s%end_is_kept) new%old_end = s%current
      end if
      if (new%generation == 3) call look(s%stem//'.'//mesh_name(1, 'end.h5'), seen, new%old_source)
      if (is_read(new%old_end)) call read_try(s%stem, s%rows, seen, new)
    end associate
  end subroutine read_new_mesh

  !> The mesh whose tries are still there: that of the run; or, where an operation has begun since, one of an operation before.
  !> Tries that were refused before an operation began are none of its mesh, on which no run was restarted.
  subroutine find_tries(s, seen, generation, found)
    type(situation_t), intent(in) :: s
    type(seen_files_t), intent(inout) :: seen
    integer, intent(inout) :: generation   !! that of the run on entry
    logical, intent(out) :: found
    type(checkpoint_file_t) :: old_end
    integer :: g, least
    logical :: restarted

    least = generation
    if (s%current%facts%operation > 1) least = 2
    do g = generation, least, -1
      found = any_try(s, g)
      restarted = file_exists(s%stem//'.'//mesh_name(g, 'restart.json'))
      if (found .and. s%current%facts%operation > 1 .and. .not. restarted) then
        call look(s%stem//'.'//mesh_name(g - 1, 'end.h5'), seen, old_end)
        found = is_read(old_end)
        if (found) found = is_first_mesh(old_end%facts)
      end if
      if (.not. found) cycle
      generation = g
      return
    end do
  end subroutine find_tries

  !> The try at hand: the one after those that were refused at this stop.
  subroutine read_try(stem, rows, seen, new)
    character(len=*), intent(in) :: stem
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    type(seen_files_t), intent(inout) :: seen
    type(made_mesh_t), intent(inout) :: new
    character(len=:), allocatable :: json, path

    new%number = number_refused(rows, new%generation, new%old_end%facts%step) + 1
    ! the earlier save is never the first way
    if (new%number > 1) call look(stem//'.'//mesh_name(new%generation - 1, 'end.1.h5'), seen, new%old_earlier)
    path = stem//'.'//try_name(new%generation, new%number)
    call look(path, seen, new%made)
    new%has_facts = file_exists(path//'.json')
    call read_json(path//'.json', json)
    new%made_stage = json_text(json, 'stage')
    call read_json(stem//'.'//mesh_name(new%generation, 'restart.json'), json)
    new%restart_refused = json_text(json, 'remesh_refused') == 'true'
    new%restart_stage = json_text(json, 'stage')
    call read_json(stem//'.'//mesh_name(new%generation, 'probation.json'), json)
    new%steps_stage = json_text(json, 'stage')
  end subroutine read_try

  pure function no_mesh() result(new)
    type(made_mesh_t) :: new

    new%made_stage = ''
    new%restart_stage = ''
    new%steps_stage = ''
  end function no_mesh

  pure function failed(ended)
    type(ended_t), intent(in) :: ended
    logical :: failed

    failed = ended%program == ended_lagamine .and. ended%code == exit_no_convergence
  end function failed

  !> No try at mesh `generation` has a higher number.
  pure function most_tries(rows, generation) result(most)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    integer :: most

    most = count(rows%generation == generation) + 1
  end function most_tries

  !> Is there a file of any try at mesh `generation`?
  function any_try(s, generation)
    type(situation_t), intent(in) :: s
    integer, intent(in) :: generation
    logical :: any_try
    integer :: k

    any_try = .false.
    do k = 1, most_tries(s%rows, generation)
      any_try = file_exists(s%stem//'.'//try_name(generation, k))
      if (any_try) return
    end do
  end function any_try

  !> Have two files the same bytes?
  function is_same(one, other)
    character(len=*), intent(in) :: one, other
    logical :: is_same
    character(len=:), allocatable :: first, second
    type(error_t), allocatable :: error

    is_same = file_exists(other)
    if (.not. is_same) return
    call read_text(one, first, error)
    if (.not. allocated(error)) call read_text(other, second, error)
    is_same = .not. allocated(error)
    if (is_same) is_same = len(first) == len(second)
    if (is_same) is_same = first == second
  end function is_same

  !> Does `summary.json` report the end of the scene, at the step of the checkpoint? Its warnings are counted.
  subroutine read_summary(s)
    type(situation_t), intent(inout) :: s
    character(len=:), allocatable :: json

    call read_json(join_path(s%folder, 'summary.json'), json)
    associate (facts => s%current%facts)
      s%finished = number('exit_code') == 0 .and. number('steps') == facts%step .and. number('remeshings') == facts%remeshings
    end associate
    if (s%finished) s%warnings = max(0, number('warning_count'))

  contains

    function number(name)
      character(len=*), intent(in) :: name
      integer :: number

      number = nint(json_number(json, name, -1.0_wp))
    end function number

  end subroutine read_summary

  !> Is there room for a new mesh, which may have some times the elements of the old one? Then a disk that was full is not why it
  !> could not be written.
  function room_for_mesh(stem) result(room)
    character(len=*), intent(in) :: stem
    logical :: room
    integer, parameter :: times = 8
    character(len=:), allocatable :: bytes, path
    type(error_t), allocatable :: error, ignored

    path = stem//'.room.tmp'
    call read_text(stem//'.'//current_name, bytes, error)
    if (.not. allocated(error)) call write_text(path, repeat(bytes, times), error)
    room = .not. allocated(error)
    call remove_file(path, ignored)
  end function room_for_mesh

end module cycle_folder
