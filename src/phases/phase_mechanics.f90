!> Mechanics of a mixture of phases: moduli, strains by temperature and phases, yield stress, hardening, transformation plasticity.
!>
!> z are the fractions, Z that of all phases but austenite (g). Moduli are linear in the fractions.
!> Strain in the total form, eps(T, z) = z_g ALPHA_g (T - T0) + sum_i z_i (ALPHA_i (T - T0) + DEPS_i), ALPHA secant from T0; in the
!> incremental form, d eps = sum z_i ALPHA_i dT + sum DEPS_i dz_i, ALPHA tangent: the integral of ALPHA is exact, the fractions
!> those in the middle of the step.
!> Yield stress (1 - f(Z)) y_g + f(Z) sum_i z_i y_i/Z, y = SY + ET r + QV (1 - exp(-BV r)), r the hardening of each phase: all grow
!> by dp, and what forms brings THETA times that of what it forms from, so that r_i = (z_i r_i + dz_i THETA_i r)/(z_i + dz_i).
!> What becomes tempered in a step forms from martensite or bainite, also what has become these in the same step.
!> Stress by the rate r', of Norton and Hoff's form, added to it with the same weights: P2 sqrt3^(1+P3) r^P4 exp(-P1 r) r'^P3.
!> Transformation plasticity d eps = 3/2 s dG, dG = sum K_i (F(Z_end) - F(Z_start)) dz_i/dZ where phases form from austenite: exact
!> in F; of one phase K (F(z_end) - F(z_start)). F is z (2 - z), z (1 - ln z) above z = .03, or z. Nothing forms tempered from
!> austenite: what does and is tempered in the same step counts as the martensite or bainite that it was.
!> Sources: J.-B. Leblond, G. Mottet, J.-C. Devaux, J. Mech. Phys. Solids 34 (1986) 395-432; J.-B. Leblond, Int. J. Plasticity 5
!> (1989) 573-591 (F, its threshold, K = 2 deps/sy_g; THETA); Y. Desalos, IRSID report 95.34.94.01 (1981); code_aster R4.04.02
!> (mixture, several phases).
module phase_mechanics
  use kinds, only: wp
  use phases_there, only: phases_that_form
  use steels, only: austenite, bainite, expansion_none, expansion_total, martensite, phase_count, phase_names, &
                    plasticity_desalos, plasticity_leblond, plasticity_none, prop_alpha, prop_consistency, prop_hardening, &
                    prop_memory, prop_modulus, prop_plasticity, prop_poisson, prop_rate, prop_rise, prop_saturation, &
                    prop_softening, prop_strain, prop_yield, prop_young, steel_t, tempered
  use temperature_curves, only: curve_at, curve_integral, is_given
  use text, only: add_text, string_t
  implicit none
  private
  public :: mixture_moduli, strain_of_phases, weights_of_yield, mixture_yield, carry_hardening, plasticity_of_transformation, &
            lacking_mechanical_data, has_yield, mixture_viscosity, lacking_viscosity

  !> Leblond's F counts from this fraction on (1989, sec. 4).
  real(wp), parameter :: leblond_threshold = 0.03_wp

