!> ARBTHMET (350): elastic, elastoplastic or viscoplastic steel with phases.
!>
!> strain = elastic + plastic + by transformation plasticity + by temperature and phases (src/phases/phase_mechanics). The fractions
!> are those of a formulation with phases on the same body, known at both ends of the step; or, with TIME, the law follows the
!> kinetics of the steel at its own temperature.
!> Return: phase_point. With RATE0 and COWPER the flow stress grows with the rate, with VISCO each phase flows by its own rate. With
!> ISIG the kinetics depend on the stress (stressed_phases). The stress is the one the kinematics hand to laws: Kirchhoff's for LOG,
!> per volume free of elastic strain, Cauchy's otherwise.
!> The units of the steel's file are turned into those of the deck: STRESS is 1 MPa, TIME the seconds of its unit of time, ZERO
!> what makes its temperatures degC.
!> Sources: those of phase_point and stress_kinetics.
module law_arbthmet
  use kinds, only: wp
  use law_api, only: driver_temperature, law_line, law_t, parameter, parameter_t, row_of_volume, row_of_work
  use materials, only: has_number, material_t
  use mechanical_data, only: lacking_mechanical_data, lacking_viscosity
  use phase_flow, only: has_yield
  use phase_mechanics, only: mixture_moduli
  use phase_point, only: first_hardening, first_phases, flow_stress_of_point, place_cowper, place_isig, place_melt, place_rate, &
                         place_stress, place_time, place_trip, place_visco, place_zero, return_of_point, row_plastic, row_trip, &
                         row_work, stress_row
  use phase_state, only: at_coldest, at_grain, first_fraction, never_cold, state_names, state_size, state_units
  use phase_step, only: advance_phases
  use state_variables, only: state_variable, transfer_fraction, transfer_scalar
  use steels, only: austenite, phase_count, phase_names
  use stressed_phases, only: measures_of, return_under_stress
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_arbthmet_row

  !> Place of the first fraction among the drivers.
  integer, parameter :: driver_fraction = 2
