!> Errors of the stress and of the places that come of the path within all steps so far, carried on from step to step.
!>
!> Steps are bounded by the root of the elastic energy at the motion of the run (path_error): that is what creep errs in. Where a
!> body flows plastically this root hardly errs, for the yield stress states it, but the directions of the stress do, and the
!> pressures that balance them. What comes of that is known only of all steps: an error that one has made is forgotten where flow
!> goes on, kept where points unload or rest, and turned where the load turns. So the difference of all the state and of the places
!> to a better run is carried along, e(n+1) = M e(n) + d (the error of a scheme is the sum of its local ones, each carried on by the
!> scheme: E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 1993, II.3):
!> - d, what the step adds: what two halves of it make of the state, doubled as in path_error, and the motion that balances that;
!> - M e, what the step makes of an error at its start: the laws make the step from the state with the error, at the places with
!>   theirs, and a motion balances what they answer.
!>
!> The state with the error has the hardening that belongs to it: it lies on its yield surface, and a hold leaves it there. One with
!> another stress alone is returned by the laws and forgotten, or lies within and is kept, as its sign is.
!>
!> All of it is made with a thousandth of the errors, so that it is linear, and solutions with the matrix of the step balance it.
!> Errors of temperatures in time, and of the phases that follow them, are among those of the step (path_heat).
!> What they leave out of balance is balanced in the next step. Where the matrix is that of points that flow and the answer is
!> elastic, they go too far: then the answer is shortened as a line search does.
module path_stress
  use contact_changes, only: contact_differs
  use corrections, only: solve_correction
  use dofs, only: move_fields
  use equations, only: equations_t
  use kinds, only: wp
  use kinematics_api, only: first_history
  use path_heat, only: follow_heat, warmth_t
  use path_record, only: error_weight, largest_linear, path_record_t, path_step_t, state_error_t, stress_scale
  use path_states, only: advance_beside, begin_beside, of_unknowns, on_nodes, root_energy, unbalanced_forces
  use resting_bodies, only: remove_rigid_motion
  use scene, only: plane_stress, scene_t
  use solution, only: group_state_t, solution_t
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: carry_errors, carry_errors_in_quiet, difference, stress_of

  !> The share of the errors by which they are carried on.
  real(wp), parameter :: small = 1.0e-3_wp
  !> A motion that should balance forces and makes so large a share of them the other way goes too far.
  real(wp), parameter :: too_far = 0.1_wp

