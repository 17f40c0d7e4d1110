!> The contours of a BODY card: the outer one and those of holes, each around with the part on its left.
module contour_loops
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use remesh_defaults, only: area_in
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

  !> All ends and middle points of pieces are inside a closed contour of others, by the crossings of a ray along x with its chords,
  !> two to each piece.
  pure function lies_within(pieces, others) result(within)
    real(wp), intent(in) :: pieces(:, :, :), others(:, :, :)   !! (2, 3, npiece) [length]
    logical :: within
    logical :: inside
    integer :: i, j, k, m

    within = .true.
    do k = 1, size(pieces, 3)
      do i = 1, 2
        inside = .false.
        do j = 1, size(others, 3)
          do m = 1, 2
            associate (x => pieces(:, i, k), a => others(:, m, j), b => others(:, m + 1, j))
              if ((a(2) > x(2)) .eqv. (b(2) > x(2))) cycle
              if (x(1) < a(1) + (x(2) - a(2))*(b(1) - a(1))/(b(2) - a(2))) inside = .not. inside
            end associate
          end do
        end do
        within = within .and. inside
      end do
    end do
  end function lies_within

  !> Where a contour begins.
  pure function place(pieces) result(words)
    real(wp), intent(in) :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    character(len=:), allocatable :: words

    words = to_text(pieces(1, 1, 1), 10)//' '//to_text(pieces(2, 1, 1), 10)
  end function place

end module contour_loops
