!> Fractions from the cooling histories of a CCT diagram.
!>
!> As M. Waeckel's model (M. Waeckel, P. Dupas, S. Andrieux, Adv. Comput. Methods in Materials Modelling (1994)): the rate of
!> transformation is a function of the fractions z, the cooling rate and the temperature, known along measured coolings at constant
!> rates and interpolated between. At each temperature the histories are points of the space of ln(rate) and z, and lines between
!> neighbouring rates; the place on them that is nearest to the present rate and fractions says how the fractions go on: by the
!> difference of the histories at both ends of the sub-step. So each history is met exactly, by any step. Rates beyond those of the
!> diagram count as its first or last; the distance weighs a factor e in rate as a difference of 1 in a fraction. Histories hold
!> down to Ms.
module cct_histories
  use dual_numbers, only: dual_t, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: histories_t
  implicit none
  private
  public :: cct_increments

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
    if (to%value >= cct%hottest .or. from%value <= cct%coldest) return
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
    type(dual_t) :: a, b, along, length
    real(wp) :: here(4), from(4), to(4), line(4), s, distance, best
    integer :: h, i

    best = huge(best)
    k = 1
    here = [rate%value, z%value]
    to = place_of(cct, 1, temperature%value)
    do h = 1, cct%n - 1
      from = to
      to = place_of(cct, h + 1, temperature%value)
      line = to - from
      s = max(0.0_wp, min(1.0_wp, dot_product(here - from, line)/dot_product(line, line)))
      distance = sum((here - from - s*line)**2)
      if (distance >= best) cycle
      best = distance
      k = h
    end do
    ! the same again for the nearest line, with its derivative
    b = dual_t(log(cct%rate(k + 1)/cct%rate(k)))
    along = (rate - log(cct%rate(k)))*b
    length = b*b
    do i = 1, 3
      a = history_at(cct, k, i, temperature)
      b = history_at(cct, k + 1, i, temperature) - a
      along = along + (z(i) - a)*b
      length = length + b*b
    end do
    share = along/length
    if (share%value <= 0) share = dual_t(0.0_wp)
    if (share%value >= 1) share = dual_t(1.0_wp)
  end subroutine nearest_place

  !> ln(rate) and fractions of history k at a temperature.
  pure function place_of(cct, k, temperature) result(place)
    type(histories_t), intent(in) :: cct
    integer, intent(in) :: k
    real(wp), intent(in) :: temperature
    real(wp) :: place(4)
    real(wp) :: share
    integer :: p

    place(1) = log(cct%rate(k))
    associate (first => cct%first(k), last => cct%first(k + 1) - 1)
      if (temperature >= cct%t(first)) then
        place(2:) = cct%z(:, first)
      else if (temperature <= cct%t(last)) then
        place(2:) = cct%z(:, last)
      else
        do p = first, last - 2
          if (temperature > cct%t(p + 1)) exit
        end do
        share = (temperature - cct%t(p))/(cct%t(p + 1) - cct%t(p))
        place(2:) = (1 - share)*cct%z(:, p) + share*cct%z(:, p + 1)
      end if
    end associate
  end function place_of

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
