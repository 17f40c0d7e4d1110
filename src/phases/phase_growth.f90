!> What one phase alone would form of the austenite by diffusion: where it may, how much, up to its largest fraction.
module phase_growth
  use avrami, only: grow_avrami
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use li_kinetics, only: grow_li, li_progress
  use phase_state, only: first_growth, first_incubation
  use steels, only: austenite, first_diffusive, kinetics_avrami, kinetics_li, kinetics_none, steel_t
  use temperature_curves, only: dual_curve_at, is_given
  implicit none
  private
  public :: forms, match_growth, grow, limit_growth, forget_growth

  !> Below it (1 + exp(-w))/2 - (1 - exp(-w))/w is taken from its series.
  real(wp), parameter :: series_below = 1.0e-2_wp

contains

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

  !> Li's X of a phase that has a largest fraction is what there is over that fraction at this temperature, and his rate one of X
  !> (D.F. Watt, L. Coon, M. Bibby, J. Goldak, C. Henwood, Acta Metall. 36 (1988) 3029): where the largest fraction moves
  !> with the temperature, or some was there before, growth goes on from there.
  pure subroutine match_growth(steel, phase, temperature, fraction, growth)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(in) :: fraction      !! of the phase
    type(dual_t), intent(inout) :: growth     !! Li's S [-]
    type(dual_t) :: most

    associate (kinetics => steel%kinetics(phase))
      if (.not. (kinetics%kind == kinetics_li .and. is_given(kinetics%limit) .and. fraction%value > 0)) return
      most = dual_curve_at(kinetics%limit, temperature)
      if (most%value > 0) growth = li_progress(steel%li_sum, steel%li_slope, fraction/most)
    end associate
  end subroutine match_growth

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

  !> Of a phase that has a largest fraction, only the rest up to there can form. The largest fraction is linear in the sub-step, and
  !> w grows evenly in it: dz = (most - z) dw, exactly, so that what follows the largest fraction, as in annealing, is not late.
  pure subroutine limit_growth(steel, phase, temperature, half, s, w, volume)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature   !! in the middle of the sub-step [degC]
    type(dual_t), intent(in) :: half          !! from there to its end [K]
    type(dual_t), intent(in) :: s(:)          !! (state_size) [state_units]
    type(dual_t), intent(inout) :: w, volume
    type(dual_t) :: room, change, rest, formed

    associate (limit => steel%kinetics(phase)%limit)
      if (.not. (is_given(limit) .and. s(austenite)%value > 0)) return
      room = dual_curve_at(limit, temperature) - s(phase)
      if (volume%value > 0) then
        if (room%value < volume%value) volume = room
        if (room%value <= 0) volume = dual_t()
        room = room - volume
      end if
      if (room%value >= s(austenite)%value .or. .not. w%value > 0) return
      change = dual_curve_at(limit, temperature + half) - dual_curve_at(limit, temperature - half)
      rest = exp(-w)
      if (w%value > series_below) then
        formed = room*(1.0_wp - rest) + change*(0.5_wp*(1.0_wp + rest) - (1.0_wp - rest)/w)
      else
        formed = room*(1.0_wp - rest) + change*(w*w/12.0_wp)
      end if
      if (formed%value <= 0) then
        w = dual_t()
      else if (formed%value < s(austenite)%value) then
        w = -log(1.0_wp - formed/s(austenite))
      end if
    end associate
  end subroutine limit_growth

  !> Above the temperatures at which a phase forms its nuclei dissolve.
  pure subroutine forget_growth(steel, phase, temperature, s)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(inout) :: s(:)   !! (state_size) [state_units]

    if (temperature < steel%kinetics(phase)%high) return
    s(first_incubation + phase - first_diffusive) = dual_t()
    s(first_growth + phase - first_diffusive) = dual_t()
  end subroutine forget_growth

end module phase_growth
