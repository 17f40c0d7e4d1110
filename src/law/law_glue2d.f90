!> GLUE2D: a side that always sticks to its die: no opening, no slip.
!>
!> p = AKP d of either sign, dtau = AKTAU ds: sticking dies of the classic upsetting tests, and
!> anything welded or shrunk on.
module law_glue2d
  use contact_penalties, only: penalty_parameters, penalty_problems
  use kinds, only: wp
  use law_api, only: contact_law, contact_stick, law_line, law_t
  use materials, only: material_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_glue2d_row

contains

  function law_glue2d_row() result(row)
    type(law_t) :: row

    row%name = 'GLUE2D'
    row%number = 9401
    row%kind = contact_law
    row%purpose = 'side glued to a die: sticks, pulls and pushes'
    row%source = 'COUL2D''s stick equations without its limits'
    allocate (row%lines, source=[law_line(penalty_parameters(), pairs=.true.)])
    allocate (row%history(0))
    row%lasts = .true.
    row%symmetric = .false.
    row%effects = 'contact'
    row%slide => slide
    row%check => check
  end function law_glue2d_row

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

    history = committed
    status = contact_stick
    pressure = augmentation + penalty(1)*penetration
    tau = tau_committed + penalty(2)*slip
    tangent = 0
    tangent(1, 1) = penalty(1)
    tangent(2, 2) = penalty(2)
    tangent(3, 3) = penalty(2)
  end subroutine slide

end module law_glue2d
