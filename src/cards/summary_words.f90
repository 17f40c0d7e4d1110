!> Words that the parts of a scene's summary share.
module summary_words
  use scene, only: scene_t
  implicit none
  private
  public :: direction_names, times

  !> Components of a displacement and of the motion of a pilot.
  character(len=*), parameter :: direction_names(3) = ['x', 'y', 'a']

contains

  !> ' x NAME' of a multiplier, nothing where there is none.
  pure function times(scene, multiplier) result(s)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: multiplier   !! place in the scene's list, 0 for none
    character(len=:), allocatable :: s

    s = ''
    if (multiplier > 0) s = ' x '//scene%multipliers(multiplier)%name
  end function times

end module summary_words
