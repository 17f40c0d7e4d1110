!> Error of the stress that comes of the errors of temperatures in time, where no law flows: at the end of a run.
!>
!> An elastic stress has no memory: it owes to the temperatures of now alone what they err (heat_error). The laws make the last step
!> to temperatures with a small share of their errors, and a motion balances what they answer. Where a law flows the errors of all
!> steps are carried on (path_stress).
module heat_stress
  use corrections, only: solve_correction
  use equations, only: equations_t, take_turn
  use errors, only: exit_no_convergence
  use fields, only: displacement_field
  use kinds, only: wp
  use path_heat, only: follow_heat, warmth_t
  use path_states, only: advance_beside, begin_beside, has_path, has_stress, root_energy, unbalanced_forces
  use path_stress, only: difference, stress_of
  use scene, only: scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: find_stress_of_heat

  !> The share of the errors along which all is linear.
  real(wp), parameter :: small = 1.0e-3_wp

contains

  !> The error of the stress over the stress, in the norm of elastic energy; none where temperatures have no estimate.
  subroutine find_stress_of_heat(scene, equations, solution, dt, at_hand, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution   !! its trial state is that of the step
    real(wp), intent(in) :: dt        !! [time]
    logical, intent(in) :: at_hand    !! factors of a matrix of this step are
    type(outcome_t), intent(inout) :: outcome
    type(warmth_t) :: warmth
    type(solution_t) :: other
    real(wp), dimension(equations%dofs%ndof) :: motion, residual, answer
    real(wp) :: element_force(size(equations%buffers%force)), stress
    logical :: active(size(scene%groups)), done

    active = has_stress(scene, equations%laws)
    if (any(has_path(scene, equations%laws)) .or. .not. (any(active) .and. outcome%heat%estimated)) return
    call take_turn(equations, displacement_field)
    ! the books want the element forces of the step
    element_force = equations%buffers%force
    call follow_heat(scene, equations, solution, active, small, outcome, warmth)
    if (warmth%any) call compare()
    equations%buffers%force = element_force
    if (.not. allocated(outcome%error)) return
    ! there is no estimate then
    if (outcome%error%code == exit_no_convergence) deallocate (outcome%error)

  contains

    subroutine compare()
      motion = outcome%du + small*(warmth%before + warmth%change)
      call begin_beside(solution, other)
      call advance_beside(scene, equations, active, warmth%drivers, motion, dt, other, done)
      if (.not. done) return
      call unbalanced_forces(scene, equations, solution, outcome%du, residual)
      call solve_correction(equations, residual, answer, outcome%error, at_hand=at_hand)
      if (allocated(outcome%error)) return
      call begin_beside(solution, other)
      call advance_beside(scene, equations, active, warmth%drivers, motion + answer, dt, other, done)
      if (.not. done) return
      stress = root_energy(scene, equations, active, other, solution%groups)
      if (.not. stress > 0) return
      outcome%heat%stress_error = root_energy(scene, equations, active, other, &
                                              stress_of(scene, active, difference(other%groups, solution%groups, active, 1/small), &
                                                        solution%groups))/stress
    end subroutine compare

  end subroutine find_stress_of_heat

end module heat_stress
