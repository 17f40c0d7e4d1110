!> Steels and thermal histories for the tests of phases.
module steel_cases
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use kinds, only: wp
  use phase_state, only: state_size
  use phase_step, only: advance_phases
  use steel_build, only: set_nodes
  use steel_reader, only: read_steels
  use steels, only: kinetics_avrami, steel_t
  use temperature_curves, only: curve_constant, curve_polynomial, temperature_curve_t, curve_table
  use text, only: string_t
  implicit none
  private
  public :: shipped, one_phase, constant, polynomial, table, follow, cool

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
