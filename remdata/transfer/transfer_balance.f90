!> Change of integrals over the volume by a transfer, and the correction that restores them.
!>
!> The correction keeps the mean of a variable over its material; where the volume is kept so is the integral. (A change of volume
!> is due to the contour: it must not heat or harden the material, and a constant stays constant.) It respects ranges:
!> `v + lambda (v - a)(b - v)/(b - a)` with |lambda| <= 1 stays in [a, b] and does not change values at an end of their range, so
!> that regions without strain stay without, and peaks are kept.
module transfer_balance
  use kinds, only: eps, wp
  implicit none
  private
  public :: integral, keep_mean, keep_mean_fractions, same_integral

  !> Sweeps of the corrections; one is enough where |lambda| < 1.
  integer, parameter :: most_sweeps = 200
  !> Integrals that differ by less of the range times the volume are equal: the round-off of sums of a million points.
  real(wp), parameter :: same_integral = 1000*eps

contains

  pure function integral(values, volumes) result(total)
    real(wp), intent(in) :: values(:), volumes(:)   !! (npoint) [unit of the variable]; (npoint) [volume]
    real(wp) :: total

    total = sum(values*volumes)
  end function integral

  !> Values of the given integral in the range [lower, upper]; if the range does not allow it they are at its end.
  pure subroutine keep_mean(volumes, lower, upper, requested, values)
    real(wp), intent(in) :: volumes(:)     !! (npoint) [volume]
    real(wp), intent(in) :: lower, upper   !! of the material
    real(wp), intent(in) :: requested      !! integral
    real(wp), intent(inout) :: values(:)   !! (npoint) [unit of the variable]
    real(wp) :: missing, room, freedom(size(values))
    integer :: sweep

    if (.not. upper > lower) return
    do sweep = 1, most_sweeps
      missing = requested - integral(values, volumes)
      if (abs(missing) <= same_integral*(upper - lower)*sum(volumes)) exit
      freedom = max(0.0_wp, values - lower)*max(0.0_wp, upper - values)/(upper - lower)
      room = integral(freedom, volumes)
      if (.not. room > tiny(1.0_wp)) exit
      values = min(upper, max(lower, values + max(-1.0_wp, min(1.0_wp, missing/room))*freedom))
    end do
  end subroutine keep_mean

  !> Fractions (fraction, point) whose sums are 1 at every point and whose integrals are the given ones: each is multiplied by a
  !> factor of its own, then all of a point are divided by their sum (W.E. Deming, F.F. Stephan, Ann. Math. Stat. 11 (1940) 427).
  !> The factors are found one by one in Newton's steps of their logarithms, d integral(v)/d log(factor) = integral(v (1 - v)).
  pure subroutine keep_mean_fractions(volumes, requested, values)
    real(wp), intent(in) :: volumes(:), requested(:)   !! (npoint) [volume]; (nfraction) integrals [volume]
    real(wp), intent(inout) :: values(:, :)            !! (nfraction, npoint) [-]
    real(wp) :: missing, freedom, worst
    integer :: sweep, i, p

    do sweep = 1, most_sweeps
      worst = 0
      do i = 1, size(requested)
        missing = requested(i) - integral(values(i, :), volumes)
        freedom = integral(values(i, :)*(1 - values(i, :)), volumes)
        worst = max(worst, abs(missing))
        if (.not. freedom > tiny(1.0_wp)) cycle
        values(i, :) = values(i, :)*exp(max(-1.0_wp, min(1.0_wp, missing/freedom)))
        do p = 1, size(volumes)
          values(:, p) = values(:, p)/sum(values(:, p))
        end do
      end do
      if (worst <= same_integral*sum(volumes)) exit
    end do
  end subroutine keep_mean_fractions

end module transfer_balance
