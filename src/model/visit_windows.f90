!> The members of windows of the remesher (visitors).
module visit_windows
  use kinds, only: wp
  use mesh_windows, only: mesh_window_t
  use visitors, only: kept, visitor_t
  implicit none
  private
  public :: visit_window_list

  !> Windows of one operation at most.
  integer, parameter :: most_windows = 100000

contains

  subroutine visit_window_list(visitor, list)
    class(visitor_t), intent(inout) :: visitor
    type(mesh_window_t), allocatable, intent(inout) :: list(:)   !! (nwindow)
    integer :: k, n

    n = 0
    if (allocated(list)) n = size(list)
    call visitor%list('windows', n, most_windows)
    if (.not. allocated(list)) allocate (list(n))
    do k = 1, n
      call visitor%enter_item('windows', k)
      call visit_window(visitor, list(k))
      call visitor%leave('windows')
    end do
  end subroutine visit_window_list

  subroutine visit_window(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(mesh_window_t), intent(inout) :: self

    call visitor%fixed('low', self%low, kept, 'length')
    call visitor%fixed('high', self%high, kept, 'length')
    call visitor%member('smallest', self%smallest, kept, 'length', low=tiny(1.0_wp))
    call visitor%member('largest', self%largest, kept, 'length', low=tiny(1.0_wp))
    call visitor%member('by_matter', self%by_matter, kept)
    call visitor%member('die', self%die, kept, low=0)
  end subroutine visit_window

end module visit_windows
