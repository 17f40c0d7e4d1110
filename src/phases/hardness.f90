!> Hardness by the mixture of phases: of each phase given, or by P. Maynier, B. Jungmann, J. Dollet, in Hardenability Concepts with
!> Applications to Steel (TMS-AIME 1978) 518, from the composition and the cooling rate at 700 degC in degC per hour.
module hardness
  use kinds, only: wp
  use steels, only: austenite, bainite, composition_t, el_c, el_cr, el_mn, el_mo, el_ni, el_si, el_v, ferrite, martensite, &
                    pearlite, phase_count, prop_hardness, steel_t, tempered
  use temperature_curves, only: curve_at, is_given
  implicit none
  private
  public :: hardness_of, maynier_hardness, has_hardness

  real(wp), parameter :: seconds_per_hour = 3600.0_wp
  !> Cooling rates below this say nothing of hardness: a point that has not passed 700 degC [K/s].
  real(wp), parameter :: no_rate = 0.0_wp
  !> Where hardness is measured [degC].
  real(wp), parameter :: room_temperature = 20.0_wp

contains

  !> The steel has what a hardness needs.
  pure function has_hardness(steel) result(yes)
    type(steel_t), intent(in) :: steel
    logical :: yes

    yes = steel%maynier .or. any(is_given(steel%properties(prop_hardness, :)))
  end function has_hardness

  !> Hardness of a mixture; 0 for a steel without any.
  pure function hardness_of(steel, fractions, rate_700, hollomon_jaffe) result(hv)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: fractions(:)      !! (phase_count) [-]
    real(wp), intent(in) :: rate_700          !! cooling rate at 700 degC [K/s]
    real(wp), intent(in) :: hollomon_jaffe    !! in thousands [1e3 K]
    real(wp) :: hv   !! [HV]
    integer :: i

    hv = 0
    do i = 1, phase_count
      if (fractions(i) > 0) hv = hv + fractions(i)*phase_hardness(steel, i, rate_700, hollomon_jaffe)
    end do
  end function hardness_of

  !> Hardness of one phase.
  pure function phase_hardness(steel, phase, rate_700, hollomon_jaffe) result(hv)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: rate_700          !! [K/s]
    real(wp), intent(in) :: hollomon_jaffe    !! in thousands [1e3 K]
    real(wp) :: hv   !! [HV]

    hv = 0
    if (phase == tempered .and. is_given(steel%tempered_hardness)) then
      hv = curve_at(steel%tempered_hardness, hollomon_jaffe)
    else if (is_given(steel%properties(prop_hardness, phase))) then
      hv = curve_at(steel%properties(prop_hardness, phase), room_temperature)
    else if (steel%maynier .and. rate_700 > no_rate) then
      ! tempered and retained austenite as martensite, which they were or become
      hv = maynier_hardness(phase, steel%composition, rate_700)
    end if
  end function phase_hardness

  !> Maynier's formulas.
  pure function maynier_hardness(phase, composition, rate_700) result(hv)
    integer, intent(in) :: phase
    type(composition_t), intent(in) :: composition
    real(wp), intent(in) :: rate_700   !! [K/s]
    real(wp) :: hv   !! [HV]
    real(wp) :: log_rate

    log_rate = log10(rate_700*seconds_per_hour)
    hv = 0
    associate (w => composition%w)
      select case (phase)
      case (austenite, martensite, tempered)
        hv = 127 + 949*w(el_c) + 27*w(el_si) + 11*w(el_mn) + 8*w(el_ni) + 16*w(el_cr) + 21*log_rate
      case (bainite)
        hv = -323 + 185*w(el_c) + 330*w(el_si) + 153*w(el_mn) + 65*w(el_ni) + 144*w(el_cr) + 191*w(el_mo) &
             + (89 + 53*w(el_c) - 55*w(el_si) - 22*w(el_mn) - 10*w(el_ni) - 20*w(el_cr) - 33*w(el_mo))*log_rate
      case (ferrite, pearlite)
        hv = 42 + 223*w(el_c) + 53*w(el_si) + 30*w(el_mn) + 12.6_wp*w(el_ni) + 7*w(el_cr) + 19*w(el_mo) &
             + (10 - 19*w(el_si) + 4*w(el_ni) + 8*w(el_cr) + 130*w(el_v))*log_rate
      end select
    end associate
  end function maynier_hardness

end module hardness
