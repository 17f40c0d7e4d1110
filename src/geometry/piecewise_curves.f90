!> An oriented curve of parabolas, joined end to end, with a tree of boxes to search it by.
module piecewise_curves
  use kinds, only: wp
  use parabolas, only: box_of_parabola
  use vectors, only: length_of
  implicit none
  private
  public :: piecewise_curve_t, prepare_search, adjacent_piece, blunt

  !> A vertex where a curve turns by less than this sine is no corner: parabolas that follow a curve within a tolerance turn by up
  !> to 3 degrees where they meet.
  real(wp), parameter :: blunt = 0.1_wp

  type :: piecewise_curve_t
    !> Points of the pieces (2, 3, npiece) [length].
    real(wp), allocatable :: pieces(:, :, :)
    !> Boxes around the pieces: (xmin, ymin, xmax, ymax; npiece) [length].
    real(wp), allocatable :: boxes(:, :)
    !> Boxes around sequences of pieces: the inner nodes of a binary tree. Node 1 holds all, node i the nodes 2 i and 2 i + 1;
    !> after the inner nodes come the pieces in their order, so that piece k is node size(tree, 2) + k.
    real(wp), allocatable :: tree(:, :)
    !> The last piece ends where the first one begins: they share a vertex.
    logical :: closed = .false.
  end type piecewise_curve_t

contains

  !> Boxes and tree of a curve whose pieces are known.
  pure subroutine prepare_search(curve)
    class(piecewise_curve_t), intent(inout) :: curve
    integer :: k

    if (allocated(curve%boxes)) deallocate (curve%boxes)
    allocate (curve%boxes(4, size(curve%pieces, 3)))
    do k = 1, size(curve%pieces, 3)
      curve%boxes(:, k) = box_of_parabola(curve%pieces(:, :, k))
    end do
    call grow_tree(curve%boxes, curve%tree)
    associate (n => size(curve%pieces, 3))
      curve%closed = n > 1
      if (curve%closed) curve%closed = .not. length_of(curve%pieces(:, 3, n) - curve%pieces(:, 1, 1)) > 0
    end associate
  end subroutine prepare_search

  !> Inner nodes of the tree over the boxes, as many as make its lowest row full; those over no piece stay empty.
  pure subroutine grow_tree(boxes, tree)
    real(wp), intent(in) :: boxes(:, :)
    real(wp), allocatable, intent(out) :: tree(:, :)
    integer :: leaves, i

    leaves = 1
    do while (leaves < size(boxes, 2))
      leaves = 2*leaves
    end do
    allocate (tree(4, leaves - 1))
    do i = leaves - 1, 1, -1
      tree(1:2, i) = min(low_of(2*i), low_of(2*i + 1))
      tree(3:4, i) = max(high_of(2*i), high_of(2*i + 1))
    end do

  contains

    pure function low_of(node) result(low)
      integer, intent(in) :: node
      real(wp) :: low(2)

      low = huge(low)
      if (node < leaves) then
        low = tree(1:2, node)
      else if (node - leaves < size(boxes, 2)) then
        low = boxes(1:2, node - leaves + 1)
      end if
    end function low_of

    pure function high_of(node) result(high)
      integer, intent(in) :: node
      real(wp) :: high(2)

      high = -huge(high)
      if (node < leaves) then
        high = tree(3:4, node)
      else if (node - leaves < size(boxes, 2)) then
        high = boxes(3:4, node - leaves + 1)
      end if
    end function high_of

  end subroutine grow_tree

  !> The piece before (-1) or after (1) a piece, 0 where the curve ends.
  pure function adjacent_piece(curve, piece, way) result(next)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece, way
    integer :: next

    next = piece + way
    if (next >= 1 .and. next <= size(curve%pieces, 3)) return
    next = 0
    if (curve%closed) next = merge(1, size(curve%pieces, 3), way > 0)
  end function adjacent_piece

end module piecewise_curves
