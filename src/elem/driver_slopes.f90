!> Derivatives of drivers by the temperature, where states of a formulation of heat drive mechanics solved together with it; and of
!> heat by stress, where stress drives the heat.
!>
!> In one system for all fields (SOLVE MONOLITHIC) the fractions that PL8TM holds change with the unknown temperature, and the
!> mechanics with them. Such groups have a third plane of drivers: d(driver at the end)/d(temperature at the point at the end), by
!> central differences of what the law of heat releases; error eps**(2/3). Where temperatures stand on all nodes, PL8LS takes
!> them projected (point_temperatures) and PL8TM as they are: the derivative goes along the projected ones.
!>
!> Where the law of heat is driven by measures of the stress (METAMEC), mechanics has a fourth plane: d(heat released)/d(measure at
!> the end) at the point, found in the same way at the stress of the last evaluation; PL8LS knows how the stress follows the motion.
!> Planes behind it hold d(LAMBDA)/d(measure at the end) times the weight, for each instant at which heat flows: phases conduct.
module driver_slopes
  use driver_values, only: field_at_points
  use drivers, only: drivers_t, drives_heat, from_itself, from_state, from_stress, with_slopes
  use elem_api, only: instant_t
  use fields, only: find_field
  use kinds, only: wp
  use law_api, only: driver_count, driver_temperature, law_t
  use point_temperatures, only: temperature_field
  use scene, only: host_of, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: fill_slopes

