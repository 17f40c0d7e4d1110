!> Means of multipliers over steps: of heat that is stated by one, a step takes its share, whatever its length.
module multiplier_means
  use kinds, only: wp
  use loads, only: multiplier_at, multiplier_t
  implicit none
  private
  public :: mean_of_multiplier

contains

  !> Mean over a span of time; linear between the points, constant before and after them.
  pure function mean_of_multiplier(multiplier, from, to) result(mean)
    type(multiplier_t), intent(in) :: multiplier
    real(wp), intent(in) :: from, to   !! from < to [time]
    real(wp) :: mean                   !! [-]
    real(wp) :: ends(2), values(2), total
    integer :: i

    ends(1) = from
    values(1) = multiplier_at(multiplier, from)
    total = 0
    do i = 1, size(multiplier%time) + 1
      ends(2) = to
      if (i <= size(multiplier%time)) ends(2) = min(max(multiplier%time(i), from), to)
      values(2) = multiplier_at(multiplier, ends(2))
      total = total + 0.5_wp*sum(values)*(ends(2) - ends(1))
      ends(1) = ends(2)
      values(1) = values(2)
    end do
    mean = total/(to - from)
  end function mean_of_multiplier

end module multiplier_means
