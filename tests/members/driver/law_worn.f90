!> WORN: friction of Coulomb whose coefficient falls with the temperature and grows with the way slipped, as a coating wears off.
!>
!> |tau| <= PHI0 p (1 - SOFT T) (1 + RISE (1 - exp(-s/WAY))), T the temperature at the end of the step, s the way at its start.
module law_worn
  use contact_penalties, only: penalty_parameters, penalty_problems
  use kinds, only: wp
  use law_api, only: contact_law, contact_open, contact_slip, contact_stick, driver_temperature, law_line, law_t, parameter
  use materials, only: material_t
  use state_variables, only: state_variable, transfer_contact
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_worn_row

  integer, parameter :: place_phi = 5, place_soft = 6, place_rise = 7, place_way = 8

contains

  function law_worn_row() result(row)
    type(law_t) :: row

    row%name = 'WORN'
    row%number = 9501
    row%kind = contact_law
    row%purpose = 'friction that a coating loses on its way'
    row%source = 'made for the test'
    allocate (row%lines, source=[law_line([penalty_parameters(), &
                                           parameter('PHI0', '-', 'coefficient at the start', lower=0.0_wp), &
                                           parameter('SOFT', '1/temperature', 'fall by temperature', lower=0.0_wp), &
                                           parameter('RISE', '-', 'rise without the coating', lower=0.0_wp), &
                                           parameter('WAY', 'length', 'way that wears it off', above=0.0_wp)], pairs=.true.)])
    allocate (row%history, source=[state_variable('worn_way', 'length', transfer_contact)])
    row%symmetric = .false.
    row%effects = 'contact friction'
    row%slide => slide
    row%check => check
  end function law_worn_row

  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    allocate (problems(0))
    if (len(penalty_problems(material)) > 0) call add_text(problems, penalty_problems(material))
  end subroutine check

  pure subroutine slide(material, dt, drivers, penalty, augmentation, penetration, slip, tau_committed, committed, pressure, tau, &
                        history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :), penalty(2), augmentation, penetration, slip(2), tau_committed(2), committed(:)
    real(wp), intent(out) :: pressure, tau(2), history(:), tangent(3, 3)
    integer, intent(out) :: status
    real(wp) :: phi, trial

    history = committed
    tau = 0
    tangent = 0
    status = contact_open
    pressure = augmentation + penalty(1)*penetration
    if (pressure < 0) then
      pressure = 0
      return
    end if
    tangent(1, 1) = penalty(1)
    associate (v => material%values)
      phi = v(place_phi)*(1 - v(place_soft)*drivers(driver_temperature, 2)) &
            *(1 + v(place_rise)*(1 - exp(-committed(1)/v(place_way))))
    end associate
    trial = tau_committed(1) + penalty(2)*slip(1)
    if (abs(trial) <= phi*pressure) then
      status = contact_stick
      tau(1) = trial
      tangent(2, 2) = penalty(2)
    else
      status = contact_slip
      tau(1) = sign(phi*pressure, trial)
      tangent(2, 1) = sign(phi*penalty(1), trial)
      if (dt > 0) history(1) = committed(1) + abs(slip(1) - (tau(1) - tau_committed(1))/penalty(2))
    end if
  end subroutine slide

end module law_worn
