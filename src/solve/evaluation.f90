!> Internal forces and matrices of the present solve at a motion of the step, and the error of a heat content.
module evaluation
  use wall_contact, only: press_on_walls
  use elem_api, only: block_done, instant_t, mode_error, mode_restore, report_t
  use element_loop, only: gather_forces, gather_matrix, run_elements
  use equation_set_up, only: pair_up, renew_pairs
  use equations, only: equations_t, solves_heat
  use fields, only: displacement_field
  use kinds, only: wp
  use matrix_pattern, only: add_to_diagonal, matrix_pattern_t
  use round_off_floors, only: set_floors
  use scene, only: scene_t
  use solution, only: solution_t
  use step_instants, only: driving_values, make_instant, note_correction
  use threads, only: fit_to_load
  implicit none
  private
  public :: add_diagonal, evaluate, is_apart, measure_error

contains

  !> Internal force, and matrices when wanted, at the motion `du` of the step. Points that meet pieces of deformable dies
  !> beyond their pairs get new ones, and all is computed again: no contact is lost, no step cut back.
  subroutine evaluate(scene, equations, solution, dt, du, tangent, report, predicted, kept, turning, &
                      corrected_from, contact_alone, points_alone)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    logical, intent(in) :: tangent
    type(report_t), intent(out) :: report
    logical, intent(in), optional :: predicted              !! the motion is a prediction
    logical, intent(in), optional :: kept                   !! contact of the start of the step is kept
    logical, intent(in), optional :: turning(:)             !! (ndie) not with these dies
    real(wp), intent(in), optional :: corrected_from(:)     !! (ndof) motion before the correction that led to it [unknown]
    logical, intent(in), optional :: contact_alone          !! all but contact is as it was evaluated last, or of no interest
    logical, intent(in), optional :: points_alone           !! sides press on dies at their points alone
    type(instant_t) :: instant
    real(wp), allocatable :: now(:, :)
    logical :: active(size(scene%groups)), damped, dragged
    integer :: timer

    call fit_to_load(equations%team)
    call make_instant(scene, equations, solution, dt, du, tangent, instant)
    if (present(predicted)) instant%predicted = predicted
    if (present(kept)) instant%kept = kept
    if (present(turning)) instant%turning = turning
    if (present(points_alone)) instant%points_alone = points_alone
    if (present(corrected_from)) call note_correction(scene, equations%dofs, corrected_from, instant)
    call driving_values(scene, equations, solution, du, now)
    active = equations%solves(equations%now)%active
    if (present(contact_alone)) then
      if (contact_alone) active = active .and. is_contact(scene, equations)
    end if
    do
      call pair_up(scene, solution%pairs, equations)
      instant%pairs = solution%pairs
      call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, &
                        equations%solves(equations%now)%pattern, instant, du, now, solution, equations%drivers, &
                        equations%buffers, equations%timers, report)
      if (report%status /= block_done) return
      if (.not. report%unpaired) exit
      call renew_pairs(scene, equations%solves(equations%now)%active, solution)
    end do
    equations%source = sqrt(report%source)
    if (solves_heat(scene, equations)) then
      equations%heat_stored = report%heat_stored
      equations%heat_released = report%heat_released
    end if
    call equations%timers%add('assembly', timer)
    call equations%timers%start(timer)
    associate (solve => equations%solves(equations%now))
      ! round-off is that of the bodies alone
      if (tangent) call set_floors(scene, equations, solution%fields)
      if (solve%own(displacement_field)) &
        call press_on_walls(scene, equations%dofs, solve%pattern, solve%active, solution%fields(displacement_field)%value, du, &
                            tangent, equations%mode == mode_restore, equations%wall, equations%buffers%force, &
                            equations%buffers%matrix, report)
      call gather_forces(solve%pattern, equations%buffers, solve%is_own, equations%force, equations%magnitude)
      damped = allocated(equations%damping) .and. dt > 0 .and. solve%own(displacement_field)
      if (damped) equations%force = equations%force + equations%damping*(du - equations%carried)/dt
      dragged = solve%own(displacement_field) .and. any(equations%drag > 0)
      if (dragged) equations%force = equations%force + equations%drag*du
      if (tangent) then
        call gather_matrix(solve%pattern, equations%buffers, solve%values)
        if (damped) call add_diagonal(solve%pattern, solve%equation, equations%damping/dt, solve%values)
        if (dragged) call add_diagonal(solve%pattern, solve%equation, equations%drag, solve%values)
      end if
    end associate
    call equations%timers%stop(timer)
  end subroutine evaluate

  !> Add to the diagonal of a matrix, unknown by unknown.
  pure subroutine add_diagonal(pattern, equation, added, values)
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: equation(:)     !! (ndof) of every unknown, 0 where it has none
    real(wp), intent(in) :: added(:)       !! (ndof) [residual/unknown]
    real(wp), intent(inout) :: values(:)   !! (nnz) [residual/unknown]
    real(wp) :: diagonal(0:pattern%neq)
    integer :: d

    diagonal = 0
    do d = 1, size(equation)
      diagonal(equation(d)) = added(d)
    end do
    call add_to_diagonal(pattern, diagonal, values)
  end subroutine add_diagonal

  !> Groups whose multipliers are carried forward.
  pure function is_contact(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(size(scene%groups))
    integer :: g

    do g = 1, size(yes)
      yes(g) = associated(equations%elems(scene%groups(g)%elem_id)%augment)
    end do
  end function is_contact

  !> Contact can be evaluated alone: nothing else follows from it, and walls have added nothing to element forces.
  pure function is_apart(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes

    yes = size(equations%solves) == 1 .and. .not. solves_heat(scene, equations) .and. .not. any(equations%wall%held)
  end function is_apart

  !> An error of the heat content at the end of a step, in the mean square of the volume of the bodies, over the least heat capacity
  !> of each; and that of the temperatures that it belongs to, by which it is given.
  subroutine measure_error(scene, equations, solution, du, temperatures, error, of_temperature)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: du(:)             !! (ndof) motion of the step [unknown]
    real(wp), intent(in) :: temperatures(:)   !! (ndof) the error [unknown]
    real(wp), intent(out) :: error            !! [temperature]
    real(wp), intent(out) :: of_temperature   !! [temperature]
    type(instant_t) :: instant
    type(report_t) :: report
    real(wp), allocatable :: now(:, :)

    call make_instant(scene, equations, solution, 0.0_wp, du, .false., instant)
    instant%mode = mode_error
    instant%values = instant%values + du
    call driving_values(scene, equations, solution, du, now)
    call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, &
                      equations%solves(equations%now)%active, equations%solves(equations%now)%pattern, instant, temperatures, now, &
                      solution, equations%drivers, equations%buffers, equations%timers, report)
    error = 0
    of_temperature = 0
    if (.not. report%error_volume > 0) return
    error = sqrt(report%error_square/report%error_volume)
    of_temperature = sqrt(report%temperature_square/report%error_volume)
  end subroutine measure_error

end module evaluation
