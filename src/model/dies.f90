!> Dies: an ordered chain of parabolas, moved by a pilot when rigid, by the nodes of bodies when deformable.
!>
!> Walking along the chain the part is on the left and the die's body on the right (annex 3). A
!> piece is the isoparametric parabola through three points, y(xi) = sum_k phi_k(xi) Y_k; a segment
!> is one with its middle point in the middle. Pieces are stored in the axes of the pilot: a point
!> X of the die stands at `c + R(theta) X` when the pilot is at c and has turned by theta. A deformable
!> die is a chain of sides of bodies, walked against the walk around these; its pilot stays at the origin.
module dies
  use kinds, only: wp
  use vectors, only: length_of
  implicit none
  private
  public :: die_t, finish_die, is_deformable, place_on_nodes

  type :: die_t
    character(len=:), allocatable :: name
    !> Points of the pieces (2, 3, npiece) in the pilot's axes [length].
    real(wp), allocatable :: pieces(:, :, :)
    !> Smallest boxes around the pieces: (xmin, ymin, xmax, ymax; npiece), in the pilot's axes.
    real(wp), allocatable :: boxes(:, :)
    !> Boxes around runs of pieces: the inner nodes of a binary tree. Node 1 holds all, node i the nodes 2 i and 2 i + 1;
    !> after the inner nodes come the pieces in their order, so that piece k is node size(tree, 2) + k.
    real(wp), allocatable :: tree(:, :)
    !> The last piece ends where the first one begins: they share a vertex.
    logical :: closed = .false.
    !> Where the pilot stands at the start (x, y, angle).
    real(wp) :: pilot(3) = 0.0_wp
    !> Nodes of the pieces of a deformable die (3, npiece); not allocated for a rigid one.
    integer, allocatable :: nodes(:, :)
  end type die_t

contains

  !> Move the points into the pilot's axes and make the boxes.
  !> The box of a parabola is that of its Bezier points, which contain it.
  pure subroutine finish_die(die)
    type(die_t), intent(inout) :: die
    integer :: k, i
    real(wp) :: bezier(2)

    if (allocated(die%boxes)) deallocate (die%boxes)
    allocate (die%boxes(4, size(die%pieces, 3)))
    do k = 1, size(die%pieces, 3)
      do i = 1, 3
        die%pieces(:, i, k) = die%pieces(:, i, k) - die%pilot(1:2)
      end do
      associate (p => die%pieces(:, :, k))
        bezier = 2*p(:, 2) - 0.5_wp*(p(:, 1) + p(:, 3))
        die%boxes(1:2, k) = min(p(:, 1), p(:, 3), bezier)
        die%boxes(3:4, k) = max(p(:, 1), p(:, 3), bezier)
      end associate
    end do
    call grow_tree(die%boxes, die%tree)
    associate (n => size(die%pieces, 3))
      die%closed = n > 1 .and. .not. length_of(die%pieces(:, 3, n) - die%pieces(:, 1, 1)) > 0
    end associate
  end subroutine finish_die

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

  elemental function is_deformable(die) result(yes)
    type(die_t), intent(in) :: die
    logical :: yes

    yes = allocated(die%nodes)
  end function is_deformable

  !> Put the pieces of a deformable die where its nodes are.
  pure subroutine place_on_nodes(coordinates, die)
    real(wp), intent(in) :: coordinates(:, :)   !! of all nodes (2, nnode) [length]
    type(die_t), intent(inout) :: die
    integer :: k

    do k = 1, size(die%nodes, 2)
      die%pieces(:, :, k) = coordinates(:, die%nodes(:, k))
    end do
    call finish_die(die)
  end subroutine place_on_nodes

end module dies
