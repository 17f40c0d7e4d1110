!> Volumes around the unknowns of the motion, by which viscous forces are shared out.
module volumes_of_unknowns
  use elem_body_springs, only: mass_matrix
  use equations, only: equations_t
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  implicit none
  private
  public :: volumes_of_motion, volumes_of_nodes

contains

  !> Volume around the node of each free displacement, an eighth of that of an element; 0 for all other unknowns.
  function volumes_of_nodes(scene, equations, solution) result(volume)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp) :: volume(equations%dofs%ndof)   !! [volume, per radian when axisymmetric]
    real(wp), allocatable :: x(:, :)
    real(wp) :: share
    integer :: g, e, j, c, d

    volume = 0
    allocate (x, source=present_coordinates(scene, solution))
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      associate (nodes => scene%groups(g)%connectivity)
        do e = 1, size(nodes, 2)
          share = sum(mass_matrix(scene%section, x(:, nodes(:, e))))/size(nodes, 1)
          do j = 1, size(nodes, 1)
            do c = 1, 2
              d = equations%dofs%fields(displacement_field)%number(c, nodes(j, e))
              if (d == 0) cycle
              if (equations%dofs%is_free(d)) volume(d) = volume(d) + share
            end do
          end do
        end do
      end associate
    end do
  end function volumes_of_nodes

  !> The same, and for free motions of other things, as of a die that a force moves, the volume of all bodies; for angles times the
  !> square of the size of the scene.
  function volumes_of_motion(scene, equations, solution) result(volume)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp) :: volume(equations%dofs%ndof)   !! [volume, per radian when axisymmetric]
    real(wp) :: whole

    volume = volumes_of_nodes(scene, equations, solution)
    ! each counts once for each of two components
    whole = 0.5_wp*sum(volume)
    where (equations%dofs%is_free .and. equations%dofs%quantity == 1 .and. .not. volume > 0) &
      volume = whole*merge(equations%size**2, 1.0_wp, equations%dofs%is_angle)
  end function volumes_of_motion

end module volumes_of_unknowns
