!> The return of every von Mises law: plastic or viscous, hardening by a curve, with or without backstress.
!>
!> With the driving stress s - X (deviator less backstress X = 2/3 HKIN times the back strain), q its von Mises measure:
!> q_trial - (3 G + HKIN) dp = flow(p + dp, dp/dt). The left falls and the right is not below zero, so that
!> 0 <= dp <= q_trial/(3 G + HKIN) holds a root, found by Newton's method kept inside the bracket; where flow depends
!> on the rate, in the logarithm of dp, since there dp may be any number of decades below the bracket's end.
!> Consistent tangent: J.C. Simo, R.L. Taylor, CMAME 48 (1985) 101-118; with backstress J.C. Simo, T.J.R. Hughes,
!> Computational Inelasticity (1998), box 3.2.
module radial_return
  use elasticity, only: hooke_stress, hooke_tangent
  use hardening, only: most_numbers, yield_between, yield_i, yield_linear
  use kinds, only: eps, wp
  use law_api, only: law_done, law_not_converged
  use rate_dependence, only: rate_factor, rate_none, rate_power, rate_within
  implicit none
  private
  public :: flow_t, return_point, flow_stress_at

  !> A trial beyond yield by less than this share is elastic: round-off of the stress itself.
  real(wp), parameter :: yield_tolerance = 8*eps
  !> The return is solved when the flow condition holds to this share of the trial stress; powers cost a few digits more.
  real(wp), parameter :: return_tolerance = 16*eps, rate_tolerance = 64*eps
  !> ln of the least dp sought where flow depends on the rate, over the bracket: less changes no strain by a digit.
  real(wp), parameter :: least_flow = 2*log(eps)

  !> Numbers of a point that flows, at its temperature.
  type :: flow_t
    real(wp) :: bulk = 0.0_wp, shear = 0.0_wp
    !> Form of hardening with numbers at the temperatures of the card below and above, and the share of the latter.
    procedure(yield_i), nopass, pointer :: yield => yield_linear
    real(wp) :: below(most_numbers) = 0.0_wp, above(most_numbers) = 0.0_wp, share = 0.0_wp
    !> Modulus of linear kinematic hardening [stress].
    real(wp) :: kinematic = 0.0_wp
    integer :: rate_form = rate_none
    !> Stress below which nothing flows, where the form of hardening holds the rate (rate_within): at no growth of the plastic
    !> strain it answers the stress at the rate of the start.
    real(wp) :: threshold = 0.0_wp
    real(wp) :: rate(2) = 0.0_wp
    !> Rows of the history: back strain (4 rows, then the stored work), plastic rate; 0 where they are not there.
    integer :: back_row = 0, rate_row = 0
  end type flow_t

