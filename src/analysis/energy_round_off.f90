!> Energy that round-off of stresses and strains may be worth.
module energy_round_off
  use equations, only: equations_t
  use kinds, only: eps, wp
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: energy_of_round_off, energy_without_strain, operations, stiffest

  !> Stresses carry some eps of the modulus as round-off, from strains that come from gradients of order one; on the motion of a
  !> step they make work. As many operations as this stand behind a stress and a sum.
  real(wp), parameter :: operations = 1000

contains

  !> Energy below which stresses are round-off: what the motion of the steps may have left of it, and strains of that size.
  pure function energy_of_round_off(scene, equations, solution, volume) result(energy)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: volume   !! of the bodies, per radian when axisymmetric [volume]
    real(wp) :: energy               !! per radian when axisymmetric [energy]

    energy = solution%work%round_off + energy_without_strain(scene, equations, volume)
  end function energy_of_round_off

  !> What round-off of strains may be worth in bodies that have none.
  pure function energy_without_strain(scene, equations, volume, strain) result(energy)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: volume   !! of the bodies, per radian when axisymmetric [volume]
    real(wp), intent(in), optional :: strain   !! that counts as none, where it is not that of round-off [-]
    real(wp) :: energy               !! per radian when axisymmetric [energy]

    energy = stiffest(scene, equations)*volume*(operations*eps)**2
    if (present(strain)) energy = stiffest(scene, equations)*volume*strain**2
  end function energy_without_strain

  !> Largest Young's modulus of the scene's materials at no temperature: the size of a stress.
  pure function stiffest(scene, equations) result(modulus)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp) :: modulus
    real(wp) :: young, poisson
    integer :: m

    modulus = 0
    do m = 1, size(scene%materials)
      associate (law => equations%laws(scene%materials(m)%law_id))
        if (.not. associated(law%elastic)) cycle
        call law%elastic(scene%materials(m), 0.0_wp, young, poisson)
        modulus = max(modulus, young)
      end associate
    end do
  end function stiffest

end module energy_round_off