contains

  !> Young's modulus and Poisson's ratio of a mixture.
  pure subroutine mixture_moduli(steel, z, temperature, young, poisson)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z(:)          !! (phase_count) [-]
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp), intent(out) :: young        !! [MPa]
    real(wp), intent(out) :: poisson      !! [-]

    young = mixture_of(steel, prop_young, z, temperature)
    poisson = mixture_of(steel, prop_poisson, z, temperature)
  end subroutine mixture_moduli

  !> Strain by temperature and phases from the start to the end of a step.
  pure function strain_of_phases(steel, before, now, from, to) result(strain)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: before(:), now(:)   !! (phase_count) fractions at both ends [-]
    real(wp), intent(in) :: from, to            !! temperatures at both ends [degC]
    real(wp) :: strain                          !! [-]
    integer :: i

    if (steel%expansion == expansion_total) then
      strain = total_strain(steel, now, to) - total_strain(steel, before, from)
      return
    end if
    strain = 0
    do i = 1, phase_count
      if (.not. before(i) + now(i) > 0) cycle
      strain = strain + 0.5_wp*(before(i) + now(i))*curve_integral(steel%properties(prop_alpha, i), from, to)
      if (i == austenite) cycle
      strain = strain + (now(i) - before(i))*curve_at(steel%properties(prop_strain, i), 0.5_wp*(from + to))
    end do
  end function strain_of_phases

  !> Strain in the total form, from austenite at the reference temperature.
  pure function total_strain(steel, z, temperature) result(strain)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z(:), temperature
    real(wp) :: strain
    integer :: i

    strain = 0
    do i = 1, phase_count
      if (.not. z(i) > 0) cycle
      strain = strain + z(i)*curve_at(steel%properties(prop_alpha, i), temperature)*(temperature - steel%reference)
      if (i /= austenite) strain = strain + z(i)*curve_at(steel%properties(prop_strain, i), steel%reference)
    end do
  end function total_strain

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

  !> Fractions at the end of a step were nothing tempered in it. What is tempered is missing first where less is left than there
  !> was; what is more than that was martensite, or bainite where no martensite is tempered.
  pure function before_tempering(steel, before, now) result(formed)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: before(:), now(:)   !! (phase_count) fractions at both ends of the step [-]
    real(wp) :: formed(phase_count)             !! (phase_count) [-]
    real(wp) :: left, part
    integer :: k
    integer, parameter :: origins(2) = [martensite, bainite]

    formed = now
    left = now(tempered) - before(tempered)
    if (.not. left > 0) return
    formed(tempered) = before(tempered)
    do k = 1, size(origins)
      part = min(left, max(0.0_wp, before(origins(k)) - now(origins(k))))
      formed(origins(k)) = formed(origins(k)) + part
      left = left - part
    end do
    k = merge(1, 2, steel%temper_rate(1) > 0 .or. .not. steel%temper_rate(2) > 0)
    formed(origins(k)) = formed(origins(k)) + left
  end function before_tempering

  !> dG of the step: the strain of transformation plasticity over 3/2 of the deviator of the stress.
  pure function plasticity_of_transformation(steel, before, now, from, to) result(factor)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: before(:), now(:)   !! (phase_count) fractions at both ends [-]
    real(wp), intent(in) :: from, to            !! temperatures at both ends [degC]
    real(wp) :: factor                          !! [1/MPa]
    real(wp) :: grown(phase_count)
    integer :: i

    factor = 0
    if (steel%plasticity == plasticity_none .or. .not. before(austenite) > now(austenite)) return
    grown = max(0.0_wp, before_tempering(steel, before, now) - before)
    if (.not. sum(grown) > 0) return
    do i = 1, phase_count
      if (grown(i) > 0) factor = factor + coefficient(steel, i, 0.5_wp*(from + to))*grown(i)/sum(grown)
    end do
    factor = factor*(progress(steel, 1 - now(austenite)) - progress(steel, 1 - before(austenite)))
  end function plasticity_of_transformation

  !> F(z).
  pure function progress(steel, z) result(f)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z
    real(wp) :: f
    real(wp) :: bounded

    bounded = min(1.0_wp, max(0.0_wp, z))
    select case (steel%plasticity)
    case (plasticity_desalos)
      f = bounded*(2 - bounded)
    case (plasticity_leblond)
      bounded = max(bounded, leblond_threshold)
      f = bounded*(1 - log(bounded))
    case default
      f = bounded
    end select
  end function progress

  !> K of a phase: given, or Leblond's 2 deps/sy_g, deps the strain between the phase and austenite.
  pure function coefficient(steel, phase, temperature) result(k)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: temperature
    real(wp) :: k   !! [1/MPa]
    real(wp) :: strain, yield

    if (is_given(steel%properties(prop_plasticity, phase))) then
      k = curve_at(steel%properties(prop_plasticity, phase), temperature)
      return
    end if
    k = 0
    if (steel%plasticity /= plasticity_leblond) return
    yield = curve_at(steel%properties(prop_yield, austenite), temperature)
    if (steel%expansion == expansion_total) then
      strain = curve_at(steel%properties(prop_strain, phase), steel%reference) + (temperature - steel%reference) &
               *(curve_at(steel%properties(prop_alpha, phase), temperature) &
                 - curve_at(steel%properties(prop_alpha, austenite), temperature))
    else
      strain = curve_at(steel%properties(prop_strain, phase), temperature)
    end if
    if (yield > 0) k = 2*abs(strain)/yield
  end function coefficient

  !> sum z_i of a property.
  pure function mixture_of(steel, property, z, temperature) result(value)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: property
    real(wp), intent(in) :: z(:), temperature
    real(wp) :: value
    integer :: i

    value = 0
    do i = 1, phase_count
      if (z(i) > 0) value = value + z(i)*curve_at(steel%properties(property, i), temperature)
    end do
  end function mixture_of

  !> What the phases that may be there lack for their flow by the rate, a line each.
  pure subroutine lacking_viscosity(steel, problems)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(inout) :: problems(:)   !! (nproblem) those found are added
    logical :: there(phase_count)
    integer :: i

    there = phases_that_form(steel)
    do i = 1, phase_count
      if (.not. there(i)) cycle
      if (is_given(steel%properties(prop_consistency, i)) .and. is_given(steel%properties(prop_rate, i))) cycle
      call add_text(problems, 'the steel '''//steel%name//''' has no P2 and P3 of '//trim(phase_names(i)))
    end do
  end subroutine lacking_viscosity

  !> What the phases that may be there lack for their mechanics, a line each.
  pure subroutine lacking_mechanical_data(steel, problems)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem)
    logical :: there(phase_count)
    logical, parameter :: from_austenite(phase_count) = [.false., .true., .true., .true., .true., .false.]
    integer :: i

    allocate (problems(0))
    there = phases_that_form(steel)
    if (steel%expansion == expansion_none) &
      call add_text(problems, 'the steel '''//steel%name//''' has no card EXPAND, the form of strains by temperature and phases')
    do i = 1, phase_count
      if (.not. there(i)) cycle
      call ask_for(i, prop_young, 'E', problems)
      call ask_for(i, prop_poisson, 'NU', problems)
      call ask_for(i, prop_alpha, 'ALPHA', problems)
      if (i /= austenite) call ask_for(i, prop_strain, 'DEPS', problems)
      if (has_yield(steel) .neqv. is_given(steel%properties(prop_yield, i))) &
        call add_text(problems, 'the steel '''//steel%name//''' has SY of some phases and none of '// &
                      trim(phase_names(merge(i, austenite, has_yield(steel)))))
      if (.not. from_austenite(i) .or. any(steel%plasticity == [plasticity_none, plasticity_leblond])) cycle
      call ask_for(i, prop_plasticity, 'KTP', problems)
    end do
    if (steel%plasticity == plasticity_leblond .and. .not. has_yield(steel) .and. &
        any(there .and. from_austenite .and. .not. is_given(steel%properties(prop_plasticity, :)))) &
      call add_text(problems, 'the steel '''//steel%name//''' needs KTP of all phases, or SY, for TRIP LEBLOND')

  contains

    pure subroutine ask_for(phase, property, name, list)
      integer, intent(in) :: phase, property
      character(len=*), intent(in) :: name
      type(string_t), allocatable, intent(inout) :: list(:)   !! (nproblem)

      if (.not. is_given(steel%properties(property, phase))) &
        call add_text(list, 'the steel '''//steel%name//''' has no '//name//' of '//trim(phase_names(phase)))
    end subroutine ask_for

  end subroutine lacking_mechanical_data

end module phase_mechanics
