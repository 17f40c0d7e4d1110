!> Nodes of each material with the elements around them. A node between two materials counts once in each.
module patch_nodes
  use shape_functions, only: quad8_side
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: patch_nodes_t, number_nodes, around_node, widen

  type :: patch_nodes_t
    !> Places of the nodes of the elements in the lists below (8, nelem).
    integer, allocatable :: places(:, :)
    !> Node of the mesh at each place, and the places of the ends of its side (itself twice for a corner) (2, n).
    integer, allocatable :: node(:), ends(:, :)
    !> Elements around place k: elements(first(k)) ... elements(first(k + 1) - 1).
    integer, allocatable :: first(:), elements(:)
  end type patch_nodes_t

contains

  pure subroutine number_nodes(mesh, nodes)
    type(transfer_mesh_t), intent(in) :: mesh
    type(patch_nodes_t), intent(out) :: nodes
    integer, dimension(size(mesh%connectivity)) :: node, material, next
    integer :: head(size(mesh%nodes, 2)), e, a, s, k, n, nelem

    nelem = size(mesh%material)
    allocate (nodes%places(8, nelem))
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
        nodes%places(a, e) = k
      end do
    end do
    allocate (nodes%node(n), source=node(:n))
    allocate (nodes%ends(2, n))
    do e = 1, nelem
      do s = 1, 4
        nodes%ends(:, nodes%places(quad8_side(1, s), e)) = nodes%places(quad8_side(1, s), e)
        nodes%ends(:, nodes%places(quad8_side(2, s), e)) = nodes%places(quad8_side([1, 3], s), e)
      end do
    end do
    call list_elements(nodes)
  end subroutine number_nodes

  !> Elements around each place, in their order.
  pure subroutine list_elements(nodes)
    type(patch_nodes_t), intent(inout) :: nodes
    integer :: fill(size(nodes%node)), e, a, k, n

    n = size(nodes%node)
    allocate (nodes%first(n + 1), nodes%elements(size(nodes%places)))
    fill = 0
    do e = 1, size(nodes%places, 2)
      fill(nodes%places(:, e)) = fill(nodes%places(:, e)) + 1
    end do
    nodes%first(1) = 1
    do k = 1, n
      nodes%first(k + 1) = nodes%first(k) + fill(k)
    end do
    fill = nodes%first(:n)
    do e = 1, size(nodes%places, 2)
      do a = 1, 8
        k = nodes%places(a, e)
        nodes%elements(fill(k)) = e
        fill(k) = fill(k) + 1
      end do
    end do
  end subroutine list_elements

  !> Elements around a corner, or around both ends of the side of a mid node: as many as there is room for.
  pure subroutine around_node(nodes, place, elements, n)
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(in) :: place
    integer, intent(out) :: elements(:), n

    elements = 0
    n = 0
    call add_around(nodes, nodes%ends(1, place), elements, n)
    call add_around(nodes, nodes%ends(2, place), elements, n)
  end subroutine around_node

  !> Take in the elements that touch a corner of those there are.
  pure subroutine widen(nodes, elements, n)
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(inout) :: elements(:), n
    integer :: k, a, before

    before = n
    do k = 1, before
      do a = 1, 4
        call add_around(nodes, nodes%places(a, elements(k)), elements, n)
      end do
    end do
  end subroutine widen

  pure subroutine add_around(nodes, place, elements, n)
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(in) :: place
    integer, intent(inout) :: elements(:), n
    integer :: k

    do k = nodes%first(place), nodes%first(place + 1) - 1
      if (any(elements(:n) == nodes%elements(k))) cycle
      if (n == size(elements)) return
      n = n + 1
      elements(n) = nodes%elements(k)
    end do
  end subroutine add_around

end module patch_nodes
