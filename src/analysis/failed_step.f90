!> What is done about a step that has failed: a shorter one, damping, a new mesh, or the end of the run.
module failed_step
  use acceptance, only: is_on_probation, note_cutback
  use damping, only: begin_damping, strengthen_damping
  use errors, only: error_t
  use folding_bodies, only: law_of_folds
  use kinds, only: wp
  use listing, only: list_cutback, list_note, list_softer_contact
  use probation, only: is_too_short, pass_probation, refuse_after_all
  use run_record, only: run_t, save_all
  use run_stop, only: stop_here
  use scene, only: scene_t
  use soft_penalties, only: soften_penalties
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use step_strategy, only: after_failure
  use text, only: to_text
  use unheld_dies, only: find_unheld_die, unheld_die_t
  use watch_mesh, only: answer_distress, mesh_is_due
  implicit none
  private
  public :: answer_failure, note_damped_steps, refuse_mesh

  !> So many cutbacks in a row are not answered by damping; damped, a step of the least length is tried until there were so many.
  integer, parameter :: most_cutbacks_undamped = 2, most_cutbacks_damped = 12
  !> So many cutbacks in a row show that a body passes through itself in steps of any length.
  integer, parameter :: most_cutbacks_for_crossing = 3

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
    logical :: give_up, on_probation, softer

    ! in the first of steps that are cut back the sides are far enough apart to tell whether the body is between them
    if (cutbacks == 0) then
      run%thins_out = outcome%thins_out
      run%crossings = 0
    end if
    run%crossings = merge(run%crossings + 1, 0, outcome%passes_itself)
    if (run%crossings == 1) run%crossed_from = dt
    on_probation = is_on_probation(solution%probation)
    unheld = find_unheld_die(scene, run%equations, solution, index(outcome%reason, 'singular') > 0)
    solution%cutbacks = solution%cutbacks + 1
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
    ! that sides meet says nothing of the mesh
    if (.not. outcome%passes_itself) call note_cutback(solution%probation, solution%next_step)
    if (on_probation .and. is_too_short(scene, solution)) then
      call refuse_mesh(scene, solution, outcome, run, error)
      return
    end if
    call answer_distress(scene, merge(0, cutbacks, solution%damping > 0), give_up, run%listing, solution)
    if (mesh_is_due(solution)) then
      if (on_probation) call pass_probation(scene, run%stem, run%listing, solution, error)
      if (.not. allocated(error)) call save_all(scene, solution, run, error)
    else if (give_up .and. sides_have_met(scene, outcome, run)) then
      run%folding = outcome%crossing_group
      run%folds = scene%groups(outcome%crossing_group)%name//' passes through itself'//outcome%crossing_place
      ! it was no fault of the length
      solution%next_step = run%crossed_from
    else if (give_up) then
      ! resumed, it ends the same way
      solution%next_step = dt
      call stop_here(scene, solution, dt, outcome, unheld, run, error)
      if (on_probation) call refuse_mesh(scene, solution, outcome, run, error)
    end if
  end subroutine answer_failure

  !> A body passes through itself in one attempt after the other, and its sides can have contact with one another.
  pure function sides_have_met(scene, outcome, run) result(yes)
    type(scene_t), intent(in) :: scene
    type(outcome_t), intent(in) :: outcome
    type(run_t), intent(in) :: run
    logical :: yes

    yes = run%crossings > most_cutbacks_for_crossing .and. .not. (run%thins_out .or. outcome%thins_out)
    if (yes) yes = law_of_folds(scene, run%equations%laws, outcome%crossing_group) > 0
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
    call list_note(run%listing, 'note: step '//to_text(solution%step + 1)//': '//name &
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
