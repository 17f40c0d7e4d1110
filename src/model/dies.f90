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
  public :: die_t, finish_die, is_deformable, place_on_nodes, present_die

  !> A vertex where the chain turns by less than this sine is no corner: parabolas that follow a curve within a tolerance turn
  !> by up to 3 degrees where they meet.
  real(wp), parameter :: blunt = 0.1_wp

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
    !> Corners of a rigid die that point to the part, open ends included: the point, and the tangents before and behind it
    !> (x, y, t1x, t1y, t2x, t2y; ncorner), in the pilot's axes; the piece each belongs to, and the place on it.
    real(wp), allocatable :: corners(:, :)
    integer, allocatable :: corner_piece(:)
    real(wp), allocatable :: corner_xi(:)
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
      die%closed = n > 1
      if (die%closed) die%closed = .not. length_of(die%pieces(:, 3, n) - die%pieces(:, 1, 1)) > 0
    end associate
    if (.not. is_deformable(die)) call list_corners(die)
  end subroutine finish_die

  !> Vertices where the chain turns right, away from the part. At an open end the body is taken to go down at a right angle.
  pure subroutine list_corners(die)
    type(die_t), intent(inout) :: die
    real(wp) :: list(6, size(die%pieces, 3) + 1), t1(2), t2(2)
    integer :: piece(size(die%pieces, 3) + 1)
    integer :: k, n, npiece

    npiece = size(die%pieces, 3)
    n = 0
    t1 = 0
    do k = 0, npiece
      if (k == 0 .and. (die%closed .or. npiece == 0)) cycle
      if (k > 0) t1 = end_tangent(die%pieces(:, :, k), 1)
      if (k < npiece) then
        t2 = end_tangent(die%pieces(:, :, k + 1), -1)
      else if (die%closed) then
        t2 = end_tangent(die%pieces(:, :, 1), -1)
      else
        t2 = [t1(2), -t1(1)]
      end if
      if (k == 0) t1 = [-t2(2), t2(1)]
      if (t1(1)*t2(2) - t1(2)*t2(1) > -blunt .and. dot_product(t1, t2) > 0) cycle
      if (t1(1)*t2(2) - t1(2)*t2(1) > 0) cycle
      n = n + 1
      piece(n) = k
      list(1:2, n) = die%pieces(:, 1, max(k, 1))
      if (k > 0) list(1:2, n) = die%pieces(:, 3, k)
      list(3:6, n) = [t1, t2]
    end do
    die%corners = list(:, :n)
    die%corner_piece = max(piece(:n), 1)
    die%corner_xi = merge(-1.0_wp, 1.0_wp, piece(:n) == 0)
  end subroutine list_corners

  !> Unit tangent at the start (-1) or end (1) of a piece.
  pure function end_tangent(piece, xi) result(t)
    real(wp), intent(in) :: piece(2, 3)
    integer, intent(in) :: xi
    real(wp) :: t(2)

    t = (xi - 0.5_wp)*piece(:, 1) - 2*xi*piece(:, 2) + (xi + 0.5_wp)*piece(:, 3)
    t = t/length_of(t)
  end function end_tangent

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

  !> The die as its nodes now are; a rigid one is as it was: its pilot moves it.
  pure function present_die(die, coordinates) result(now)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: coordinates(:, :)   !! of all nodes (2, nnode) [length]
    type(die_t) :: now

    now = die
    if (is_deformable(now)) call place_on_nodes(coordinates, now)
  end function present_die

end module dies
