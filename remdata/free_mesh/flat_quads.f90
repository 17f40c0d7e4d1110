!> Quadrilaterals with a flat corner on the contour are replaced.
!>
!> Where two consecutive sides of an element lie on a smooth contour, its corner between them has 180 degrees for any position
!> of its other nodes. With a neighbour it forms a hexagon, which another one of its long diagonals divides as well:
!> ```
!>     d --- q         d --- q
!>     |  \  |         |     |       b is smooth: the element a b c d replaces its side c d, or d a,
!>     a    \ p   ->   a     p       by one from b, whichever gives the better worse half
!>      \   /           \  / /
!>       b-c             b--c
!> ```
!> Where this only makes the next corner flat, as at a round corner of a part, a layer of three nodes is inserted
!> between the contour and d:
!> ```
!>     v --- d --- w        v --- d --- w
!>     |     |     |        | m --m-- m |      m are new, the middle one between b and d;
!>     |     |     |   ->   | |   |   | |      v and w keep their other sides
!>     r --- a b c s        r a   b   c s
!> ```
module flat_quads
  use kinds, only: wp
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: open_flat_corners

  !> Halves with a smaller sine at a corner are not accepted.
  real(wp), parameter :: least_sine = 0.3_wp

contains

  pure subroutine open_flat_corners(next, smooth, x, corners, zone)
    integer, intent(in) :: next(:)  !! (npoint) next point along the contour of each; points of contours come first
    logical, intent(in) :: smooth(:)                       !! (npoint) the contour has no corner at this point
    real(wp), allocatable, intent(inout) :: x(:, :)        !! (2, nend) [length]
    integer, allocatable, intent(inout) :: corners(:, :)   !! (4, nelem) counter-clockwise
    integer, allocatable, intent(inout) :: zone(:)         !! (nelem)
    integer :: e, k
    logical :: swapped

    do e = 1, size(corners, 2)
      do k = 1, 4
        if (.not. is_flat(next, smooth, corners(modulo(k - 2, 4) + 1, e), corners(k, e), corners(mod(k, 4) + 1, e))) cycle
        call swap_side(next, smooth, x, e, k, corners, swapped)
        if (.not. swapped) call add_layer(size(next), e, k, x, corners, zone)
        exit
      end do
    end do
  end subroutine open_flat_corners

  !> Are two sides of an element consecutive on a smooth contour?
  pure function is_flat(next, smooth, before, node, after) result(flat)
    integer, intent(in) :: next(:)
    logical, intent(in) :: smooth(:)
    integer, intent(in) :: before, node, after
    logical :: flat

    flat = .false.
    if (max(before, node) > size(next)) return
    flat = next(before) == node .and. next(node) == after .and. smooth(node)
  end function is_flat

  !> Exchange a side of element e, flat at its corner k, with the better of two neighbours, if either is good enough.
  pure subroutine swap_side(next, smooth, x, e, k, corners, swapped)
    integer, intent(in) :: next(:)
    logical, intent(in) :: smooth(:)
    real(wp), intent(in) :: x(:, :)
    integer, intent(in) :: e, k
    integer, intent(inout) :: corners(:, :)
    logical, intent(out) :: swapped
    integer :: a, b, c, d, p, q, other, best_other, halves(4, 2), best(4, 2), option
    real(wp) :: worst, best_worst

    a = corners(modulo(k - 2, 4) + 1, e)
    b = corners(k, e)
    c = corners(mod(k, 4) + 1, e)
    d = corners(mod(k + 1, 4) + 1, e)
    best_worst = least_sine
    best_other = 0
    do option = 1, 2
      if (option == 1) then
        call element_across(corners, c, d, other, p, q)
        halves = reshape([a, b, q, d, b, c, p, q], [4, 2])
      else
        call element_across(corners, d, a, other, p, q)
        halves = reshape([b, c, d, p, a, b, p, q], [4, 2])
      end if
      if (other == 0) cycle
      worst = min(quality(next, smooth, x, halves(:, 1)), quality(next, smooth, x, halves(:, 2)))
      if (.not. worst > best_worst) cycle
      best_worst = worst
      best_other = other
      best = halves
    end do
    swapped = best_other > 0
    if (.not. swapped) return
    corners(:, e) = best(:, 1)
    corners(:, best_other) = best(:, 2)
  end subroutine swap_side

  !> Insert three nodes and three elements in an element whose corner opposite to the flat one is inside.
  pure subroutine add_layer(ncontour, e, k, x, corners, zone)
    integer, intent(in) :: ncontour, e, k
    real(wp), allocatable, intent(inout) :: x(:, :)
    integer, allocatable, intent(inout) :: corners(:, :), zone(:)
    real(wp), allocatable :: more_x(:, :)
    integer, allocatable :: more(:, :)
    integer :: a, b, c, d, before, after, r, s, v, w, n, m(3), last

    a = corners(modulo(k - 2, 4) + 1, e)
    b = corners(k, e)
    c = corners(mod(k, 4) + 1, e)
    d = corners(mod(k + 1, 4) + 1, e)
    call element_across(corners, d, a, before, v, r)
    call element_across(corners, c, d, after, s, w)
    if (d <= ncontour .or. before == 0 .or. after == 0) return
    n = size(x, 2)
    m = n + [1, 2, 3]
    allocate (more_x(2, n + 3))
    more_x(:, :n) = x
    more_x(:, m(1)) = 0.5_wp*x(:, a) + 0.25_wp*(x(:, d) + x(:, v))
    more_x(:, m(2)) = 0.5_wp*(x(:, b) + x(:, d))
    more_x(:, m(3)) = 0.5_wp*x(:, c) + 0.25_wp*(x(:, d) + x(:, w))
    call move_alloc(more_x, x)
    last = size(corners, 2)
    allocate (more(4, last + 3))
    more(:, :last) = corners
    where (more(:, before) == d) more(:, before) = m(1)
    where (more(:, after) == d) more(:, after) = m(3)
    more(:, e) = [a, b, m(2), m(1)]
    more(:, last + 1) = [b, c, m(3), m(2)]
    more(:, last + 2) = [m(1), m(2), d, v]
    more(:, last + 3) = [m(2), m(3), w, d]
    call move_alloc(more, corners)
    zone = [zone, spread(zone(e), 1, 3)]
  end subroutine add_layer

  !> The element that has the side from `first` to `second` in the opposite direction, and its two nodes after `first`; 0 where
  !> there is none.
  pure subroutine element_across(corners, first, second, element, p, q)
    integer, intent(in) :: corners(:, :), first, second
    integer, intent(out) :: element, p, q
    integer :: e, k

    element = 0
    p = 1
    q = 1
    do e = 1, size(corners, 2)
      do k = 1, 4
        if (corners(k, e) /= second .or. corners(mod(k, 4) + 1, e) /= first) cycle
        element = e
        p = corners(mod(k + 1, 4) + 1, e)
        q = corners(mod(k + 2, 4) + 1, e)
        return
      end do
    end do
  end subroutine element_across

  !> Smallest sine at the corners of an element; 0 at a flat one.
  pure function quality(next, smooth, x, nodes) result(least)
    integer, intent(in) :: next(:), nodes(4)
    logical, intent(in) :: smooth(:)
    real(wp), intent(in) :: x(:, :)
    real(wp) :: least
    real(wp) :: to(2), from(2)
    integer :: k

    least = 1
    do k = 1, 4
      associate (before => nodes(modulo(k - 2, 4) + 1), node => nodes(k), after => nodes(mod(k, 4) + 1))
        to = x(:, after) - x(:, node)
        from = x(:, before) - x(:, node)
        least = min(least, cross(to, from)/(length_of(to)*length_of(from)))
        if (is_flat(next, smooth, before, node, after)) least = 0
      end associate
    end do
  end function quality

end module flat_quads
