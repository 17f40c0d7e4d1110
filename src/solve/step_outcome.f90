!> What an attempt at a step has come to: its motion and how it was found, or why it has failed.
module step_outcome
  use elem_api, only: block_inverted, block_without_source, report_t
  use errors, only: error_t, exit_no_convergence
  use heat_record, only: heat_step_t
  use iteration_history, only: iteration_t
  use kinds, only: wp
  use path_record, only: path_step_t
  use shape_record, only: shape_errors_t
  implicit none
  private
  public :: outcome_t, set_cause, set_solver_cause

  type :: outcome_t
    logical :: converged = .false.
    !> Why the step must be cut back, when it has not converged; and the element that failed, when there is one.
    character(len=:), allocatable :: reason
    integer :: group = 0, element = 0
    !> Iterations in all, and those before the first augmentation: the difficulty of the step.
    integer :: iterations = 0, first_iterations = 0
    !> What iterations on the unknowns of patches add to the latter.
    real(wp) :: patch_difficulty = 0.0_wp
    !> It was found in so many parts (first_step_parts).
    integer :: parts = 1
    type(iteration_t), allocatable :: history(:)
    !> The step should be no longer than this share of it; why.
    real(wp) :: event = 1.0_wp
    character(len=:), allocatable :: event_reason
    !> The solve that failed is one of heat alone.
    logical :: of_heat = .false.
    !> The equilibrium found has a body that passes through itself, one of the group of elements `crossing_group`.
    logical :: passes_itself = .false.
    integer :: crossing_group = 0
    character(len=:), allocatable :: crossing_place
    !> It has thinned to nothing where it does.
    logical :: thins_out = .false.
    !> Share of the heat through contact that is another by the contact that it leads to, where turns of the solves do not agree on
    !> it (step_solves).
    real(wp) :: contact_lag = 0.0_wp
    !> Balance of heat in time.
    type(heat_step_t) :: heat
    !> Path within the step.
    type(path_step_t) :: path
    !> Error in space of the shape, of the last step of a run.
    type(shape_errors_t) :: shape
    !> Motion of every unknown (ndof).
    real(wp), allocatable :: du(:)
    !> Residual force of every unknown where a failed step stopped (ndof).
    real(wp), allocatable :: residual(:)
    !> Largest strain increment, worst residual of the linear solves.
    real(wp) :: strain = 0.0_wp, linear_residual = 0.0_wp
    !> Multipliers of contact were carried forward so many times.
    integer :: augmentations = 0
    !> A further augmentation had no equilibrium: the one before it was kept.
    logical :: gave_way = .false.
    !> Eigenvalues below 0 of the matrix at the equilibrium: it is not stable. One found before it was not.
    integer :: unstable = 0
    logical :: left_unstable = .false.
    !> The last word on it: no stable one was found in the shortest step.
    logical :: stays_unstable = .false.
    !> The machine failed, not the step.
    type(error_t), allocatable :: error
  end type outcome_t

contains

  !> Cause of a failed step: the element, and what failed in it.
  pure subroutine set_cause(report, outcome)
    type(report_t), intent(in) :: report
    type(outcome_t), intent(inout) :: outcome

    if (report%status == block_inverted) then
      outcome%reason = 'an element turned inside out'
    else if (report%status == block_without_source) then
      outcome%reason = 'the torch of GOLDAK is off its bodies while it has power: end its power (LIC) or its path there'
    else
      outcome%reason = 'a law did not converge'
    end if
    outcome%group = report%group
    outcome%element = report%element
  end subroutine set_cause

  !> A matrix that the solver cannot factorise cuts the step back; a failure of the machine does not.
  subroutine set_solver_cause(outcome)
    type(outcome_t), intent(inout) :: outcome

    if (outcome%error%code /= exit_no_convergence) return
    outcome%reason = outcome%error%message
    deallocate (outcome%error)
  end subroutine set_solver_cause

end module step_outcome
