!> Connected parts: nodes that elements join belong to one body.
module bodies
  use scene, only: is_solid, scene_t
  implicit none
  private
  public :: bodies_of_nodes, elements_at_middles

contains

  !> The body of every node (nnode): the lowest number of its nodes.
  pure function bodies_of_nodes(scene) result(body)
    type(scene_t), intent(in) :: scene
    integer :: body(size(scene%mesh%coordinates, 2))
    integer :: g, e, i, k

    body = [(k, k=1, size(body))]
    do g = 1, size(scene%groups)
      associate (nodes => scene%groups(g)%connectivity)
        if (scene%groups(g)%die > 0) cycle
        do e = 1, size(nodes, 2)
          do i = 2, size(nodes, 1)
            call join(nodes(1, e), nodes(i, e), body)
          end do
        end do
      end associate
    end do
    do k = 1, size(body)
      body(k) = root(body, k)
    end do
  end function bodies_of_nodes

  !> How many elements of bodies have each node in the middle of a side (nnode): 1 on free sides and on those of other parts.
  pure function elements_at_middles(scene, only_of) result(number)
    type(scene_t), intent(in) :: scene
    integer, intent(in), optional :: only_of   !! the elements of this group alone are counted
    integer :: number(size(scene%mesh%coordinates, 2))
    integer :: g, e

    number = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      if (present(only_of)) then
        if (g /= only_of) cycle
      end if
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (middle => scene%groups(g)%connectivity(5:8, e))
          number(middle) = number(middle) + 1
        end associate
      end do
    end do
  end function elements_at_middles

  !> The lower root becomes the parent of the higher one.
  pure subroutine join(a, b, parent)
    integer, intent(in) :: a, b
    integer, intent(inout) :: parent(:)
    integer :: low, high

    low = min(root(parent, a), root(parent, b))
    high = max(root(parent, a), root(parent, b))
    parent(high) = low
    parent(a) = low
    parent(b) = low
  end subroutine join

  pure function root(parent, k) result(r)
    integer, intent(in) :: parent(:), k
    integer :: r

    r = k
    do while (parent(r) /= r)
      r = parent(r)
    end do
  end function root

end module bodies
