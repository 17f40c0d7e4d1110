!> DIETM: the heat capacity of a rigid die that has one temperature, C (T - T_n)/dt.
module elem_die_heat
  use elem_api, only: elem_t, instant_t, layout_t, mode_error, mode_restore, no_variables, report_t
  use elem_heat_contact, only: elem_cnttm_row
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use scene, only: group_t, role_die_heat, scene_t
  implicit none
  private
  public :: elem_dietm_row

contains

  function elem_dietm_row() result(row)
    type(elem_t) :: row
    type(elem_t) :: contact

    row%name = 'DIETM'
    row%purpose = 'heat capacity of a rigid die'
    row%nnode = 0
    row%role = role_die_heat
    contact = elem_cnttm_row()
    allocate (row%unknowns, source=contact%unknowns(2:2))
    row%effect = 'heat'
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function elem_dietm_row

  !> On a new mesh the die keeps its temperature.
  subroutine compute(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
                     force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :), start(:, :), drivers(:, :, :, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report

    force = 0
    if (instant%tangent) stiffness = 0
    if (instant%mode == mode_restore) then
      if (instant%tangent) stiffness = 1
      return
    end if
    if (instant%mode == mode_error .or. .not. instant%content) return
    force = group%amplitude/instant%dt*du(1:1, :)
    if (instant%tangent) stiffness = group%amplitude/instant%dt
    report%heat_stored = group%amplitude*sum(du(1, :))
  end subroutine compute

end module elem_die_heat
