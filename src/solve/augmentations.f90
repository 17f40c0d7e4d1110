!> Augmentations of contact in a step: multipliers are carried forward (Uzawa), and equilibrium is found anew.
!>
!> A motion that is in equilibrium stays one. Where the equilibrium after an augmentation is not found, the multipliers are carried
!> forward by a share of the way; where that does not help either, the equilibrium before is the result of the step, somewhat deeper
!> in the die: a shorter step would have the same to find.
module augmentations
  use elem_api, only: report_t
  use equations, only: equations_t
  use evaluation, only: evaluate
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  implicit none
  private
  public :: augmentations_t, augment, begin_augmentations, go_back, put_back

  type :: augmentations_t
    integer :: times = 0
    !> Share of the way by which multipliers are carried forward, halved whenever there is no equilibrium.
    real(wp), private :: share = 1.0_wp
    !> The last one had no equilibrium: there are no more.
    logical :: gave_way = .false.
    !> States of contact that held before the first one, before the last one, and after it, the whole way; allocated where they were
    !> changed (ngroup).
    type(group_state_t), allocatable, private :: first(:), last(:), whole(:)
    !> Motion in equilibrium before the last one (ndof).
    real(wp), allocatable, private :: du(:)
  end type augmentations_t

  !> Shares below this hardly change the depth.
  real(wp), parameter :: least_share = 0.2_wp

contains

  !> None yet.
  subroutine begin_augmentations(ngroup, made)
    integer, intent(in) :: ngroup
    type(augmentations_t), intent(out) :: made

    allocate (made%first(ngroup), made%last(ngroup), made%whole(ngroup))
  end subroutine begin_augmentations

  !> Uzawa's update of all contacts that need it, from a motion in equilibrium.
  subroutine augment(scene, equations, solution, du, made, changed)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    type(augmentations_t), intent(inout) :: made
    logical, intent(out) :: changed
    logical :: group_changed
    integer :: g

    changed = .false.
    if (made%gave_way) return
    do g = 1, size(scene%groups)
      associate (row => equations%elems(scene%groups(g)%elem_id), state => solution%groups(g))
        if (.not. associated(row%augment)) cycle
        if (.not. allocated(made%first(g)%committed)) made%first(g)%committed = state%committed
        made%last(g)%committed = state%committed
        call row%augment(scene, scene%groups(g), made%times, state%committed, state%trial, group_changed)
        made%whole(g)%committed = state%committed
        changed = changed .or. group_changed
      end associate
    end do
    if (.not. changed) return
    call carry_forward(made, solution)
    made%times = made%times + 1
    made%du = du
  end subroutine augment

  !> Multipliers between those before and after the last augmentation.
  subroutine carry_forward(made, solution)
    type(augmentations_t), intent(in) :: made
    type(solution_t), intent(inout) :: solution
    integer :: g

    if (.not. made%share < 1) return
    do g = 1, size(made%whole)
      if (.not. allocated(made%whole(g)%committed)) cycle
      associate (before => made%last(g)%committed)
        solution%groups(g)%committed = before + made%share*(made%whole(g)%committed - before)
      end associate
    end do
  end subroutine carry_forward

  !> Back to the equilibrium before the last augmentation: motion, forces, and multipliers, which are carried forward again by half
  !> of the share that had no equilibrium. Below `least_share` they stay as they were.
  subroutine go_back(scene, equations, solution, dt, made, du, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(augmentations_t), intent(inout) :: made
    real(wp), intent(out) :: du(:)   !! (ndof) [unknown]
    type(report_t), intent(out) :: report

    made%share = 0.5_wp*made%share
    made%gave_way = made%share < least_share
    if (made%gave_way) then
      made%times = made%times - 1
      call put_states(made%last, solution)
    else
      call carry_forward(made, solution)
    end if
    du = made%du
    call evaluate(scene, equations, solution, dt, du, .true., report)
  end subroutine go_back

  !> A step that failed leaves the states it began with.
  subroutine put_back(made, solution)
    type(augmentations_t), intent(in) :: made
    type(solution_t), intent(inout) :: solution

    call put_states(made%first, solution)
  end subroutine put_back

  subroutine put_states(states, solution)
    type(group_state_t), intent(in) :: states(:)
    type(solution_t), intent(inout) :: solution
    integer :: g

    do g = 1, size(states)
      if (allocated(states(g)%committed)) solution%groups(g)%committed = states(g)%committed
    end do
  end subroutine put_states

end module augmentations
