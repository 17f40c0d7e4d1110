!> Method 0: mean of the nearest integration points, weighted by 1/R^N.
!>
!> Source: D. Shepard, Proc. 23rd ACM Nat. Conf. (1968) 517-524. A constant is transferred exactly, a linear field is not:
!> the mean of points on one side only (at a boundary, on a graded mesh) is off by the size of an element.
module transfer_inverse_distance
  use connected_points, only: nearest_connected
  use errors, only: error_t
  use kinds, only: wp
  use locate_point, only: element_location_t, locate
  use patch_nodes, only: number_nodes, patch_nodes_t
  use transfer_api, only: check_materials, transfer_options_t, transfer_t
  use transfer_map, only: append_rows, start_rows, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: transfer_inverse_distance_row

  !> Points whose rows are appended to the map at once.
  integer, parameter :: block = 512

contains

  function transfer_inverse_distance_row() result(row)
    type(transfer_t) :: row

    row%name = 'INVERSE'
    row%purpose = 'mean of the nearest points, weighted by 1/R^N'
    row%number = 0
    row%exact_degree = 0
    row%weights => weights
  end function transfer_inverse_distance_row

  subroutine weights(mesh, options, points, material, map, error)
    type(transfer_mesh_t), intent(in) :: mesh
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(in) :: points(:, :)
    integer, intent(in) :: material(:)
    type(transfer_map_t), intent(out) :: map
    type(error_t), allocatable, intent(out) :: error
    type(patch_nodes_t) :: nodes
    type(element_location_t) :: location
    integer :: source(options%nearest, block), used(block), p, k, n
    real(wp) :: weight(options%nearest, block), squares(options%nearest)

    call check_materials(mesh, material, error)
    if (allocated(error)) return
    call number_nodes(mesh, nodes)
    n = size(material)
    call start_rows(n, map)
    allocate (map%outside(n), source=0.0_wp)
    allocate (map%degree(n), source=0)
    do p = 0, n - 1, block
      !$omp parallel do schedule(static) private(location, squares)
      do k = 1, min(block, n - p)
        call locate(mesh, material(p + k), points(:, p + k), 0.0_wp, location)
        map%outside(p + k) = location%distance
        call nearest_connected(mesh, nodes, location%element, points(:, p + k), used(k), source(:, k), squares)
        call from_distances(squares(:used(k)), options%exponent, weight(:used(k), k))
      end do
      !$omp end parallel do
      call append_rows(p, source, weight, used(:min(block, n - p)), map)
    end do
  end subroutine weights

  !> Weights from squares of distances, nearest first. Distances are divided by the nearest one: no overflow, no unit.
  pure subroutine from_distances(squares, exponent, weight)
    real(wp), intent(in) :: squares(:), exponent
    real(wp), intent(out) :: weight(:)

    if (squares(1) > tiny(1.0_wp)) then
      weight = (squares(1)/squares)**(0.5_wp*exponent)
    else
      weight = merge(1.0_wp, 0.0_wp,.not. squares > tiny(1.0_wp))
    end if
    weight = weight/sum(weight)
  end subroutine from_distances

end module transfer_inverse_distance