contains

  !> One point: trial elastic strain to stress, elastic strain, history (plastic strain, plastic work, ...), tangent.
  pure subroutine return_point(flow, below, above, dt, trial_strain, committed, stress, elastic_strain, history, tangent, by_work, &
                               status)
    type(flow_t), intent(in) :: flow
    real(wp), intent(in) :: below(:, :)          !! (2, npoint) plastic strain [-], yield stress [stress] at the temperature below
    real(wp), intent(in) :: above(:, :)          !! (2, npoint) plastic strain [-], yield stress [stress] at the temperature above
    real(wp), intent(in) :: dt                   !! [time]
    real(wp), intent(in) :: trial_strain(4)      !! [-]
    real(wp), intent(in) :: committed(:)         !! (nhistory) [unit of each component]
    real(wp), intent(out) :: stress(4)           !! [stress]
    real(wp), intent(out) :: elastic_strain(4)   !! [-]
    real(wp), intent(out) :: history(:)          !! (nhistory) [unit of each component]
    real(wp), intent(out) :: tangent(4, 4)       !! [stress]
    real(wp), intent(out) :: by_work(4)          !! d(plastic work)/d(trial strain) [stress]
    integer, intent(out) :: status
    real(wp) :: driving(4), back(4), mean, q, g3, start, limit, factor, exponent, sy, slope, dp, rate

    status = law_done
    by_work = 0
    stress = hooke_stress(flow%bulk, flow%shear, trial_strain)
    elastic_strain = trial_strain
    history = committed
    if (flow%rate_row > 0 .and. dt > 0) history(flow%rate_row) = 0

    mean = (stress(1) + stress(2) + stress(4))/3
    driving = [stress(1) - mean, stress(2) - mean, stress(3), stress(4) - mean]
    g3 = 3*flow%shear
    start = 0
    if (flow%back_row > 0) then
      start = von_mises(driving)
      back = committed(flow%back_row:flow%back_row + 3)
      driving = driving - (2*flow%kinematic/3)*back
      g3 = g3 + flow%kinematic
      history(flow%back_row + 4) = stored_work(flow%kinematic, back)
    end if
    q = von_mises(driving)
    call yield_between(flow%yield, flow%below, flow%above, flow%share, below, above, committed(1), sy, slope)
    limit = sy
    if (flow%rate_form == rate_power) limit = 0
    if (flow%rate_form == rate_within) limit = flow%threshold
    ! in zero time (equilibrium restored on a new mesh) nothing flows
    if (q <= limit + yield_tolerance*(limit + start) .or. .not. dt > 0) then
      tangent = hooke_tangent(flow%bulk, flow%shear)
      return
    end if

    start = sy
    if (flow%rate_form == rate_none) then
      call return_at_rest(flow, below, above, committed(1), q, g3, dp, sy, slope, status)
    else
      ! a small share of an error of the state (path_stress) makes less than no rate of what has not flowed yet
      rate = max(committed(flow%rate_row), 0.0_wp)
      call rate_factor(flow%rate_form, flow%rate, rate, factor, exponent)
      start = start*factor
      dp = rate*dt
      call return_with_rate(flow, below, above, committed(1), q, g3, limit, dt, dp, sy, slope, status)
      history(flow%rate_row) = dp/dt
      if (.not. dp > 0) then
        tangent = hooke_tangent(flow%bulk, flow%shear)
        return
      end if
    end if
    factor = sy/q
    stress = [mean + driving(1)*factor, mean + driving(2)*factor, driving(3)*factor, mean + driving(4)*factor]
    factor = 1.5_wp*dp/q
    elastic_strain = trial_strain - factor*[driving(1), driving(2), 2*driving(3), driving(4)]
    history(1) = committed(1) + dp
    history(2) = committed(2) + 0.5_wp*(start + sy)*dp
    ! dq_trial = (g3 + slope) d dp, and 3 G/q times the driving deviator along the strain
    by_work = (0.5_wp*(start + sy + slope*dp)/(g3 + slope)*3*flow%shear/q)*driving
    if (flow%back_row > 0) then
      back = back + (1.5_wp*dp/q)*driving
      stress = stress + (2*flow%kinematic/3)*back
      history(flow%back_row:flow%back_row + 3) = back
      history(flow%back_row + 4) = stored_work(flow%kinematic, back)
    end if
    tangent = consistent_tangent(flow%bulk, flow%shear, driving/(q*sqrt(2.0_wp/3)), dp, q, slope + flow%kinematic)
  end subroutine return_point

  !> Stress to flow at a plastic strain and rate.
  pure function flow_stress_at(flow, below, above, p, rate) result(stress)
    type(flow_t), intent(in) :: flow
    real(wp), intent(in) :: below(:, :)   !! (2, npoint) plastic strain [-], yield stress [stress] at the temperature below
    real(wp), intent(in) :: above(:, :)   !! (2, npoint) plastic strain [-], yield stress [stress] at the temperature above
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(in) :: rate          !! [1/time]
    real(wp) :: stress
    real(wp) :: slope, factor, exponent

    call yield_between(flow%yield, flow%below, flow%above, flow%share, below, above, p, stress, slope)
    call rate_factor(flow%rate_form, flow%rate, rate, factor, exponent)
    stress = stress*factor
  end function flow_stress_at

  !> Plastic strain increment `dp`, with the yield stress and slope reached.
  pure subroutine return_at_rest(flow, below, above, p, q, g3, dp, sy, slope, status)
    type(flow_t), intent(in) :: flow
    real(wp), intent(in) :: below(:, :), above(:, :), p, q, g3
    real(wp), intent(out) :: dp, sy, slope
    integer, intent(inout) :: status
    real(wp) :: lower, upper, residual, step
    integer :: iteration
    integer, parameter :: max_iterations = 60  ! bisection alone reaches round-off in 53

    lower = 0
    upper = q/g3
    dp = 0
    do iteration = 1, max_iterations
      call yield_between(flow%yield, flow%below, flow%above, flow%share, below, above, p + dp, sy, slope)
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
  end subroutine return_at_rest

  !> The same with flow by rate, `sy` and `slope` = d sy/d dp with the factor of the rate; dp = 0 where it is below round-off. It is
  !> sought from the dp given, that of the rate of the last step.
  !>
  !> Unknown z = ln(dp g3/q) < 0. Newton's method takes the residual of the logarithms of both sides while flow is a small part
  !> of the trial strain (a power is straight there), and the residual itself where it is most of it.
  pure subroutine return_with_rate(flow, below, above, p, q, g3, limit, dt, dp, sy, slope, status)
    type(flow_t), intent(in) :: flow
    real(wp), intent(in) :: below(:, :), above(:, :), p, q, g3, limit, dt
    real(wp), intent(inout) :: dp
    real(wp), intent(out) :: sy, slope
    integer, intent(inout) :: status
    real(wp) :: lower, upper, z, begin, share, residual, growth, factor, exponent, step
    integer :: iteration
    integer, parameter :: max_iterations = 100  ! bisection alone reaches round-off of z in 60

    lower = least_flow
    upper = 0
    begin = upper
    if (dp > 0) begin = log(dp*g3/q)
    z = lower
    do iteration = 1, max_iterations
      share = exp(z)
      dp = share*q/g3
      call yield_between(flow%yield, flow%below, flow%above, flow%share, below, above, p + dp, sy, slope)
      call rate_factor(flow%rate_form, flow%rate, dp/dt, factor, exponent)
      slope = slope*factor
      sy = sy*factor
      if (dp > 0) slope = slope + exponent*sy/dp
      residual = q*(1 - share) - sy
      if (iteration == 1) then
        if (residual <= 0) dp = 0
        if (residual <= 0) return
        z = log(0.5_wp)
        if (limit > 0) z = log(1 - limit/q)
        if (begin > lower .and. begin < upper) z = begin
        if (.not. (z > lower .and. z < upper)) z = 0.5_wp*(lower + upper)
        cycle
      end if
      if (abs(residual) <= rate_tolerance*q) return
      if (residual > 0) then
        lower = z
      else
        upper = z
      end if
      if (upper - lower <= 4*eps*abs(lower)) return
      growth = slope*dp
      if (share < 0.5_wp .and. sy > 0) then
        step = -log(sy/(q*(1 - share)))/(growth/sy + share/(1 - share))
      else
        step = residual/(growth + q*share)
      end if
      if (z + step > lower .and. z + step < upper) then
        z = z + step
      else
        z = 0.5_wp*(lower + upper)
      end if
    end do
    status = law_not_converged
  end subroutine return_with_rate

  !> d stress / d trial strain; `direction` is the unit deviator of flow, `slope` d(flow stress + backstress)/dp.
  pure function consistent_tangent(bulk, shear, direction, dp, q, slope) result(tangent)
    real(wp), intent(in) :: bulk, shear, direction(4), dp, q, slope
    real(wp) :: tangent(4, 4)
    real(wp) :: theta, theta_bar, along
    integer :: i, j

    theta = 1 - 3*shear*dp/q
    theta_bar = 3*shear/(3*shear + slope) - (1 - theta)
    tangent = hooke_tangent(bulk, shear*theta)
    do j = 1, 4
      along = 2*shear*theta_bar*direction(j)
      do i = 1, 4
        tangent(i, j) = tangent(i, j) - along*direction(i)
      end do
    end do
  end function consistent_tangent

  !> Work kept by the backstress: 1/3 HKIN (back strain : back strain).
  pure function stored_work(modulus, back) result(work)
    real(wp), intent(in) :: modulus, back(4)
    real(wp) :: work

    work = (modulus/3)*(back(1)**2 + back(2)**2 + back(4)**2 + 2*back(3)**2)
  end function stored_work

  pure function von_mises(deviator) result(q)
    real(wp), intent(in) :: deviator(4)
    real(wp) :: q

    q = sqrt(1.5_wp*(deviator(1)**2 + deviator(2)**2 + deviator(4)**2 + 2*deviator(3)**2))
  end function von_mises

end module radial_return
