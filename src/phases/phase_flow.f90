!> Flow of a mixture of phases: yield stress, hardening, stress by the rate.
!>
!> z are the fractions, Z that of all phases but austenite (g).
!> Yield stress (1 - f(Z)) y_g + f(Z) sum_i z_i y_i/Z, y = SY + ET r + QV (1 - exp(-BV r)), r the hardening of each phase: all grow
!> by dp, and what forms brings THETA times that of what it forms from, so that r_i = (z_i r_i + dz_i THETA_i r)/(z_i + dz_i).
!> What becomes tempered in a step forms from martensite or bainite, also what has become these in the same step.
!> Stress by the rate r', of Norton and Hoff's form, added to it with the same weights: P2 sqrt3^(1+P3) r^P4 exp(-P1 r) r'^P3.
!> Sources: J.-B. Leblond, Int. J. Plasticity 5 (1989) 573-591 (THETA); code_aster R4.04.02 (mixture, several phases).
module phase_flow
  use kinds, only: wp
  use steels, only: austenite, phase_count, prop_consistency, prop_hardening, prop_memory, prop_modulus, prop_rate, prop_rise, &
                    prop_saturation, prop_softening, prop_yield, steel_t
  use temperature_curves, only: curve_at, is_given
  use transformation_plasticity, only: before_tempering
  implicit none
  private
  public :: weights_of_yield, mixture_yield, carry_hardening, has_yield, mixture_viscosity

contains

  !> The phases of this steel have yield stresses.
  pure function has_yield(steel) result(yes)
    type(steel_t), intent(in) :: steel
    logical :: yes

    yes = is_given(steel%properties(prop_yield, austenite))
  end function has_yield

  !> Share of each phase in the yield stress.
  pure function weights_of_yield(steel, z) result(weights)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z(:)              !! (phase_count) [-]
    real(wp) :: weights(phase_count)          !! (phase_count) [-]
    real(wp) :: cold, f

    cold = sum(z) - z(austenite)
    f = cold
    if (is_given(steel%weight)) f = curve_at(steel%weight, cold)
    weights = 0
    if (cold > 0) weights = z*(f/cold)
    weights(austenite) = 1 - f
  end function weights_of_yield

  !> Yield stress of a mixture as a function of the growth dp of all hardenings: a(1) + a(2) dp + sum c_i (1 - exp(-b_i dp)).
  pure subroutine mixture_yield(steel, z, hardening, temperature, a, curve)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z(:)           !! (phase_count) [-]
    real(wp), intent(in) :: hardening(:)   !! (phase_count) [-]
    real(wp), intent(in) :: temperature    !! [degC]
    real(wp), intent(out) :: a(2)          !! [MPa]
    real(wp), intent(out) :: curve(:, :)   !! (2, phase_count) b [-] and c [MPa]
    real(wp) :: weights(phase_count), modulus, rise, left
    integer :: i

    weights = weights_of_yield(steel, z)
    a = 0
    curve = 0
    do i = 1, phase_count
      if (.not. weights(i) > 0) cycle
      associate (own => steel%properties(:, i))
        modulus = curve_at(own(prop_modulus), temperature)
        a(1) = a(1) + weights(i)*(curve_at(own(prop_yield), temperature) + modulus*hardening(i))
        a(2) = a(2) + weights(i)*modulus
        if (.not. is_given(own(prop_rise))) cycle
        curve(1, i) = curve_at(own(prop_saturation), temperature)
        rise = weights(i)*curve_at(own(prop_rise), temperature)
        left = exp(-curve(1, i)*hardening(i))
        a(1) = a(1) + rise*(1 - left)
        curve(2, i) = rise*left
      end associate
    end do
  end subroutine mixture_yield

  !> Stress by the rate of a mixture, of each phase: weight times P2 sqrt3^(1+P3), P4, P1, P3.
  pure subroutine mixture_viscosity(steel, z, temperature, numbers)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z(:)             !! (phase_count) [-]
    real(wp), intent(in) :: temperature      !! [degC]
    real(wp), intent(out) :: numbers(:, :)   !! (4, phase_count) [MPa s^P3], [-], [-], [-]
    real(wp) :: weights(phase_count)
    integer :: i

    weights = weights_of_yield(steel, z)
    numbers = 0
    do i = 1, phase_count
      if (.not. weights(i) > 0) cycle
      associate (own => steel%properties(:, i))
        numbers(2, i) = curve_at(own(prop_hardening), temperature)
        numbers(3, i) = curve_at(own(prop_softening), temperature)
        numbers(4, i) = curve_at(own(prop_rate), temperature)
        numbers(1, i) = weights(i)*curve_at(own(prop_consistency), temperature)*sqrt(3.0_wp)**(1 + numbers(4, i))
      end associate
    end do
  end subroutine mixture_viscosity

  !> Hardening of the phases after they have changed, before anything flows.
  pure subroutine carry_hardening(steel, before, now, temperature, hardening)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: before(:), now(:)   !! (phase_count) fractions at both ends of the step [-]
    real(wp), intent(in) :: temperature         !! [degC]
    real(wp), intent(inout) :: hardening(:)     !! (phase_count) [-]
    real(wp) :: formed(phase_count)

    formed = before_tempering(steel, before, now)
    call hand_over(steel, before, formed, temperature, hardening)
    call hand_over(steel, formed, now, temperature, hardening)
  end subroutine carry_hardening

  !> What phases that shrink hand over to those that grow. Fractions that are none but for round-off, or for a small share of an
  !> error (path_stress), may be below 0: they hold no hardening, and a phase that is not there at the end gets none.
  pure subroutine hand_over(steel, before, now, temperature, hardening)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: before(:), now(:)   !! (phase_count) [-]
    real(wp), intent(in) :: temperature         !! [degC]
    real(wp), intent(inout) :: hardening(:)     !! (phase_count) [-]
    real(wp) :: gone(phase_count), given, theta, kept
    integer :: i

    gone = max(0.0_wp, before - now)
    if (.not. sum(gone) > 0) return
    given = dot_product(gone, hardening)/sum(gone)
    do i = 1, phase_count
      kept = max(before(i), 0.0_wp)
      if (.not. now(i) > kept) cycle
      theta = 1
      if (is_given(steel%properties(prop_memory, i))) theta = curve_at(steel%properties(prop_memory, i), temperature)
      hardening(i) = (kept*hardening(i) + (now(i) - kept)*theta*given)/now(i)
    end do
  end subroutine hand_over

end module phase_flow
