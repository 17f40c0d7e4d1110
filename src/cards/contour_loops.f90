!> The contours of a BODY card: the outer one and those of holes, each around with the part on its left.
module contour_loops
  use closed_parabolas, only: area_in, lies_within
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use text, only: to_text
  use zone_marks, only: contour_card_t
  implicit none
  private
  public :: check_loops

contains

  !> The first one has the part inside, all others have it outside and lie in the first one, none in another. Whether they cross
  !> is seen where the mesh is made.
  subroutine check_loops(cursor, contour)
    type(cursor_t), intent(inout) :: cursor
    type(contour_card_t), intent(in) :: contour
    integer :: k, other

    if (.not. area_in(pieces_of(contour, 1)) > 0) then
      call cursor%fail('the part must be on the left of its contour: give the pieces the other way round')
      return
    end if
    do k = 2, maxval(contour%loop)
      associate (hole => pieces_of(contour, k))
        if (.not. area_in(hole) < 0) then
          call cursor%fail('the part must be on the left of a hole too: give the pieces of the hole that begins at '//place(hole) &
                           //' the other way round')
        else if (.not. lies_within(hole, pieces_of(contour, 1))) then
          call cursor%fail('the contour has closed, and the row that begins at '//place(hole)//' begins a hole: expected it ' &
                           //'inside the contour')
        end if
        do other = 2, k - 1
          if (lies_within(hole(:, :, 1:1), pieces_of(contour, other)) .or. lies_within(pieces_of(contour, other), hole)) &
            call cursor%fail('the hole that begins at '//place(hole)//' and the one at '//place(pieces_of(contour, other)) &
                             //' lie in one another')
        end do
      end associate
      if (cursor%failed()) return
    end do
  end subroutine check_loops

  pure function pieces_of(contour, loop) result(pieces)
    type(contour_card_t), intent(in) :: contour
    integer, intent(in) :: loop
    real(wp), allocatable :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    integer :: k

    allocate (pieces, source=contour%pieces(:, :, pack([(k, k=1, size(contour%loop))], contour%loop == loop)))
  end function pieces_of

  !> Where a contour begins.
  pure function place(pieces) result(words)
    real(wp), intent(in) :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    character(len=:), allocatable :: words

    words = to_text(pieces(1, 1, 1), 10)//' '//to_text(pieces(2, 1, 1), 10)
  end function place

end module contour_loops
