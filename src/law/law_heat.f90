!> HEAT and HEATH: isotropic conduction of heat.
!>
!> Heat flow -LAMBDA(T) grad T. HEAT has the heat capacity per volume of the start RHOC(T), HEATH the heat content H(T), which
!> holds latent heats too; both linear between the temperatures of the card. The heat taken up from one temperature to another is
!> the exact integral of the capacity, or the difference of the contents, so that no heat is lost at any step; outside its
!> temperatures HEAT keeps its capacity, and HEATH that of its first or last interval.
!> SOURCE is the heat that a change of volume takes up, per volume and unit of volume strain: 3 K ALPHA T of thermoelasticity
!> (W. Thomson 1855; J.M.C. Duhamel). QUINNEY turns plastic work of the body into heat.
module law_heat
  use heat_sources, only: heat_source_parameters, place_share, share_of_work, source_of_volume, work_heated, work_name
  use kinds, only: wp
  use law_api, only: driver_temperature, heat_law, law_line, law_t, parameter
  use materials, only: bracket_temperature, integral_over_temperature, material_t
  use state_variables, only: state_variable, transfer_scalar
  implicit none
  private
  public :: law_heat_row, law_heath_row

  !> Places among the values of a material; the second is RHOC or H. Places of the drivers.
  integer, parameter :: place_conductivity = 1, place_content = 2, driver_work = 2

contains

  function law_heat_row() result(row)
    type(law_t) :: row

    row%name = 'HEAT'
    row%number = 9001
    row%purpose = 'isotropic conduction of heat'
    allocate (row%lines, source=[law_line([parameter('LAMBDA', 'power/length/temperature', 'conductivity', above=0.0_wp), &
                                           parameter('RHOC', 'energy/length^3/temperature', 'heat capacity per volume', &
                                                     above=0.0_wp)]), &
                                 law_line(heat_source_parameters(), pairs=.true.)])
    row%store => store_by_capacity
    call common_parts(row)
  end function law_heat_row

  function law_heath_row() result(row)
    type(law_t) :: row

    row%name = 'HEATH'
    row%number = 9002
    row%purpose = 'isotropic conduction of heat, by heat content'
    allocate (row%lines, source=[law_line([parameter('LAMBDA', 'power/length/temperature', 'conductivity', above=0.0_wp), &
                                           parameter('H', 'energy/length^3', 'heat content per volume', rises=.true.)]), &
                                 law_line(heat_source_parameters(), pairs=.true.)])
    row%store => store_by_content
    call common_parts(row)
  end function law_heath_row

  subroutine common_parts(row)
    type(law_t), intent(inout) :: row

    row%kind = heat_law
    row%source = 'Fourier'
    row%effects = ''
    row%symmetric_by_temperature = .false.
    allocate (row%history(1), row%drivers(1))
    row%history(1) = state_variable(work_heated, 'stress', transfer_scalar, needs=place_share)
    row%drivers(driver_work - 1)%name = work_name
    row%drivers(driver_work - 1)%needs = place_share
    row%conduct => conduct
    row%swell => source_of_volume
    row%release => release
  end subroutine common_parts

  !> Conductivity, linear between the temperatures of the card, constant outside.
  pure subroutine conduct(material, drivers, conductivity, slope, by_driver)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    real(wp), intent(out) :: conductivity(:), slope(:)
    real(wp), intent(out), optional :: by_driver(:, :)
    real(wp) :: share
    integer :: n, k

    slope = 0
    if (present(by_driver)) by_driver = 0
    if (.not. allocated(material%temperatures)) then
      conductivity = material%values(place_conductivity)
      return
    end if
    associate (t => material%temperatures, v => material%values_by_temperature)
      do n = 1, size(conductivity)
        call bracket_temperature(material, drivers(1, n), k, share)
        conductivity(n) = v(place_conductivity, k)
        if (.not. share > 0) cycle
        slope(n) = (v(place_conductivity, k + 1) - v(place_conductivity, k))/(t(k + 1) - t(k))
        conductivity(n) = conductivity(n) + share*(v(place_conductivity, k + 1) - v(place_conductivity, k))
      end do
    end associate
  end subroutine conduct

  !> The integral of RHOC.
  pure subroutine store_by_capacity(material, before, now, taken, capacity)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: before(:, :), now(:, :)
    real(wp), intent(out) :: taken(:), capacity(:)
    real(wp) :: share
    integer :: n, k

    do n = 1, size(taken)
      taken(n) = integral_over_temperature(material, place_content, before(1, n), now(1, n))
      if (.not. allocated(material%temperatures)) then
        capacity(n) = material%values(place_content)
        cycle
      end if
      call bracket_temperature(material, now(1, n), k, share)
      capacity(n) = material%values_by_temperature(place_content, k)
      if (share > 0) capacity(n) = (1 - share)*capacity(n) + share*material%values_by_temperature(place_content, k + 1)
    end do
  end subroutine store_by_capacity

  !> The difference of H.
  pure subroutine store_by_content(material, before, now, taken, capacity)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: before(:, :), now(:, :)
    real(wp), intent(out) :: taken(:), capacity(:)
    integer :: n, a, b

    associate (t => material%temperatures, h => material%values_by_temperature(place_content, :))
      do n = 1, size(taken)
        a = interval(t, before(1, n))
        b = interval(t, now(1, n))
        capacity(n) = (h(b + 1) - h(b))/(t(b + 1) - t(b))
        if (a == b) then
          taken(n) = capacity(n)*(now(1, n) - before(1, n))
        else
          taken(n) = h(b) + capacity(n)*(now(1, n) - t(b)) - h(a) - (h(a + 1) - h(a))/(t(a + 1) - t(a))*(before(1, n) - t(a))
        end if
      end do
    end associate
  end subroutine store_by_content

  !> The interval of a table that holds a temperature; the first or the last where none does.
  pure function interval(t, temperature) result(k)
    real(wp), intent(in) :: t(:), temperature
    integer :: k

    do k = 1, size(t) - 2
      if (temperature < t(k + 1)) return
    end do
    k = size(t) - 1
  end function interval

  !> The share QUINNEY of the plastic work (G.I. Taylor, H. Quinney 1934) that has not become heat yet.
  pure subroutine release(material, dt, drivers, committed, released, of_work, slope, history, surplus, changes)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :), committed(:)
    real(wp), intent(out) :: released, of_work, slope, history(:)
    real(wp), intent(out), optional :: surplus, changes(:)

    released = 0
    of_work = 0
    slope = 0
    if (present(surplus)) surplus = 0
    if (present(changes)) changes = 0
    if (size(history) == 0) return
    history(1) = drivers(driver_work, 2)
    of_work = share_of_work(material, place_share, drivers(driver_temperature, 1))*(drivers(driver_work, 2) - committed(1))
  end subroutine release

end module law_heat
