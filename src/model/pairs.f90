!> Contact pairs: the pieces of deformable dies that points of sides are coupled with.
!>
!> A point in reach of a deformable die may meet three pieces in a row, the middle one being that of its closest point when the
!> pairs were last renewed. A point far from the die meets none. The pieces of all points of a side, each once, have their
!> nodes among the unknowns of its element: few, however many points there are. The pattern of the matrix depends on them, and on
!> nothing else that moves.
module pairs
  use dies, only: die_t
  use scene, only: scene_t
  implicit none
  private
  public :: pairs_t, pieces_in_reach, nodes_per_piece
  public :: start_pairs, pairs_differ, paired_nodes, place_in_reach, list_pieces, most_pieces

  !> Pieces a point is coupled with, and the nodes of each.
  integer, parameter :: pieces_in_reach = 3, nodes_per_piece = 3

  !> Pairs of one group of contact elements.
  type :: pairs_t
    !> Middle piece of each point (npoint, nelem), 0 where there is none.
    integer, allocatable :: piece(:, :)
  end type pairs_t

contains

  !> No pairs yet, for all groups that face a deformable die.
  pure subroutine start_pairs(scene, pairs)
    type(scene_t), intent(in) :: scene
    type(pairs_t), allocatable, intent(out) :: pairs(:)   !! (npair) of the groups that face a deformable die
    integer :: g

    allocate (pairs(maxval([0, scene%groups%pairs])))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        ! heat through a contact has the pairs of that
        if (group%pairs == 0 .or. group%host > 0) cycle
        allocate (pairs(group%pairs)%piece(group%rule%n, size(group%connectivity, 2)), source=0)
      end associate
    end do
  end subroutine start_pairs

  !> Sides are coupled with other pieces.
  pure function pairs_differ(scene, one, other) result(differ)
    type(scene_t), intent(in) :: scene
    type(pairs_t), intent(in) :: one(:), other(:)   !! (npair) of the groups that face a deformable die
    logical :: differ
    integer :: g, e

    differ = .true.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%pairs == 0) cycle
        associate (die => scene%dies(group%die), first => one(group%pairs)%piece, second => other(group%pairs)%piece)
          do e = 1, size(first, 2)
            if (all(first(:, e) == second(:, e))) cycle
            if (differ_on(die, first(:, e), second(:, e))) return
          end do
        end associate
      end associate
    end do
    differ = .false.
  end function pairs_differ

  !> A side is coupled with other pieces.
  pure function differ_on(die, one, other) result(differ)
    type(die_t), intent(in) :: die
    integer, intent(in) :: one(:), other(:)   !! (npoint) middle piece of each point
    logical :: differ
    integer :: first(pieces_in_reach*size(one)), second(pieces_in_reach*size(other)), n, m

    call list_pieces(die, one, n, first)
    call list_pieces(die, other, m, second)
    differ = n /= m
    if (.not. differ) differ = any(first(:n) /= second(:n))
  end function differ_on

  !> Pieces that the points of a side may meet, each once, in ascending order.
  pure subroutine list_pieces(die, middle, n, pieces)
    type(die_t), intent(in) :: die
    integer, intent(in) :: middle(:)   !! (npoint) middle piece of each point
    integer, intent(out) :: n
    integer, intent(out) :: pieces(:)   !! (pieces_in_reach*npoint) the first n
    integer :: p, k, i, piece

    n = 0
    pieces = 0
    do p = 1, size(middle)
      do k = 1, pieces_in_reach
        piece = piece_in_reach(die, middle(p), k)
        if (piece == 0) cycle
        if (any(pieces(:n) == piece)) cycle
        n = n + 1
        do i = n, 2, -1
          if (pieces(i - 1) < piece) exit
          pieces(i) = pieces(i - 1)
        end do
        pieces(i) = piece
      end do
    end do
  end subroutine list_pieces

  !> The largest number of pieces that a side of a group is coupled with, at least one.
  pure function most_pieces(die, middle) result(most)
    type(die_t), intent(in) :: die
    integer, intent(in) :: middle(:, :)   !! (npoint, nside) middle piece of each point
    integer :: most
    integer :: pieces(pieces_in_reach*size(middle, 1)), e, n

    most = 1
    do e = 1, size(middle, 2)
      call list_pieces(die, middle(:, e), n, pieces)
      most = max(most, n)
    end do
  end function most_pieces

  !> Nodes of an element with its pairs: those of the side, then those of its pieces. Where there is no further piece the
  !> side's first node stands, with which nothing new is coupled.
  pure function paired_nodes(die, side, middle, npiece) result(nodes)
    type(die_t), intent(in) :: die
    integer, intent(in) :: side(:)     !! (3) nodes of the side
    integer, intent(in) :: middle(:)   !! (npoint) middle piece of each point
    integer, intent(in) :: npiece      !! pieces to make room for
    integer :: nodes(size(side) + nodes_per_piece*npiece)
    integer :: pieces(pieces_in_reach*size(middle)), k, n

    call list_pieces(die, middle, n, pieces)
    nodes(:size(side)) = side
    do k = 1, npiece
      associate (own => nodes(size(side) + nodes_per_piece*(k - 1) + 1:size(side) + nodes_per_piece*k))
        own = side(1)
        if (k <= n) own = die%nodes(:, pieces(k))
      end associate
    end do
  end function paired_nodes

  !> The k-th piece in reach of a point, 0 where the die has ended or the point has no pair.
  pure function piece_in_reach(die, middle, k) result(piece)
    type(die_t), intent(in) :: die
    integer, intent(in) :: middle, k
    integer :: piece

    piece = 0
    if (middle == 0) return
    piece = middle + k - 2
    associate (n => size(die%nodes, 2))
      if (piece >= 1 .and. piece <= n) return
      piece = merge(modulo(piece - 1, n) + 1, 0, die%nodes(3, n) == die%nodes(1, 1) .and. n >= pieces_in_reach)
    end associate
  end function piece_in_reach

  !> Which of the pieces in reach of a point a piece is, 0 for none.
  pure function place_in_reach(die, middle, piece) result(k)
    type(die_t), intent(in) :: die
    integer, intent(in) :: middle, piece
    integer :: k

    do k = pieces_in_reach, 1, -1
      if (piece_in_reach(die, middle, k) == piece) return
    end do
  end function place_in_reach

end module pairs
