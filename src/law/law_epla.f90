!> EPLA: von Mises elastoplasticity, isotropic hardening by a curve, and if wanted by HKIN linear kinematic hardening
!> (Prager), and by COWPER or JOHNSON a yield stress that grows with the rate; all numbers by temperature.
!>
!> Between two temperatures of the card the yield stress is linear. The backstress is 2/3 HKIN times the back strain, so that
!> the work it keeps is a function of the state; `plastic_work` is what is dissipated, `stored_work` what is kept.
module law_epla
  use elasticity, only: moduli
  use kinds, only: wp
  use law_api, only: find_parameter, law_line, law_t, parameter
  use materials, only: bracket_temperature, has_number, material_t, values_at
  use radial_return, only: flow_stress_at, flow_t, return_point
  use rate_dependence, only: rate_cowper, rate_johnson
  use state_variables, only: state_variable, transfer_scalar, transfer_tensor
  implicit none
  private
  public :: law_epla_row

  !> Places of the numbers in a material's values: E, nu, form, the numbers of each form, HKIN, RATE0, COWPER, JOHNSON.
  integer, parameter :: place_form = 3
  integer, parameter :: place_numbers(4) = [4, 6, 10, 13]
  integer, parameter :: place_kinematic = 14, place_rate = 15, place_cowper = 16, place_johnson = 17
  !> Rows of the history that come after plastic strain and plastic work.
  integer, parameter :: first_option = 3, rows_of_backstress = 5

