!> What the weak springs of bodies (SPRNG) do at the end of a run: they hold a body before dies do, and must not count after.
module spring_check
  use elem_body_springs, only: springs_of_body
  use energy_books, only: spring_energy
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: has_body_springs, spring_advice, spring_force, spring_share

  !> The run warns above this share of the largest force.
  real(wp), parameter :: largest_share = 1.0e-3_wp

contains

  !> The scene has weak springs.
  pure function has_body_springs(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes

    yes = any(scene%groups%is_spring)
  end function has_body_springs

  !> Largest force of the springs of a body in a direction now, per radian when axisymmetric [force].
  pure function spring_force(scene, solution) result(largest)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: largest
    real(wp) :: force, energy
    integer :: g

    largest = 0
    do g = 1, size(scene%groups)
      if (.not. scene%groups(g)%is_spring) cycle
      call springs_of_body(scene, scene%groups(g), solution%fields(displacement_field)%value, force, energy)
      largest = max(largest, abs(force))
    end do
  end function spring_force

  !> This force over the largest of a die so far; where no die has been pressed, the energy of the springs over all that passed.
  pure function spring_share(scene, solution) result(share)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: share

    share = 0
    if (solution%largest_force > 0) then
      share = spring_force(scene, solution)/solution%largest_force
    else if (solution%work%passed > 0) then
      share = spring_energy(scene, solution)/solution%work%passed
    end if
  end function spring_share

  !> Empty where the springs are weak.
  pure function spring_advice(scene, solution) result(advice)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice

    advice = ''
    if (spring_share(scene, solution) > largest_share) &
      advice = 'springs that hold a body (SPRNG) carry a part of the load: take a stiffness smaller by this, and compare'
  end function spring_advice

end module spring_check
