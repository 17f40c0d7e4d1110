!> Contact variables carried along the contour by arc length, from entry to exit of the same contact interval; the force on a die.
!>
!> Arc lengths of the new interval are scaled to the length of the old one, so that entry meets entry and exit meets exit. Between
!> the old points values are linear; with NPT > 2 each new value is that of the straight line fitted to the NPT nearest old points,
!> weighted by nearness, which smooths the noise of penalty and time integration. Values stay in the range of the old points they
!> are computed from. The correction `v + lambda |v|` restores the integral along the interval and changes no zero: a pressure is
!> scaled.
module transfer_contact
  use kinds, only: wp
  implicit none
  private
  public :: carry_along

contains

  !> Values (component, point) at the new points of an interval from those at the old ones, both in the order of the contour.
  pure subroutine carry_along(length_old, s_old, old, weight_old, length_new, s_new, weight_new, smoothing, conserve, new, change)
    real(wp), intent(in) :: length_old, length_new         !! of the interval from entry to exit [length]
    real(wp), intent(in) :: s_old(:), s_new(:)             !! (npoint) arc length from the entry, not decreasing [length]
    real(wp), intent(in) :: old(:, :)                      !! (component, npoint) at the old points [unit of the variable]
    real(wp), intent(in) :: weight_old(:), weight_new(:)   !! (npoint) [length], or times the radius [length^2]
    integer, intent(in) :: smoothing                       !! NPT: points of the fitted line; 2 or less: none
    logical, intent(in) :: conserve                        !! restore the integrals
    real(wp), intent(out) :: new(:, :)                     !! (component, npoint) at the new points [unit of the variable]
    real(wp), intent(out) :: change(:)  !! (component) change of the integrals by the transfer, before the correction [unit length]
    real(wp) :: weight(size(s_old)), s, before, after, missing, magnitude
    integer :: p, c, first, last

    new = 0
    change = 0
    if (size(s_old) == 0) return
    do p = 1, size(s_new)
      s = s_new(p)
      if (length_new > 0) s = s*(length_old/length_new)
      call line_weights(s_old, s, smoothing, first, last, weight)
      do c = 1, size(old, 1)
   new(c, p) = min(maxval(old(c, first:last)), max(minval(old(c, first:last)), dot_product(weight(first:last), old(c, first:last))))
      end do
    end do
    do c = 1, size(old, 1)
      before = sum(old(c, :)*weight_old)
      after = sum(new(c, :)*weight_new)
      missing = before - after
      change(c) = -missing
      magnitude = sum(abs(new(c, :))*weight_new)
      if (conserve .and. magnitude > abs(missing)) new(c, :) = new(c, :) + (missing/magnitude)*abs(new(c, :))
    end do
  end subroutine carry_along

  !> Weights of old points first ... last for the value at s: straight between two, or a fitted line.
  pure subroutine line_weights(s_old, s, smoothing, first, last, weight)
    real(wp), intent(in) :: s_old(:), s
    integer, intent(in) :: smoothing
    integer, intent(out) :: first, last
    real(wp), intent(inout) :: weight(:)
    real(wp) :: kernel, total, mean, spread_of, reach, part
    integer :: requested, n, k

    n = size(s_old)
    requested = min(n, max(2, smoothing))
    last = 1 + count(s_old(2:) <= s)
    first = last
    do while (last - first + 1 < requested)
      if (first == 1) then
        last = last + 1
      else if (last == n) then
        first = first - 1
      else if (requested == 2 .or. s_old(last + 1) - s <= s - s_old(first - 1)) then
        ! the two of a plain interpolation are those on either side
        last = last + 1
      else
        first = first - 1
      end if
    end do
    ! the line sum k (a + b (s_k - s) - v_k)^2 -> least, its value a
    reach = max(abs(s_old(first) - s), abs(s_old(last) - s))
    weight(first:last) = 1
    if (requested > 2 .and. reach > 0) weight(first:last) = 1 - 0.75_wp*(abs(s_old(first:last) - s)/reach)**2
    total = sum(weight(first:last))
    mean = sum(weight(first:last)*s_old(first:last))/total
    spread_of = sum(weight(first:last)*(s_old(first:last) - mean)**2)
    do k = first, last
      kernel = weight(k)
      part = 0
      if (spread_of > 0) part = (s - mean)*(s_old(k) - mean)/spread_of
      weight(k) = kernel*(1/total + part)
    end do
  end subroutine line_weights

end module transfer_contact
