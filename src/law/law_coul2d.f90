!> COUL2D (94): unilateral contact with Coulomb friction by penalties (annex 3, eqs. 2-7).
!>
!> p = augmentation + AKP d where positive; stick dtau = AKTAU ds; slip |tau| = min(PHI p + PBOUE, TAUMAX),
!> non-associated: no opening by slip. The slip tangent dtau = PHI AKP sign(tau) dd is unsymmetric.
module law_coul2d
  use contact_penalties, only: penalty_parameters
  use kinds, only: wp
  use law_api, only: contact_law, contact_open, contact_slip, contact_stick, law_line, law_t, parameter
  use materials, only: material_t
  implicit none
  private
  public :: law_coul2d_row

contains

  function law_coul2d_row() result(row)
    type(law_t) :: row

    row%name = 'COUL2D'
    row%number = 94
    row%kind = contact_law
    row%purpose = 'contact with Coulomb friction'
    row%source = 'Charlier; seed, annex 3'
    allocate (row%lines, source=[law_line([penalty_parameters(), &
                                           parameter('PHI', '-', 'friction coefficient', lower=0.0_wp), &
                                           parameter('PBOUE', 'stress', 'cohesion', lower=0.0_wp, default=0.0_wp), &
                                           parameter('TAUMAX', 'stress', 'largest friction stress', &
                                                     above=0.0_wp, default=huge(1.0_wp))], pairs=.true.)])
    allocate (row%history(0))
    row%symmetric = .false.
    row%effects = 'contact friction'
    row%slide => slide
  end function law_coul2d_row

  pure subroutine slide(material, penalty, augmentation, penetration, slip, tau_committed, pressure, tau, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: penalty(2), augmentation, penetration, slip, tau_committed
    real(wp), intent(out) :: pressure, tau, tangent(2, 2)
    integer, intent(out) :: status
    real(wp) :: limit, trial, phi, cohesion, tau_max

    tau = 0
    tangent = 0
    status = contact_open
    pressure = augmentation + penalty(1)*penetration
    if (.not. pressure > 0) then
      pressure = 0
      return
    end if
    phi = material%values(5)
    cohesion = material%values(6)
    tau_max = material%values(7)
    tangent(1, 1) = penalty(1)
    trial = tau_committed + penalty(2)*slip
    limit = min(phi*pressure + cohesion, tau_max)
    if (abs(trial) <= limit) then
      status = contact_stick
      tau = trial
      tangent(2, 2) = penalty(2)
    else
      status = contact_slip
      tau = sign(limit, trial)
      if (limit < tau_max) tangent(2, 1) = sign(phi*penalty(1), trial)
    end if
  end subroutine slide

end module law_coul2d
