!> Numbers of a steel that no steel has, each beside another one: units were mixed, or a line slipped.
module steel_numbers
  use kinds, only: wp
  use scene, only: scene_t
  use steel_temperatures, only: top_of, words_of_temperatures
  use steels, only: austenite, bainite, expansion_none, expansion_total, kinetics_none, martensite, phase_count, phase_names, &
                    prop_alpha, prop_latent, prop_plasticity, prop_strain, prop_yield, prop_young, steel_t, unknown_temperature
  use temperature_curves, only: curve_at, is_given
  use text, only: add_new_text, string_t, to_text
  implicit none
  private
  public :: judge_steels, words_of_numbers

  !> Rates of martensite by temperature [1/K]: 0.011 (D.P. Koistinen, R.E. Marburger, Acta Metall. 7 (1959) 59); 0.0107 to 0.0224
  !> for carbon up to 1.1 % (S.M.C. van Bohemen, Mater. Sci. Technol. 28 (2012) 487); up to 0.06 fitted to single steels.
  real(wp), parameter :: least_beta = 0.002_wp, most_beta = 0.2_wp
  !> Steels yield at less than this share of Young's modulus, as other metals (law_numbers_check).
  real(wp), parameter :: largest_yield = 0.03_wp
  !> Bs by a formula of the composition may lie as much too low [K].
  real(wp), parameter :: scatter_of_formulas = 75.0_wp
  !> Steels have more of the elements that are named [mass per cent]; those of low alloy, as shares, have less.
  real(wp), parameter :: least_alloyed = 0.06_wp
  !> Where both are compared [degC].
  real(wp), parameter :: room_temperature = 20.0_wp
  !> Where heats of transformation are looked at [degC], and what none of steel comes near: 640 to 1 100 by L. Furlan et al. 2025
  !> for 100Cr6 [MJ/m3].
  real(wp), parameter :: warm = 400.0_wp, most_latent = 3000.0_wp
  !> Coefficients of transformation plasticity of steels: 1e-5 to 2e-4 (F.D. Fischer et al., Eur. J. Mech. A 15 (1996) 1) [1/MPa].
  real(wp), parameter :: least_plasticity = 1.0e-7_wp
  !> Hollomon and Jaffe's P/1000 is 8 to 30 [1e3 K].
  real(wp), parameter :: most_parameter = 100.0_wp

