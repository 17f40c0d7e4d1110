!> Heat content of an element of PL8TM: what it takes up in a step, what its points release, what is left to it; and errors of it.
module heat_content
  use elem_api, only: instant_t, report_t
  use heat_points, only: functions_t, heat_points_t
  use kinds, only: wp
  use law_api, only: driver_temperature, law_t
  use materials, only: material_t
  implicit none
  private
  public :: add_content, add_due, add_error, add_released

contains

  !> Heat taken up in the step, per time: at the points, or lumped at the corners.
  pure subroutine add_content(instant, law, material, npoint, own, lumped, place, drivers, change, start, force, stiffness, stored)
    type(instant_t), intent(in) :: instant
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    logical, intent(in) :: lumped
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)              !! (ndriver, 2, npoint) [unit of each driver]
    real(wp), intent(in) :: change(:), start(:)           !! (n) of temperatures in the step, and they at its start [temperature]
    real(wp), intent(inout) :: force(:)                   !! (ndof) [power]
    real(wp), intent(inout) :: stiffness(:, :)            !! (ndof, ndof) [power/unknown]
    real(wp), intent(inout) :: stored                     !! heat taken up [energy]
    real(wp) :: before(max(1, size(drivers, 1)), 9), now(max(1, size(drivers, 1)), 9), taken(9), capacity(9), volume
    integer :: p, j, n, m

    n = own%n
    m = merge(n, npoint, lumped)
    call drive(own, npoint, lumped, drivers(:, 1, :), start, before)
    call drive(own, npoint, lumped, drivers(:, 2, :), start + change, now)
    call law%store(material, before(:, :m), now(:, :m), taken(:m), capacity(:m))
    taken(:m) = taken(:m)/instant%dt
    capacity(:m) = capacity(:m)/instant%dt
    if (lumped) then
      do j = 1, n
        volume = dot_product(own%phi(j, :npoint), place%dv0(:npoint))
        force(j) = force(j) + volume*taken(j)
        stored = stored + volume*taken(j)*instant%dt
        if (instant%tangent) stiffness(j, j) = stiffness(j, j) + volume*capacity(j)
      end do
    else
      do p = 1, npoint
        force(:n) = force(:n) + own%phi(:n, p)*(taken(p)*place%dv0(p))
        stored = stored + taken(p)*place%dv0(p)*instant%dt
        if (.not. instant%tangent) cycle
        do j = 1, n
          stiffness(:n, j) = stiffness(:n, j) + own%phi(:n, p)*(capacity(p)*place%dv0(p)*own%phi(j, p))
        end do
      end do
    end if
  end subroutine add_content

  !> What drives the law: at the corners the temperature alone, where the content is lumped there; else all at the points.
  pure subroutine drive(own, npoint, lumped, drivers, temperatures, given)
    type(functions_t), intent(in) :: own
    integer, intent(in) :: npoint
    logical, intent(in) :: lumped
    real(wp), intent(in) :: drivers(:, :)      !! (ndriver, npoint)
    real(wp), intent(in) :: temperatures(:)    !! (n)
    real(wp), intent(out) :: given(:, :)       !! (ndriver, 9)

    given = 0
    if (lumped) then
      given(driver_temperature, :own%n) = temperatures
    else
      if (size(drivers, 1) > 1) given(2:, :npoint) = drivers(2:, :)
      given(driver_temperature, :npoint) = matmul(temperatures, own%phi(:own%n, :npoint))
    end if
  end subroutine drive

  !> Square of an error of the heat content over the least heat capacity of the material, so that latent heat counts as heat; and of
  !> the temperatures themselves.
  pure subroutine add_error(law, material, npoint, own, lumped, place, drivers, change, now, report)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    logical, intent(in) :: lumped
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)        !! (ndriver, 2, npoint) [unit of each driver]
    real(wp), intent(in) :: change(:), now(:)       !! (n) the error in temperatures, and present ones [temperature]
    type(report_t), intent(inout) :: report
    real(wp) :: given(max(1, size(drivers, 1)), 9), taken(9), capacity(9), error(9), volume(9), least
    integer :: n, m

    n = own%n
    m = merge(n, npoint, lumped)
    call drive(own, npoint, lumped, drivers(:, 2, :), now, given)
    if (lumped) then
      error(:n) = change
      volume(:n) = matmul(own%phi(:n, :npoint), place%dv0(:npoint))
    else
      error(:npoint) = matmul(change, own%phi(:n, :npoint))
      volume(:npoint) = place%dv0(:npoint)
    end if
    call law%store(material, given(:, :m), given(:, :m), taken(:m), capacity(:m))
    report%temperature_square = report%temperature_square + sum(volume(:m)*error(:m)**2)
    least = least_capacity(law, material, given(:, 1))
    ! a smooth capacity holds no latent heat
    if (least > 0) error(:m) = error(:m)*capacity(:m)/least
    report%error_square = report%error_square + sum(volume(:m)*error(:m)**2)
    report%error_volume = report%error_volume + sum(volume(:m))
  end subroutine add_error

  !> The least heat capacity at the temperatures where it bends, or from one of them to the next; 0 where it bends nowhere.
  pure function least_capacity(law, material, drivers) result(least)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:)   !! (ndriver) that go with the temperature
    real(wp) :: least                    !! [energy/length^3/temperature]
    real(wp) :: given(size(drivers), 1), taken(1), capacity(1)
    real(wp), allocatable :: temperatures(:)
    integer :: k

    least = 0
    if (associated(law%bends)) then
      call law%bends(material, temperatures)
    else if (allocated(material%temperatures)) then
      allocate (temperatures, source=material%temperatures)
    else
      return
    end if
    given(:, 1) = drivers
    do k = 1, size(temperatures)
      given(driver_temperature, 1) = temperatures(k)
      call law%store(material, given, given, taken, capacity)
      if (capacity(1) > 0 .and. .not. (least > 0 .and. least < capacity(1))) least = capacity(1)
    end do
  end function least_capacity

  !> Heat that a change of volume takes up, less that released at the points, per time.
  pure subroutine add_released(instant, law, material, npoint, own, place, drivers, change, start, u, committed, trial, force, &
                               stiffness, by_end, report)
    type(instant_t), intent(in) :: instant
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)              !! (ndriver, 2, npoint) [unit of each driver]
    real(wp), intent(in) :: change(:), start(:)           !! (n) of temperatures in the step, and they at its start [temperature]
    integer, intent(in) :: u                              !! local place of the first displacement, 0 where there is none
    real(wp), intent(in) :: committed(:, :)               !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: trial(:, :)                !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: force(:)                   !! (ndof) [power]
    real(wp), intent(inout) :: stiffness(:, :)            !! (ndof, ndof) [power/unknown]
    real(wp), intent(out) :: by_end(:, :)                 !! (nstate, npoint) d(state)/d(temperature at the end) [unit/temperature]
    type(report_t), intent(inout) :: report
    real(wp) :: given(max(1, size(drivers, 1)), 2), released, of_work, slope, surplus, per_strain, share, heat(own%n), counted
    integer :: p, j, n

    n = own%n
    heat = 0
    counted = 0
    by_end = 0
    do p = 1, npoint
      share = place%dv0(p)/instant%dt
      per_strain = law%swell(material, dot_product(own%phi(:n, p), start))
      heat = heat + own%phi(:n, p)*(per_strain*share*place%strain(p))
      if (instant%tangent .and. u > 0) then
        do j = 1, 16
          stiffness(:n, u + j - 1) = stiffness(:n, u + j - 1) + own%phi(:n, p)*(per_strain*share*place%swelling(j, p))
        end do
      end if
      if (.not. associated(law%release) .or. size(committed, 1) == 0) cycle
      given = 0
      if (size(drivers, 1) > 0) given = drivers(:, :, p)
      given(driver_temperature, :) = [dot_product(own%phi(:n, p), start), dot_product(own%phi(:n, p), start + change)]
      ! what happens at a point takes the time since the start of the step
      call law%release(material, instant%dt/instant%share, given, committed(:, p), released, of_work, slope, trial(:, p), &
                       surplus, by_end(:, p))
      heat = heat - own%phi(:n, p)*(released*share + of_work*(place%worked(p)/instant%dt))
      counted = counted + surplus*place%dv0(p)
      if (.not. instant%tangent .or. .not. abs(slope) > 0) cycle
      do j = 1, n
        stiffness(:n, j) = stiffness(:n, j) - own%phi(:n, p)*(slope*share*own%phi(j, p))
      end do
    end do
    force(:n) = force(:n) + heat
    report%source = report%source + sum(heat**2)
    report%heat_stored = report%heat_stored - counted
    report%heat_released = report%heat_released - sum(heat)*instant%dt - counted
  end subroutine add_released

  !> Heat that the operation before has left, in this step.
  pure subroutine add_due(instant, npoint, own, place, due, force, report)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: due(:)              !! (npoint) per volume at the start of the scene [energy/length^3]
    real(wp), intent(inout) :: force(:)         !! (ndof) [power]
    type(report_t), intent(inout) :: report
    real(wp) :: heat(own%n)

    if (.not. any(abs(due) > 0)) return
    heat = matmul(own%phi(:own%n, :npoint), due*place%dv0(:npoint))
    force(:own%n) = force(:own%n) - heat/instant%dt
    report%source = report%source + sum((heat/instant%dt)**2)
    report%heat_released = report%heat_released + sum(heat)
  end subroutine add_due

end module heat_content
