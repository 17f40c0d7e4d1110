!> Ends of elements along all sides, with sizes smoothed along the contour.
!>
!> Each side has its own number of elements, determined by all zones of its class, and each part of it a whole number: where sides
!> or parts meet, the sizes may differ by more than the gradation. Along the contour, from one corner of a single zone to the next,
!> the sizes of such neighbours are smoothed; parts keep their lengths.
module contour_divisions
  use curve_divisions, only: divide_curve, shares_of
  use kinds, only: wp
  use side_curves, only: curve_t
  use zone_divisions, only: division_t
  use zones, only: follows_contour, zone_layout_t
  implicit none
  private
  public :: divide_sides, order_along, even_out

  integer, parameter :: passes = 100
  !> Neighbours are smoothed from this share of the gradation on, so that it is met when smoothing ends.
  real(wp), parameter :: from_share = 0.95_wp

contains

  !> Lengths from the start of side s to its ends of elements: ends(first(s)) ... ends(first(s + 1) - 1).
  pure subroutine divide_sides(layout, curves, division, gradation, first, ends)
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)   !! (nside)
    type(division_t), intent(in) :: division
    real(wp), intent(in) :: gradation
    integer, intent(out) :: first(:)                !! (nside + 1)
    real(wp), allocatable, intent(out) :: ends(:)   !! (first(nside + 1) - 1) [length]
    integer, allocatable :: order(:)
    integer :: sides_at(size(layout%points)), s, i, last

    first(1) = 1
    sides_at = 0
    do s = 1, size(curves)
      first(s + 1) = first(s) + division%count(s) + 1
      sides_at(layout%sides(s)%points) = sides_at(layout%sides(s)%points) + 1
    end do
    allocate (ends(first(size(first)) - 1))
    do s = 1, size(curves)
      call divide_curve(curves(s), division%count(s), ends(first(s):first(s + 1) - 1))
    end do
    call order_along(layout, curves, order)
    i = 1
    do while (i <= size(order))
      last = i
      do while (last < size(order))
        if (curves(order(last + 1))%boundary /= curves(order(i))%boundary) exit
        last = last + 1
      end do
      call even_boundary(layout, curves, division, gradation, sides_at, order(i:last), first, ends)
      i = last + 1
    end do
  end subroutine divide_sides

  !> Sides on the contour, sorted by boundary curve and position.
  pure subroutine order_along(layout, curves, order)
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)          !! (nside)
    integer, allocatable, intent(out) :: order(:)   !! (n)
    integer :: list(size(curves)), s, i, n

    n = 0
    do s = 1, size(curves)
      if (layout%sides(s)%form /= follows_contour) cycle
      i = n
      do while (i > 0)
        associate (other => curves(list(i)))
          if (other%boundary < curves(s)%boundary .or. (other%boundary == curves(s)%boundary &
                                                        .and. other%start < curves(s)%start)) exit
        end associate
        list(i + 1) = list(i)
        i = i - 1
      end do
      list(i + 1) = s
      n = n + 1
    end do
    allocate (order(n))
    order = list(:n)
  end subroutine order_along

  !> Smooth the sizes along one boundary curve, between corners of single zones.
  pure subroutine even_boundary(layout, curves, division, gradation, sides_at, order, first, ends)
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)
    type(division_t), intent(in) :: division
    real(wp), intent(in) :: gradation
    integer, intent(in) :: sides_at(:), order(:), first(:)
    real(wp), intent(inout) :: ends(:)
    integer :: sequence(size(order)), start, i, k, n

    n = size(order)
    start = 1
    do i = n, 1, -1
      if (begins_sequence(order(i))) start = i
    end do
    k = 0
    do i = 1, n
      k = k + 1
      sequence(k) = order(mod(start + i - 2, n) + 1)
      if (i < n) then
        if (.not. begins_sequence(order(mod(start + i - 1, n) + 1))) cycle
      end if
      call even_sequence(curves, division, gradation, sequence(:k),.not. begins_sequence(sequence(1)), first, ends)
      k = 0
    end do

  contains

    pure function begins_sequence(side) result(yes)
      integer, intent(in) :: side
      logical :: yes

      yes = sides_at(layout%sides(side)%points(1)) == 2
    end function begins_sequence

  end subroutine even_boundary

  pure subroutine even_sequence(curves, division, gradation, sequence, closed, first, ends)
    type(curve_t), intent(in) :: curves(:)
    type(division_t), intent(in) :: division
    real(wp), intent(in) :: gradation
    integer, intent(in) :: sequence(:), first(:)
    logical, intent(in) :: closed
    real(wp), intent(inout) :: ends(:)
    real(wp) :: h(sum(division%count(sequence)))
    integer, allocatable :: shares(:)
    integer :: i, k, s, n, total

    total = 0
    do i = 1, size(sequence)
      total = total + size(curves(sequence(i))%needs)
    end do
    allocate (shares(total))
    n = 0
    k = 0
    do i = 1, size(sequence)
      s = sequence(i)
      h(n + 1:n + division%count(s)) = ends(first(s) + 1:first(s + 1) - 1) - ends(first(s):first(s + 1) - 2)
      shares(k + 1:k + size(curves(s)%needs)) = shares_of(curves(s), division%count(s))
      n = n + division%count(s)
      k = k + size(curves(s)%needs)
    end do
    call even_out(shares, gradation, closed, h)
    n = 0
    do i = 1, size(sequence)
      s = sequence(i)
      ! from break to break: breaks are not moved
      do k = 1, division%count(s) - 1
        if (any(abs(ends(first(s) + k) - curves(s)%breaks) <= 0)) cycle
        ends(first(s) + k) = ends(first(s) + k - 1) + h(n + k)
      end do
      n = n + division%count(s)
    end do
  end subroutine even_sequence

  !> Sizes that differ from a neighbour by more than the gradation are moved toward the geometric mean of both neighbours, so that a
  !> geometric progression is not changed. Each part keeps its length.
  pure subroutine even_out(shares, gradation, closed, h)
    integer, intent(in) :: shares(:)   !! (npart) elements of each part
    real(wp), intent(in) :: gradation
    logical, intent(in) :: closed     !! the first element follows the last
    real(wp), intent(inout) :: h(:)   !! (n) sizes [length]
    real(wp) :: new(size(h)), before, after
    integer :: pass, p, k, i, n
    logical :: even

    n = size(h)
    do pass = 1, passes
      new = h
      even = .true.
      do i = 1, n
        before = h(merge(i - 1, merge(n, 1, closed), i > 1))
        after = h(merge(i + 1, merge(1, n, closed), i < n))
        if (max(before/h(i), h(i)/before, after/h(i), h(i)/after) <= from_share*gradation) cycle
        new(i) = sqrt(h(i)*sqrt(before*after))
        even = even .and. max(before/h(i), h(i)/before, after/h(i), h(i)/after) <= gradation
      end do
      if (even) return
      k = 0
      do p = 1, size(shares)
        associate (old => h(k + 1:k + shares(p)), part => new(k + 1:k + shares(p)))
          part = part*sum(old)/sum(part)
        end associate
        k = k + shares(p)
      end do
      h = new
    end do
  end subroutine even_out

end module contour_divisions
