!> Fractions from the cooling histories of a CCT diagram.
!>
!> As M. Waeckel's model (M. Waeckel, P. Dupas, S. Andrieux, Adv. Comput. Methods in Materials Modelling (1994)): the rate of
!> transformation is a function of the fractions z, the cooling rate and the temperature, known along measured coolings at constant
!> rates and interpolated between. At each temperature the histories are points of the space of ln(rate) and z, and lines between
!> neighbouring rates; the place on them that is nearest to the present rate and fractions says how the fractions go on: by the
!> difference of the histories at both ends of the sub-step. So each history is met exactly, by any step. Rates beyond those of the
!> diagram count as its first or last; the distance weighs a factor e in rate as a difference of 1 in a fraction.
module cct_histories
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: histories_t
  implicit none
  private
  public :: cct_increments, history_at

contains

  !> Ferrite, pearlite and bainite that form on the way from a temperature to a lower one.
  pure subroutine cct_increments(cct, time, from, to, grain, z, increments)
    type(histories_t), intent(in) :: cct
    type(dual_t), intent(in) :: time         !! [s]
    type(dual_t), intent(in) :: from, to     !! temperatures [degC]
    type(dual_t), intent(in) :: grain        !! size of the austenite's grains [um]
    type(dual_t), intent(in) :: z(3)         !! ferrite, pearlite and bainite at the start
    type(dual_t), intent(out) :: increments(3)   !! [-]
    type(dual_t) :: rate, share
    integer :: k, i

    increments = dual_t()
    if (.not. (to%value < from%value .and. time%value > 0)) return
    rate = log((from - to)/time)
    if (abs(cct%grain_factor) > 0) rate = rate + cct%grain_factor*(grain - cct%grain_reference)
    if (rate%value < log(cct%rate(1))) rate = dual_t(log(cct%rate(1)))
    if (rate%value > log(cct%rate(cct%n))) rate = dual_t(log(cct%rate(cct%n)))
    call nearest_place(cct, rate, from, z, k, share)
    do i = 1, 3
      increments(i) = (1.0_wp - share)*(history_at(cct, k, i, to) - history_at(cct, k, i, from)) &
                      + share*(history_at(cct, k + 1, i, to) - history_at(cct, k + 1, i, from))
    end do
  end subroutine cct_increments

  !> History k, and the share of the next one, nearest to a rate and fractions.
  pure subroutine nearest_place(cct, rate, temperature, z, k, share)
    type(histories_t), intent(in) :: cct
    type(dual_t), intent(in) :: rate, temperature, z(3)
    integer, intent(out) :: k
    type(dual_t), intent(out) :: share
    type(dual_t) :: a(3), b(3), along, d, length, distance, s
    real(wp) :: low, best
    integer :: h, i

    best = huge(best)
    k = 1
    share = dual_t()
    do i = 1, 3
      b(i) = history_at(cct, 1, i, temperature)
    end do
    do h = 1, cct%n - 1
      a = b
      do i = 1, 3
        b(i) = history_at(cct, h + 1, i, temperature)
      end do
      low = log(cct%rate(h))
      d = dual_t(log(cct%rate(h + 1)) - low)
      along = (rate - low)*d
      length = d*d
      do i = 1, 3
        along = along + (z(i) - a(i))*(b(i) - a(i))
        length = length + (b(i) - a(i))*(b(i) - a(i))
      end do
      s = along/length
      if (s%value <= 0) s = dual_t(0.0_wp)
      if (s%value >= 1) s = dual_t(1.0_wp)
      distance = (rate - low - s*d)*(rate - low - s*d)
      do i = 1, 3
        distance = distance + (z(i) - a(i) - s*(b(i) - a(i)))*(z(i) - a(i) - s*(b(i) - a(i)))
      end do
      if (distance%value >= best) cycle
      best = distance%value
      k = h
      share = s
    end do
  end subroutine nearest_place

  !> Fraction i of history k at a temperature: linear between its points, constant outside.
  pure function history_at(cct, k, i, temperature) result(z)
    type(histories_t), intent(in) :: cct
    integer, intent(in) :: k   !! history
    integer, intent(in) :: i   !! 1: ferrite, 2: pearlite, 3: bainite
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: z
    integer :: p
    real(wp) :: slope

    associate (first => cct%first(k), last => cct%first(k + 1) - 1)
      if (temperature%value >= cct%t(first)) then
        z = dual_t(cct%z(i, first))
      else if (temperature%value <= cct%t(last)) then
        z = dual_t(cct%z(i, last))
      else
        do p = first, last - 2
          if (temperature%value > cct%t(p + 1)) exit
        end do
        slope = (cct%z(i, p + 1) - cct%z(i, p))/(cct%t(p + 1) - cct%t(p))
        z = dual_t(cct%z(i, p) + slope*(temperature%value - cct%t(p)), slope*temperature%slope)
      end if
    end associate
  end function history_at

end module cct_histories
