!> Method 0: mean of the nearest integration points, weighted by 1/R^N.
!>
!> Source: D. Shepard, Proc. 23rd ACM Nat. Conf. (1968) 517-524. A constant comes through exactly, a linear field does not:
!> the mean of points on one side only (at a boundary, on a graded mesh) is off by the size of an element.
module transfer_inverse_distance
  use box_tree, only: nearest_items
  use errors, only: error_t
  use kinds, only: wp
  use transfer_api, only: check_materials, transfer_options_t, transfer_t
  use transfer_map, only: start_map, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: transfer_inverse_distance_row

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
    real(wp) :: squares(options%nearest)
    integer :: p, found

    call check_materials(mesh, material, error)
    if (allocated(error)) return
    call start_map(min(options%nearest, mesh%point_trees(material)%n), map)
    !$omp parallel do schedule(static) private(squares, found)
    do p = 1, size(material)
      associate (first => map%first(p), last => map%first(p + 1) - 1)
        call nearest_items(mesh%point_trees(material(p)), points(:, p), found, map%source(first:last), &
                           squares(:last - first + 1))
        call from_distances(squares(:last - first + 1), options%exponent, map%weight(first:last))
      end associate
    end do
    !$omp end parallel do
  end subroutine weights

  !> Weights from squares of distances, nearest first. Distances are taken over the nearest: no overflow, no unit.
  pure subroutine from_distances(squares, exponent, weight)
    real(wp), intent(in) :: squares(:), exponent
    real(wp), intent(out) :: weight(:)

    if (squares(1) > tiny(1.0_wp)) then
      weight = (squares(1)/squares)**(0.5_wp*exponent)
    else
      weight = merge(1.0_wp, 0.0_wp, .not. squares > tiny(1.0_wp))
    end if
    weight = weight/sum(weight)
  end subroutine from_distances

end module transfer_inverse_distance
