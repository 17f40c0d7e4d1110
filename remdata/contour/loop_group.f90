!> The group of the scene that a contour belongs to.
module loop_group
  use boundary_sides, only: loop_t
  use scene, only: is_solid, scene_t
  implicit none
  private
  public :: group_of

contains

  !> Group of the body inside a contour.
  pure function group_of(scene, loop, number) result(group)
    type(scene_t), intent(in) :: scene
    type(loop_t), intent(in) :: loop
    integer, intent(in) :: number   !! of the contour, of which a first mesh has one for each body
    integer :: group
    integer :: last

    if (size(loop%element) == 0) then
      group = scene%remesher%contours(number)%group
      return
    end if
    last = 0
    do group = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(group))) cycle
      last = last + size(scene%groups(group)%connectivity, 2)
      if (loop%element(1) <= last) return
    end do
  end function group_of

end module loop_group
