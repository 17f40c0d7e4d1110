!> BODY: a body by its contour, of which the remesher makes the first mesh.
module cards_contours
  use cards_mesh, only: read_body_head
  use contour_loops, only: check_loops
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: wp
  use mesh, only: side_set_t
  use mesh_parts, only: body_t, mesh_parts_t
  use piece_rows, only: is_one_point, piece_words, read_piece
  use remesher_options, only: has_contours
  use scene_draft, only: close_card, draft_t, head_location, words_of
  use text, only: string_t, to_text
  use zone_marks, only: contour_card_t
  implicit none
  private
  public :: read_contours, refuse_half_contours

contains

  !> All BODY cards: a body without elements each, and a set of sides for each of its rows.
  subroutine read_contours(deck, draft, parts, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(body_t) :: body
    type(contour_card_t) :: contour
    type(contour_card_t), allocatable :: contours(:)
    integer :: i, n

    allocate (contours(size(deck%cards)))
    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'BODY') cycle
      n = n + 1
      call cursor%open(deck%cards(i), diagnostics)
      call read_body_head(cursor, draft, diagnostics, 'BODY', size(draft%scene%mesh%sides) + 1, body)
      call read_chain(cursor, size(deck%cards(i)%rows), contour)
      call close_card(draft, cursor, deck%cards(i))
      parts%sound = parts%sound .and. .not. cursor%failed()
      if (cursor%failed()) contour%row = [integer ::]
      contour%group = size(parts%bodies) + 1
      contours(n) = contour
      call append_body(head_location(deck%cards(i)), size(deck%cards(i)%rows), body, draft, parts)
    end do
    allocate (draft%scene%remesher%contours, source=contours(:n))
  end subroutine read_contours

  !> The rows: pieces end to end and around, the part on their left. Where they have come back to where they began, the next row
  !> begins a hole.
  subroutine read_chain(cursor, nrow, contour)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: nrow
    type(contour_card_t), intent(inout) :: contour
    type(string_t), allocatable :: forms(:)
    integer, allocatable :: row(:), loop(:)
    real(wp), allocatable :: pieces(:, :, :)
    integer :: ends(max(nrow, 1)), loops(max(nrow, 1))
    real(wp) :: largest
    logical :: closed
    integer :: first, form, i, k, n, number

    call words_of(piece_words, forms)
    allocate (pieces(2, 3, 0))
    n = 0
    first = 1
    closed = .false.
    largest = 0
    number = 1
    do k = 1, max(nrow, 1)
      if (closed) then
        first = n + 1
        number = number + 1
      end if
      loops(k) = number
      call cursor%next_row('one of '//piece_words//' and its points')
      call cursor%name('one of '//piece_words, forms, form)
      i = n
      if (form > 0) call read_piece(cursor, form, n, pieces, anywhere=closed)
      ends(k) = n
      if (n > i) largest = max(largest, maxval(abs(pieces(:, :, i + 1:n))))
      closed = n > first
      if (closed) closed = is_one_point(pieces(:, 3, n), pieces(:, 1, first), largest)
      if (closed) pieces(:, 3, n) = pieces(:, 1, first)
    end do
    allocate (row(n), loop(n))
    i = 0
    do k = 1, size(ends)
      row(i + 1:ends(k)) = k
      loop(i + 1:ends(k)) = loops(k)
      i = ends(k)
    end do
    contour%pieces = pieces(:, :, :n)
    call move_alloc(row, contour%row)
    call move_alloc(loop, contour%loop)
    call cursor%end_row()
    if (cursor%failed()) return
    if (closed) then
      call check_loops(cursor, contour)
    else
      call cursor%fail('the contour must end where it began, at '//to_text(pieces(1, 1, first), 10)//' ' &
                       //to_text(pieces(2, 1, first), 10))
    end if
  end subroutine read_chain

  !> Its sets of sides are empty until there is a mesh.
  subroutine append_body(where, nrow, body, draft, parts)
    type(location_t), intent(in) :: where
    integer, intent(in) :: nrow
    type(body_t), intent(inout) :: body
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(side_set_t), allocatable :: sides(:)
    type(location_t), allocatable :: joined(:)
    integer :: k, n

    if (allocated(body%labels)) deallocate (body%labels, body%location, body%connectivity)
    allocate (body%labels(0), body%location(1), body%connectivity(8, 0))
    body%location = where
    parts%bodies = [parts%bodies, body]
    n = size(draft%scene%mesh%sides)
    allocate (sides(n + nrow), joined(n + nrow))
    do k = 1, n
      call move_alloc(draft%scene%mesh%sides(k)%name, sides(k)%name)
      call move_alloc(draft%scene%mesh%sides(k)%nodes, sides(k)%nodes)
    end do
    joined(:n) = parts%joined
    do k = 1, nrow
      sides(n + k)%name = body%name//'.'//to_text(k)
      allocate (sides(n + k)%nodes(3, 0))
    end do
    call move_alloc(sides, draft%scene%mesh%sides)
    call move_alloc(joined, parts%joined)
  end subroutine append_body

  !> The remesher makes the first mesh of all bodies or of none, and to a size.
  subroutine refuse_half_contours(deck, draft, parts, diagnostics)
    type(deck_t), intent(in) :: deck
    type(draft_t), intent(in) :: draft
    type(mesh_parts_t), intent(in) :: parts
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: i

    if (.not. has_contours(draft%scene%remesher)) return
    do i = 1, size(draft%scene%remesher%contours)
      if (size(draft%scene%remesher%contours(i)%row) == 0) return   ! a mistake that has been reported
    end do
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == 'BODY') exit
    end do
    associate (where => head_location(deck%cards(i)))
      if (size(parts%bodies) > size(draft%scene%remesher%contours)) then
        call diagnostics%add(where, 'BODY', 'a deck has bodies by their contours or bodies with elements, not both')
      else if (.not. (draft%scene%remesher%largest > 0 .or. goes_on(deck))) then
        call diagnostics%add(where, 'BODY', 'the size of its elements is not given: expected a REMSH card')
      end if
    end associate
  end subroutine refuse_half_contours

  !> This operation follows another one of the deck, which has made the mesh: cards of others have no keyword of theirs here.
  pure function goes_on(deck) result(yes)
    type(deck_t), intent(in) :: deck
    logical :: yes
    integer :: i

    yes = .false.
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == 'OPERA') return
      yes = deck%cards(i)%elsewhere
      if (yes) return
    end do
  end function goes_on

end module cards_contours
