!> Temperatures of a steel that no steel has in degC: its file is in kelvin, or in degrees Fahrenheit.
module steel_temperatures
  use kinds, only: wp
  use steels, only: bainite, celsius_zero, el_c, el_cr, el_mn, el_mo, el_ni, el_si, first_diffusive, kinetics_none, &
                    last_diffusive, phase_names, steel_t, unknown_temperature
  use temperature_curves, only: curve_none, temperature_curve_t
  use text, only: to_text
  implicit none
  private
  public :: top_of, words_of_temperatures

  !> No steel has more [degC]: Ae1 and Ac1 (pure iron 912, steels of 17 % chromium 900), Ae3 and Ac3 (those with much silicon or
  !> aluminium), Bs and Ms (pure iron 545; 700 cooled by 1e5 K/s).
  real(wp), parameter :: most_a1 = 960.0_wp, most_a3 = 1150.0_wp, most_bs = 830.0_wp, most_ms = 700.0_wp
  !> Curves of ferrite and pearlite end below Ae3, those of bainite below its start [degC].
  real(wp), parameter :: most_curve = 1000.0_wp
  !> A temperature that is farther than this from what a formula gives for the composition is not meant by it [K].
  real(wp), parameter :: scatter = 150.0_wp

  !> The steels of Andrews had no more of C, Mn, Si, Ni, Cr and Mo; beyond that carbides hold carbon that does not lower Ms [%].
  real(wp), parameter :: most_of(6) = [0.6_wp, 4.9_wp, 1.9_wp, 5.0_wp, 4.6_wp, 5.4_wp]

contains

  !> What is too hot; empty where nothing is.
  pure function words_of_temperatures(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    character(len=:), allocatable :: hot
    integer :: p

    hot = beyond('Ae1', steel%ae1, most_a1)//beyond('Ac1', steel%ac1, most_a1)//beyond('Ae3', steel%ae3, most_a3) &
          //beyond('Ac3', steel%ac3, most_a3)//beyond('Bs', steel%bs, most_bs)//beyond('Ms', steel%ms, most_ms)
    do p = first_diffusive, last_diffusive
      if (steel%kinetics(p)%kind == kinetics_none) cycle
      hot = hot//beyond('the curve of '//trim(phase_names(p)), top_of(steel%kinetics(p)%start), &
                        merge(most_bs, most_curve, p == bainite))
    end do
    if (steel%composition%given) hot = hot//by_composition(steel, hot)
    words = ''
    if (hot == '') return
    words = 'the steel '//steel%name//': '//hot(3:)//': temperatures of steels are degC'
    if (allocated(steel%where_defined)) words = words//' ('//steel%where_defined//')'
  end function words_of_temperatures

  !> A temperature with its bound, where it is above.
  pure function beyond(name, value, most) result(words)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value, most   !! [degC]
    character(len=:), allocatable :: words

    words = ''
    if (value > most) words = ', '//name//' at '//to_text(value, 5)//', that of steels is below '//to_text(most, 4)
  end function beyond

  !> Ac1 and Ms that are those of the composition once they are read as kelvin: K.W. Andrews, J. Iron Steel Inst. 203 (1965)
  !> 721-727, Ac1 = 723 - 10.7 Mn - 16.9 Ni + 29.1 Si + 16.9 Cr, Ms = 539 - 423 C - 30.4 Mn - 17.7 Ni - 12.1 Cr - 7.5 Mo.
  pure function by_composition(steel, hot) result(words)
    type(steel_t), intent(in) :: steel
    character(len=*), intent(in) :: hot   !! what is told already
    character(len=:), allocatable :: words
    real(wp) :: a1, ms

    words = ''
    associate (w => steel%composition%w)
      if (any(w([el_c, el_mn, el_si, el_ni, el_cr, el_mo]) > most_of)) return
      a1 = 723 - 10.7_wp*w(el_mn) - 16.9_wp*w(el_ni) + 29.1_wp*w(el_si) + 16.9_wp*w(el_cr)
      ms = 539 - 423*w(el_c) - 30.4_wp*w(el_mn) - 17.7_wp*w(el_ni) - 12.1_wp*w(el_cr) - 7.5_wp*w(el_mo)
    end associate
    if (is_kelvin(steel%ac1, a1) .and. index(hot, 'Ac1') == 0) &
      words = words//', Ac1 at '//to_text(steel%ac1, 5)//', by its composition about '//to_text(a1, 3)
    if (is_kelvin(steel%ms, ms) .and. index(hot, 'Ms') == 0) &
      words = words//', Ms at '//to_text(steel%ms, 5)//', by its composition about '//to_text(ms, 3)
  end function by_composition

  !> A temperature is that of a formula as kelvin, and not as degC.
  pure function is_kelvin(value, formula) result(yes)
    real(wp), intent(in) :: value, formula   !! [degC]
    logical :: yes

    yes = value > formula + scatter .and. abs(value - celsius_zero - formula) < scatter
  end function is_kelvin

  !> The highest temperature of a table, unknown of none.
  pure function top_of(curve) result(top)
    type(temperature_curve_t), intent(in) :: curve
    real(wp) :: top   !! [degC]

    top = unknown_temperature
    if (curve%form == curve_none .or. .not. allocated(curve%t)) return
    if (size(curve%t) > 0) top = maxval(curve%t)
  end function top_of

end module steel_temperatures
