!> EPLA: von Mises elastoplasticity, isotropic hardening by a curve, and if wanted by HKIN linear kinematic hardening
!> (Prager), and by COWPER or JOHNSON a yield stress that grows with the rate; all numbers by temperature.
!>
!> Between two temperatures of the card the yield stress is linear. The backstress is 2/3 HKIN times the back strain, so that
!> the work it keeps is a function of the state; `plastic_work` is what is dissipated, `stored_work` what is kept.
module law_epla
  use elastic_numbers, only: elastic_of_card, elastic_parameters, place_poisson, place_young
  use elasticity, only: moduli
  use hardening, only: yield_linear, yield_swift, yield_table, yield_voce
  use kinds, only: wp
  use law_api, only: driver_temperature, find_parameter, law_line, law_t, parameter, row_of_work
  use materials, only: bracket_temperature, has_number, material_t, values_at
  use radial_return, only: flow_stress_at, flow_t, return_point
  use rate_dependence, only: rate_cowper, rate_johnson
  use state_variables, only: state_variable, transfer_scalar, transfer_tensor
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: law_epla_row

  !> Forms of hardening in the order of their lines, and how many numbers each has.
  integer, parameter :: linear = 1, voce = 2, swift = 3, table = 4
  integer, parameter :: form_numbers(4) = [2, 4, 3, 1]
  !> Numbers among the values of a material: after E and NU the form, the numbers of all forms, then the pairs.
  integer, parameter :: place_form = 3
  integer, parameter :: place_numbers(4) = place_form + 1 + [0, 2, 6, 9]
  integer, parameter :: place_kinematic = place_form + sum(form_numbers) + 1, place_rate = place_kinematic + 1, &
                        place_cowper = place_kinematic + 2, place_johnson = place_kinematic + 3
  !> Rows of the history that come after plastic strain and plastic work.
  integer, parameter :: first_option = 3, rows_of_backstress = 5

contains

  function law_epla_row() result(row)
    type(law_t) :: row

    row%name = 'EPLA'
    row%number = 55
    row%purpose = 'von Mises elastoplasticity, isotropic and linear kinematic hardening, rate'
    row%source = 'Simo and Taylor 1985 (radial return, consistent tangent); Prager; Cowper and Symonds; Johnson and Cook'
    allocate (row%lines, source=[law_line(elastic_parameters()), &
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
                          word='TABLE', abscissa='the plastic strain', ordinate='the yield stress'), &
                 law_line([parameter('HKIN', 'stress', 'modulus of kinematic hardening', lower=0.0_wp, default=0.0_wp), &
                           parameter('RATE0', '1/time', 'reference rate of COWPER or JOHNSON', lower=0.0_wp, default=0.0_wp, &
                                     turns_on=.true.), &
                           parameter('COWPER', '-', 'P: yield times 1 + (rate/RATE0)^(1/P)', lower=0.0_wp, default=0.0_wp, &
                                     turns_on=.true.), &
                           parameter('JOHNSON', '-', 'C: yield times 1 + C ln(rate/RATE0), not below 1', lower=0.0_wp, &
                                     default=0.0_wp, turns_on=.true.)], pairs=.true.)])
    allocate (row%history(5))
    row%history(1) = state_variable('plastic_strain', '-', transfer_scalar)
    row%history(2) = state_variable('plastic_work', 'stress', transfer_scalar)
    row%history(3) = state_variable('back_strain', '-', transfer_tensor, 4, needs=find_parameter(row, 'HKIN'))
    row%history(4) = state_variable('stored_work', 'stress', transfer_scalar, needs=find_parameter(row, 'HKIN'))
    row%history(5) = state_variable('plastic_rate', '1/time', transfer_scalar, needs=find_parameter(row, 'RATE0'))
    row%effects = 'plasticity'
    row%update => update
    row%flow_stress => flow_stress
    row%elastic => elastic_of_card
    row%check => check
  end function law_epla_row

  !> A table begins at 0 with stresses above 0; the effect of the rate has its reference and one form.
  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)
    logical :: rate, cowper, johnson

    allocate (problems(0))
    if (size(material%curve, 2) > 0) then
      if (abs(material%curve(1, 1)) > 0) then
        call add_text(problems, 'the first plastic strain of the table must be 0, found '//to_text(material%curve(1, 1)))
      else if (any(.not. material%curve(2, :) > 0)) then
        call add_text(problems, 'all yield stresses of the table must be above 0, found '//to_text(minval(material%curve(2, :))))
      end if
    end if
    rate = material%values(place_rate) > 0
    cowper = material%values(place_cowper) > 0
    johnson = material%values(place_johnson) > 0
    if ((cowper .or. johnson) .and. .not. rate) then
      call add_text(problems, 'COWPER and JOHNSON need a RATE0 above 0')
    else if (rate .and. (cowper .eqv. johnson)) then
      call add_text(problems, 'RATE0 wants one of COWPER and JOHNSON above 0')
    end if
  end subroutine check

  pure subroutine update(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    type(flow_t) :: flow
    real(wp) :: values(size(material%values)), by_work(4)
    integer :: n, k

    flow = options_of(material)
    if (.not. allocated(material%temperatures)) then
      call numbers_of(material%values, flow)
      do n = 1, size(trial_strain, 2)
        call return_point(flow, material%curve, material%curve, dt, trial_strain(:, n), committed(:, n), stress(:, n), &
                          elastic_strain(:, n), history(:, n), tangent(:4, :, n), by_work, status(n))
        if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :, n) = by_work
      end do
    else
      do n = 1, size(trial_strain, 2)
        call numbers_at(material, drivers(driver_temperature, 2, n), values, flow, k)
        call return_point(flow, material%curves(:, :, k), material%curves(:, :, min(k + 1, size(material%curves, 3))), dt, &
                          trial_strain(:, n), committed(:, n), stress(:, n), elastic_strain(:, n), history(:, n), &
                          tangent(:4, :, n), by_work, status(n))
        if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :, n) = by_work
      end do
    end if
  end subroutine update

  !> Yield stress at the plastic strain and the rate reached.
  pure function flow_stress(material, drivers, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:), history(:)
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
      call numbers_at(material, drivers(driver_temperature), values, flow, k)
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
    integer :: form

    call moduli(values(place_young), values(place_poisson), flow%bulk, flow%shear)
    form = nint(values(place_form))
    select case (form)
    case (voce)
      flow%yield => yield_voce
    case (swift)
      flow%yield => yield_swift
    case (table)
      flow%yield => yield_table
    case default
      flow%yield => yield_linear
    end select
    flow%below(:form_numbers(form)) = values(place_numbers(form):place_numbers(form) + form_numbers(form) - 1)
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
    integer :: form, first, last

    call values_at(material, temperature, values)
    call numbers_of(values, flow)
    call bracket_temperature(material, temperature, k, flow%share)
    form = nint(values(place_form))
    first = place_numbers(form)
    last = first + form_numbers(form) - 1
    flow%below(:form_numbers(form)) = material%values_by_temperature(first:last, k)
    flow%above(:form_numbers(form)) = material%values_by_temperature(first:last, min(k + 1, size(material%temperatures)))
  end subroutine numbers_at

end module law_epla
