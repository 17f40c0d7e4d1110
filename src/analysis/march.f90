!> The march in time: the page that reads like the method.
module march
  use accept_step, only: accept
  use acceptance, only: is_on_probation, note_step
  use equations, only: solves_heat
  use errors, only: error_t
  use failed_step, only: answer_failure, answer_long_path, note_damped_steps, refuse_mesh
  use heated_steels, only: note_missing_austenite
  use held_steels, only: note_held_steels
  use kinds, only: wp
  use listing, only: list_event, list_lines, list_note, list_step, show_progress
  use lost_equilibrium, only: refuse_lost_equilibrium
  use march_start, only: start_march
  use path_record, only: note_attempt
  use probation, only: is_too_short, pass_probation
  use run_record, only: run_t, record, at_end
  use run_stop, only: finish
  use scene, only: scene_t
  use small_strain, only: refuse_large_strain
  use solution, only: solution_t
  use spent_polynomials, only: refuse_spent_polynomials
  use spurious_mode, only: has_mean_dilatation, spurious_limit
  use step_outcome, only: outcome_t
  use step_pace, only: note_pace
  use step_solves, only: solve_fields
  use step_strategy, only: after_success, choose_step
  use system, only: caught_signal
  use text, only: string_t, to_text
  use unsettled_contact, only: note_unsettled_contact
  use watch_mesh, only: estimate, look_at_mesh, mesh_is_due
  implicit none
  private
  public :: march_to_end

  !> A step shortened to an event is shortened by at least this much, so that the event is met in a few trials.
  real(wp), parameter :: largest_event = 0.95_wp

contains

  !> March from the instant of the solution to the end of the scene, or to where it must stop.
  subroutine march_to_end(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(outcome_t) :: outcome
    real(wp) :: dt
    integer :: cutbacks

    cutbacks = 0
    call start_march(scene, solution, run, error)
    if (.not. allocated(error)) call refuse_lost_equilibrium(scene, solution, error)
    do while (.not. (allocated(error) .or. mesh_is_due(solution) .or. at_end(scene, solution) .or. run%folding > 0))
      dt = choose_step(scene, solution%time, solution%next_step)
      call solve_to_event(scene, dt, outcome, solution, run)
      if (allocated(outcome%error)) then
        call move_alloc(outcome%error, error)
      else if (outcome%converged) then
        cutbacks = 0
        call take_step(scene, dt, outcome, solution, run, error)
        if (caught_signal() /= 0) exit
      else
        call answer_failure(scene, dt, outcome, cutbacks, solution, run, error)
      end if
    end do
    call finish(scene, solution, run, error)
  end subroutine march_to_end

  !> Solve a step; where something happens within it, as contact that begins, it is shortened to there and solved again.
  subroutine solve_to_event(scene, dt, outcome, solution, run)
    type(scene_t), intent(in) :: scene
    real(wp), intent(inout) :: dt   !! length of the step [time]
    type(outcome_t), intent(out) :: outcome
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run

    call solve_fields(scene, run%equations, solution, dt, outcome)
    do while (outcome%event < 1)
      call note_attempt(outcome%path, dt, solution%path)
      if (outcome%path%too_long) call answer_long_path(solution, run)
      dt = max(min(outcome%event, largest_event)*dt, scene%strategy%least_step)
      call list_event(run%listing, solution, dt, outcome%event_reason)
      if (outcome%heat%too_long) solution%heat%shortened = solution%heat%shortened + 1
      call solve_fields(scene, run%equations, solution, dt, outcome)
    end do
  end subroutine solve_to_event

  !> A step has converged: it is accepted, judged and recorded, and the length of the next one is chosen.
  subroutine take_step(scene, dt, outcome, solution, run, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(string_t) :: note(1)
    real(wp) :: length, growth, factor
    logical :: on_probation

    length = min(solution%next_step, scene%strategy%largest_step)
    on_probation = is_on_probation(solution%probation)
    growth = min(outcome%heat%growth, outcome%path%growth)
    factor = 1
    note(1)%s = ''
    ! longer steps would make errors of temperatures larger
    if (.not. (on_probation .or. solution%damping > 0 .or. scene%load_factor%multiplier > 0 &
               .or. solves_heat(scene, run%equations))) &
      call note_pace(scene%strategy, length, dt, outcome%iterations, growth, solution%pace, factor, note(1)%s)
    solution%next_step = after_success(scene, dt, solution%next_step, outcome%first_iterations, outcome%strain, growth, &
                                       outcome%patch_difficulty, solution%pace%beyond_nopti, factor)
    call accept(scene, run%equations, dt, outcome, solution, run%totals, error)
    if (allocated(error)) return
    call note_missing_austenite(scene, run%equations%laws, solution)
    call note_held_steels(scene, run%equations%laws, solution)
    call note_damped_steps(solution, run)
    call note_step(solution%probation, length)
    call estimate(scene, run%estimator, run%equations%timers, solution)
    call list_step(run%listing, solution, outcome, run%totals)
    if (note(1)%s /= '') call list_lines(run%listing, note)
    ! at the end no new mesh is needed; on one made while viscous forces hold the part these would be out of balance
    if (.not. (at_end(scene, solution) .or. solution%damping > 0)) &
      call look_at_mesh(scene, run%equations%timers, run%listing, solution)
    call report_spurious_mode(scene, solution, run)
    call note_unsettled_contact(scene, solution, outcome, run)
    call show_progress(run%listing, scene, solution, outcome%iterations)
    if (on_probation) call judge_steps(scene, solution, outcome, run, error)
    if (.not. allocated(error)) call record(scene, solution, outcome, run, error)
    if (.not. allocated(error)) call refuse_large_strain(scene, run%equations%laws, solution, error)
    if (.not. allocated(error)) call refuse_spent_polynomials(scene, run%equations%laws, solution, error)
    if (.not. allocated(error)) call refuse_lost_equilibrium(scene, solution, error)
  end subroutine take_step

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
      if (has_mean_dilatation(run%equations%elems(group%elem_id), group)) then
        motion = 'changes its volume in a way that the pressure of MEAN does not see (spurious_mode '//percent//'); ' &
                 //'compare with 4 points, or a finer mesh'
      end if
      call list_note(run%listing, 'note: step '//to_text(solution%step)//': element '//to_text(solution%spurious_element)//' of ' &
                     //group%name//' '//motion)
    end associate
  end subroutine report_spurious_mode

end module march
