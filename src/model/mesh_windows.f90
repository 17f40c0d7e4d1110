!> Windows of REMSH: boxes in which elements of a new mesh have sizes of their own.
module mesh_windows
  use kinds, only: wp
  implicit none
  private
  public :: mesh_window_t

  type :: mesh_window_t
    !> Corners with the least and the largest coordinates, where the window is at the start [length].
    real(wp) :: low(2) = 0.0_wp, high(2) = 0.0_wp
    !> Sizes of the elements in it [length].
    real(wp) :: smallest = 0.0_wp, largest = 0.0_wp
    !> It holds the matter that is in it at the start, wherever that is now.
    logical :: by_matter = .false.
    !> The rigid die it goes with, 0 for none.
    integer :: die = 0
  end type mesh_window_t

end module mesh_windows
