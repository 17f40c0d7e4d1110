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
!> the laws, from a state with elastic strains a little larger: creep forgets it, elastic unloading does not.
module path_error
  use axis_wall, only: press_on_axis
  use corrections, only: solve_correction
  use dofs, only: move_fields
  use drivers, only: drivers_of_half, drivers_t
  use elem_api, only: block_done, instant_t, report_t, totals_t
  use element_loop, only: gather_forces, group_geometry, run_elements
  use equations, only: equations_t, take_turn
  use errors, only: exit_no_convergence
  use fields, only: displacement_field, section_field
  use kinds, only: eps, wp
  use kinematics_api, only: first_history
  use law_api, only: law_t, solid_law
  use newton, only: outcome_t
  use path_record, only: mean_square, path_step_t, stress_scale
  use predictor, only: proportion
  use round_off_floors, only: round_off_motion
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  use step_instants, only: make_instant
  use timers, only: ledger_t
  implicit none
  private
  public :: at_corner, bend_of, estimate_path, on_nodes

  !> Elastic strains are enlarged by this share; what is left of an error is found to about as much.
  real(wp), parameter :: enlarged = 1.0e-3_wp
  !> An error of the stress below this share is carried on as it is.
  real(wp), parameter :: negligible = 3.0e-4_wp

