!> One step of the phases of a point between two temperatures, the temperature linear in time.
!>
!> The way is divided at the nodes of the steel (`steels`: temperatures at fixed distances, and where curves begin, end or bend), so
!> that the end temperature may move while a step is iterated without any jump of the result, and its derivative is exact (dual
!> numbers). In a sub-step the temperature of kinetics is that in its middle: order 2 in the width of the sub-steps. Fractions stay
!> in [0, 1]; austenite is what is left.
!> Where stress acts on the kinetics (stress_kinetics), it is linear in time between both ends of the step.
module phase_step
  use ascending, only: count_up_to
  use austenite_decomposition, only: cool_by_histories, transform
  use dual_numbers, only: dual_t, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use martensite_kinetics, only: martensite_start
  use phase_growth, only: forms, grow, match_growth
  use phase_state, only: at_coldest, at_rate, cold_as_mixture, first_growth, first_incubation, never_cold, set_hardness, state_size
  use phase_tempering, only: temper_phases
  use reheating, only: heat_up
  use steels, only: austenite, bainite, ferrite, first_diffusive, last_diffusive, martensite, phase_count, steel_t, tempered, &
                    unknown_temperature
  use stress_kinetics, only: hastened, shift_of_phase
  implicit none
  private
  public :: advance_phases

  !> Where several phases form at once, a sub-step is divided so that none grows by more than this extended fraction, as it would
  !> at the start; into so many parts at most.
  !> Less austenite than that makes nothing new.
  real(wp), parameter :: least_austenite = 1.0e-3_wp
  real(wp), parameter :: most_growth = 0.1_wp
  integer, parameter :: most_parts = 64
  !> Where the cooling rate of hardness is taken [degC]: 700, but for a hair. Steps end at 700 itself, and there a step may end on
  !> one side of it and the next one begin on the other, by round-off.
  real(wp), parameter :: rate_temperature = 699.99_wp

