!> Nodes and the named sets of sides that cards refer to.
module mesh
  use kinds, only: wp
  use vectors, only: length_of
  implicit none
  private
  public :: mesh_t, side_set_t, find_side_set, nodes_of_sides, nearest_node

  !> Sides of elements on a boundary, each traversed with the part on its left.
  type :: side_set_t
    character(len=:), allocatable :: name
    !> Nodes (3, n): first end, middle, second end.
    integer, allocatable :: nodes(:, :)
  end type side_set_t

  type :: mesh_t
    !> Coordinates (2, nnode) at the start of this mesh [length].
    real(wp), allocatable :: coordinates(:, :)
    !> Where the material of each node was when the deck's own mesh began (2, nnode) [length]: cards name positions there.
    real(wp), allocatable :: origin(:, :)
    !> Number the user knows the node by (nnode).
    integer, allocatable :: labels(:)
    type(side_set_t), allocatable :: sides(:)
  end type mesh_t

contains

  !> Place of a set of sides, 0 when there is none of that name.
  pure function find_side_set(mesh, name) result(k)
    type(mesh_t), intent(in) :: mesh
    character(len=*), intent(in) :: name
    integer :: k

    do k = 1, size(mesh%sides)
      if (mesh%sides(k)%name == name) return
    end do
    k = 0
  end function find_side_set

  !> Nodes of some sides, each once, in the order met.
  pure subroutine nodes_of_sides(sides, nnode, nodes)
    integer, intent(in) :: sides(:, :)   !! (3, nside)
    integer, intent(in) :: nnode
    integer, allocatable, intent(out) :: nodes(:)   !! (n)
    logical :: seen(nnode)
    integer :: i, j, n
    integer :: list(size(sides))

    seen = .false.
    n = 0
    do j = 1, size(sides, 2)
      do i = 1, size(sides, 1)
        if (seen(sides(i, j))) cycle
        seen(sides(i, j)) = .true.
        n = n + 1
        list(n) = sides(i, j)
      end do
    end do
    nodes = list(:n)
  end subroutine nodes_of_sides

  !> Node closest to a point, and its distance.
  pure subroutine nearest_node(coordinates, point, node, distance)
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) [length]
    real(wp), intent(in) :: point(2)            !! [length]
    integer, intent(out) :: node
    real(wp), intent(out) :: distance   !! [length]
    integer :: i
    real(wp) :: d

    node = 0
    distance = huge(1.0_wp)
    do i = 1, size(coordinates, 2)
      d = length_of(coordinates(:, i) - point)
      if (d < distance) then
        distance = d
        node = i
      end if
    end do
  end subroutine nearest_node

end module mesh
