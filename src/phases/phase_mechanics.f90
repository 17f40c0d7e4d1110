!> Mechanics of a mixture of phases: moduli, and strains by temperature and phases.
!>
!> z are the fractions, z_g that of austenite. Moduli are linear in the fractions.
!> Strain in the total form, eps(T, z) = z_g ALPHA_g (T - T0) + sum_i z_i (ALPHA_i (T - T0) + DEPS_i), ALPHA secant from T0; in the
!> incremental form, d eps = sum z_i ALPHA_i dT + sum DEPS_i dz_i, ALPHA tangent: the integral of ALPHA is exact, the fractions
!> those in the middle of the step.
!> Sources: code_aster R4.04.02 (mixture, several phases).
module phase_mechanics
  use kinds, only: wp
  use steels, only: austenite, expansion_total, phase_count, prop_alpha, prop_poisson, prop_strain, prop_young, steel_t
  use temperature_curves, only: curve_at, curve_integral
  implicit none
  private
  public :: mixture_moduli, strain_of_phases

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

end module phase_mechanics