contains

  !> The third plane of a group's drivers.
  subroutine fill_slopes(scene, laws, solution, now, instant, g, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: now(:, :)    !! (nnode, nfield) trial values of the nodal fields of one component [unit of each field]
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: g             !! number of the group
    type(drivers_t), intent(inout) :: drivers(:)   !! (ngroup)
    real(wp), allocatable :: high(:), low(:)   ! state of a point at a higher and at a lower temperature
    real(wp) :: dt   ! since the start of the step [time]
    integer :: k, body, other, e, f, n

    dt = instant%dt/instant%share
    if (drives_heat(drivers(g))) call fill_heat(scene, laws, solution, now, instant, dt, g, drivers)
    if (.not. with_slopes(drivers(g))) return
    drivers(g)%value(:, 3, :, :) = 0
    if (.not. dt > 0) return   ! on a new mesh nothing forms
    body = host_of(scene, g)
    f = find_field(scene%fields, temperature_field)
    other = 0
    do k = 1, size(drivers(g)%source)
      if (drivers(g)%source(k)%kind == from_state) other = drivers(g)%source(k)%group(body)
    end do
    n = size(solution%groups(other)%committed, 1)
    allocate (high(n), low(n))
    do e = 1, size(drivers(g)%value, 4)
      call slopes_of_element(field_at_points(scene%fields(f), solution%fields(f)%value(1, :), scene%groups(other), e), &
                             field_at_points(scene%fields(f), now(:, f), scene%groups(other), e))
    end do

  contains

    !> At the points of an element, from the temperatures there at both ends of the step.
    subroutine slopes_of_element(before, after)
      real(wp), intent(in) :: before(:), after(:)
      real(wp) :: given(driver_count(laws(scene%materials(scene%groups(other)%material)%law_id)), 2), change, heat, of_work, slope
      integer :: p, row

      associate (material => scene%materials(scene%groups(other)%material), committed => solution%groups(other)%committed)
        do p = 1, size(before)
          given = drivers(other)%value(:size(given, 1), :2, p, e)
          change = epsilon(1.0_wp)**(1.0_wp/3)*max(abs(before(p)), abs(after(p)))
          if (.not. change > 0) change = epsilon(1.0_wp)**(1.0_wp/3)
          given(driver_temperature, :) = [before(p), after(p) + change]
          call laws(material%law_id)%release(material, dt, given, committed(:n, p, e), heat, of_work, slope, high)
          given(driver_temperature, 2) = after(p) - change
          call laws(material%law_id)%release(material, dt, given, committed(:n, p, e), heat, of_work, slope, low)
          do k = 1, size(drivers(g)%source)
            if (drivers(g)%source(k)%kind /= from_state) cycle
            row = drivers(g)%source(k)%row(body)
            if (row <= n) drivers(g)%value(k, 3, p, e) = (high(row) - low(row))/(2*change)
          end do
        end do
      end associate
    end subroutine slopes_of_element

  end subroutine fill_slopes

  !> The fourth plane of a group's drivers and those behind it: heat released per volume and conductivity, per unit of each measure
  !> of its stress.
  subroutine fill_heat(scene, laws, solution, now, instant, dt, g, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: now(:, :)
    type(instant_t), intent(in) :: instant
    real(wp), intent(in) :: dt
    integer, intent(in) :: g
    type(drivers_t), intent(inout) :: drivers(:)
    integer :: other, e, f, k

    drivers(g)%value(:, 4:, :, :) = 0
    if (.not. dt > 0) return
    f = find_field(scene%fields, temperature_field)
    do other = 1, size(drivers)
      if (other == g .or. .not. allocated(drivers(other)%source) .or. host_of(scene, other) /= g) cycle
      if (.not. any([(drivers(other)%source(k)%kind == from_stress, k=1, size(drivers(other)%source))])) cycle
      do e = 1, size(drivers(other)%value, 4)
        call heat_of_element(field_at_points(scene%fields(f), solution%fields(f)%value(1, :), scene%groups(other), e), &
                             field_at_points(scene%fields(f), now(:, f), scene%groups(other), e))
      end do
    end do

  contains

    !> At the points of an element, from the temperatures there at both ends of the step.
    subroutine heat_of_element(before, after)
      real(wp), intent(in) :: before(:), after(:)
      real(wp) :: given(driver_count(laws(scene%materials(scene%groups(other)%material)%law_id)), 2)
      real(wp) :: change, high, low, of_work, slope
      real(wp), allocatable :: more(:), less(:)   ! states
      integer :: p, d, n

      associate (material => scene%materials(scene%groups(other)%material), committed => solution%groups(other)%committed, &
                 sources => drivers(other)%source)
        n = size(committed, 1)
        allocate (more(n), less(n))
        do p = 1, size(before)
          given = drivers(other)%value(:size(given, 1), :2, p, e)
          given(driver_temperature, :) = [before(p), after(p)]
          do d = 1, size(sources)
            if (sources(d)%kind /= from_stress) cycle
            change = epsilon(1.0_wp)**(1.0_wp/3)*maxval(abs(given(:, 2)), mask=sources(:size(given, 1))%kind == from_stress)
            if (.not. change > 0) cycle
            given(d, 2) = given(d, 2) + change
            call laws(material%law_id)%release(material, dt, given, committed(:n, p, e), high, of_work, slope, more)
            given(d, 2) = given(d, 2) - 2*change
            call laws(material%law_id)%release(material, dt, given, committed(:n, p, e), low, of_work, slope, less)
            given(d, 2) = given(d, 2) + change
            drivers(g)%value(sources(d)%measure, 4, p, e) = (high - low)/(2*change)
            do k = 1, instant%flow%n
              drivers(g)%value(sources(d)%measure, 4 + k, p, e) = &
                instant%flow%weight(k)*conductivity_by(k, given, 0.5_wp*(more + less), (more - less)/(2*change))
            end do
          end do
        end do
      end associate
    end subroutine heat_of_element

    !> By how much a point conducts better at an instant of the flow rule, by a change of its states at the end of the step.
    pure function conductivity_by(instant_of_flow, given, state, changes) result(change)
      integer, intent(in) :: instant_of_flow
      real(wp), intent(in) :: given(:, :)             !! (ndriver, 2)
      real(wp), intent(in) :: state(:), changes(:)    !! (nstate) at the end of the step, and by how much they change
      real(wp) :: change                              !! [power/length/temperature/unit of the change]
      real(wp) :: at(size(given, 1), 1), by_driver(size(given, 1), 1), conductivity(1), slope(1)
      integer :: d

      associate (share => instant%flow%share(instant_of_flow), sources => drivers(other)%source(:size(given, 1)), &
                 material => scene%materials(scene%groups(other)%material))
        at(:, 1) = (1 - share)*given(:, 1) + share*given(:, 2)
        do d = 1, size(sources)
          if (sources(d)%kind == from_itself) at(d, 1) = (1 - share)*given(d, 1) + share*state(sources(d)%row(other))
        end do
        call laws(material%law_id)%conduct(material, at, conductivity, slope, by_driver)
        change = 0
        do d = 1, size(sources)
          if (sources(d)%kind == from_itself) change = change + share*by_driver(d, 1)*changes(sources(d)%row(other))
        end do
      end associate
    end function conductivity_by

  end subroutine fill_heat

end module driver_slopes
