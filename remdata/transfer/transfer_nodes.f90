!> Values at the nodes of a mesh carried to points of another one: the shape functions of the element that holds the point.
!>
!> A field that the elements of the old mesh represent comes through exactly; a point outside takes the nearest element, prolonged.
module transfer_nodes
  use errors, only: error_t
  use kinds, only: wp
  use locate_point, only: locate, place_t
  use shape_functions, only: quad8
  use transfer_api, only: check_materials
  use transfer_map, only: carry, start_map, transfer_map_t
  use transfer_mesh, only: plant_mesh_trees, set_up_mesh, transfer_mesh_t
  implicit none
  private
  public :: carry_nodal, carry_at_nodes, shape_weights

  !> Any rule will do: nodal fields do not look at integration points.
  integer, parameter :: any_rule = 4

contains

  !> Values (component, node) of an old mesh carried to the nodes of a new one, within each material (all 1: the whole mesh is one).
  subroutine carry_nodal(nodes, connectivity, material, values, new_nodes, new_material, outside, new_values, farthest, error)
    real(wp), intent(in) :: nodes(:, :)              !! (2, nnode) of the old mesh [length]
    integer, intent(in) :: connectivity(:, :)        !! (8, nelem)
    integer, intent(in) :: material(:)               !! (nelem)
    real(wp), intent(in) :: values(:, :)             !! (component, nnode)
    real(wp), intent(in) :: new_nodes(:, :)          !! (2, n) [length]
    integer, intent(in) :: new_material(:)           !! (n)
    real(wp), intent(in) :: outside                  !! how far an element is prolonged, in halves of an element
    real(wp), intent(out) :: new_values(:, :)        !! (component, n)
    real(wp), intent(out) :: farthest                !! new node outside the old mesh [length]
    type(error_t), allocatable, intent(out) :: error
    type(transfer_mesh_t) :: mesh

    call set_up_mesh(nodes, connectivity, material, spread(any_rule, 1, size(material)), .false., mesh)
    call plant_mesh_trees(mesh)
    call carry_at_nodes(mesh, values, new_nodes, new_material, outside, new_values, farthest, error)
  end subroutine carry_nodal

  !> The same where the trees of the old mesh are planted already.
  subroutine carry_at_nodes(mesh, values, new_nodes, new_material, outside, new_values, farthest, error)
    type(transfer_mesh_t), intent(in) :: mesh
    real(wp), intent(in) :: values(:, :), new_nodes(:, :)   !! as above
    integer, intent(in) :: new_material(:)
    real(wp), intent(in) :: outside
    real(wp), intent(out) :: new_values(:, :), farthest
    type(error_t), allocatable, intent(out) :: error
    type(transfer_map_t) :: map

    new_values = 0
    farthest = 0
    call shape_weights(mesh, mesh%connectivity, new_nodes, new_material, outside, map, error)
    if (allocated(error)) return
    call carry(map, values, new_values)
    if (size(map%outside) > 0) farthest = maxval(map%outside)
  end subroutine carry_at_nodes

  !> Weights of the columns `places` (8, nelem) of the old elements: its connectivity, where values belong to nodes.
  subroutine shape_weights(mesh, places, points, material, outside, map, error)
    type(transfer_mesh_t), intent(in) :: mesh   !! the old one, its trees planted
    integer, intent(in) :: places(:, :)
    real(wp), intent(in) :: points(:, :)        !! (2, n) [length]
    integer, intent(in) :: material(:)          !! (n)
    real(wp), intent(in) :: outside             !! how far an element is prolonged, in halves of an element
    type(transfer_map_t), intent(out) :: map
    type(error_t), allocatable, intent(out) :: error
    type(place_t) :: place
    real(wp) :: dphi(2, 8)
    integer :: p

    call check_materials(mesh, material, error)
    if (allocated(error)) return
    call start_map(spread(8, 1, size(material)), map)
    !$omp parallel do schedule(static) private(place, dphi)
    do p = 1, size(material)
      call locate(mesh, material(p), points(:, p), outside, place)
      map%source(8*p - 7:8*p) = places(:, place%element)
      call quad8(place%xi(1), place%xi(2), map%weight(8*p - 7:8*p), dphi)
      map%outside(p) = place%distance
    end do
    !$omp end parallel do
  end subroutine shape_weights

end module transfer_nodes
