!> Newton's method for one step: from a predicted motion, correction by correction, to an equilibrium.
!>
!> A step has converged when the residual force is below `force_norm` of the forces at work, and the
!> correction still to come (the last one times the last fall of the residual) is below
!> `displacement_norm` of the motion of the step.
module newton
  use augmentations, only: augment, augmentations_t, begin_augmentations, go_back, put_back
  use contact_changes, only: contact_set, note_contact, touching_dies
  use contact_heat_tangent, only: couples_contact, follow_contact
  use convergence, only: heat_in_balance, pilots_in_equilibrium, relative_motion, relative_residual, weigh_quantities
  use corrections, only: solve_correction
  use elem_api, only: block_done, report_t
  use equations, only: equations_t
  use equilibrium_check, only: check_equilibrium
  use evaluation, only: evaluate, is_apart
  use exchange_in_turns, only: advance_exchange, begin_exchange, end_exchange, turns_t
  use external_loads, only: external_forces
  use fields, only: displacement_field
  use flow_changes, only: flow_set, note_flow
  use heat_correction, only: follow_content, is_steep
  use iteration_history, only: caught, ceiling_of_residual, difficulty_of_patches, goes_to_and_fro, has_converged, in_circles, &
                               in_turmoil, is_near, iteration_t, judge, was_given_time, went_round
  use kinds, only: wp
  use law_api, only: contact_slip, contact_stick
  use linear_solver, only: return_to_chosen
  use line_search, only: manner_t, search_along
  use nonlinear_elimination, only: take_eliminated
  use onset_motion, only: add_missing
  use predictor, only: lagging_dies, leaving_dies, predict, work_of_dies
  use pseudo_transient, only: ease_shift, goes_past_limits, shift_t, solve_shifted, turn_downhill
  use resting_bodies, only: strengthen_drag
  use scene, only: scene_t
  use soft_contact, only: is_stage_done, stiffen
  use soft_penalties, only: press_too_softly, raise_penalties
  use solution, only: solution_t
  use step_outcome, only: outcome_t, set_cause, set_solver_cause
  implicit none
  private
  public :: find_equilibrium

  !> Conductances of contact follow its pressures and gaps once they change by no more than this, over their slack
  !> (exchange_in_turns), or after so many exchanges.
  real(wp), parameter :: near_change = 5.0e-3_wp
  integer, parameter :: most_exchanges = 12
  !> Points that slip to each that sticks, or more, where hardly anything holds a body in its contacts.
  integer, parameter :: few_stick = 4

