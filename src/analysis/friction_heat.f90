!> Heat of friction where temperatures are solved for once, before the motion: the work that friction took in the step becomes heat
!> in the next one. Until then it is kept at the points of heat through contact, per area, so that none is lost over a checkpoint or
!> a new mesh.
module friction_heat
  use contact_work, only: friction_energy
  use elem_heat_contact, only: name_of_due
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use quadrature, only: line_rule
  use scene, only: group_t, role_heat_contact, scene_t
  use side_points, only: area_at
  use solution, only: solution_t
  use state_variables, only: find_variable
  use strategy, only: coupling_once
  implicit none
  private
  public :: keep_friction_work

contains

  !> Work of friction of the step that was just found, into the trial state of heat through contact; fields have moved already.
  subroutine keep_friction_work(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer :: g, due

    if (scene%strategy%coupling /= coupling_once) return
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_heat_contact) cycle
      due = find_variable(scene%groups(g)%variables, name_of_due)
      if (due > 0) call keep_of_group(scene, g, due, solution)
    end do
  end subroutine keep_friction_work

  subroutine keep_of_group(scene, g, due, solution)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, due   !! group, and row of its state
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: x(2, 3, 2), section(3, 2), work(3, 2), energy(2), area
    integer :: rows(3), e, p, k

    associate (group => scene%groups(g), host => scene%groups(scene%groups(g)%host), &
               state => solution%groups(scene%groups(g)%host), u => solution%fields(displacement_field))
      call line_rule(group%rule, xi, weight)
      rows = [row_of(host, 'friction_work'), row_of(host, 'corner_friction_work'), row_of(host, 'corner_place')]
      section = spread(scene%section, 2, 2)
      if (scene%finite) then
        section(:, 2) = solution%fields(section_field)%value(:, 1)
        section(:, 1) = section(:, 2) - solution%fields(section_field)%last_increment(:, 1)
      end if
      do e = 1, size(group%connectivity, 2)
        associate (nodes => group%connectivity(:, e))
          x(:, :, 2) = scene%mesh%coordinates(:, nodes) + u%value(:, nodes)
          x(:, :, 1) = x(:, :, 2) - u%last_increment(:, nodes)
        end associate
        do p = 1, size(xi)
          work = 0
          do k = 1, size(rows)
            if (rows(k) > 0) work(k, :) = [state%committed(rows(k), p, e), state%trial(rows(k), p, e)]
          end do
          energy = friction_energy(group%rule, host%pairs > 0, xi, weight, p, work, section, x)
          area = weight(p)*area_at(xi(p), section(:, 2), x(:, :, 2))
          ! a point on the axis has no area
          if (area > 0) solution%groups(g)%trial(due, p, e) = (energy(2) - energy(1))/area
        end do
      end do
    end associate
  end subroutine keep_of_group

  !> First component of a state variable, 0 where the group has none of the name.
  pure function row_of(group, name) result(row)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: name
    integer :: row

    row = find_variable(group%variables, name)
    if (row > 0) row = group%variables(row)%first
  end function row_of

end module friction_heat
