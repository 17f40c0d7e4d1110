!> Unknowns of every element, in the local order of the ELEM family, from those of the fields at its nodes.
module element_dofs
  use dofs, only: dofs_t
  use elem_api, only: elem_t, field_nodes
  use element_fields, only: layout_of
  use fields, only: field_t, on_nodes, on_pilots
  use pairs, only: most_pieces, nodes_per_piece, paired_nodes, pairs_t, start_pairs
  use scene, only: scene_t
  implicit none
  private
  public :: list_elements, number_pairs

contains

  !> Unknowns of every element.
  subroutine list_elements(scene, elems, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(dofs_t), intent(inout) :: dofs
    type(pairs_t), allocatable :: pairs(:)
    integer :: g

    allocate (dofs%groups(size(scene%groups)))
    call start_pairs(scene, pairs)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs > 0) cycle
      dofs%groups(g)%nodes = scene%groups(g)%connectivity
      call number_elements(scene, elems(scene%groups(g)%elem_id), g, dofs)
    end do
    call number_pairs(scene, elems, pairs, dofs)
  end subroutine list_elements

  !> Unknowns of the elements that face deformable dies, with the pairs of now.
  subroutine number_pairs(scene, elems, pairs, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)    !! (nelem_row)
    type(pairs_t), intent(in) :: pairs(:)   !! (npair)
    type(dofs_t), intent(inout) :: dofs
    integer :: g, e, n, npiece

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%pairs == 0) cycle
        associate (middle => pairs(group%pairs)%piece)
          npiece = most_pieces(scene%dies(group%die), middle)
          n = size(group%connectivity, 1) + nodes_per_piece*npiece
          if (allocated(dofs%groups(g)%nodes)) then
            if (size(dofs%groups(g)%nodes, 1) /= n) deallocate (dofs%groups(g)%nodes, dofs%groups(g)%dof)
          end if
          if (.not. allocated(dofs%groups(g)%nodes)) allocate (dofs%groups(g)%nodes(n, size(middle, 2)))
          do e = 1, size(middle, 2)
            dofs%groups(g)%nodes(:, e) = paired_nodes(scene%dies(group%die), group%connectivity(:, e), middle(:, e), npiece)
          end do
        end associate
        call number_elements(scene, elems(group%elem_id), g, dofs)
      end associate
    end do
  end subroutine number_pairs

  !> Unknowns of the elements of a group from their nodes.
  subroutine number_elements(scene, elem, g, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elem
    integer, intent(in) :: g
    type(dofs_t), intent(inout) :: dofs
    integer :: u, c

    associate (own => dofs%groups(g))
      own%layout = layout_of(elem, size(own%nodes, 1), scene%groups(g)%option, scene%plane_state, scene%fields)
      if (.not. allocated(own%dof)) allocate (own%dof(own%layout%ndof, size(own%nodes, 2)))
      do u = 1, own%layout%nfield
        associate (number => dofs%fields(own%layout%field(u))%number, first => own%layout%first)
          do c = 1, size(number, 1)
            call take_places(own%nodes, scene%groups(g)%die, scene%fields(own%layout%field(u)), number(c, :), &
                             own%dof(first(c, u):first(c, u) + own%layout%count(u) - 1, :))
          end do
        end associate
      end do
    end associate
  end subroutine number_elements

  !> Unknowns of one component of a field, of all elements of a group.
  pure subroutine take_places(nodes, die, field, number, dof)
    integer, intent(in) :: nodes(:, :)   !! (nnode, nelem)
    integer, intent(in) :: die           !! of the group, 0 for none
    type(field_t), intent(in) :: field
    integer, intent(in) :: number(:)     !! (place) the component's unknowns
    integer, intent(out) :: dof(:, :)    !! (count, nelem)
    integer :: local(size(dof, 1)), e

    select case (field%place)
    case (on_nodes)
      local = field_nodes(field, size(nodes, 1))
      do e = 1, size(nodes, 2)
        dof(:, e) = number(nodes(local, e))
      end do
    case (on_pilots)
      dof = number(die)
    case default
      dof = number(1)
    end select
  end subroutine take_places

end module element_dofs
