!> Kinetics from the composition: M.V. Li, D.V. Niebuhr, L.L. Meekisho, D.G. Atteridge, Metall. Mater. Trans. B 29 (1998) 661.
!>
!> At one temperature a share X of what can form takes the time S(X)/rate(T),
!> S(X) = int_0^X dx/(x^(0.4(1-x)) (1-x)^(0.4x)), rate = 2^(a G) (T_start - T)^p exp(-Q/RT)/factor(composition), with p = 3 for
!> ferrite and pearlite, 2 for bainite, Q = 27 500 cal/mol. The sum of rate dt is additive: the state is S itself. S is tabulated
!> over q, X = q^(5/3)/(q^(5/3) + (1-q)^(5/3)), in which it has finite slopes at both ends, and is cubic between.
module li_kinetics
  use ascending, only: count_up_to
  use dual_numbers, only: dual_t, exp, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: bainite, celsius_zero, composition_t, el_c, el_cr, el_mn, el_mo, el_ni, el_si, ferrite, gas_constant, &
                    kinetics_t, pearlite
  implicit none
  private
  public :: li_speed, li_power, li_table, li_rate, li_sum, li_progress, grow_li

  !> Calories are thermochemical [J/cal].
  real(wp), parameter :: activation = 27500*4.184_wp
  !> Ends of q: what is left of the phase there is below round-off.
  real(wp), parameter :: last_q = 1 - 1.0e-9_wp

