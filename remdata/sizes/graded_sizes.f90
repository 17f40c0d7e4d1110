!> Sizes at the nodes of a mesh, each limited by its neighbours.
!>
!> h(j) <= h(i) + slope |x(j) - x(i)| between all corners of an element. Nodes are settled from the smallest size up, as in the
!> shortest path search (E.W. Dijkstra, Numer. Math. 1 (1959) 269-271), so that each is settled once: n log n.
module graded_sizes
  use kinds, only: wp
  use vectors, only: length_of
  implicit none
  private
  public :: grade, slope_of, list_elements

  !> Binary heap of the nodes that are not settled, the smallest size on top.
  type :: heap_t
    integer :: n = 0
    integer, allocatable :: nodes(:)   !! (nnode) the first n are in the heap
    integer, allocatable :: slot(:)    !! (nnode) index of a node in the heap
  end type heap_t

contains

  !> Growth of size over length when each element is `gradation` times the one before: from middle to middle,
  !> (g h - h) over (g h + h)/2.
  pure function slope_of(gradation) result(slope)
    real(wp), intent(in) :: gradation
    real(wp) :: slope

    slope = 2*(gradation - 1)/(gradation + 1)
  end function slope_of

  pure subroutine grade(nodes, connectivity, slope, sizes)
    real(wp), intent(in) :: nodes(:, :)         !! (2, nnode) [length]
    integer, intent(in) :: connectivity(:, :)   !! (n, nelem) corners first, n at least 4
    real(wp), intent(in) :: slope
    real(wp), intent(inout) :: sizes(:)   !! (nnode) [length]; those of other nodes than corners stay
    integer, allocatable :: first(:), around(:)
    type(heap_t) :: heap
    real(wp) :: most
    integer :: e, k, i, j, node, other

    allocate (first(size(sizes) + 1), around(4*size(connectivity, 2)))
    call list_elements(connectivity, first, around)
    allocate (heap%nodes(size(sizes)), heap%slot(size(sizes)))
    do node = 1, size(sizes)
      heap%n = heap%n + 1
      heap%nodes(heap%n) = node
      heap%slot(node) = heap%n
      call rise(sizes, heap, heap%n)
    end do
    do i = 1, size(sizes)
      call take_smallest(sizes, heap, node)
      do j = first(node), first(node + 1) - 1
        e = around(j)
        do k = 1, 4
          other = connectivity(k, e)
          if (heap%slot(other) == 0) cycle
          most = sizes(node) + slope*length_of(nodes(:, other) - nodes(:, node))
          if (.not. sizes(other) > most) cycle
          sizes(other) = most
          call rise(sizes, heap, heap%slot(other))
        end do
      end do
    end do
  end subroutine grade

  !> Elements at each corner node: those of node i are around(first(i)) ... around(first(i + 1) - 1).
  pure subroutine list_elements(connectivity, first, around)
    integer, intent(in) :: connectivity(:, :)     !! (n, nelem) corners first
    integer, intent(out) :: first(:), around(:)   !! (nnode + 1); (4*nelem)
    integer :: e, k, i

    first = 0
    do e = 1, size(connectivity, 2)
      first(connectivity(1:4, e)) = first(connectivity(1:4, e)) + 1
    end do
    do i = 2, size(first)
      first(i) = first(i) + first(i - 1)
    end do
    do e = size(connectivity, 2), 1, -1
      do k = 4, 1, -1
        i = connectivity(k, e)
        around(first(i)) = e
        first(i) = first(i) - 1
      end do
    end do
    first = first + 1
  end subroutine list_elements

  pure subroutine take_smallest(sizes, heap, node)
    real(wp), intent(in) :: sizes(:)
    type(heap_t), intent(inout) :: heap
    integer, intent(out) :: node
    integer :: i, child

    node = heap%nodes(1)
    heap%slot(node) = 0
    heap%nodes(1) = heap%nodes(heap%n)
    heap%n = heap%n - 1
    if (heap%n == 0) return
    heap%slot(heap%nodes(1)) = 1
    i = 1
    do
      child = 2*i
      if (child > heap%n) exit
      if (child < heap%n) then
        if (before(sizes, heap%nodes(child + 1), heap%nodes(child))) child = child + 1
      end if
      if (.not. before(sizes, heap%nodes(child), heap%nodes(i))) exit
      call swap(heap, i, child)
      i = child
    end do
  end subroutine take_smallest

  pure subroutine rise(sizes, heap, start)
    real(wp), intent(in) :: sizes(:)
    type(heap_t), intent(inout) :: heap
    integer, intent(in) :: start
    integer :: i

    i = start
    do while (i > 1)
      if (.not. before(sizes, heap%nodes(i), heap%nodes(i/2))) exit
      call swap(heap, i, i/2)
      i = i/2
    end do
  end subroutine rise

  pure subroutine swap(heap, i, j)
    type(heap_t), intent(inout) :: heap
    integer, intent(in) :: i, j

    heap%nodes([i, j]) = heap%nodes([j, i])
    heap%slot(heap%nodes([i, j])) = [i, j]
  end subroutine swap

  pure function before(sizes, a, b) result(is_before)
    real(wp), intent(in) :: sizes(:)
    integer, intent(in) :: a, b
    logical :: is_before

    is_before = sizes(a) < sizes(b) .or. (.not. sizes(a) > sizes(b) .and. a < b)
  end function before

end module graded_sizes
