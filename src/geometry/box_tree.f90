!> A tree of boxes to find the nearest of many to a point, or those that meet a box. Points are boxes of zero size.
!>
!> A k-d tree split at the median (J.L. Bentley, Commun. ACM 18 (1975) 509-517), each node with the box of all items below it: built
!> in n log n, searched in log n, on graded meshes too. Ties are broken by the number of the item, so that results depend on the
!> items only.
module box_tree
  use kinds, only: wp
  implicit none
  private
  public :: box_tree_t, build_tree, nearest_items, items_meeting, insert

  !> Largest number of items of a leaf, and largest depth of a tree (halves of 2^31 items).
  integer, parameter :: leaf = 8, deepest = 64

  type :: box_tree_t
    integer :: n = 0
    !> Items in the order of the leaves (n), and their boxes (4, n): least x, y, largest x, y.
    integer, allocatable :: items(:)
    real(wp), allocatable :: boxes(:, :)
    !> Nodes (3, nnode): first and last item, right branch (0: a leaf). The left branch is the next node.
    integer, allocatable :: nodes(:, :)
    real(wp), allocatable :: node_boxes(:, :)
  end type box_tree_t

contains

  !> Build the tree of some of the boxes.
  pure subroutine build_tree(boxes, members, tree)
    real(wp), intent(in) :: boxes(:, :)   !! (4, nbox) least x, y, largest x, y [length]
    integer, intent(in) :: members(:)     !! (n) boxes of the tree
    type(box_tree_t), intent(out) :: tree
    integer :: used, i

    tree%n = size(members)
    allocate (tree%items(tree%n), source=members)
    allocate (tree%boxes(4, tree%n))
    allocate (tree%nodes(3, max(1, tree%n)), tree%node_boxes(4, max(1, tree%n)))
    used = 0
    if (tree%n > 0) call grow(boxes, 1, tree%n, tree, used)
    do i = 1, tree%n
      tree%boxes(:, i) = boxes(:, tree%items(i))
    end do
  end subroutine build_tree

  !> Build one node and all below it.
  pure recursive subroutine grow(boxes, first, last, tree, used)
    real(wp), intent(in) :: boxes(:, :)
    integer, intent(in) :: first, last
    type(box_tree_t), intent(inout) :: tree
    integer, intent(inout) :: used
    real(wp) :: box(4), least(2), largest(2), centre(2)
    integer :: node, middle, i

    used = used + 1
    node = used
    box = boxes(:, tree%items(first))
    least = huge(1.0_wp)
    largest = -huge(1.0_wp)
    do i = first, last
      associate (item => boxes(:, tree%items(i)))
        box(1:2) = min(box(1:2), item(1:2))
        box(3:4) = max(box(3:4), item(3:4))
        centre = item(1:2) + item(3:4)
        least = min(least, centre)
        largest = max(largest, centre)
      end associate
    end do
    tree%node_boxes(:, node) = box
    tree%nodes(:, node) = [first, last, 0]
    if (last - first < leaf) return
    middle = (first + last)/2
    call part_at(boxes, merge(1, 2, largest(1) - least(1) >= largest(2) - least(2)), first, last, middle, tree%items)
    call grow(boxes, first, middle, tree, used)
    tree%nodes(3, node) = used + 1
    call grow(boxes, middle + 1, last, tree, used)
  end subroutine grow

  !> Partition so that the item at `middle` is the one sorting would put there, smaller ones before it.
  !> Source: C.A.R. Hoare, Algorithm 65: FIND, Commun. ACM 4 (1961) 321.
  pure subroutine part_at(boxes, axis, first, last, middle, items)
    real(wp), intent(in) :: boxes(:, :)
    integer, intent(in) :: axis, first, last, middle
    integer, intent(inout) :: items(:)
    integer :: lower, upper, i, j, pivot

    lower = first
    upper = last
    do while (lower < upper)
      pivot = items((lower + upper)/2)
      i = lower
      j = upper
      do while (i <= j)
        do while (before(items(i), pivot))
          i = i + 1
        end do
        do while (before(pivot, items(j)))
          j = j - 1
        end do
        if (i <= j) then
          items([i, j]) = items([j, i])
          i = i + 1
          j = j - 1
        end if
      end do
      if (j < middle) lower = i
      if (middle < i) upper = j
    end do

  contains

    pure function before(a, b) result(is_before)
      integer, intent(in) :: a, b
      logical :: is_before
      real(wp) :: difference

      difference = (boxes(axis, a) + boxes(axis + 2, a)) - (boxes(axis, b) + boxes(axis + 2, b))
      is_before = difference < 0 .or. (.not. difference > 0 .and. a < b)
    end function before

  end subroutine part_at

  !> The items nearest to a point, nearest first; of equally near ones the one of the lower number first. `found` is less than the
  !> size of `items` only where the tree has no more. `tried` counts the nodes and items visited.
  pure subroutine nearest_items(tree, point, found, items, distances, tried)
    type(box_tree_t), intent(in) :: tree
    real(wp), intent(in) :: point(2)   !! [length]
    integer, intent(out) :: found
    integer, intent(out) :: items(:)        !! (n) as many as requested
    real(wp), intent(out) :: distances(:)   !! (n) squares [length^2]
    integer, intent(out), optional :: tried
    integer :: waiting(deepest), top, node, near, far, i, visited
    real(wp) :: waiting_at(deepest), to_near, to_far, d

    found = 0
    visited = 0
    items = 0
    distances = huge(1.0_wp)
    top = 0
    if (tree%n > 0) then
      top = 1
      waiting(1) = 1
      waiting_at(1) = 0
    end if
    do while (top > 0)
      node = waiting(top)
      d = waiting_at(top)
      top = top - 1
      visited = visited + 1
      if (d > distances(size(distances))) cycle
      if (tree%nodes(3, node) > 0) then
        near = node + 1
        far = tree%nodes(3, node)
        to_near = distance_to(tree%node_boxes(:, near), point)
        to_far = distance_to(tree%node_boxes(:, far), point)
        if (to_far < to_near) then
          waiting(top + 1:top + 2) = [near, far]
          waiting_at(top + 1:top + 2) = [to_near, to_far]
        else
          waiting(top + 1:top + 2) = [far, near]
          waiting_at(top + 1:top + 2) = [to_far, to_near]
        end if
        top = top + 2
        cycle
      end if
      do i = tree%nodes(1, node), tree%nodes(2, node)
        visited = visited + 1
        d = distance_to(tree%boxes(:, i), point)
        if (d > distances(size(distances))) cycle
        call insert(tree%items(i), d, found, items, distances)
      end do
    end do
    if (present(tried)) tried = visited
  end subroutine nearest_items

  !> Items whose boxes meet a box, in the order of the leaves; those that do not fit into the list are counted only.
  pure subroutine items_meeting(tree, box, found, items)
    type(box_tree_t), intent(in) :: tree
    real(wp), intent(in) :: box(4)   !! least x, y, largest x, y [length]
    integer, intent(out) :: found
    integer, intent(inout) :: items(:)   !! (n) the first `found`
    integer :: waiting(deepest), top, node, i

    found = 0
    top = min(tree%n, 1)
    waiting(1) = 1
    do while (top > 0)
      node = waiting(top)
      top = top - 1
      if (.not. meets(tree%node_boxes(:, node))) cycle
      if (tree%nodes(3, node) > 0) then
        waiting(top + 1:top + 2) = [tree%nodes(3, node), node + 1]
        top = top + 2
        cycle
      end if
      do i = tree%nodes(1, node), tree%nodes(2, node)
        if (.not. meets(tree%boxes(:, i))) cycle
        found = found + 1
        if (found <= size(items)) items(found) = tree%items(i)
      end do
    end do

  contains

    pure function meets(other) result(yes)
      real(wp), intent(in) :: other(4)
      logical :: yes

      yes = all(other(1:2) <= box(3:4)) .and. all(box(1:2) <= other(3:4))
    end function meets

  end subroutine items_meeting

  !> Insert an item into the list of the nearest, if it is nearer than the last one.
  pure subroutine insert(item, distance, found, items, distances)
    integer, intent(in) :: item
    real(wp), intent(in) :: distance
    integer, intent(inout) :: found, items(:)   !! (n)
    real(wp), intent(inout) :: distances(:)     !! (n) squares [length^2]
    integer :: slot

    if (found == size(items)) then
      if (.not. nearer(distance, item, distances(found), items(found))) return
      found = found - 1
    end if
    slot = found
    do while (slot > 0)
      if (.not. nearer(distance, item, distances(slot), items(slot))) exit
      items(slot + 1) = items(slot)
      distances(slot + 1) = distances(slot)
      slot = slot - 1
    end do
    items(slot + 1) = item
    distances(slot + 1) = distance
    found = found + 1
  end subroutine insert

  pure function nearer(d, item, other_d, other) result(is_nearer)
    real(wp), intent(in) :: d, other_d
    integer, intent(in) :: item, other
    logical :: is_nearer

    is_nearer = d < other_d .or. (.not. d > other_d .and. item < other)
  end function nearer

  !> Square of the distance of a point to a box, 0 inside.
  pure function distance_to(box, point) result(d)
    real(wp), intent(in) :: box(4), point(2)
    real(wp) :: d

    d = sum(max(box(1:2) - point, point - box(3:4), 0.0_wp)**2)
  end function distance_to

end module box_tree
