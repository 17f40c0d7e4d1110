!> The group of the scene that a contour belongs to.
module loop_group
  use boundary_sides, only: loop_t
  use scene, only: is_solid, scene_t
  implicit none
  private
  public :: group_of, group_of_element

contains

  !> Group of the body inside a contour.
  pure function group_of(scene, loop) result(group)
    type(scene_t), intent(in) :: scene
    type(loop_t), intent(in) :: loop   !! without elements for a first mesh: its body is the number of the card
    integer :: group

    if (size(loop%element) == 0) then
      group = scene%remesher%contours(loop%body)%group
      return
    end if
    group = group_of_element(scene, loop%element(1))
  end function group_of

  !> Group of an element, counted through all solid groups; 0 beyond the last.
  pure function group_of_element(scene, element) result(group)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: element
    integer :: group
    integer :: g, last

    group = 0
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      last = last + size(scene%groups(g)%connectivity, 2)
      if (group == 0 .and. element <= last) group = g
    end do
  end function group_of_element

end module loop_group
