!> `lagamine DECK`: from a deck to its results.
module run_deck
  use accuracy_plan, only: plan_lines
  use accuracy_runs, only: make_plan
  use accuracy_samples, only: key_of
  use blas, only: keep_blas_to_one_thread
  use cards_operations, only: operations_t
  use contact_ends, only: contact_end_t
  use cost_file, only: cost_t, write_cost
  use deck_check, only: as_warnings, check_deck, look_at_deck
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, exit_done, exit_input, exit_remesh, exit_signal, fail
  use exchange, only: read_state, write_checkpoint
  use finer_temperatures, only: start_finer
  use folding_run, only: save_with_contact
  use folder_lock, only: folder_lock_t, lock_folder, unlock_folder
  use heat_handed_over, only: hand_heat_over
  use kinds, only: wp
  use laid_bodies, only: share_heat
  use law_api, only: law_t
  use law_registry, only: list_laws
  use listing, only: close_listing, list_lines, list_note, open_listing
  use march, only: march_to_end
  use member_reader, only: member_reader_t
  use next_operation, only: begin_operation
  use remeshing, only: drop_triggers
  use run_beginning, only: begin_run
  use run_ending, only: end_run, suspend_run
  use run_facts, only: run_facts_t
  use run_input, only: read_input, read_next_operation
  use run_options, only: run_options_t, stem_of
  use run_record, only: run_t
  use scene, only: lacks_mesh, scene_t
  use scene_summary, only: scene_lines
  use solution, only: solution_t, start_solution
  use standard_streams, only: print_lines
  use system, only: catch_signals, caught_signal, cpu_seconds, directory_exists, join_path, make_directory, wall_seconds
  use text, only: string_t
  implicit none
  private
  public :: run_options_on_deck

