!> DIE cards: segments, parabolas and arcs, end to end, and fillets between them. Those of sides of bodies are read when there
!> is a mesh.
module cards_dies
  use card_points, only: read_xy
  use curve_loops, only: find_loop
  use deck_card, only: card_t
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use fillets, only: round_corner
  use dies, only: die_t, finish_die, radius_on
  use kinds, only: wp
  use piece_rows, only: ends_meet, piece_words, read_piece
  use scene, only: axisymmetric
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_dies

  !> Row of the card after those of pieces.
  integer, parameter :: fillet = 4

  !> State of reading the rows of a card.
  type :: die_rows_t
    !> First piece of the last row of pieces; 0 before the first row.
    integer :: first = 0
    !> Pieces so far: the die's array has room for more.
    integer :: npiece = 0
    !> The last row was a fillet; the piece after it is still to come.
    logical :: fillet = .false.
    real(wp) :: radius = 0.0_wp, tolerance = 0.0_wp
    !> Rows read, and pieces up to the end of each (row), those of a fillet with the row before it.
    integer :: nrow = 0
    integer, allocatable :: last(:)
  end type die_rows_t

contains

  !> All DIE cards, in the order of the deck.
  subroutine read_dies(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: forms(:)
    type(die_t), allocatable :: dies(:)
    type(die_t) :: die
    type(die_rows_t) :: rows
    integer :: i, n

    call words_of(piece_words//' FILLT', forms)
    allocate (dies(size(deck%cards)))
    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'DIE') cycle
      n = n + 1
      call cursor%open(deck%cards(i), diagnostics)
      call draft%places%define(cursor, 'the name of the die', 'DIE', n, diagnostics, die%name)
      if (cursor%peek_word() == 'SIDES') then
        ! its sides are looked up when there is a mesh (cards_side_dies)
        dies(n)%name = die%name
        allocate (dies(n)%nodes(3, 0))
        cycle
      end if
      call read_pilot(cursor, die%pilot)
      if (allocated(die%pieces)) deallocate (die%pieces)
      allocate (die%pieces(2, 3, 0))
      rows = die_rows_t(last=spread(0, 1, size(deck%cards(i)%rows)))
      call cursor%next_row('SEGM, PARAB or ARC and its points')
      do while (.not. cursor%failed())
        call read_row(cursor, forms, die, rows)
        rows%nrow = rows%nrow + 1
        rows%last(rows%nrow) = rows%npiece
        if (.not. cursor%more_rows()) exit
        call cursor%next_row('a piece')
      end do
      if (rows%fillet) call cursor%fail('a fillet stands between two pieces: none comes after it')
      die%pieces = die%pieces(:, :, :rows%npiece)
      if (ends_meet(die%pieces)) die%pieces(:, 3, size(die%pieces, 3)) = die%pieces(:, 1, 1)
      call close_card(draft, cursor, deck%cards(i))
      call finish_die(die)
      if (.not. cursor%failed()) then
        call refuse_loops(deck%cards(i), die, rows, diagnostics)
        if (draft%scene%plane_state == axisymmetric) call go_on_past_axis(die)
      end if
      dies(n) = die
    end do
    draft%scene%dies = dies(:n)
  end subroutine read_dies

  !> The part on the left of a curve that crosses itself would be on its right too.
  subroutine refuse_loops(card, die, rows, diagnostics)
    type(card_t), intent(in) :: card
    type(die_t), intent(in) :: die
    type(die_rows_t), intent(in) :: rows
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: pieces(2)
    real(wp) :: point(2)

    call find_loop(die, pieces, point)
    if (pieces(1) == 0) return
    point = point + die%pilot(1:2)
    associate (first => card%rows(row_of(pieces(1))), second => card%rows(row_of(pieces(2))))
      call diagnostics%add(location_t(second%file, second%line, second%fields(1)%column), card%keyword, &
                           'expected a curve that does not cross itself; this piece crosses that of line '//to_text(first%line) &
                           //' at x = '//to_text(point(1))//', y = '//to_text(point(2)))
    end associate

  contains

    pure function row_of(piece) result(row)
      integer, intent(in) :: piece
      integer :: row

      row = findloc(rows%last >= piece, .true., dim=1)
    end function row_of

  end subroutine refuse_loops

  !> A die that ends on the axis of an axisymmetric scene, and does not lie along it, goes on as its mirror image, by a piece: a
  !> point of the part on the axis would else be now on its last piece and now beyond its end, by the round-off of x, or by
  !> the slope that a parabola has where its arc has none.
  subroutine go_on_past_axis(die)
    type(die_t), intent(inout) :: die
    real(wp), allocatable :: pieces(:, :, :)
    real(wp) :: pilot(3)
    logical :: on_axis(2)   !! ends of the first piece, or of the last
    integer :: n

    n = size(die%pieces, 3)
    if (die%closed .or. n == 0) return
    pilot = die%pilot
    pieces = die%pieces
    on_axis = ends_on_axis(pieces(:, :, n))
    if (on_axis(2) .and. .not. on_axis(1)) pieces = reshape([pieces, mirrored(pieces(:, :, n))], [2, 3, n + 1])
    on_axis = ends_on_axis(pieces(:, :, 1))
    if (on_axis(1) .and. .not. on_axis(2)) pieces = reshape([mirrored(pieces(:, :, 1)), pieces], [2, 3, size(pieces, 3) + 1])
    if (size(pieces, 3) == n) return
    die%pieces = pieces
    die%pilot = 0
    call finish_die(die)
    die%pilot = pilot

  contains

    pure function ends_on_axis(piece) result(on_axis)
      real(wp), intent(in) :: piece(2, 3)   !! in the pilot's axes [length]
      logical :: on_axis(2)

      on_axis = [.not. abs(radius_on(die, piece(1, 1))) > 0,.not. abs(radius_on(die, piece(1, 3))) > 0]
    end function ends_on_axis

    !> The mirror image of a piece, walked the other way.
    pure function mirrored(piece) result(image)
      real(wp), intent(in) :: piece(2, 3)   !! in the pilot's axes [length]
      real(wp) :: image(2, 3)

      image(1, :) = -2*pilot(1) - piece(1, 3:1:-1)
      image(2, :) = piece(2, 3:1:-1)
    end function mirrored

  end subroutine go_on_past_axis

  subroutine read_pilot(cursor, pilot)
    type(cursor_t), intent(inout) :: cursor
    real(wp), intent(out) :: pilot(3)
    type(string_t), allocatable :: words(:)
    integer :: k

    pilot = 0
    if (.not. cursor%more()) return
    call words_of('PILOT', words)
    call cursor%name('PILOT, SIDES or the end of the line', words, k)
    call read_xy(cursor, 'the pilot', pilot(1:2))
  end subroutine read_pilot

  !> One row: a piece, or a fillet of the corner between the pieces before and after it.
  subroutine read_row(cursor, forms, die, rows)
    type(cursor_t), intent(inout) :: cursor
    type(string_t), intent(in) :: forms(:)
    type(die_t), intent(inout) :: die
    type(die_rows_t), intent(inout) :: rows
    character(len=:), allocatable :: message
    real(wp), allocatable :: rounded(:, :, :), whole(:, :, :)
    integer :: form, n, first, rest

    call cursor%name('a form of piece', forms, form)
    if (form == fillet) then
      if (rows%first == 0) call cursor%fail('a fillet stands between two pieces: none comes before it')
      if (rows%fillet) call cursor%fail('a fillet stands between two pieces, this one follows a fillet')
      call cursor%real('the radius of the fillet', rows%radius, lower=0.0_wp, strict_lower=.true., unit='length')
      call cursor%real('the tolerance of the fillet', rows%tolerance, lower=0.0_wp, strict_lower=.true., unit='length')
      rows%fillet = .true.
      return
    end if
    n = rows%npiece
    call read_piece(cursor, form, rows%npiece, die%pieces)
    if (cursor%failed()) then
      rows%fillet = .false.
      return
    end if
    first = rows%first
    rows%first = n + 1
    if (.not. rows%fillet) return
    rows%fillet = .false.
    call round_corner(die%pieces(:, :, first:n), die%pieces(:, :, n + 1:rows%npiece), rows%radius, rows%tolerance, &
                      rounded, rest, message)
    if (message /= '') then
      call cursor%fail(message)
      return
    end if
    allocate (whole(2, 3, first - 1 + size(rounded, 3)))
    whole(:, :, :first - 1) = die%pieces(:, :, :first - 1)
    whole(:, :, first:) = rounded
    rows%npiece = size(whole, 3)
    rows%first = rows%npiece - rest + 1
    rows%last(rows%nrow - 1:rows%nrow) = rows%npiece - rest
    call move_alloc(whole, die%pieces)
  end subroutine read_row

end module cards_dies
