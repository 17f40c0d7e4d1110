!> Ranges of values after a transfer: scalars of the history, and fractions.
module transfer_limits
  use kinds, only: wp
  implicit none
  private
  public :: clip, fractions_rule, keep_fractions, sum_is_free, sum_at_most_one, sum_is_one

  !> Constraint on the sum of the fractions of a material.
  integer, parameter :: sum_is_free = 0, sum_at_most_one = 1, sum_is_one = 2
  !> Tolerance on sums of fractions: round-off of many steps and transfers.
  real(wp), parameter :: same_sum = 1.0e-6_wp

contains

  !> Limit values to their ranges; `share` is the share of the volume whose points were outside.
  pure subroutine clip(volumes, lower, upper, values, share)
    real(wp), intent(in) :: volumes(:), lower(:), upper(:)   !! (npoint) [volume]; limits (npoint) [unit of the variable]
    real(wp), intent(inout) :: values(:)                     !! (npoint) [unit of the variable]
    real(wp), intent(out) :: share

    share = sum(volumes, mask=values < lower .or. values > upper)/max(sum(volumes), tiny(1.0_wp))
    values = min(upper, max(lower, values))
  end subroutine clip

  !> The rule that fractions (fraction, point) obey: phases add up to 1, some of them to no more, unlike fractions to anything.
  pure function fractions_rule(fractions) result(rule)
    real(wp), intent(in) :: fractions(:, :)   !! (nfraction, npoint) [-]
    integer :: rule
    real(wp) :: sums(size(fractions, 2))

    sums = sum(fractions, 1)
    rule = sum_is_free
    if (all(sums <= 1 + same_sum)) rule = sum_at_most_one
    if (all(abs(sums - 1) <= same_sum)) rule = sum_is_one
  end function fractions_rule

  !> Fractions of a point limited to 0 and 1, with their sum according to the rule.
  pure subroutine keep_fractions(rule, fractions)
    integer, intent(in) :: rule
    real(wp), intent(inout) :: fractions(:)   !! (nfraction) [-]
    real(wp) :: total

    fractions = min(1.0_wp, max(0.0_wp, fractions))
    total = sum(fractions)
    if (.not. total > 0) return
    if (rule == sum_is_one .or. (rule == sum_at_most_one .and. total > 1)) fractions = fractions/total
  end subroutine keep_fractions

end module transfer_limits
