!> What is done about a step that has failed: a shorter one, damping, a new mesh, or the end of the run.
module failed_step
  use acceptance, only: forget_cutbacks, is_on_probation, note_cutback
  use crossing_record, only: crossing_record_t
  use damping, only: begin_damping, strengthen_damping
  use errors, only: error_t
  use folding_bodies, only: law_of_folds
  use kinds, only: wp
  use law_api, only: law_t
  use listing, only: list_cutback, list_note, list_softer_contact
  use probation, only: is_too_short, pass_probation, refuse_after_all
  use run_record, only: run_t, save_all
  use run_stop, only: stop_here
  use scene, only: scene_t
  use soft_penalties, only: soften_penalties
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use step_pace, only: note_failed_attempt
  use step_strategy, only: after_failure
  use text, only: to_text
  use unheld_dies, only: find_unheld_die, unheld_die_t
  use watch_mesh, only: answer_distress, mesh_is_due
  implicit none
  private
  public :: answer_failure, answer_long_path, note_damped_steps, refuse_mesh

  !> So many cutbacks in a row are not answered by damping; damped, a step of the least length is tried until there were so many.
  integer, parameter :: most_cutbacks_undamped = 2, most_cutbacks_damped = 12
  !> So many cutbacks in a row show that a body passes through itself in steps of any length. Its sides have met where it does so
  !> in a step that is this much shorter than the first one that did, before the end of that one.
  integer, parameter :: most_cutbacks_for_crossing = 3
  real(wp), parameter :: much_shorter = 0.5_wp**most_cutbacks_for_crossing

