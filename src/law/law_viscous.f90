!> EVP-NH (270) and GSELL: elastic-viscoplastic laws whose flow stress is a curve times a power of the rate.
!>
!> EVP-NH, Norton-Hoff: p**P4 exp(-P1 p) P2 sqrt3 (sqrt3 rate)**P3.
!> GSELL, G'Sell-Jonas: K exp(A/T) (1 - exp(-W p)) exp(H p**2) rate**M, T the absolute temperature.
!> p and rate are the equivalent viscoplastic strain and its rate. There is no elastic domain: some flow goes on at any stress.
!> Implicit in time (radial_return). The parameters are linear between the temperatures of a card.
module law_viscous
  use elastic_numbers, only: elastic_of_card, elastic_parameters, place_poisson, place_young
  use elasticity, only: moduli
  use hardening, only: yield_gsell, yield_norton
  use kinds, only: wp
  use law_api, only: driver_temperature, law_line, law_not_converged, law_t, parameter, row_of_work
  use materials, only: material_t, values_at
  use radial_return, only: flow_stress_at, flow_t, return_point
  use rate_dependence, only: rate_power
  use state_variables, only: state_variable, transfer_scalar
  implicit none
  private
  public :: law_evpnh_row, law_gsell_row

  !> Row of the plastic rate in the history.
  integer, parameter :: row_of_rate = 3
  !> Numbers among the values of a material: after E and NU those of EVP-NH and those of GSELL.
  integer, parameter :: p1 = 3, p2 = 4, p3 = 5, p4 = 6
  integer, parameter :: place_k = 3, place_w = 4, place_h = 5, place_m = 6, place_a = 7, place_absolute = 8

