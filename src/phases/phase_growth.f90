!> What one phase alone would form of the austenite by diffusion: where it may, how much, up to its largest fraction.
module phase_growth
  use avrami, only: grow_avrami
  use dual_numbers, only: dual_t, exp, log, operator(*), operator(-), operator(/)
  use kinds, only: wp
  use li_kinetics, only: grow_li
  use phase_state, only: first_growth, first_incubation
  use steels, only: austenite, first_diffusive, kinetics_avrami, kinetics_li, kinetics_none, steel_t
  use temperature_curves, only: dual_curve_at, is_given
  implicit none
  private
  public :: forms, grow, limit_growth, forget_growth

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

  !> Of a phase that has a largest fraction, only the rest up to there can form.
  pure subroutine limit_growth(steel, phase, temperature, s, w, volume)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(in) :: s(:)          !! (state_size) [state_units]
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
