!> Tempering of martensite and bainite.
!>
!> The share tempered is 1 - exp(-X), X = (int k0 exp(-Q/RT) dt)^n: Avrami's law in equivalent time (T. Reti, M. Gergely,
!> P. Tardy, Mater. Sci. Technol. 3 (1987) 365). Hardness follows the parameter of J.H. Hollomon, L.D. Jaffe, Trans. AIME 162 (1945)
!> 223, P = T (C + log10 t) with T in K and t in hours, added up over temperatures by the time that gives the same P.
!>
!> What is left of a phase may have formed at different times, but it has one equivalent time tau = int k dt for all. Where a
!> fraction d forms beside f, tau becomes tau' with tau'^m = f tau^m/(f + d), m = min(n, 1): the mean by amounts of tau^m over
!> what is not tempered yet, of new phase with 0. For n <= 1 it is the mean of X, of the logarithm of what is left. It is exact
!> where n = 1, where all has the same age, and where nothing old is left. Else, against the sum over all ages, it is in general the
!> nearest of the means of tau, of X and of exp(X): for n < 1 what is young is tempered fastest, and a mean of tau would count what
!> is old too much.
!> P is that of what is tempered: a mean by amounts. What becomes tempered brings P of its own equivalent time, tau/k at the
!> temperature, never more than that of what is tempered already.
module tempering
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: celsius_zero, gas_constant, steel_t
  implicit none
  private
  public :: temper, make_younger, add_hollomon_jaffe, join_hollomon_jaffe, hollomon_jaffe

  real(wp), parameter :: seconds_per_hour = 3600.0_wp
  !> Fractions up to here are none: quotients of such have no digits.
  real(wp), parameter :: no_amount = 1.0e-100_wp

contains

  !> Equivalent time is advanced; `extended` is the logarithm by which the phase shrinks.
  pure subroutine temper(steel, which, time, temperature, progress, extended)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: which              !! 1: martensite, 2: bainite
    type(dual_t), intent(in) :: time          !! [s]
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(inout) :: progress   !! int k dt [-]
    type(dual_t), intent(out) :: extended     !! [-]
    type(dual_t) :: before

    extended = dual_t()
    if (.not. steel%temper_rate(which) > 0) return
    before = progress
    progress = progress + time*rate_of(steel, which, temperature)
    extended = power(progress, steel%temper_exponent(which)) - power(before, steel%temper_exponent(which))
  end subroutine temper

  !> k = k0 exp(-Q/RT) [1/s].
  pure function rate_of(steel, which, temperature) result(rate)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: which
    type(dual_t), intent(in) :: temperature   ! [degC]
    type(dual_t) :: rate

    rate = steel%temper_rate(which)*exp(-(steel%temper_energy(which)/(gas_constant*(temperature + celsius_zero))))
  end function rate_of

  !> Equivalent time of a phase of which some has just formed: tau^m is the mean by amounts, of what is new 0; m = min(n, 1), see
  !> above.
  pure subroutine make_younger(steel, which, old, fresh, progress)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: which              !! 1: martensite, 2: bainite
    type(dual_t), intent(in) :: old, fresh    !! fractions: there before, and new [-]
    type(dual_t), intent(inout) :: progress   !! int k dt [-]

    if (.not. fresh%value > 0) return
    if (.not. old%value + fresh%value > no_amount) return
    progress = progress*power(old/(old + fresh), 1/min(steel%temper_exponent(which), 1.0_wp))
  end subroutine make_younger

  pure function power(x, n) result(y)
    type(dual_t), intent(in) :: x
    real(wp), intent(in) :: n
    type(dual_t) :: y

    y = dual_t()
    if (x%value > 0) y = exp(n*log(x))
  end function power

  !> P after a time at a temperature.
  pure function hollomon_jaffe(temperature, time, c) result(p)
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp), intent(in) :: time          !! [s]
    real(wp), intent(in) :: c             !! Hollomon and Jaffe's constant
    real(wp) :: p                         !! in thousands [1e3 K]

    p = 1.0e-3_wp*(temperature + celsius_zero)*(c + log10(time/seconds_per_hour))
  end function hollomon_jaffe

  !> P after some time more at another temperature.
  pure subroutine add_hollomon_jaffe(steel, time, temperature, p)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time          !! [s]
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(inout) :: p          !! in thousands [1e3 K]
    type(dual_t) :: kelvin, old, new, log_total

    if (.not. time%value > 0) return
    kelvin = temperature + celsius_zero
    new = log(time/seconds_per_hour)
    old = log(10.0_wp)*(1.0e3_wp*p/kelvin - steel%hollomon)
    if (old%value > new%value) then
      log_total = old + log(exp(new - old) + 1.0_wp)
    else
      log_total = new + log(exp(old - new) + 1.0_wp)
    end if
    p = 1.0e-3_wp*kelvin*(log_total/log(10.0_wp) + steel%hollomon)
  end subroutine add_hollomon_jaffe

  !> P of what is tempered, after more of a phase has become tempered.
  pure subroutine join_hollomon_jaffe(steel, which, temperature, progress, there, more, p)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: which                !! 1: martensite, 2: bainite
    type(dual_t), intent(in) :: temperature     !! [degC]
    type(dual_t), intent(in) :: progress        !! int k dt of the phase [-]
    type(dual_t), intent(in) :: there, more     !! fractions: tempered before, and new [-]
    type(dual_t), intent(inout) :: p            !! in thousands [1e3 K]
    type(dual_t) :: own

    if (.not. (more%value > no_amount .and. progress%value > 0)) return
    own = 1.0e-3_wp*(temperature + celsius_zero) &
          *(log(progress/rate_of(steel, which, temperature)/seconds_per_hour)/log(10.0_wp) + steel%hollomon)
    if (own%value < p%value) p = p + more/(there + more)*(own - p)
  end subroutine join_hollomon_jaffe

end module tempering
