!> META (312), and METAMEC (313), whose phases form under the stress of the body: conduction of heat in a steel whose phases change.
!>
!> The points of the body hold the fractions of the phases and what their kinetics remember (src/phases). Heat flow
!> -LAMBDA(T, z) grad T, LAMBDA that of the mixture at the instant of the flow. Heat taken up is that of austenite, exact between
!> any temperatures; what the other phases take up more or less, with the mean of their fractions at both ends of the step, and the
!> latent heat are released at the points, with the exact derivative by the temperature at the end. In the books of heat the former
!> is heat taken up, which so is that of the phases there are. A steel whose heat content H holds the latent heat has none beside.
!> The data are in the units of the steel's file: ENERGY is 1 MJ/m3 in the deck's [energy/length^3], CONDUCT 1 W/m/K in its unit of
!> conductivity, TIME the seconds of its unit of time, ZERO what makes its temperatures degC. QUINNEY turns plastic work into heat.
!> Source: S. Denis, D. Farias, A. Simon, ISIJ Int. 32 (1992) 316; kinetics: where they stand.
module law_meta
  use heat_of_phases, only: capacity_bends, heat_taken, lacking_heat_data, mixture_conductivity, phase_conductivities
  use heat_sources, only: share_of_work, work_heated, work_name
  use kinds, only: wp
  use law_api, only: driver_t, driver_temperature, heat_law, law_line, law_t, parameter, parameter_t
  use materials, only: has_number, material_t
  use phase_state, only: at_coldest, at_grain, first_fraction, never_cold, state_names, state_size, state_units
  use phase_step, only: advance_phases
  use state_variables, only: state_variable, transfer_fraction, transfer_scalar
  use steels, only: austenite, phase_count
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_meta_row, law_metamec_row

  !> Places among the values of a material; place of the first fraction among the drivers.
  integer, parameter :: place_energy = 1, place_conduct = 2, place_time = 3, place_zero = 4, place_source = 5, place_share = 6, &
                        driver_fraction = 2
  !> Those of METAMEC alone, and its first driver by stress.
  integer, parameter :: place_stress = 7, place_isig = 8, driver_stress = driver_fraction + phase_count

