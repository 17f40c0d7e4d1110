!> COUL2D (94): unilateral contact with Coulomb friction by penalties (annex 3, eqs. 2-7).
!>
!> p = augmentation + AKP d where positive; stick dtau = AKTAU ds; slip |tau| = min(PHI p + PBOUE, TAUMAX,
!> M flow_stress/sqrt3), each limit where it is given (M: constant-factor law, Tresca's friction). Where M stands without PHI, PHI
!> is `steepest`, and of PBOUE there is `steepest` p where that is less: a point that just touches would have all of its friction
!> at once, and a step in which its pressure goes to zero need not have an equilibrium; nor need it with large coefficients of
!> friction: in the plane one is known to exist below
!> sqrt(3 - 4 nu)/(2 - 2 nu) (C. Eck, J. Jarusek, Math. Models Methods Appl. Sci. 8 (1998) 445), .96 at nu = .3 and 1 where
!> volume cannot change, as in flow. A die that rocks on a block finds none at any step with 5, but does with PHI 1 beside M: what a
!> run that stops gives as advice (run_stop). It is no default: walls that are hardly pressed, as of a container, would rub less
!> than M says;
!> non-associated: no opening by slip. The slip tangent dtau = PHI AKP sign(tau) dd is unsymmetric.
module law_coul2d
  use contact_penalties, only: penalty_parameters, penalty_problems
  use kinds, only: wp
  use law_api, only: contact_law, contact_open, contact_slip, contact_stick, law_line, law_t, parameter
  use materials, only: material_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_coul2d_row

  !> Numbers among the values of a material, after the penalties; and that of the flow stress among the drivers.
  integer, parameter :: place_phi = 5, place_cohesion = 6, place_largest = 7, place_factor = 8, driver_flow = 2

  !> Coefficient of friction up to the limit M where PHI is not given: friction is the limit from M flow_stress/8.7 of pressure on.
  !> So is it that of the cohesion, which is PBOUE from a pressure of a fifth of it on.
  real(wp), parameter :: steepest = 5.0_wp

contains

  function law_coul2d_row() result(row)
    type(law_t) :: row

    row%name = 'COUL2D'
    row%number = 94
    row%kind = contact_law
    row%purpose = 'contact with Coulomb friction'
    row%source = 'Charlier; seed, annex 3'
    allocate (row%lines, source=[law_line([penalty_parameters(), &
                                           parameter('PHI', '-', 'friction coefficient (5 where M stands alone)', lower=0.0_wp, &
                                                     default=huge(1.0_wp)), &
                                           parameter('PBOUE', 'stress', 'cohesion, at most 5 times the pressure', lower=0.0_wp, &
                                                     default=0.0_wp), &
                                           parameter('TAUMAX', 'stress', 'largest friction stress', &
                                                     above=0.0_wp, default=huge(1.0_wp)), &
                                           parameter('M', '-', 'friction factor: largest friction over the shear flow stress', &
                                                     lower=0.0_wp, upper=1.0_wp, default=huge(1.0_wp))], pairs=.true.)])
    allocate (row%history(0))
    allocate (row%drivers(1))
    row%drivers(driver_flow - 1)%name = 'flow_stress'
    row%symmetric = .false.
    row%effects = 'contact friction'
    row%slide => slide
    row%friction_coefficient => friction_coefficient
    row%check => check
  end function law_coul2d_row

  !> Friction must be given, if only as zero.
  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    allocate (problems(0))
    if (len(penalty_problems(material)) > 0) call add_text(problems, penalty_problems(material))
    if (.not. min(material%values(place_phi), material%values(place_factor)) < huge(1.0_wp)) &
      call add_text(problems, 'neither PHI nor M is given: one of them says what friction there is (PHI 0. for none)')
  end subroutine check

  !> PHI; with cohesion a point that is hardly pressed has friction too.
  pure function friction_coefficient(material) result(coefficient)
    type(material_t), intent(in) :: material
    real(wp) :: coefficient

    coefficient = huge(1.0_wp)
    if (material%values(place_cohesion) > 0) return
    if (material%values(place_phi) > 0) coefficient = material%values(place_phi)
  end function friction_coefficient

  !> In slip, with the direction n = trial/|trial|: tau = limit n, and d tau = n PHI AKP dd + limit/|trial| AKTAU (1 - n n) ds,
  !> the derivative of the discrete update: eq. (7), which is its limit for small steps.
  pure subroutine slide(material, dt, drivers, penalty, augmentation, penetration, slip, tau_committed, committed, pressure, tau, &
                        history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :), penalty(2), augmentation, penetration, slip(2), tau_committed(2), committed(:)
    real(wp), intent(out) :: pressure, tau(2), history(:), tangent(3, 3)
    integer, intent(out) :: status
    real(wp) :: limit, size_of_trial, trial(2), direction(2), phi, cohesion, tau_max
    logical :: by_pressure

    history = committed
    tau = 0
    tangent = 0
    status = contact_open
    pressure = augmentation + penalty(1)*penetration
    ! a point that just touches is closed: it has the stiffness of contact before it has a pressure
    if (pressure < 0) then
      pressure = 0
      return
    end if
    phi = material%values(place_phi)
    if (.not. phi < huge(1.0_wp)) phi = steepest
    cohesion = material%values(place_cohesion)
    tau_max = material%values(place_largest)
    if (material%values(place_factor) < huge(1.0_wp)) &
      tau_max = min(tau_max, material%values(place_factor)*drivers(driver_flow, 2)/sqrt(3.0_wp))
    tangent(1, 1) = penalty(1)
    trial = tau_committed + penalty(2)*slip
    size_of_trial = sqrt(dot_product(trial, trial))
    limit = tau_max
    if (cohesion > steepest*pressure) then
      phi = phi + steepest
      cohesion = 0
    end if
    by_pressure = phi*pressure + cohesion < tau_max
    if (by_pressure) limit = phi*pressure + cohesion
    if (size_of_trial <= limit) then
      status = contact_stick
      tau = trial
      tangent(2, 2) = penalty(2)
      tangent(3, 3) = penalty(2)
    else
      status = contact_slip
      direction = trial/size_of_trial
      tau = limit*direction
      if (by_pressure) tangent(2:3, 1) = phi*penalty(1)*direction
      associate (share => limit/size_of_trial*penalty(2))
        tangent(2, 2:3) = share*[direction(2)**2, -direction(1)*direction(2)]
        tangent(3, 2:3) = share*[-direction(1)*direction(2), direction(1)**2]
      end associate
    end if
  end subroutine slide

end module law_coul2d
