!> Values at the nodes of a mesh carried to points of another one: the shape functions of the element that holds the point.
!>
!> A field that the elements of the old mesh represent is transferred exactly; for a point outside the nearest element is
!> extrapolated.
module transfer_nodes
  use errors, only: error_t
  use kinds, only: wp
  use locate_point, only: element_location_t, locate
  use shape_functions, only: quad8
  use transfer_api, only: check_materials
  use transfer_map, only: carry, start_map, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: carry_at_nodes, shape_weights

contains

  !> Values at the nodes of an old mesh carried to points of a new one, within each material.
  subroutine carry_at_nodes(mesh, values, new_nodes, new_material, outside, new_values, farthest, error)
    type(transfer_mesh_t), intent(in) :: mesh   !! the old one, with its trees
    real(wp), intent(in) :: values(:, :)        !! (component, nnode) [unit of each component]
    real(wp), intent(in) :: new_nodes(:, :)     !! (2, n) coordinates [length]
    integer, intent(in) :: new_material(:)      !! (n)
    real(wp), intent(in) :: outside             !! how far an element is extrapolated, in halves of an element
    real(wp), intent(out) :: new_values(:, :)   !! (component, n) [unit of each component]
    real(wp), intent(out) :: farthest           !! distance of the farthest new node outside the old mesh [length]
    type(error_t), allocatable, intent(out) :: error
    type(transfer_map_t) :: map

    new_values = 0
    farthest = 0
    call shape_weights(mesh, mesh%connectivity, new_nodes, new_material, outside, map, error)
    if (allocated(error)) return
    call carry(map, values, new_values)
    if (size(map%outside) > 0) farthest = maxval(map%outside)
  end subroutine carry_at_nodes

  !> Weights of the `columns` of the old elements: its connectivity, where values belong to nodes.
  subroutine shape_weights(mesh, columns, points, material, outside, map, error)
    type(transfer_mesh_t), intent(in) :: mesh   !! the old one, with its trees
    integer, intent(in) :: columns(:, :)        !! (8, nelem)
    real(wp), intent(in) :: points(:, :)        !! (2, n) [length]
    integer, intent(in) :: material(:)          !! (n)
    real(wp), intent(in) :: outside             !! how far an element is extrapolated, in halves of an element
    type(transfer_map_t), intent(out) :: map
    type(error_t), allocatable, intent(out) :: error
    type(element_location_t) :: location
    real(wp) :: dphi(2, 8)
    integer :: p

    call check_materials(mesh, material, error)
    if (allocated(error)) return
    call start_map(spread(8, 1, size(material)), map)
    !$omp parallel do schedule(static) private(location, dphi)
    do p = 1, size(material)
      call locate(mesh, material(p), points(:, p), outside, location)
      map%source(8*p - 7:8*p) = columns(:, location%element)
      call quad8(location%xi(1), location%xi(2), map%weight(8*p - 7:8*p), dphi)
      map%outside(p) = location%distance
    end do
    !$omp end parallel do
  end subroutine shape_weights

end module transfer_nodes
