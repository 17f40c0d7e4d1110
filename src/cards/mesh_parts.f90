!> Nodes and elements as cards give them, before sides are joined and everything gets its final number.
module mesh_parts
  use diagnostics, only: location_t
  use kinds, only: wp
  implicit none
  private
  public :: mesh_parts_t, body_t, start_parts, sort_labels, find_label, root_of, merge_nodes

  !> Elements of one card, from which a group is made.
  type :: body_t
    character(len=:), allocatable :: name
    character(len=:), allocatable :: elem
    integer :: npoint = 4
    !> Option of the ELEM, 0 for none.
    integer :: option = 0
    integer :: material = 0
    !> Nodes (8, nelem), and where each element or their block stands in the deck.
    integer, allocatable :: connectivity(:, :)
    integer, allocatable :: labels(:)
    type(location_t), allocatable :: location(:)
    !> Made by a BLOCK card, with a number of elements along side 1.
    logical :: is_block = .false.
    integer :: across = 0
  end type body_t

  type :: mesh_parts_t
    !> Explicit nodes first (nexplicit), then those of the blocks.
    real(wp), allocatable :: coordinates(:, :)
    integer, allocatable :: labels(:)
    type(location_t), allocatable :: location(:)
    !> A node that became one with another points to it.
    integer, allocatable :: parent(:)
    integer :: nexplicit = 0
    type(body_t), allocatable :: bodies(:)
    !> Where a set of sides was joined to another (line 0: it was not).
    type(location_t), allocatable :: joined(:)
    !> No mistake in what the mesh is made of so far.
    logical :: sound = .true.
    !> All blocks have even divisions.
    logical :: even = .true.
    !> The mesh of the cards can be made finer: all bodies are blocks, or given by their contours.
    logical :: divisible = .false.
  end type mesh_parts_t

contains

  subroutine start_parts(parts)
    type(mesh_parts_t), intent(out) :: parts

    allocate (parts%coordinates(2, 0), parts%labels(0), parts%location(0), parts%parent(0), parts%bodies(0), parts%joined(0))
  end subroutine start_parts

  !> Order that makes labels ascend; equal labels keep theirs. Merge sort from the bottom up.
  pure subroutine sort_labels(labels, order)
    integer, intent(in) :: labels(:)                !! (n)
    integer, allocatable, intent(out) :: order(:)   !! (n)
    integer :: width, first, middle, last, i, j, k
    integer :: other(size(labels))

    allocate (order(size(labels)))
    order = [(i, i=1, size(labels))]
    width = 1
    do while (width < size(labels))
      do first = 1, size(labels), 2*width
        middle = min(first + width, size(labels) + 1)
        last = min(first + 2*width, size(labels) + 1)
        i = first
        j = middle
        do k = first, last - 1
          if (takes_left(i, j, middle, last)) then
            other(k) = order(i)
            i = i + 1
          else
            other(k) = order(j)
            j = j + 1
          end if
        end do
      end do
      order = other
      width = 2*width
    end do

  contains

    pure function takes_left(i, j, middle, last) result(yes)
      integer, intent(in) :: i, j, middle, last
      logical :: yes

      if (i >= middle) then
        yes = .false.
      else if (j >= last) then
        yes = .true.
      else
        yes = labels(order(i)) <= labels(order(j))
      end if
    end function takes_left

  end subroutine sort_labels

  !> Position of a label among ascending ones, 0 when it is not there.
  pure function find_label(sorted, label) result(k)
    integer, intent(in) :: sorted(:)   !! (n) labels
    integer, intent(in) :: label
    integer :: k
    integer :: low, high

    low = 1
    high = size(sorted)
    do while (low <= high)
      k = low + (high - low)/2
      if (sorted(k) == label) return
      if (sorted(k) < label) then
        low = k + 1
      else
        high = k - 1
      end if
    end do
    k = 0
  end function find_label

  !> The node that represents a node after all merging.
  pure function root_of(parent, node) result(root)
    integer, intent(in) :: parent(:)   !! (nnode)
    integer, intent(in) :: node
    integer :: root

    root = node
    do while (parent(root) /= root)
      root = parent(root)
    end do
  end function root_of

  !> Make two nodes one; the first made stays.
  pure subroutine merge_nodes(parent, a, b)
    integer, intent(inout) :: parent(:)   !! (nnode)
    integer, intent(in) :: a, b
    integer :: i, j

    i = root_of(parent, a)
    j = root_of(parent, b)
    parent(max(i, j)) = min(i, j)
  end subroutine merge_nodes

end module mesh_parts
