!> Transformation plasticity of a mixture of phases.
!>
!> d eps = 3/2 s dG, dG = sum K_i (F(Z_end) - F(Z_start)) dz_i/dZ where phases form from austenite, Z the fraction of all phases but
!> austenite: exact in F; of one phase K (F(z_end) - F(z_start)). F is z (2 - z), z (1 - ln z) above z = .03, or z. Nothing forms
!> tempered from austenite: what does and is tempered in the same step counts as the martensite or bainite that it was.
!> Sources: J.-B. Leblond, G. Mottet, J.-C. Devaux, J. Mech. Phys. Solids 34 (1986) 395-432; J.-B. Leblond, Int. J. Plasticity 5
!> (1989) 573-591 (F, its threshold, K = 2 deps/sy_g); Y. Desalos, IRSID report 95.34.94.01 (1981).
module transformation_plasticity
  use kinds, only: wp
  use steels, only: austenite, bainite, expansion_total, martensite, phase_count, plasticity_desalos, plasticity_leblond, &
                    plasticity_none, prop_alpha, prop_plasticity, prop_strain, prop_yield, steel_t, tempered
  use temperature_curves, only: curve_at, is_given
  implicit none
  private
  public :: plasticity_of_transformation
  public :: before_tempering

  !> Leblond's F counts from this fraction on (1989, sec. 4).
  real(wp), parameter :: leblond_threshold = 0.03_wp

contains

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

end module transformation_plasticity
