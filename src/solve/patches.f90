!> Patches: the few elements where a residual is, what acts on their sides, and their unknowns.
module patches
  use dofs, only: dofs_t
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: is_solid, scene_t
  implicit none
  private
  public :: patch_map_t, patch_t, choose_patch, map_patches

  !> A patch grows until no more than this share of the residual is left outside.
  real(wp), parameter :: left_outside = 0.05_wp

  !> Elements by their nodes, as long as they keep them: those that face a deformable die do not.
  type :: patch_map_t
    !> Elements of bodies around node n: body(around(n):around(n+1)-1), element the same.
    integer, allocatable :: around(:), body(:), element(:)
    !> Elements of all groups whose first node is n: group(begun(n):begun(n+1)-1), begun_by the same.
    integer, allocatable :: begun(:), group(:), begun_by(:)
  end type patch_map_t

  type :: patch_t
    !> Elements one after the other in a group: group, first, last (nrun).
    integer, allocatable :: group(:), first(:), last(:)
    !> Unknowns that have an equation (n).
    integer, allocatable :: unknown(:)
  end type patch_t

contains

  !> Elements of a mesh by their nodes.
  subroutine map_patches(scene, dofs, map)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(patch_map_t), intent(out) :: map
    integer, allocatable :: next_around(:), next_begun(:)
    integer :: nnode, pass, g, e, k, n

    nnode = size(scene%mesh%coordinates, 2)
    allocate (map%around(nnode + 1), map%begun(nnode + 1), source=0)
    do pass = 1, 2
      do g = 1, size(dofs%groups)
        do e = 1, size(dofs%groups(g)%nodes, 2)
          if (size(dofs%groups(g)%nodes, 1) == 0) cycle
          n = dofs%groups(g)%nodes(1, e)
          call note(map%begun, next_begun, map%group, map%begun_by)
          if (.not. is_solid(scene%groups(g))) cycle
          do k = 1, size(dofs%groups(g)%nodes, 1)
            n = dofs%groups(g)%nodes(k, e)
            call note(map%around, next_around, map%body, map%element)
          end do
        end do
      end do
      if (pass == 2) exit
      call sum_up(map%around, next_around, map%body, map%element)
      call sum_up(map%begun, next_begun, map%group, map%begun_by)
    end do

  contains

    subroutine note(start, next, groups, elements)
      integer, intent(inout) :: start(:)
      integer, allocatable, intent(inout) :: next(:), groups(:), elements(:)

      if (pass == 1) then
        start(n + 1) = start(n + 1) + 1
        return
      end if
      groups(next(n)) = g
      elements(next(n)) = e
      next(n) = next(n) + 1
    end subroutine note

    subroutine sum_up(start, next, groups, elements)
      integer, intent(inout) :: start(:)
      integer, allocatable, intent(inout) :: next(:), groups(:), elements(:)
      integer :: i

      start(1) = 1
      do i = 1, nnode
        start(i + 1) = start(i + 1) + start(i)
      end do
      next = start(:nnode)
      allocate (groups(start(nnode + 1) - 1), elements(start(nnode + 1) - 1))
    end subroutine sum_up

  end subroutine map_patches

  !> The elements around the nodes with the largest residuals, at most so many, and all active elements that have no other nodes.
  !> Of no unknowns where a single node has more elements.
  subroutine choose_patch(dofs, map, active, equation, residual, most, patch)
    type(dofs_t), intent(in) :: dofs
    type(patch_map_t), intent(in) :: map
    logical, intent(in) :: active(:)       !! (ngroup)
    integer, intent(in) :: equation(:)     !! (ndof) of every unknown, 0 where it has none
    real(wp), intent(in) :: residual(:)    !! (ndof) [force]
    integer, intent(in) :: most            !! elements of bodies
    type(patch_t), intent(out) :: patch
    integer :: body(most), element(most), n
    logical :: inside(size(map%around) - 1)

    call take_elements(dofs, map, equation, residual, body, element, n)
    call mark_nodes(dofs, body(:n), element(:n), inside)
    call list_runs(dofs, map, active, inside, patch)
    call list_unknowns(dofs, equation, patch)
  end subroutine choose_patch

  !> Elements of bodies around the nodes with the largest residuals.
  subroutine take_elements(dofs, map, equation, residual, body, element, n)
    type(dofs_t), intent(in) :: dofs
    type(patch_map_t), intent(in) :: map
    integer, intent(in) :: equation(:)
    real(wp), intent(in) :: residual(:)
    integer, intent(out) :: body(:), element(:), n
    real(wp) :: square(size(map%around) - 1), whole, outside
    integer :: node, k, added, c

    associate (number => dofs%fields(displacement_field)%number)
      square = 0
      do node = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, node) == 0) cycle
          if (equation(number(c, node)) > 0) square(node) = square(node) + residual(number(c, node))**2
        end do
      end do
    end associate
    whole = sum(square)
    outside = whole
    n = 0
    do while (outside > left_outside**2*whole)
      node = maxloc(square, 1)
      added = 0
      do k = map%around(node), map%around(node + 1) - 1
        if (is_taken(map%body(k), map%element(k))) cycle
        added = added + 1
        if (n + added > size(body)) return
        body(n + added) = map%body(k)
        element(n + added) = map%element(k)
      end do
      n = n + added
      outside = outside - square(node)
      square(node) = 0
    end do

  contains

    pure function is_taken(g, e) result(yes)
      integer, intent(in) :: g, e
      logical :: yes

      yes = any(body(:n) == g .and. element(:n) == e)
    end function is_taken

  end subroutine take_elements

  !> Nodes of these elements.
  pure subroutine mark_nodes(dofs, body, element, inside)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: body(:), element(:)
    logical, intent(out) :: inside(:)
    integer :: k

    inside = .false.
    do k = 1, size(body)
      inside(dofs%groups(body(k))%nodes(:, element(k))) = .true.
    end do
  end subroutine mark_nodes

  !> All active elements with no nodes but these, those that follow each other in a group as one run.
  subroutine list_runs(dofs, map, active, inside, patch)
    type(dofs_t), intent(in) :: dofs
    type(patch_map_t), intent(in) :: map
    logical, intent(in) :: active(:), inside(:)
    type(patch_t), intent(inout) :: patch
    integer, allocatable :: group(:), element(:)
    integer :: node, k, i, n

    allocate (group(0), element(0))
    do node = 1, size(inside)
      if (.not. inside(node)) cycle
      do k = map%begun(node), map%begun(node + 1) - 1
        associate (g => map%group(k), e => map%begun_by(k))
          if (.not. active(g)) cycle
          if (.not. all(inside(dofs%groups(g)%nodes(:, e)))) cycle
          i = count(group < g .or. group == g .and. element < e)
          group = [group(:i), g, group(i + 1:)]
          element = [element(:i), e, element(i + 1:)]
        end associate
      end do
    end do
    allocate (patch%group(size(group)), patch%first(size(group)), patch%last(size(group)))
    n = 0
    do k = 1, size(group)
      if (n > 0) then
        if (patch%group(n) == group(k) .and. patch%last(n) == element(k) - 1) then
          patch%last(n) = element(k)
          cycle
        end if
      end if
      n = n + 1
      patch%group(n) = group(k)
      patch%first(n) = element(k)
      patch%last(n) = element(k)
    end do
    patch%group = patch%group(:n)
    patch%first = patch%first(:n)
    patch%last = patch%last(:n)
  end subroutine list_runs

  !> Unknowns of the elements that have equations, each once.
  pure subroutine list_unknowns(dofs, equation, patch)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: equation(:)
    type(patch_t), intent(inout) :: patch
    logical :: listed(size(equation))
    integer :: k, e, i, n

    listed = .false.
    n = 0
    do k = 1, size(patch%group)
      associate (dof => dofs%groups(patch%group(k))%dof)
        do e = patch%first(k), patch%last(k)
          do i = 1, size(dof, 1)
            if (equation(dof(i, e)) > 0) listed(dof(i, e)) = .true.
          end do
        end do
      end associate
    end do
    patch%unknown = pack([(i, i=1, size(listed))], listed)
  end subroutine list_unknowns

end module patches
