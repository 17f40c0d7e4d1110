!> Volumes that the integration points of an element stand for.
module point_volumes
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use quad8_geometry, only: derivatives, quad8_rule_t
  use scene, only: scene_t
  use sections, only: thickness_at
  use solution, only: solution_t
  implicit none
  private
  public :: volumes_of_points

contains

  !> Of an element as it stands (as it stood at the start where kinematics are SMALL), per radian when axisymmetric.
  pure function volumes_of_points(scene, solution, rule, nodes) result(volumes)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(quad8_rule_t), intent(in) :: rule   !! of the group
    integer, intent(in) :: nodes(8)          !! of the element
    real(wp) :: volumes(rule%npoint)         !! [volume]
    real(wp) :: x(2, 8), nx(8), ny(8), section(3), detj
    integer :: p

    section = scene%section
    if (scene%finite) section = solution%fields(section_field)%value(:, 1)
    associate (u => solution%fields(displacement_field)%value)
      x = scene%mesh%coordinates(:, nodes)
      if (scene%finite .and. size(u) > 0) x = x + u(:, nodes)
    end associate
    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      volumes(p) = detj*rule%weight(p)*thickness_at(section, matmul(x, rule%phi(:, p)))
    end do
  end function volumes_of_points

end module point_volumes
