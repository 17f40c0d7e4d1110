!> A remeshed scene: the deck's cards on another mesh.
!>
!> Bodies, sets of sides and their names are the deck's; nodes and elements are those of the remesh. Cards name
!> places where they were in the deck's own mesh: `origin` of the new nodes is where their material was then.
module remeshed_parts
  use diagnostics, only: location_t
  use mesh, only: nearest_node
  use mesh_parts, only: mesh_parts_t
  use kinds, only: wp
  use remesh, only: remesh_t
  use scene, only: group_t
  use scene_draft, only: draft_t
  implicit none
  private
  public :: replace_parts, order_as_remeshed

contains

  !> Put the remesh in place of the parts that the cards have made, blocks without elements among them. Where it does not fit them
  !> the scene keeps its generation. Labels of nodes now mean the nearest node of the new mesh.
  subroutine replace_parts(remesh, draft, parts)
    type(remesh_t), intent(in) :: remesh
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(location_t), allocatable :: first(:)
    real(wp) :: distance
    integer :: i, k, nnode

    if (.not. fits(remesh, draft, parts)) then
      ! blocks have no elements now: nothing is searched in them
      parts%sound = .false.
      return
    end if
    do i = 1, size(draft%labelled_nodes)
      call nearest_node(remesh%origin, parts%coordinates(:, draft%labelled_nodes(i)), k, distance)
      draft%labelled_nodes(i) = k
    end do
    nnode = size(remesh%coordinates, 2)
    parts%nexplicit = 0
    parts%coordinates = remesh%coordinates
    parts%labels = spread(0, 1, nnode)
    parts%parent = [(k, k=1, nnode)]
    allocate (first(nnode))
    first = parts%bodies(1)%location(1)
    call move_alloc(first, parts%location)
    do i = 1, size(parts%bodies)
      associate (body => parts%bodies(i))
        body%connectivity = remesh%groups(i)%connectivity
        ! elements of a remesh are known by their place in the body
        body%is_block = .false.
        body%labels = [(k, k=1, size(body%connectivity, 2))]
        allocate (first(size(body%labels)))
        first = body%location(1)
        call move_alloc(first, body%location)
      end associate
    end do
    draft%scene%mesh%sides = remesh%sides
    draft%scene%mesh%origin = remesh%origin
    draft%scene%generation = remesh%generation
  end subroutine replace_parts

  !> Are bodies and sets those of the deck?
  pure function fits(remesh, draft, parts) result(yes)
    type(remesh_t), intent(in) :: remesh
    type(draft_t), intent(in) :: draft
    type(mesh_parts_t), intent(in) :: parts
    logical :: yes
    integer :: i

    yes = parts%sound .and. remesh%generation > 1 .and. size(parts%bodies) > 0
    if (.not. yes) return
    yes = size(remesh%groups) >= size(parts%bodies) .and. size(remesh%sides) == size(draft%scene%mesh%sides)
    if (.not. yes) return
    do i = 1, size(parts%bodies)
      yes = yes .and. remesh%groups(i)%name == parts%bodies(i)%name .and. size(remesh%groups(i)%connectivity, 1) == 8
    end do
    do i = 1, size(remesh%sides)
      yes = yes .and. remesh%sides(i)%name == draft%scene%mesh%sides(i)%name
    end do
  end function fits

  !> Elements on sides in the order of the remesh, in which their state is stored.
  pure subroutine order_as_remeshed(remesh, groups)
    type(remesh_t), intent(in) :: remesh
    type(group_t), intent(inout) :: groups(:)   !! (ngroup)
    integer :: g

    do g = 1, min(size(groups), size(remesh%groups))
      if (remesh%groups(g)%name /= groups(g)%name .or. size(groups(g)%connectivity, 1) /= 3) cycle
      if (.not. same_sides(remesh%groups(g)%connectivity, groups(g)%connectivity)) cycle
      groups(g)%connectivity = remesh%groups(g)%connectivity
    end do
  end subroutine order_as_remeshed

  !> The same sides in any order: a side is known by its middle node.
  pure function same_sides(a, b) result(yes)
    integer, intent(in) :: a(:, :), b(:, :)
    logical :: yes
    integer :: k

    yes = all(shape(a) == shape(b))
    if (.not. yes) return
    do k = 1, size(a, 2)
      yes = yes .and. any(b(2, :) == a(2, k))
    end do
  end function same_sides

end module remeshed_parts
