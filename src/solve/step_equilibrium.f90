!> The equilibrium at the end of a step: attempts at it by Newton's method (newton), each in another manner, until one is found that
!> may be taken.
module step_equilibrium
  use equations, only: equations_t
  use iteration_history, only: iteration_t
  use kinds, only: wp
  use newton, only: find_equilibrium
  use scene, only: scene_t
  use soft_contact, only: begin_softly, end_softly
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use step_strategy, only: is_shortest
  implicit none
  private
  public :: solve_step

contains

  !> Find the equilibrium of the present solve at the end of a step of length dt. With a load factor corrections are taken whole, as
  !> those of a slender part must be; where that leads nowhere, so much of them that the residual stays below a ceiling. An
  !> equilibrium that is not stable is left: the forces say to which side, by corrections that lead downhill alone. A perfect part
  !> stays where it is, and in the shortest step nothing else may be found: the equilibrium that is not stable is taken then, and in
  !> later steps until they are stable again. A step that fails leaves the committed state as it was.
  subroutine solve_step(scene, equations, solution, dt, outcome, left, given, go_on)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: left(:)    !! (ndof) part of the residual to be left, 0 where absent [residual]
    real(wp), intent(in), optional :: given(:)   !! (ndof) motion of other solves' unknowns; of all with go_on [unknown]
    logical, intent(in), optional :: go_on       !! from `given` for the own unknowns too
    type(iteration_t), allocatable :: history(:)

    call begin_softly(scene, dt, equations)
    equations%takes_unstable = solution%stays_unstable
    call find_equilibrium(scene, equations, solution, dt, outcome, left, given, go_on)
    if (scene%load_factor%multiplier > 0 .and. .not. (outcome%converged .or. outcome%event < 1 .or. allocated(outcome%error))) then
      history = outcome%history
      equations%below_ceiling = .true.
      call find_equilibrium(scene, equations, solution, dt, outcome, left, given, go_on)
      equations%below_ceiling = .false.
      outcome%history = [history, outcome%history]
      outcome%iterations = size(outcome%history) - 1
    end if
    if (outcome%unstable > 0 .and. .not. equations%takes_unstable) then
      history = outcome%history
      equations%downhill = .true.
      call find_equilibrium(scene, equations, solution, dt, outcome, left, given, go_on)
      equations%downhill = .false.
      history = [history, outcome%history]
      if (.not. allocated(outcome%error) .and. &
          (outcome%converged .and. outcome%unstable > 0 .or. .not. outcome%converged .and. is_shortest(scene, dt))) then
        equations%takes_unstable = .true.
        call find_equilibrium(scene, equations, solution, dt, outcome, left, given, go_on)
        history = [history, outcome%history]
      end if
      outcome%left_unstable = .not. equations%takes_unstable
      outcome%history = history
      outcome%iterations = size(history) - 1
    end if
    outcome%stays_unstable = equations%takes_unstable .and. outcome%unstable > 0
    call end_softly(outcome%converged, outcome%history, equations)
  end subroutine solve_step

end module step_equilibrium
