!> PROBE cards of nodes: `NODE` and `REACT`.
module cards_node_probes
  use card_places, only: node_text, place_t, read_place
  use cards_fields, only: field_words
  use deck_cursor, only: cursor_t
  use field_places, only: refuse_without_field
  use fields, only: displacement_field
  use kinds, only: pi, wp
  use mesh, only: nearest_node
  use probe_places, only: is_off, nearest_of_body, read_point
  use probes, only: probe_t
  use scene, only: axisymmetric, is_solid
  use scene_draft, only: draft_t, words_of
  use text, only: string_t
  use vectors, only: length_of
  implicit none
  private
  public :: read_node_probe, read_reaction_probe

contains

  !> `X|Y|UX|UY x y [body]`, or the word of another field: the node nearest to a point of the mesh as it begins, of a body where
  !> one is named: nodes of several bodies may stand at one place. `X|Y|UX|UY NODE label`: a node of a NODES card.
  subroutine read_node_probe(cursor, remeshed, is_cut, draft, probe)
    type(cursor_t), intent(inout) :: cursor
    logical, intent(in) :: remeshed   !! the deck asks for new meshes
    logical, intent(in) :: is_cut     !! bodies may have been cut
    type(draft_t), intent(inout) :: draft
    type(probe_t), intent(inout) :: probe
    type(place_t) :: named
    type(string_t), allocatable :: quantities(:), words(:)
    character(len=:), allocatable :: word
    integer, allocatable :: place(:)
    real(wp) :: x(2), distance
    integer :: node, of_body

    call words_of('X Y UX UY', quantities)
    if (draft%groups_sound) then
      call field_words(draft%scene%fields, place, words)
      quantities = [quantities, words]
      call cursor%name('a quantity', quantities, probe%quantity)
    else
      ! after a mistake on another card the fields are not known, and no word is wrong
      call cursor%word('a quantity', word)
    end if
    probe%unit = 'length'
    if (probe%quantity > 4) then
      probe%field = place(probe%quantity - 4)
      probe%unit = draft%scene%fields(probe%field)%unit
    end if
    if (cursor%peek_word() == 'NODE') then
      call read_place(cursor, draft, .false., named)
      if (cursor%failed() .or. .not. draft%mesh_sound) return
      if (remeshed) then
        call cursor%fail('a node by its label is one of the first mesh: with REMSH name a point x y, of a body if need be')
        return
      end if
      node = named%nodes(1)
      x = draft%scene%mesh%origin(:, node)
    else
      call read_point(cursor, draft, is_cut, x)
      call read_body(cursor, draft, of_body)
      if (cursor%failed() .or. .not. draft%mesh_sound) return
      call nearest_node(draft%scene%mesh%origin, x, node, distance)
      if (of_body > 0) node = nearest_of_body(draft%scene%mesh%origin, draft%scene%groups(of_body), x)
    end if
    probe%nodes = [node]
    probe%place = draft%scene%mesh%origin(:, node)
    probe%apart = length_of(probe%place - x)
    if (probe%field > 0 .and. draft%scene%generation == 1) &
      call refuse_without_field(cursor, draft, probe%field, probe%nodes, node_text(draft, node), own=.false.)
    if (draft%scene%generation > 1) probe%offset = x - draft%scene%mesh%origin(:, node)
    if (is_cut) probe%is_gone = is_off(draft, x)
  end subroutine read_node_probe

  !> The name of a body at the end of a row, 0 where there is none.
  subroutine read_body(cursor, draft, body)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(out) :: body   !! place of its group
    type(string_t), allocatable :: names(:)
    character(len=:), allocatable :: unread
    integer, allocatable :: groups(:)
    integer :: k

    body = 0
    if (cursor%failed() .or. .not. cursor%more()) return
    if (.not. draft%groups_sound) then
      call cursor%word('the name of a body', unread)
      return
    end if
    groups = pack([(k, k=1, size(draft%scene%groups))], is_solid(draft%scene%groups))
    allocate (names(size(groups)))
    do k = 1, size(groups)
      names(k)%s = draft%scene%groups(groups(k))%name
    end do
    call cursor%name('the name of a body', names, k)
    if (k > 0) body = groups(k)
  end subroutine read_body

  !> `X|Y place`: the sum of the reactions there, over the full circumference.
  subroutine read_reaction_probe(cursor, draft, probe)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(probe_t), intent(inout) :: probe
    type(string_t), allocatable :: directions(:)
    type(place_t) :: place
    logical :: asked(size(draft%scene%mesh%labels)), held
    integer :: k

    call words_of('X Y', directions)
    call cursor%name('a direction', directions, probe%quantity)
    probe%unit = 'force'
    if (draft%scene%plane_state == axisymmetric) probe%factor = 2*pi
    call read_place(cursor, draft, .false., place)
    if (cursor%failed() .or. .not. draft%mesh_sound) return
    probe%nodes = place%nodes
    asked = .false.
    asked(place%nodes) = .true.
    held = .false.
    do k = 1, size(draft%scene%fixations)
      if (draft%scene%fixations(k)%field /= displacement_field) cycle
      if (draft%scene%fixations(k)%component == probe%quantity) held = held .or. any(asked(draft%scene%fixations(k)%nodes))
    end do
    ! what was cut off is held nowhere
    if (.not. (held .or. size(place%nodes) == 0)) &
      call cursor%fail('no motion is given there in this direction: the reaction would always be zero')
  end subroutine read_reaction_probe

end module cards_node_probes
