!> ARBTHMET (350): elastic, elastoplastic or viscoplastic steel with phases.
!>
!> strain = elastic + plastic + by transformation plasticity + by temperature and phases (src/phases/phase_mechanics). The fractions
!> are those of a formulation with phases on the same body, known at both ends of the step; or, with TIME, the law follows the
!> kinetics of the steel at its own temperature.
!> Return: the deviator s and its von Mises measure q at the end obey s = s_trial - 2 G (3/2) (dp/q + dG) s, so that with
!> A = 1 + 3 G dG, A q = q_trial - 3 G dp: the return of a steel whose flow stress is A times as large, after which deviators are
!> divided by A. For a flow stress of slope R' that is dp = f A/(3 G + A R'), f = q_trial/A - R. With RATE0 and COWPER the flow
!> stress grows with the rate (radial_return). The stress is the one the kinematics hand to laws: Kirchhoff's for LOG, per volume
!> free of elastic strain, Cauchy's otherwise.
!> The units of the steel's file are turned into those of the deck: STRESS is 1 MPa, TIME the seconds of its unit of time, ZERO
!> what makes its temperatures degC.
!> Sources: J.-B. Leblond, Int. J. Plasticity 5 (1989) 573-591; code_aster R4.04.02; J.C. Simo, R.L. Taylor, CMAME 48 (1985)
!> 101-118.
module law_arbthmet
  use elasticity, only: hooke_stress, hooke_tangent, moduli
  use hardening, only: most_numbers
  use kinds, only: wp
  use law_api, only: driver_temperature, law_done, law_line, law_not_converged, law_t, parameter, parameter_t
  use materials, only: has_number, material_t
  use phase_mechanics, only: carry_hardening, has_yield, lacking_mechanical_data, mixture_moduli, mixture_yield, &
                             plasticity_of_transformation, strain_of_phases
  use phase_state, only: at_coldest, at_grain, first_fraction, never_cold, state_names, state_size, state_units
  use phase_step, only: advance_phases
  use radial_return, only: flow_stress_at, flow_t, return_point
  use rate_dependence, only: rate_cowper
  use state_variables, only: state_variable, transfer_fraction, transfer_scalar
  use steels, only: austenite, phase_count, phase_names
  use stress_measures, only: von_mises
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_arbthmet_row

  !> Places among the values of a material.
  integer, parameter :: place_stress = 1, place_time = 2, place_zero = 3, place_trip = 4, place_rate = 5, place_cowper = 6
  !> Rows of the history: plastic strain, dissipated work, strain of transformation plasticity, hardening of the phases; then what
  !> follows where TIME is given, and the plastic rate last.
  integer, parameter :: row_plastic = 1, row_work = 2, row_trip = 3, first_hardening = 4, &
                        first_phases = first_hardening + phase_count
  !> Place of the first fraction among the drivers.
  integer, parameter :: driver_fraction = 2
  !> Rows of what the return knows of a point: plastic strain, work, rate.
  integer, parameter :: return_rows = 3

  !> Normal components of a tensor (xx, yy, xy, zz).
  integer, parameter :: normal(3) = [1, 2, 4]

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
    allocate (row%history(first_phases + state_size), row%drivers(phase_count))
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
    row%history(first_phases + state_size) = state_variable('plastic_rate', '1/time', transfer_scalar, needs=place_rate)
    row%update => update
    row%flow_stress => flow_stress
    row%elastic => elastic_of_austenite
    row%check => check
  end function law_arbthmet_row

  function parameters() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(6))
    list(place_stress) = parameter('STRESS', 'stress', 'that of 1 MPa in units of the deck', above=0.0_wp)
    list(place_time) = parameter('TIME', '-', 'seconds of a unit of time: the law follows the kinetics itself; 0: others do', &
                                 lower=0.0_wp, default=0.0_wp)
    list(place_zero) = parameter('ZERO', 'temperature', 'what is added to make temperatures degC', default=0.0_wp)
    list(place_trip) = parameter('TRIP', '-', 'factor of transformation plasticity', lower=0.0_wp, default=1.0_wp)
    list(place_rate) = parameter('RATE0', '1/time', 'reference rate of COWPER', lower=0.0_wp, default=0.0_wp)
    list(place_cowper) = parameter('COWPER', '-', 'P: yield times 1 + (rate/RATE0)^(1/P)', lower=0.0_wp, default=0.0_wp)
  end function parameters

  pure subroutine update(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: z(phase_count, 2), temperature(2)
    logical :: follows, flows
    integer :: n

    follows = material%values(place_time) > 0
    flows = has_yield(material%steel)
    do n = 1, size(trial_strain, 2)
      history(:, n) = committed(:, n)
      temperature = drivers(driver_temperature, :, n) + material%values(place_zero)
      if (follows .and. dt > 0) then
        call follow_kinetics(material, dt, temperature, committed(first_phases:, n), history(first_phases:, n))
        z(:, 1) = committed(first_phases:first_phases + phase_count - 1, n)
        z(:, 2) = history(first_phases:first_phases + phase_count - 1, n)
      else
        ! in no time nothing forms but what is given
        z = drivers(driver_fraction:driver_fraction + phase_count - 1, :, n)
        if (follows) history(first_phases:first_phases + phase_count - 1, n) = z(:, 2)
      end if
      call update_point(material, flows, dt, temperature, z, trial_strain(:, n), stress(:, n), elastic_strain(:, n), &
                        history(:, n), tangent(:, :, n), status(n))
    end do
  end subroutine update

  !> Phases at the end of the step, at the temperature of the point.
  pure subroutine follow_kinetics(material, dt, temperature, committed, history)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(2), committed(:)
    real(wp), intent(inout) :: history(:)
    real(wp) :: start(state_size), slope(state_size), heat, heat_slope

    start = committed(:state_size)
    if (.not. start(at_grain) > 0) start(at_grain) = material%steel%grain
    call advance_phases(material%steel, dt*material%values(place_time), temperature(1), temperature(2), start, &
                        history(:state_size), slope, heat, heat_slope)
  end subroutine follow_kinetics

  !> One point whose fractions are known at both ends of the step.
  pure subroutine update_point(material, flows, dt, temperature, z, trial_strain, stress, elastic_strain, history, tangent, &
                               status)
    type(material_t), intent(in) :: material
    logical, intent(in) :: flows
    real(wp), intent(in) :: dt, temperature(2), z(phase_count, 2), trial_strain(4)
    real(wp), intent(out) :: stress(4), elastic_strain(4)
    real(wp), intent(inout) :: history(:)
    real(wp), intent(out) :: tangent(4, 4)
    integer, intent(out) :: status
    type(flow_t) :: flow
    real(wp) :: trial(4), curve(2, phase_count), known(return_rows), found(return_rows), dg, a, q

    associate (steel => material%steel, hardened => history(first_hardening:first_hardening + phase_count - 1))
      call elastic_flow(material, z(:, 2), temperature(2), flow)
      trial = trial_strain
      trial(normal) = trial(normal) - strain_of_phases(steel, z(:, 1), z(:, 2), temperature(1), temperature(2))
      dg = 0
      if (dt > 0) dg = material%values(place_trip)/material%values(place_stress) &
                       *plasticity_of_transformation(steel, z(:, 1), z(:, 2), temperature(1), temperature(2))
      a = 1 + 3*flow%shear*dg
      known = 0
      found = 0
      status = law_done
      if (flows) then
        call carry_hardening(steel, z(:, 1), z(:, 2), temperature(2), hardened)
        call flow_of_mixture(material, z(:, 2), hardened, temperature(2), a, flow, curve)
        if (flow%rate_row > 0) known(flow%rate_row) = history(rate_row(material))
        call return_point(flow, curve, curve, dt, trial, known, stress, elastic_strain, found, tangent, status)
        if (.not. flow%below(1) > 0) status = law_not_converged
        hardened = hardened + found(row_plastic)
        if (flow%rate_row > 0) history(rate_row(material)) = found(flow%rate_row)
      else
        stress = hooke_stress(flow%bulk, flow%shear, trial)
        elastic_strain = trial
        tangent = hooke_tangent(flow%bulk, flow%shear)
      end if
    end associate
    if (a > 1) then
      stress = with_deviator_over(a, stress)
      elastic_strain = with_deviator_over(a, elastic_strain)
      tangent = tangent/a
      tangent(normal, normal) = tangent(normal, normal) + flow%bulk*(1 - 1/a)
    end if
    q = von_mises(stress)
    history(row_plastic) = history(row_plastic) + found(row_plastic)
    history(row_work) = history(row_work) + found(row_work)/a + q*q*dg
    history(row_trip) = history(row_trip) + q*dg
  end subroutine update_point

  !> Moduli of the mixture, in units of the deck.
  pure subroutine elastic_flow(material, z, temperature, flow)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: z(:), temperature
    type(flow_t), intent(out) :: flow
    real(wp) :: young, poisson

    call mixture_moduli(material%steel, z, temperature, young, poisson)
    call moduli(young*material%values(place_stress), poisson, flow%bulk, flow%shear)
  end subroutine elastic_flow

  !> Flow stress of the mixture times `a`, as a function of the plastic strain of the step.
  pure subroutine flow_of_mixture(material, z, hardened, temperature, a, flow, curve)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: z(:), hardened(:), temperature, a
    type(flow_t), intent(inout) :: flow
    real(wp), intent(out) :: curve(:, :)

    call mixture_yield(material%steel, z, hardened, temperature, flow%below(:2), curve)
    flow%below(:2) = flow%below(:2)*(a*material%values(place_stress))
    curve(2, :) = curve(2, :)*(a*material%values(place_stress))
    flow%yield => yield_mixture
    if (.not. has_number(material, place_rate)) return
    flow%rate_row = return_rows
    flow%rate_form = rate_cowper
    flow%rate = material%values([place_rate, place_cowper])
  end subroutine flow_of_mixture

  !> Row of the plastic rate in the history.
  pure function rate_row(material) result(row)
    type(material_t), intent(in) :: material
    integer :: row

    row = first_phases + merge(state_size, 0, material%values(place_time) > 0)
  end function rate_row

  !> a(1) + a(2) p + sum c_i (1 - exp(-b_i p)), b and c in `curve`.
  pure subroutine yield_mixture(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [stress]
    real(wp), intent(in) :: curve(:, :)       !! (2, npoint): b [-], c [stress]
    real(wp), intent(in) :: p                 !! plastic strain of the step [-]
    real(wp), intent(out) :: sy, slope        !! [stress]
    real(wp) :: left(size(curve, 2))

    left = curve(2, :)*exp(-curve(1, :)*p)
    sy = a(1) + a(2)*p + sum(curve(2, :) - left)
    slope = a(2) + sum(curve(1, :)*left)
  end subroutine yield_mixture

  !> Stress to flow at what has been reached; 0 for a steel without yield stresses.
  pure function flow_stress(material, drivers, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:), history(:)
    real(wp) :: stress
    type(flow_t) :: flow
    real(wp) :: z(phase_count), curve(2, phase_count), rate

    stress = 0
    if (.not. has_yield(material%steel)) return
    if (material%values(place_time) > 0) then
      z = history(first_phases:first_phases + phase_count - 1)
    else
      z = drivers(driver_fraction:driver_fraction + phase_count - 1)
    end if
    call flow_of_mixture(material, z, history(first_hardening:first_hardening + phase_count - 1), &
                         drivers(driver_temperature) + material%values(place_zero), 1.0_wp, flow, curve)
    rate = 0
    if (flow%rate_row > 0) rate = history(rate_row(material))
    stress = flow_stress_at(flow, curve, curve, 0.0_wp, rate)
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

  !> A symmetric tensor (xx, yy, xy, zz) whose deviator is divided by a number.
  pure function with_deviator_over(a, tensor) result(divided)
    real(wp), intent(in) :: a
    real(wp), intent(in) :: tensor(4)   !! [of any unit]
    real(wp) :: divided(4)

    divided = tensor/a
    divided(normal) = divided(normal) + sum(tensor(normal))/3*(1 - 1/a)
  end function with_deviator_over

  !> The steel has the mechanics of all phases that may be there; RATE0 and COWPER go together.
  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    call lacking_mechanical_data(material%steel, problems)
    if ((material%values(place_rate) > 0) .neqv. (material%values(place_cowper) > 0)) &
      call add_text(problems, 'RATE0 and COWPER go together')
    if (material%values(place_rate) > 0 .and. .not. has_yield(material%steel)) &
      call add_text(problems, 'RATE0 needs a steel with SY of '//trim(phase_names(austenite)))
  end subroutine check

end module law_arbthmet
