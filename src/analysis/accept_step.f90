!> What happens when a step is accepted: the trial state becomes the state, and every check is made.
module accept_step
  use bookkeeping, only: book_work, book_reactions, book_deformable_dies, measure_scene, book_spurious_mode, sample_contacts
  use contact_flow, only: update_flow_stress
  use elem_api, only: totals_t
  use equations, only: equations_t
  use errors, only: error_t, exit_bug, fail
  use kinds, only: wp
  use newton, only: outcome_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: accept, accept_balance

  !> Dissipated work may fall by this share of the largest work density: round-off of a sum.
  real(wp), parameter :: dissipation_slack = 1.0e-12_wp

contains

  !> Commit the step, book its work, measure the scene, check it. An error is a bug of ours: exit 6.
  subroutine accept(scene, equations, dt, outcome, solution, totals, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: dt
    type(outcome_t), intent(in) :: outcome
    type(solution_t), intent(inout) :: solution
    type(totals_t), intent(out) :: totals
    type(error_t), allocatable, intent(out) :: error

    call book_work(equations, outcome%du, solution)
    call book_reactions(scene, equations, solution%time + dt, solution%reactions)
    call take_motion(equations, outcome%du, solution)
    solution%time = solution%time + dt
    solution%last_step = dt
    solution%step = solution%step + 1
    solution%iterations = solution%iterations + outcome%iterations
    solution%worst_linear_residual = max(solution%worst_linear_residual, outcome%linear_residual)

    call book_deformable_dies(scene, equations, solution, error)
    if (allocated(error)) return
    call measure_scene(scene, equations, solution, totals)
    solution%worst_penetration = max(solution%worst_penetration, totals%max_penetration)
    solution%worst_penetration_ratio = max(solution%worst_penetration_ratio, totals%penetration_ratio)
    solution%least_dissipation = min(solution%least_dissipation, totals%least_dissipation)
    solution%friction_work = totals%friction_work
    call book_spurious_mode(scene, equations, solution)
    call sample_contacts(scene, solution)
    call check(solution, totals, error)
    call commit(scene, equations, solution)
  end subroutine accept

  !> Commit an equilibrium restored at fixed time on a new mesh: no work is booked, no step counted, and the motion of the step
  !> before stays the one to go on with.
  subroutine accept_balance(scene, equations, outcome, solution, totals, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(outcome_t), intent(in) :: outcome
    type(solution_t), intent(inout) :: solution
    type(totals_t), intent(out) :: totals
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: work, increment(2, size(solution%last_increment, 2)), pilots(3, size(solution%pilots, 2)), section(3)

    work = solution%external_work
    call book_work(equations, outcome%du, solution)
    solution%external_work = work
    call book_reactions(scene, equations, solution%time, solution%reactions)
    increment = solution%last_increment
    pilots = solution%last_pilot_increment
    section = solution%last_section_increment
    call take_motion(equations, outcome%du, solution)
    solution%last_increment = increment
    solution%last_pilot_increment = pilots
    solution%last_section_increment = section
    solution%iterations = solution%iterations + outcome%iterations
    call book_deformable_dies(scene, equations, solution, error)
    call measure_scene(scene, equations, solution, totals)
    call commit(scene, equations, solution)
  end subroutine accept_balance

  !> Move nodes, pilots and section.
  pure subroutine take_motion(equations, du, solution)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: du(:)
    type(solution_t), intent(inout) :: solution
    integer :: k, c, d

    do k = 1, size(equations%dofs%node, 2)
      do c = 1, 2
        d = equations%dofs%node(c, k)
        if (d > 0) solution%last_increment(c, k) = du(d)
      end do
    end do
    do k = 1, size(equations%dofs%pilot, 2)
      do c = 1, 3
        d = equations%dofs%pilot(c, k)
        if (d > 0) solution%last_pilot_increment(c, k) = du(d)
      end do
    end do
    do c = 1, 3
      d = equations%dofs%section(c)
      if (d > 0) solution%last_section_increment(c) = du(d)
    end do
    solution%displacement = solution%displacement + solution%last_increment
    solution%section = solution%section + solution%last_section_increment
    solution%pilots = solution%pilots + solution%last_pilot_increment
  end subroutine take_motion

  !> The trial state becomes the state.
  subroutine commit(scene, equations, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    integer :: k

    do k = 1, size(solution%groups)
      solution%groups(k)%committed = solution%groups(k)%trial
    end do
    call update_flow_stress(scene, equations%laws, equations%bodies, solution)
  end subroutine commit

  !> Invariants of an accepted step.
  subroutine check(solution, totals, error)
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    type(error_t), allocatable, intent(out) :: error
    integer :: g
    real(wp) :: scale

    scale = 0
    do g = 1, size(solution%groups)
      if (size(solution%groups(g)%trial) == 0) cycle
      scale = max(scale, maxval(abs(solution%groups(g)%trial)))
      if (.not. all(abs(solution%groups(g)%trial) <= huge(1.0_wp))) then
        call fail(error, exit_bug, 'step '//to_text(solution%step)//': not a number in the state of group '//to_text(g))
        return
      end if
    end do
    if (totals%least_dissipation < -dissipation_slack*scale) then
      call fail(error, exit_bug, 'step '//to_text(solution%step)//': dissipated work fell by ' &
                //to_text(-totals%least_dissipation, 3)//' at a point')
    end if
  end subroutine check

end module accept_step
