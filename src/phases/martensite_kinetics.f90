!> Martensite: D.P. Koistinen, R.E. Marburger, Acta Metall. 7 (1959) 59, in increments dz = -beta z_austenite dT below Ms.
!>
!> Martensite forms while the temperature is below Ms and below the coldest one so far. A step from there to T divides the
!> austenite by exp(beta (T_before - T)): exact for any step. Ms moves with what has formed before.
module martensite_kinetics
  use dual_numbers, only: dual_t, operator(*), operator(+), operator(-)
  use kinds, only: wp
  use steels, only: steel_t, unknown_temperature
  implicit none
  private
  public :: martensite_start, grow_martensite

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

end module martensite_kinetics
