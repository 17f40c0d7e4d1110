!> What a heat treater reads of a steel: times at one temperature, mixtures after cooling at a constant rate, and martensite after a
!> hold.
module steel_tables
  use avrami, only: avrami_time
  use dual_numbers, only: dual_t
  use kinds, only: wp
  use li_kinetics, only: li_rate, li_sum
  use phase_state, only: at_rate, set_hardness, start_phases
  use phase_step, only: advance_phases
  use steels, only: austenite, kinetics_avrami, kinetics_li, martensite, phase_count, steel_t, unknown_temperature
  implicit none
  private
  public :: isothermal_time, isothermal_rows, cool_at_rate, hold_martensite

  !> Length of a step of temperature while cooling [K]; sub-steps are within.
  real(wp), parameter :: step_length = 2.0_wp
  !> Fraction by which transformation has begun.
  real(wp), parameter :: begun = 0.01_wp
  !> Cooling rate at 700 degC of martensite that has been quenched, for formulas of hardness that ask for it [K/s].
  real(wp), parameter, public :: quench_rate = 100.0_wp

contains

  !> The phase has kinetics of times at this temperature.
  pure function forms_at(steel, phase, temperature) result(yes)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: temperature   !! [degC]
    logical :: yes

    associate (kinetics => steel%kinetics(phase))
      yes = any(kinetics%kind == [kinetics_avrami, kinetics_li])
      yes = yes .and. temperature >= kinetics%low .and. temperature <= kinetics%high
      if (kinetics%kind == kinetics_li) yes = yes .and. temperature < kinetics%high
    end associate
  end function forms_at

  !> Time in which a share of what can form of a phase forms at one temperature; only where it forms (`forms_at`).
  pure function isothermal_time(steel, phase, temperature, share) result(time)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp), intent(in) :: share         !! above 0, below 1
    real(wp) :: time   !! [s]
    type(dual_t) :: rate

    if (steel%kinetics(phase)%kind == kinetics_li) then
      rate = li_rate(steel%kinetics(phase), dual_t(temperature))
      time = li_sum(steel%li_sum, steel%li_slope, share)/rate%value
    else
      time = avrami_time(steel%kinetics(phase), temperature, share)
    end if
  end function isothermal_time

  !> The isothermal diagram of a phase, row by row from its highest temperature down.
  pure subroutine isothermal_rows(steel, phase, width, shares, temperatures, times)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: width       !! distance of rows [K]
    real(wp), intent(in) :: shares(:)   !! (nshare) of what can form, above 0, below 1
    real(wp), allocatable, intent(out) :: temperatures(:), times(:, :)   !! (nrow) [degC], (nshare, nrow) [s]
    real(wp) :: t
    integer :: k, i, n, row
    logical, allocatable :: forms(:)

    associate (kinetics => steel%kinetics(phase))
      n = max(-1, floor((kinetics%high - kinetics%low)/width))
      allocate (forms(0:n))
      do k = 0, n
        forms(k) = forms_at(steel, phase, kinetics%high - k*width)
      end do
      allocate (temperatures(count(forms)), times(size(shares), count(forms)))
      row = 0
      do k = 0, n
        if (.not. forms(k)) cycle
        t = kinetics%high - k*width
        row = row + 1
        temperatures(row) = t
        do i = 1, size(shares)
          times(i, row) = isothermal_time(steel, phase, t, shares(i))
        end do
      end do
    end associate
  end subroutine isothermal_rows

  !> State after cooling from austenite at a constant rate, and the temperature at which one per cent had transformed (`to` where
  !> it had not), also of each phase by itself and of what had transformed by 99 per cent.
  pure subroutine cool_at_rate(steel, rate, from, to, state, begin, begin_of, finish)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: rate        !! [K/s]
    real(wp), intent(in) :: from, to    !! temperatures [degC]
    real(wp), intent(out) :: state(:)   !! (state_size) [state_units]
    real(wp), intent(out) :: begin      !! [degC]
    real(wp), intent(out), optional :: begin_of(:)   !! (phase_count) [degC], unknown_temperature where there is less
    real(wp), intent(out), optional :: finish        !! [degC], unknown_temperature where less transforms
    real(wp) :: committed(size(state)), slope(size(state)), a, b, heat, heat_slope
    integer :: k, n, i

    call start_phases(steel, state)
    begin = to
    if (present(begin_of)) begin_of = unknown_temperature
    if (present(finish)) finish = unknown_temperature
    n = max(1, ceiling((from - to)/step_length))
    do k = 1, n
      a = from + (to - from)*(k - 1)/n
      b = from + (to - from)*k/n
      committed = state
      call advance_phases(steel, (a - b)/rate, a, b, committed, state, slope, heat, heat_slope)
      call note(1 - committed(austenite), 1 - state(austenite), begun, begin)
      if (present(finish)) call note(1 - committed(austenite), 1 - state(austenite), 1 - begun, finish)
      if (.not. present(begin_of)) cycle
      do i = austenite + 1, phase_count
        call note(committed(i), state(i), begun, begin_of(i))
      end do
    end do

  contains

    !> The temperature at which a share passes a level between a and b.
    pure subroutine note(before, now, level, temperature)
      real(wp), intent(in) :: before, now, level
      real(wp), intent(inout) :: temperature

      if (before < level .and. now >= level) temperature = a + (b - a)*(level - before)/(now - before)
    end subroutine note

  end subroutine cool_at_rate

  !> State of martensite after a time at one temperature; in no time, as quenched.
  pure subroutine hold_martensite(steel, time, temperature, state)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: time          !! [s]
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp), intent(out) :: state(:)     !! (state_size) [state_units]
    real(wp) :: fractions(phase_count), committed(size(state)), slope(size(state)), heat, heat_slope

    fractions = 0
    fractions(martensite) = 1
    call start_phases(steel, state, fractions)
    state(at_rate) = quench_rate
    call set_hardness(steel, state)
    if (.not. time > 0) return
    committed = state
    call advance_phases(steel, time, temperature, temperature, committed, state, slope, heat, heat_slope)
  end subroutine hold_martensite

end module steel_tables
