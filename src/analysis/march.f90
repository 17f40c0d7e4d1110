!> The march in time: the page that reads like the method.
module march
  use accept_step, only: accept
  use acceptance, only: begin_probation, is_on_probation, note_cutback, note_step
  use blas, only: blas_buffer
  use bookkeeping, only: measure_scene
  use cut_report, only: lines_of_cuts
  use damping, only: begin_damping, strengthen_damping
  use driver_values, only: start_drivers
  use energy_books, only: start_stored
  use equation_set_up, only: set_up
  use errors, only: error_t, exit_no_convergence, fail
  use fields, only: displacement_field
  use estimator, only: set_up_estimator
  use heated_steels, only: note_missing_austenite
  use held_steels, only: note_held_steels
  use history, only: open_history
  use judge_remesh, only: limit_lines, refuse_remesh
  use kinds, only: eps, wp
  use listing, only: list_balance, list_cutback, list_event, list_lines, list_note, list_step, show_progress
  use lost_equilibrium, only: refuse_lost_equilibrium
  use memory_limits, only: require_memory
  use path_record, only: note_attempt
  use probation, only: is_too_short, pass_probation, refuse_after_all
  use restart_report, only: write_restart
  use restore_balance, only: balance_t, keep_balance, restore_equilibrium
  use results, only: open_results, save_fields
  use run_record, only: run_t, record, save_all, at_end
  use run_stop, only: stop_here, finish
  use scene, only: scene_t
  use small_strain, only: refuse_large_strain
  use solution, only: solution_t
  use spent_polynomials, only: refuse_spent_polynomials
  use spurious_mode, only: has_mean_dilatation, spurious_limit
  use step_outcome, only: outcome_t
  use step_solves, only: solve_fields
  use step_strategy, only: after_failure, after_success, choose_step
  use system, only: caught_signal, join_path
  use text, only: to_text, two_digits
  use unheld_dies, only: find_unheld_die, unheld_die_t
  use watch_mesh, only: answer_distress, ask_for_trims, estimate, estimate_stress, look_at_mesh, mesh_is_due
  implicit none
  private
  public :: march_to_end

  !> A step shortened to an event is shortened by at least this much, so that the event is met in a few trials.
  real(wp), parameter :: largest_event = 0.95_wp
  !> So many cutbacks in a row are not answered by damping; damped, a step of the least length is tried until there were so many.
  integer, parameter :: most_cutbacks_undamped = 2, most_cutbacks_damped = 12
  !> So many cutbacks in a row show that a body passes through itself in steps of any length.
  integer, parameter :: most_cutbacks_for_crossing = 3

