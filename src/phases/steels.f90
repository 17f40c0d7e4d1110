!> A steel as data: its phases, their kinetics, and their properties by temperature. Says nothing of a file, a mesh or a scene.
!>
!> Units of this folder: degC, s, MJ/m3 (= N/mm2), HV, mass per cent, grain sizes in micrometre; absolute temperatures in K where
!> a formula has them.
module steels
  use kinds, only: wp
  use temperature_curves, only: temperature_curve_t
  implicit none
  private
  public :: steel_t, kinetics_t, histories_t, composition_t, stress_effect_t
  public :: austenite, ferrite, pearlite, bainite, martensite, tempered, phase_count, phase_names, first_diffusive, last_diffusive
  public :: kinetics_none, kinetics_avrami, kinetics_li
  public :: property_count, property_names, property_units
  public :: prop_lambda, prop_rhoc, prop_latent, prop_hardness, prop_content, prop_young, prop_poisson, prop_alpha, prop_strain, &
            prop_yield, prop_modulus, prop_plasticity, prop_rise, prop_saturation, prop_memory, prop_softening, prop_consistency, &
            prop_rate, prop_hardening
  public :: expansion_none, expansion_total, expansion_incremental
  public :: plasticity_none, plasticity_desalos, plasticity_leblond, plasticity_tanaka, plasticity_names
  public :: element_names, celsius_zero, gas_constant, unknown_temperature
  public :: el_c, el_mn, el_si, el_ni, el_cr, el_mo, el_v, el_w, el_cu, el_p, el_al, el_as, el_ti

  !> Phases. `ferrite` is what forms before pearlite, cementite in a hypereutectoid steel; `tempered` is martensite and bainite
  !> after tempering.
  integer, parameter :: austenite = 1, ferrite = 2, pearlite = 3, bainite = 4, martensite = 5, tempered = 6, phase_count = 6
  character(len=10), parameter :: phase_names(phase_count) = [character(len=10) :: 'AUSTENITE', 'FERRITE', 'PEARLITE', 'BAINITE', &
                                                              'MARTENSITE', 'TEMPERED']
  !> Phases that form by diffusion.
  integer, parameter :: first_diffusive = ferrite, last_diffusive = bainite

  integer, parameter :: kinetics_none = 0, kinetics_avrami = 1, kinetics_li = 2

  !> Properties of a phase by temperature, their names on cards and their units.
  integer, parameter :: prop_lambda = 1, prop_rhoc = 2, prop_latent = 3, prop_hardness = 4, prop_content = 5, &
                        prop_young = 6, prop_poisson = 7, prop_alpha = 8, prop_strain = 9, prop_yield = 10, prop_modulus = 11, &
                        prop_plasticity = 12, prop_rise = 13, prop_saturation = 14, prop_memory = 15, prop_softening = 16, &
                        prop_consistency = 17, prop_rate = 18, prop_hardening = 19, property_count = 19
  character(len=6), parameter :: property_names(property_count) = [character(len=6) :: 'LAMBDA', 'RHOC', 'LATENT', 'HV', &
                                                                   'H', 'E', 'NU', 'ALPHA', 'DEPS', 'SY', 'ET', 'KTP', &
                                                                   'QV', 'BV', 'THETA', 'P1', 'P2', 'P3', 'P4']
  character(len=9), parameter :: property_units(property_count) = [character(len=9) :: 'W/m/K', 'MJ/m3/K', 'MJ/m3', 'HV', &
                                                                   'MJ/m3', 'MPa', '-', '1/K', '-', 'MPa', 'MPa', '1/MPa', &
                                                                   'MPa', '-', '-', '-', 'MPa s^P3', '-', '-']

  !> Form of the strains by temperature and phases: a function of both, or summed up step by step.
  integer, parameter :: expansion_none = 0, expansion_total = 1, expansion_incremental = 2
  !> Form of transformation plasticity, and its name on cards.
  integer, parameter :: plasticity_none = 0, plasticity_desalos = 1, plasticity_leblond = 2, plasticity_tanaka = 3
  character(len=7), parameter :: plasticity_names(3) = ['DESALOS', 'LEBLOND', 'TANAKA ']

  !> Elements of a composition.
  integer, parameter :: el_c = 1, el_mn = 2, el_si = 3, el_ni = 4, el_cr = 5, el_mo = 6, el_v = 7, el_w = 8, el_cu = 9, el_p = 10, &
                        el_al = 11, el_as = 12, el_ti = 13
  character(len=2), parameter :: element_names(13) = ['C ', 'MN', 'SI', 'NI', 'CR', 'MO', 'V ', 'W ', 'CU', 'P ', 'AL', 'AS', 'TI']

  !> 0 degC in K; gas constant [J/mol/K] (CODATA 2018).
  real(wp), parameter :: celsius_zero = 273.15_wp, gas_constant = 8.314462618_wp
  !> A temperature that has not been given.
  real(wp), parameter :: unknown_temperature = -huge(1.0_wp)
  !> Width of a sub-step of kinetics where a steel does not state it [K]: fractions then change by less than 1e-3 for steps ten
  !> times as long (tests/phases).
  real(wp), parameter :: default_substep = 2.5_wp

  !> Mass per cent of each element.
  type :: composition_t
    logical :: given = .false.
    real(wp) :: w(size(element_names)) = 0.0_wp
  end type composition_t

  !> How a phase forms by diffusion.
  type :: kinetics_t
    integer :: kind = kinetics_none
    !> Temperatures between which it forms [degC].
    real(wp) :: low = 0.0_wp, high = 0.0_wp
    !> Avrami, from two curves: times at which `start_share` and `finish_share` have formed [s].
    logical :: by_curves = .false.
    real(wp) :: start_share = 0.01_wp, finish_share = 0.99_wp
    type(temperature_curve_t) :: start, finish
    !> Avrami: ln b and n by temperature; of curves counted from incubation, n alone.
    type(temperature_curve_t) :: log_rate, exponent
    !> Growth waits for the Scheil sum of dt/(factor*start) to reach 1; Avrami's time counts from there, else from time zero.
    logical :: waits = .false., from_incubation = .false.
    real(wp) :: factor = 1.0_wp
    !> The share at the start is one of the whole volume, else of the austenite that is left.
    logical :: start_of_volume = .false.
    !> Largest fraction by temperature, where it is given.
    type(temperature_curve_t) :: limit
    !> Li: rate = speed (high - T)^power exp(-Q/RT).
    real(wp) :: speed = 0.0_wp
    integer :: power = 0
  end type kinetics_t

  !> Cooling histories of a CCT diagram: points of history k are first(k) to first(k+1)-1, temperatures descending.
  type :: histories_t
    integer :: n = 0
    real(wp), allocatable :: rate(:)            !! (n) cooling rates, ascending [K/s]
    real(wp), allocatable :: log_rate(:)        !! (n) their logarithms
    integer, allocatable :: first(:)            !! (n+1)
    real(wp), allocatable :: t(:), z(:, :)      !! (npoint) [degC], (3, npoint) ferrite, pearlite, bainite
    real(wp) :: hottest = 0.0_wp, coldest = 0.0_wp   !! first and last temperature of all [degC]
    !> Cooling rate counts exp(grain_factor (D - grain_reference)) times, D the grain size.
    real(wp) :: grain_factor = 0.0_wp, grain_reference = 0.0_wp
  end type histories_t

  !> Effect of the mean and of von Mises' stress on kinetics: a phase forms at a temperature T as without stress at
  !> T - shift . (mean, mises), in times divided by exp(haste . (mean, mises)).
  type :: stress_effect_t
    logical :: given = .false.
    real(wp) :: shift(2, first_diffusive:martensite) = 0.0_wp      !! [K/MPa]
    real(wp) :: haste(2, first_diffusive:last_diffusive) = 0.0_wp  !! [1/MPa]
  end type stress_effect_t

  type :: steel_t
    character(len=:), allocatable :: name, source
    !> Where the file defines it, for messages.
    character(len=:), allocatable :: where_defined
    type(composition_t) :: composition
    !> Characteristic temperatures [degC]: of equilibrium, on heating, bainite start, martensite start.
    real(wp) :: ae1 = unknown_temperature, ae3 = unknown_temperature, ac1 = unknown_temperature, ac3 = unknown_temperature
    real(wp) :: bs = unknown_temperature, ms = unknown_temperature
    type(kinetics_t) :: kinetics(first_diffusive:last_diffusive)
    type(histories_t) :: cct
    !> Martensite: beta [1/K]; Ms moves by min(0, shift_slope*z + shift_offset) where z, formed before, exceeds shift_from.
    real(wp) :: beta = 0.0_wp, shift_from = 1.0_wp, shift_slope = 0.0_wp, shift_offset = 0.0_wp
    !> Koistinen and Marburger's share is one of all that other phases leave, else of the austenite that is left.
    logical :: martensite_total = .false.
    type(stress_effect_t) :: isig
    !> Austenite on heating: time constants at ac1 and ac3 [s]; 0: none forms.
    real(wp) :: tau1 = 0.0_wp, tau3 = 0.0_wp
    !> Grain [um]: first size; 1/lambda = exp(-lambda_energy/T)/lambda0, limit = limit0 exp(-limit_energy/T); energies in K,
    !> lambda0 [s/um2], 0: grains do not grow. ASTM number for Li.
    real(wp) :: grain = 0.0_wp, lambda0 = 0.0_wp, lambda_energy = 0.0_wp, limit0 = 0.0_wp, limit_energy = 0.0_wp
    real(wp) :: grain_number = 0.0_wp
    !> Tempering of martensite (1) and bainite (2): X = (int k0 exp(-Q/RT) dt)^n; k0 = 0: none. [1/s], [J/mol], [-]
    real(wp) :: temper_rate(2) = 0.0_wp, temper_energy(2) = 0.0_wp, temper_exponent(2) = 1.0_wp
    !> Hollomon-Jaffe: C, and hardness by the parameter T (C + log10 t)/1000 (a table over thousands of K).
    real(wp) :: hollomon = 20.0_wp
    type(temperature_curve_t) :: tempered_hardness
    !> Hardness by Maynier's formulas where a phase has none of its own.
    logical :: maynier = .false.
    type(temperature_curve_t) :: properties(property_count, phase_count)
    !> Strains by temperature and phases, and the temperature at which DEPS holds and ALPHA counts from in the total form [degC].
    integer :: expansion = expansion_none
    real(wp) :: reference = unknown_temperature
    integer :: plasticity = plasticity_none
    !> Weight of the yield stress of what has formed from austenite, over its fraction; where it is not given, the fraction.
    type(temperature_curve_t) :: weight
    !> All phases take up heat alike.
    logical :: one_heat = .false.
    real(wp) :: substep = default_substep   !! [K]
    !> Temperatures at which sub-steps end, ascending [degC]: they stand still while a step is iterated.
    real(wp), allocatable :: nodes(:)
    !> Highest temperature at which data begin, end or bend; where there are nodes [degC].
    real(wp) :: data_end = unknown_temperature
    !> Li's S(X) and its slope over q at equal distances, X = q^(5/3)/(q^(5/3) + (1-q)^(5/3)).
    real(wp), allocatable :: li_sum(:), li_slope(:)
  end type steel_t

end module steels
