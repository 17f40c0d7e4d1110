!> Nodes of each material with the elements around them. A node between two materials has an entry in each.
module patch_nodes
  use shape_functions, only: quad8_side
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: patch_nodes_t, number_nodes, around_node, widen

  type :: patch_nodes_t
    !> Entries of the nodes of the elements in the lists below (8, nelem).
    integer, allocatable :: entries(:, :)
    !> Node of the mesh at each entry, and the entries of the ends of its side (itself twice for a corner) (2, n).
    integer, allocatable :: node(:), ends(:, :)
    !> Elements around entry k: elements(first(k)) ... elements(first(k + 1) - 1).
    integer, allocatable :: first(:), elements(:)
  end type patch_nodes_t

contains

  pure subroutine number_nodes(mesh, nodes)
    type(transfer_mesh_t), intent(in) :: mesh
    type(patch_nodes_t), intent(out) :: nodes
    integer, dimension(size(mesh%connectivity)) :: node, material, next
    integer :: head(size(mesh%nodes, 2)), e, a, s, k, n, nelem

    nelem = size(mesh%material)
    allocate (nodes%entries(8, nelem))
    head = 0
    n = 0
    do e = 1, nelem
      do a = 1, 8
        k = head(mesh%connectivity(a, e))
        do while (k > 0)
          if (material(k) == mesh%material(e)) exit
          k = next(k)
        end do
        if (k == 0) then
          n = n + 1
          k = n
          node(k) = mesh%connectivity(a, e)
          material(k) = mesh%material(e)
          next(k) = head(node(k))
          head(node(k)) = k
        end if
        nodes%entries(a, e) = k
      end do
    end do
    allocate (nodes%node(n), source=node(:n))
    allocate (nodes%ends(2, n))
    do e = 1, nelem
      do s = 1, 4
        nodes%ends(:, nodes%entries(quad8_side(1, s), e)) = nodes%entries(quad8_side(1, s), e)
        nodes%ends(:, nodes%entries(quad8_side(2, s), e)) = nodes%entries(quad8_side([1, 3], s), e)
      end do
    end do
    call list_elements(nodes)
  end subroutine number_nodes

  !> Elements around each entry, sorted.
  pure subroutine list_elements(nodes)
    type(patch_nodes_t), intent(inout) :: nodes
    integer :: fill(size(nodes%node)), e, a, k, n

    n = size(nodes%node)
    allocate (nodes%first(n + 1), nodes%elements(size(nodes%entries)))
    fill = 0
    do e = 1, size(nodes%entries, 2)
      fill(nodes%entries(:, e)) = fill(nodes%entries(:, e)) + 1
    end do
    nodes%first(1) = 1
    do k = 1, n
      nodes%first(k + 1) = nodes%first(k) + fill(k)
    end do
    fill = nodes%first(:n)
    do e = 1, size(nodes%entries, 2)
      do a = 1, 8
        k = nodes%entries(a, e)
        nodes%elements(fill(k)) = e
        fill(k) = fill(k) + 1
      end do
    end do
  end subroutine list_elements

  !> Elements around a corner, or around both ends of the side of a mid node: as many as there is room for.
  pure subroutine around_node(nodes, entry, elements, n)
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(in) :: entry
    integer, intent(out) :: elements(:), n   !! (n) as many as there is room for; number found

    elements = 0
    n = 0
    call add_around(nodes, nodes%ends(1, entry), elements, n)
    call add_around(nodes, nodes%ends(2, entry), elements, n)
  end subroutine around_node

  !> Add the elements that touch a corner of those in the list.
  pure subroutine widen(nodes, elements, n)
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(inout) :: elements(:), n   !! (n) as many as there is room for; number found
    integer :: k, a, before

    before = n
    do k = 1, before
      do a = 1, 4
        call add_around(nodes, nodes%entries(a, elements(k)), elements, n)
      end do
    end do
  end subroutine widen

  pure subroutine add_around(nodes, entry, elements, n)
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(in) :: entry
    integer, intent(inout) :: elements(:), n
    integer :: k

    do k = nodes%first(entry), nodes%first(entry + 1) - 1
      if (any(elements(:n) == nodes%elements(k))) cycle
      if (n == size(elements)) return
      n = n + 1
      elements(n) = nodes%elements(k)
    end do
  end subroutine add_around

end module patch_nodes