contains

  !> March from the instant of the solution to the end of the scene, or to where it must stop.
  subroutine march_to_end(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(outcome_t) :: outcome
    real(wp) :: dt, length
    logical :: on_probation
    integer :: cutbacks

    cutbacks = 0
    call start(scene, solution, run, error)
    if (.not. allocated(error)) call refuse_lost_equilibrium(scene, solution, error)
    do while (.not. (allocated(error) .or. mesh_is_due(solution)) .and. solution%time < scene%strategy%end_time*(1 - 64*eps))
      dt = choose_step(scene, solution%time, solution%next_step)
      length = min(solution%next_step, scene%strategy%largest_step)
      on_probation = is_on_probation(solution%probation)

      call solve_fields(scene, run%equations, solution, dt, outcome)
      do while (outcome%event < 1)
        call note_attempt(outcome%path, dt, solution%path)
        if (outcome%path%too_long) call strengthen_damping(solution)
        dt = max(min(outcome%event, largest_event)*dt, scene%strategy%least_step)
        call list_event(run%listing, solution, dt, outcome%event_reason)
        if (outcome%heat%too_long) solution%heat%shortened = solution%heat%shortened + 1
        call solve_fields(scene, run%equations, solution, dt, outcome)
      end do
      if (allocated(outcome%error)) then
        call move_alloc(outcome%error, error)
        exit
      end if

      if (.not. outcome%converged) then
        call answer_failure(scene, dt, on_probation, outcome, cutbacks, solution, run, error)
        if (mesh_is_due(solution)) exit
        cycle
      end if

      solution%next_step = after_success(scene, dt, solution%next_step, outcome%first_iterations, outcome%strain, &
                                        min(outcome%heat%growth, outcome%path%growth), outcome%patch_difficulty)
      call accept(scene, run%equations, dt, outcome, solution, run%totals, error)
      if (allocated(error)) exit
      call note_missing_austenite(scene, run%equations%laws, solution)
      call note_held_steels(scene, run%equations%laws, solution)
      cutbacks = 0
      call note_damped_steps(solution, run)
      call note_step(solution%probation, length)
      call estimate(scene, run%estimator, run%equations%timers, solution)
      call list_step(run%listing, solution, outcome, run%totals)
      ! at the end no new mesh is needed; on one made while viscous forces hold the part these would be out of balance
      if (.not. (at_end(scene, solution) .or. solution%damping > 0)) &
        call look_at_mesh(scene, run%equations%timers, run%listing, solution)
      call report_spurious_mode(scene, solution, run)
      call show_progress(run%listing, scene, solution, outcome%iterations)
      if (on_probation) call judge_steps(scene, solution, outcome, run, error)
      if (allocated(error)) exit
      call record(scene, solution, outcome, run, error)
      if (.not. allocated(error)) call refuse_large_strain(scene, run%equations%laws, solution, error)
      if (.not. allocated(error)) call refuse_spent_polynomials(scene, run%equations%laws, solution, error)
      if (.not. allocated(error)) call refuse_lost_equilibrium(scene, solution, error)
      if (allocated(error)) exit
      if (caught_signal() /= 0 .or. mesh_is_due(solution)) exit
    end do
    call finish(scene, solution, run, error)
  end subroutine march_to_end

  !> A step has failed: it is cut back, a new mesh is asked for, the mesh is refused, or the run cannot go on.
  subroutine answer_failure(scene, dt, on_probation, outcome, cutbacks, solution, run, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt
    logical, intent(in) :: on_probation
    type(outcome_t), intent(in) :: outcome
    integer, intent(inout) :: cutbacks   !! one after the other
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(unheld_die_t) :: unheld
    logical :: give_up

    unheld = find_unheld_die(scene, run%equations, solution, index(outcome%reason, 'singular') > 0)
    solution%cutbacks = solution%cutbacks + 1
    call after_failure(scene, dt, solution%next_step, give_up)
    call list_cutback(run%listing, scene, solution, dt, solution%next_step, outcome)
    cutbacks = cutbacks + 1
    ! only a motion that is not found is damped
    if (.not. (outcome%of_heat .or. outcome%passes_itself) &
        .and. (cutbacks > most_cutbacks_undamped .or. give_up .or. solution%damping > 0)) then
      call damp(scene, dt, on_probation, outcome, solution, run)
      ! more damping does what a shorter step cannot
      if (give_up .and. solution%damping > 0 .and. cutbacks < most_cutbacks_damped) then
        give_up = .false.
        solution%next_step = dt
      end if
    end if
    if (outcome%passes_itself) give_up = give_up .or. cutbacks > most_cutbacks_for_crossing
    call note_cutback(solution%probation, solution%next_step)
    if (on_probation .and. is_too_short(scene, solution)) then
      call refuse_mesh(scene, solution, outcome, run, error)
      return
    end if
    call answer_distress(scene, merge(0, cutbacks, solution%damping > 0), give_up, run%listing, solution)
    if (mesh_is_due(solution)) then
      if (on_probation) call pass_probation(scene, run%stem, run%listing, solution, error)
      if (.not. allocated(error)) call save_all(scene, solution, run, error)
    else if (give_up) then
      ! resumed, it ends the same way
      solution%next_step = dt
      call stop_here(scene, solution, dt, outcome, unheld, run, error)
      if (on_probation) call refuse_mesh(scene, solution, outcome, run, error)
    end if
  end subroutine answer_failure

  !> The step is tried again with more damping than before, where a die withdraws, or past a limit point.
  subroutine damp(scene, dt, on_probation, outcome, solution, run)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt   !! of the step that failed [time]
    logical, intent(in) :: on_probation
    type(outcome_t), intent(in) :: outcome
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    logical :: past_limit, withdraws
    integer :: die

    if (solution%damping > 0) then
      call strengthen_damping(solution)
      return
    end if
    ! in the first step a part may begin deep in its dies, and nothing has been found yet that it could snap from; on a new mesh the
    ! fault may be the mesh's
    past_limit = solution%last_step > 0 .and. .not. on_probation .and. any(outcome%history%past_limit)
    call begin_damping(scene, run%equations, solution, dt, past_limit, die, withdraws)
    if (die == 0) return
    run%damped_from = solution%step + 1
    call list_note(run%listing, 'note: step '//to_text(solution%step + 1)//': '//scene%dies(die)%name &
                   //trim(merge(' withdraws, and               ', ' moves past a limit point, and', withdraws))//' no ' &
                   //'equilibrium is near: what it held is let go suddenly; steps are damped until there is one')
  end subroutine damp

  !> A step was accepted, and damping has ended with it.
  subroutine note_damped_steps(solution, run)
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run

    if (run%damped_from == 0 .or. solution%damping > 0) return
    call list_note(run%listing, 'note: steps '//to_text(run%damped_from)//' to '//to_text(solution%step) &
                   //' were damped: forces of dies and supports have viscous ones in them there')
    run%damped_from = 0
  end subroutine note_damped_steps

  !> Equations, the scene at rest, and files. A mesh that is refused has touched none of the results.
  subroutine start(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    logical :: new_mesh

    new_mesh = solution%unbalanced
    call set_up(scene, run%equations, error)
    if (.not. allocated(error)) call require_memory(8*sum(run%equations%solves%solver%estimated_entries), &
      'the factors of the matrix', error, address_space=run%equations%team%most*blas_buffer)
    if (allocated(error)) return
    call start_drivers(scene, run%equations%laws, solution, run%equations%drivers)
    call measure_scene(scene, run%equations, solution, run%totals)
    if (scene%remesh%estimate) call set_up_estimator(scene, run%equations%laws, run%estimator)
    if (.not. run%estimator%elastic) call list_note(run%listing, 'note: a law has no elastic moduli, so error_stress is in the ' &
                                                    //'norm of the deviator, not of the energy')
    if (.not. solution%initial_volume > 0) solution%initial_volume = run%totals%volume
    if (new_mesh .and. .not. run%begins_operation) then
      call balance_new_mesh(scene, solution, run, error)
    else if (new_mesh) then
      call release_part(scene, solution, run, error)
    end if
    if (allocated(error)) return
    if (new_mesh) call list_lines(run%listing, lines_of_cuts(scene, solution, scene%generation))
    call start_stored(run%totals, solution)
    call open_history(scene, solution, join_path(run%folder, 'history.csv'), run%resume, run%columns, run%table, error)
    if (allocated(error)) return
    call open_results(scene, solution, run%stem, merge(solution%step, -1, run%resume), new_mesh, run%results, error)
    if (allocated(error)) return
    if (allocated(run%results%note)) call list_note(run%listing, run%results%note)
    call ask_for_trims(scene, run%listing, solution)
    if (new_mesh .or. mesh_is_due(solution)) then
      call save_all(scene, solution, run, error)
    else if (.not. run%resume) then
      call save_fields(scene, solution, run%results, error)
    end if
  end subroutine start

  !> An operation begins: what the dies of the one before and its supports carried is taken off the part, at fixed time. What this
  !> changes of the elastic energy is told apart, as on a new mesh.
  subroutine release_part(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(balance_t) :: balance
    type(outcome_t) :: outcome

    solution%friction_apart = solution%friction_work - run%totals%friction_work
    run%totals%friction_work = solution%friction_work
    solution%unbalanced = .false.
    if (.not. scene%fields(displacement_field)%declared) return
    balance%before = run%totals
    call restore_equilibrium(scene, run%equations, solution, balance, outcome)
    if (allocated(outcome%error)) then
      call move_alloc(outcome%error, error)
      return
    end if
    call list_balance(run%listing, scene, solution, balance, outcome)
    if (.not. balance%restored) then
      call fail(error, exit_no_convergence, 'operation '//scene%operation_name//': the part, released from the operation before, ' &
                //'finds no equilibrium at time '//to_text(solution%time)//': '//balance%reason, &
                'hold it by supports (FIXED) or by a die that it lies on, or lift the dies at the end of the operation before')
      return
    end if
    run%totals = balance%after
    call estimate_stress(scene, run%estimator, solution)
  end subroutine release_part

  !> Equilibrium on a new mesh, judged; later steps begin from it.
  subroutine balance_new_mesh(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    type(outcome_t) :: outcome

    allocate (run%balance)
    ! friction work that the new points of contact do not hold is kept apart
    solution%friction_apart = solution%friction_work - run%totals%friction_work
    run%totals%friction_work = solution%friction_work
    run%balance%before = run%totals
    if (.not. scene%fields(displacement_field)%declared) then
      call keep_balance(scene, solution, run%balance)
      call write_restart(run%stem//'.g'//two_digits(scene%generation)//'.restart.json', scene, solution, run%balance, error)
      return
    end if
    call restore_equilibrium(scene, run%equations, solution, run%balance, outcome)
    if (allocated(outcome%error)) then
      call move_alloc(outcome%error, error)
      return
    end if
    run%totals = run%balance%after
    call list_balance(run%listing, scene, solution, run%balance, outcome)
    call list_lines(run%listing, limit_lines(scene, run%balance))
    call refuse_remesh(scene, solution, run%force_agreed, run%balance, error)
    run%mesh_refused = run%balance%refused
    if (.not. run%mesh_refused) call begin_probation(solution%probation)
    if (run%balance%restored) call estimate_stress(scene, run%estimator, solution)
    solution%estimate%first_stress = solution%estimate%stress
    call write_restart(run%stem//'.g'//two_digits(scene%generation)//'.restart.json', scene, solution, run%balance, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
  end subroutine balance_new_mesh

  !> A step on probation was accepted: the mesh may be refused by it, or the probation may end.
  subroutine judge_steps(scene, solution, outcome, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(outcome_t), intent(in) :: outcome
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error

    if (is_too_short(scene, solution)) then
      call refuse_mesh(scene, solution, outcome, run, error)
    else if (.not. is_on_probation(solution%probation) .or. mesh_is_due(solution) .or. at_end(scene, solution)) then
      call pass_probation(scene, run%stem, run%listing, solution, error)
    end if
  end subroutine judge_steps

  !> The mesh is refused after all; an error that is there already is the reason why the run cannot go on.
  subroutine refuse_mesh(scene, solution, outcome, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(inout) :: error

    run%mesh_refused = .true.
    call refuse_after_all(scene, run%equations, solution, outcome, run%stem, error)
  end subroutine refuse_mesh

  !> A note, once, when an element has moved in a way that its points, or its pressure, do not see.
  subroutine report_spurious_mode(scene, solution, run)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    character(len=:), allocatable :: motion

    if (run%spurious_reported .or. .not. solution%worst_spurious > spurious_limit) return
    ! an element of an earlier mesh was reported there
    if (solution%spurious_element == 0) return
    run%spurious_reported = .true.
    associate (group => scene%groups(solution%spurious_group), percent => to_text(100*solution%worst_spurious, 3)//' %')
      motion = 'moves in the way that 4 integration points do not see ('//percent//' of its strain); ' &
               //'PL8LS with 9 points and MEAN has no such motion'
      if (has_mean_dilatation(group)) then
        motion = 'changes its volume in a way that the pressure of MEAN does not see (spurious_mode '//percent//'); ' &
                 //'compare with 4 points, or a finer mesh'
      end if
      call list_note(run%listing, 'note: step '//to_text(solution%step)//': element '//to_text(solution%spurious_element)//' of ' &
                     //group%name//' '//motion)
    end associate
  end subroutine report_spurious_mode

end module march
