!> Quadrilaterals separated along inner curves, so that each side of a curve is a contour of its own.
!>
!> A point on a curve gets a copy for each further sector between the curves there: elements on one side of a curve are then
!> connected by what lies on that side only, and no change of theirs crosses it.
module quad_seams
  implicit none
  private
  public :: separate_sides

contains

  !> Number the corners on other sides of curves anew, from the number of points on; `original` has the points they are copies of.
  pure subroutine separate_sides(npoint, inner, corners, original)
    integer, intent(in) :: npoint
    integer, intent(in) :: inner(:, :)            !! ends of the sides of inner curves (2, nside)
    integer, intent(inout) :: corners(:, :)       !! (4, nquad)
    integer, allocatable, intent(out) :: original(:)   !! (ncopy)
    integer :: first(npoint + 1), around(4*size(corners, 2)), sector(4*size(corners, 2)), filled(npoint), e, k, p
    logical :: on_curve(npoint), changed
    integer :: i, j, low, high, copies

    allocate (original(0))
    if (size(inner, 2) == 0) return
    on_curve = .false.
    on_curve(inner(1, :)) = .true.
    on_curve(inner(2, :)) = .true.
    filled = 0
    do e = 1, size(corners, 2)
      filled(corners(:, e)) = filled(corners(:, e)) + 1
    end do
    first(1) = 1
    do p = 1, npoint
      first(p + 1) = first(p) + filled(p)
    end do
    filled = 0
    do e = 1, size(corners, 2)
      do k = 1, 4
        p = corners(k, e)
        around(first(p) + filled(p)) = 4*(e - 1) + k
        filled(p) = filled(p) + 1
      end do
    end do
    ! corners of one sector get its smallest number, from side to side until nothing changes
    sector = [(i, i=1, size(sector))]
    do p = 1, npoint
      if (.not. on_curve(p)) cycle
      low = first(p)
      high = first(p + 1) - 1
      do
        changed = .false.
        do i = low, high
          do j = low, high
            if (next_of(corners, around(i)) /= last_of(corners, around(j)) .or. sector(i) == sector(j)) cycle
            if (is_inner(p, next_of(corners, around(i)))) cycle
            sector([i, j]) = minval(sector([i, j]))
            changed = .true.
          end do
        end do
        if (.not. changed) exit
      end do
    end do
    do p = 1, npoint
      if (.not. on_curve(p)) cycle
      low = first(p)
      high = first(p + 1) - 1
      do i = low, high
        if (sector(i) /= i .or. i == low) cycle
        original = [original, p]
        copies = size(original)
        do j = i, high
          if (sector(j) /= i) cycle
          k = around(j)
          corners(mod(k - 1, 4) + 1, (k - 1)/4 + 1) = -copies
        end do
      end do
    end do
    where (corners < 0) corners = npoint - corners

  contains

    pure function is_inner(a, b) result(yes)
      integer, intent(in) :: a, b
      logical :: yes

      yes = any(inner(1, :) == a .and. inner(2, :) == b) .or. any(inner(1, :) == b .and. inner(2, :) == a)
    end function is_inner

  end subroutine separate_sides

  !> Point after a corner in its quadrilateral, and before it.
  pure function next_of(corners, corner) result(point)
    integer, intent(in) :: corners(:, :), corner
    integer :: point

    point = corners(mod(corner, 4) + 1, (corner - 1)/4 + 1)
  end function next_of

  pure function last_of(corners, corner) result(point)
    integer, intent(in) :: corners(:, :), corner
    integer :: point

    point = corners(mod(corner + 2, 4) + 1, (corner - 1)/4 + 1)
  end function last_of

end module quad_seams
