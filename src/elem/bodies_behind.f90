!> Bodies behind sides: which element has a side as its own.
module bodies_behind
  use scene, only: is_solid, scene_t
  implicit none
  private
  public :: find_bodies_behind

contains

  !> Bodies behind sides, by the nodes in the middle of these: group, element, and its side 1 to 4.
  pure subroutine find_bodies_behind(scene, middles, body, element, side)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: middles(:)                                  !! (nside)
    integer, allocatable, intent(out) :: body(:), element(:), side(:)  !! (nside)
    integer :: owner(3, size(scene%mesh%coordinates, 2)), g, e, k

    owner = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 4
          owner(:, scene%groups(g)%connectivity(4 + k, e)) = [g, e, k]
        end do
      end do
    end do
    body = owner(1, middles)
    element = owner(2, middles)
    side = owner(3, middles)
  end subroutine find_bodies_behind

end module bodies_behind