contains

  !> Composition and grain size: 2^(a G)/factor [1/s/K^p].
  pure function li_speed(phase, composition, grain_number) result(speed)
    integer, intent(in) :: phase   !! ferrite, pearlite or bainite
    type(composition_t), intent(in) :: composition
    real(wp), intent(in) :: grain_number   !! ASTM number of the austenite's grain
    real(wp) :: speed

    speed = 0
    associate (w => composition%w)
      select case (phase)
      case (ferrite)
        speed = 2**(0.41_wp*grain_number)/exp(1 + 6.31_wp*w(el_c) + 1.78_wp*w(el_mn) + 0.31_wp*w(el_si) + 1.12_wp*w(el_ni) &
                                              + 2.70_wp*w(el_cr) + 4.06_wp*w(el_mo))
      case (pearlite)
        speed = 2**(0.32_wp*grain_number)/exp(-4.25_wp + 4.12_wp*w(el_c) + 4.36_wp*w(el_mn) + 0.44_wp*w(el_si) &
                                              + 1.71_wp*w(el_ni) + 3.33_wp*w(el_cr) + 5.19_wp*sqrt(w(el_mo)))
      case (bainite)
        speed = 2**(0.29_wp*grain_number)/exp(-10.23_wp + 10.18_wp*w(el_c) + 0.85_wp*w(el_mn) + 0.55_wp*w(el_ni) &
                                              + 0.90_wp*w(el_cr) + 0.36_wp*w(el_mo))
      end select
    end associate
  end function li_speed

  !> Power of the undercooling.
  pure function li_power(phase) result(power)
    integer, intent(in) :: phase
    integer :: power

    power = merge(2, 3, phase == bainite)
  end function li_power

  !> The sum that one second adds at a temperature.
  pure function li_rate(kinetics, temperature) result(rate)
    type(kinetics_t), intent(in) :: kinetics
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: rate                      !! [1/s]
    integer :: k

    rate = dual_t()
    if (temperature%value >= kinetics%high) return
    rate = kinetics%speed*exp(-activation/(gas_constant*(temperature + celsius_zero)))
    do k = 1, kinetics%power
      rate = rate*(kinetics%high - temperature)
    end do
  end function li_rate

  !> S and dS/dq at equal distances of q, by Gauss's rule of three points on four parts of each.
  pure subroutine li_table(n, total, slope)
    integer, intent(in) :: n   !! number of intervals
    real(wp), allocatable, intent(out) :: total(:), slope(:)   !! (n+1) [-]
    real(wp), parameter :: place(3) = [-sqrt(0.6_wp), 0.0_wp, sqrt(0.6_wp)], weight(3) = [5.0_wp, 8.0_wp, 5.0_wp]/18
    integer, parameter :: parts = 4
    real(wp) :: h, middle
    integer :: k, p, i

    allocate (total(n + 1), slope(n + 1))
    h = 1.0_wp/(n*parts)
    total(1) = 0
    do k = 1, n + 1
      slope(k) = integrand(real(k - 1, wp)/n)
      if (k == 1) cycle
      total(k) = total(k - 1)
      do p = 1, parts
        middle = ((k - 2)*parts + p - 0.5_wp)*h
        do i = 1, 3
          total(k) = total(k) + weight(i)*h*integrand(middle + 0.5_wp*h*place(i))
        end do
      end do
    end do
  end subroutine li_table

  !> dS/dq. At the ends its limits 5/3, where dX/dq and the integrand of S compensate.
  pure function integrand(q) result(value)
    real(wp), intent(in) :: q
    real(wp) :: value
    real(wp) :: x, rest

    value = 5.0_wp/3
    if (.not. (q > 0 .and. q < 1)) return
    call share_of(q, x, rest)
    value = 5.0_wp/3*x*rest/(q*(1 - q))/(x**(0.4_wp*rest)*rest**(0.4_wp*x))
  end function integrand

  !> X and 1 - X at q.
  pure subroutine share_of(q, x, rest)
    real(wp), intent(in) :: q
    real(wp), intent(out) :: x, rest
    real(wp) :: a, b

    a = q**(5.0_wp/3)
    b = (1 - q)**(5.0_wp/3)
    x = a/(a + b)
    rest = b/(a + b)
  end subroutine share_of

  !> S(X).
  pure function li_sum(total, slope, share) result(sum_of_share)
    real(wp), intent(in) :: total(:), slope(:)   !! (n+1) of li_table [-]
    real(wp), intent(in) :: share                !! X
    real(wp) :: sum_of_share
    real(wp) :: q, ratio, derivative
    integer :: n, k

    sum_of_share = 0
    if (share <= 0) return
    n = size(total) - 1
    sum_of_share = total(n + 1)
    if (share >= 1) return
    ratio = (share/(1 - share))**0.6_wp
    q = ratio/(1 + ratio)
    k = min(n, int(q*n) + 1)
    call cubic(total, slope, k, q*n - (k - 1), sum_of_share, derivative)
  end function li_sum

  !> S(X) with its derivative, for the progress of a share that is there.
  pure function li_progress(total, slope, share) result(progress)
    real(wp), intent(in) :: total(:), slope(:)   !! (n+1) of li_table [-]
    type(dual_t), intent(in) :: share            !! X
    type(dual_t) :: progress                     !! S [-]

    progress%value = li_sum(total, slope, share%value)
    if (.not. (share%value > 0 .and. share%value < 1)) return
    progress%slope = share%slope/(share%value**(0.4_wp*(1 - share%value))*(1 - share%value)**(0.4_wp*share%value))
  end function li_progress

  !> Value and derivative by u of the cubic of interval k, u from 0 to 1 in it.
  pure subroutine cubic(total, slope, k, u, value, derivative)
    real(wp), intent(in) :: total(:), slope(:), u
    integer, intent(in) :: k
    real(wp), intent(out) :: value, derivative
    real(wp) :: d, a, b

    d = total(k + 1) - total(k)
    a = slope(k)/(size(total) - 1) - d
    b = d - slope(k + 1)/(size(total) - 1)
    value = total(k) + u*d + u*(1 - u)*(a*(1 - u) + b*u)
    derivative = d + (1 - 2*u)*(a*(1 - u) + b*u) + u*(1 - u)*(b - a)
  end subroutine cubic

  !> Growth over a time at one temperature: S is advanced, and `extended` is ln((1-X)/(1-X')), by which what can form shrinks.
  pure subroutine grow_li(kinetics, total, slope, time, temperature, progress, extended)
    type(kinetics_t), intent(in) :: kinetics
    real(wp), intent(in) :: total(:), slope(:)   !! (n+1) of li_table [-]
    type(dual_t), intent(in) :: time             !! [s]
    type(dual_t), intent(in) :: temperature      !! [degC]
    type(dual_t), intent(inout) :: progress      !! S [-]
    type(dual_t), intent(out) :: extended        !! [-]
    type(dual_t) :: before

    before = progress
    progress = progress + time*li_rate(kinetics, temperature)
    if (progress%value > total(size(total))) progress = dual_t(total(size(total)))
    extended = extended_of(total, slope, progress) - extended_of(total, slope, before)
  end subroutine grow_li

  !> -ln(1 - X) at S.
  pure function extended_of(total, slope, progress) result(extended)
    real(wp), intent(in) :: total(:), slope(:)
    type(dual_t), intent(in) :: progress
    type(dual_t) :: extended
    real(wp) :: q, x, rest, by_s

    call find_q(total, slope, progress%value, q, by_s)
    call share_of(q, x, rest)
    extended%value = -log(rest)
    ! d(-ln(1-X))/dq = (5/3) X/(q (1-q)); it is 0 at q = 0
    if (q > 0) extended%slope = 5.0_wp/3*x/(q*(1 - q))*by_s*progress%slope
  end function extended_of

  !> q at S, and dq/dS, by Newton's method within the interval.
  pure subroutine find_q(total, slope, sum_of_share, q, by_s)
    real(wp), intent(in) :: total(:), slope(:), sum_of_share
    real(wp), intent(out) :: q, by_s
    real(wp) :: u, value, derivative, low, high
    integer :: n, k, iteration

    n = size(total) - 1
    k = 1 + count_up_to(total(2:n), sum_of_share)
    low = 0
    high = 1
    u = (sum_of_share - total(k))/(total(k + 1) - total(k))
    do iteration = 1, 30
      call cubic(total, slope, k, u, value, derivative)
      if (value > sum_of_share) then
        high = u
      else
        low = u
      end if
      u = u - (value - sum_of_share)/derivative
      if (.not. (u >= low .and. u <= high)) u = 0.5_wp*(low + high)
      if (abs(value - sum_of_share) <= 4*epsilon(value)*total(n + 1)) exit
    end do
    call cubic(total, slope, k, u, value, derivative)
    q = min(last_q, (k - 1 + u)/n)
    by_s = 0
    if (q < last_q) by_s = 1/(n*derivative)
  end subroutine find_q

end module li_kinetics
