!> The row WINDOW of REMSH: sizes of elements in a box that stays where it is, goes with a die, or with the matter in it.
module remesher_windows
  use card_places, only: read_rigid_die
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use mesh_windows, only: mesh_window_t
  use scene_draft, only: draft_t, words_of
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_window, window_text

contains

  !> `x y x y smallest largest [MATTER | DIE name]`: two opposite corners, sizes, what it goes with.
  subroutine read_window(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(mesh_window_t) :: window
    real(wp) :: corners(2, 2)

    call read_xy(cursor, 'a corner of the window', corners(:, 1))
    call read_xy(cursor, 'the opposite corner', corners(:, 2))
    if (cursor%failed()) return
    window%low = minval(corners, dim=2)
    window%high = maxval(corners, dim=2)
    if (any(.not. window%low < window%high)) then
      call cursor%fail('the window has no area: expected two opposite corners')
      return
    end if
    call cursor%real('the smallest size of an element', window%smallest, lower=0.0_wp, strict_lower=.true., unit='length')
    call cursor%real('the largest size of an element', window%largest, lower=window%smallest, unit='length')
    if (cursor%more()) call read_company(cursor, draft, window)
    if (cursor%failed()) return
    draft%scene%remesher%windows = [draft%scene%remesher%windows, window]
  end subroutine read_window

  !> What the window goes with.
  subroutine read_company(cursor, draft, window)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(mesh_window_t), intent(inout) :: window
    type(string_t), allocatable :: words(:)
    integer :: k

    call words_of('MATTER DIE', words)
    call cursor%name('MATTER or DIE', words, k)
    if (k == 0) return
    window%by_matter = words(k)%s == 'MATTER'
    if (.not. window%by_matter) call read_rigid_die(cursor, draft, window%die, 'MATTER')
  end subroutine read_company

  !> For the summary of a scene.
  pure function window_text(window, die) result(s)
    type(mesh_window_t), intent(in) :: window
    character(len=*), intent(in) :: die   !! name of the one it goes with
    character(len=:), allocatable :: s

    s = 'elements of '//to_text(window%smallest, 4)//' to '//to_text(window%largest, 4)//' in x '//to_text(window%low(1), 4) &
        //' to '//to_text(window%high(1), 4)//', y '//to_text(window%low(2), 4)//' to '//to_text(window%high(2), 4)
    if (window%by_matter) s = s//', with the matter'
    if (window%die > 0) s = s//', with '//die
  end function window_text

end module remesher_windows
