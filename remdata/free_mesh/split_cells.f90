!> Triangles and quadrilaterals between every other point of the contours, split into quadrilaterals between all of them.
!>
!> A triangle becomes three quadrilaterals, a quadrilateral four, around a new node in its middle and between new ones halfway along
!> its sides; on the contour these are the omitted points. So every mesh becomes one of quadrilaterals only, if less regular.
module split_cells
  use kinds, only: wp
  use quad_lists, only: quads_t
  implicit none
  private
  public :: split_into_quads

contains

  !> Points along the contours are 1, 3, 5 ... after the split, the omitted ones 2, 4, 6 ...
  pure subroutine split_into_quads(points, next, quads)
    real(wp), intent(in) :: points(:, :)   !! every other point along the contours (2, n) [length]
    integer, intent(in) :: next(:)         !! the one after each of these along its contour (n)
    type(quads_t), intent(inout) :: quads
    type(quads_t) :: parts
    real(wp) :: x(2, size(points, 2) + size(quads%inside, 2))
    integer :: sides(4, size(quads%corners, 2)), nodes(4), corners(4), e, k, m, n, centre, last, total
    integer, allocatable :: ends(:, :), middle(:)

    n = size(points, 2)
    x(:, :n) = points
    x(:, n + 1:) = quads%inside
    call number_sides(quads%corners, size(x, 2), sides, ends)
    allocate (parts%inside(2, size(quads%inside, 2) + size(ends, 2) + size(sides, 2)), parts%corners(4, 4*size(sides, 2)))
    last = size(quads%inside, 2)
    parts%inside(:, :last) = quads%inside
    allocate (middle(size(ends, 2)))
    do k = 1, size(ends, 2)
      middle(k) = left_out(next, ends(:, k))
      if (middle(k) > 0) cycle
      last = last + 1
      middle(k) = 2*n + last
      parts%inside(:, last) = 0.5_wp*sum(x(:, ends(:, k)), 2)
    end do
    total = 0
    do e = 1, size(sides, 2)
      m = count(quads%corners(:, e) > 0)
      nodes = quads%corners(:, e)
      last = last + 1
      centre = 2*n + last
      parts%inside(:, last) = sum(x(:, nodes(:m)), 2)/m
      corners(:m) = merge(2*nodes(:m) - 1, n + nodes(:m), nodes(:m) <= n)
      do k = 1, m
        total = total + 1
        parts%corners(:, total) = [corners(k), middle(sides(k, e)), centre, middle(sides(modulo(k - 2, m) + 1, e))]
      end do
    end do
    parts%inside = parts%inside(:, :last)
    parts%corners = parts%corners(:, :total)
    quads = parts
  end subroutine split_into_quads

  !> The omitted point of the contour between two points, 0 for a side inside.
  pure function left_out(next, ends) result(point)
    integer, intent(in) :: next(:), ends(2)
    integer :: point

    point = 0
    if (maxval(ends) > size(next)) return
    if (next(ends(1)) == ends(2)) point = 2*ends(1)
    if (next(ends(2)) == ends(1)) point = 2*ends(2)
  end function left_out

  !> Sides of all cells, each numbered once.
  pure subroutine number_sides(corners, nnode, sides, ends)
    integer, intent(in) :: corners(:, :)   !! (4, ncell), the fourth 0 for triangles
    integer, intent(in) :: nnode
    integer, intent(out) :: sides(:, :)               !! (4, ncell)
    integer, allocatable, intent(out) :: ends(:, :)   !! (2, nside)
    ! sides with the same lower node form a linked list
    integer :: latest(nnode), before(4*size(corners, 2)), list(2, 4*size(corners, 2)), pair(2), e, k, m, n, s

    sides = 0
    latest = 0
    n = 0
    do e = 1, size(corners, 2)
      m = count(corners(:, e) > 0)
      do k = 1, m
        pair = [corners(k, e), corners(mod(k, m) + 1, e)]
        pair = [minval(pair), maxval(pair)]
        s = latest(pair(1))
        do while (s > 0)
          if (list(2, s) == pair(2)) exit
          s = before(s)
        end do
        if (s == 0) then
          n = n + 1
          s = n
          list(:, s) = pair
          before(s) = latest(pair(1))
          latest(pair(1)) = s
        end if
        sides(k, e) = s
      end do
    end do
    allocate (ends, source=list(:, :n))
  end subroutine number_sides

end module split_cells