contains

  function law_arbthmet_row() result(row)
    type(law_t) :: row
    integer :: k

    row%name = 'ARBTHMET'
    row%number = 350
    row%purpose = 'steel with phases: strains and plasticity of transformation'
    row%source = 'Leblond 1989; Simo and Taylor 1985; data of the steel''s file'
    row%effects = 'plasticity temperature'
    row%of_steel = .true.
    allocate (row%lines, source=[law_line(parameters(), pairs=.true.)])
    allocate (row%history(first_phases + state_size + 2), row%drivers(phase_count))
    row%history(row_plastic) = state_variable('plastic_strain', '-', transfer_scalar)
    row%history(row_work) = state_variable('plastic_work', 'stress', transfer_scalar)
    row%history(row_trip) = state_variable('transformation_plasticity', '-', transfer_scalar)
    do k = 1, phase_count
      row%drivers(k)%name = trim(state_names(k))
      row%history(first_hardening + k - 1) = state_variable('hardening_'//trim(state_names(k)), '-', transfer_scalar)
    end do
    do k = 1, state_size
      if (k < first_fraction + phase_count) then
        row%history(first_phases + k - 1) = state_variable(trim(state_names(k)), trim(state_units(k)), transfer_fraction, &
                                                           needs=place_time)
      else
        row%history(first_phases + k - 1) = state_variable(trim(state_names(k)), trim(state_units(k)), transfer_scalar, &
                                                           needs=place_time)
      end if
    end do
    row%history(first_phases + austenite - 1)%initial = 1
    row%history(first_phases + at_coldest - 1)%initial = never_cold
    row%history(first_phases + state_size) = state_variable('plastic_rate', '1/time', transfer_scalar, needs=place_rate, &
                                                               or_needs=place_visco)
    row%history(first_phases + state_size + 1) = state_variable('kinetic_mean', 'stress', transfer_scalar, needs=place_isig)
    row%history(first_phases + state_size + 2) = state_variable('kinetic_mises', 'stress', transfer_scalar, needs=place_isig)
    row%swells_with = place_isig
    row%update => update
    row%flow_stress => flow_stress
    row%elastic => elastic_of_austenite
    row%check => check
    row%check_phases => check_phases
  end function law_arbthmet_row

  function parameters() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(9))
    list(place_stress) = parameter('STRESS', 'stress', 'that of 1 MPa in units of the deck', above=0.0_wp)
    list(place_time) = parameter('TIME', '-', 'seconds of a unit of time: the law follows the kinetics itself; 0: others do', &
                                 lower=0.0_wp, default=0.0_wp)
    list(place_zero) = parameter('ZERO', 'temperature', 'what is added to make temperatures degC', default=0.0_wp)
    list(place_trip) = parameter('TRIP', '-', 'factor of transformation plasticity', lower=0.0_wp, default=1.0_wp)
    list(place_rate) = parameter('RATE0', '1/time', 'reference rate of COWPER', lower=0.0_wp, default=0.0_wp)
    list(place_cowper) = parameter('COWPER', '-', 'P: yield times 1 + (rate/RATE0)^(1/P)', lower=0.0_wp, default=0.0_wp)
    list(place_visco) = parameter('VISCO', '-', 'seconds of a unit of time: phases flow by the rate (P1 to P4); 0: not', &
                                  lower=0.0_wp, default=0.0_wp)
    list(place_isig) = parameter('ISIG', '-', '1: stress acts on the kinetics that the law follows', lower=0.0_wp, upper=1.0_wp, &
                                 default=0.0_wp, whole=.true.)
    list(place_melt) = parameter('MELT', 'temperature', 'from which on hardening is lost; 0: never', lower=0.0_wp, default=0.0_wp)
  end function parameters

  pure subroutine update(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: z(phase_count, 2), temperature(2), start(size(committed, 1)), by_work(4)
    logical :: follows
    integer :: n, row

    follows = material%values(place_time) > 0
    row = stress_row(material)
    do n = 1, size(trial_strain, 2)
      history(:, n) = committed(:, n)
      temperature = drivers(driver_temperature, :, n) + material%values(place_zero)
      if (follows .and. dt > 0) then
        start = with_grain(material, committed(:, n))
        if (row > 0) then
          call return_under_stress(material, dt, temperature, trial_strain(:, n), start, stress(:, n), elastic_strain(:, n), &
                                   history(:, n), tangent(:, :, n), status(n))
          cycle
        end if
        call follow_kinetics(material, dt, temperature, start(first_phases:), history(first_phases:, n))
        z(:, 1) = committed(first_phases:first_phases + phase_count - 1, n)
        z(:, 2) = history(first_phases:first_phases + phase_count - 1, n)
      else
        ! in no time nothing forms but what is given
        z = drivers(driver_fraction:driver_fraction + phase_count - 1, :, n)
        if (follows) history(first_phases:first_phases + phase_count - 1, n) = z(:, 2)
      end if
      call return_of_point(material, dt, temperature, z, trial_strain(:, n), stress(:, n), elastic_strain(:, n), history(:, n), &
                           tangent(:4, :, n), by_work, status(n))
      if (size(tangent, 1) >= row_of_volume) tangent(row_of_volume, :, n) = [1, 1, 0, 1]
      if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :, n) = by_work
      if (row > 0) history(row:row + 1, n) = measures_of(stress(:, n))
    end do
  end subroutine update

  !> The state at the start of a step, with the grain of the steel where there is none yet.
  pure function with_grain(material, committed) result(start)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: committed(:)
    real(wp) :: start(size(committed))

    start = committed
    if (.not. start(first_phases + at_grain - 1) > 0) start(first_phases + at_grain - 1) = material%steel%grain
  end function with_grain

  !> Phases at the end of the step, at the temperature of the point.
  pure subroutine follow_kinetics(material, dt, temperature, start, history)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(2), start(:)
    real(wp), intent(inout) :: history(:)
    real(wp) :: slope(state_size), heat, heat_slope

    call advance_phases(material%steel, dt*material%values(place_time), temperature(1), temperature(2), start(:state_size), &
                        history(:state_size), slope, heat, heat_slope)
  end subroutine follow_kinetics

  !> Stress to flow at what has been reached; 0 for a steel that does not flow.
  pure function flow_stress(material, drivers, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:), history(:)
    real(wp) :: stress
    real(wp) :: z(phase_count)

    if (material%values(place_time) > 0) then
      z = history(first_phases:first_phases + phase_count - 1)
    else
      z = drivers(driver_fraction:driver_fraction + phase_count - 1)
    end if
    stress = flow_stress_of_point(material, z, drivers(driver_temperature) + material%values(place_zero), history)
  end function flow_stress

  !> Moduli of austenite at a temperature: those of the phases differ little.
  pure subroutine elastic_of_austenite(material, temperature, young, poisson)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    real(wp), intent(out) :: young, poisson   !! [stress], [-]
    real(wp) :: z(phase_count)

    z = 0
    z(austenite) = 1
    call mixture_moduli(material%steel, z, temperature + material%values(place_zero), young, poisson)
    young = young*material%values(place_stress)
  end subroutine elastic_of_austenite

  !> The steel has the mechanics of all phases that may be there; RATE0 and COWPER go together.
  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    call lacking_mechanical_data(material%steel, problems)
    if ((material%values(place_rate) > 0) .neqv. (material%values(place_cowper) > 0)) &
      call add_text(problems, 'RATE0 and COWPER go together')
    if (material%values(place_rate) > 0 .and. .not. has_yield(material%steel)) &
      call add_text(problems, 'RATE0 needs a steel with SY of '//trim(phase_names(austenite)))
    if (material%values(place_rate) > 0 .and. material%values(place_visco) > 0) &
      call add_text(problems, 'RATE0 and VISCO are two laws of the rate: expected one of them')
    if (material%values(place_visco) > 0) call lacking_viscosity(material%steel, problems)
    if (.not. has_number(material, place_isig)) return
    if (.not. material%values(place_time) > 0) call add_text(problems, 'ISIG needs TIME: the law must follow the kinetics itself')
    if (.not. material%steel%isig%given) &
      call add_text(problems, 'the steel '''//material%steel%name//''' has no card ISIG, the effect of stress on its kinetics')
  end subroutine check

  !> Phases that are there at the start and would not form have their mechanics too.
  pure subroutine check_phases(material, given, problems)
    type(material_t), intent(in) :: material
    logical, intent(in) :: given(:)   !! (phase_count)
    type(string_t), allocatable, intent(out) :: problems(:)

    call lacking_mechanical_data(material%steel, problems, given)
    if (material%values(place_visco) > 0) call lacking_viscosity(material%steel, problems, given)
  end subroutine check_phases

end module law_arbthmet
