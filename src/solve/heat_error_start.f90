!> Errors of the heat contents that go with those of the temperatures at the start of a step, where only these are known: on a new
!> mesh, to whose nodes they have been carried.
module heat_error_start
  use elem_api, only: block_done, instant_t, report_t
  use element_loop, only: gather_forces, run_elements
  use equations, only: equations_t
  use kinds, only: wp
  use kinetics_error, only: has_heat_law, of_groups
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  use step_instants, only: make_instant
  implicit none
  private
  public :: content_of

contains

  !> What contents have more by errors of the temperatures at the start of a step, from what a small share of them leaves to be
  !> taken up to its end. Element forces and states are kept.
  subroutine content_of(scene, equations, solution, dt, du, errors, share, heat)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt          !! [time]
    real(wp), intent(in) :: du(:)       !! (ndof) motion of the step [unknown]
    real(wp), intent(in) :: errors(:)   !! (ndof) at its start [temperature]
    real(wp), intent(in) :: share       !! so small that all is linear [-]
    real(wp), intent(out) :: heat(:)    !! (ndof) [energy]
    type(group_state_t) :: kept(size(scene%groups))
    type(instant_t) :: instant
    type(report_t) :: report
    real(wp) :: element_force(size(equations%buffers%force)), taken(size(equations%buffers%force)), magnitude(size(du)), none(0, 0)
    logical :: active(size(scene%groups)), vary(size(scene%groups))
    integer :: g, k

    heat = 0
    active = equations%solves(equations%now)%active .and. has_heat_law(scene, equations)
    do g = 1, size(active)
      if (active(g)) kept(g)%trial = solution%groups(g)%trial
    end do
    vary = equations%drivers%vary
    equations%drivers%vary = .false.
    element_force = equations%buffers%force
    associate (solve => equations%solves(equations%now), buffers => equations%buffers)
      do k = 0, 1
        call make_instant(scene, equations, solution, dt, du, .false., instant)
        instant%values = instant%values + k*share*errors
        instant%flow%n = 0
        call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, solve%pattern, &
                          instant, du - k*share*errors, none, solution, equations%drivers, buffers, equations%timers, report)
        if (report%status /= block_done) exit
        if (k == 0) taken = buffers%force
      end do
      if (report%status == block_done) then
        buffers%force = merge(dt*(taken - buffers%force)/share, 0.0_wp, of_groups(equations, active))
        call gather_forces(solve%pattern, buffers, solve%is_own, heat, magnitude)
      end if
      buffers%force = element_force
    end associate
    equations%drivers%vary = vary
    do g = 1, size(active)
      if (active(g)) call move_alloc(kept(g)%trial, solution%groups(g)%trial)
    end do
  end subroutine content_of

end module heat_error_start
