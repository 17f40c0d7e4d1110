!> Points of a side in contact in the present geometry, with derivatives along the local unknowns.
!>
!> These are those of the side (x of its nodes, y of them), then those of what it meets (the
!> pilot of a rigid die, or the nodes of another body's side), then the section; the last three are
!> there in generalised plane strain only, and always the last.
module side_points
  use kinds, only: wp
  use scene, only: scene_t
  use sections, only: thickness_at
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: contact_point_t, area_at, side_length, side_point, thinning
  public :: most_unknowns, no_surface, touching

  !> Six of a side, six of what it meets, three of the section.
  integer, parameter :: most_unknowns = 15

  !> A radius below this share of the side is the axis.
  real(wp), parameter :: no_surface = 1.0e-9_wp
  !> Depth below this share of the side is round-off of coordinates: the point just touches.
  real(wp), parameter :: touching = 1.0e-12_wp

  !> A point of the side in the present geometry, with derivatives along the local unknowns.
  type :: contact_point_t
    real(wp) :: x(2), tangent(2), length, e_r(2), thickness
    real(wp), dimension(most_unknowns) :: dlength, dthickness
    real(wp) :: dx(2, most_unknowns)
  end type contact_point_t

contains

  !> Position, length, inner normal and thickness of a point of the side, and their derivatives.
  pure subroutine side_point(phi, dphi, section, x, du, nunknown, point)
    real(wp), intent(in) :: phi(3), dphi(3)   !! [-]
    real(wp), intent(in) :: section(3)        !! at the end of the step: thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)           !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(6)             !! their motion, x then y [length]
    integer, intent(in) :: nunknown           !! local unknowns, the section's three among them
    type(contact_point_t), intent(out) :: point
    real(wp) :: y(2, 3)

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    point%x = matmul(y, phi)
    point%tangent = matmul(y, dphi)
    point%length = length_of(point%tangent)
    point%e_r = 0
    point%thickness = thickness_at(section, point%x)
    point%dx = 0
    point%dlength = 0
    point%dthickness = 0
    point%dx(1, 1:3) = phi
    point%dx(2, 4:6) = phi
    point%dthickness(1:3) = section(2)*phi
    point%dthickness(4:6) = section(3)*phi
    point%dthickness(nunknown - 2:nunknown) = [1.0_wp, point%x]
    ! no tangent, no normal: at an end whose middle node is at a quarter of the side
    if (.not. point%length > 0) return
    point%e_r = [-point%tangent(2), point%tangent(1)]/point%length
    point%dlength(1:3) = dphi*point%tangent(1)/point%length
    point%dlength(4:6) = dphi*point%tangent(2)/point%length
  end subroutine side_point

  !> Area before the step over the present one, at points of a side.
  pure function thinning(from, to, section, thickening, x, du) result(share)
    real(wp), intent(in) :: from(:)         !! (npoint) parent coordinates on the side before the step [-]
    real(wp), intent(in) :: to(:)           !! (npoint) parent coordinates now [-]
    real(wp), intent(in) :: section(3)      !! at the end of the step: thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: thickening(3)   !! its change in the step: thickness [length], slopes [-]
    real(wp), intent(in) :: x(2, 3)         !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(6)           !! their motion, x then y [length]
    real(wp) :: share(size(to))
    real(wp) :: y(2, 3), area
    integer :: p

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    do p = 1, size(to)
      area = area_at(to(p), section, y)
      ! on the axis there is no area, before or after
      share(p) = 1
      if (area > 0) share(p) = area_at(from(p), section - thickening, x)/area
    end do
  end function thinning

  !> Area of a side per unit of xi at a parent coordinate: length times thickness.
  pure function area_at(xi, section, x) result(area)
    real(wp), intent(in) :: xi           !! [-]
    real(wp), intent(in) :: section(3)   !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)      !! nodes [length]
    real(wp) :: area
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    area = length_of(matmul(x, dphi))*thickness_at(section, matmul(x, phi))
  end function area_at

  !> Chord of a side in the mesh as it began.
  pure function side_length(scene, nodes) result(length)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: nodes(3)
    real(wp) :: length

    length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
  end function side_length

end module side_points
