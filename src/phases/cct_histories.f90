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
    type(dual_t) :: rate, share, first(3), second(3)
    integer :: k, i

    increments = dual_t()
    if (.not. (to%value < from%value .and. time%value > 0)) return
    if (to%value >= cct%hottest .or. from%value <= cct%coldest) return
    rate = log((from - to)/time)
    if (abs(cct%grain_factor) > 0) rate = rate + cct%grain_factor*(grain - cct%grain_reference)
    if (rate%value < cct%log_rate(1)) rate = dual_t(cct%log_rate(1))
    if (rate%value > cct%log_rate(cct%n)) rate = dual_t(cct%log_rate(cct%n))
    call nearest_place(cct, rate, from, z, k, share)
    first = change_along(cct, k, from, to)
    second = change_along(cct, k + 1, from, to)
    do i = 1, 3
      ! (1 - share) first + share second, written out: it is done in every sub-step of every point
      increments(i)%value = (1 - share%value)*first(i)%value + share%value*second(i)%value
      increments(i)%slope = (-share%slope*first(i)%value + (1 - share%value)*first(i)%slope) &
                            + (share%slope*second(i)%value + share%value*second(i)%slope)
    end do
  end subroutine cct_increments

  !> History k, and the share of the next one, nearest to a rate and fractions.
  pure subroutine nearest_place(cct, rate, temperature, z, k, share)
    type(histories_t), intent(in) :: cct
    type(dual_t), intent(in) :: rate, temperature, z(3)
    integer, intent(out) :: k
    type(dual_t), intent(out) :: share
    type(dual_t) :: a(3), b(3), along, length
    real(wp) :: here(4), from(4), to(4), s, distance, best, within
    integer :: h, i, reached

    here = [rate%value, z%value]
    ! the line across the rate itself: those that are farther away by their rates alone need not be asked
    h = 1
    do while (h < cct%n - 1)
      if (rate%value <= cct%log_rate(h + 1)) exit
      h = h + 1
    end do
    call measure_line(here, place_of(cct, h, temperature%value), place_of(cct, h + 1, temperature%value), s, within)
    within = within*(1 + sqrt(epsilon(within)))
    best = huge(best)
    k = h
    reached = 0
    do h = 1, cct%n - 1
      if (max(0.0_wp, here(1) - cct%log_rate(h + 1), cct%log_rate(h) - here(1))**2 > within) cycle
      if (reached == h) then
        from = to
      else
        from = place_of(cct, h, temperature%value)
      end if
      to = place_of(cct, h + 1, temperature%value)
      reached = h + 1
      call measure_line(here, from, to, s, distance)
      if (distance >= best) cycle
      best = distance
      k = h
    end do
    ! the same again for the nearest line, with its derivative
    length = dual_t(log(cct%rate(k + 1)/cct%rate(k)))
    along = (rate - cct%log_rate(k))*length
    length = length*length
    a = fractions_at(cct, k, temperature)
    b = fractions_at(cct, k + 1, temperature)
    do i = 1, 3
      b(i) = dual_t(b(i)%value - a(i)%value, b(i)%slope - a(i)%slope)
      along%value = along%value + (z(i)%value - a(i)%value)*b(i)%value
      along%slope = along%slope + ((z(i)%slope - a(i)%slope)*b(i)%value + (z(i)%value - a(i)%value)*b(i)%slope)
      length%value = length%value + b(i)%value*b(i)%value
      length%slope = length%slope + (b(i)%slope*b(i)%value + b(i)%value*b(i)%slope)
    end do
    share = along/length
    if (share%value <= 0) share = dual_t(0.0_wp)
    if (share%value >= 1) share = dual_t(1.0_wp)
  end subroutine nearest_place

  !> The share of a line between two places that is nearest to a third one, and the square of its distance.
  pure subroutine measure_line(here, from, to, share, distance)
    real(wp), intent(in) :: here(4), from(4), to(4)
    real(wp), intent(out) :: share, distance
    real(wp) :: line(4)

    line = to - from
    share = max(0.0_wp, min(1.0_wp, dot_product(here - from, line)/dot_product(line, line)))
    distance = sum((here - from - share*line)**2)
  end subroutine measure_line

  !> ln(rate) and fractions of history k at a temperature.
  pure function place_of(cct, k, temperature) result(place)
    type(histories_t), intent(in) :: cct
    integer, intent(in) :: k
    real(wp), intent(in) :: temperature
    real(wp) :: place(4)
    real(wp) :: share
    integer :: p

    place(1) = cct%log_rate(k)
    p = point_before(cct, k, temperature)
    if (p < cct%first(k)) then
      place(2:) = cct%z(:, cct%first(k))
    else if (p == cct%first(k + 1) - 1) then
      place(2:) = cct%z(:, p)
    else
      share = (temperature - cct%t(p))/(cct%t(p + 1) - cct%t(p))
      place(2:) = (1 - share)*cct%z(:, p) + share*cct%z(:, p + 1)
    end if
  end function place_of

  !> Fractions of history k at a temperature: linear between its points, constant outside.
  pure function fractions_at(cct, k, temperature) result(z)
    type(histories_t), intent(in) :: cct
    integer, intent(in) :: k   !! history
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: z(3)   !! ferrite, pearlite, bainite
    integer :: p, i
    real(wp) :: slope

    p = point_before(cct, k, temperature%value)
    do i = 1, 3
      if (p < cct%first(k)) then
        z(i) = dual_t(cct%z(i, cct%first(k)))
      else if (p == cct%first(k + 1) - 1) then
        z(i) = dual_t(cct%z(i, p))
      else
        slope = (cct%z(i, p + 1) - cct%z(i, p))/(cct%t(p + 1) - cct%t(p))
        z(i) = dual_t(cct%z(i, p) + slope*(temperature%value - cct%t(p)), slope*temperature%slope)
      end if
    end do
  end function fractions_at

  !> Point of history k behind which a temperature is on the way down: one less than the first above all of them, the last below.
  pure function point_before(cct, k, temperature) result(p)
    type(histories_t), intent(in) :: cct
    integer, intent(in) :: k
    real(wp), intent(in) :: temperature   !! [degC]
    integer :: p

    associate (first => cct%first(k), last => cct%first(k + 1) - 1)
      if (temperature >= cct%t(first)) then
        p = first - 1
      else if (temperature <= cct%t(last)) then
        p = last
      else
        do p = first, last - 2
          if (temperature > cct%t(p + 1)) exit
        end do
      end if
    end associate
  end function point_before

  !> Fractions that history k gains on the way from a temperature to another.
  pure function change_along(cct, k, from, to) result(change)
    type(histories_t), intent(in) :: cct
    integer, intent(in) :: k
    type(dual_t), intent(in) :: from, to   !! [degC]
    type(dual_t) :: change(3)
    type(dual_t) :: before(3)

    before = fractions_at(cct, k, from)
    change = fractions_at(cct, k, to)
    change%value = change%value - before%value
    change%slope = change%slope - before%slope
  end function change_along

end module cct_histories
