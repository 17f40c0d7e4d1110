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
    stress(1) = 2*shear*strain(1) + (bulk - 2*shear/3)*volume
    stress(2) = 2*shear*strain(2) + (bulk - 2*shear/3)*volume
    stress(3) = shear*strain(3)
    stress(4) = 2*shear*strain(4) + (bulk - 2*shear/3)*volume
  end function hooke_stress

  pure function hooke_tangent(bulk, shear) result(tangent)
    real(wp), intent(in) :: bulk, shear
    real(wp) :: tangent(4, 4)
    real(wp) :: across, along

    across = bulk - 2*shear/3
    along = across + 2*shear
    tangent(:, 1) = [along, across, 0.0_wp, across]
    tangent(:, 2) = [across, along, 0.0_wp, across]
    tangent(:, 3) = [0.0_wp, 0.0_wp, shear, 0.0_wp]
    tangent(:, 4) = [across, across, 0.0_wp, along]
  end function hooke_tangent

end module elasticity
