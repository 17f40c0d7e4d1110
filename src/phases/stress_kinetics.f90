!> Effect of stress on the kinetics of phases: shifts of Ms and of the temperatures and times of diffusive growth.
!>
!> With the mean stress p (positive in tension) and von Mises' stress q, a phase forms at a temperature T as it does without stress
!> at T - (a p + b q), and in times divided by exp(c p + d q). So Ms becomes Ms + a p + b q, and a TTT curve moves by as much along
!> temperatures and by the factor exp(-c p - d q) along times. Below T is called T* = T - (a p + b q).
!> Source: J.R. Patel, M. Cohen, Acta Metall. 1 (1953) 531 (shear and tension raise Ms, pressure lowers it); S. Denis, E. Gautier,
!> A. Simon, G. Beck, Mater. Sci. Technol. 1 (1985) 805 (Ms and isothermal diagrams in calculations of quenching).
module stress_kinetics
  use dual_numbers, only: dual_t, exp, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: last_diffusive, steel_t, stress_effect_t
  implicit none
  private
  public :: shift_of_phase, hastened, stressed_span

contains

  !> By how much the temperatures move at which a phase forms.
  pure function shift_of_phase(effect, phase, stress) result(shift)
    type(stress_effect_t), intent(in) :: effect
    integer, intent(in) :: phase               !! ferrite to martensite
    type(dual_t), intent(in) :: stress(2)      !! mean and von Mises' stress [MPa]
    type(dual_t) :: shift                      !! [K]

    shift = dual_t()
    if (effect%given) shift = effect%shift(1, phase)*stress(1) + effect%shift(2, phase)*stress(2)
  end function shift_of_phase

  !> The time without stress in which a phase grows as much as in a time under stress.
  pure function hastened(effect, phase, stress, time) result(without)
    type(stress_effect_t), intent(in) :: effect
    integer, intent(in) :: phase               !! ferrite to bainite
    type(dual_t), intent(in) :: stress(2)      !! mean and von Mises' stress [MPa]
    type(dual_t), intent(in) :: time           !! [s]
    type(dual_t) :: without                    !! [s]

    without = time
    if (.not. effect%given) return
    if (any(abs(effect%haste(:, phase)) > 0)) &
      without = time*exp(effect%haste(1, phase)*stress(1) + effect%haste(2, phase)*stress(2))
  end function hastened

  !> T* and the time of growth of a phase in a sub-step: of the part of it in which T* is where the phase forms, so that the growth
  !> has no jump while the stress is iterated. Without effect both stay as they are.
  pure subroutine stressed_span(steel, phase, from, to, stress, temperature, time)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase                  !! ferrite to bainite
    type(dual_t), intent(in) :: from, to          !! temperatures at both ends of the sub-step [degC]
    type(dual_t), intent(in) :: stress(2, 2)      !! mean and von Mises' stress, at both ends [MPa]
    type(dual_t), intent(inout) :: temperature    !! in the middle: becomes T* [degC]
    type(dual_t), intent(inout) :: time           !! [s]
    type(dual_t) :: middle(2), a, b, low, high

    if (.not. steel%isig%given .or. phase > last_diffusive) return
    middle = 0.5_wp*(stress(:, 1) + stress(:, 2))
    time = hastened(steel%isig, phase, middle, time)
    if (.not. any(abs(steel%isig%shift(:, phase)) > 0)) return
    a = from - shift_of_phase(steel%isig, phase, stress(:, 1))
    b = to - shift_of_phase(steel%isig, phase, stress(:, 2))
    temperature = 0.5_wp*(a + b)
    low = a
    high = b
    if (b%value < a%value) then
      low = b
      high = a
    end if
    associate (kinetics => steel%kinetics(phase))
      if (.not. (high%value > kinetics%low .and. low%value < kinetics%high .and. high%value > low%value)) return
      a = low
      b = high
      if (low%value < kinetics%low) a = dual_t(kinetics%low)
      if (high%value > kinetics%high) b = dual_t(kinetics%high)
      time = time*((b - a)/(high - low))
      temperature = 0.5_wp*(a + b)
    end associate
  end subroutine stressed_span

end module stress_kinetics
