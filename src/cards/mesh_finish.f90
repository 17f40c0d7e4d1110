!> From the parts of a mesh to the mesh: nodes made one, numbers and labels, groups, and what must hold for all.
module mesh_finish
  use block_mesh, only: least_jacobian, polygon_area
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: wp
  use law_api, only: law_of_material
  use mesh_parts, only: body_t, mesh_parts_t, root_of
  use scene, only: axisymmetric, group_t, role_body
  use scene_draft, only: draft_t, find_elem
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: finish_mesh

  !> A radius below zero by less than this share of the mesh is round-off.
  real(wp), parameter :: axis_tolerance = 1.0e-9_wp

contains

  !> Fill the mesh and the groups of bodies of the scene.
  subroutine finish_mesh(draft, parts, diagnostics)
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout) :: diagnostics
    integer, allocatable :: number(:), kept(:)
    integer :: i, k, n, before, next_label

    allocate (number(size(parts%labels)), kept(size(parts%labels)))
    n = 0
    do i = 1, size(number)
      if (root_of(parts%parent, i) /= i) cycle
      n = n + 1
      number(i) = n
      kept(n) = i
    end do
    do i = 1, size(number)
      number(i) = number(root_of(parts%parent, i))
    end do
    associate (mesh => draft%scene%mesh)
      mesh%coordinates = parts%coordinates(:, kept(:n))
      if (.not. allocated(mesh%origin)) mesh%origin = mesh%coordinates
      mesh%labels = parts%labels(kept(:n))
      next_label = 0
      if (parts%nexplicit > 0) next_label = maxval(parts%labels)
      do i = 1, n
        if (kept(i) <= parts%nexplicit) cycle
        next_label = next_label + 1
        mesh%labels(i) = next_label
      end do
      do k = 1, size(mesh%sides)
        call renumber(mesh%sides(k)%nodes, number)
      end do
      draft%mesh_size = 0
      if (n > 0) draft%mesh_size = length_of(maxval(mesh%coordinates, 2) - minval(mesh%coordinates, 2))
    end associate
    allocate (draft%scene%groups(size(parts%bodies)))
    do i = 1, size(parts%bodies)
      call renumber(parts%bodies(i)%connectivity, number)
      call fill_group(draft, parts%bodies(i), draft%scene%groups(i))
      draft%group_where = [draft%group_where, location_t()]
      draft%groups_sound = draft%groups_sound .and. has_law(draft, draft%scene%groups(i)%material)
    end do
    draft%mesh_sound = parts%sound
    if (.not. parts%sound) return

    before = diagnostics%count()
    call count_sharing(draft, n)
    call refuse_lonely_nodes(draft, parts, number, diagnostics)
    call refuse_negative_radius(draft, parts, kept(:n), diagnostics)
    do i = 1, size(parts%bodies)
      call check_elements(draft%scene%mesh%coordinates, parts%bodies(i), diagnostics)
    end do
    draft%mesh_sound = diagnostics%count() == before
  end subroutine finish_mesh

  pure subroutine renumber(nodes, number)
    integer, intent(inout) :: nodes(:, :)
    integer, intent(in) :: number(:)
    integer :: i, j

    do j = 1, size(nodes, 2)
      do i = 1, size(nodes, 1)
        nodes(i, j) = number(nodes(i, j))
      end do
    end do
  end subroutine renumber

  !> The material of a body is known, and made of a law that is.
  pure function has_law(draft, material) result(yes)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: material
    logical :: yes

    yes = material > 0
    if (yes) yes = draft%scene%materials(material)%law_id > 0
  end function has_law

  !> A group of the scene from a body.
  subroutine fill_group(draft, body, group)
    type(draft_t), intent(in) :: draft
    type(body_t), intent(in) :: body
    type(group_t), intent(out) :: group
    integer :: law

    group%name = body%name
    group%elem = body%elem
    group%elem_id = find_elem(draft%elems, body%elem)
    group%material = body%material
    group%rule%n = body%npoint
    group%option = body%option
    group%role = role_body
    group%connectivity = body%connectivity
    allocate (group%variables(0))
    if (body%material == 0) return
    law = draft%scene%materials(body%material)%law_id
    if (law == 0) return
    deallocate (group%variables)
    call draft%elems(group%elem_id)%variables(law_of_material(draft%laws(law), draft%scene%materials(group%material)), &
                                                     draft%scene%plane_state, group%variables)
  end subroutine fill_group

  !> A side on the boundary is that of one element: its middle node shows it. Elements of bodies that are asleep are not there.
  subroutine count_sharing(draft, nnode)
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: nnode
    integer :: g, e, k

    deallocate (draft%sharing, draft%owner, draft%beginning)
    allocate (draft%sharing(nnode), draft%owner(nnode), draft%beginning(nnode), source=0)
    do g = 1, size(draft%scene%groups)
      if (any([(draft%sleepers(k)%s == draft%scene%groups(g)%name, k=1, size(draft%sleepers))])) cycle
      associate (group => draft%scene%groups(g))
        do e = 1, size(group%connectivity, 2)
          do k = 5, 8
            associate (node => group%connectivity(k, e))
              draft%sharing(node) = draft%sharing(node) + 1
              draft%owner(node) = group%material
              draft%beginning(node) = group%connectivity(k - 4, e)
            end associate
          end do
        end do
      end associate
    end do
  end subroutine count_sharing

  subroutine refuse_lonely_nodes(draft, parts, number, diagnostics)
    type(draft_t), intent(in) :: draft
    type(mesh_parts_t), intent(in) :: parts
    integer, intent(in) :: number(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    logical :: attached(size(draft%scene%mesh%labels))
    integer :: g, e, i

    attached = .false.
    do g = 1, size(draft%scene%groups)
      do e = 1, size(draft%scene%groups(g)%connectivity, 2)
        attached(draft%scene%groups(g)%connectivity(:, e)) = .true.
      end do
    end do
    do i = 1, parts%nexplicit
      if (attached(number(i))) cycle
      call diagnostics%add(parts%location(i), 'NODES', 'node '//to_text(parts%labels(i))//' belongs to no element')
    end do
  end subroutine refuse_lonely_nodes

  !> Axisymmetric scenes have no radius below zero.
  subroutine refuse_negative_radius(draft, parts, kept, diagnostics)
    type(draft_t), intent(in) :: draft
    type(mesh_parts_t), intent(in) :: parts
    integer, intent(in) :: kept(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: last
    integer :: i

    if (draft%scene%plane_state /= axisymmetric) return
    do i = 1, size(kept)
      if (draft%scene%mesh%coordinates(1, i) >= -axis_tolerance*draft%mesh_size) cycle
      ! A block is reported once.
      if (parts%location(kept(i))%line == last%line .and. parts%location(kept(i))%file == last%file) cycle
      last = parts%location(kept(i))
      call diagnostics%add(last, merge('NODES', 'BLOCK', kept(i) <= parts%nexplicit), &
                           'a node lies at the radius '//to_text(draft%scene%mesh%coordinates(1, i)) &
                           //'; in an axisymmetric scene x must not be below 0')
    end do
  end subroutine refuse_negative_radius

  !> Elements are counter-clockwise, do not fold, and have eight nodes after joining.
  subroutine check_elements(coordinates, body, diagnostics)
    real(wp), intent(in) :: coordinates(:, :)
    type(body_t), intent(in) :: body
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: where
    character(len=:), allocatable :: keyword, which, message
    real(wp) :: x(2, 8)
    integer :: e, i

    do e = 1, size(body%connectivity, 2)
      message = ''
      keyword = body%elem
      which = ''
      x = coordinates(:, body%connectivity(:, e))
      if (.not. polygon_area(x(:, 1:4)) > 0) then
        message = 'its corners must run counter-clockwise, and they do not'
      else if (.not. least_jacobian(x, body%npoint) > 0) then
        message = 'it is folded: the Jacobian is not above zero everywhere; its corners or middle nodes are too far off'
      end if
      do i = 2, 8
        if (any(body%connectivity(:i - 1, e) == body%connectivity(i, e))) message = 'two of its nodes are one after joining'
      end do
      if (message == '') cycle
      if (body%is_block) then
        where = body%location(1)
        keyword = 'BLOCK'
        which = to_text(mod(e - 1, body%across) + 1)//' along side 1, '//to_text((e - 1)/body%across + 1)//' along side 2'
      else
        where = body%location(e)
        which = to_text(body%labels(e))
      end if
      call diagnostics%add(where, keyword, 'element '//which//': '//message)
      ! The elements of a block fail for one reason.
      if (body%is_block) return
    end do
  end subroutine check_elements

end module mesh_finish
