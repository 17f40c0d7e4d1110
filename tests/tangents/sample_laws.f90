!> A material of every solid law and of every form and option it has, with the stress at which it flows written once more.
!> A law without a sample here fails test_tangent_table.
module sample_laws
  use kinds, only: wp
  use law_cases, only: at_temperatures, closed_form_yield, elastic_material, material_of, plastic_material, set_value
  use materials, only: material_t
  use steel_materials, only: polynomial, steel_alpha, steel_beta, steel_deps, steel_k, steel_material, steel_modulus, steel_ms, &
                             steel_of_tests, steel_poisson, steel_yield, steel_young
  use steels, only: austenite, martensite, prop_consistency, prop_hardening, prop_rate, prop_rise, prop_saturation, prop_softening
  implicit none
  private
  public :: sample_law_t, list_samples, flow_stress, young_at, poisson_of, thermal_strain, plasticity_of_step

  type :: sample_law_t
    character(len=16) :: name
    type(material_t) :: material
    !> Temperatures at the start, and at the end of the first and of the second step.
    real(wp) :: temperatures(0:2) = 0.0_wp
    !> Its stress under monotonic flow is written below.
    logical :: closed_form = .true.
  end type sample_law_t

  real(wp), parameter :: expansion = 1.2e-5_wp
  !> HKIN; RATE0 and COWPER; RATE0 and JOHNSON.
  real(wp), parameter :: kinematic = 2500.0_wp, cowper(2) = [40.0_wp, 5.0_wp], johnson(2) = [1.0e-3_wp, 0.02_wp]
  !> E NU P1 P2 P3 P4 and E NU K W H M A TABS.
  real(wp), parameter :: norton(6) = [150000.0_wp, 0.3_wp, 0.5_wp, 90.0_wp, 0.12_wp, 0.2_wp]
  real(wp), parameter :: gsell(8) = [500.0_wp, 0.4_wp, 0.02_wp, 30.0_wp, 0.6_wp, 0.06_wp, 2000.0_wp, 273.15_wp]
  !> The card by temperature: numbers at 20, and these shares of E and of the yield stress at 420.
  real(wp), parameter :: hot_modulus = 0.7_wp, hot_yield = 0.5_wp
  !> QV and BV of austenite and martensite; RATE0 and COWPER of the steel with phases.
  real(wp), parameter :: rise(2) = [60.0_wp, 150.0_wp], saturation(2) = [20.0_wp, 35.0_wp], viscous(2) = [5.0_wp, 3.0_wp]
  !> P1 P2 P3 P4 of its phases.
  real(wp), parameter :: by_rate(4, 2) = reshape([0.5_wp, 90.0_wp, 0.12_wp, 0.2_wp, 0.2_wp, 400.0_wp, 0.05_wp, 0.1_wp], [4, 2])

