!> The path of a material point: strains and stresses that are given, by ramps in time.
!>
!> Strains xx, yy, xy, zz are logarithms of stretches, and for xy the shear gamma: lines of the material along x stay
!> along x, those along y lean towards x. F = (exp xx, gamma exp yy; 0, exp yy), exp zz across. With kinematics that do
!> not follow the geometry they are the small strains, gamma the engineering shear.
module point_paths
  use kinds, only: wp
  use materials, only: material_t
  implicit none
  private
  public :: point_path_t, ramp_t, step_gradient, gradient_of_strain

  !> From what the point is at to what is wanted at `time`, in equal steps.
  type :: ramp_t
    real(wp) :: time = 0.0_wp
    integer :: steps = 1
    !> Of xx, yy, xy, zz: the Cauchy stress is given, not the strain; and the values.
    logical :: stress(4) = .false.
    real(wp) :: values(4) = 0.0_wp
    real(wp) :: temperature = 0.0_wp
    !> Where the deck says so, for messages.
    character(len=:), allocatable :: where_defined
  end type ramp_t

  type :: point_path_t
    character(len=:), allocatable :: title
    integer :: kinematics_id = 0
    type(material_t) :: material
    !> The deck gives temperatures; the one at the start.
    logical :: has_temperature = .false.
    real(wp) :: temperature = 0.0_wp
    type(ramp_t), allocatable :: ramps(:)
  end type point_path_t

contains

  !> f = dx(n+1)/dx(n), components xx, xy, yx, yy, zz, of a step between two strains.
  pure function step_gradient(finite, from, to) result(f)
    logical, intent(in) :: finite
    real(wp), intent(in) :: from(4), to(4)   !! components xx, yy, xy, zz [-]
    real(wp) :: f(5)

    if (finite) then
      f = [exp(to(1) - from(1)), 0.0_wp, 0.0_wp, exp(to(2) - from(2)), exp(to(4) - from(4))]
      f(2) = to(3)*f(4) - from(3)*f(1)
    else
      f = [1 + to(1) - from(1), to(3) - from(3), 0.0_wp, 1 + to(2) - from(2), 1 + to(4) - from(4)]
    end if
  end function step_gradient

  !> d h / d strain, h = dF F^-1 with the components xx, xy, yx, yy, zz.
  pure function gradient_of_strain(finite, strain) result(g)
    logical, intent(in) :: finite
    real(wp), intent(in) :: strain(4)   !! [-]
    real(wp) :: g(5, 4)

    g = 0
    g(1, 1) = 1
    g(4, 2) = 1
    g(2, 3) = 1
    g(5, 4) = 1
    if (finite) g(2, 1:2) = [-strain(3), strain(3)]
  end function gradient_of_strain

end module point_paths
