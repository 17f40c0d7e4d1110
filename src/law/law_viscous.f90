!> EVP-NH (270) and GSELL: elastic-viscoplastic laws whose flow stress is a curve times a power of the rate.
!>
!> EVP-NH, Norton-Hoff: p**P4 exp(-P1 p) P2 sqrt3 (sqrt3 rate)**P3.
!> GSELL, G'Sell-Jonas: K exp(A/T) (1 - exp(-W p)) exp(H p**2) rate**M, T the absolute temperature.
!> p and rate are the equivalent viscoplastic strain and its rate. There is no elastic domain: some flow goes on at any stress.
!> Implicit in time (radial_return). The parameters are linear between the temperatures of a card.
module law_viscous
  use elasticity, only: moduli
  use hardening, only: hardening_gsell, hardening_norton
  use kinds, only: wp
  use law_api, only: law_line, law_not_converged, law_t, parameter
  use materials, only: material_t, values_at
  use radial_return, only: flow_stress_at, flow_t, return_point
  use rate_dependence, only: rate_power
  use state_variables, only: state_variable, transfer_scalar
  implicit none
  private
  public :: law_evpnh_row, law_gsell_row

  !> Row of the plastic rate in the history, and place of TABS in the values of GSELL.
  integer, parameter :: row_of_rate = 3, place_absolute = 8

contains

  function law_evpnh_row() result(row)
    type(law_t) :: row

    row%name = 'EVP-NH'
    row%number = 270
    row%purpose = 'elastic-viscoplastic, Norton-Hoff'
    row%source = 'Norton, Hoff; in LAGAMINE: Pascon, Habraken et al.'
    allocate (row%lines, source=[law_line([parameter('E', 'stress', 'Young''s modulus', above=0.0_wp), &
                           parameter('NU', '-', 'Poisson''s ratio', lower=0.0_wp, upper=0.499999_wp)]), &
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
    allocate (row%lines, source=[law_line([parameter('E', 'stress', 'Young''s modulus', above=0.0_wp), &
                           parameter('NU', '-', 'Poisson''s ratio', lower=0.0_wp, upper=0.499999_wp)]), &
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
  end subroutine common_parts

  pure subroutine update_evpnh(material, dt, temperature, trial_strain, committed, stress, elastic_strain, history, tangent, &
                               status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(:, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: values(size(material%values))
    type(flow_t) :: flow
    integer :: n

    flow = norton_hoff(material%values)
    do n = 1, size(trial_strain, 2)
      if (allocated(material%temperatures)) then
        call values_at(material, temperature(2, n), values)
        flow = norton_hoff(values)
      end if
      call return_point(flow, material%curve, material%curve, dt, trial_strain(:, n), committed(:, n), stress(:, n), &
                        elastic_strain(:, n), history(:, n), tangent(:, :, n), status(n))
    end do
  end subroutine update_evpnh

  pure subroutine update_gsell(material, dt, temperature, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(:, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: values(size(material%values))
    integer :: n

    do n = 1, size(trial_strain, 2)
      call values_at(material, temperature(2, n), values)
      call return_point(gsell_jonas(values, temperature(2, n)), material%curve, material%curve, dt, trial_strain(:, n), &
                        committed(:, n), stress(:, n), elastic_strain(:, n), history(:, n), tangent(:, :, n), status(n))
      if (.not. temperature(2, n) + values(place_absolute) > 0) status(n) = law_not_converged   ! below absolute zero
    end do
  end subroutine update_gsell

  !> Stress that the strain and the rate reached ask for.
  pure function flow_of_evpnh(material, temperature, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature, history(:)
    real(wp) :: stress
    real(wp) :: values(size(material%values))

    call values_at(material, temperature, values)
    stress = flow_stress_at(norton_hoff(values), material%curve, material%curve, history(1), history(row_of_rate))
  end function flow_of_evpnh

  !> Stress that the strain and the rate reached ask for.
  pure function flow_of_gsell(material, temperature, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature, history(:)
    real(wp) :: stress
    real(wp) :: values(size(material%values))

    call values_at(material, temperature, values)
    stress = flow_stress_at(gsell_jonas(values, temperature), material%curve, material%curve, history(1), history(row_of_rate))
  end function flow_of_gsell

  !> E, NU, P1, P2, P3, P4 to the numbers of the return.
  pure function norton_hoff(values) result(flow)
    real(wp), intent(in) :: values(:)
    type(flow_t) :: flow

    call moduli(values(1), values(2), flow%bulk, flow%shear)
    flow%form = hardening_norton
    flow%below = [values(4)*sqrt(3.0_wp)**(1 + values(5)), values(6), values(3), 0.0_wp]
    flow%rate_form = rate_power
    flow%rate(1) = values(5)
    flow%rate_row = row_of_rate
  end function norton_hoff

  !> E, NU, K, W, H, M, A, TABS to the numbers of the return.
  pure function gsell_jonas(values, temperature) result(flow)
    real(wp), intent(in) :: values(:), temperature
    type(flow_t) :: flow
    real(wp) :: absolute

    call moduli(values(1), values(2), flow%bulk, flow%shear)
    absolute = temperature + values(place_absolute)
    if (.not. absolute > 0) absolute = huge(absolute)   ! the caller refuses it
    flow%form = hardening_gsell
    flow%below = [values(3)*exp(values(7)/absolute), values(4), values(5), 0.0_wp]
    flow%rate_form = rate_power
    flow%rate(1) = values(6)
    flow%rate_row = row_of_rate
  end function gsell_jonas

end module law_viscous
