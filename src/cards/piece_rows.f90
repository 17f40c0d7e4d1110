!> Rows of pieces end to end: segments, parabolas and arcs of dies and of contours.
module piece_rows
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use circle_arcs, only: arc_pieces
  use kinds, only: wp
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: piece_words, read_piece, ends_meet, is_one_point

  !> A piece begins where the last one ended, to this share of the curve's size.
  real(wp), parameter :: gap_tolerance = 1.0e-9_wp
  !> The middle point of a parabola lies over the middle half of its chord, or the parabola folds.
  real(wp), parameter :: middle_half(2) = [0.25_wp, 0.75_wp]

  !> Forms of pieces.
  character(len=*), parameter :: piece_words = 'SEGM PARAB ARC'
  integer, parameter :: segment = 1, parabola = 2, arc = 3

contains

  !> A piece: its points, for an arc its tolerance. It comes after the first `n` of `pieces`, which has room for more of them, and
  !> begins where the last one ended, or `anywhere`.
  subroutine read_piece(cursor, form, n, pieces, anywhere)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: form
    integer, intent(inout) :: n
    real(wp), allocatable, intent(inout) :: pieces(:, :, :)   !! (2, 3, n or more) [length]
    logical, intent(in), optional :: anywhere
    logical :: goes_on
    real(wp) :: first(2), middle(2), last(2), tolerance, gap, extent, share
    real(wp), allocatable :: more(:, :, :)
    character(len=:), allocatable :: message

    call read_xy(cursor, 'the first point', first)
    goes_on = n > 0
    if (present(anywhere)) goes_on = goes_on .and. .not. anywhere
    if (goes_on .and. .not. cursor%failed()) then
      gap = length_of(first - pieces(:, 3, n))
      extent = maxval(abs(first))
      ! seldom, so that the cost does not grow with the square of the number of pieces
      if (gap > gap_tolerance*extent) extent = max(extent, maxval(abs(pieces(:, :, :n))))
      if (gap > gap_tolerance*extent) &
        call cursor%fail('the piece must begin where the last one ended, at '//to_text(pieces(1, 3, n), 10)//' ' &
                         //to_text(pieces(2, 3, n), 10)//'; it begins '//to_text(gap)//' away from there')
      first = pieces(:, 3, n)
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
      more = reshape([first, 0.5_wp*(first + last), last], [2, 3, 1])
    case (parabola)
      share = dot_product(middle - first, last - first)/dot_product(last - first, last - first)
      if (.not. (share > middle_half(1) .and. share < middle_half(2))) &
        call cursor%fail('the middle point must lie over the middle half of the chord, or the parabola folds; it lies at ' &
                         //to_text(100*share, 4)//' % of it')
      more = reshape([first, middle, last], [2, 3, 1])
    case default
      call arc_pieces(first, middle, last, tolerance, more, message)
      if (message /= '') call cursor%fail(message)
    end select
    if (cursor%failed()) return
    call make_room(n, n + size(more, 3), pieces)
    pieces(:, :, n + 1:n + size(more, 3)) = more
    n = n + size(more, 3)
  end subroutine read_piece

  !> Room for `needed` pieces, with the first `n` kept; twice as much as there was, so that a long card is read in a time that grows
  !> with its rows.
  pure subroutine make_room(n, needed, pieces)
    integer, intent(in) :: n, needed
    real(wp), allocatable, intent(inout) :: pieces(:, :, :)   !! (2, 3, n or more) [length]
    real(wp), allocatable :: longer(:, :, :)

    if (needed <= size(pieces, 3)) return
    allocate (longer(2, 3, max(needed, 2*size(pieces, 3))))
    longer(:, :, :n) = pieces(:, :, :n)
    call move_alloc(longer, pieces)
  end subroutine make_room

  !> The last of several pieces ends where the first begins, to round-off.
  pure function ends_meet(pieces) result(yes)
    real(wp), intent(in) :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    logical :: yes
    integer :: n

    n = size(pieces, 3)
    yes = n >= 2
    if (yes) yes = is_one_point(pieces(:, 3, n), pieces(:, 1, 1), maxval(abs(pieces)))
  end function ends_meet

  !> Two ends of pieces are the same point, to round-off of the largest coordinate of their curve.
  pure function is_one_point(a, b, largest) result(yes)
    real(wp), intent(in) :: a(2), b(2), largest   !! [length]
    logical :: yes

    yes = length_of(a - b) <= gap_tolerance*largest
  end function is_one_point

end module piece_rows
