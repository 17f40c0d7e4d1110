!> The third direction of a plane scene: thickness t(x, y) = a1 + a2 x + a3 y at present coordinates.
!>
!> One formula for all plane states: plane strain has a = (thickness, 0, 0), held; an axisymmetric
!> scene a = (0, 1, 0), held, so that t is the radius and all is per radian; generalised plane strain
!> has a = thickness (1 + E, KX, KY), unknowns of the whole scene. In plane stress a = (thickness, 0, 0)
!> is the thickness at the start, and each point has a stretch of its own.
!> Source: for generalised plane strain, Charlier's BWD elements of LAGAMINE: thickness alpha_0 + alpha_1 x + alpha_2 y.
module sections
  use kinds, only: wp
  implicit none
  private
  public :: section_drive_t, thickness_at
  public :: section_held, section_moved, section_forced, section_names, section_motions, section_loads

  !> What drives a component of the section: nothing moves it; its motion is given; its load is given.
  integer, parameter :: section_held = 1
  integer, parameter :: section_moved = 2
  integer, parameter :: section_forced = 3
  !> Components: strain of the section, curvatures along x and y.
  character(len=2), parameter :: section_names(3) = ['E ', 'KX', 'KY']
  !> Columns of the history: the motion of each component, and its load.
  character(len=19), parameter :: section_motions(3) = ['section_strain     ', 'section_curvature_x', 'section_curvature_y']
  character(len=19), parameter :: section_loads(3) = ['section_force      ', 'section_moment_x   ', 'section_moment_y   ']

  type :: section_drive_t
    integer :: kind = section_held
    !> Motion (E, KX or KY) or load (axial force, moment of the axial stress about y or x) by amplitude times multiplier.
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
  end type section_drive_t

contains

  !> Thickness of the section `a` at a point.
  pure function thickness_at(a, point) result(t)
    real(wp), intent(in) :: a(3)       !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: point(2)   !! [length]
    real(wp) :: t

    t = a(1) + a(2)*point(1) + a(3)*point(2)
  end function thickness_at

end module sections
