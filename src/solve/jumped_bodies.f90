!> Bodies that are pressed at the start of a step and by nothing at its end, though what moves presses them on.
!>
!> A body that no support holds is in equilibrium without forces wherever it touches nothing: Newton's method may end there from any
!> state, as where a billet turns under a tilted die, and the part jumps out of its dies. Shorter steps tell whether it would.
module jumped_bodies
  use equations, only: equations_t
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use prescribed_unknowns, only: prescribed_motion
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: has_jumped

  !> Forces at the end of a step that are no more than this share of those at its start press nothing any more.
  real(wp), parameter :: nothing = 1.0e-3_wp

contains

  !> A body has jumped so in a step of length dt.
  function has_jumped(scene, equations, solution, dt, external) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations   !! with the forces at the end of the step
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                   !! [time]
    real(wp), intent(in) :: external(:)          !! (ndof) forces at the end of the step [residual]
    logical :: yes
    real(wp) :: driven(size(equations%dofs%prescribed)), motion(equations%dofs%ndof), before
    integer :: k

    yes = .false.
    if (size(equations%loose) == 0) return
    call prescribed_motion(scene, equations%dofs, solution%fields, .false., solution%time, solution%time + dt, driven)
    motion = 0
    do k = 1, size(driven)
      motion(equations%dofs%prescribed(k)%dof) = driven(k)
    end do
    before = work_before(displacement_field) + work_before(pilot_field)
    yes = before > 0 .and. dot_product(equations%force - external, motion) < nothing*before

  contains

    !> Work that the forces from outside at the start of the step would do on the prescribed motion of a field [energy].
    pure function work_before(field) result(work)
      integer, intent(in) :: field
      real(wp) :: work
      integer :: c, k

      work = 0
      associate (number => equations%dofs%fields(field)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (number(c, k) > 0) work = work + solution%fields(field)%applied(c, k)*motion(number(c, k))
          end do
        end do
      end associate
    end function work_before

  end function has_jumped

end module jumped_bodies
