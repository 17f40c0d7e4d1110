!> `lagamine DECK`: from a deck to its results.
module run_deck
  use accuracy_laws, only: sample_t
  use accuracy_plan, only: accuracy_lines, accuracy_warning, judge_run, plan_lines
  use accuracy_rules, only: fineness_t
  use accuracy_runs, only: make_plan
  use accuracy_samples, only: add_cost, key_of, read_sample
  use atomic, only: refuse_place
  use blas, only: blas_buffer, blas_build, blas_core_name, keep_blas_to_one_thread
  use cards_operations, only: operations_t
  use closing_table, only: close_cycle, close_run
  use confinement, only: warn_of_confinement
  use contact_ends, only: contact_end_t
  use cost_file, only: cost_t, write_cost
  use cut_report, only: warn_of_webs
  use crossed_bodies, only: warn_of_crossed_bodies
  use deck_check, only: as_warnings, check_deck, look_at_deck
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, exit_done, exit_input, exit_no_convergence, exit_remesh, exit_signal, fail
  use exchange, only: read_state, write_checkpoint
  use floating_bodies, only: warn_of_floating_bodies, warn_of_idle_dies
  use folder_lock, only: folder_lock_t, lock_folder, unlock_folder
  use judge_remesh, only: agreed_words
  use heat_handed_over, only: hand_heat_over
  use heated_steels, only: warn_of_missing_austenite
  use held_steels, only: warn_of_held_steels
  use kinds, only: wp
  use laid_bodies, only: share_heat
  use law_api, only: law_t
  use law_manual, only: law_card, law_list
  use law_registry, only: law_names, list_laws
  use listing, only: close_listing, end_progress, list_lines, list_note, list_resumed, open_listing
  use march, only: march_to_end
  use member_reader, only: member_reader_t
  use memory_limits, only: require_memory
  use next_operation, only: begin_operation
  use operation_outlook, only: look_at_beginning, warn_of_overlap
  use passed_planes, only: warn_of_passed_planes
  use remeshing, only: drop_triggers
  use run_facts, only: run_facts_t
  use run_input, only: read_input, read_next_operation
  use run_options, only: run_options_t, stem_of
  use run_record, only: run_t
  use results, only: forget_failure
  use run_version, only: blas_words, version_text
  use scene, only: lacks_mesh, scene_t
  use scene_summary, only: scene_lines
  use solution, only: solution_t, start_solution
  use standard_streams, only: print_line, print_lines
  use summary, only: write_summary
  use summary_table, only: summary_lines
  use system, only: catch_signals, caught_signal, cpu_seconds, directory_exists, join_path, make_directory, &
                    remove_file, wall_seconds
  use text, only: add_text, join, nearest_word, string_t, to_text
  use threads, only: start_team
  implicit none
  private
  public :: run_options_on_deck, print_law

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
    type(run_t), intent(in) :: first   !! of the operation that has ended
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
    type(error_t), allocatable :: late
    type(string_t), allocatable :: lines(:), late_warnings(:)
    real(wp) :: started, processor
    integer :: told

    started = wall_seconds()
    processor = cpu_seconds()
    call start_team(run%equations%team, options%threads)
    call require_memory(0.0_wp, 'the threads of a run', error, address_space=run%equations%team%most*blas_buffer)
    if (allocated(error)) return
    call open_listing(run%stem//'.log', run%resume, options%quiet, options%progress, solution%time/scene%strategy%end_time, &
                      run%listing, error)
    if (allocated(error)) return
    ! the result of an earlier call is not that of this one: its summary, end and failure are removed
    call remove_file(join_path(run%folder, 'summary.json'), error)
    if (.not. allocated(error) .and. scene%operation > 0) &
      call remove_file(join_path(run%folder, 'summary.'//scene%operation_name//'.json'), error)
    if (.not. allocated(error)) call forget_failure(run%stem, scene%generation, error)
    ! written only after a while
    if (.not. allocated(error)) call refuse_place(run%stem//'.ckp.h5', error)
    if (allocated(error)) return
    if (run%begins_operation) then
      call list_lines(run%listing, [string_t('operation '//scene%operation_name//' begins after step ' &
                                             //to_text(solution%step)//', time '//to_text(solution%time))])
    else if (run%resume) then
      call list_resumed(run%listing, options%resume, solution)
    end if
    call scene_lines(scene, lines)
    call list_lines(run%listing, lines)
    call look_at_deck(options, scene, lines, facts%warnings, error)
    if (run%begins_operation .and. .not. allocated(error)) call look_at_beginning(scene, solution, lines)
    if (.not. allocated(error)) call warn_of_overlap(scene, solution, facts%warnings)
    if (.not. allocated(error)) told = size(facts%warnings)
    if (options%progress .and. .not. (allocated(options%resume) .or. allocated(error))) &
      call print_lines(as_warnings(facts%warnings), error)
    if (allocated(error)) return
    call list_lines(run%listing, lines)
    call list_lines(run%listing, as_warnings(facts%warnings))
    if (allocated(run%plan) .and. .not. run%begins_operation) then
      call plan_lines(run%plan, lines)
      call list_lines(run%listing, lines)
      if (.not. (options%quiet .or. run%resume)) call print_lines(lines, error)
      if (allocated(error)) return
    end if
    call march_to_end(scene, solution, run, error)
    call end_progress(run%listing)
    if (allocated(error)) call add_warnings(facts%warnings, error)

    if (allocated(run%balance)) then
      if (run%balance%agreed) call add_text(facts%warnings, agreed_words(run%balance))
    end if
    call warn_of_confinement(scene, solution, facts%warnings)
    call warn_of_passed_planes(scene, solution, facts%warnings)
    if (run%exit_code == exit_done) then
      call warn_of_webs(scene, solution, facts%warnings)
      call warn_of_missing_austenite(scene, solution, facts%warnings)
      call warn_of_held_steels(scene, solution, facts%warnings)
      call warn_of_floating_bodies(scene, run%equations%loose, solution, facts%warnings)
      call warn_of_crossed_bodies(scene, run%equations%free_sides, solution, facts%warnings)
      call warn_of_idle_dies(scene, run%equations, solution, run%totals%volume, facts%warnings)
    end if
    facts%version = version_text
    facts%deck = options%deck
    facts%deck_text = run%deck_text
    facts%overrides = options%overrides
    facts%status = merge('done   ', 'stopped', run%exit_code == exit_done)
    facts%status = trim(facts%status)
    facts%stop_reason = run%stop_reason
    facts%exit_code = run%exit_code
    facts%threads = run%equations%team%most
    facts%blas = blas_words(blas_build(), blas_core_name())
    facts%wall = wall_seconds() - started
    call close_run(scene, run%equations, solution, run%totals%volume, facts%closing)
    ! of an operation without REMSH too, where others have it
    if (run%has_new_meshes .or. (scene%accuracy%asked > 0 .and. allocated(options%fineness))) &
      call close_cost(options, scene, solution, cpu_seconds() - processor, run, facts, late)
    call summary_lines(facts, scene, run%equations, solution, run%totals, lines)
    call list_lines(run%listing, lines)
    call close_listing(run%listing)
    call write_summary(join_path(run%folder, summary_name(scene, run)), facts, scene, run%equations, solution, run%totals, &
                       run%balance, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
    if (.not. (options%quiet .or. options%progress .or. allocated(error))) then
      if (scene%operation > 0) call print_line('operation '//scene%operation_name, late)
      call print_lines(lines, late)
      ! scripts read first why a run has stopped
      if (allocated(late) .and. run%exit_code == exit_done) call move_alloc(late, error)
    else if (options%progress .and. run%exit_code == exit_done .and. .not. allocated(error)) then
      allocate (late_warnings, source=closing_warnings(lines, facts%warnings(:told)))
      if (allocated(facts%closing%accuracy)) then
        call accuracy_lines(facts%closing%accuracy, lines)
        call print_lines(lines, error)
      end if
      if (.not. allocated(error)) call print_lines(late_warnings, error)
    end if
  end subroutine run_and_report

  !> Warnings among the lines of the summary that were not printed before the run.
  pure function closing_warnings(lines, before) result(list)
    type(string_t), intent(in) :: lines(:)    !! (nline) of the summary
    type(string_t), intent(in) :: before(:)   !! (nwarning) of the deck
    type(string_t), allocatable :: list(:)
    integer :: k, j

    allocate (list(0))
    do k = 1, size(lines)
      if (index(lines(k)%s, 'WARNING: ') == 0) cycle
      do j = 1, size(before)
        if (index(lines(k)%s, before(j)%s) > 0) exit
      end do
      if (j > size(before)) call add_text(list, trim(adjustl(lines(k)%s)))
    end do
  end function closing_warnings

  !> What was seen of the deck before the run may be why it cannot go on.
  pure subroutine add_warnings(warnings, error)
    type(string_t), intent(in) :: warnings(:)   !! (nwarning) of the deck
    type(error_t), intent(inout) :: error
    character(len=:), allocatable :: words
    integer :: k

    if (error%code /= exit_no_convergence .or. size(warnings) == 0) return
    words = 'WARNING before the run: '//warnings(1)%s
    do k = 2, size(warnings)
      words = words//'; '//warnings(k)%s
    end do
    if (allocated(error%advice)) words = words//'; '//error%advice
    error%advice = words
  end subroutine add_warnings

  !> What a run of a deck with ACCURACY or REMSH has cost, over all its meshes; and what one with ACCURACY that has come to its end
  !> has reached. A warning where that is less than asked.
  subroutine close_cost(options, scene, solution, seconds, run, facts, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: seconds   !! of processor [s]
    type(run_t), intent(in) :: run
    type(run_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(sample_t) :: sample
    type(fineness_t) :: fineness
    type(cost_t) :: cost
    character(len=:), allocatable :: words
    logical :: there

    if (allocated(options%fineness)) fineness = options%fineness
    call add_cost(run%stem, run%deck_text, fineness, scene, run%equations, solution, seconds, &
                  merge(facts%closing%stress, -1.0_wp, facts%closing%space), &
                  run%exit_code == exit_done .and. scene%operation >= scene%operations, &
                  run%begins_operation .or. allocated(options%resume), cost, error)
    if (allocated(error)) return
    call close_cycle(scene, cost, join_path(run%folder, 'history.csv'), facts%closing)
    if (.not. (cost%finished .and. allocated(run%plan))) return
    call read_sample(options, run%deck_text, options%fineness, run%plan%columns, sample, there)
    if (.not. there) return
    allocate (facts%closing%accuracy)
    call judge_run(run%plan, sample, facts%closing%accuracy)
    words = accuracy_warning(facts%closing%accuracy)
    if (len(words) > 0) call add_text(facts%warnings, words)
  end subroutine close_cost

  !> The summary of an operation that others follow has a name of its own.
  pure function summary_name(scene, run) result(name)
    type(scene_t), intent(in) :: scene
    type(run_t), intent(in) :: run
    character(len=:), allocatable :: name

    name = 'summary.json'
    if (run%exit_code == exit_done .and. scene%operation < scene%operations) name = 'summary.'//scene%operation_name//'.json'
  end function summary_name

  !> --law: the card of a law, or all laws in a list where no name is given.
  subroutine print_law(name, error)
    character(len=*), intent(in) :: name
    type(error_t), allocatable, intent(out) :: error
    type(law_t), allocatable :: laws(:)
    type(string_t), allocatable :: names(:), lines(:)
    character(len=:), allocatable :: nearest
    integer :: k

    call list_laws(laws)
    if (name == '') then
      call law_list(laws, lines)
      call print_lines(lines, error)
      return
    end if
    do k = 1, size(laws)
      if (laws(k)%name /= name) cycle
      call law_card(laws(k), lines)
      call print_lines(lines, error)
      return
    end do
    call law_names(laws, names)
    nearest = nearest_word(name, names)
    if (nearest /= '') nearest = '; nearest: '''//nearest//''''
    call law_list(laws, lines)
    call fail(error, exit_input, 'no law is called '''//name//''''//nearest, 'the laws:'//new_line('a')//join(lines, new_line('a')))
  end subroutine print_law

end module run_deck