contains

  function law_epla_row() result(row)
    type(law_t) :: row

    row%name = 'EPLA'
    row%number = 55
    row%purpose = 'von Mises elastoplasticity, isotropic and linear kinematic hardening, rate'
    row%source = 'Simo and Taylor 1985 (radial return, consistent tangent); Prager; Cowper and Symonds; Johnson and Cook'
    allocate (row%lines, source=[law_line([parameter('E', 'stress', 'Young''s modulus', above=0.0_wp), &
                           parameter('NU', '-', 'Poisson''s ratio', lower=0.0_wp, upper=0.499999_wp)]), &
                 law_line([parameter('RE', 'stress', 'yield stress', above=0.0_wp), &
                           parameter('ET', 'stress', 'plastic modulus d(yield)/d(plastic strain)', lower=0.0_wp)], &
                          word='LINEAR'), &
                 law_line([parameter('RE', 'stress', 'yield stress', above=0.0_wp), &
                           parameter('Q', 'stress', 'rise at saturation', lower=0.0_wp), &
                           parameter('B', '-', 'rate of saturation', lower=0.0_wp), &
                           parameter('ET', 'stress', 'plastic modulus that remains', lower=0.0_wp)], word='VOCE'), &
                 law_line([parameter('K', 'stress', 'yield = K (E0 + p)^N', above=0.0_wp), &
                           parameter('E0', '-', 'strain offset', above=0.0_wp), &
                           parameter('N', '-', 'exponent', lower=0.0_wp, upper=1.0_wp)], word='SWIFT'), &
                 law_line([parameter('NPOINT', '-', 'rows: plastic strain, yield stress', lower=1.0_wp)], &
                          word='TABLE', curve=.true.), &
                 law_line([parameter('HKIN', 'stress', 'modulus of kinematic hardening', lower=0.0_wp, default=0.0_wp), &
                           parameter('RATE0', '1/time', 'reference rate of COWPER or JOHNSON', lower=0.0_wp, default=0.0_wp), &
                           parameter('COWPER', '-', 'P: yield times 1 + (rate/RATE0)^(1/P)', lower=0.0_wp, default=0.0_wp), &
                           parameter('JOHNSON', '-', 'C: yield times 1 + C ln(rate/RATE0), not below 1', lower=0.0_wp, &
                                     default=0.0_wp)], pairs=.true.)])
    allocate (row%history(5))
    row%history(1) = state_variable('plastic_strain', '-', transfer_scalar)
    row%history(2) = state_variable('plastic_work', 'stress', transfer_scalar)
    row%history(3) = state_variable('back_strain', '-', transfer_tensor, 4, needs=find_parameter(row, 'HKIN'))
    row%history(4) = state_variable('stored_work', 'stress', transfer_scalar, needs=find_parameter(row, 'HKIN'))
    row%history(5) = state_variable('plastic_rate', '1/time', transfer_scalar, needs=find_parameter(row, 'RATE0'))
    row%effects = 'plasticity'
    row%update => update
    row%flow_stress => flow_stress
  end function law_epla_row

  pure subroutine update(material, dt, temperature, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(:, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    type(flow_t) :: flow
    real(wp) :: values(size(material%values))
    integer :: n, k

    flow = options_of(material)
    if (.not. allocated(material%temperatures)) then
      call numbers_of(material%values, flow)
      do n = 1, size(trial_strain, 2)
        call return_point(flow, material%curve, material%curve, dt, trial_strain(:, n), committed(:, n), stress(:, n), &
                          elastic_strain(:, n), history(:, n), tangent(:, :, n), status(n))
      end do
    else
      do n = 1, size(trial_strain, 2)
        call numbers_at(material, temperature(2, n), values, flow, k)
        call return_point(flow, material%curves(:, :, k), material%curves(:, :, min(k + 1, size(material%curves, 3))), dt, &
                          trial_strain(:, n), committed(:, n), stress(:, n), elastic_strain(:, n), history(:, n), &
                          tangent(:, :, n), status(n))
      end do
    end if
  end subroutine update

  !> Yield stress at the plastic strain and the rate reached.
  pure function flow_stress(material, temperature, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature, history(:)
    real(wp) :: stress
    type(flow_t) :: flow
    real(wp) :: values(size(material%values)), rate
    integer :: k

    flow = options_of(material)
    rate = 0
    if (flow%rate_row > 0) rate = history(flow%rate_row)
    if (.not. allocated(material%temperatures)) then
      call numbers_of(material%values, flow)
      stress = flow_stress_at(flow, material%curve, material%curve, history(1), rate)
    else
      call numbers_at(material, temperature, values, flow, k)
      stress = flow_stress_at(flow, material%curves(:, :, k), material%curves(:, :, min(k + 1, size(material%curves, 3))), &
                              history(1), rate)
    end if
  end function flow_stress

  !> What the material has beyond isotropic hardening, the same for all its points.
  pure function options_of(material) result(flow)
    type(material_t), intent(in) :: material
    type(flow_t) :: flow
    integer :: next

    next = first_option
    if (has_number(material, place_kinematic)) then
      flow%back_row = next
      next = next + rows_of_backstress
    end if
    if (.not. has_number(material, place_rate)) return
    flow%rate_row = next
    flow%rate_form = rate_cowper
    if (has_number(material, place_johnson)) flow%rate_form = rate_johnson
  end function options_of

  !> Numbers from the values of a material.
  pure subroutine numbers_of(values, flow)
    real(wp), intent(in) :: values(:)
    type(flow_t), intent(inout) :: flow

    call moduli(values(1), values(2), flow%bulk, flow%shear)
    flow%form = nint(values(place_form))
    flow%below = values(place_numbers(flow%form):place_numbers(flow%form) + 3)
    flow%kinematic = values(place_kinematic)
    flow%rate = [values(place_rate), values(merge(place_johnson, place_cowper, flow%rate_form == rate_johnson))]
  end subroutine numbers_of

  !> Numbers at a temperature, which lies above the k-th of the card.
  pure subroutine numbers_at(material, temperature, values, flow, k)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    real(wp), intent(out) :: values(:)
    type(flow_t), intent(inout) :: flow
    integer, intent(out) :: k
    integer :: first

    call values_at(material, temperature, values)
    call numbers_of(values, flow)
    call bracket_temperature(material, temperature, k, flow%share)
    first = place_numbers(flow%form)
    flow%below = material%values_by_temperature(first:first + 3, k)
    flow%above = material%values_by_temperature(first:first + 3, min(k + 1, size(material%temperatures)))
  end subroutine numbers_at

end module law_epla
