!> Martensite: D.P. Koistinen, R.E. Marburger, Acta Metall. 7 (1959) 59, in increments dz = -beta z_austenite dT below Ms.
!>
!> Martensite forms while the temperature is below Ms and below the coldest one so far. A step from there to T divides the
!> austenite by exp(beta (T_before - T)): exact for any step. Ms moves with what has formed before.
!>
!> In the total form z = (1 - z_d) (1 - E), E = exp(-beta (Ms - T)), where z_d is what other phases have taken so far: what forms
!> below Ms by diffusion is missing in the martensite. As z_austenite = (1 - z_d) E, a step ends with z_austenite' = z_austenite
!> E'/E - dz_d E', whatever stood beside before (martensite of an earlier quench, or tempered); martensite that this would take back
!> stays. Without other phases below Ms both forms are the same. Source of the total form: code_aster, R4.04.02 (metallurgical
!> behaviour of steels).
module martensite_kinetics
  use dual_numbers, only: dual_t, exp, operator(*), operator(+), operator(-)
  use kinds, only: wp
  use steels, only: steel_t, unknown_temperature
  implicit none
  private
  public :: martensite_start, grow_martensite, total_martensite

contains

  !> Ms where a fraction has formed by diffusion. Without Ms: below all temperatures.
  pure function martensite_start(steel, formed) result(ms)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: formed   !! of ferrite, pearlite and bainite
    type(dual_t) :: ms                   !! [degC]
    type(dual_t) :: shift

    ms = dual_t(steel%ms)
    if (steel%ms <= unknown_temperature .or. formed%value <= steel%shift_from) return
    shift = steel%shift_slope*formed + steel%shift_offset
    if (shift%value < 0) ms = ms + shift
  end function martensite_start

  !> Logarithm by which austenite shrinks on the way to a temperature, and the coldest temperature so far.
  pure subroutine grow_martensite(steel, formed, temperature, coldest, extended)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: formed        !! of ferrite, pearlite and bainite
    type(dual_t), intent(in) :: temperature   !! at the end [degC]
    type(dual_t), intent(inout) :: coldest    !! [degC]
    type(dual_t), intent(out) :: extended     !! [-]
    type(dual_t) :: from

    extended = dual_t()
    if (steel%ms <= unknown_temperature) return
    from = martensite_start(steel, formed)
    if (coldest%value < from%value) from = coldest
    if (temperature%value < from%value) extended = steel%beta*(from - temperature)
    if (temperature%value < coldest%value) coldest = temperature
  end subroutine grow_martensite

  !> Martensite that forms in a step by the total form.
  pure function total_martensite(steel, ms, coldest, austenite, by_diffusion) result(formed)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: ms(2), coldest(2)   !! before and after [degC]
    type(dual_t), intent(in) :: austenite           !! fraction before
    type(dual_t), intent(in) :: by_diffusion        !! fraction of other phases that forms in the step
    type(dual_t) :: formed
    type(dual_t) :: log_left(2)
    integer :: k

    formed = dual_t()
    do k = 1, 2   ! ln E
      log_left(k) = dual_t()
      if (coldest(k)%value < ms(k)%value) log_left(k) = steel%beta*(coldest(k) - ms(k))
    end do
    if (log_left(2)%value >= log_left(1)%value) return
    formed = austenite*(1.0_wp - exp(log_left(2) - log_left(1))) - by_diffusion*(1.0_wp - exp(log_left(2)))
    if (formed%value < 0) formed = dual_t()
  end function total_martensite

end module martensite_kinetics
