!> Where the bodies of a scene have a field: a card that gives a value or a load elsewhere would be without effect, and is refused.
module field_places
  use deck_cursor, only: cursor_t
  use diagnostics, only: diagnostics_t, location_t
  use elem_api, only: applies
  use element_fields, only: acts_on
  use fields, only: find_field, has_corners_only
  use scene, only: role_body, role_second
  use scene_draft, only: draft_t
  implicit none
  private
  public :: refuse_without_field, refuse_unlike_nodes

contains

  !> The card fails where one of these nodes is not of a body with the field, or, with `own`, where none has a value of its own.
  !> Nothing is checked while bodies have mistakes.
  subroutine refuse_without_field(cursor, draft, field, nodes, label, own)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: field            !! position in the scene's list
    integer, intent(in) :: nodes(:)         !! (n)
    character(len=*), intent(in) :: label   !! the nodes, as messages name them
    logical, intent(in) :: own
    logical, allocatable :: has(:), is_own(:)
    integer :: g

    if (cursor%failed() .or. .not. (draft%mesh_sound .and. draft%groups_sound) .or. size(nodes) == 0) return
    allocate (has(size(draft%scene%mesh%labels)), is_own(size(draft%scene%mesh%labels)), source=.false.)
    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        if (group%role /= role_body .and. group%role /= role_second) cycle
        if (.not. acts_on(draft%elems(group%elem_id), draft%scene%fields(field)%name)) cycle
        has(reshape(group%connectivity, [size(group%connectivity)])) = .true.
        associate (last => merge(4, size(group%connectivity, 1), has_corners_only(draft%scene%fields(field))))
          is_own(reshape(group%connectivity(:last, :), [last*size(group%connectivity, 2)])) = .true.
        end associate
      end associate
    end do
    ! what is given can be seen, not set
    if (draft%scene%fields(field)%given .and. .not. own) then
      do g = 1, size(draft%scene%histories)
        if (draft%scene%histories(g)%field == field) has(draft%scene%histories(g)%nodes) = .true.
      end do
    end if
    if (.not. all(has(nodes))) then
      call cursor%fail(label//': nodes here are of a body without '//draft%scene%fields(field)%name)
    else if (own .and. .not. any(is_own(nodes))) then
      call cursor%fail(label//' has no '//draft%scene%fields(field)%name//' of its own, corners of elements have')
    end if
  end subroutine refuse_without_field

  !> All bodies have a field on the same nodes of their elements: at corners only, or on all.
  subroutine refuse_unlike_nodes(draft, diagnostics)
    type(draft_t), intent(in) :: draft
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=*), parameter :: nodes(2) = [character(len=11) :: 'all nodes', 'the corners']
    type(location_t) :: where
    character(len=:), allocatable :: keyword
    integer :: g, u, k, n

    keyword = ''
    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g), elem => draft%elems(draft%scene%groups(g)%elem_id))
        do u = 1, size(elem%unknowns)
          if (elem%unknowns(u)%optional .or. .not. applies(elem%unknowns(u), draft%scene%plane_state, group%option)) cycle
          k = find_field(draft%scene%fields, elem%unknowns(u)%field%name)
          if (elem%unknowns(u)%field%at_corners .eqv. draft%scene%fields(k)%at_corners) cycle
          keyword = 'ADDEL'
          where = draft%group_where(g)
          do n = 1, size(draft%places%words)
            if (draft%places%words(n)%s /= group%name) cycle
            keyword = draft%places%keywords(n)%s
            where = draft%places%location(n)
          end do
          call diagnostics%add(where, keyword, group%name//' has a '//draft%scene%fields(k)%name//' on ' &
                               //trim(nodes(merge(2, 1, elem%unknowns(u)%field%at_corners)))//' of elements, other bodies on ' &
                               //trim(nodes(merge(2, 1, draft%scene%fields(k)%at_corners)))//'; expected all alike')
        end do
      end associate
    end do
  end subroutine refuse_unlike_nodes

end module field_places
