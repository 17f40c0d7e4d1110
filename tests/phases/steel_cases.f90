!> Steels and thermal histories for the tests of phases.
module steel_cases
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use kinds, only: wp
  use phase_state, only: state_size
  use phase_step, only: advance_phases
  use steel_build, only: set_nodes
  use steel_reader, only: read_steels
  use steels, only: bainite, ferrite, kinetics_avrami, martensite, prop_latent, steel_t
  use temperature_curves, only: curve_constant, curve_polynomial, temperature_curve_t, curve_table
  use text, only: string_t
  implicit none
  private
  public :: shipped, shipped_names, everything, by_curves, one_phase, constant, polynomial, table, follow, cool

  !> Steels shipped with kinetics of every kind: histories, polynomials, composition.
  character(len=6), parameter :: shipped_names(4) = ['16mnd5', '100cr6', '4140  ', 'c45   ']

contains

  !> A steel of decks/steels.
  function shipped(name) result(steel)
    character(len=*), intent(in) :: name
    type(steel_t) :: steel
    type(steel_t), allocatable :: steels(:)
    type(diagnostics_t), target :: diagnostics
    type(error_t), allocatable :: error
    type(string_t) :: none(0)
    character(len=400) :: folder

    call get_environment_variable('LAGAMINE_SOURCE', folder)
    call read_steels(trim(folder)//'/decks/steels/'//name//'.met', none, steels, diagnostics)
    call diagnostics%error(error)
    if (allocated(error)) error stop 'a shipped steel cannot be read'
    steel = steels(1)
  end function shipped

  pure function constant(value) result(curve)
    real(wp), intent(in) :: value
    type(temperature_curve_t) :: curve

    curve%form = curve_constant
    allocate (curve%v(1), source=value)
  end function constant

  pure function polynomial(coefficients) result(curve)
    real(wp), intent(in) :: coefficients(:)
    type(temperature_curve_t) :: curve

    curve%form = curve_polynomial
    allocate (curve%v, source=coefficients)
  end function polynomial

  !> A table, of logarithms where asked for.
  pure function table(t, v, logarithmic) result(curve)
    real(wp), intent(in) :: t(:), v(:)
    logical, intent(in), optional :: logarithmic
    type(temperature_curve_t) :: curve

    curve%form = curve_table
    allocate (curve%t, source=t)
    allocate (curve%v, source=v)
    if (.not. present(logarithmic)) return
    curve%logarithmic = logarithmic
    if (logarithmic) curve%v = log(v)
  end function table

  !> A shipped steel with all that can be added: latent heats, austenite, grains, tempering.
  function everything(name) result(steel)
    character(len=*), intent(in) :: name
    type(steel_t) :: steel
    integer :: i

    steel = shipped(name)
    steel%ac1 = 724
    steel%ac3 = 846
    steel%tau1 = 30
    steel%tau3 = 5
    steel%grain = 11
    steel%lambda0 = 1.0e-9_wp
    steel%lambda_energy = 3.0e4_wp
    steel%limit0 = 1.0e6_wp
    steel%limit_energy = 1.0e4_wp
    steel%temper_rate = [1.0e9_wp, 1.0e8_wp]
    steel%temper_energy = 2.0e5_wp
    steel%temper_exponent = [0.3_wp, 0.5_wp]
    do i = ferrite, martensite
      steel%properties(prop_latent, i) = table([0.0_wp, 400.0_wp, 900.0_wp], [700.0_wp, 600.0_wp + 10*i, 400.0_wp])
    end do
    deallocate (steel%nodes)
    call set_nodes(steel)
  end function everything

  !> A steel of which one phase forms, by Avrami's law.
  function one_phase(phase, low, high, log_rate, exponent) result(steel)
    integer, intent(in) :: phase
    real(wp), intent(in) :: low, high
    type(temperature_curve_t), intent(in) :: log_rate, exponent
    type(steel_t) :: steel

    steel%name = 'sample'
    steel%kinetics(phase)%kind = kinetics_avrami
    steel%kinetics(phase)%low = low
    steel%kinetics(phase)%high = high
    steel%kinetics(phase)%log_rate = log_rate
    steel%kinetics(phase)%exponent = exponent
    call set_nodes(steel)
  end function one_phase

  !> Two curves of a diagram.
  function by_curves(from_incubation, factor) result(steel)
    logical, intent(in) :: from_incubation
    real(wp), intent(in) :: factor
    type(steel_t) :: steel
    real(wp), parameter :: t(3) = [300.0_wp, 400.0_wp, 500.0_wp]

    steel = one_phase(bainite, t(1), t(3), constant(0.0_wp), constant(1.0_wp))
    associate (k => steel%kinetics(bainite))
      k%by_curves = .true.
      k%waits = .true.
      k%from_incubation = from_incubation
      k%factor = factor
      k%start = table(t, [50.0_wp, 8.0_wp, 90.0_wp], logarithmic=.true.)
      k%finish = table(t, [400.0_wp, 80.0_wp, 2000.0_wp], logarithmic=.true.)
      k%exponent = table(t, [1.5_wp, 2.0_wp, 1.2_wp])
    end associate
  end function by_curves

  !> One step, in place.
  pure subroutine follow(steel, dt, before, now, state, heat)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: dt, before, now
    real(wp), intent(inout) :: state(state_size)
    real(wp), intent(inout), optional :: heat
    real(wp) :: committed(state_size), slope(state_size), released, released_slope

    committed = state
    call advance_phases(steel, dt, before, now, committed, state, slope, released, released_slope)
    if (present(heat)) heat = heat + released
  end subroutine follow

  !> At a constant rate between two temperatures, in equal steps.
  pure subroutine cool(steel, rate, from, to, steps, state)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: rate   !! [K/s]
    real(wp), intent(in) :: from, to
    integer, intent(in) :: steps
    real(wp), intent(inout) :: state(state_size)
    integer :: k

    do k = 1, steps
      call follow(steel, abs(to - from)/(rate*steps), from + (to - from)*(k - 1)/steps, from + (to - from)*k/steps, state)
    end do
  end subroutine cool

end module steel_cases
