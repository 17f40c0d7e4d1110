!> A scene while a deck is read: the data that the families of cards share.
module scene_draft
  use card_names, only: names_t
  use deck_cursor, only: cursor_t
  use deck_reader, only: card_t, deck_t
  use diagnostics, only: diagnostics_t, location_t
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use kinematics_registry, only: list_kinematics
  use law_api, only: law_t
  use law_registry, only: list_laws
  use scene, only: scene_t
  use text, only: join, string_t
  implicit none
  private
  public :: draft_t, start_draft, only_card, close_card, find_elem, next_of_words, words_of, head_location

  type :: draft_t
    type(scene_t) :: scene
    type(law_t), allocatable :: laws(:)
    type(elem_t), allocatable :: elems(:)
    type(kinematics_t), allocatable :: kinematics(:)
    type(names_t) :: materials, multipliers, probes
    !> Bodies, sets of sides and dies: all that a load may act on. The item of a BLOCK is its first set of sides.
    type(names_t) :: places
    !> Place where each group is defined (ngroup).
    type(location_t), allocatable :: group_where(:)
    !> Labels of explicit nodes in ascending order, and the nodes they belong to.
    integer, allocatable :: sorted_labels(:), labelled_nodes(:)
    !> Bodies that are not there in this operation.
    type(string_t), allocatable :: sleepers(:)
    !> Of each node: elements there are which have it in the middle of a side; of one of them the material, and the node in which
    !> the side begins, walked with the element on the left.
    integer, allocatable :: sharing(:), owner(:), beginning(:)
    !> Nodes, groups and sides are all there: points and places can be looked up.
    logical :: mesh_sound = .false.
    !> No group is missing, and the state of each is known.
    logical :: groups_sound = .true.
    !> Length of the diagonal of the box around the mesh [length].
    real(wp) :: mesh_size = 0.0_wp
    !> Elements along a line of a block, over what its card says.
    real(wp) :: mesh_factor = 1.0_wp
  end type draft_t

contains

  subroutine start_draft(draft)
    type(draft_t), intent(out) :: draft

    call list_laws(draft%laws)
    call list_elems(draft%elems)
    call list_kinematics(draft%kinematics)
    call draft%materials%clear()
    call draft%multipliers%clear()
    call draft%probes%clear()
    call draft%places%clear()
    allocate (draft%group_where(0), draft%sorted_labels(0), draft%labelled_nodes(0), draft%sharing(0), draft%owner(0))
    allocate (draft%beginning(0), draft%sleepers(0))
  end subroutine start_draft

  !> The one card with this keyword, 0 when there is none. A second one is refused, and none where it says what is `expected` on it.
  subroutine only_card(deck, keyword, diagnostics, k, expected)
    type(deck_t), intent(inout) :: deck
    character(len=*), intent(in) :: keyword
    type(diagnostics_t), intent(inout) :: diagnostics
    integer, intent(out) :: k
    character(len=*), intent(in), optional :: expected
    type(location_t) :: where
    integer :: i

    k = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= keyword) cycle
      deck%cards(i)%taken = .true.
      if (k == 0) then
        k = i
      else
        call diagnostics%add(head_location(deck%cards(i)), keyword, 'given twice, the first is at ' &
                             //diagnostics%place(head_location(deck%cards(k))))
      end if
    end do
    if (k > 0 .or. .not. present(expected)) return
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'OPERA') cycle
      call diagnostics%add(head_location(deck%cards(i)), 'OPERA', 'neither this operation nor what all of them share has a card ' &
                           //keyword//': expected '//expected)
      return
    end do
    call diagnostics%register(deck%path, where%file)
    call diagnostics%add(where, keyword, 'the deck has no such card: expected '//expected)
  end subroutine only_card

  !> Refuse what is left on a card. When it has a mistake, the names on it count as used all the same.
  subroutine close_card(draft, cursor, card)
    type(draft_t), intent(inout) :: draft
    type(cursor_t), intent(inout) :: cursor
    type(card_t), intent(in) :: card
    integer :: i

    call cursor%end_card()
    if (.not. cursor%failed()) return
    do i = 1, size(card%head%fields)
      if (card%head%fields(i)%numeric) cycle
      call draft%materials%mention(card%head%fields(i)%text)
      call draft%multipliers%mention(card%head%fields(i)%text)
      call draft%places%mention(card%head%fields(i)%text)
    end do
  end subroutine close_card

  pure function head_location(card) result(where)
    type(card_t), intent(in) :: card
    type(location_t) :: where

    where = location_t(card%head%file, card%head%line, 1)
  end function head_location

  !> Position of an element in the list of elements, 0 when there is none of that name.
  pure function find_elem(elems, name) result(k)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    character(len=*), intent(in) :: name
    integer :: k

    do k = 1, size(elems)
      if (elems(k)%name == name) return
    end do
    k = 0
  end function find_elem

  !> The next of a card's words, which may stand in any order, each once; k = 0 where there is none of them.
  subroutine next_of_words(cursor, words, given, k)
    type(cursor_t), intent(inout) :: cursor
    type(string_t), intent(in) :: words(:)   !! (nword)
    logical, intent(inout) :: given(:)       !! (nword) those that stood already
    integer, intent(out) :: k

    call cursor%name('one of '//join(words, ' '), words, k)
    if (k == 0) return
    if (given(k)) call cursor%fail(''''//words(k)%s//''' is given twice')
    given(k) = .true.
  end subroutine next_of_words

  !> A list of words for `cursor%name`, from words separated by blanks.
  pure subroutine words_of(line, words)
    character(len=*), intent(in) :: line
    type(string_t), allocatable, intent(out) :: words(:)   !! (nword)
    integer :: i, n, first, pass

    do pass = 1, 2
      n = 0
      first = 1
      do i = 1, len(line) + 1
        if (i <= len(line)) then
          if (line(i:i) /= ' ') cycle
        end if
        if (i > first) then
          n = n + 1
          if (pass == 2) words(n)%s = line(first:i - 1)
        end if
        first = i + 1
      end do
      if (pass == 1) allocate (words(n))
    end do
  end subroutine words_of

end module scene_draft
