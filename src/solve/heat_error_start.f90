!> Errors of the heat contents that go with those of the temperatures at the start of a step, where only these are known: on a new
!> mesh, to whose nodes they have been carried.
module heat_error_start
  use elem_api, only: instant_t
  use equations, only: equations_t
  use kinds, only: wp
  use kinetics_error, only: gather_heat, has_heat_law, take_up
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
    real(wp), dimension(size(equations%buffers%force)) :: with, without
    logical :: active(size(scene%groups)), done
    integer :: g

    heat = 0
    active = equations%solves(equations%now)%active .and. has_heat_law(scene, equations)
    do g = 1, size(active)
      if (active(g)) kept(g)%trial = solution%groups(g)%trial
    end do
    call make_instant(scene, equations, solution, dt, du, .false., instant)
    instant%flow%n = 0
    call take_up(scene, equations, solution, active, instant, du, without, done)
    instant%values = instant%values + share*errors
    if (done) call take_up(scene, equations, solution, active, instant, du - share*errors, with, done)
    if (done) call gather_heat(equations, active, dt*(without - with)/share, heat)
    do g = 1, size(active)
      if (active(g)) call move_alloc(kept(g)%trial, solution%groups(g)%trial)
    end do
  end subroutine content_of

end module heat_error_start
