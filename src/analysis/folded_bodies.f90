!> Bodies that have met themselves in the run, where no card gives their sides contact (folding_bodies): told at the end, since the
!> law of that contact is a choice of the program, and a lap in the part.
module folded_bodies
  use own_contact, only: list_folding
  use scene, only: role_contact, scene_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: warn_of_folds

contains

  !> A warning for each of them.
  pure subroutine warn_of_folds(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    type(string_t), allocatable :: names(:)
    integer :: k, g

    call list_folding(scene, names)
    do k = 1, size(names)
      do g = 1, size(scene%groups)
        if (scene%groups(g)%role /= role_contact) cycle
        if (scene%dies(scene%groups(g)%die)%unasked .and. index(scene%groups(g)%name, names(k)%s//'/') == 1) exit
      end do
      if (g > size(scene%groups)) cycle
      call add_text(warnings, names(k)%s//' has met itself: since then its sides press on one another by LAW ' &
                    //scene%materials(scene%groups(g)%material)%name//', which no card asks for; another law: DIE name SIDES ' &
                    //'place and CNT2D name name law')
    end do
  end subroutine warn_of_folds

end module folded_bodies
