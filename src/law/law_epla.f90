!> EPLA: von Mises elastoplasticity with isotropic hardening.
!>
!> Radial return: q_trial - 3 G dp = sigma_y(p + dp), solved by a Newton iteration kept inside the
!> bracket 0 <= dp <= q_trial/(3 G), which always holds a root for a hardening or mildly softening
!> curve. Consistent tangent: J.C. Simo, R.L. Taylor, CMAME 48 (1985) 101-118.
module law_epla
  use elasticity, only: hooke_stress, hooke_tangent, moduli
  use hardening, only: yield_stress
  use kinds, only: eps, wp
  use law_api, only: law_done, law_line, law_not_converged, law_t, parameter
  use materials, only: material_t, values_at
  use state_variables, only: state_variable, transfer_scalar
  implicit none
  private
  public :: law_epla_row

  !> Places of the numbers in a material's values: E, nu, form, then the numbers of each form.
  integer, parameter :: place_form = 3
  integer, parameter :: place_numbers(4) = [4, 6, 10, 13]
  !> A trial beyond yield by less than this share is elastic: round-off of the stress itself.
  real(wp), parameter :: yield_tolerance = 8*eps
  !> The return is solved when the yield condition holds to this share of the trial stress.
  real(wp), parameter :: return_tolerance = 16*eps

contains

  function law_epla_row() result(row)
    type(law_t) :: row

    row%name = 'EPLA'
    row%number = 55
    row%purpose = 'von Mises elastoplasticity, isotropic hardening'
    row%source = 'Simo and Taylor 1985 (radial return, consistent tangent)'
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
                          word='TABLE', curve=.true.)])
    row%history = [state_variable('plastic_strain', '-', transfer_scalar), &
                   state_variable('plastic_work', 'stress', transfer_scalar)]
    row%effects = 'plasticity'
    row%update => update
    row%flow_stress => flow_stress
  end function law_epla_row

  pure subroutine update(material, dt, temperature, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(:, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: bulk, shear, hooke(4, 4), a(4)
    real(wp) :: deviator(4), mean, q, sy, sy_start, slope, dp
    integer :: n, form

    call moduli(material%values(1), material%values(2), bulk, shear)
    hooke = hooke_tangent(bulk, shear)
    call numbers_of_form(material%values, form, a)

    do n = 1, size(trial_strain, 2)
      status(n) = law_done
      stress(:, n) = hooke_stress(bulk, shear, trial_strain(:, n))
      elastic_strain(:, n) = trial_strain(:, n)
      history(:, n) = committed(:, n)
      tangent(:, :, n) = hooke

      mean = (stress(1, n) + stress(2, n) + stress(4, n))/3
      deviator = stress(:, n) - mean*[1, 1, 0, 1]
      q = sqrt(1.5_wp*(deviator(1)**2 + deviator(2)**2 + deviator(4)**2 + 2*deviator(3)**2))
      call yield_stress(form, a, material%curve, committed(1, n), sy, slope)
      if (q <= sy*(1 + yield_tolerance)) cycle

      sy_start = sy
      call return_to_yield(form, a, material%curve, committed(1, n), q, 3*shear, dp, sy, slope, status(n))
      stress(:, n) = mean*[1, 1, 0, 1] + deviator*(sy/q)
      elastic_strain(:, n) = trial_strain(:, n) - (1.5_wp*dp/q)*deviator*[1, 1, 2, 1]
      history(1, n) = committed(1, n) + dp
      history(2, n) = committed(2, n) + 0.5_wp*(sy_start + sy)*dp
      tangent(:, :, n) = consistent_tangent(bulk, shear, deviator/(q*sqrt(2.0_wp/3)), dp, q, slope)
    end do
  end subroutine update

  !> The form of hardening and its numbers.
  pure subroutine numbers_of_form(values, form, a)
    real(wp), intent(in) :: values(:)
    integer, intent(out) :: form
    real(wp), intent(out) :: a(4)
    integer :: first, last

    form = nint(values(place_form))
    first = place_numbers(form)
    last = min(first + 3, size(values))
    a = 0
    a(:last - first + 1) = values(first:last)
  end subroutine numbers_of_form

  !> Yield stress at the plastic strain reached.
  pure function flow_stress(material, temperature, history) result(flow)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature, history(:)
    real(wp) :: flow
    real(wp) :: a(4), values(size(material%values)), slope
    integer :: form

    call values_at(material, temperature, values)
    call numbers_of_form(values, form, a)
    call yield_stress(form, a, material%curve, history(1), flow, slope)
  end function flow_stress

  !> Plastic strain increment `dp`, with the yield stress and slope reached.
  pure subroutine return_to_yield(form, a, curve, p, q, g3, dp, sy, slope, status)
    integer, intent(in) :: form
    real(wp), intent(in) :: a(4), curve(:, :), p, q, g3
    real(wp), intent(out) :: dp, sy, slope
    integer, intent(inout) :: status
    real(wp) :: lower, upper, residual, step
    integer :: iteration
    integer, parameter :: max_iterations = 60  ! bisection alone reaches round-off in 53

    lower = 0
    upper = q/g3
    dp = 0
    do iteration = 1, max_iterations
      call yield_stress(form, a, curve, p + dp, sy, slope)
      residual = q - g3*dp - sy
      if (abs(residual) <= return_tolerance*q) return
      if (residual > 0) then
        lower = dp
      else
        upper = dp
      end if
      if (upper - lower <= 4*eps*upper) return
      step = residual/(g3 + slope)
      if (g3 + slope > 0 .and. dp + step > lower .and. dp + step < upper) then
        dp = dp + step
      else
        dp = 0.5_wp*(lower + upper)
      end if
    end do
    status = law_not_converged
  end subroutine return_to_yield

  !> d stress / d trial strain; `flow` is the unit deviator (flow : flow = 1).
  pure function consistent_tangent(bulk, shear, flow, dp, q, slope) result(tangent)
    real(wp), intent(in) :: bulk, shear, flow(4), dp, q, slope
    real(wp) :: tangent(4, 4)
    real(wp) :: theta, theta_bar
    integer :: j

    theta = 1 - 3*shear*dp/q
    theta_bar = 3*shear/(3*shear + slope) - (1 - theta)
    tangent = hooke_tangent(bulk, shear*theta)
    do j = 1, 4
      tangent(:, j) = tangent(:, j) - 2*shear*theta_bar*flow*flow(j)
    end do
  end function consistent_tangent

end module law_epla
