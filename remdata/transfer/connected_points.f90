!> The nearest integration points that are connected with a point through elements: points across a slit or a closed fold of the
!> same material are near, but their values are independent.
!>
!> A point is connected if its element is reached from the element that contains the target in few steps from element to element
!> over common nodes. On meshes without slits the nearest points are all reached.
module connected_points
  use box_tree, only: insert, nearest_items
  use kinds, only: wp
  use patch_nodes, only: patch_nodes_t, widen
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: nearest_connected

  !> Largest number of steps from element to element: the 64 nearest points of a grid with 2 x 2 points in an element are within 3.
  integer, parameter :: most_steps = 4
  !> Largest number of elements reached: 81 in a grid.
  integer, parameter :: most_elements = 160
  !> Searches, the second for twice as many points as the first. Where these are not enough, because many small elements lie on the
  !> other side, all points of the elements reached are compared.
  integer, parameter :: searches = 2

contains

  !> As nearest_items, but only of points reached from an element.
  pure subroutine nearest_connected(mesh, nodes, element, point, found, items, squares)
    type(transfer_mesh_t), intent(in) :: mesh
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(in) :: element     !! that contains the point
    real(wp), intent(in) :: point(2)   !! [length]
    integer, intent(out) :: found
    integer, intent(out) :: items(:)      !! (n) as many as requested
    real(wp), intent(out) :: squares(:)   !! (n) of the distances [length^2]
    integer :: near(size(items)*2**(searches - 1)), elements(most_elements), n, steps, requested, got, search, k, p
    real(wp) :: distances(size(near))
    logical :: reached

    elements = 0
    elements(1) = element
    n = 1
    steps = 0
    requested = size(items)
    do search = 1, searches
      call nearest_items(mesh%point_trees(mesh%material(element)), point, got, near(:requested), distances(:requested))
      found = 0
      items = 0
      squares = huge(1.0_wp)
      do k = 1, got
        do
          reached = any(elements(:n) == mesh%point_element(near(k)))
          if (reached .or. steps == most_steps) exit
          call widen(nodes, elements, n)
          steps = steps + 1
        end do
        if (.not. reached) cycle
        call insert(near(k), distances(k), found, items, squares)
        if (found == size(items)) return
      end do
      if (got < requested) return
      requested = 2*requested
    end do
    found = 0
    items = 0
    squares = huge(1.0_wp)
    do k = 1, n
      do p = mesh%first_point(elements(k)), mesh%first_point(elements(k) + 1) - 1
        call insert(p, sum((mesh%points(:, p) - point)**2), found, items, squares)
      end do
    end do
  end subroutine nearest_connected

end module connected_points
