!> Tempering of martensite and bainite.
!>
!> The share tempered is 1 - exp(-X), X = (int k0 exp(-Q/RT) dt)^n: Avrami's law in equivalent time (T. Reti, M. Gergely,
!> P. Tardy, Mater. Sci. Technol. 3 (1987) 365). Hardness follows the parameter of J.H. Hollomon, L.D. Jaffe, Trans. AIME 162 (1945)
!> 223, P = T (C + log10 t) with T in K and t in hours, added up over temperatures by the time that gives the same P.
module tempering
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: celsius_zero, gas_constant, steel_t
  implicit none
  private
  public :: temper, add_hollomon_jaffe, hollomon_jaffe

  real(wp), parameter :: seconds_per_hour = 3600.0_wp

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
    progress = progress + time*(steel%temper_rate(which) &
                                *exp(-(steel%temper_energy(which)/(gas_constant*(temperature + celsius_zero)))))
    extended = power(progress, steel%temper_exponent(which)) - power(before, steel%temper_exponent(which))
  end subroutine temper

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

end module tempering