contains

  !> Carry out the options; `code` is the program's exit code when `error` stays unallocated.
  subroutine run_options_on_deck(options, code, error)
    type(run_options_t), intent(in) :: options
    integer, intent(out) :: code
    type(error_t), allocatable, intent(out) :: error
    type(folder_lock_t) :: lock

    code = exit_done
    call catch_signals()
    ! a checkpoint there is read only when no other process can replace it
    if (directory_exists(options%out) .and. .not. options%check) call lock_folder(options%out, 'lagamine', lock, error)
    if (.not. allocated(error)) call read_and_run(options, lock, code, error)
    call unlock_folder(lock)
  end subroutine run_options_on_deck

  recursive subroutine read_and_run(given, lock, code, error)
    type(run_options_t), intent(in) :: given
    type(folder_lock_t), intent(inout) :: lock
    integer, intent(out) :: code
    type(error_t), allocatable, intent(out) :: error
    type(deck_t), target :: deck
    type(diagnostics_t), target :: diagnostics
    type(operations_t) :: operations
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(run_t) :: run
    type(member_reader_t) :: checkpoint
    type(error_t), allocatable :: ignored
    type(run_options_t) :: options
    type(string_t), allocatable :: lines(:)
    logical :: at_rest

    code = exit_done
    options = given
    call keep_blas_to_one_thread()
    call read_input(options, deck, diagnostics, operations, scene, run%deck_text, at_rest, checkpoint, error)
    if (.not. allocated(error) .and. wants_plan(options, scene)) then
      call checkpoint%file%close(ignored)
      allocate (run%plan)
      call make_plan(options, scene, run%deck_text, run_pilot, run%plan, code, error)
      if (allocated(error) .or. code /= exit_done) return
      options%fineness = run%plan%fineness
      call read_input(options, deck, diagnostics, operations, scene, run%deck_text, at_rest, checkpoint, error)
    end if
    run%resume = allocated(options%resume) .and. .not. at_rest
    run%force_agreed = options%force_agreed
    if (.not. (allocated(error) .or. options%check)) then
      call start_solution(scene, solution)
      if (.not. run%resume) call start_finer(scene, solution%heat%finer)
      if (run%resume) call read_state(checkpoint, scene, solution, error)
      ! the reason why the run stopped is dropped: it goes on
      call drop_triggers(solution%estimate)
      solution%between_saves = .false.
    end if
    call checkpoint%file%close(ignored)
    if (allocated(error)) return
    if (options%forecast .and. .not. allocated(run%plan)) then
      call fail(error, exit_input, '--forecast: the deck has no ACCURACY card')
      return
    end if
    if (options%check) then
      call check_deck(options, deck, diagnostics, operations, scene, error)
      if (allocated(error) .or. .not. allocated(run%plan)) return
      call plan_lines(run%plan, lines)
      call print_lines(lines, error)
      return
    end if
    call make_directory(options%out, error)
    if (.not. allocated(error)) call lock_folder(options%out, 'lagamine', lock, error)
    if (allocated(error)) return
    run%deck_path = options%deck
    run%folder = options%out
    run%stem = join_path(run%folder, stem_of(options%deck))
    if (lacks_mesh(scene)) then
      call ask_for_mesh(options, scene, solution, run, error)
      code = exit_remesh
    else
      if (operations%count > 0) allocate (run%columns, source=operations%columns)
      run%has_new_meshes = operations%remeshed
      call run_and_report(options, scene, solution, run, error)
      code = run%exit_code
      if (operations%count > 0) call go_on(options, deck, diagnostics, operations, scene, solution, run, &
                                             code, error)
      if (run%folding == 0 .or. allocated(error)) return
      call save_with_contact(deck, diagnostics, operations, scene, solution, run%folding, run, error)
      if (allocated(error)) return
      options = given
      options%resume = run%stem//'.ckp.h5'
      call read_and_run(options, lock, code, error)
    end if
  end subroutine read_and_run

  !> A deck with ACCURACY that runs, or a forecast of it, but no pilot.
  pure function wants_plan(options, scene) result(yes)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    logical :: yes

    yes = scene%accuracy%asked > 0 .and. .not. allocated(options%fineness) .and. (options%forecast .or. .not. options%check)
  end function wants_plan

  !> A pilot of a deck with ACCURACY.
  recursive subroutine run_pilot(options, code, error)
    type(run_options_t), intent(in) :: options
    integer, intent(out) :: code
    type(error_t), allocatable, intent(out) :: error
    type(folder_lock_t) :: lock

    call read_and_run(options, lock, code, error)
    call unlock_folder(lock)
  end subroutine run_pilot

  !> The operations that follow one that has come to its end, one after the other.
  subroutine go_on(options, deck, diagnostics, operations, scene, solution, first, code, error)
    type(run_options_t), intent(in) :: options
    type(deck_t), intent(inout), target :: deck
    type(diagnostics_t), intent(inout), target :: diagnostics   !! without mistakes so far
    type(operations_t), intent(inout) :: operations
    type(scene_t), intent(inout) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: first   !! of the operation that has ended; what stops a later one is noted
    integer, intent(inout) :: code
    type(error_t), allocatable, intent(inout) :: error
    type(run_t), allocatable :: run
    type(scene_t), allocatable :: next
    type(solution_t), allocatable :: after
    type(law_t), allocatable :: laws(:)

    call list_laws(laws)
    do while (.not. allocated(error) .and. code == exit_done .and. scene%operation < operations%count)
      if (caught_signal() /= 0) then
        code = exit_signal + caught_signal()
        return
      end if
      allocate (run, next, after)
      call read_next_operation(deck, diagnostics, operations, scene, solution%step, next, error)
      if (allocated(error)) return
      call begin_operation(scene, solution, next, after)
      call share_heat(scene, next, laws, after)
      call hand_heat_over(scene, solution, next, laws, after)
      run%deck_path = first%deck_path
      run%deck_text = first%deck_text
      run%folder = first%folder
      run%stem = first%stem
      if (allocated(first%plan)) allocate (run%plan, source=first%plan)
      allocate (run%columns, source=first%columns)
      run%resume = .true.
      run%begins_operation = .true.
      run%has_new_meshes = first%has_new_meshes
      call run_and_report(options, next, after, run, error)
      code = run%exit_code
      first%folding = run%folding
      if (allocated(run%folds)) first%folds = run%folds
      scene = next
      solution = after
      deallocate (run, next, after)
    end do
  end subroutine go_on

  !> Bodies that have contours alone: a checkpoint for the remesher, which makes the first mesh.
  subroutine ask_for_mesh(options, scene, solution, run, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: reason = 'remesh: no mesh yet, the remesher makes it'
    type(string_t), allocatable :: lines(:), warnings(:)
    type(cost_t) :: cost

    cost%key = key_of(run%deck_text)
    if (allocated(options%fineness)) cost%fineness = options%fineness
    call write_cost(run%stem, cost, error)
    if (allocated(error)) return
    call open_listing(run%stem//'.log', .false., options%quiet, options%progress, 0.0_wp, run%listing, error)
    if (allocated(error)) return
    call scene_lines(scene, lines)
    call list_lines(run%listing, lines)
    call look_at_deck(options, scene, lines, warnings, error)
    if (.not. (allocated(error) .or. options%quiet)) call print_lines(as_warnings(warnings), error)
    if (allocated(error)) return
    call list_lines(run%listing, lines)
    call list_lines(run%listing, as_warnings(warnings))
    call list_note(run%listing, reason)
    call close_listing(run%listing)
    call write_checkpoint(run%stem//'.ckp.h5', run%deck_path, run%deck_text, scene, solution, [contact_end_t ::], error)
  end subroutine ask_for_mesh

  !> March, then write summary and listing whatever happened.
  subroutine run_and_report(options, scene, solution, run, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(run_facts_t) :: facts
    real(wp) :: started, processor
    integer :: nbefore

    started = wall_seconds()
    processor = cpu_seconds()
    call begin_run(options, scene, solution, run, facts%warnings, error)
    if (allocated(error)) return
    nbefore = size(facts%warnings)
    call march_to_end(scene, solution, run, error)
    facts%wall = wall_seconds() - started
    facts%processor = cpu_seconds() - processor
    if (run%folding > 0 .and. .not. allocated(error)) then
      call suspend_run(options, scene, solution, run, facts, error)
      return
    end if
    call end_run(options, scene, solution, nbefore, run, facts, error)
  end subroutine run_and_report

end module run_deck