contains

  !> One attempt at the equilibrium of the present solve at the end of a step of length dt, in the manner that `equations` state.
  !> One that fails leaves the committed state as it was.
  subroutine find_equilibrium(scene, equations, solution, dt, outcome, left, given, go_on)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: left(:)    !! (ndof) part of the residual to be left, 0 where absent [residual]
    real(wp), intent(in), optional :: given(:)   !! (ndof) motion of other solves' unknowns; of all with go_on [unknown]
    logical, intent(in), optional :: go_on       !! from `given` for the own unknowns too
    !> Forces at the end of the step and what is left of them [residual]; prescribed motion that is still missing, and the last
    !> correction [unknown].
    real(wp), dimension(equations%dofs%ndof) :: external, residual, missing, correction
    type(augmentations_t) :: made
    type(iteration_t) :: line
    type(shift_t) :: shift
    type(report_t) :: report
    !> Status of all points of contact, and what walls hold, as they were.
    integer, allocatable :: contact(:)
    logical, allocatable :: held(:, :)
    !> Points that flow, as they were.
    logical, allocatable :: flows(:)
    !> Of each die: points that touch it, work on its missing motion, it lags behind its motion, it has left the part.
    integer :: touched(size(scene%dies))
    real(wp) :: work(size(scene%dies))
    logical :: lags(size(scene%dies)), left_by(size(scene%dies))
    !> Unknowns that keep their motion where others turn back.
    logical :: staying(equations%dofs%ndof)
    !> The step is begun where an earlier turn ended; from a prediction that keeps contact; from a new one, as dies leave the part.
    logical :: again, kept, afresh
    !> A heat capacity varies much; past a limit point equilibrium is looked for further on.
    logical :: steep, goes_on
    !> Heat through contact is solved for with the motion: its conductances are exchanged first.
    type(turns_t) :: exchange
    logical :: together
    logical :: changed, ends
    !> Line of the history with which the present search began: norms are judged from there on.
    integer :: first

    allocate (outcome%history(0), outcome%du(equations%dofs%ndof))
    call start_motion()
    if (allocated(outcome%error) .or. allocated(outcome%reason) .or. outcome%event < 1) return
    call start_iterations()
    do
      call measure_residual()
      if (is_stage_done(scene, equations, outcome%history(first:)) .and. .not. is_missing_motion()) then
        call stiffen_contact()
        cycle
      end if
      if (together .and. any(equations%drivers%hands_conductance)) then
        if (size(outcome%history) > first .and. is_near(outcome%history(first:))) then
          call exchange_conductances()
          cycle
        end if
      end if
      if (is_in_equilibrium()) then
        if (press_too_softly(scene, equations%dofs, solution, outcome%du)) then
          call press_harder()
          cycle
        end if
        call augment_contact(changed)
        if (.not. changed) exit
        cycle
      end if
      call judge(scene, outcome%history(first:), equations%downhill, outcome%reason)
      ends = .false.
      if (.not. allocated(outcome%reason)) call correct(ends)
      if (ends .or. allocated(outcome%error)) exit
      if (allocated(outcome%reason)) then
        if (made%times == 0) exit
        call start_again()
        if (made%gave_way) exit
      end if
    end do
    call conclude()

  contains

    !> The motion that the step begins with: the prediction, unless contact would begin within it.
    subroutine start_motion()
      integer :: g

      call begin_augmentations(size(scene%groups), made)
      together = .false.
      if (couples_contact(scene, equations) .and. solution%last_step > 0) then
        do g = 1, size(solution%groups)
          solution%groups(g)%trial = solution%groups(g)%committed
        end do
        call begin_exchange(scene, solution, equations, exchange, contact_alone=.true.)
        together = any(equations%drivers%hands_conductance)
      end if
      call return_to_chosen(equations%solves(equations%now)%solver)
      call external_forces(scene, equations%dofs, solution%time + dt, external)
      if (present(left)) external = external - left
      call predict(scene, equations, solution, dt, external, given, go_on, outcome%du, missing, kept, staying, report, &
                   outcome%error)
      if (allocated(outcome%error)) return
      if (report%status /= block_done) then
        call set_cause(report, outcome)
        return
      end if
      if (dt > scene%strategy%least_step) then
        outcome%event = report%event
        ! the motion of a prediction that keeps contact goes straight on where that will follow the die
        if (.not. kept) outcome%event = min(outcome%event, report%passed)
      end if
      if (outcome%event < 1) outcome%event_reason = 'contact begins'
    end subroutine start_motion

    !> What the iterations begin with.
    subroutine start_iterations()
      goes_on = goes_past_limits(scene, equations%dofs, solution, dt, outcome%du(equations%dofs%prescribed%dof) &
                                 + missing(equations%dofs%prescribed%dof))
      goes_on = equations%downhill .or. goes_on .and. .not. equations%takes_unstable
      again = .false.
      if (present(go_on)) again = go_on .and. .not. equations%solves(equations%now)%own(displacement_field)
      steep = is_steep(scene, equations)
      first = 1
      correction = 0
      allocate (contact, source=contact_set(scene, solution))
      allocate (flows, source=flow_set(scene, solution))
      held = equations%wall%held
      left_by = .false.
      afresh = .false.
    end subroutine start_iterations

    !> The residual of the motion, and its norms: a line of the history.
    subroutine measure_residual()
      residual = external - equations%force
      if (size(outcome%history) == 0) call weigh_quantities(equations, external, residual)
      line%force_norm = relative_residual(equations, solution%fields, external, residual, outcome%du)
      line%displacement_norm = relative_motion(equations, solution%fields, correction, outcome%du)
      outcome%history = [outcome%history, line]
      outcome%iterations = size(outcome%history) - 1
    end subroutine measure_residual

    !> Prescribed unknowns have not made all of their motion.
    function is_missing_motion() result(is)
      logical :: is

      is = any(abs(missing) > 0)
    end function is_missing_motion

    !> New contact presses with a larger share of its penalties; norms begin anew.
    subroutine stiffen_contact()
      call stiffen(equations)
      first = size(outcome%history) + 1
      correction = 0
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    end subroutine stiffen_contact

    !> Contact presses with a share of its penalties that keeps it from sinking in; norms begin anew.
    subroutine press_harder()
      call raise_penalties(scene, equations%dofs, outcome%du, solution)
      first = size(outcome%history) + 1
      correction = 0
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    end subroutine press_harder

    !> Heat through contact takes what contact has reached; once that hardly changes it follows it. Norms begin anew.
    subroutine exchange_conductances()
      real(wp) :: change

      change = 0
      call advance_exchange(scene, solution, equations, exchange, change)
      if (change < near_change .or. exchange%n >= most_exchanges) call end_exchange(equations, exchange)
      first = size(outcome%history) + 1
      correction = 0
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    end subroutine exchange_conductances

    !> The whole of the motion is made, contact has its whole penalties, and all norms are met.
    function is_in_equilibrium() result(is)
      logical :: is

      is = .not. (is_missing_motion() .or. equations%penalty_share < 1)
      if (.not. is) return
      is = has_converged(scene, outcome%history(first:), again .or. kept .and. (outcome%iterations == 0 .or. afresh)) &
           .and. .not. (kept .and. afresh .and. line%force_norm > 0) &
           .and. pilots_in_equilibrium(equations, solution%fields, external, residual) &
           .and. (heat_in_balance(equations, residual, dt) .or. was_given_time(scene, outcome%history(first:)))
    end function is_in_equilibrium

    !> Multipliers of contact are carried forward from an equilibrium, where they change.
    subroutine augment_contact(changed)
      logical, intent(out) :: changed

      if (made%times == 0) then
        outcome%first_iterations = size(outcome%history) - first
        outcome%patch_difficulty = difficulty_of_patches(outcome%history)
      end if
      call augment(scene, equations, solution, outcome%du, made, changed)
      if (.not. changed) return
      first = size(outcome%history) + 1
      correction = 0
      call evaluate_multipliers()
    end subroutine augment_contact

    !> One correction of the motion. Where none is found `outcome` holds the reason; where there cannot be any, the attempt ends.
    subroutine correct(ends)
      logical, intent(out) :: ends
      logical :: followed, taken
      type(manner_t) :: manner

      ends = .false.
      if (together .or. is_near(outcome%history(first:))) call follow_contact(scene, equations, solution, dt, outcome%du)
      call add_missing(equations, missing, residual)
      call solve_for_correction()
      if (allocated(outcome%error)) then
        call set_solver_cause(outcome)
        return
      end if
      outcome%linear_residual = max(outcome%linear_residual, equations%solves(equations%now)%solver%residual)
      call follow_content(scene, equations, solution, outcome%du, correction, followed)
      manner = manner_of_search(followed)
      afresh = .false.
      if (followed .and. in_circles(outcome%history(first:))) correction = 0.5_wp*correction
      if (is_missing_motion()) then
        ! a missing motion is taken without search, by what it moves alone
        where (staying) correction = 0
        touched = touching_dies(scene, solution)
        work = work_of_dies(equations, missing)
        lags = lagging_dies(equations, missing)
      end if
      call take_without_search(taken, ends)
      if (ends .or. allocated(outcome%error)) return
      if (taken) then
        line%line_search = 1
      else
        ! between the two states contact may be as in neither
        if (goes_to_and_fro(outcome%history(first:))) correction = 0.5_wp*correction
        call search_along(scene, equations, solution, dt, external, residual, missing, correction, manner, outcome%du, &
                          line%line_search, report)
      end if
      if (is_missing_motion()) call follow_dies()
      if (allocated(outcome%error)) return
      if (.not. line%line_search > 0) then
        call set_cause(report, outcome)
        return
      end if
      line%closely = manner%closely .and. .not. taken
      line%watched = caught(outcome%history(first:)) .and. manner%whole .or. equations%let_go
      call note_contact(scene, solution, contact, line%contact_changed)
      call note_flow(scene, solution, flows, line%flow_changed)
      line%contact_changed = line%contact_changed .or. followed .or. steep .or. any(held .neqv. equations%wall%held)
      held = equations%wall%held
      correction = line%line_search*correction
    end subroutine correct

    !> How the correction is searched along.
    function manner_of_search(followed) result(manner)
      logical, intent(in) :: followed   !! the correction follows the heat content
      type(manner_t) :: manner
      logical :: long

      long = relative_motion(equations, solution%fields, correction, outcome%du) >= 1
      manner = manner_t(whole=caught(outcome%history(first:)) .and. .not. shift%value > 0 .and. .not. long, &
                        closely=in_turmoil(outcome%history(first:)) .or. went_round(outcome%history(first:)))
      ! a body that contact alone holds slips at nearly all of its points
      manner%many = size(equations%loose) > 0 .and. few_stick*count(contact == contact_stick) <= count(contact == contact_slip)
      if (long .and. manner%many .and. solution%last_step > 0) manner%closely = .true.
      if (steep) manner = manner_t(exactly=.true.)
      if (equations%downhill) manner = manner_t(downhill=.true.)
      if (equations%below_ceiling) manner%ceiling = ceiling_of_residual(outcome%history(first:), norm2(outcome%du) > 0)
      ! forces with contact kept are no measure of those without; past a limit point the way to equilibrium leads up and down
      if (kept .and. afresh .or. followed .or. equations%let_go) manner%whole = .true.
      if (scene%load_factor%multiplier > 0) manner%whole = .not. equations%below_ceiling
    end function manner_of_search

    !> A correction with a patch eliminated, or one past a limit point by which the residual falls by half, is taken without a
    !> search. Past a limit point any other becomes one that leads downhill; where its matrix has no factors the attempt ends.
    subroutine take_without_search(taken, ends)
      logical, intent(out) :: taken, ends

      ends = .false.
      taken = .false.
      line%inner = 0
      if (.not. (is_missing_motion() .or. shift%value > 0 .or. equations%penalty_share < 1 &
            .or. equations%downhill)) &
        call take_eliminated(scene, equations, solution, dt, external, residual, outcome%iterations, correction, outcome%du, &
                             line%inner, report, outcome%error)
      if (allocated(outcome%error)) return
      taken = line%inner > 0
      line%past_limit = shift%uphill .and. .not. taken
      if (line%past_limit .and. goes_on) &
        call turn_downhill(scene, equations, solution, dt, external, residual, shift, correction, outcome%du, taken, report, &
                           outcome%error)
      if (allocated(outcome%error)) then
        call set_solver_cause(outcome)
        ends = .true.
        return
      end if
      line%past_limit = line%past_limit .and. .not. taken .or. shift%value > 0
    end subroutine take_without_search

    !> The correction of the residual. A missing motion is given, and past a limit point of a load factor the way leads up and down.
    subroutine solve_for_correction()
      integer :: n

      n = size(outcome%history)
      shift%uphill = .false.
      if (any(abs(missing) > 0) .or. scene%load_factor%multiplier > 0 &
          .or. .not. equations%solves(equations%now)%own(displacement_field)) then
        call solve_correction(equations, residual, correction, outcome%error)
        return
      end if
      if (n > first) call ease_shift(outcome%history(n)%line_search, outcome%history(n - 1)%force_norm, line%force_norm, &
                                     equations%downhill, shift)
      call solve_shifted(scene, equations, residual, shift, correction, outcome%error)
    end subroutine solve_for_correction

    !> Multipliers are others, the motion is the same: so is all but contact, whose strains are none.
    subroutine evaluate_multipliers()
      real(wp) :: strain

      strain = report%strain
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report, contact_alone=is_apart(scene, equations))
      report%strain = max(report%strain, strain)
    end subroutine evaluate_multipliers

    !> Where dies leave the part, or it cannot follow those that withdraw: once more, with these dies where they go.
    subroutine follow_dies()
      logical :: leaving(size(touched))
      integer :: now(size(touched))

      now = 0
      if (line%line_search > 0) now = touching_dies(scene, solution)
      missing = 0
      leaving = leaving_dies(lags, work, touched, now) .and. .not. left_by
      if (.not. any(leaving)) return
      left_by = left_by .or. leaving
      call predict(scene, equations, solution, dt, external, given, go_on, outcome%du, missing, kept, staying, report, &
                   outcome%error, left_by)
      if (allocated(outcome%error)) return
      afresh = .true.
      line%line_search = merge(1.0_wp, 0.0_wp, report%status == block_done)
      correction = 0
    end subroutine follow_dies

    !> No equilibrium after an augmentation: from the one before it, which is the result where none is found by shorter ways either.
    subroutine start_again()
      deallocate (outcome%reason)
      outcome%group = 0
      outcome%element = 0
      call go_back(scene, equations, solution, dt, made, outcome%du, report)
      first = size(outcome%history) + 1
      correction = 0
      missing = 0
      line%contact_changed = .false.
      line%flow_changed = .false.
      line%watched = .false.
      contact = contact_set(scene, solution)
      flows = flow_set(scene, solution)
      held = equations%wall%held
    end subroutine start_again

    !> What the attempt has found: an equilibrium, unless the step is too long for it to be taken.
    subroutine conclude()

      if (together) call end_exchange(equations, exchange)
      outcome%augmentations = made%times
      outcome%gave_way = made%gave_way
      outcome%strain = report%strain
      outcome%converged = .not. (allocated(outcome%reason) .or. allocated(outcome%error))
      if (equations%solves(equations%now)%own(displacement_field)) then
        equations%without_patches = .not. outcome%converged .and. (equations%without_patches .or. any(outcome%history%inner > 0))
        call strengthen_drag(.not. outcome%converged, equations)
      end if
      if (outcome%converged) &
        call check_equilibrium(scene, equations, solution, dt, external, report, in_part=present(left), &
                               past_limit=shift%value > 0, outcome=outcome)
      if (outcome%converged) return
      outcome%residual = residual
      call put_back(made, solution)
    end subroutine conclude

  end subroutine find_equilibrium

end module newton
