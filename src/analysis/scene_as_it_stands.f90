!> The scene at the present instant, as a deck would describe it that began there.
module scene_as_it_stands
  use dies, only: is_deformable
  use fields, only: pilot_field
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  implicit none
  private
  public :: present_scene

contains

  !> The scene with its nodes and the pilots of its rigid dies where they are in the committed state.
  function present_scene(scene, solution) result(now)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(scene_t) :: now
    integer :: k

    now = scene
    now%mesh%coordinates = present_coordinates(scene, solution)
    do k = 1, size(now%dies)
      if (.not. is_deformable(now%dies(k))) now%dies(k)%pilot = solution%fields(pilot_field)%value(:, k)
    end do
  end function present_scene

end module scene_as_it_stands
