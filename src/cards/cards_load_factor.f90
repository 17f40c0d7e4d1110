!> LOADF: a multiplier that is found, so that a displacement, or the work of its loads, follows another one.
module cards_load_factor
  use card_groups, only: start_group
  use card_places, only: node_text, place_t, read_place
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use element_fields, only: has_unknown
  use field_places, only: refuse_without_field
  use fields, only: displacement_field
  use history_columns, only: own_columns_named
  use kinds, only: pi, wp
  use loads, only: multiplier_t
  use scene, only: axisymmetric, group_t
  use scene_draft, only: close_card, draft_t, only_card, words_of
  use text, only: string_t
  implicit none
  private
  public :: name_load_factor, read_load_factor

contains

  !> The name of the card, so that loads can have it as that of their multiplier. Whatever its value will be, it acts: 1 stands
  !> for it.
  subroutine name_load_factor(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(multiplier_t) :: multiplier
    integer :: k

    call only_card(deck, 'LOADF', diagnostics, k)
    if (k == 0) return
    call cursor%open(deck%cards(k), diagnostics)
    call draft%multipliers%define(cursor, 'the name of the multiplier', 'LOADF', size(draft%scene%multipliers) + 1, diagnostics, &
                                  multiplier%name)
    if (cursor%failed()) return
    multiplier%time = [0.0_wp]
    multiplier%value = [1.0_wp]
    draft%scene%multipliers = [draft%scene%multipliers, multiplier]
    draft%scene%load_factor%multiplier = size(draft%scene%multipliers)
  end subroutine name_load_factor

  !> `LOADF name NODE label|POINT x y X|Y lic [amplitude]` or `LOADF name WORK lic [amplitude]`, after all loads.
  subroutine read_load_factor(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(string_t), allocatable :: work(:)
    character(len=:), allocatable :: name
    type(cursor_t) :: cursor
    integer :: card, k

    if (draft%scene%load_factor%multiplier == 0) return
    call only_card(deck, 'LOADF', diagnostics, card)
    call words_of('WORK', work)
    call cursor%open(deck%cards(card), diagnostics)
    call cursor%word('the name of the multiplier', name)
    if (own_columns_named(draft%scene, name) > 1) &
      call cursor%fail('the history has a column '''//name//''' of its own, take another name')
    associate (factor => draft%scene%load_factor)
      if (cursor%peek_word() == 'WORK') then
        call cursor%name('WORK', work, k)
      else
        call read_node(cursor, draft)
      end if
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      if (k > 0) factor%curve = draft%multipliers%item(k)
      if (k > 0 .and. factor%curve == factor%multiplier) call cursor%fail('expected a LIC, '''//name//''' is what is found')
      if (cursor%more()) call cursor%real('the amplitude', factor%amplitude, unit='length; of WORK force*length')
      if (factor%node == 0 .and. draft%scene%plane_state == axisymmetric) factor%amplitude = factor%amplitude/(2*pi)
      call refuse_other_uses(cursor, draft, name)
    end associate
    call close_card(draft, cursor, deck%cards(card))
    if (cursor%failed() .or. .not. draft%mesh_sound) return
    call append_group(draft, name)
    draft%group_where = [draft%group_where, cursor%where()]
  end subroutine read_load_factor

  !> The node whose displacement is given, in a direction in which nothing holds it.
  subroutine read_node(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(string_t), allocatable :: directions(:)
    type(place_t) :: place
    integer :: k

    call words_of('X Y', directions)
    call read_place(cursor, draft, .false., place)
    call refuse_without_field(cursor, draft, displacement_field, place%nodes, place%label, own=.true.)
    associate (factor => draft%scene%load_factor)
      call cursor%name('a direction', directions, factor%component)
      if (cursor%failed() .or. size(place%nodes) == 0) return
      if (size(place%nodes) > 1) call cursor%fail('expected one node (NODE label, POINT x y) or WORK')
      factor%node = place%nodes(1)
      do k = 1, size(draft%scene%fixations)
        associate (held => draft%scene%fixations(k))
          if (held%field == displacement_field .and. held%component == factor%component .and. any(held%nodes == factor%node)) &
            call cursor%fail('the motion of '//node_text(draft, factor%node)//' in this direction is given by '//held%label)
        end associate
      end do
    end associate
  end subroutine read_node

  !> Pressures, tractions and forces on nodes have it, and nothing else: elements that have it among their unknowns.
  subroutine refuse_other_uses(cursor, draft, name)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    character(len=*), intent(in) :: name
    integer :: g
    logical :: used, other, has_it

    associate (scene => draft%scene, m => draft%scene%load_factor%multiplier)
      used = any(scene%forces%multiplier == m)
      other = any(scene%fixations%multiplier == m) .or. any(scene%die_motions%multiplier == m) &
              .or. any(scene%die_forces%multiplier == m) .or. any(scene%section_drives%multiplier == m)
      if (allocated(scene%die_heats)) other = other .or. any(scene%die_heats%multiplier == m)
      if (allocated(scene%sources)) other = other .or. any(scene%sources%multiplier == m)
      do g = 1, size(scene%groups)
        associate (group => scene%groups(g))
          has_it = has_unknown(draft%elems(group%elem_id), 'load_factor')
          used = used .or. (has_it .and. group%multiplier == m)
          other = other .or. (.not. has_it .and. group%multiplier == m) .or. group%temperature_multiplier == m &
                  .or. group%exchange%multiplier == m .or. group%exchange%surroundings_multiplier == m
        end associate
      end do
    end associate
    if (other) call cursor%fail('what is found multiplies PRES2D, TRACT and FORCE on nodes; '''//name//''' is on other cards too')
    if (.not. used .and. draft%groups_sound .and. draft%mesh_sound) &
      call cursor%fail(''''//name//''' multiplies no load: expected it on a PRES2D, TRACT or FORCE card')
  end subroutine refuse_other_uses

  !> Forces on nodes that it multiplies, what the measure shall be, and what it is.
  subroutine append_group(draft, name)
    type(draft_t), intent(inout) :: draft
    character(len=*), intent(in) :: name
    type(group_t) :: group
    integer :: k, node

    associate (factor => draft%scene%load_factor, forces => draft%scene%forces)
      factor%forces = pack([(k, k=1, size(forces))], forces%multiplier == factor%multiplier)
      call start_group('LOADF', draft, group)
      group%name = name//'/found'
      group%multiplier = factor%multiplier
      group%rule%n = 1
      ! the equation of work is no node's: any that moves
      node = draft%scene%groups(1)%connectivity(1, 1)
      if (factor%node > 0) node = factor%node
      group%connectivity = reshape([forces(factor%forces)%node, node, spread(node, 1, merge(1, 0, factor%node > 0))], &
                                   [1, size(factor%forces) + merge(2, 1, factor%node > 0)])
    end associate
    draft%scene%groups = [draft%scene%groups, group]
  end subroutine append_group

end module cards_load_factor
