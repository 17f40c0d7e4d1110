!> Materials of ARBTHMET for the tests of laws and of what is built on them: a steel whose martensite and bainite have numbers of
!> their own.
module steel_materials
  use kinds, only: wp
  use materials, only: material_t
  use steel_build, only: set_nodes
  use steels, only: austenite, expansion_incremental, expansion_total, phase_count, plasticity_desalos, prop_alpha, prop_modulus, &
                    prop_plasticity, prop_poisson, prop_strain, prop_yield, prop_young, steel_t
  use temperature_curves, only: curve_polynomial, temperature_curve_t
  implicit none
  private
  public :: steel_of_tests, steel_material, polynomial, steel_young, steel_poisson, steel_ms, steel_beta, steel_k, steel_deps, &
            steel_alpha, steel_yield, steel_modulus

  !> Elastic numbers of all phases; martensite: start [degC], rate [1/K], K [1/MPa], strain at 20 degC.
  real(wp), parameter :: steel_young = 200000.0_wp, steel_poisson = 0.3_wp
  real(wp), parameter :: steel_ms = 330.0_wp, steel_beta = 0.011_wp, steel_k = 8.0e-5_wp, steel_deps = 0.0104_wp
  !> Of austenite and martensite: expansion [1/K], yield stress at 0 degC and its slope [MPa], [MPa/K], modulus of hardening [MPa].
  real(wp), parameter :: steel_alpha(2) = [22.0e-6_wp, 12.0e-6_wp]
  real(wp), parameter :: steel_yield(2, 2) = reshape([220.0_wp, -0.15_wp, 1100.0_wp, -0.8_wp], [2, 2])
  real(wp), parameter :: steel_modulus(2) = [2500.0_wp, 6000.0_wp]

contains

  pure function polynomial(coefficients) result(curve)
    real(wp), intent(in) :: coefficients(:)
    type(temperature_curve_t) :: curve

    curve%form = curve_polynomial
    allocate (curve%v, source=coefficients)
  end function polynomial

  !> A steel with martensite, in the total form of strains from 20 degC, or the same in the incremental form; transformation
  !> plasticity after Desalos. Bainite has the numbers of martensite, and no kinetics.
  function steel_of_tests(total) result(steel)
    logical, intent(in) :: total
    type(steel_t) :: steel
    integer :: i, k

    steel%name = 'tests'
    steel%ms = steel_ms
    steel%beta = steel_beta
    steel%plasticity = plasticity_desalos
    steel%expansion = merge(expansion_total, expansion_incremental, total)
    steel%reference = 20
    do i = 1, phase_count
      k = merge(1, 2, i == austenite)
      steel%properties(prop_young, i) = polynomial([steel_young])
      steel%properties(prop_poisson, i) = polynomial([steel_poisson])
      steel%properties(prop_alpha, i) = polynomial([steel_alpha(k)])
      steel%properties(prop_yield, i) = polynomial(steel_yield(:, k))
      steel%properties(prop_modulus, i) = polynomial([steel_modulus(k)])
      if (i == austenite) cycle
      steel%properties(prop_plasticity, i) = polynomial([steel_k])
      if (total) then
        steel%properties(prop_strain, i) = polynomial([steel_deps])
      else
        ! deps + (alpha_i - alpha_g) (T - 20): what the total form says of a phase that forms at T
        steel%properties(prop_strain, i) = polynomial([steel_deps - 20*(steel_alpha(2) - steel_alpha(1)), &
                                                       steel_alpha(2) - steel_alpha(1)])
      end if
    end do
    call set_nodes(steel)
  end function steel_of_tests

  !> STRESS TIME ZERO TRIP RATE0 COWPER VISCO ISIG MELT. With `follows` the law follows the kinetics, in seconds.
  function steel_material(steel, follows) result(material)
    type(steel_t), intent(in) :: steel
    logical, intent(in) :: follows
    type(material_t) :: material

    material%name = 'steel'
    material%law = 'ARBTHMET'
    allocate (material%values, source=[1.0_wp, merge(1.0_wp, 0.0_wp, follows), 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
                                      0.0_wp, 0.0_wp])
    allocate (material%curve(2, 0))
    allocate (material%steel, source=steel)
  end function steel_material

end module steel_materials
