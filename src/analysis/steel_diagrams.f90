!> What diagrams of a steel are drawn from, as JSON: its temperatures, the isothermal diagram, and where phases begin while it cools
!> at constant rates. In the summary of a run, and in `NAME.steel.json` of `lagamine --met`; drawn by lagareport.
module steel_diagrams
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use errors, only: error_t
  use hardness, only: has_hardness
  use json_writer, only: json_t
  use kinds, only: wp
  use phase_state, only: at_hardness, state_size
  use steel_tables, only: cool_at_rate, isothermal_rows
  use steels, only: austenite, first_diffusive, last_diffusive, phase_count, phase_names, steel_t, unknown_temperature
  implicit none
  private
  public :: add_diagrams, write_diagrams

  !> Width of the rows of the isothermal diagram [K], and shares that have formed (start, half, end).
  real(wp), parameter :: width = 5.0_wp, shares(3) = [0.01_wp, 0.5_wp, 0.99_wp]
  !> Cooling rates: so many, from slowest to fastest at equal ratios [K/s]; from and to these temperatures at least [degC].
  integer, parameter :: rate_count = 37
  real(wp), parameter :: slowest = 0.01_wp, fastest = 1000.0_wp, hot = 900.0_wp, cold = 20.0_wp

contains

  !> The diagrams of a steel as a file.
  subroutine write_diagrams(steel, path, error)
    type(steel_t), intent(in) :: steel
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(json_t) :: json

    call json%begin_object()
    call json%add('name', steel%name)
    call add_diagrams(json, steel)
    call json%end_object()
    call json%write_file(path, error)
  end subroutine write_diagrams

  !> Members of the object that is open.
  subroutine add_diagrams(json, steel)
    type(json_t), intent(inout) :: json
    type(steel_t), intent(in) :: steel
    real(wp), allocatable :: t(:), times(:, :)
    integer :: phase

    call json%begin_object('temperatures')
    call add_known('Ae1', steel%ae1)
    call add_known('Ae3', steel%ae3)
    call add_known('Ac1', steel%ac1)
    call add_known('Ac3', steel%ac3)
    call add_known('Bs', steel%bs)
    call add_known('Ms', steel%ms)
    call json%end_object()
    call json%begin_array('isothermal')
    do phase = first_diffusive, last_diffusive
      call isothermal_rows(steel, phase, width, shares, t, times)
      if (size(t) == 0) cycle
      call json%begin_object()
      call json%add('phase', trim(phase_names(phase)))
      call json%add('temperature', t)
      call json%add('start', times(1, :))
      call json%add('half', times(2, :))
      call json%add('end', times(3, :))
      call json%end_object()
    end do
    call json%end_array()
    if (size(steel%nodes) > 0) call add_coolings(json, steel)

  contains

    subroutine add_known(name, value)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: value

      if (value > unknown_temperature) call json%add(name, value)
    end subroutine add_known

  end subroutine add_diagrams

  !> Coolings at constant rates: temperatures at which 1 % of each phase has formed and 99 % of all, mixtures and hardness at the
  !> end.
  subroutine add_coolings(json, steel)
    type(json_t), intent(inout) :: json
    type(steel_t), intent(in) :: steel
    real(wp) :: rates(rate_count), start, begin, state(state_size, rate_count), begin_of(phase_count, rate_count), &
                finish(rate_count)
    integer :: k, i

    start = max(hot, steel%data_end)
    do k = 1, rate_count
      rates(k) = slowest*(fastest/slowest)**(real(k - 1, wp)/(rate_count - 1))
      call cool_at_rate(steel, rates(k), start, cold, state(:, k), begin, begin_of(:, k), finish(k))
    end do
    call json%begin_object('coolings')
    call json%add('from', start)
    call json%add('rate', rates)
    if (has_hardness(steel)) call json%add('hardness', state(at_hardness, :))
    call json%begin_array('phases')
    do i = 1, phase_count
      if (.not. any(state(i, :) > 0)) cycle
      call json%begin_object()
      call json%add('phase', trim(phase_names(i)))
      call json%add('share', state(i, :))
      if (i /= austenite) call json%add('start', known(begin_of(i, :)))
      call json%end_object()
    end do
    call json%end_array()
    call json%add('end', known(finish))
    call json%end_object()
  end subroutine add_coolings

  !> Temperatures, not a number (JSON: null) where there is none.
  pure elemental function known(temperature) result(value)
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp) :: value

    value = temperature
    if (.not. temperature > unknown_temperature) value = ieee_value(value, ieee_quiet_nan)
  end function known

end module steel_diagrams
