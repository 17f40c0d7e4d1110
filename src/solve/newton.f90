!> Newton's method for one step, with line search.
!>
!> Predictor: the motion of the last step, in proportion; what prescribed unknowns still miss is
!> spread by the matrix in the first iteration. A step has converged when the residual force is
!> below `force_norm` of the forces at work, and the correction still to come (this one times the
!> last fall of the residual) is below `displacement_norm` of the motion of the step.
module newton
  use dofs, only: prescribed_motion
  use elem_api, only: block_done, block_inverted, report_t
  use element_loop, only: add_prescribed
  use equations, only: equations_t, evaluate, external_forces, solve_correction
  use errors, only: error_t, exit_no_convergence
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: solve_step, outcome_t, iteration_t

  !> One line of the listing.
  type :: iteration_t
    real(wp) :: force_norm = 0.0_wp, displacement_norm = 0.0_wp, line_search = 1.0_wp
    integer :: evaluations = 0
  end type iteration_t

  type :: outcome_t
    logical :: converged = .false.
    !> Why the step must be cut, when it has not converged; and the element at fault, when there is one.
    character(len=:), allocatable :: reason
    integer :: group = 0, element = 0
    integer :: iterations = 0
    type(iteration_t), allocatable :: history(:)
    !> Contact begins after this share of the step: it should be no longer.
    real(wp) :: event = 1.0_wp
    !> Motion of every unknown (ndof).
    real(wp), allocatable :: du(:)
    !> Largest strain increment, worst residual of the linear solves.
    real(wp) :: strain = 0.0_wp, linear_residual = 0.0_wp
    !> The machine failed: not a matter of the step.
    type(error_t), allocatable :: error
  end type outcome_t

  !> The proportional predictor is kept while it changes no penetration by more than this share of a
  !> side. Otherwise contact has changed the motion: only its onset is kept, and the matrix there
  !> (loading, with the contacts of now) spreads the rest.
  real(wp), parameter :: smooth_contact = 2.0e-3_wp, onset = 0.02_wp
  !> Line search: sought when the residual along the correction keeps more than this share.
  real(wp), parameter :: search_above = 0.8_wp
  integer, parameter :: max_searches = 4
  !> A residual this many times larger than the first one, after `patience` iterations, is hopeless.
  real(wp), parameter :: hopeless = 1.0e3_wp
  integer, parameter :: patience = 6
  !> The residual stagnates when the best of the last `patience` - 1 iterations is above this share of the best before.
  real(wp), parameter :: stagnant = 0.3_wp