contains

  !> Warnings, one line each: of two laws of one steel once.
  subroutine judge_steels(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: m

    do m = 1, size(scene%materials)
      if (.not. allocated(scene%materials(m)%steel)) cycle
      call add_new_text(warnings, words_of_temperatures(scene%materials(m)%steel))
      call add_new_text(warnings, words_of_numbers(scene%materials(m)%steel))
    end do
  end subroutine judge_steels

  !> What is wrong with the numbers; empty where nothing is.
  pure function words_of_numbers(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    real(wp) :: scatter   !! [K]

    scatter = merge(scatter_of_formulas, 0.0_wp, steel%composition%given)
    words = in_order('Ms', steel%ms, 'Bs', steel%bs, scatter)
    ! by Andrews' formulas Ae1 may lie above Ae3, that of ferrite, with much carbon
    if (.not. steel%composition%given) words = words//in_order('Ae1', steel%ae1, 'Ae3', steel%ae3, 0.0_wp)
    if (steel%kinetics(bainite)%kind /= kinetics_none) &
      words = words//in_order('the curve of BAINITE', top_of(steel%kinetics(bainite)%start), 'Bs', steel%bs, scatter)
    if (steel%ms > unknown_temperature .and. .not. (steel%beta > least_beta .and. steel%beta < most_beta)) &
      words = words//'; BETA of MARTEN is '//to_text(steel%beta, 4)//' 1/K, that of steels '//to_text(least_beta)//' to ' &
              //to_text(most_beta)
    if (steel%composition%given .and. sum(steel%composition%w) < least_alloyed .and. count(steel%composition%w > 0) > 1) &
      words = words//'; elements of COMPO are '//to_text(sum(steel%composition%w), 3)//' per cent in all, less than in any ' &
              //'steel: they are in mass per cent, not shares'
    words = words//yields(steel)//transforms(steel)
    if (words == '') return
    words = 'the steel '//steel%name//': '//words(3:)
    if (allocated(steel%where_defined)) words = words//' ('//steel%where_defined//')'
  end function words_of_numbers

  !> A temperature that lies above another one, below which it is in all steels.
  pure function in_order(name, value, above, limit, scatter) result(words)
    character(len=*), intent(in) :: name, above
    real(wp), intent(in) :: value, limit   !! [degC]
    real(wp), intent(in) :: scatter        !! of the limit [K]
    character(len=:), allocatable :: words

    words = ''
    if (.not. (value > unknown_temperature .and. limit > unknown_temperature)) return
    if (value > limit + scatter) words = '; '//name//' ('//to_text(value, 5)//') is above '//above//' ('//to_text(limit, 5)//')'
  end function in_order

  !> The phase whose yield stress is largest beside its modulus, where that is more than steels have.
  pure function yields(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    real(wp) :: ratio(phase_count)
    integer :: p

    ratio = 0
    do p = 1, phase_count
      associate (young => steel%properties(prop_young, p), yield => steel%properties(prop_yield, p))
        if (is_given(young) .and. is_given(yield)) &
          ratio(p) = curve_at(yield, room_temperature)/curve_at(young, room_temperature)
      end associate
    end do
    words = ''
    p = maxloc(ratio, 1)
    if (ratio(p) > largest_yield) words = '; '//trim(phase_names(p))//' yields at '//to_text(ratio(p), 3)//' of E at 20 degC, ' &
                                          //'steels below '//to_text(largest_yield)//': SY and E are in MPa'
  end function yields

  !> Heat, plasticity and strain of transformation, and hardness by tempering, in other units or of the wrong sign.
  pure function transforms(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    real(wp) :: value
    integer :: p

    words = ''
    do p = 1, phase_count
      value = number(steel, prop_latent, p, warm)
      if (value > most_latent) words = words//'; LATENT of '//trim(phase_names(p))//' is '//to_text(value, 4)//' MJ/m3 at ' &
                                       //to_text(warm)//' degC, that of steels below '//to_text(most_latent)
      value = number(steel, prop_plasticity, p, room_temperature)
      if (value > 0 .and. value < least_plasticity) &
        words = words//'; KTP of '//trim(phase_names(p))//' is '//to_text(value, 3)//' 1/MPa, that of steels 1e-5 to 2e-4'
    end do
    if (is_given(steel%tempered_hardness)) then
      if (allocated(steel%tempered_hardness%t)) then
        value = maxval(steel%tempered_hardness%t)
        if (value > most_parameter) words = words//'; HV of TEMPER is by P/1000, 8 to 30, not by P up to '//to_text(value, 5)
      end if
    end if
    words = words//shrinks(steel)
  end function transforms

  !> Martensite that is smaller, at Ms, than the austenite that it forms from.
  pure function shrinks(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    real(wp) :: strain

    words = ''
    if (steel%expansion == expansion_none .or. .not. steel%ms > unknown_temperature) return
    if (.not. is_given(steel%properties(prop_strain, martensite))) return
    strain = number(steel, prop_strain, martensite, steel%ms) - number(steel, prop_strain, austenite, steel%ms)
    if (steel%expansion == expansion_total) &
      strain = strain + (number(steel, prop_alpha, martensite, steel%ms) - number(steel, prop_alpha, austenite, steel%ms)) &
               *(steel%ms - steel%reference)
    if (strain < 0) words = '; MARTENSITE is smaller than the austenite that it forms from, by a strain of '//to_text(-strain, 3) &
                            //' at Ms: that of steels is larger (DEPS of MARTENSITE)'
  end function shrinks

  !> A number of a phase at a temperature; 0 where it is not given.
  pure function number(steel, property, phase, temperature) result(value)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: property, phase
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp) :: value                     !! [unit of the property]

    value = 0
    if (is_given(steel%properties(property, phase))) value = curve_at(steel%properties(property, phase), temperature)
  end function number

end module steel_numbers
