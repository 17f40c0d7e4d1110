!> Free dies that nothing holds: no spring, no body that they touch.
module untouched_dies
  use contact_changes, only: touching_dies
  use contact_outlook, only: gaps_at_rest
  use kinds, only: wp
  use scene, only: role_contact, role_spring, scene_t
  use scene_as_it_stands, only: present_scene
  use solution, only: solution_t
  implicit none
  private
  public :: untouched_die_advice

  !> A die touches a side where it is no farther off than this share of the side's length: contact that begins with the first step
  !> is open before it.
  real(wp), parameter :: lies_on = 1.0e-3_wp
  character(len=*), parameter :: names(3) = ['X', 'Y', 'A']

contains

  !> What the first such die needs; nothing where there is none.
  function untouched_die_advice(scene, solution) result(advice)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice
    integer :: touched(size(scene%dies))
    integer :: k

    advice = ''
    if (size(scene%die_forces) == 0) return
    touched = touching_dies(scene, solution, at_start=.true.)
    do k = 1, size(scene%die_forces)
      associate (die => scene%die_forces(k)%die, component => scene%die_forces(k)%component)
        if (touched(die) > 0) cycle
        if (has_spring(scene, die, component)) cycle
        if (lies_on_a_side(scene, solution, die)) cycle
        advice = 'die '//scene%dies(die)%name//' is free along '//names(component)//' and touches nothing: a SPRNG card holds it ' &
                 //'until it does; '
        return
      end associate
    end do
  end function untouched_die_advice

  pure function has_spring(scene, die, component) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die, component
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        yes = yes .or. (group%role == role_spring .and. group%die == die .and. group%component == component)
      end associate
    end do
  end function has_spring

  !> Some side that faces the die is no farther from it than a side that touches.
  function lies_on_a_side(scene, solution, die) result(lies)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: die
    logical :: lies
    type(scene_t) :: now
    real(wp), allocatable :: gaps(:, :), over_sides(:, :)
    integer :: g

    lies = .false.
    now = present_scene(scene, solution)
    do g = 1, size(now%groups)
      if (now%groups(g)%role /= role_contact .or. now%groups(g)%die /= die) cycle
      call gaps_at_rest(now, now%groups(g), gaps, over_sides)
      lies = lies .or. any(over_sides < lies_on)
    end do
  end function lies_on_a_side

end module untouched_dies
