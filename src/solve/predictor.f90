!> Where Newton's method starts: the motion of the last step, in proportion.
!>
!> The proportion is kept while it changes no penetration much; otherwise contact has changed the
!> motion, and only the onset of it is kept: the matrix there (loading, with the contacts of now)
!> spreads the rest. What prescribed unknowns still miss is left for the first iteration to spread.
module predictor
  use dofs, only: prescribed_motion
  use elem_api, only: block_done, report_t
  use equations, only: equations_t, evaluate
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: predict

  !> Change of penetration, as a share of the side, below which contact goes on as before.
  real(wp), parameter :: smooth_contact = 2.0e-3_wp
  !> Share of the proportional motion that shows which points load.
  real(wp), parameter :: onset = 0.02_wp
  !> A missing motion below this share of the motion is round-off: of times, and of their differences.
  real(wp), parameter :: round_off = 1.0e-10_wp

contains

  !> Start `du` and what prescribed unknowns miss of their motion; forces and matrices are evaluated there.
  subroutine predict(scene, equations, solution, dt, du, missing, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    real(wp), intent(out) :: du(:), missing(:)
    type(report_t), intent(out) :: report
    real(wp) :: motion(size(equations%dofs%prescribed))
    real(wp) :: ratio
    integer :: k

    ratio = 0
    if (solution%last_step > 0) ratio = dt/solution%last_step
    call proportion(equations, solution, ratio, du)
    call evaluate(scene, equations, solution, dt, du, .true., report)
    if (report%status == block_done .and. report%event >= 1 .and. report%jump > smooth_contact) then
      call proportion(equations, solution, onset*ratio, du)
      call evaluate(scene, equations, solution, dt, du, .true., report)
    end if
    if (report%status /= block_done .and. ratio > 0) then
      du = 0
      call evaluate(scene, equations, solution, dt, du, .true., report)
    end if

    call prescribed_motion(scene, equations%dofs, solution%step == 0, solution%time, solution%time + dt, motion)
    missing = 0
    do k = 1, size(motion)
      associate (d => equations%dofs%prescribed(k)%dof)
        missing(d) = motion(k) - du(d)
        if (abs(missing(d)) > round_off*abs(motion(k))) cycle
        du(d) = motion(k)
        missing(d) = 0
      end associate
    end do
  end subroutine predict

  !> The last accepted motion of all unknowns times `ratio`.
  pure subroutine proportion(equations, solution, ratio, du)
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: ratio
    real(wp), intent(out) :: du(:)
    integer :: k, c

    do k = 1, size(equations%dofs%node, 2)
      do c = 1, 2
        if (equations%dofs%node(c, k) > 0) du(equations%dofs%node(c, k)) = ratio*solution%last_increment(c, k)
      end do
    end do
    do c = 1, 3
      if (equations%dofs%section(c) > 0) du(equations%dofs%section(c)) = ratio*solution%last_section_increment(c)
    end do
    do k = 1, size(equations%dofs%pilot, 2)
      do c = 1, 3
        if (equations%dofs%pilot(c, k) > 0) du(equations%dofs%pilot(c, k)) = ratio*solution%last_pilot_increment(c, k)
      end do
    end do
  end subroutine proportion

end module predictor
