!> What a point of steel remembers: fractions of phases, sums of incubation and growth, coldest temperature, grain, tempering,
!> hardness.
module phase_state
  use hardness, only: hardness_of
  use kinds, only: wp
  use steels, only: austenite, phase_count, steel_t
  implicit none
  private
  public :: state_size, state_names, state_units, first_fraction, first_incubation, first_growth, at_coldest, at_grain, &
            at_tempering, at_hollomon_jaffe, at_rate, at_hardness
  public :: start_phases, set_hardness

  !> Places in a state: fractions of all phases; Scheil sums and progress of growth of ferrite, pearlite, bainite; progress of
  !> tempering of martensite and bainite.
  integer, parameter :: first_fraction = 1, first_incubation = phase_count + 1, first_growth = first_incubation + 3, &
                        at_coldest = first_growth + 3, at_grain = at_coldest + 1, at_tempering = at_grain + 1, &
                        at_hollomon_jaffe = at_tempering + 2, at_rate = at_hollomon_jaffe + 1, at_hardness = at_rate + 1, &
                        state_size = at_hardness
  character(len=20), parameter :: state_names(state_size) = [character(len=20) :: &
                                  'austenite', 'ferrite', 'pearlite', 'bainite', 'martensite', 'tempered', &
                                  'incubation_ferrite', 'incubation_pearlite', 'incubation_bainite', &
                                  'growth_ferrite', 'growth_pearlite', 'growth_bainite', 'coldest', 'grain_size', &
                                  'temper_martensite', 'temper_bainite', 'hollomon_jaffe', 'rate_at_700', 'hardness']
  character(len=6), parameter :: state_units(state_size) = [character(len=6) :: &
                                 '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', 'degC', 'um', '-', '-', '1e3 K', &
                                 'K/s', 'HV']
  !> Coldest temperature of a point that has not been cold [degC]: above all that steel can have.
  real(wp), parameter, public :: never_cold = 1.0e4_wp
  !> That of a point that begins with a given mixture of austenite and martensite: to be found from the mixture and the temperature.
  real(wp), parameter, public :: cold_as_mixture = 2*never_cold

contains

  !> Austenite, or a given mixture, with no history.
  pure subroutine start_phases(steel, state, fractions)
    type(steel_t), intent(in) :: steel
    real(wp), intent(out) :: state(:)                 !! (state_size) [state_units]
    real(wp), intent(in), optional :: fractions(:)    !! (phase_count) [-]

    state = 0
    state(austenite) = 1
    if (present(fractions)) state(:phase_count) = fractions
    state(at_coldest) = never_cold
    state(at_grain) = steel%grain
    call set_hardness(steel, state)
  end subroutine start_phases

  !> Hardness of the mixture as it is.
  pure subroutine set_hardness(steel, state)
    type(steel_t), intent(in) :: steel
    real(wp), intent(inout) :: state(:)   !! (state_size) [state_units]

    state(at_hardness) = hardness_of(steel, state(:phase_count), state(at_rate), state(at_hollomon_jaffe))
  end subroutine set_hardness

end module phase_state
