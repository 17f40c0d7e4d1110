!> Contact pairs: the pieces of deformable dies that points of sides are coupled with.
!>
!> A point in reach of a deformable die has the nodes of three pieces in a row among its element's
!> unknowns, the middle one being that of its closest point when the pairs were last renewed. A point far from
!> the die has none. The pattern of the matrix depends on the pairs, and on nothing else that moves.
module pairs
  use dies, only: die_t
  use scene, only: scene_t
  implicit none
  private
  public :: pairs_t, pieces_in_reach, nodes_per_point
  public :: start_pairs, pairs_differ, paired_nodes, place_in_reach

  !> Pieces a point is coupled with, and their nodes.
  integer, parameter :: pieces_in_reach = 3, nodes_per_point = 3*pieces_in_reach

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
        if (group%pairs == 0) cycle
        allocate (pairs(group%pairs)%piece(group%rule%n, size(group%connectivity, 2)), source=0)
      end associate
    end do
  end subroutine start_pairs

  pure function pairs_differ(one, other) result(differ)
    type(pairs_t), intent(in) :: one(:), other(:)   !! (npair) of the groups that face a deformable die
    logical :: differ
    integer :: k

    differ = .false.
    do k = 1, size(one)
      differ = differ .or. any(one(k)%piece /= other(k)%piece)
    end do
  end function pairs_differ

  !> Nodes of an element with its pairs: those of the side, then for each point those of its pieces in reach. Where there is
  !> no piece the side's first node stands, with which nothing new is coupled.
  pure function paired_nodes(die, side, middle) result(nodes)
    type(die_t), intent(in) :: die
    integer, intent(in) :: side(:)     !! (3) nodes of the side
    integer, intent(in) :: middle(:)   !! (npoint) middle piece of each point
    integer :: nodes(size(side) + nodes_per_point*size(middle))
    integer :: p, k, n, piece

    nodes(:size(side)) = side
    n = size(side)
    do p = 1, size(middle)
      do k = 1, pieces_in_reach
        piece = piece_in_reach(die, middle(p), k)
        nodes(n + 1:n + 3) = side(1)
        if (piece > 0) nodes(n + 1:n + 3) = die%nodes(:, piece)
        n = n + 3
      end do
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