contains

  function law_evpnh_row() result(row)
    type(law_t) :: row

    row%name = 'EVP-NH'
    row%number = 270
    row%purpose = 'elastic-viscoplastic, Norton-Hoff'
    row%source = 'Norton, Hoff; in LAGAMINE: Pascon, Habraken et al.'
    allocate (row%lines, source=[law_line(elastic_parameters()), &
                 law_line([parameter('P1', '-', 'softening: exp(-P1 p)', lower=0.0_wp), &
                           parameter('P2', 'stress', 'consistency, with times in the unit of the deck', above=0.0_wp), &
                           parameter('P3', '-', 'exponent of the rate', lower=0.001_wp, upper=1.0_wp), &
                           parameter('P4', '-', 'hardening: p^P4', lower=0.0_wp, upper=1.0_wp)])])
    call common_parts(row, 'plasticity')
    row%update => update_evpnh
    row%flow_stress => flow_of_evpnh
  end function law_evpnh_row

  function law_gsell_row() result(row)
    type(law_t) :: row

    row%name = 'GSELL'
    row%number = 9270
    row%purpose = 'polymers near their forming temperature, G''Sell-Jonas'
    row%source = 'C. G''Sell, J.J. Jonas, J. Mater. Sci. 14 (1979) 583-591'
    allocate (row%lines, source=[law_line(elastic_parameters()), &
                 law_line([parameter('K', 'stress', 'consistency, with times in the unit of the deck', above=0.0_wp), &
                           parameter('W', '-', 'rise to flow: 1 - exp(-W p)', above=0.0_wp), &
                           parameter('H', '-', 'strain hardening: exp(H p^2)', lower=0.0_wp), &
                           parameter('M', '-', 'exponent of the rate', lower=0.001_wp, upper=1.0_wp), &
                           parameter('A', 'temperature', 'exp(A/T), T absolute', lower=0.0_wp), &
                           parameter('TABS', 'temperature', 'T = temperature of the body + TABS', lower=0.0_wp)])])
    call common_parts(row, 'plasticity temperature')
    row%update => update_gsell
    row%flow_stress => flow_of_gsell
  end function law_gsell_row

  subroutine common_parts(row, effects)
    type(law_t), intent(inout) :: row
    character(len=*), intent(in) :: effects

    allocate (row%history(3))
    row%history(1) = state_variable('plastic_strain', '-', transfer_scalar)
    row%history(2) = state_variable('plastic_work', 'stress', transfer_scalar)
    row%history(row_of_rate) = state_variable('plastic_rate', '1/time', transfer_scalar)
    row%effects = effects
    row%elastic => elastic_of_card
  end subroutine common_parts

  pure subroutine update_evpnh(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: values(size(material%values)), by_work(4)
    type(flow_t) :: flow
    integer :: n

    flow = norton_hoff(material%values)
    do n = 1, size(trial_strain, 2)
      if (allocated(material%temperatures)) then
        call values_at(material, drivers(driver_temperature, 2, n), values)
        flow = norton_hoff(values)
      end if
      call return_point(flow, material%curve, material%curve, dt, trial_strain(:, n), committed(:, n), stress(:, n), &
                        elastic_strain(:, n), history(:, n), tangent(:4, :, n), by_work, status(n))
      if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :, n) = by_work
    end do
  end subroutine update_evpnh

  pure subroutine update_gsell(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: values(size(material%values)), by_work(4)
    integer :: n

    do n = 1, size(trial_strain, 2)
      call values_at(material, drivers(driver_temperature, 2, n), values)
      call return_point(gsell_jonas(values, drivers(driver_temperature, 2, n)), material%curve, material%curve, dt, &
                        trial_strain(:, n), committed(:, n), stress(:, n), elastic_strain(:, n), history(:, n), &
                        tangent(:4, :, n), by_work, status(n))
      if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :, n) = by_work
      ! below absolute zero
      if (.not. drivers(driver_temperature, 2, n) + values(place_absolute) > 0) status(n) = law_not_converged
    end do
  end subroutine update_gsell

  !> Flow stress at the strain and the rate reached.
  pure function flow_of_evpnh(material, drivers, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:), history(:)
    real(wp) :: stress
    real(wp) :: values(size(material%values))

    call values_at(material, drivers(driver_temperature), values)
    stress = flow_stress_at(norton_hoff(values), material%curve, material%curve, history(1), history(row_of_rate))
  end function flow_of_evpnh

  !> Flow stress at the strain and the rate reached.
  pure function flow_of_gsell(material, drivers, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:), history(:)
    real(wp) :: stress
    real(wp) :: values(size(material%values))

    call values_at(material, drivers(driver_temperature), values)
    stress = flow_stress_at(gsell_jonas(values, drivers(driver_temperature)), material%curve, material%curve, history(1), &
                            history(row_of_rate))
  end function flow_of_gsell

  !> E, NU, P1, P2, P3, P4 to the numbers of the return.
  pure function norton_hoff(values) result(flow)
    real(wp), intent(in) :: values(:)
    type(flow_t) :: flow

    call moduli(values(place_young), values(place_poisson), flow%bulk, flow%shear)
    flow%yield => yield_norton
    flow%below(:3) = [values(p2)*sqrt(3.0_wp)**(1 + values(p3)), values(p4), values(p1)]
    flow%rate_form = rate_power
    flow%rate(1) = values(p3)
    flow%rate_row = row_of_rate
  end function norton_hoff

  !> E, NU, K, W, H, M, A, TABS to the numbers of the return.
  pure function gsell_jonas(values, temperature) result(flow)
    real(wp), intent(in) :: values(:), temperature
    type(flow_t) :: flow
    real(wp) :: absolute

    call moduli(values(place_young), values(place_poisson), flow%bulk, flow%shear)
    absolute = temperature + values(place_absolute)
    if (.not. absolute > 0) absolute = huge(absolute)   ! the caller refuses it
    flow%yield => yield_gsell
    flow%below(:3) = [values(place_k)*exp(values(place_a)/absolute), values(place_w), values(place_h)]
    flow%rate_form = rate_power
    flow%rate(1) = values(place_m)
    flow%rate_row = row_of_rate
  end function gsell_jonas

end module law_viscous