contains

  !> Seek equilibrium at the end of a step of length dt.
  subroutine solve_step(scene, equations, solution, dt, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(out) :: outcome
    real(wp), dimension(equations%dofs%ndof) :: external, missing, residual, correction
    real(wp) :: norm, first_norm, previous_norm
    type(report_t) :: report
    type(iteration_t) :: line
    integer :: k, augmentations, first_iteration
    logical :: changed

    allocate (outcome%history(0))
    augmentations = 0
    first_iteration = 0
    call external_forces(scene, equations%dofs, solution%time + dt, external)
    call predict(scene, equations, solution, dt, outcome, missing, report)
    if (allocated(outcome%reason)) return
    if (dt > scene%strategy%least_step) outcome%event = report%event
    if (outcome%event < 1) return
    first_norm = 0
    previous_norm = 0
    correction = 0
    k = -1
    do while (k - first_iteration < scene%strategy%max_iterations)
      k = k + 1
      residual = external - equations%force
      norm = relative_residual(equations, solution%force_floor, external, residual)
      if (.not. norm <= huge(norm)) then
        outcome%reason = 'not a number in the forces'
        return
      end if
      line%force_norm = norm
      line%displacement_norm = 1
      if (k > 0) line%displacement_norm = free_norm(equations, correction)/motion_scale(equations, outcome%du)
      outcome%history = [outcome%history, line]
      outcome%iterations = k
      if (k == 1) first_norm = norm
      if (k > 0 .or. .not. any(abs(missing) > 0)) then
        if (norm <= scene%strategy%force_norm) then
          if (k == 0) line%displacement_norm = 0
          if (line%displacement_norm*min(1.0_wp, fall(norm, previous_norm)) <= scene%strategy%displacement_norm) then
            call augment_contacts(scene, equations, solution, augmentations, changed)
            if (.not. changed) then
              call accept(scene, report, outcome)
              return
            end if
            augmentations = augmentations + 1
            call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
            residual = external - equations%force
            first_iteration = k
          end if
        end if
      end if
      if (k - first_iteration == scene%strategy%max_iterations) exit
      if (k - first_iteration > patience .and. norm > hopeless*first_norm) then
        outcome%reason = 'diverged: residual '//to_text(norm, 3)
        return
      end if
      if (k - first_iteration >= patience) then
        if (minval(outcome%history(k - patience + 3:k + 1)%force_norm) > &
            stagnant*minval(outcome%history(first_iteration + 2:k - patience + 2)%force_norm)) then
          outcome%reason = 'residual stagnates at '//to_text(norm, 3)
          return
        end if
      end if
      previous_norm = norm

      call add_missing(equations, missing, residual)
      call solve_correction(equations, residual, correction, outcome%error)
      if (allocated(outcome%error)) then
        if (outcome%error%code /= exit_no_convergence) return
        outcome%reason = outcome%error%message
        deallocate (outcome%error)
        return
      end if
      outcome%linear_residual = max(outcome%linear_residual, equations%solver%residual)
      call search(scene, equations, solution, dt, external, residual, missing, correction, outcome, line, report)
      if (allocated(outcome%reason)) return
      missing = 0
    end do
    outcome%reason = to_text(scene%strategy%max_iterations)//' iterations without convergence (residual '//to_text(norm, 3)//')'
  end subroutine solve_step

  !> Start from the last motion in proportion, or from rest where that is no start.
  subroutine predict(scene, equations, solution, dt, outcome, missing, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(inout) :: outcome
    real(wp), intent(out) :: missing(:)
    type(report_t), intent(out) :: report
    real(wp) :: target_motion(size(equations%dofs%prescribed))
    real(wp) :: ratio
    integer :: k

    call prescribed_motion(scene, equations%dofs, solution%step == 0, solution%time, solution%time + dt, target_motion)
    allocate (outcome%du(equations%dofs%ndof), source=0.0_wp)
    ratio = 0
    if (solution%last_step > 0) ratio = dt/solution%last_step
    call spread(equations, ratio, solution, outcome%du)
    call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    if (report%status == block_done .and. report%event >= 1 .and. report%jump > smooth_contact) then
      call spread(equations, onset*ratio, solution, outcome%du)
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    end if
    if (report%status /= block_done .and. ratio > 0) then
      outcome%du = 0
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    end if
    if (report%status /= block_done) call blame(report, outcome)
    missing = 0
    do k = 1, size(target_motion)
      associate (d => equations%dofs%prescribed(k)%dof)
        missing(d) = target_motion(k) - outcome%du(d)
        ! round-off of the proportion is no motion to spread
        if (abs(missing(d)) <= 16*epsilon(1.0_wp)*abs(target_motion(k))) then
          outcome%du(d) = target_motion(k)
          missing(d) = 0
        end if
      end associate
    end do
  end subroutine predict

  !> Motion of all unknowns from the last accepted one.
  pure subroutine spread(equations, ratio, solution, du)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: ratio
    type(solution_t), intent(in) :: solution
    real(wp), intent(inout) :: du(:)
    integer :: k, c

    do k = 1, size(equations%dofs%node, 2)
      do c = 1, 2
        if (equations%dofs%node(c, k) > 0) du(equations%dofs%node(c, k)) = ratio*solution%last_increment(c, k)
      end do
    end do
    do k = 1, size(equations%dofs%pilot, 2)
      do c = 1, 3
        if (equations%dofs%pilot(c, k) > 0) du(equations%dofs%pilot(c, k)) = ratio*solution%last_pilot_increment(c, k)
      end do
    end do
  end subroutine spread

  !> Residual of the free unknowns over the largest of external force, reactions and element forces.
  pure function relative_residual(equations, force_floor, external, residual) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: force_floor, external(:), residual(:)
    real(wp) :: norm
    real(wp) :: reference, reactions

    norm = free_norm(equations, residual)
    reactions = sqrt(max(norm2(residual)**2 - norm**2, 0.0_wp))
    reference = max(norm2(external), reactions, norm2(equations%magnitude), force_floor)
    if (reference > 0) norm = norm/reference
  end function relative_residual

  pure function free_norm(equations, v) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:)
    real(wp) :: norm
    integer :: d

    norm = 0
    do d = 1, size(v)
      if (equations%dofs%equation(d) > 0) norm = norm + v(d)**2
    end do
    norm = sqrt(norm)
  end function free_norm

  !> Size of the step's motion; at least what round-off makes of the coordinates.
  pure function motion_scale(equations, du) result(scale)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: du(:)
    real(wp) :: scale

    scale = max(norm2(du), 1.0e-10_wp*equations%size)
  end function motion_scale

  !> By how much the residual fell in the last iteration.
  pure function fall(norm, previous) result(ratio)
    real(wp), intent(in) :: norm, previous
    real(wp) :: ratio

    ratio = 1
    if (previous > 0) ratio = norm/previous
  end function fall

  !> The forces that missing prescribed motions make through the matrix.
  subroutine add_missing(equations, missing, residual)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: missing(:)
    real(wp), intent(inout) :: residual(:)
    real(wp) :: force(size(residual))

    if (.not. any(abs(missing) > 0)) return
    force = 0
    call add_prescribed(equations%dofs, equations%pattern, equations%buffers, missing, force)
    residual = residual - force
  end subroutine add_missing

  !> Move along the correction, by the whole of it or less.
  subroutine search(scene, equations, solution, dt, external, residual, missing, correction, outcome, line, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt, external(:), residual(:), missing(:)
    real(wp), intent(inout) :: correction(:)
    type(outcome_t), intent(inout) :: outcome
    type(iteration_t), intent(out) :: line
    type(report_t), intent(out) :: report
    real(wp) :: start(size(correction)), s, slope0, slope, best_s, best
    integer :: k

    start = outcome%du
    s = 1
    slope0 = dot_product(correction, residual)
    best = huge(best)
    best_s = 0
    do k = 1, max_searches
      line%evaluations = k
      outcome%du = start + s*correction + missing
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
      if (report%status /= block_done) then
        ! the correction turns an element inside out: halve it; a prescribed motion cannot be halved
        s = 0.5_wp*s
        cycle
      end if
      slope = dot_product(correction, external - equations%force)
      if (abs(slope) < best) then
        best = abs(slope)
        best_s = s
      end if
      if (abs(slope) <= search_above*abs(slope0) .or. any(abs(missing) > 0)) exit
      if (relative_fall(external - equations%force, residual)) exit
      if (slope0*slope < 0) then
        s = s*min(0.9_wp, max(0.1_wp, slope0/(slope0 - slope)))
      else
        s = 0.5_wp*s
      end if
    end do
    if (best_s <= 0) then
      call blame(report, outcome)
      return
    end if
    if (k > max_searches) then
      s = best_s
      outcome%du = start + s*correction + missing
      call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
    end if
    correction = s*correction
    line%line_search = s

  contains

    !> The whole residual falls, whatever it does along the correction.
    pure function relative_fall(now, before) result(falls)
      real(wp), intent(in) :: now(:), before(:)
      logical :: falls

      falls = free_norm(equations, now) < free_norm(equations, before)
    end function relative_fall

  end subroutine search

  !> Uzawa's update of all contacts that ask for it.
  subroutine augment_contacts(scene, equations, solution, times, changed)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    integer, intent(in) :: times
    logical, intent(out) :: changed
    logical :: group_changed
    integer :: g

    changed = .false.
    do g = 1, size(scene%groups)
      associate (row => equations%elems(scene%groups(g)%elem_id), state => solution%groups(g))
        if (.not. associated(row%augment)) cycle
        call row%augment(scene, scene%groups(g), times, state%committed, state%trial, group_changed)
        changed = changed .or. group_changed
      end associate
    end do
  end subroutine augment_contacts

  !> Say which element stopped the step, and why.
  subroutine blame(report, outcome)
    type(report_t), intent(in) :: report
    type(outcome_t), intent(inout) :: outcome

    if (report%status == block_inverted) then
      outcome%reason = 'an element turned inside out'
    else
      outcome%reason = 'a law did not converge'
    end if
    outcome%group = report%group
    outcome%element = report%element
  end subroutine blame

  !> The step has converged; it stands if its strains are within bounds.
  subroutine accept(scene, report, outcome)
    type(scene_t), intent(in) :: scene
    type(report_t), intent(in) :: report
    type(outcome_t), intent(inout) :: outcome

    outcome%strain = report%strain
    if (report%strain > scene%strategy%strain_bound) then
      outcome%reason = 'strain increment '//to_text(report%strain, 3)//' above '//to_text(scene%strategy%strain_bound, 3)
    else
      outcome%converged = .true.
    end if
  end subroutine accept

end module newton
