!> Coordinates on cards.
module card_points
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: read_xy

  !> Beyond these, products of four lengths overflow or vanish.
  real(wp), parameter :: farthest = 1.0e50_wp, nearest = 1.0e-50_wp

contains

  !> x and y of what `of` names.
  subroutine read_xy(cursor, of, x)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: of
    real(wp), intent(out) :: x(2)   !! [length]
    character(len=1), parameter :: names(2) = ['x', 'y']
    integer :: c

    do c = 1, 2
      call cursor%real(names(c)//' of '//of, x(c), unit='length')
      if (abs(x(c)) > farthest) then
        call cursor%fail(names(c)//' of '//of//' is too large: '//to_text(x(c)))
        x(c) = 0
      else if (abs(x(c)) < nearest) then
        x(c) = 0
      end if
    end do
  end subroutine read_xy

end module card_points
