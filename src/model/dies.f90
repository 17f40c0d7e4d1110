!> Dies: an ordered chain of parabolas, moved by a pilot when rigid, by the nodes of bodies when deformable.
!>
!> Walking along the chain the part is on the left and the die's body on the right (annex 3). A
!> piece is the isoparametric parabola through three points, y(xi) = sum_k phi_k(xi) Y_k; a segment
!> is one with its middle point in the middle. Pieces are stored in the axes of the pilot: a point
!> X of the die stands at `c + R(theta) X` when the pilot is at c and has turned by theta. A deformable
!> die is a chain of sides of bodies, walked against the walk around these; its pilot stays at the origin.
module dies
  use kinds, only: wp
  implicit none
  private
  public :: die_t, finish_die, is_deformable, place_on_nodes

  type :: die_t
    character(len=:), allocatable :: name
    !> Points of the pieces (2, 3, npiece) in the pilot's axes [length].
    real(wp), allocatable :: pieces(:, :, :)
    !> Smallest boxes around the pieces: (xmin, ymin, xmax, ymax; npiece), in the pilot's axes.
    real(wp), allocatable :: boxes(:, :)
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
  end subroutine finish_die

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
