!> ADDEL, IMPOS and SOLVE: further formulations on bodies, values of their fields where they are imposed, and how fields are
!> coupled.
module cards_fields
  use card_groups, only: append_group
  use card_places, only: place_t, read_place
  use cards_laws, only: read_material
  use cards_mesh, only: read_option
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use element_fields, only: declare_fields, list_body_elems
  use field_places, only: refuse_unlike_nodes, refuse_without_field
  use fields, only: field_t, solved_with
  use law_api, only: law_of_material
  use loads, only: fixation_t
  use scene, only: group_t, is_solid, role_second
  use scene_draft, only: close_card, draft_t, find_elem, only_card
  use strategy, only: coupling_names
  use text, only: string_t
  implicit none
  private
  public :: read_formulations, read_imposed_values, read_coupling, read_body, read_field, field_words

contains

  !> All ADDEL cards, `body elem law [option]`: elements of a further formulation on the elements and points of a body. After them
  !> the fields of the bodies are known.
  subroutine read_formulations(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(group_t) :: group
    integer :: i, law

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'ADDEL') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_formulation(cursor, draft, group)
      call close_card(draft, cursor, deck%cards(i))
      law = 0
      if (.not. cursor%failed() .and. group%material > 0) law = draft%scene%materials(group%material)%law_id
      if (law == 0 .or. group%host == 0) then
        draft%groups_sound = .false.
        cycle
      end if
      call draft%elems(group%elem_id)%variables(law_of_material(draft%laws(law), draft%scene%materials(group%material)), &
                                                draft%scene%plane_state, group%variables)
      call append_group(draft, group, cursor%where())
    end do
    if (.not. draft%groups_sound) return
    call declare_fields(draft%elems, draft%scene)
    call refuse_unlike_nodes(draft, diagnostics)
  end subroutine read_formulations

  subroutine read_formulation(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(group_t), intent(out) :: group
    type(string_t), allocatable :: known(:)
    integer :: k, g

    group%role = role_second
    call read_body(cursor, draft, group%host)
    call list_body_elems(draft%elems, known)
    call cursor%name('an element', known, k)
    if (k == 0) return
    group%elem = known(k)%s
    group%elem_id = find_elem(draft%elems, group%elem)
    call read_material(cursor, draft, draft%elems(group%elem_id)%law_kind, group%material)
    if (group%host == 0) return
    associate (host => draft%scene%groups(group%host))
      group%rule = host%rule
      group%connectivity = host%connectivity
      group%name = host%name//'/'//group%elem
      do g = 1, size(draft%scene%groups)
        if ((g == group%host .or. draft%scene%groups(g)%host == group%host) .and. draft%scene%groups(g)%elem == group%elem) &
          call cursor%fail('body '''//host%name//''' has elements '//group%elem//' already')
      end do
    end associate
    call read_option(cursor, draft%elems(group%elem_id), draft%scene%plane_state, group%rule%n, group%option)
  end subroutine read_formulation

  !> The name of a body; 0 after a mistake.
  subroutine read_body(cursor, draft, body)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(out) :: body   !! place of its group
    integer :: k, g

    body = 0
    call draft%places%find(cursor, 'the name of a body', k, not_of='DIE SIDES')
    if (k == 0) return
    do g = 1, size(draft%scene%groups)
      if (is_solid(draft%scene%groups(g)) .and. draft%scene%groups(g)%name == draft%places%words(k)%s) body = g
    end do
    if (body == 0 .and. draft%mesh_sound) call cursor%fail(''''//draft%places%words(k)%s//''' is a ' &
                                                           //draft%places%keywords(k)%s//', expected a body')
  end subroutine read_body

  !> Fields that cards call by a word of their own, and these words.
  pure subroutine field_words(fields, place, words)
    type(field_t), intent(in) :: fields(:)                 !! (nfield)
    integer, allocatable, intent(out) :: place(:)          !! (nword) position in the scene's list
    type(string_t), allocatable, intent(out) :: words(:)   !! (nword)
    integer :: k, n

    allocate (place(0))
    do k = 1, size(fields)
      if (fields(k)%declared .and. len(fields(k)%word) > 0) place = [place, k]
    end do
    allocate (words(size(place)))
    do n = 1, size(place)
      words(n)%s = fields(place(n))%word
    end do
  end subroutine field_words

  !> All IMPOS cards, `place field lic [amplitude]`: the value of a field, amplitude times multiplier.
  subroutine read_imposed_values(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(fixation_t) :: fixation
    type(place_t) :: place
    integer :: i, k, f

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'IMPOS') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_place(cursor, draft, .false., place)
      call read_field(cursor, draft, f)
      if (f == 0) call cursor%leave()
      if (f > 0) call refuse_without_field(cursor, draft, f, place%nodes, place%label, own=.true.)
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      fixation%amplitude = 1
      if (f > 0 .and. cursor%more()) call cursor%real('the amplitude', fixation%amplitude, unit=draft%scene%fields(f)%unit)
      fixation%multiplier = 0
      if (k > 0) fixation%multiplier = draft%multipliers%item(k)
      if (.not. cursor%failed()) call refuse_second_value(cursor, draft, f, place, fixation)
      call close_card(draft, cursor, deck%cards(i))
      if (cursor%failed()) cycle
      fixation%nodes = place%nodes
      fixation%field = f
      fixation%component = 1
      fixation%label = 'IMPOS '//place%label//' '//draft%scene%fields(f)%word//' '//draft%multipliers%words(k)%s
      draft%scene%fixations = [draft%scene%fixations, fixation]
    end do
  end subroutine read_imposed_values

  !> A node has one imposed value of a field; the same one may be given twice, where two places meet.
  subroutine refuse_second_value(cursor, draft, field, place, fixation)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: field
    type(place_t), intent(in) :: place
    type(fixation_t), intent(in) :: fixation   !! the one that is read
    integer :: k, i

    do k = 1, size(draft%scene%fixations)
      if (draft%scene%fixations(k)%field /= field) cycle
      if (draft%scene%fixations(k)%multiplier == fixation%multiplier &
          .and. .not. abs(draft%scene%fixations(k)%amplitude - fixation%amplitude) > 0) cycle
      do i = 1, size(place%nodes)
        if (.not. any(draft%scene%fixations(k)%nodes == place%nodes(i))) cycle
        call cursor%fail('a node of '//place%label//' has a value of '//draft%scene%fields(field)%word//' already, by ' &
                         //draft%scene%fixations(k)%label)
        return
      end do
    end do
  end subroutine refuse_second_value

  !> The word of a field of the scene; 0 where there is none.
  subroutine read_field(cursor, draft, field)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(out) :: field
    type(string_t), allocatable :: words(:)
    character(len=:), allocatable :: word
    integer, allocatable :: place(:)
    integer :: k

    field = 0
    if (.not. draft%groups_sound) then
      call cursor%word('a field', word)
      return
    end if
    call field_words(draft%scene%fields, place, words)
    if (size(words) == 0) then
      call cursor%word('a field', word)
      call cursor%fail('no body of this scene has a field beside its displacement (ADDEL, or another element on BLOCK)')
      return
    end if
    call cursor%name('a field', words, k)
    if (k > 0) field = place(k)
  end subroutine read_field

  !> `SOLVE ONCE|CONVERGE|MONOLITHIC`: how fields of several quantities are coupled.
  subroutine read_coupling(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t) :: words(size(coupling_names))
    integer :: k, c

    call only_card(deck, 'SOLVE', diagnostics, k)
    if (k == 0) return
    do c = 1, size(words)
      words(c)%s = trim(coupling_names(c))
    end do
    call cursor%open(deck%cards(k), diagnostics)
    call cursor%name('a coupling', words, c)
    if (c > 0) draft%scene%strategy%coupling = c
    if (c > 0 .and. draft%groups_sound) then
      if (.not. several_quantities(draft%scene%fields)) call cursor%fail('there is nothing to couple: the scene has one quantity')
    end if
    call close_card(draft, cursor, deck%cards(k))
  end subroutine read_coupling

  !> Declared fields are not all of one quantity.
  pure function several_quantities(fields) result(yes)
    type(field_t), intent(in) :: fields(:)
    logical :: yes
    integer :: i, j

    yes = .false.
    do i = 1, size(fields)
      do j = 1, i - 1
        if (any(fields([i, j])%given)) cycle
        if (fields(i)%declared .and. fields(j)%declared) yes = yes .or. solved_with(fields(i)) /= solved_with(fields(j))
      end do
    end do
  end function several_quantities

end module cards_fields
