!> DIE cards: segments, parabolas and arcs, end to end, and fillets between them. Those of sides of bodies are read when there
!> is a mesh.
module cards_dies
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use die_arcs, only: arc_pieces
  use die_fillets, only: round_corner
  use dies, only: die_t, finish_die
  use kinds, only: wp
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: read_dies

  !> A piece begins where the last one ended, to this share of the die's size.
  real(wp), parameter :: gap_tolerance = 1.0e-9_wp
  !> The middle point of a parabola lies over the middle half of its chord, or the parabola folds.
  real(wp), parameter :: middle_half(2) = [0.25_wp, 0.75_wp]

  !> Rows of the card.
  integer, parameter :: segment = 1, parabola = 2, arc = 3, fillet = 4

  !> What rows before say of the next one.
  type :: chain_t
    !> Piece the last row of pieces began with; 0 before the first.
    integer :: first = 0
    !> A fillet waits for the piece after it.
    logical :: fillet = .false.
    real(wp) :: radius = 0.0_wp, tolerance = 0.0_wp
  end type chain_t

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
    type(chain_t) :: chain
    integer :: i, n

    call words_of('SEGM PARAB ARC FILLT', forms)
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
      chain = chain_t()
      call cursor%next_row('SEGM, PARAB or ARC and its points')
      do while (.not. cursor%failed())
        call read_row(cursor, forms, die, chain)
        if (.not. cursor%more_rows()) exit
        call cursor%next_row('a piece')
      end do
      if (chain%fillet) call cursor%fail('a fillet stands between two pieces: none comes after it')
      call close_chain(die)
      call close_card(draft, cursor, deck%cards(i))
      call finish_die(die)
      dies(n) = die
    end do
    draft%scene%dies = dies(:n)
  end subroutine read_dies

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

  !> A chain whose ends meet to round-off is closed: they become one point.
  pure subroutine close_chain(die)
    type(die_t), intent(inout) :: die
    integer :: n

    n = size(die%pieces, 3)
    if (n < 2) return
    if (length_of(die%pieces(:, 3, n) - die%pieces(:, 1, 1)) <= gap_tolerance*maxval(abs(die%pieces))) then
      die%pieces(:, 3, n) = die%pieces(:, 1, 1)
    end if
  end subroutine close_chain

  !> One row: a piece, or a fillet for the corner to come.
  subroutine read_row(cursor, forms, die, chain)
    type(cursor_t), intent(inout) :: cursor
    type(string_t), intent(in) :: forms(:)
    type(die_t), intent(inout) :: die
    type(chain_t), intent(inout) :: chain
    character(len=:), allocatable :: message
    real(wp), allocatable :: rounded(:, :, :), whole(:, :, :)
    integer :: form, n, first, rest

    call cursor%name('a form of piece', forms, form)
    if (form == fillet) then
      if (chain%first == 0) call cursor%fail('a fillet stands between two pieces: none comes before it')
      if (chain%fillet) call cursor%fail('a fillet stands between two pieces, this one follows a fillet')
      call cursor%real('the radius of the fillet', chain%radius, lower=0.0_wp, strict_lower=.true., unit='length')
      call cursor%real('the tolerance of the fillet', chain%tolerance, lower=0.0_wp, strict_lower=.true., unit='length')
      chain%fillet = .true.
      return
    end if
    n = size(die%pieces, 3)
    call read_piece(cursor, form, die)
    if (cursor%failed()) then
      chain%fillet = .false.
      return
    end if
    first = chain%first
    chain%first = n + 1
    if (.not. chain%fillet) return
    chain%fillet = .false.
    call round_corner(die%pieces(:, :, first:n), die%pieces(:, :, n + 1:), chain%radius, chain%tolerance, rounded, rest, &
                      message)
    if (message /= '') then
      call cursor%fail(message)
      return
    end if
    allocate (whole(2, 3, first - 1 + size(rounded, 3)))
    whole(:, :, :first - 1) = die%pieces(:, :, :first - 1)
    whole(:, :, first:) = rounded
    chain%first = size(whole, 3) - rest + 1
    call move_alloc(whole, die%pieces)
  end subroutine read_row

  !> A piece: its points, for an arc its tolerance.
  subroutine read_piece(cursor, form, die)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: form
    type(die_t), intent(inout) :: die
    real(wp) :: first(2), middle(2), last(2), tolerance, gap, size_of_die, share
    real(wp), allocatable :: pieces(:, :, :)
    character(len=:), allocatable :: message
    integer :: n

    call read_xy(cursor, 'the first point', first)
    n = size(die%pieces, 3)
    if (n > 0 .and. .not. cursor%failed()) then
      gap = length_of(first - die%pieces(:, 3, n))
      size_of_die = max(maxval(abs(die%pieces)), maxval(abs(first)))
      if (gap > gap_tolerance*size_of_die) &
        call cursor%fail('the piece must begin where the last one ended, at '//to_text(die%pieces(1, 3, n), 10)//' ' &
                         //to_text(die%pieces(2, 3, n), 10)//'; it begins '//to_text(gap)//' away from there')
      first = die%pieces(:, 3, n)
    end if
    middle = 0
    if (form /= segment) call read_xy(cursor, 'the middle point', middle)
    call read_xy(cursor, 'the last point', last)
    if (form == arc) call cursor%real('the tolerance of the arc', tolerance, lower=0.0_wp, strict_lower=.true., unit='length')
    if (cursor%failed()) return
    if (.not. length_of(last - first) > gap_tolerance*max(maxval(abs(first)), maxval(abs(last)))) then
      call cursor%fail('the piece ends where it begins')
      return
    end if
    select case (form)
    case (segment)
      pieces = reshape([first, 0.5_wp*(first + last), last], [2, 3, 1])
    case (parabola)
      share = dot_product(middle - first, last - first)/dot_product(last - first, last - first)
      if (.not. (share > middle_half(1) .and. share < middle_half(2))) &
        call cursor%fail('the middle point must lie over the middle half of the chord, or the parabola folds; it lies at ' &
                         //to_text(100*share, 4)//' % of it')
      pieces = reshape([first, middle, last], [2, 3, 1])
    case default
      call arc_pieces(first, middle, last, tolerance, pieces, message)
      if (message /= '') call cursor%fail(message)
    end select
    if (cursor%failed()) return
    die%pieces = reshape([die%pieces, pieces], [2, 3, n + size(pieces, 3)])
  end subroutine read_piece

end module cards_dies
