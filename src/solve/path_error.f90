!> Error of a step that comes of the path within it: of the rates of the laws, and of a strain path that bends.
!>
!> A law advances its points by the motion of the whole step, as if it went straight and as if rates were those of the end. Once
!> the step has converged the laws make the same motion again in two halves, along the path that bends as the motions of the step
!> before and of this one tell (velocities linear in time). Backward Euler errs twice as much in the step as in its two halves, in
!> the rates as in the direction of flow, so that the error of the stresses is twice the difference (step doubling: E. Hairer,
!> S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 1993, II.4).
!>
!> Forces of this difference are no longer in balance. The motion that balances them, by the last factors of the matrix, is the
!> error of the motion: where a part is about to give way a small force makes much of it, as at the begin of a neck. The error of
!> the stress is counted as that of the root of the elastic energy. What becomes in a step of an error at its start is found by
!> the laws, from a state with elastic strains a little smaller: creep forgets it, elastic unloading does not.
module path_error
  use corrections, only: solve_correction
  use drivers, only: drivers_of_half, drivers_t
  use equations, only: equations_t, take_turn
  use errors, only: exit_no_convergence
  use fields, only: displacement_field
  use kinds, only: eps, wp
  use kinematics_api, only: first_history
  use known_motion, only: proportion
  use path_record, only: bound_scale, mean_square, path_step_t
  use path_states, only: advance_beside, begin_beside, flow_energy, has_path, has_stress, on_nodes, root_energy, &
                         unbalanced_forces
  use path_stress, only: carry_errors
  use resting_bodies, only: remove_rigid_motion
  use round_off_floors, only: round_off_motion
  use scene, only: scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use strategy, only: strategy_t
  implicit none
  private
  public :: at_corner, bend_of, estimate_path

  !> Elastic strains are made smaller by this share, for larger ones are returned at once where a point rests on its yield surface;
  !> what is left of an error is found to about as much.
  real(wp), parameter :: reduced = 1.0e-3_wp
  !> An error of the stress below this share, or below as much of a bound that is tighter than by default, is carried on as it is.
  real(wp), parameter :: negligible = 3.0e-4_wp

