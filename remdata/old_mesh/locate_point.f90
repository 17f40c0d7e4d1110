!> Location of a point in a mesh: the element and the parent coordinates.
!>
!> Elements are found by `nearest_element`; outside of them the nearest one is extrapolated.
module locate_point
  use kinds, only: wp
  use nearest_element, only: at_rest, find_element, full_step, most_iterations
  use shape_functions, only: quad8
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: element_location_t, locate

  type :: element_location_t
    integer :: element = 0
    !> Parent coordinates; outside the square by at most the extrapolation allowed where the point lies outside the mesh.
    real(wp) :: xi(2) = 0.0_wp
    !> Distance of the point to the mesh, 0 inside [length].
    real(wp) :: distance = 0.0_wp
  end type element_location_t

contains

  !> Location of a point among the elements of its material. Outside of them the nearest element is extrapolated by at most
  !> `outside` (1 is half an element); farther away the value is that of the last location reached.
  pure subroutine locate(mesh, material, point, outside, location)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material
    real(wp), intent(in) :: point(2), outside   !! coordinates [length]; limit of the extrapolation [-]
    type(element_location_t), intent(out) :: location

    if (material < 1 .or. material > mesh%nmaterial) return
    call find_element(mesh%nodes, mesh%connectivity, mesh%element_trees(material), point, location%element, location%xi, &
                      location%distance)
    if (location%distance > 0) call prolong(mesh%nodes(:, mesh%connectivity(:, location%element)), point, outside, location%xi)
  end subroutine locate

  !> Extrapolation beyond the element by Newton's method from its side, limited to the allowed distance.
  pure subroutine prolong(x, point, outside, xi)
    real(wp), intent(in) :: x(2, 8), point(2), outside
    real(wp), intent(inout) :: xi(2)
    real(wp) :: phi(8), dphi(2, 8), step(2)
    integer :: iteration

    do iteration = 1, most_iterations
      call quad8(xi(1), xi(2), phi, dphi)
      step = full_step(matmul(x, transpose(dphi)), point - matmul(x, phi))
      step = max(-1 - outside - xi, min(1 + outside - xi, step))
      xi = xi + step
      if (maxval(abs(step)) <= at_rest) exit
    end do
  end subroutine prolong

end module locate_point