contains

  !> A step has failed: it is cut back, a new mesh is asked for, the mesh is refused, sides of a body that have met are to have
  !> contact, or the run cannot go on.
  subroutine answer_failure(scene, dt, outcome, cutbacks, solution, run, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt   !! of the step [time]
    type(outcome_t), intent(in) :: outcome
    integer, intent(inout) :: cutbacks   !! one after the other
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(unheld_die_t) :: unheld
    logical :: give_up, on_probation, softer, folds

    ! in the first of steps that do so the sides are far enough apart to tell whether the body is between them
    if (outcome%passes_itself .and. .not. solution%time < solution%crossing%until) &
      solution%crossing = crossing_record_t(dt, solution%time + dt, outcome%thins_out, solution%crossing%remeshed)
    on_probation = is_on_probation(solution%probation)
    unheld = find_unheld_die(scene, run%equations, solution, index(outcome%reason, 'singular') > 0)
    solution%cutbacks = solution%cutbacks + 1
    call note_failed_attempt(outcome%iterations, solution%pace)
    call after_failure(scene, dt, solution%next_step, give_up)
    softer = .false.
    if (.not. (outcome%of_heat .or. outcome%passes_itself)) &
      call soften_penalties(scene, outcome%history, solution, softer)
    ! the step may be found as it is
    if (softer .and. cutbacks == 0) solution%next_step = dt
    call list_cutback(run%listing, scene, solution, dt, solution%next_step, outcome)
    if (softer) call list_softer_contact(run%listing, solution)
    cutbacks = cutbacks + 1
    if (softer .and. cutbacks == 1) return
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
    folds = sides_have_met(scene, run%equations%laws, dt, outcome, solution%crossing)
    give_up = give_up .or. folds
    call note_cutback(solution%probation, solution%next_step)
    ! another mesh has the same sides
    if (on_probation .and. is_too_short(scene, solution) .and. .not. folds) then
      call refuse_mesh(scene, solution, outcome, run, error)
      return
    end if
    ! the mesh was made as sides met on the one before, and has the same sides: as a hole closes, more of them meet on each mesh
    if (.not. (folds .and. solution%crossing%remeshed)) &
      call answer_distress(scene, merge(0, cutbacks, solution%damping > 0), give_up, outcome%passes_itself, run%listing, solution)
    if (mesh_is_due(solution)) then
      solution%crossing%remeshed = outcome%passes_itself
      if (on_probation) call pass_probation(scene, run%stem, run%listing, solution, error)
      if (.not. allocated(error)) call save_all(scene, solution, run, error)
    else if (folds) then
      ! lengths of steps that passed through say nothing of those with contact, nor of the mesh
      solution%next_step = solution%crossing%length
      solution%crossing = crossing_record_t()
      call forget_cutbacks(solution%probation)
      run%folding = outcome%crossing_group
      run%folds = scene%groups(outcome%crossing_group)%name//' passes through itself'//outcome%crossing_place
    else if (give_up) then
      ! resumed, it ends the same way
      solution%next_step = dt
      call stop_here(scene, solution, dt, outcome, unheld, run, error)
      if (on_probation) call refuse_mesh(scene, solution, outcome, run, error)
    end if
  end subroutine answer_failure

  !> A body passes through itself in steps much shorter than the first that did, and its sides can have contact with one another.
  pure function sides_have_met(scene, laws, dt, outcome, crossing) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    real(wp), intent(in) :: dt   !! of the step that has failed [time]
    type(outcome_t), intent(in) :: outcome
    type(crossing_record_t), intent(in) :: crossing
    logical :: yes

    yes = outcome%passes_itself .and. .not. (crossing%thinned .or. outcome%thins_out) .and. dt <= much_shorter*crossing%length
    if (yes) yes = law_of_folds(scene, laws, outcome%crossing_group) > 0
  end function sides_have_met

  !> The step is tried again with more damping than before, where a die withdraws, or past a limit point.
  subroutine damp(scene, dt, on_probation, outcome, solution, run)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt   !! of the step that failed [time]
    logical, intent(in) :: on_probation
    type(outcome_t), intent(in) :: outcome
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    logical :: past_limit, withdraws
    character(len=:), allocatable :: name
    integer :: die

    if (solution%damping > 0) then
      call strengthen_damping(solution)
      return
    end if
    ! in the first step a part may begin deep in its dies, and nothing has been found yet that it could snap from; on a new mesh the
    ! fault may be the mesh's
    past_limit = solution%last_step > 0 .and. .not. on_probation .and. any(outcome%history%past_limit)
    call begin_damping(scene, run%equations, solution, dt, past_limit, die, withdraws, name)
    if (name == '') return
    run%damped_from = solution%step + 1
    ! what a die that withdraws has held is let go, however short the step
    if (withdraws) run%undamped_again = run%damped_from
    call list_note(run%listing, 'note: step '//to_text(solution%step + 1)//': '//name &
                   //trim(merge(' withdraws, and               ', ' moves past a limit point, and', withdraws))//' no ' &
                   //'equilibrium is near: what it held is let go suddenly; steps are damped until there is one')
  end subroutine damp

  !> A damped step goes further than its path can be followed, and is tried again shorter: with more damping. Where damping began
  !> with this step, past a limit point of a die that goes on, those that had failed were longer than the one to come, which may
  !> have an equilibrium near: that is tried without damping first, once. (A hot billet with a chilled skin, pressed in steps that
  !> are far too long, would buckle off its die.)
  subroutine answer_long_path(solution, run)
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run

    if (solution%damping > 0 .and. run%damped_from == solution%step + 1 .and. .not. run%undamped_again == run%damped_from) then
      solution%damping = 0
      run%undamped_again = run%damped_from
      run%damped_from = 0
      call list_note(run%listing, 'note: step '//to_text(run%undamped_again)//', now shorter, is tried without damping first')
    else
      call strengthen_damping(solution)
    end if
  end subroutine answer_long_path

  !> A step was accepted, and damping has ended with it.
  subroutine note_damped_steps(solution, run)
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run

    if (run%damped_from == 0 .or. solution%damping > 0) return
    call list_note(run%listing, 'note: steps '//to_text(run%damped_from)//' to '//to_text(solution%step) &
                   //' were damped: forces of dies and supports have viscous ones in them there')
    run%damped_from = 0
  end subroutine note_damped_steps

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

end module failed_step
