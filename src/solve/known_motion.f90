!> What is known of the motion of a step before it is solved for: that of prescribed unknowns, of unknowns of other solves, of dies
!> that leave the part, and what turns back; else the last motion, in proportion.
module known_motion
  use dofs, only: dofs_t
  use equations, only: equations_t
  use fields, only: displacement_field, field_t, pilot_field
  use kinds, only: wp
  use prescribed_unknowns, only: prescribed_motion
  use scene, only: scene_t
  use solution, only: solution_t
  use turning_back, only: reversed_unknowns, turn_back
  implicit none
  private
  public :: known_motion_t, find_known_motion, find_missing_motion, proportion

  !> A missing motion below this share of the motion is round-off: of times, and of their differences.
  real(wp), parameter :: round_off = 1.0e-10_wp

  type :: known_motion_t
    !> Unknowns (ndof) that are given; that belong to dies where they go; that turn back; that do not, where others do.
    logical, allocatable :: fixed(:), at_place(:), back(:), staying(:)
    !> Dies that turn back (ndie).
    logical, allocatable :: dies(:)
    !> The start is that of an earlier turn.
    logical :: goes_on = .false.
    !> Motion of prescribed unknowns in the step (nprescribed) [unknown].
    real(wp), allocatable :: motion(:)
    !> Length of the step over that of the last one, 0 without one [-].
    real(wp) :: ratio = 0.0_wp
  end type known_motion_t

contains

  subroutine find_known_motion(scene, equations, solution, dt, go_on, left, known)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                 !! [time]
    logical, intent(in), optional :: go_on     !! start from what is given for the own unknowns too
    logical, intent(in), optional :: left(:)   !! (ndie) dies that leave the part: they start where they go
    type(known_motion_t), intent(out) :: known
    integer :: n

    n = equations%dofs%ndof
    allocate (known%fixed(n), known%at_place(n), known%back(n), known%staying(n), known%dies(size(scene%dies)), &
              known%motion(size(equations%dofs%prescribed)))
    ! what moves at once does so in the first step, not while equilibrium is restored at fixed time
    call prescribed_motion(scene, equations%dofs, solution%fields, dt > 0 .and. .not. solution%last_step > 0, solution%time, &
                           solution%time + dt, known%motion)
    if (present(go_on)) known%goes_on = go_on
    known%fixed = .not. equations%solves(equations%now)%is_own .or. known%goes_on
    call place_leaving_dies(equations%dofs, left, known%at_place)
    if (solution%last_step > 0) known%ratio = dt/solution%last_step
    call find_turning(scene, equations%dofs, solution, known)
  end subroutine find_known_motion

  !> Unknowns of dies that leave the part.
  pure subroutine place_leaving_dies(dofs, left, at_place)
    type(dofs_t), intent(in) :: dofs
    logical, intent(in), optional :: left(:)   !! (ndie)
    logical, intent(out) :: at_place(:)        !! (ndof)
    integer :: k

    at_place = .false.
    if (.not. present(left)) return
    associate (pilot => dofs%fields(pilot_field)%number)
      do k = 1, size(left)
        if (left(k)) at_place(pack(pilot(:, k), pilot(:, k) > 0)) = .true.
      end do
    end associate
  end subroutine place_leaving_dies

  !> What turns back: dies and supports that do so, and what they move. Where anything does, other motions stay as they are.
  subroutine find_turning(scene, dofs, solution, known)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    type(known_motion_t), intent(inout) :: known
    logical :: turning(size(known%back))
    real(wp) :: before(size(known%back))

    known%back = known%at_place
    if (.not. known%goes_on .and. known%ratio > 0) then
      call proportion(dofs, solution%fields, known%ratio, before)
      known%back = known%back .or. reversed_unknowns(dofs, before, known%motion)
    end if
    call turn_back(scene, dofs, solution, known%back, turning, known%dies)
    known%back = turning
    known%staying = .false.
    if (any(known%back)) known%staying = is_motion(dofs) .and. .not. known%back
  end subroutine find_turning

  !> Unknowns of nodes and of dies that are motions (ndof).
  pure function is_motion(dofs) result(yes)
    type(dofs_t), intent(in) :: dofs
    logical :: yes(dofs%ndof)
    integer :: f

    yes = .false.
    do f = 1, size(dofs%fields)
      if (f /= displacement_field .and. f /= pilot_field) cycle
      associate (number => dofs%fields(f)%number)
        yes(pack(number, number > 0)) = .true.
      end associate
    end do
  end function is_motion

  !> What prescribed unknowns miss of their motion; a rest that is round-off is made now.
  pure subroutine find_missing_motion(equations, known, du, missing)
    type(equations_t), intent(in) :: equations
    type(known_motion_t), intent(in) :: known
    real(wp), intent(inout) :: du(:)      !! (ndof) [unknown]
    real(wp), intent(out) :: missing(:)   !! (ndof) [unknown]
    integer :: i

    missing = 0
    do i = 1, size(known%motion)
      associate (d => equations%dofs%prescribed(i)%dof, motion => known%motion(i))
        if (.not. equations%solves(equations%now)%is_own(d)) cycle
        missing(d) = motion - du(d)
        if (abs(missing(d)) > round_off*abs(motion)) cycle
        du(d) = motion
        missing(d) = 0
      end associate
    end do
  end subroutine find_missing_motion

  !> The last accepted motion of all unknowns times `ratio`.
  pure subroutine proportion(dofs, fields, ratio, du)
    type(dofs_t), intent(in) :: dofs
    type(field_t), intent(in) :: fields(:)   !! (nfield)
    real(wp), intent(in) :: ratio
    real(wp), intent(out) :: du(:)   !! (ndof) [unknown]
    integer :: f, k, c

    do f = 1, size(fields)
      associate (number => dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (number(c, k) > 0) du(number(c, k)) = ratio*fields(f)%last_increment(c, k)
          end do
        end do
      end associate
    end do
  end subroutine proportion

end module known_motion
