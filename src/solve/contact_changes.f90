!> Which points are in contact, and how: what may change from one iteration to the next.
!>
!> While it does, Newton's method searches for the set of points in contact rather than a zero nearby: its matrix changes at every
!> iteration, and its residual need not fall until the set is found (M. Hintermüller, K. Ito, K. Kunisch, SIAM J. Optim. 13
!> (2003) 865-888: primal-dual active sets are Newton's method).
module contact_changes
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip
  use scene, only: group_t, scene_t
  use solution, only: group_state_t, solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: contact_differs, contact_set, contact_states_t, loses_a_die, note_contact
  public :: recall_contact, remember_contact, touching_dies

  !> Trial states of all groups of contact.
  type :: contact_states_t
    type(group_state_t), allocatable :: groups(:)
  end type contact_states_t

contains

  !> The set as it is now, and whether it is another than before.
  pure subroutine note_contact(scene, solution, set, changed)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, allocatable, intent(inout) :: set(:)   !! (n) status of all points of contact
    logical, intent(out) :: changed
    integer, allocatable :: now(:)

    allocate (now, source=contact_set(scene, solution))
    changed = any(now /= set)
    call move_alloc(now, set)
  end subroutine note_contact

  !> Before another motion is tried: a search asks what was in contact where it begins.
  subroutine remember_contact(scene, solution, states)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_states_t), intent(out) :: states
    integer :: g

    allocate (states%groups(size(scene%groups)))
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die > 0) states%groups(g)%trial = solution%groups(g)%trial
    end do
  end subroutine remember_contact

  !> Back from a motion that is not taken.
  subroutine recall_contact(scene, states, solution)
    type(scene_t), intent(in) :: scene
    type(contact_states_t), intent(inout) :: states
    type(solution_t), intent(inout) :: solution
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%die > 0) call move_alloc(states%groups(g)%trial, solution%groups(g)%trial)
    end do
  end subroutine recall_contact

  !> A die that the sides of a group touched at the start of the step touches none of them in the trial state.
  pure function loses_a_die(scene, solution) result(loses)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: loses
    integer :: g

    loses = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      loses = loses .or. (touches(scene%groups(g), solution%groups(g)%committed) &
                          .and. .not. touches(scene%groups(g), solution%groups(g)%trial))
    end do
  end function loses_a_die

  !> Points and corners of all groups that touch each die in the trial state, or at the start of the step.
  pure function touching_dies(scene, solution, at_start) result(n)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in), optional :: at_start
    integer :: n(size(scene%dies))   !! (ndie)
    logical :: before
    integer :: g

    n = 0
    before = .false.
    if (present(at_start)) before = at_start
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      associate (die => scene%groups(g)%die)
        if (before) then
          n(die) = n(die) + touching(scene%groups(g), solution%groups(g)%committed)
        else
          n(die) = n(die) + touching(scene%groups(g), solution%groups(g)%trial)
        end if
      end associate
    end do
  end function touching_dies

  !> A group of contact is closed somewhere in this state.
  pure function touches(group, state)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (component, point, element)
    logical :: touches

    touches = touching(group, state) > 0
  end function touches

  !> Points and corners of a group of contact that are closed in this state, and open points beside which their side is in contact.
  pure function touching(group, state) result(n)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (component, point, element)
    integer :: n

    associate (variables => group%variables)
      n = count(nint(state(variables(find_variable(variables, 'contact_status'))%first, :, :)) /= contact_open &
                .or. state(variables(find_variable(variables, 'pressure_between'))%first, :, :) > 0)
      if (find_variable(variables, 'corner_place') == 0) return
      n = n + count(nint(state(variables(find_variable(variables, 'corner_contact_status'))%first, :, :)) /= contact_open)
    end associate
  end function touching

  !> Status of all points and corners in the trial state, one after the other: open, stick, slip; slip backwards is negative. What
  !> is in contact between points follows the points of its group.
  pure function contact_set(scene, solution) result(set)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, allocatable :: set(:)
    integer :: g

    allocate (set(0))
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      set = [set, set_of_group(scene%groups(g), solution%groups(g)%trial)]
    end do
  end function contact_set

  !> Some point of contact is another way at the end of the step than at its start.
  pure function contact_differs(scene, solution) result(differs)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: differs
    integer :: g

    differs = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      differs = differs .or. any(set_of_group(scene%groups(g), solution%groups(g)%committed) &
                                 /= set_of_group(scene%groups(g), solution%groups(g)%trial))
    end do
  end function contact_differs

  pure function set_of_group(group, state) result(set)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (component, point, element)
    integer, allocatable :: set(:)

    associate (variables => group%variables)
      set = ways(state(variables(find_variable(variables, 'contact_status'))%first, :, :), &
                 state(variables(find_variable(variables, 'friction'))%first, :, :))
      set = [set, merge(contact_slip, contact_open, &
                        pack(state(variables(find_variable(variables, 'pressure_between'))%first, :, :), .true.) > 0)]
      if (find_variable(variables, 'corner_place') == 0) return
      set = [set, ways(state(variables(find_variable(variables, 'corner_contact_status'))%first, :, :), &
                       state(variables(find_variable(variables, 'corner_friction'))%first, :, :))]
    end associate
  end function set_of_group

  pure function ways(status, friction)
    real(wp), intent(in) :: status(:, :), friction(:, :)
    integer :: ways(size(status))

    ways = reshape(nint(status), [size(status)])
    where (ways == contact_slip .and. reshape(friction < 0, [size(status)])) ways = -ways
  end function ways

end module contact_changes
