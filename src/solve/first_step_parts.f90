!> The first step on a new mesh in parts, where it is not found at once.
!>
!> Stresses that were carried balance elastically (restore_balance), but some are outside the yield surface: their return leaves a
!> residual that is there however short the step. Where it moves the part far, as beside a gap that closes, which the old mesh was
!> too coarse to close, Newton's method may not find the way at once, and shorter steps have the same way to go. So a share of that
!> residual is left as an external force, and taken back part by part (residual_parts), each from the motion of the one before.
module first_step_parts
  use acceptance, only: is_first_step
  use elem_api, only: block_done, report_t
  use equations, only: equations_t
  use evaluation, only: evaluate
  use external_loads, only: external_forces
  use fields, only: displacement_field
  use kinds, only: wp
  use residual_parts, only: first_parts, next_part, residual_parts_t
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  use step_equilibrium, only: solve_step
  use step_outcome, only: outcome_t
  use text, only: to_text
  implicit none
  private
  public :: solve_motion

  !> The first part of the residual that is taken back, and the smallest.
  real(wp), parameter :: first_part = 0.25_wp, smallest_part = 1.0_wp/32

contains

  !> Equilibrium of the present solve, as solve_step finds it, in the first step on a new mesh also in parts.
  subroutine solve_motion(scene, equations, solution, dt, outcome, given, go_on)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: given(:)   !! (ndof) motion of other solves' unknowns; of all with go_on [unknown]
    logical, intent(in), optional :: go_on       !! from `given` for the own unknowns too

    call solve_step(scene, equations, solution, dt, outcome, given=given, go_on=go_on)
    if (outcome%converged .or. outcome%event < 1 .or. allocated(outcome%error)) return
    if (.not. (is_first_step(solution%probation) .and. equations%solves(equations%now)%own(displacement_field))) return
    if (scene%load_factor%multiplier > 0) return
    call solve_in_parts(scene, equations, solution, dt, outcome, given)
  end subroutine solve_motion

  !> Leave a share of the residual, and take it back. The outcome is that of the last part, with the iterations of all; where a
  !> part fails at the smallest size, states are as they were.
  subroutine solve_in_parts(scene, equations, solution, dt, outcome, given)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome        !! of the step at once
    real(wp), intent(in), optional :: given(:)       !! (ndof) motion of other solves' unknowns [unknown]
    type(outcome_t) :: one
    type(group_state_t) :: before(size(solution%groups))
    real(wp), dimension(equations%dofs%ndof) :: rest, motion
    type(residual_parts_t) :: parts
    real(wp) :: strain
    logical :: found
    integer :: g, iterations

    motion = 0
    if (present(given)) motion = merge(0.0_wp, given, equations%solves(equations%now)%is_own)
    call residual_of_rest(scene, equations, solution, dt, motion, rest, found)
    if (.not. found) return
    do g = 1, size(before)
      before(g)%committed = solution%groups(g)%committed
    end do
    iterations = outcome%iterations
    parts = first_parts(first_part, smallest_part)
    strain = 0
    found = .false.
    do while (parts%goes_on)
      call solve_step(scene, equations, solution, dt, one, (parts%left - parts%part)*rest, motion, found)
      iterations = iterations + one%iterations
      if (allocated(one%error)) exit
      if (one%converged .and. one%strain - strain > scene%strategy%strain_bound) then
        one%converged = .false.
        one%reason = 'strain increment '//to_text(one%strain - strain, 3)//' of a part above ' &
                     //to_text(scene%strategy%strain_bound, 3)
      end if
      if (one%converged) then
        strain = one%strain
        motion = one%du
        found = .true.
      end if
      call next_part(parts, one%converged)
    end do
    if (parts%left > 0) then
      do g = 1, size(before)
        solution%groups(g)%committed = before(g)%committed
      end do
    end if
    one%history = [outcome%history, one%history]
    outcome = one
    outcome%parts = parts%number
    outcome%iterations = iterations
    outcome%first_iterations = iterations
  end subroutine solve_in_parts

  !> What is not balanced where nothing moves.
  subroutine residual_of_rest(scene, equations, solution, dt, motion, rest, found)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt          !! [time]
    real(wp), intent(in) :: motion(:)   !! (ndof) of other solves' unknowns [unknown]
    real(wp), intent(out) :: rest(:)    !! (ndof) [residual]
    logical, intent(out) :: found       !! there is such a state, and a residual
    type(report_t) :: report

    call external_forces(scene, equations%dofs, solution%time + dt, rest)
    call evaluate(scene, equations, solution, dt, motion, .false., report)
    found = report%status == block_done
    rest = rest - equations%force
    where (equations%solves(equations%now)%equation == 0) rest = 0
    found = found .and. any(abs(rest) > 0)
  end subroutine residual_of_rest

end module first_step_parts