contains

  !> Errors of a step that has converged. `done` is false where the two halves cannot be made.
  subroutine estimate_path(scene, equations, solution, dt, at_hand, outcome, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution   !! its trial state is that of the step
    real(wp), intent(in) :: dt        !! [time]
    logical, intent(in) :: at_hand    !! factors of a matrix of this step are
    type(outcome_t), intent(inout) :: outcome
    logical, intent(out) :: done
    type(solution_t) :: other
    type(drivers_t), allocatable :: drivers(:)
    real(wp), dimension(equations%dofs%ndof) :: first, residual, error
    real(wp) :: element_force(size(equations%buffers%force)), before, after, small
    logical, dimension(size(scene%groups)) :: active, moved
    integer :: g

    active = has_path(scene, equations%laws)
    moved = has_stress(scene, equations%laws)
    call take_turn(equations, displacement_field)
    ! the books want the element forces of the step
    element_force = equations%buffers%force
    call motion_of_first_half(scene, equations, solution, dt, outcome%du, first)
    call begin_beside(solution, other)
    call drivers_of_half(equations%drivers, other%groups, .false., drivers)
    call advance_beside(scene, equations, moved, drivers, first, 0.5_wp*dt, other, done)
    if (done) then
      do g = 1, size(active)
        if (moved(g)) other%groups(g)%committed = other%groups(g)%trial
      end do
      call drivers_of_half(equations%drivers, other%groups, .true., drivers)
      call advance_beside(scene, equations, moved, drivers, outcome%du - first, 0.5_wp*dt, other, done)
    end if
    estimate: if (done) then
      associate (step => outcome%path)
        step%stress = root_energy(scene, equations, active, other, solution%groups)
        step%stress_error = 2*(root_energy(scene, equations, active, other, other%groups) - step%stress)
        step%flow = flow_energy(scene, equations, active, solution)
        call unbalanced_forces(scene, equations, solution, outcome%du, residual)
        call solve_correction(equations, 2*residual, error, outcome%error, at_hand=at_hand)
        ! what follows is of no use then, and may not take the error's place
        if (allocated(outcome%error)) exit estimate
        ! what a body goes that only its drag resists is no answer to forces of a path
        call remove_rigid_motion(scene, equations, solution, error)
        step%motion = mean_square(on_nodes(equations, outcome%du))
        step%motion_error = mean_square(on_nodes(equations, error))
        call drop_round_off(equations, solution, step)
        call carry_errors(scene, equations, solution, active, moved, dt, error, 2*residual, other%groups, outcome)
        if (allocated(outcome%error)) exit estimate
        small = least_share(scene%strategy)*bound_scale(solution%path, step%stress, step%flow)
        if (max(abs(step%stress_error), abs(solution%path%stress_error), solution%path%whole_before) > small &
            .or. solution%path%unknown > 0) then
          before = root_energy(scene, equations, active, solution, solution%groups, committed=.true.)
          call begin_beside(solution, other)
          do g = 1, size(active)
            if (active(g)) other%groups(g)%committed(:first_history - 1, :, :) &
              = (1 - reduced)*other%groups(g)%committed(:first_history - 1, :, :)
          end do
          deallocate (drivers)
          allocate (drivers, source=equations%drivers)
          drivers%vary = .false.
          call advance_beside(scene, equations, active, drivers, outcome%du, dt, other, done)
          if (done .and. before > 0) then
            after = root_energy(scene, equations, active, other, other%groups)
            ! loads that go on do not make more of it
            step%left = min(max((step%stress - after)/(reduced*before), 0.0_wp), 1.0_wp)
          end if
          done = .true.
        end if
      end associate
    end if estimate
    equations%buffers%force = element_force
    if (.not. allocated(outcome%error)) return
    outcome%converged = .false.
    if (outcome%error%code /= exit_no_convergence) return
    outcome%reason = outcome%error%message
    deallocate (outcome%error)
  end subroutine estimate_path

  !> Share of the stress below which its error is carried on as it is: what is not forgotten must not use up the bound.
  pure function least_share(strategy) result(share)
    type(strategy_t), intent(in) :: strategy
    real(wp) :: share
    type(strategy_t) :: default

    share = negligible
    if (strategy%rate_bound > 0) share = negligible*min(strategy%rate_bound/default%rate_bound, 1.0_wp)
  end function least_share

  !> Where hardly anything moves yet, as before a torch comes near, errors are round-off of places and stresses: none.
  pure subroutine drop_round_off(equations, solution, step)
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(path_step_t), intent(inout) :: step
    real(wp) :: motion, energy

    motion = round_off_motion*equations%size
    energy = 0.5_wp*solution%fields(displacement_field)%floor*motion
    if (step%motion_error <= motion) step%motion_error = 0
    if (abs(step%stress_error) <= sqrt(energy)) step%stress_error = 0
  end subroutine drop_round_off

  !> Motion of the first half: velocities are linear in time, with the mean v(n) of the step before and v of this one in their
  !> middles, du_1 = dt v/2 - (v - v(n)) dt^2/(4 (dt + dt_n)). What is no motion goes straight; so does all where a multiplier has a
  !> corner, at which velocities jump.
  pure subroutine motion_of_first_half(scene, equations, solution, dt, du, first)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt, du(:)
    real(wp), intent(out) :: first(:)
    real(wp) :: before(size(du))
    integer :: f, k, c, d

    first = 0.5_wp*du
    if (.not. solution%last_step > 0 .or. at_corner(scene, solution%time)) return
    call proportion(equations%dofs, solution%fields, dt/solution%last_step, before)
    do f = 1, size(solution%fields)
      if (solution%fields(f)%quantity /= 'motion') cycle
      associate (number => equations%dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            d = number(c, k)
            if (d > 0) first(d) = first(d) - (du(d) - before(d))*dt/(4*(dt + solution%last_step))
          end do
        end do
      end associate
    end do
  end subroutine motion_of_first_half

  !> Share of a motion that is not in proportion to that of the step before, on the nodes.
  pure function bend_of(equations, solution, dt, du) result(bend)
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    real(wp) :: bend
    real(wp) :: before(size(du)), motion

    bend = 0
    if (.not. solution%last_step > 0) return
    call proportion(equations%dofs, solution%fields, dt/solution%last_step, before)
    motion = mean_square(on_nodes(equations, du))
    if (motion > 0) bend = mean_square(on_nodes(equations, du - before))/motion
  end function bend_of

  !> A multiplier has a corner at this time.
  pure function at_corner(scene, time) result(yes)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(scene%multipliers)
      yes = yes .or. any(abs(scene%multipliers(k)%time - time) <= 64*eps*abs(scene%strategy%end_time))
    end do
  end function at_corner

end module path_error
