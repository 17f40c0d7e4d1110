!> Values at the nodes of a mesh carried to points of another one: the shape functions of the element that holds the point.
!>
!> A field that the elements of the old mesh represent comes through exactly; a point outside takes the nearest element, prolonged.
module transfer_nodes
  use errors, only: error_t
  use kinds, only: wp
  use locate_point, only: locate, place_t
  use shape_functions, only: quad8
  use transfer_api, only: check_materials
  use transfer_map, only: start_map, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: shape_weights

contains

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
