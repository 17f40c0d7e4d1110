!> The members of the mesh, of dies, supports and walls (visitors).
module visit_parts
  use dies, only: die_t, is_deformable
  use loads, only: fixation_t
  use mesh, only: mesh_t, side_set_t
  use scene, only: wall_t
  use visitors, only: kept, of_the_mesh, visitor_t
  implicit none
  private
  public :: visit_die, visit_fixation, visit_mesh, visit_wall

  !> Sets of sides at most.
  integer, parameter :: most_sets = 100000
  character(len=*), parameter :: of_the_deck = 'the solver reads it from the deck', of_the_pieces = 'follows from the pieces'

contains

  subroutine visit_mesh(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(mesh_t), intent(inout) :: self
    integer :: k, n

    call visitor%member('coordinates', self%coordinates, of_the_mesh, '2, node', 'length')
    call visitor%member('origin', self%origin, of_the_mesh, '2, node', 'length')
    call visitor%member('labels', self%labels, of_the_mesh, 'node')
    n = 0
    if (allocated(self%sides)) n = size(self%sides)
    call visitor%list('sides', n, most_sets)
    if (.not. allocated(self%sides)) allocate (self%sides(n))
    do k = 1, n
      call visitor%enter_item('sides', k)
      call visit_side_set(visitor, self%sides(k))
      call visitor%leave('sides')
    end do
  end subroutine visit_mesh

  subroutine visit_side_set(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(side_set_t), intent(inout) :: self

    call visitor%member('name', self%name, kept)
    call visitor%member('nodes', self%nodes, of_the_mesh, '3, side', low=1)
  end subroutine visit_side_set

  subroutine visit_die(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(die_t), intent(inout) :: self
    character(len=:), allocatable :: carried
    logical :: deformable

    call visitor%member('name', self%name, kept)
    deformable = is_deformable(self)
    carried = kept
    if (deformable) carried = of_the_mesh
    call visitor%member('pieces', self%pieces, carried, '2, 3, piece', 'length')
    call visitor%member('deformable', deformable, kept)
    call visitor%member('unasked', self%unasked, kept)
    if (deformable) call visitor%member('nodes', self%nodes, of_the_mesh, '3, piece', low=1)
    call visitor%fixed('start', self%pilot, kept, 'length')
    call visitor%derived('boxes', of_the_pieces)
    call visitor%derived('tree', of_the_pieces)
    call visitor%derived('closed', of_the_pieces)
    call visitor%derived('corners', of_the_pieces)
    call visitor%derived('corner_piece', of_the_pieces)
    call visitor%derived('corner_xi', of_the_pieces)
  end subroutine visit_die

  subroutine visit_fixation(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(fixation_t), intent(inout) :: self

    call visitor%member('nodes', self%nodes, of_the_mesh, 'node', low=1)
    call visitor%member('component', self%component, of_the_mesh, low=1, high=2)
    call visitor%derived('amplitude', of_the_deck)
    call visitor%derived('multiplier', of_the_deck)
    call visitor%derived('field', of_the_deck)
    call visitor%derived('may_pass', of_the_deck)
    call visitor%derived('label', of_the_deck)
  end subroutine visit_fixation

  subroutine visit_wall(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(wall_t), intent(inout) :: self

    call visitor%member('label', self%label, kept)
    call visitor%member('component', self%component, kept, low=1, high=2)
    call visitor%member('side', self%side, kept, low=-1, high=1)
    call visitor%member('node', self%node, of_the_mesh, low=1)
  end subroutine visit_wall

end module visit_parts
