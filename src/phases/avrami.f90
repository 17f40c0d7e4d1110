!> Growth of a phase by Johnson, Mehl, Avrami and Kolmogorov, added up over temperatures by fictitious time, after Scheil's
!> incubation.
!>
!> At one temperature the extended fraction is X = b t^n, and 1 - exp(-X) of what can form has formed. From temperature to
!> temperature X stays: the fictitious time (X/b)^(1/n) would have given it at the new one (additivity). Exact for any length of
!> step at one temperature. The Scheil sum S of dt/(factor t_start) reaches 1 at the end of incubation. Time counts from there, or
!> from zero: then X grows in proportion to S to b t_start^n, the share of the curve of start. That share is one of the austenite
!> that is left, or of the whole volume: then the fraction itself grows in proportion to S to 1 - exp(-b t_start^n).
!> Two curves t_s(T) and t_f(T) of shares z_s and z_f give n = ln(ln(1-z_f)/ln(1-z_s))/ln(t_f/t_s) (6.12733/ln(t99/t1)),
!> b = -ln(1-z_s)/t_s^n; their times are linear in ln t between temperatures.
!> Curves end where the driving force does, and times go to infinity there; those of a file end at a finite time. Over the last
!> `fading` below their end the time counts less and less, to nothing. So latent heat can lift the temperature to the end of the
!> curve, where growth then takes what is conducted away: with a rate that jumped no temperature would balance the heat there
!> (A.F. Filippov, Differential Equations with Discontinuous Righthand Sides, 1988).
!> Source: E. Scheil, Arch. Eisenhuettenwes. 8 (1935) 565; M. Avrami, J. Chem. Phys. 8 (1940) 212; F. Fernandes, S. Denis,
!> A. Simon, Mater. Sci. Technol. 1 (1985) 838.
module avrami
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: kinetics_t
  use temperature_curves, only: dual_curve_at
  implicit none
  private
  public :: grow_avrami, avrami_numbers, avrami_time, fading

  !> Width below the highest temperature of a phase in which its growth ends [K]: less than temperatures of diagrams are known to.
  real(wp), parameter :: fading = 2.0_wp

contains

  !> Growth over a time at one temperature: Scheil sum and extended fraction, which are advanced; what this leaves undivided, as the
  !> share at the start is of the whole volume, `of_volume`.
  pure subroutine grow_avrami(kinetics, time, temperature, incubation, extended, growth, of_volume)
    type(kinetics_t), intent(in) :: kinetics
    type(dual_t), intent(in) :: time          !! [s]
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(inout) :: incubation, extended   !! [-]
    type(dual_t), intent(out) :: growth      !! of the extended fraction, by which austenite is divided [-]
    type(dual_t), intent(out) :: of_volume   !! fraction of the whole volume that forms beside [-]
    type(dual_t) :: log_b, n, start, left, share, before, first, below

    before = extended
    of_volume = dual_t()
    call avrami_numbers(kinetics, temperature, log_b, n)
    below = kinetics%high - temperature
    left = time
    if (below%value < fading) left = time*(below/fading)
    if (kinetics%waits .and. incubation%value < 1) then
      start = dual_curve_at(kinetics%start, temperature)
      share = left/(kinetics%factor*start)
      if (incubation%value + share%value < 1) then
        incubation = incubation + share
        left = dual_t()
      else
        share = 1.0_wp - incubation
        left = left - kinetics%factor*start*share
        incubation = dual_t(1.0_wp)
      end if
      if (.not. kinetics%from_incubation) then
        first = exp(log_b + n*log(start))
        extended = extended + share*first
        if (kinetics%start_of_volume) then
          of_volume = share*(1.0_wp - exp(-first))
          before = extended
        end if
      end if
    end if
    if (left%value > 0) call add_time(log_b, n, left, extended)
    growth = extended - before
  end subroutine grow_avrami

  !> X at the fictitious time, later by `time`.
  pure subroutine add_time(log_b, n, time, extended)
    type(dual_t), intent(in) :: log_b, n, time
    type(dual_t), intent(inout) :: extended
    type(dual_t) :: total

    total = time
    if (extended%value > 0) total = total + exp((log(extended) - log_b)/n)
    extended = exp(log_b + n*log(total))
  end subroutine add_time

  !> ln b and n at a temperature.
  pure subroutine avrami_numbers(kinetics, temperature, log_b, n)
    type(kinetics_t), intent(in) :: kinetics
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(out) :: log_b, n     !! b in s^-n
    type(dual_t) :: start, finish
    real(wp) :: first, last

    if (.not. kinetics%by_curves) then
      log_b = dual_curve_at(kinetics%log_rate, temperature)
      n = dual_curve_at(kinetics%exponent, temperature)
      return
    end if
    first = -log(1 - kinetics%start_share)
    last = -log(1 - kinetics%finish_share)
    start = dual_curve_at(kinetics%start, temperature)
    finish = dual_curve_at(kinetics%finish, temperature)
    if (kinetics%from_incubation) then
      n = dual_curve_at(kinetics%exponent, temperature)
      log_b = log(last) - n*log(finish - start)
    else
      n = log(last/first)/log(finish/start)
      log_b = log(first) - n*log(start)
    end if
  end subroutine avrami_numbers

  !> Time at which a share of what can form has formed at one temperature.
  pure function avrami_time(kinetics, temperature, share) result(time)
    type(kinetics_t), intent(in) :: kinetics
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp), intent(in) :: share         !! above 0, below 1
    real(wp) :: time                      !! [s]
    type(dual_t) :: log_b, n, start
    real(wp) :: first, sum_there

    call avrami_numbers(kinetics, dual_t(temperature), log_b, n)
    time = exp((log(-log(1 - share)) - log_b%value)/n%value)
    if (.not. kinetics%waits) return
    start = dual_curve_at(kinetics%start, dual_t(temperature))
    if (kinetics%from_incubation) then
      time = time + kinetics%factor*start%value
    else if (time < start%value) then
      first = exp(log_b%value + n%value*log(start%value))
      sum_there = -log(1 - share)/first
      if (kinetics%start_of_volume) sum_there = share/(1 - exp(-first))
      time = sum_there*kinetics%factor*start%value
    else
      time = time + (kinetics%factor - 1)*start%value
    end if
  end function avrami_time

end module avrami