contains

  !> Groups of bodies whose laws flow (ngroup).
  pure function has_path(scene, laws) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical :: yes(size(scene%groups))
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
        yes(g) = law%kind == solid_law .and. associated(law%flow_stress)
      end associate
    end do
  end function has_path

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
    real(wp) :: element_force(size(equations%buffers%force)), before, after
    logical :: active(size(scene%groups))
    integer :: g

    active = has_path(scene, equations%laws)
    call take_turn(equations, displacement_field)
    ! the books want the element forces of the step
    element_force = equations%buffers%force
    call motion_of_first_half(scene, equations, solution, dt, outcome%du, first)
    call begin(other)
    call drivers_of_half(equations%drivers, other%groups, .false., drivers)
    call advance(first, 0.5_wp*dt)
    if (done) then
      do g = 1, size(active)
        if (active(g)) other%groups(g)%committed = other%groups(g)%trial
      end do
      call drivers_of_half(equations%drivers, other%groups, .true., drivers)
      call advance(outcome%du - first, 0.5_wp*dt)
    end if
    if (done) then
      associate (step => outcome%path)
        step%stress = root_energy(scene, equations, active, other, solution%groups)
        step%stress_error = 2*(root_energy(scene, equations, active, other, other%groups) - step%stress)
        call unbalanced_forces(scene, equations, solution, outcome%du, residual)
        call solve_correction(equations, 2*residual, error, outcome%error, at_hand=at_hand)
        step%motion = mean_square(on_nodes(equations, outcome%du))
        allocate (step%error, source=on_nodes(equations, error))
        step%motion_error = mean_square(step%error)
        call drop_round_off(equations, solution, step)
        if (max(abs(step%stress_error), abs(solution%path%stress_error)) &
            > negligible*stress_scale(solution%path, step%stress)) then
          before = root_energy(scene, equations, active, solution, solution%groups, committed=.true.)
          call begin(other)
          do g = 1, size(active)
            if (active(g)) other%groups(g)%committed(:first_history - 1, :, :) &
              = (1 + enlarged)*other%groups(g)%committed(:first_history - 1, :, :)
          end do
          deallocate (drivers)
          allocate (drivers, source=equations%drivers)
          drivers%vary = .false.
          call advance(outcome%du, dt)
          if (done .and. before > 0) then
            after = root_energy(scene, equations, active, other, other%groups)
            ! loads that go on do not make more of it
            step%left = min(max((after - step%stress)/(enlarged*before), 0.0_wp), 1.0_wp)
          end if
          done = .true.
        end if
      end associate
    end if
    equations%buffers%force = element_force
    if (.not. allocated(outcome%error)) return
    outcome%converged = .false.
    if (outcome%error%code /= exit_no_convergence) return
    outcome%reason = outcome%error%message
    deallocate (outcome%error)

  contains

    !> The start of the step.
    subroutine begin(state)
      type(solution_t), intent(out) :: state

      state = solution
      ! nothing of contact is computed
      deallocate (state%pairs)
      allocate (state%pairs(0))
    end subroutine begin

    !> Trial states after a motion, and the geometry.
    subroutine advance(motion, length)
      real(wp), intent(in) :: motion(:)   !! (ndof) [unknown]
      real(wp), intent(in) :: length      !! [time]
      type(instant_t) :: instant
      type(report_t) :: report
      type(ledger_t) :: within
      real(wp) :: none(0, 0)

      call make_instant(scene, equations, other, length, motion, .false., instant)
      call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, &
                        equations%solves(equations%now)%pattern, instant, motion, none, other, drivers, equations%buffers, &
                        within, report)
      done = report%status == block_done
      call move_fields(equations%dofs, motion, other%fields)
      other%time = other%time + length
    end subroutine advance

  end subroutine estimate_path

  !> Where hardly anything moves yet, as before a torch comes near, both errors are round-off of places and stresses: none.
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

  !> Forces of the step less those that the stresses of both halves make in its end, on the unknowns of mechanics.
  subroutine unbalanced_forces(scene, equations, solution, du, residual)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations   !! element forces are those of both halves
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)
    real(wp), intent(out) :: residual(:)
    type(report_t) :: unused
    real(wp), dimension(size(du)) :: force, magnitude
    integer :: f, k, c

    residual = 0
    force = equations%force
    associate (solve => equations%solves(equations%now))
      call press_on_axis(scene, equations%dofs, solve%pattern, solve%active, solution%fields(displacement_field)%value, du, &
                         .false., equations%wall, equations%buffers%force, equations%buffers%matrix, unused)
      call gather_forces(solve%pattern, equations%buffers, solve%is_own, force, magnitude)
    end associate
    do f = 1, size(solution%fields)
      if (solution%fields(f)%quantity /= 'motion') cycle
      associate (number => equations%dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (number(c, k) > 0) residual(number(c, k)) = equations%force(number(c, k)) - force(number(c, k))
          end do
        end do
      end associate
    end do
  end subroutine unbalanced_forces

  !> Root of the elastic energy of the bodies that flow.
  function root_energy(scene, equations, active, place, groups, committed) result(root)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: active(:)
    type(solution_t), intent(in) :: place           !! with the geometry
    type(group_state_t), intent(in) :: groups(:)    !! with the states
    logical, intent(in), optional :: committed      !! of the committed states, not the trial ones
    real(wp) :: root
    type(totals_t) :: totals
    real(wp), allocatable :: x(:, :, :)
    integer :: g

    root = 0
    do g = 1, size(active)
      if (.not. active(g)) cycle
      associate (group => scene%groups(g), row => equations%elems(scene%groups(g)%elem_id), &
                 law => equations%laws(scene%materials(scene%groups(g)%material)%law_id), &
                 section => place%fields(section_field)%value(:, 1))
        call group_geometry(scene, group, row, place%fields(displacement_field)%value, x)
        if (present(committed)) then
          call row%measure(scene, group, law, section, x, groups(g)%committed, groups(g)%committed, totals)
        else
          call row%measure(scene, group, law, section, x, groups(g)%trial, groups(g)%trial, totals)
        end if
      end associate
      root = root + totals%elastic_energy
    end do
    root = sqrt(max(root, 0.0_wp))
  end function root_energy

  !> The part of a motion of unknowns that is of the displacements of nodes.
  pure function on_nodes(equations, motion) result(displacement)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: motion(:)   !! (ndof) [unknown]
    real(wp), allocatable :: displacement(:, :)
    integer :: k, c

    associate (number => equations%dofs%fields(displacement_field)%number)
      allocate (displacement(size(number, 1), size(number, 2)), source=0.0_wp)
      do k = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, k) > 0) displacement(c, k) = motion(number(c, k))
        end do
      end do
    end associate
  end function on_nodes

end module path_error
