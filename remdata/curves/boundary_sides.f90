!> Sides of quadrilaterals that belong to one element only, ordered into closed loops.
!>
!> A side is identified by its middle node: on the contour that node belongs to a single PL8LS (annex 2, section 2). The next side
!> is found by turning around the end node through the adjacent elements, from side to side, until one is met that is not shared. No
!> coordinate is used, so that bodies, holes and rings are separated even where two of them touch in a node. Elements are numbered
!> counter-clockwise, hence loops have the part on their left.
module boundary_sides
  use shape_functions, only: quad8_side
  implicit none
  private
  public :: loop_t, find_loops
  public :: loops_found, shared_by_three, sides_disagree

  !> One closed loop around a part, with the part on its left.
  type :: loop_t
    !> Nodes (3, nside): first end, middle, second end; a side begins where the one before it ends.
    integer, allocatable :: sides(:, :)
    !> Element each side belongs to (nside).
    integer, allocatable :: element(:)
    !> Bodies are numbered from 1: elements that share sides are of one body.
    integer :: body = 0
  end type loop_t

  !> Status of `find_loops`.
  integer, parameter :: loops_found = 0, shared_by_three = 1, sides_disagree = 2

contains

  !> All loops. Each begins at the lowest number among its end nodes, and they are sorted by these numbers, independently of the
  !> order of the elements; where a loop passes that node twice it begins with the lower middle node.
  pure subroutine find_loops(connectivity, nnode, loops, status, node)
    integer, intent(in) :: connectivity(:, :)   !! nodes of the elements (8, nelem), in the order of `quad8`
    integer, intent(in) :: nnode
    type(loop_t), allocatable, intent(out) :: loops(:)   !! (nloop)
    integer, intent(out) :: status                       !! `loops_found`, or the reason of the failure
    integer, intent(out) :: node                         !! middle node at fault, else 0
    integer :: owner(2, nnode), body(size(connectivity, 2))
    integer, allocatable :: starts(:), order(:)
    logical :: walked(nnode)
    integer :: k, n

    allocate (loops(0))
    call find_owners(connectivity, owner, status, node)
    if (status /= loops_found) return
    call number_bodies(connectivity, owner, body)
    call list_starts(connectivity, owner, starts, order)
    walked = .false.
    n = 0
    do k = 1, size(order)
      if (walked(order(k))) cycle
      call mark_loop(connectivity, owner, order(k), walked)
      n = n + 1
      starts(n) = order(k)
    end do
    deallocate (loops)
    allocate (loops(n))
    do k = 1, n
      call walk_loop(connectivity, owner, body, starts(k), loops(k))
    end do
  end subroutine find_loops

  !> The one or two sides at each middle node, as 4 (element - 1) + side of the element; 0 for none.
  pure subroutine find_owners(connectivity, owner, status, node)
    integer, intent(in) :: connectivity(:, :)
    integer, intent(out) :: owner(:, :), status, node
    integer :: e, k, ends(2), other(2)

    owner = 0
    status = loops_found
    do e = 1, size(connectivity, 2)
      do k = 1, 4
        node = connectivity(quad8_side(2, k), e)
        if (owner(2, node) > 0) then
          status = shared_by_three
          return
        else if (owner(1, node) > 0) then
          ! adjacent elements traverse the side they share in opposite directions
          ends = ends_of(connectivity, 4*(e - 1) + k)
          other = ends_of(connectivity, owner(1, node))
          if (any(ends /= other([2, 1]))) then
            status = sides_disagree
            return
          end if
          owner(2, node) = 4*(e - 1) + k
        else
          owner(1, node) = 4*(e - 1) + k
        end if
      end do
    end do
    node = 0
  end subroutine find_owners

  !> Ends of a side of an element.
  pure function ends_of(connectivity, side) result(ends)
    integer, intent(in) :: connectivity(:, :), side
    integer :: ends(2)

    ends = connectivity(quad8_side([1, 3], mod(side - 1, 4) + 1), (side - 1)/4 + 1)
  end function ends_of

  !> Middle node of a side of an element.
  pure function middle_of(connectivity, side) result(node)
    integer, intent(in) :: connectivity(:, :), side
    integer :: node

    node = connectivity(quad8_side(2, mod(side - 1, 4) + 1), (side - 1)/4 + 1)
  end function middle_of

  !> The side of the contour after another, by turning through the elements around the node between them.
  pure function next_side(connectivity, owner, side) result(next)
    integer, intent(in) :: connectivity(:, :), owner(:, :), side
    integer :: next
    integer :: node

    next = side
    do
      next = 4*((next - 1)/4) + mod(next, 4) + 1
      node = middle_of(connectivity, next)
      if (owner(2, node) == 0) return
      next = merge(owner(2, node), owner(1, node), next == owner(1, node))
    end do
  end function next_side

  !> Elements that share sides get one number, counted from 1 in the order of their first elements.
  pure subroutine number_bodies(connectivity, owner, body)
    integer, intent(in) :: connectivity(:, :), owner(:, :)
    integer, intent(out) :: body(:)
    integer :: waiting(size(body)), e, k, n, count, side, other

    body = 0
    count = 0
    do e = 1, size(body)
      if (body(e) > 0) cycle
      count = count + 1
      body(e) = count
      n = 1
      waiting(1) = e
      do while (n > 0)
        side = 4*(waiting(n) - 1)
        n = n - 1
        do k = 1, 4
          other = (sum(owner(:, middle_of(connectivity, side + k))) - side - k - 1)/4 + 1
          if (owner(2, middle_of(connectivity, side + k)) == 0) cycle
          if (body(other) > 0) cycle
          body(other) = count
          n = n + 1
          waiting(n) = other
        end do
      end do
    end do
  end subroutine number_bodies

  !> Middle nodes of the contour sorted by the first end of their side, then by their own number: two counting sorts.
  pure subroutine list_starts(connectivity, owner, starts, order)
    integer, intent(in) :: connectivity(:, :), owner(:, :)
    integer, allocatable, intent(out) :: starts(:), order(:)
    integer :: offset(size(owner, 2) + 1), node, first, n

    offset = 0
    n = 0
    do node = 1, size(owner, 2)
      if (owner(1, node) == 0 .or. owner(2, node) > 0) cycle
      first = first_of(node)
      offset(first + 1) = offset(first + 1) + 1
      n = n + 1
    end do
    do node = 2, size(offset)
      offset(node) = offset(node) + offset(node - 1)
    end do
    allocate (order(n), starts(n))
    do node = 1, size(owner, 2)
      if (owner(1, node) == 0 .or. owner(2, node) > 0) cycle
      first = first_of(node)
      offset(first) = offset(first) + 1
      order(offset(first)) = node
    end do

  contains

    pure function first_of(middle) result(first)
      integer, intent(in) :: middle
      integer :: first
      integer :: ends(2)

      ends = ends_of(connectivity, owner(1, middle))
      first = ends(1)
    end function first_of

  end subroutine list_starts

  pure subroutine mark_loop(connectivity, owner, start, walked)
    integer, intent(in) :: connectivity(:, :), owner(:, :), start
    logical, intent(inout) :: walked(:)
    integer :: side

    side = owner(1, start)
    do while (.not. walked(middle_of(connectivity, side)))
      walked(middle_of(connectivity, side)) = .true.
      side = next_side(connectivity, owner, side)
    end do
  end subroutine mark_loop

  !> The loop that begins with the side of a middle node.
  pure subroutine walk_loop(connectivity, owner, body, start, loop)
    integer, intent(in) :: connectivity(:, :), owner(:, :), body(:), start
    type(loop_t), intent(out) :: loop
    integer :: side, ends(2), n, k

    side = owner(1, start)
    n = 0
    do
      n = n + 1
      side = next_side(connectivity, owner, side)
      if (side == owner(1, start)) exit
    end do
    allocate (loop%sides(3, n), loop%element(n))
    do k = 1, n
      ends = ends_of(connectivity, side)
      loop%sides(:, k) = [ends(1), middle_of(connectivity, side), ends(2)]
      loop%element(k) = (side - 1)/4 + 1
      side = next_side(connectivity, owner, side)
    end do
    loop%body = body(loop%element(1))
  end subroutine walk_loop

end module boundary_sides
