!> Triangles left among quadrilaterals are moved towards each other, and merged.
!>
!> A triangle and a neighbouring quadrilateral are a pentagon; divided in another way, its triangle lies on the far side. From
!> cell to cell it comes beside the next triangle, and both become a quadrilateral (C. K. Lee, S. H. Lo, A new scheme for the
!> generation of a graded quadrilateral mesh, Computers & Structures 52 (1994) 847-857). Where a matching leaves some, none is
!> left after this if all regions between kept sides have an even number of them.
module triangle_moves
  use kinds, only: wp
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: merge_triangles

contains

  pure subroutine merge_triangles(x, inner, corners)
    real(wp), intent(in) :: x(:, :)       !! (2, npoint) [length]
    integer, intent(in) :: inner(:, :)    !! ends of the sides of inner curves, which no triangle crosses (2, n)
    integer, allocatable, intent(inout) :: corners(:, :)   !! (4, ncell) counter-clockwise, the fourth 0 for triangles
    integer, allocatable :: across(:, :), way(:)
    integer :: e

    if (all(corners(4, :) > 0)) return
    do e = 1, size(corners, 2)
      if (corners(4, e) > 0 .or. corners(1, e) == 0) cycle
      call find_neighbours(size(x, 2), inner, corners, across)
      call find_way(corners, across, e, way)
      if (size(way) > 1) call move_along(x, way, corners)
    end do
    corners = corners(:, pack([(e, e=1, size(corners, 2))], corners(1, :) > 0))
  end subroutine merge_triangles

  !> The cell beyond each side, 0 for none or beyond an inner curve.
  pure subroutine find_neighbours(npoint, inner, corners, across)
    integer, intent(in) :: npoint, inner(:, :), corners(:, :)
    integer, allocatable, intent(out) :: across(:, :)   !! (4, ncell)
    ! sides with the same lower point form a linked list
    integer :: latest(npoint), before(4*size(corners, 2)), far(4*size(corners, 2))
    integer :: e, k, m, s, low, high

    allocate (across(4, size(corners, 2)), source=0)
    latest = 0
    do e = 1, size(corners, 2)
      m = count(corners(:, e) > 0)
      do k = 1, m
        call ends_of(corners(k, e), corners(mod(k, m) + 1, e), low, high)
        if (any(inner(1, :) == low .and. inner(2, :) == high) .or. any(inner(2, :) == low .and. inner(1, :) == high)) cycle
        s = latest(low)
        do while (s > 0)
          if (far(s) == high) exit
          s = before(s)
        end do
        if (s > 0) then
          across(k, e) = (s - 1)/4 + 1
          across(mod(s - 1, 4) + 1, across(k, e)) = e
          cycle
        end if
        s = 4*(e - 1) + k
        far(s) = high
        before(s) = latest(low)
        latest(low) = s
      end do
    end do
  end subroutine find_neighbours

  pure subroutine ends_of(a, b, low, high)
    integer, intent(in) :: a, b
    integer, intent(out) :: low, high

    low = min(a, b)
    high = max(a, b)
  end subroutine ends_of

  !> Cells from a triangle to the nearest other one, breadth first; the first alone where there is none.
  pure subroutine find_way(corners, across, start, way)
    integer, intent(in) :: corners(:, :), across(:, :), start
    integer, allocatable, intent(out) :: way(:)
    integer :: from(size(corners, 2)), queue(size(corners, 2)), first, last, k, e

    from = 0
    from(start) = start
    queue(1) = start
    last = 1
    first = 0
    search: do while (first < last)
      first = first + 1
      do k = 1, 4
        e = across(k, queue(first))
        if (e == 0) cycle
        if (from(e) > 0) cycle
        from(e) = queue(first)
        last = last + 1
        queue(last) = e
        if (corners(4, e) == 0) exit search
      end do
    end do search
    e = queue(last)
    if (corners(4, e) > 0) e = start
    way = [e]
    do while (e /= start)
      e = from(e)
      way = [e, way]
    end do
  end subroutine find_way

  !> Move the triangle way(1) through the quadrilaterals to the triangle at the end.
  pure subroutine move_along(x, way, corners)
    real(wp), intent(in) :: x(:, :)
    integer, intent(in) :: way(:)
    integer, intent(inout) :: corners(:, :)
    integer :: i, k, side, ring(5), ear, best
    real(wp) :: shape, most

    do i = 1, size(way) - 1
      associate (t => corners(:3, way(i)), q => corners(:, way(i + 1)))
        ! the pentagon counter-clockwise: the triangle's far point, then all of the other cell from the shared side
        k = findloc([(all(q /= t(side)), side=1, 3)], .true., 1)
        ring(1:2) = [t(k), t(mod(k, 3) + 1)]
        if (i + 1 == size(way)) then
          k = findloc([(all(t /= q(side)), side=1, 3)], .true., 1)
          corners(:, way(i)) = [ring(1:2), q(k), t(modulo(findloc(t, ring(1), 1) - 2, 3) + 1)]
          corners(:, way(i + 1)) = 0
          return
        end if
        k = findloc(q, ring(2), 1)
        ring(3:5) = q([mod(k, 4) + 1, mod(k + 1, 4) + 1, mod(k + 2, 4) + 1])
      end associate
      most = -huge(most)
      best = 0
      ! the ear at a point has it and both its neighbours
      do ear = 1, 5
        k = shared_points(ring([modulo(ear - 2, 5) + 1, ear, mod(ear, 5) + 1]), corners(:, way(i + 2)))
        if (k < 2) cycle
        shape = min(worst_sine(x(:, ring([modulo(ear - 2, 5) + 1, ear, mod(ear, 5) + 1]))), worst_sine(x(:, without(ring, ear))))
        if (.not. shape > most) cycle
        most = shape
        best = ear
      end do
      corners(:, way(i)) = without(ring, best)
      corners(:, way(i + 1)) = [ring([modulo(best - 2, 5) + 1, best, mod(best, 5) + 1]), 0]
    end do
  end subroutine move_along

  pure function without(ring, ear) result(quad)
    integer, intent(in) :: ring(5), ear
    integer :: quad(4)

    quad = ring(pack([1, 2, 3, 4, 5], [1, 2, 3, 4, 5] /= ear))
  end function without

  pure function shared_points(a, b) result(n)
    integer, intent(in) :: a(:), b(:)
    integer :: n
    integer :: k

    n = count([(any(b == a(k)), k=1, size(a))])
  end function shared_points

  !> Smallest sine at the corners of a polygon.
  pure function worst_sine(x) result(worst)
    real(wp), intent(in) :: x(:, :)   !! (2, n)
    real(wp) :: worst
    real(wp) :: u(2), v(2)
    integer :: k, n

    n = size(x, 2)
    worst = 1
    do k = 1, n
      u = x(:, mod(k, n) + 1) - x(:, k)
      v = x(:, modulo(k - 2, n) + 1) - x(:, k)
      worst = min(worst, cross(u, v)/max(length_of(u)*length_of(v), tiny(1.0_wp)))
    end do
  end function worst_sine

end module triangle_moves
