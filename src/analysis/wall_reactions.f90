!> What walls carry beside the nodes of their supports: parts of the force across a plane of symmetry.
module wall_reactions
  use fields, only: displacement_field
  use history, only: circumference
  use json_writer, only: json_t
  use kinds, only: wp
  use placed_walls, only: reaction_beside, support_of
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: add_wall_reactions, list_wall_reactions

contains

  !> What a wall of the scene's list carries beside its support.
  pure function reaction_beside_support(scene, solution, number) result(total)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: number
    real(wp) :: total   !! per radian when axisymmetric [force]
    integer :: f

    total = 0
    f = support_of(scene, scene%walls(number))
    if (f == 0) return
    associate (c => scene%walls(number)%component)
      total = reaction_beside(scene, present_coordinates(scene, solution), c, scene%fixations(f)%nodes, &
                              solution%fields(displacement_field)%reaction(c, :))
    end associate
  end function reaction_beside_support

  !> Lines of the table at the end of a run, of walls that carry something. Of the full circumference when axisymmetric.
  subroutine list_wall_reactions(scene, solution, lines)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: lines(:)   !! (nline)
    real(wp) :: force
    integer :: k

    do k = 1, number_of(scene)
      force = reaction_beside_support(scene, solution, k)
      if (abs(force) > 0) call add_text(lines, '  wall of '//scene%walls(k)%label//': carries ' &
                                        //to_text(circumference(scene)*force, 4)//' beside the support, at the end')
    end do
  end subroutine list_wall_reactions

  !> All walls for the summary.
  subroutine add_wall_reactions(json, scene, solution)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: k

    call json%begin_array('walls')
    do k = 1, number_of(scene)
      call json%begin_object()
      call json%add('support', scene%walls(k)%label)
      call json%add('force_beside_support', circumference(scene)*reaction_beside_support(scene, solution, k))
      call json%end_object()
    end do
    call json%end_array()
  end subroutine add_wall_reactions

  pure function number_of(scene) result(n)
    type(scene_t), intent(in) :: scene
    integer :: n

    n = 0
    if (allocated(scene%walls)) n = size(scene%walls)
  end function number_of

end module wall_reactions