contains

  !> Errors at the end of the step; not known where one of the other states cannot be made, or where that of the stress is as large
  !> as the stress and as what makes bodies flow, of which derivatives say nothing: then they begin anew.
  !>
  !> Steps without an estimate before it have added nothing yet (carry_errors_in_quiet). They are taken to have erred as this one
  !> (error_weight): what they would have added is among the errors at the start. Their motions balanced it when it was made, so
  !> that the share which is forgotten since is a motion too.
  subroutine carry_errors(scene, equations, solution, active, moved, dt, own, force, halves, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations    !! with factors of a matrix of the step
    type(solution_t), intent(in) :: solution         !! its trial state is that of the step
    logical, intent(in) :: active(:), moved(:)       !! (ngroup) bodies that flow, and all that have a stress
    real(wp), intent(in) :: dt                       !! [time]
    real(wp), intent(in) :: own(:)                   !! (ndof) error of the motion of the step [unknown]
    real(wp), intent(in) :: force(:)                 !! (ndof) that it balances [residual]
    type(group_state_t), intent(in) :: halves(:)     !! (ngroup) states by two halves, as trial states
    type(outcome_t), intent(inout) :: outcome
    type(warmth_t) :: warmth
    type(state_error_t) :: added(size(active)), errors(size(active))
    type(solution_t) :: other
    real(wp), dimension(size(own)) :: answer, residual, after
    real(wp) :: weight, before, left, share, gain, against
    logical :: done

    outcome%path%error = solution%path%error
    call follow_heat(scene, equations, solution, moved, small, outcome, warmth)
    outcome%path%warm = warmth%any
    outcome%path%known = .not. (any_error(solution, moved) .or. warmth%any &
                                .or. max(outcome%path%motion_error, abs(outcome%path%stress_error)) > 0)
    if (outcome%path%known) return
    outcome%path%error = outcome%path%error + on_nodes(equations, own)
    outcome%path%jumps = contact_differs(scene, solution)
    weight = share_where_contact_changes(outcome%path, dt, solution%path)
    before = weight*(error_weight(outcome%path, dt, solution%path) - 1)
    added = difference(halves, solution%groups, moved, 2.0_wp)
    call start_with_errors(equations, solution, moved, warmth, added, before, other, errors)
    left = 1
    if (before > 0) left = size_of(errors)
    call advance_beside(scene, equations, moved, warmth%drivers, outcome%du + small*warmth%change, dt, other, done)
    if (.not. done) return
    if (before > 0 .and. left > 0) left = min(size_of(difference(other%groups, solution%groups, moved, 1/small))/left, 1.0_wp)
    call unbalanced_forces(scene, equations, solution, outcome%du, residual)
    call solve_correction(equations, residual/small, answer, outcome%error, at_hand=.true.)
    if (allocated(outcome%error)) return
    call remove_rigid_motion(scene, equations, solution, answer)
    residual = residual/small + weight*force
    answer = answer + weight*own
    share = 1
    call make_with_answer()
    if (.not. done) return
    gain = dot_product(residual, answer)
    against = dot_product(after/small + weight*force, answer)
    if (against < -too_far*gain) then
      share = gain/(gain - against)
      call make_with_answer()
      if (.not. done) return
    end if
    outcome%path%states = sum_of(difference(other%groups, solution%groups, moved, 1/small), weight, added)
    call add_phases(warmth, outcome%path%states)
    outcome%path%stress_whole = size_of(outcome%path%states)
    outcome%path%known = outcome%path%stress_whole &
                         <= largest_linear(stress_scale(solution%path, outcome%path%stress), outcome%path%flow)
    if (outcome%path%known) then
      outcome%path%error = solution%path%error + on_nodes(equations, share*answer + (1 - left)*before*own)
    else
      outcome%path%states = sum_of(added, -1.0_wp, added)
      call add_phases(warmth, outcome%path%states)
    end if

  contains

    !> The step from the start with errors, with this share of the answer. Contact, which is in the matrix alone, takes a part of
    !> the forces, and no more than all.
    subroutine make_with_answer()
      call start_with_errors(equations, solution, moved, warmth, added, before, other, errors)
      call advance_beside(scene, equations, moved, warmth%drivers, outcome%du + small*(warmth%change + share*answer), dt, other, &
                          done)
      if (done) call unbalanced_forces(scene, equations, solution, outcome%du, after)
    end subroutine make_with_answer

    !> Norm of the error of the stress.
    function size_of(errors) result(root)
      type(state_error_t), intent(in) :: errors(:)   !! (ngroup)
      real(wp) :: root   !! [energy^0.5]

      root = root_energy(scene, equations, active, solution, stress_of(scene, active, errors, solution%groups))
    end function size_of

  end subroutine carry_errors

  !> Errors at the end of a step without an estimate: what the laws make of them at its motion. What that leaves out of balance is
  !> balanced with the next estimate.
  subroutine carry_errors_in_quiet(scene, equations, solution, moved, dt, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution         !! its trial state is that of the step
    logical, intent(in) :: moved(:)                  !! (ngroup) bodies with a stress
    real(wp), intent(in) :: dt                       !! [time]
    type(outcome_t), intent(inout) :: outcome
    type(state_error_t) :: none(size(moved)), errors(size(moved))
    type(warmth_t) :: warmth
    type(solution_t) :: other
    real(wp) :: element_force(size(equations%buffers%force))

    ! the books want the element forces of the step
    element_force = equations%buffers%force
    call follow_heat(scene, equations, solution, moved, small, outcome, warmth)
    outcome%path%warm = warmth%any
    outcome%path%known = .not. (any_error(solution, moved) .or. warmth%any)
    if (.not. outcome%path%known) then
      call start_with_errors(equations, solution, moved, warmth, none, 0.0_wp, other, errors)
      call advance_beside(scene, equations, moved, warmth%drivers, outcome%du + small*warmth%change, dt, other, outcome%path%known)
      if (outcome%path%known) then
        outcome%path%states = difference(other%groups, solution%groups, moved, 1/small)
        call add_phases(warmth, outcome%path%states)
      end if
    end if
    equations%buffers%force = element_force
  end subroutine carry_errors_in_quiet

  !> The errors of phases that other formulations hold are carried on with the others.
  pure subroutine add_phases(warmth, states)
    type(warmth_t), intent(in) :: warmth
    type(state_error_t), intent(inout) :: states(:)   !! (ngroup)
    integer :: g

    do g = 1, size(states)
      if (allocated(warmth%phases(g)%value)) states(g)%value = warmth%phases(g)%value
    end do
  end subroutine add_phases

  !> The states have errors at the start of the step.
  pure function any_error(solution, moved) result(yes)
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: moved(:)   !! (ngroup) bodies with a stress
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(moved)
      if (moved(g)) yes = yes .or. any(abs(solution%groups(g)%error) > 0)
    end do
  end function any_error

  !> Where points of contact change, the velocities of some jump: the step is taken to err in the mean of what it says and of what
  !> the last one said in which none did, where that is less.
  pure function share_where_contact_changes(step, dt, record) result(share)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt   !! its length [time]
    type(path_record_t), intent(in) :: record
    real(wp) :: share

    share = 1
    if (.not. (step%jumps .and. record%smooth_rate >= 0 .and. step%motion_error > 0)) return
    share = 0.5_wp*(1 + min(record%smooth_rate*step%motion*dt/step%motion_error, 1.0_wp))
  end function share_where_contact_changes

  !> The start of the step with a small share of the errors there, and of so many times what a step adds.
  subroutine start_with_errors(equations, solution, moved, warmth, added, times, other, errors)
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: moved(:)                  !! (ngroup) bodies with a stress
    type(warmth_t), intent(in) :: warmth             !! errors of temperatures
    type(state_error_t), intent(in) :: added(:)      !! (ngroup)
    real(wp), intent(in) :: times
    type(solution_t), intent(out) :: other
    type(state_error_t), intent(out) :: errors(:)    !! (ngroup) of the states, in all
    integer :: g

    call begin_beside(solution, other)
    call move_fields(equations%dofs, small*(of_unknowns(equations, solution%path%error) + warmth%before), other%fields)
    do g = 1, size(moved)
      if (.not. moved(g)) cycle
      errors(g)%value = solution%groups(g)%error
      if (times > 0) errors(g)%value = errors(g)%value + times*added(g)%value
      other%groups(g)%committed = other%groups(g)%committed + small*errors(g)%value
    end do
  end subroutine start_with_errors

  !> So many times the trial states less those of the step.
  pure function difference(others, step, moved, factor) result(errors)
    type(group_state_t), intent(in) :: others(:), step(:)   !! (ngroup)
    logical, intent(in) :: moved(:)                         !! (ngroup) bodies with a stress
    real(wp), intent(in) :: factor
    type(state_error_t) :: errors(size(moved))             !! (ngroup)
    integer :: g

    do g = 1, size(moved)
      if (moved(g)) errors(g)%value = factor*(others(g)%trial - step(g)%trial)
    end do
  end function difference

  !> Errors and so many times others, for groups that have any.
  pure function sum_of(errors, times, others) result(both)
    type(state_error_t), intent(in) :: errors(:), others(:)   !! (ngroup)
    real(wp), intent(in) :: times
    type(state_error_t) :: both(size(errors))                 !! (ngroup)
    integer :: g

    do g = 1, size(errors)
      if (allocated(errors(g)%value)) both(g)%value = errors(g)%value + times*others(g)%value
    end do
  end function sum_of

  !> Stress and elastic strain of errors, as trial states that can be measured.
  pure function stress_of(scene, active, errors, step) result(difference)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: active(:)                 !! (ngroup) bodies that are measured
    type(state_error_t), intent(in) :: errors(:)     !! (ngroup)
    type(group_state_t), intent(in) :: step(:)       !! (ngroup)
    type(group_state_t) :: difference(size(step))
    integer :: g, last

    do g = 1, size(active)
      if (.not. active(g)) cycle
      allocate (difference(g)%trial, source=errors(g)%value)
      associate (of => difference(g)%trial)
        of(first_history:, :, :) = 0
        ! in plane stress the last one is the stretch across the plane, by which volumes are measured
        last = size(of, 1)
        if (scene%plane_state == plane_stress .and. scene%finite) of(last, :, :) = step(g)%trial(last, :, :)
      end associate
    end do
  end function stress_of

end module path_stress