contains

  !> From the committed state to the state at the end of a step, its derivative by the temperature there, and the heat released.
  !> Stresses count for a steel whose kinetics depend on them; without them there is none.
  pure subroutine advance_phases(steel, dt, before, now, committed, state, slope, heat, heat_slope, stresses)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: dt              !! length of the step [s]
    real(wp), intent(in) :: before, now     !! temperatures at both ends of it [degC]
    real(wp), intent(in) :: committed(:)    !! (state_size) [state_units]
    real(wp), intent(out) :: state(:)       !! (state_size) [state_units]
    real(wp), intent(out) :: slope(:)       !! (state_size) d state/d now [state_units/K]
    real(wp), intent(out) :: heat           !! [MJ/m3]
    real(wp), intent(out) :: heat_slope     !! d heat/d now [MJ/m3/K]
    real(wp), intent(in), optional :: stresses(2, 2)   !! mean and von Mises' stress at both ends of the step [MPa]
    type(dual_t) :: s(state_size), released, a, b, time, finish, part, gone, stress(2, 2)
    real(wp) :: load(2, 2)
    integer :: k, last, direction, parts, p

    load = 0
    if (present(stresses) .and. steel%isig%given) load = stresses
    s%value = committed
    if (committed(at_coldest) > 0.5_wp*(never_cold + cold_as_mixture)) &
      s(at_coldest)%value = coldest_of_mixture(steel, committed, before)
    released = dual_t()
    finish = dual_t(now, 1.0_wp)
    parts = parts_of(steel, dt, before, load(:, 1), committed)
    direction = merge(1, -1, now >= before)
    call find_nodes(steel%nodes, before, now, k, last)
    a = dual_t(before)
    gone = dual_t()
    stress = dual_t()
    stress(:, 2)%value = load(:, 1)
    do
      b = finish
      time = dual_t(dt)
      if (direction*(last - k) >= 0) b = dual_t(steel%nodes(k))
      ! the temperature is linear in time; in one piece the whole step
      if (direction*(last - k) >= 0 .or. abs(a%value - before) > 0) time = dt*(b - a)/(finish - before)
      if (parts == 1 .and. .not. steel%isig%given) then
        call sub_step(steel, time, a, b, stress, s, released)
        if (direction*(last - k) < 0) exit
        a = b
        k = k + direction
        cycle
      end if
      part = (b - a)/real(parts, wp)
      do p = 1, parts
        if (steel%isig%given .and. dt > 0) then
          gone = gone + time/real(parts, wp)
          stress(:, 1) = stress(:, 2)
          stress(:, 2) = load(:, 1) + (load(:, 2) - load(:, 1))*(gone/dt)
        end if
        call sub_step(steel, time/real(parts, wp), a + real(p - 1, wp)*part, a + real(p, wp)*part, stress, s, released)
      end do
      if (direction*(last - k) < 0) exit
      a = b
      k = k + direction
    end do
    call pass_rate(dt, before, now, committed, s(at_rate))
    state = s%value
    slope = s%slope
    heat = released%value
    heat_slope = released%slope
    call set_hardness(steel, state)
  end subroutine advance_phases

  !> A mixture that is given with its martensite has been as cold as leaves its austenite, and as it begins: no more forms above
  !> that.
  pure function coldest_of_mixture(steel, committed, before) result(coldest)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: committed(:)   !! (state_size) [state_units]
    real(wp), intent(in) :: before         !! temperature [degC]
    real(wp) :: coldest                    !! [degC]
    type(dual_t) :: ms

    ms = martensite_start(steel, dual_t(sum(committed(ferrite:bainite))))
    coldest = committed(austenite)
    coldest = min(before, ms%value + log(coldest/(coldest + committed(martensite) + committed(tempered)))/steel%beta)
  end function coldest_of_mixture

  !> First and last node strictly between two temperatures, in the direction of the step; none: `last` is before `first`.
  pure subroutine find_nodes(nodes, before, now, first, last)
    real(wp), intent(in) :: nodes(:), before, now
    integer, intent(out) :: first, last
    integer :: low, high

    low = 1 + count_up_to(nodes, min(before, now))
    ! a sub-step costs much more than the look for its end
    high = low - 1
    do while (high < size(nodes))
      if (.not. nodes(high + 1) < max(before, now)) exit
      high = high + 1
    end do
    first = low
    last = high
    if (now >= before) return
    first = high
    last = low
  end subroutine find_nodes

  !> Parts into which sub-steps are divided: a function of the state at the start and of the length of the step alone, so that it
  !> stands still while the end temperature is iterated.
  pure function parts_of(steel, dt, before, load, committed) result(parts)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: dt, before, load(2), committed(:)
    integer :: parts
    type(dual_t) :: incubation, growth, w, volume, stress(2), temperature
    real(wp) :: most
    integer :: i, active

    active = 0
    most = 0
    stress = dual_t()
    stress%value = load
    do i = first_diffusive, last_diffusive
      temperature = before - shift_of_phase(steel%isig, i, stress)
      if (.not. forms(steel, i, temperature%value)) cycle
      incubation = dual_t(committed(first_incubation + i - first_diffusive))
      growth = dual_t(committed(first_growth + i - first_diffusive))
      call match_growth(steel, i, temperature, dual_t(committed(i)), growth)
      call grow(steel, i, hastened(steel%isig, i, stress, dual_t(dt)), temperature, incubation, growth, w, volume)
      active = active + 1
      most = most + w%value + volume%value
    end do
    parts = 1
    if (active > 1) parts = max(1, min(most_parts, ceiling(min(most/most_growth, real(most_parts, wp)))))
  end function parts_of

  !> All that happens between two temperatures of one sub-step.
  pure subroutine sub_step(steel, time, from, to, stress, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, from, to, stress(2, 2)
    type(dual_t), intent(inout) :: s(:), heat
    type(dual_t) :: middle, before(2)

    middle = 0.5_wp*(from + to)
    before = s([martensite, bainite])
    if (steel%ac1 > unknown_temperature) then
      if (middle%value > steel%ac1) call heat_up(steel, time, middle, s, heat)
    end if
    if (steel%cct%n > 0 .and. s(austenite)%value > 0) call cool_by_histories(steel, time, from, to, stress(:, 2), s, heat)
    call transform(steel, time, from, to, stress, s, heat)
    if (any(steel%temper_rate > 0)) call temper_phases(steel, time, middle, before, s, heat)
    call settle(s)
  end subroutine sub_step

  !> Round-off: no fraction below 0, and austenite is what the others leave.
  pure subroutine settle(s)
    type(dual_t), intent(inout) :: s(:)
    type(dual_t) :: others
    integer :: i

    ! written out: it ends every sub-step of every point
    others = dual_t()
    do i = 2, phase_count
      if (s(i)%value < 0) s(i) = dual_t()
      others%value = others%value + s(i)%value
      others%slope = others%slope + s(i)%slope
    end do
    if (others%value > 1) then
      do i = 2, phase_count
        s(i) = s(i)/others
      end do
      others = dual_t(1.0_wp)
    end if
    s(austenite) = dual_t(1 - others%value, -others%slope)
  end subroutine settle

  !> Cooling through 700 degC at the rate of the step: that of the phases that form from the austenite there, or, where none is
  !> left, that have formed from it above (the point has not been colder since it was heated to Ac1). What was there already has
  !> formed at another one: of Maynier's hardness, linear in the logarithm of the rate, the mean by amounts counts. Of a mixture
  !> that the deck gives no rate is known: it counts as formed at the same one, if any forms.
  pure subroutine pass_rate(dt, before, now, committed, rate)
    real(wp), intent(in) :: dt, before, now     !! [s], temperatures of the step [degC]
    real(wp), intent(in) :: committed(:)        !! (state_size) at its start [state_units]
    type(dual_t), intent(inout) :: rate         !! [K/s]
    real(wp) :: new, old, fraction

    if (.not. (before >= rate_temperature .and. now < rate_temperature .and. dt > 0)) return
    fraction = committed(austenite)
    old = rate%value
    if (.not. fraction > least_austenite .and. (old > 0 .or. committed(at_coldest) < rate_temperature)) return
    new = (before - now)/dt
    rate = dual_t(new, -1/dt)
    if (.not. old > 0) return
    rate%value = exp((1 - fraction)*log(old) + fraction*log(new))
    rate%slope = -fraction*rate%value/(new*dt)
  end subroutine pass_rate

end module phase_step