contains

  function law_meta_row() result(row)
    type(law_t) :: row
    integer :: k

    row%name = 'META'
    row%number = 312
    row%kind = heat_law
    row%purpose = 'conduction of heat in a steel with phases'
    row%source = 'Fourier; kinetics of the steel''s file'
    row%effects = ''
    row%of_steel = .true.
    row%symmetric_by_temperature = .false.
    allocate (row%lines, source=[law_line(units(), pairs=.true.)])
    allocate (row%history(state_size + 1), row%drivers(phase_count + 1))
    do k = 1, state_size
      row%history(k) = state_variable(trim(state_names(k)), trim(state_units(k)), &
                                      merge(transfer_fraction, transfer_scalar//'  ', k < first_fraction + phase_count))
      row%history(k)%transfer = trim(row%history(k)%transfer)
    end do
    row%history(austenite)%initial = 1
    row%history(at_coldest)%initial = never_cold
    row%history(state_size + 1) = state_variable(work_heated, 'stress', transfer_scalar, needs=place_share)
    do k = 1, phase_count
      row%drivers(k)%name = trim(state_names(k))
    end do
    row%drivers(phase_count + 1) = driver_t(work_name, place_share)
    row%conduct => conduct
    row%store => store
    row%bends => bends
    row%swell => swell
    row%release => release
    row%check => check
    row%check_phases => check_phases
  end function law_meta_row

  !> META, with the mean and von Mises' stress of the mechanics on the same body among its drivers.
  function law_metamec_row() result(row)
    type(law_t) :: row

    row = law_meta_row()
    row%name = 'METAMEC'
    row%number = 313
    row%purpose = 'conduction of heat in a steel whose phases form under stress'
    row%lines(1)%parameters = [row%lines(1)%parameters, &
        parameter('STRESS', 'stress', 'that of 1 MPa in units of the deck', above=0.0_wp), &
        parameter('ISIG', '-', '1: stress acts on the kinetics, 0: it does not', lower=0.0_wp, upper=1.0_wp, whole=.true.)]
    ! the plastic work stays the last one
    row%drivers = [row%drivers(:phase_count), driver_t('mean_stress', place_isig), driver_t('mises', place_isig), &
                   row%drivers(phase_count + 1)]
    row%check => check_stress
  end function law_metamec_row

  !> Units of the steel's file in those of the deck, SOURCE and QUINNEY.
  function units() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(6))
    list(place_energy) = parameter('ENERGY', 'energy/length^3', 'that of 1 MJ/m3 in units of the deck', above=0.0_wp)
    list(place_conduct) = parameter('CONDUCT', '-', 'conductivity of 1 W/m/K in units of the deck', above=0.0_wp, default=1.0_wp)
    list(place_time) = parameter('TIME', '-', 'seconds of a unit of time', above=0.0_wp, default=1.0_wp)
    list(place_zero) = parameter('ZERO', 'temperature', 'what is added to make temperatures degC', default=0.0_wp)
    list(place_source) = parameter('SOURCE', 'energy/length^3', 'heat taken up by a change of volume, per volume strain', &
                                   default=0.0_wp)
    list(place_share) = parameter('QUINNEY', '-', 'share of the plastic work that becomes heat', lower=0.0_wp, upper=1.0_wp, &
                                  default=0.0_wp, turns_on=.true.)
  end function units

  !> Conductivity of the mixture.
  pure subroutine conduct(material, drivers, conductivity, slope, by_driver)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    real(wp), intent(out) :: conductivity(:), slope(:)
    real(wp), intent(out), optional :: by_driver(:, :)
    integer :: n

    do n = 1, size(conductivity)
      call mixture_conductivity(material%steel, drivers(driver_fraction:driver_fraction + phase_count - 1, n), &
                                drivers(driver_temperature, n) + material%values(place_zero), conductivity(n), slope(n))
    end do
    conductivity = conductivity*material%values(place_conduct)
    slope = slope*material%values(place_conduct)
    if (.not. present(by_driver)) return
    by_driver = 0
    do n = 1, size(conductivity)
      by_driver(driver_fraction:driver_fraction + phase_count - 1, n) = &
        material%values(place_conduct)*phase_conductivities(material%steel, drivers(driver_temperature, n) &
                                                            + material%values(place_zero))
    end do
  end subroutine conduct

  !> Heat taken up as by austenite.
  pure subroutine store(material, before, now, taken, capacity)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: before(:, :), now(:, :)
    real(wp), intent(out) :: taken(:), capacity(:)
    integer :: n

    do n = 1, size(taken)
      call heat_taken(material%steel, austenite, before(driver_temperature, n) + material%values(place_zero), &
                      now(driver_temperature, n) + material%values(place_zero), taken(n), capacity(n))
    end do
    taken = taken*material%values(place_energy)
    capacity = capacity*material%values(place_energy)
  end subroutine store

  !> Those of austenite.
  pure subroutine bends(material, temperatures)
    type(material_t), intent(in) :: material
    real(wp), allocatable, intent(out) :: temperatures(:)

    allocate (temperatures, source=capacity_bends(material%steel, austenite) - material%values(place_zero))
  end subroutine bends

  !> Phases at the end of the step, their latent heat, by how much they take up less heat than austenite, and the share of the
  !> plastic work that has not become heat yet.
  pure subroutine release(material, dt, drivers, committed, released, of_work, slope, history, surplus, changes)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :), committed(:)
    real(wp), intent(out) :: released, of_work, slope, history(:)
    real(wp), intent(out), optional :: surplus, changes(:)
    real(wp) :: start(state_size), by_end(state_size), t(2), taken, capacity, own(2), mean, less, stresses(2, 2)
    integer :: i

    start = committed(:state_size)
    if (.not. start(at_grain) > 0) start(at_grain) = material%steel%grain
    t = drivers(driver_temperature, :) + material%values(place_zero)
    stresses = 0
    if (size(drivers, 1) > driver_stress) then
      if (has_number(material, place_isig)) stresses = drivers(driver_stress:driver_stress + 1, :)/material%values(place_stress)
    end if
    call advance_phases(material%steel, dt*material%values(place_time), t(1), t(2), start, history(:state_size), by_end, &
                        released, slope, stresses)
    less = 0
    if (.not. material%steel%one_heat) then
      call heat_taken(material%steel, austenite, t(1), t(2), taken, capacity)
      do i = 1, phase_count
        mean = 0.5_wp*(start(i) + history(i))
        if (i == austenite .or. .not. mean > 0) cycle
        call heat_taken(material%steel, i, t(1), t(2), own(1), own(2))
        less = less + mean*(taken - own(1))
        slope = slope + mean*(capacity - own(2)) + 0.5_wp*by_end(i)*(taken - own(1))
      end do
    end if
    released = (released + less)*material%values(place_energy)
    if (present(changes)) then
      changes = 0
      changes(:state_size) = by_end
    end if
    if (present(surplus)) surplus = less*material%values(place_energy)
    slope = slope*material%values(place_energy)
    of_work = 0
    if (.not. has_number(material, place_share)) return
    associate (work => drivers(size(drivers, 1), 2), heated => history(state_size + 1))
      of_work = share_of_work(material, place_share, drivers(driver_temperature, 1))*(work - committed(state_size + 1))
      heated = work
    end associate
  end subroutine release

  !> SOURCE.
  pure function swell(material, temperature) result(heat)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    real(wp) :: heat

    heat = material%values(place_source)
    if (temperature < -huge(temperature)) heat = 0   ! a number that holds at any temperature
  end function swell

  !> The steel has conductivity and heat of all phases that may form.
  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    call lacking_heat_data(material%steel, problems)
  end subroutine check

  !> The same of phases that are there at the start and would not form.
  pure subroutine check_phases(material, given, problems)
    type(material_t), intent(in) :: material
    logical, intent(in) :: given(:)   !! (phase_count)
    type(string_t), allocatable, intent(out) :: problems(:)

    call lacking_heat_data(material%steel, problems, given)
  end subroutine check_phases

  !> The numbers of METAMEC: as of META, and the steel says how stress acts.
  pure subroutine check_stress(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    call lacking_heat_data(material%steel, problems)
    if (has_number(material, place_isig) .and. .not. material%steel%isig%given) &
      call add_text(problems, 'the steel '''//material%steel%name//''' has no card ISIG, the effect of stress on its kinetics')
  end subroutine check_stress

end module law_meta
