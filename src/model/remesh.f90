!> A mesh in place of the deck's own: the data of a remesh for the cards.
module remesh
  use kinds, only: wp
  use mesh, only: side_set_t
  use remesher_options, only: own_mesh_t
  use scene, only: wall_t
  use text, only: string_t
  implicit none
  private
  public :: remesh_t, elements_t

  !> Elements of a group of the deck.
  type :: elements_t
    character(len=:), allocatable :: name
    !> What the group is (scene): bodies have elements of their own.
    integer :: role = 0
    !> Nodes (nnode, nelem).
    integer, allocatable :: connectivity(:, :)
  end type elements_t

  type :: remesh_t
    !> 1 for the deck's own mesh; nothing but the operation and `folding` is filled then.
    integer :: generation = 1
    !> Operation that goes on, or begins, on it; 0 for a deck without any.
    integer :: operation = 0
    !> Bodies whose sides have met without a card that gives them contact, by the name of a group of each.
    type(string_t), allocatable :: folding(:)
    !> Steps before this mesh; 0: the bodies are at rest on it, as the cards have them.
    integer :: step = 0
    !> Where the nodes are at the start of this mesh, and where their material was at the start of the first (2, nnode) [length].
    real(wp), allocatable :: coordinates(:, :), origin(:, :)
    !> All groups and all sets of sides of the scene, in its order.
    type(elements_t), allocatable :: groups(:)
    type(side_set_t), allocatable :: sides(:)
    !> Walls that have been found before; their nodes are found anew.
    type(wall_t), allocatable :: walls(:)
    !> The deck's own mesh, which is not made again.
    type(own_mesh_t) :: own_mesh
  end type remesh_t
end module remesh
