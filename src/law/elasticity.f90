!> Isotropic linear elasticity, shared by the solid laws.
!> Components xx, yy, xy, zz; engineering shear.
module elasticity
  use kinds, only: wp
  implicit none
  private
  public :: moduli, hooke_stress, hooke_tangent

contains

  !> Bulk and shear modulus from Young's modulus and Poisson's ratio.
  pure subroutine moduli(young, poisson, bulk, shear)
    real(wp), intent(in) :: young, poisson
    real(wp), intent(out) :: bulk, shear

    bulk = young/(3*(1 - 2*poisson))
    shear = young/(2*(1 + poisson))
  end subroutine moduli

  pure function hooke_stress(bulk, shear, strain) result(stress)
    real(wp), intent(in) :: bulk, shear   !! [stress]
    real(wp), intent(in) :: strain(4)     !! engineering shear [-]
    real(wp) :: stress(4)
    real(wp) :: volume

    volume = strain(1) + strain(2) + strain(4)
    stress = 2*shear*strain
    stress(3) = shear*strain(3)
    stress([1, 2, 4]) = stress([1, 2, 4]) + (bulk - 2*shear/3)*volume
  end function hooke_stress

  pure function hooke_tangent(bulk, shear) result(tangent)
    real(wp), intent(in) :: bulk, shear
    real(wp) :: tangent(4, 4)
    integer, parameter :: normal(3) = [1, 2, 4]
    integer :: i

    tangent = 0
    tangent(normal, normal) = bulk - 2*shear/3
    do i = 1, 3
      tangent(normal(i), normal(i)) = tangent(normal(i), normal(i)) + 2*shear
    end do
    tangent(3, 3) = shear
  end function hooke_tangent

end module elasticity
