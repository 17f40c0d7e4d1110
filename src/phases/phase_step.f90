!> One step of the phases of a point between two temperatures, the temperature linear in time.
!>
!> The way is divided at the nodes of the steel (`steels`: temperatures at fixed distances, and where curves begin, end or bend), so
!> that the end temperature may move while a step is iterated without any jump of the result, and its derivative is exact (dual
!> numbers). In a sub-step the temperature of kinetics is that in its middle: order 2 in the width of the sub-steps. Each phase
!> answers the logarithm w_i by which it alone would divide the austenite; together they divide it by exp(sum w_i) and share what
!> forms in proportion: exact for one phase, order 2 for several. What forms as a fraction of the whole volume is taken from the
!> austenite half before, half after that. Fractions stay in [0, 1]; austenite is what is left.
!> Where stress acts on the kinetics (stress_kinetics), it is linear in time between both ends of the step.
module phase_step
  use austenite_kinetics, only: form_austenite, grow_grains
  use avrami, only: grow_avrami
  use cct_histories, only: cct_increments
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use latent_heat, only: heat_of_tempering, latent_of
  use li_kinetics, only: grow_li
  use martensite_kinetics, only: grow_martensite, martensite_start, total_martensite
  use phase_state, only: at_coldest, at_grain, at_hollomon_jaffe, at_rate, at_tempering, first_growth, first_incubation, &
                         cold_as_mixture, never_cold, set_hardness, state_size
  use steels, only: austenite, bainite, ferrite, first_diffusive, kinetics_avrami, kinetics_li, kinetics_none, last_diffusive, &
                    martensite, pearlite, phase_count, steel_t, tempered, unknown_temperature
  use stress_kinetics, only: hastened, shift_of_phase, stressed_span
  use temperature_curves, only: dual_curve_at, is_given
  use tempering, only: add_hollomon_jaffe, join_hollomon_jaffe, make_younger, temper
  implicit none
  private
  public :: advance_phases

  !> Where several phases form at once, a sub-step is divided so that none grows by more than this extended fraction, as it would
  !> at the start; into so many parts at most.
  real(wp), parameter :: most_growth = 0.1_wp
  integer, parameter :: most_parts = 64
  !> Where the cooling rate of hardness is taken [degC].
  real(wp), parameter :: rate_temperature = 700.0_wp
  !> A phase of which austenite has left no more than this has nothing to remember of its tempering.
  real(wp), parameter :: nothing_left = 1.0e-6_wp

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
    call pass_rate(dt, before, now, s(at_rate))
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

    low = 1 + count(nodes <= min(before, now))
    high = count(nodes < max(before, now))
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
      call grow(steel, i, hastened(steel%isig, i, stress, dual_t(dt)), temperature, incubation, growth, w, volume)
      active = active + 1
      most = most + w%value + volume%value
    end do
    parts = 1
    if (active > 1) parts = max(1, min(most_parts, ceiling(min(most/most_growth, real(most_parts, wp)))))
  end function parts_of

  !> A phase may form by diffusion at a temperature.
  pure function forms(steel, phase, temperature) result(yes)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: temperature
    logical :: yes

    associate (kinetics => steel%kinetics(phase))
      yes = kinetics%kind /= kinetics_none .and. temperature > kinetics%low .and. temperature < kinetics%high
    end associate
  end function forms

  !> The logarithm by which one phase alone divides what can form in a time at one temperature, and the fraction of the whole volume
  !> that forms beside.
  pure subroutine grow(steel, phase, time, temperature, incubation, growth, w, volume)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: time, temperature
    type(dual_t), intent(inout) :: incubation, growth
    type(dual_t), intent(out) :: w, volume

    volume = dual_t()
    select case (steel%kinetics(phase)%kind)
    case (kinetics_avrami)
      call grow_avrami(steel%kinetics(phase), time, temperature, incubation, growth, w, volume)
    case (kinetics_li)
      call grow_li(steel%kinetics(phase), steel%li_sum, steel%li_slope, time, temperature, growth, w)
    end select
    if (w%value < 0) w = dual_t()   ! round-off
  end subroutine grow

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

  !> Fraction that is tempered, or can be.
  pure function to_temper(s) result(fraction)
    type(dual_t), intent(in) :: s(:)
    real(wp) :: fraction

    fraction = s(martensite)%value + s(bainite)%value + s(tempered)%value
  end function to_temper

  !> Austenite from all other phases, in proportion, and its grains. Of what is left, tempering goes on.
  pure subroutine heat_up(steel, time, temperature, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, temperature
    type(dual_t), intent(inout) :: s(:), heat
    type(dual_t) :: formed, left, lost
    integer :: i

    call form_austenite(steel, time, temperature, s(austenite), formed)
    call grow_grains(steel, time, temperature, s(austenite), formed, s(at_grain))
    if (formed%value > 0) then
      left = dual_t()
      do i = 2, phase_count
        left = left + s(i)
      end do
      do i = 2, phase_count
        if (.not. s(i)%value > 0) cycle
        lost = formed*s(i)/left
        s(i) = s(i) - lost
        call release(steel, i, temperature, -lost, heat)
      end do
      s(austenite) = s(austenite) + formed
    end if
    do i = first_diffusive, last_diffusive
      call forget_growth(steel, i, temperature%value, s)
    end do
    s(at_coldest) = dual_t(never_cold)
    if (.not. s(martensite)%value > nothing_left) s(at_tempering) = dual_t()
    if (.not. s(bainite)%value > nothing_left) s(at_tempering + 1) = dual_t()
    if (.not. to_temper(s) > nothing_left) s(at_hollomon_jaffe) = dual_t()
  end subroutine heat_up

  !> Above the temperatures at which a phase forms its nuclei dissolve.
  pure subroutine forget_growth(steel, phase, temperature, s)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(inout) :: s(:)

    if (temperature < steel%kinetics(phase)%high) return
    s(first_incubation + phase - first_diffusive) = dual_t()
    s(first_growth + phase - first_diffusive) = dual_t()
  end subroutine forget_growth

  !> What the histories of a CCT diagram give down to Ms, as far as there is austenite.
  pure subroutine cool_by_histories(steel, time, from, to, stress, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, from, to, stress(2)
    type(dual_t), intent(inout) :: s(:), heat
    type(dual_t) :: dz(3), total, ms, finish, share
    integer :: i

    ms = martensite_start(steel, s(ferrite) + s(pearlite) + s(bainite)) + shift_of_phase(steel%isig, martensite, stress)
    if (from%value <= ms%value) return
    finish = to
    share = dual_t(1.0_wp)
    if (to%value < ms%value) then
      finish = ms
      share = (from - ms)/(from - to)
    end if
    call cct_increments(steel%cct, share*time, from, finish, s(at_grain), s(ferrite:bainite), dz)
    total = dual_t()
    do i = 1, 3
      if (dz(i)%value < 0) dz(i) = dual_t()
      total = total + dz(i)
    end do
    if (.not. total%value > 0) return
    do i = 1, 3
      if (total%value > s(austenite)%value) dz(i) = dz(i)*s(austenite)/total
      call release(steel, ferrite + i - 1, 0.5_wp*(from + to), dz(i), heat)
      s(ferrite + i - 1) = s(ferrite + i - 1) + dz(i)
    end do
    if (total%value > s(austenite)%value) total = s(austenite)
    s(austenite) = s(austenite) - total
  end subroutine cool_by_histories

  !> Ferrite, pearlite, bainite and martensite from austenite.
  pure subroutine transform(steel, time, from, to, stress, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, from, to, stress(2, 2)
    type(dual_t), intent(inout) :: s(:), heat
    type(dual_t), dimension(ferrite:martensite) :: w, volume, dz
    type(dual_t) :: total, total_volume, room, formed, middle, own, span, ms(2), coldest(2), by_diffusion, cold(2)
    integer :: i

    middle = 0.5_wp*(from + to)
    w = dual_t()
    volume = dual_t()
    do i = ferrite, bainite
      own = middle
      span = time
      call stressed_span(steel, i, from, to, stress, own, span)
      if (forms(steel, i, own%value)) then
        call grow(steel, i, span, own, s(first_incubation + i - ferrite), s(first_growth + i - ferrite), w(i), volume(i))
        call limit_growth(steel, i, own, s, w(i), volume(i))
      else if (.not. s(i)%value > 0) then
        ! those beside what has formed stay: it can go on
        call forget_growth(steel, i, own%value, s)
      end if
    end do
    by_diffusion = s(ferrite) + s(pearlite) + s(bainite)
    ms(1) = martensite_start(steel, by_diffusion)
    coldest(1) = s(at_coldest)
    ! a point that begins cold is at its coldest before it is heated
    cold = [from - shift_of_phase(steel%isig, martensite, stress(:, 1)), to - shift_of_phase(steel%isig, martensite, stress(:, 2))]
    if (cold(1)%value < cold(2)%value) cold(2) = cold(1)
    call grow_martensite(steel, by_diffusion, cold(2), s(at_coldest), w(martensite))
    coldest(2) = s(at_coldest)
    total = sum_of(w)
    total_volume = sum_of(volume)
    if (.not. (total%value + total_volume%value > 0 .and. s(austenite)%value > 0)) return
    if (total_volume%value > 0) then
      ! (z - v/2) exp(-w) - v/2 is not below 0
      room = 2.0_wp*s(austenite)*exp(-total)/(1.0_wp + exp(-total))
      if (total_volume%value > room%value) then
        do i = ferrite, bainite
          volume(i) = volume(i)*(room/total_volume)
        end do
        total_volume = room
      end if
    end if
    formed = (s(austenite) - 0.5_wp*total_volume)*(1.0_wp - exp(-total))
    dz = volume
    do i = ferrite, martensite
      if (w(i)%value > 0) dz(i) = dz(i) + formed*w(i)/total
    end do
    if (steel%martensite_total) then
      ms(2) = martensite_start(steel, by_diffusion + sum_of(dz(:bainite)))
      dz(martensite) = total_martensite(steel, ms, coldest, s(austenite), sum_of(dz(:bainite)))
    end if
    do i = ferrite, martensite
      if (.not. dz(i)%value > 0) cycle
      call release(steel, i, middle, dz(i), heat)
      s(i) = s(i) + dz(i)
    end do
    s(austenite) = s(austenite) - sum_of(dz)
  end subroutine transform

  pure function sum_of(parts) result(total)
    type(dual_t), intent(in) :: parts(:)   !! (any number)
    type(dual_t) :: total

    total = dual_t(sum(parts%value), sum(parts%slope))
  end function sum_of

  !> Of a phase that has a largest fraction, only the rest up to there can form.
  pure subroutine limit_growth(steel, phase, temperature, s, w, volume)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature, s(:)
    type(dual_t), intent(inout) :: w, volume
    type(dual_t) :: room

    if (.not. (is_given(steel%kinetics(phase)%limit) .and. s(austenite)%value > 0)) return
    room = dual_curve_at(steel%kinetics(phase)%limit, temperature) - s(phase)
    if (volume%value > 0) then
      if (room%value < volume%value) volume = room
      if (room%value <= 0) volume = dual_t()
      room = room - volume
    end if
    if (room%value >= s(austenite)%value) return
    if (room%value <= 0) then
      w = dual_t()
    else
      w = -log(1.0_wp - room/s(austenite)*(1.0_wp - exp(-w)))
    end if
  end subroutine limit_growth

  !> Martensite and bainite become tempered; the time counts for P where there is something to temper. What has formed in the
  !> sub-step, and what austenite has taken, is tempered for half of it in the mean: half of what is new joins before, half after.
  pure subroutine temper_phases(steel, time, temperature, before, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, temperature
    type(dual_t), intent(in) :: before(2)   ! martensite and bainite at the start of the sub-step
    type(dual_t), intent(inout) :: s(:), heat
    integer, parameter :: phases(2) = [martensite, bainite]
    type(dual_t) :: w, gone, half, mean
    integer :: k

    if (to_temper(s) > nothing_left) call add_hollomon_jaffe(steel, time, temperature, s(at_hollomon_jaffe))
    do k = 1, 2
      if (.not. s(phases(k))%value > 0) cycle
      mean = 0.5_wp*(before(k) + s(phases(k)))
      half = mean - before(k)
      call make_younger(steel, k, before(k), half, s(at_tempering + k - 1))
      call temper(steel, k, time, temperature, s(at_tempering + k - 1), w)
      gone = mean*(1.0_wp - exp(-w))
      if (gone%value > s(phases(k))%value) gone = s(phases(k))
      call join_hollomon_jaffe(steel, k, temperature, s(at_tempering + k - 1), s(tempered), gone, s(at_hollomon_jaffe))
      call make_younger(steel, k, mean - gone, half, s(at_tempering + k - 1))
      s(phases(k)) = s(phases(k)) - gone
      s(tempered) = s(tempered) + gone
      heat = heat + heat_of_tempering(steel, phases(k), temperature)*gone
    end do
  end subroutine temper_phases

  !> Latent heat of a phase that forms from austenite.
  pure subroutine release(steel, phase, temperature, formed, heat)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature, formed
    type(dual_t), intent(inout) :: heat

    heat = heat + latent_of(steel, phase, temperature)*formed
  end subroutine release

  !> Round-off: no fraction below 0, and austenite is what the others leave.
  pure subroutine settle(s)
    type(dual_t), intent(inout) :: s(:)
    type(dual_t) :: others
    integer :: i

    others = dual_t()
    do i = 2, phase_count
      if (s(i)%value < 0) s(i) = dual_t()
      others = others + s(i)
    end do
    if (others%value > 1) then
      do i = 2, phase_count
        s(i) = s(i)/others
      end do
      others = dual_t(1.0_wp)
    end if
    s(austenite) = 1.0_wp - others
  end subroutine settle

  !> Cooling rate on the way through 700 degC.
  pure subroutine pass_rate(dt, before, now, rate)
    real(wp), intent(in) :: dt, before, now
    type(dual_t), intent(inout) :: rate

    if (.not. (before >= rate_temperature .and. now < rate_temperature .and. dt > 0)) return
    rate = dual_t((before - now)/dt, -1/dt)
  end subroutine pass_rate

end module phase_step
