!> SPRNG: a spring between the pilot of a die and where it stands at the start.
!>
!> Force k (c - c_start) on one component of the pilot: k is a stiffness, or one of rotation. It holds a die
!> that is free before it touches anything, and is the compliance of a press.
module elem_spring
  use elem_api, only: elem_t, instant_t, layout_t, no_variables, of_pilot, report_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use scene, only: group_t, role_spring, scene_t
  implicit none
  private
  public :: elem_spring_row

contains

  function elem_spring_row() result(row)
    type(elem_t) :: row

    row%name = 'SPRNG'
    row%purpose = 'spring of a die'
    row%nnode = 0
    row%role = role_spring
    allocate (row%unknowns, source=[of_pilot()])
    row%effect = 'contact'
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function elem_spring_row

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
    type(report_t), intent(out) :: report  !! a spring never fails

    associate (c => group%component)
      force = 0
      force(c, :) = group%stiffness*(instant%pilots(c, group%die) - scene%dies(group%die)%pilot(c) + du(c, :))
      if (.not. instant%tangent) return
      stiffness = 0
      stiffness(c, c, :) = group%stiffness
    end associate
  end subroutine compute

end module elem_spring
