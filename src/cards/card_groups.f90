!> From a card to a group of the scene: what the cards of groups have in common.
module card_groups
  use deck_cursor, only: cursor_t
  use deck_reader, only: card_t
  use diagnostics, only: diagnostics_t, location_t
  use element_fields, only: acts_on
  use scene, only: group_t
  use scene_draft, only: close_card, draft_t, find_elem
  implicit none
  private
  public :: append_group, close_group, refuse_second, start_group

contains

  !> A group of load elements without state.
  subroutine start_group(elem, draft, group)
    character(len=*), intent(in) :: elem
    type(draft_t), intent(in) :: draft
    type(group_t), intent(out) :: group

    group%name = ''
    group%elem = elem
    group%elem_id = find_elem(draft%elems, elem)
    ! a program of fewer elements refuses the card: no body has the field that it acts on
    if (group%elem_id > 0) then
      associate (row => draft%elems(group%elem_id))
        group%role = row%role
        group%brings_heat = acts_on(row, 'temperature')
        group%is_spring = row%is_spring
      end associate
    end if
    allocate (group%variables(0))
  end subroutine start_group

  !> What a card says of one place by one name is said once.
  subroutine refuse_second(cursor, draft, group, what, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: what   !! it is, for the message
    type(diagnostics_t), intent(in), target :: diagnostics
    integer :: g

    do g = 1, size(draft%scene%groups)
      if (draft%scene%groups(g)%name == group%name .and. draft%scene%groups(g)%elem == group%elem) &
        call cursor%fail(what//' is already given at '//diagnostics%place(draft%group_where(g)))
    end do
  end subroutine refuse_second

  !> The card ends: its group is added to the scene, or, where the card has a mistake, groups are noted as unsound.
  subroutine close_group(draft, cursor, card, group)
    type(draft_t), intent(inout) :: draft
    type(cursor_t), intent(inout) :: cursor
    type(card_t), intent(in) :: card
    type(group_t), intent(in) :: group

    call close_card(draft, cursor, card)
    if (cursor%failed()) then
      draft%groups_sound = .false.
    else
      call append_group(draft, group, cursor%where())
    end if
  end subroutine close_group

  !> Add a group to the scene, and the place of its card.
  subroutine append_group(draft, group, where)
    type(draft_t), intent(inout) :: draft
    type(group_t), intent(in) :: group
    type(location_t), intent(in) :: where

    draft%scene%groups = [draft%scene%groups, group]
    draft%group_where = [draft%group_where, where]
  end subroutine append_group

end module card_groups