contains

  subroutine list_samples(samples)
    type(sample_law_t), allocatable, intent(out) :: samples(:)
    character(len=16), parameter :: forms(6) = [character(len=16) :: 'EPLA LINEAR', 'EPLA VOCE', 'EPLA SWIFT', 'EPLA TABLE', &
                                                'EPLA perfect', 'EPLA softening']
    type(material_t) :: hot
    integer :: k

    allocate (samples(21))
    samples(1) = sample_law_t('ELA', elastic_material())
    samples(2) = sample_law_t('ELATH', material_of('ELATH', [200000.0_wp, 0.3_wp, expansion]), [20.0_wp, 220.0_wp, 320.0_wp])
    do k = 1, 6
      samples(2 + k) = sample_law_t(forms(k), plastic_material(k))
    end do
    samples(9) = sample_law_t('EPLA HKIN', plastic_material(2))
    call set_value(samples(9)%material, 'HKIN', kinematic)
    samples(10) = sample_law_t('EPLA COWPER', plastic_material(1))
    call set_value(samples(10)%material, 'RATE0', cowper(1))
    call set_value(samples(10)%material, 'COWPER', cowper(2))
    samples(11) = sample_law_t('EPLA JOHNSON', plastic_material(1))
    call set_value(samples(11)%material, 'RATE0', johnson(1))
    call set_value(samples(11)%material, 'JOHNSON', johnson(2))
    samples(12) = samples(10)
    samples(12)%name = 'EPLA HKIN+COWPER'
    call set_value(samples(12)%material, 'HKIN', kinematic)
    hot = plastic_material(1)
    hot%values(1) = hot_modulus*hot%values(1)
    hot%values(4:5) = hot_yield*hot%values(4:5)
    samples(13) = sample_law_t('EPLA temperature', at_temperatures(plastic_material(1), 20.0_wp, hot, 420.0_wp), &
                               [20.0_wp, 120.0_wp, 320.0_wp])
    samples(14) = sample_law_t('EVP-NH', material_of('EVP-NH', norton))
    samples(15) = sample_law_t('GSELL', material_of('GSELL', gsell), [120.0_wp, 110.0_wp, 100.0_wp])
    samples(16) = sample_law_t('ARBTHMET total', steel_material(steel_of_tests(.true.), .true.), [400.0_wp, 260.0_wp, 150.0_wp])
    samples(17) = sample_law_t('ARBTHMET increm', steel_material(steel_of_tests(.false.), .true.), [400.0_wp, 260.0_wp, 150.0_wp])
    samples(18) = samples(16)
    samples(18)%name = 'ARBTHMET viscous'
    samples(18)%material%values(5:6) = viscous
    do k = 1, 2
      associate (phase => merge(austenite, martensite, k == 1))
        samples(18)%material%steel%properties(prop_rise, phase) = polynomial([rise(k)])
        samples(18)%material%steel%properties(prop_saturation, phase) = polynomial([saturation(k)])
      end associate
    end do
    samples(19) = samples(16)
    samples(19)%name = 'ARBTHMET VISCO'
    samples(19)%material%values(7) = 1
    do k = 1, 2
      associate (own => samples(19)%material%steel%properties(:, merge(austenite, martensite, k == 1)))
        own(prop_softening) = polynomial([by_rate(1, k)])
        own(prop_consistency) = polynomial([by_rate(2, k)])
        own(prop_rate) = polynomial([by_rate(3, k)])
        own(prop_hardening) = polynomial([by_rate(4, k)])
      end associate
    end do
    ! stress on the kinetics: its closed form is in tests/law
    samples(20) = samples(16)
    samples(20)%name = 'ARBTHMET ISIG'
    samples(20)%material%values(8) = 1
    samples(20)%material%steel%isig%given = .true.
    samples(20)%material%steel%isig%shift(:, martensite) = [0.05_wp, 0.03_wp]
    samples(20)%closed_form = .false.
    samples(21) = samples(19)
    samples(21)%name = 'ARBTHMET both'
    samples(21)%material%values(8) = 1
    samples(21)%material%steel%isig = samples(20)%material%steel%isig
    samples(21)%closed_form = .false.
  end subroutine list_samples

  !> Von Mises stress of monotonic flow at plastic strain p, rate and temperature; 0 for laws that do not flow.
  pure function flow_stress(name, p, rate, temperature) result(stress)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: p, rate, temperature
    real(wp) :: stress

    stress = 0
    select case (name)
    case ('EPLA LINEAR')
      stress = closed_form_yield(1, p)
    case ('EPLA VOCE')
      stress = closed_form_yield(2, p)
    case ('EPLA SWIFT')
      stress = closed_form_yield(3, p)
    case ('EPLA TABLE')
      stress = closed_form_yield(4, p)
    case ('EPLA perfect')
      stress = closed_form_yield(5, p)
    case ('EPLA softening')
      stress = closed_form_yield(6, p)
    case ('EPLA HKIN')
      stress = closed_form_yield(2, p) + kinematic*p
    case ('EPLA COWPER')
      stress = closed_form_yield(1, p)*(1 + (rate/cowper(1))**(1/cowper(2)))
    case ('EPLA HKIN+COWPER')
      stress = closed_form_yield(1, p)*(1 + (rate/cowper(1))**(1/cowper(2))) + kinematic*p
    case ('EPLA JOHNSON')
      stress = closed_form_yield(1, p)*(1 + johnson(2)*log(rate/johnson(1)))
    case ('EPLA temperature')
      stress = closed_form_yield(1, p)*(1 + (hot_yield - 1)*(temperature - 20)/400)
    case ('EVP-NH')
      stress = p**norton(6)*exp(-norton(3)*p)*norton(4)*sqrt(3.0_wp)*(sqrt(3.0_wp)*rate)**norton(5)
    case ('GSELL')
      stress = gsell(3)*exp(gsell(7)/(temperature + gsell(8)))*(1 - exp(-gsell(4)*p))*exp(gsell(5)*p**2)*rate**gsell(6)
    case ('ARBTHMET total', 'ARBTHMET increm')
      stress = mixture_yield(p, temperature)
    case ('ARBTHMET VISCO')
      stress = mixture_yield(p, temperature) + viscosity(p, rate, temperature)
    case ('ARBTHMET viscous')
      stress = mixture_yield(p, temperature) + dot_product(mixture(temperature), rise*(1 - exp(-saturation*p)))
      stress = stress*(1 + (rate/viscous(1))**(1/viscous(2)))
    end select
  end function flow_stress

  !> Stress by the rate of the mixture: P2 sqrt3^(1+P3) p^P4 exp(-P1 p) rate^P3 of each phase.
  pure function viscosity(p, rate, temperature) result(stress)
    real(wp), intent(in) :: p, rate, temperature
    real(wp) :: stress

    stress = dot_product(mixture(temperature), by_rate(2, :)*sqrt(3.0_wp)**(1 + by_rate(3, :))*p**by_rate(4, :) &
                         *exp(-by_rate(1, :)*p)*rate**by_rate(3, :))
  end function viscosity

  !> Austenite and martensite after cooling to a temperature (Koistinen and Marburger).
  pure function mixture(temperature) result(z)
    real(wp), intent(in) :: temperature
    real(wp) :: z(2)

    z(1) = exp(-steel_beta*max(0.0_wp, steel_ms - temperature))
    z(2) = 1 - z(1)
  end function mixture

  !> Yield stress of the mixture, with linear hardening.
  pure function mixture_yield(p, temperature) result(stress)
    real(wp), intent(in) :: p, temperature
    real(wp) :: stress

    stress = dot_product(mixture(temperature), steel_yield(1, :) + steel_yield(2, :)*temperature + steel_modulus*p)
  end function mixture_yield

  !> Strain of transformation plasticity in the k-th step, over the von Mises stress.
  pure function plasticity_of_step(sample, k) result(factor)
    type(sample_law_t), intent(in) :: sample
    integer, intent(in) :: k
    real(wp) :: factor
    real(wp) :: z(2, 0:1)

    factor = 0
    if (sample%name(:8) /= 'ARBTHMET') return
    z(:, 0) = mixture(sample%temperatures(k - 1))
    z(:, 1) = mixture(sample%temperatures(k))
    factor = steel_k*(z(2, 1)*(2 - z(2, 1)) - z(2, 0)*(2 - z(2, 0)))
  end function plasticity_of_step

  pure function young_at(sample, temperature) result(young)
    type(sample_law_t), intent(in) :: sample
    real(wp), intent(in) :: temperature
    real(wp) :: young

    young = sample%material%values(1)
    if (sample%name(:8) == 'ARBTHMET') young = steel_young
    if (sample%name == 'EPLA temperature') young = young*(1 + (hot_modulus - 1)*(temperature - 20)/400)
  end function young_at

  pure function poisson_of(sample) result(poisson)
    type(sample_law_t), intent(in) :: sample
    real(wp) :: poisson

    poisson = sample%material%values(2)
    if (sample%name(:8) == 'ARBTHMET') poisson = steel_poisson
  end function poisson_of

  !> Thermal strain since the start.
  pure function thermal_strain(sample, temperature) result(strain)
    type(sample_law_t), intent(in) :: sample
    real(wp), intent(in) :: temperature
    real(wp) :: strain
    real(wp) :: z(2)

    strain = 0
    if (sample%name(:8) == 'ARBTHMET') then
      z = mixture(temperature)
      strain = dot_product(z, steel_alpha)*(temperature - 20) + z(2)*steel_deps
      z = mixture(sample%temperatures(0))
      strain = strain - dot_product(z, steel_alpha)*(sample%temperatures(0) - 20) - z(2)*steel_deps
    end if
    if (sample%name == 'ELATH') strain = expansion*(temperature - sample%temperatures(0))
  end function thermal_strain

end module sample_laws
