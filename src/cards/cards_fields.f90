!> ADDEL, START, IMPOS and SOLVE: further formulations on bodies, values of their fields at the start and where they are imposed,
!> and how fields are coupled.
module cards_fields
  use card_places, only: place_t, read_place
  use cards_laws, only: read_material
  use cards_mesh, only: is_body_elem, read_option
  use cards_sides, only: append_group
  use deck_cursor, only: cursor_t
  use deck_expression, only: evaluate
  use deck_parameters, only: parameters_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_api, only: declare_fields
  use field_places, only: refuse_unlike_nodes, refuse_without_field
  use fields, only: field_t
  use kinds, only: wp
  use law_api, only: law_of_material
  use loads, only: fixation_t, start_t
  use scene, only: group_t, is_solid, role_second
  use scene_draft, only: close_card, draft_t, find_elem, only_card
  use strategy, only: coupling_names
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_formulations, read_start_values, read_imposed_values, read_coupling, field_words

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
    call body_elems(draft, known)
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
    call draft%places%find(cursor, 'the name of a body', k)
    if (k == 0) return
    do g = 1, size(draft%scene%groups)
      if (is_solid(draft%scene%groups(g)) .and. draft%scene%groups(g)%name == draft%places%words(k)%s) body = g
    end do
    if (body == 0 .and. draft%mesh_sound) call cursor%fail(''''//draft%places%words(k)%s//''' is a ' &
                                                           //draft%places%keywords(k)%s//', expected a body')
  end subroutine read_body

  !> Names of the elements that bodies are made of.
  subroutine body_elems(draft, known)
    type(draft_t), intent(in) :: draft
    type(string_t), allocatable, intent(out) :: known(:)
    integer :: k, n

    allocate (known(count([(is_body_elem(draft%elems(k)), k=1, size(draft%elems))])))
    n = 0
    do k = 1, size(draft%elems)
      if (.not. is_body_elem(draft%elems(k))) cycle
      n = n + 1
      known(n)%s = draft%elems(k)%name
    end do
  end subroutine body_elems

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

  !> All START cards, `field value [body]`: the value of a field at the start, everywhere or on a body; a number, or a formula of
  !> the place where the material is in the deck's own mesh.
  subroutine read_start_values(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(start_t) :: start
    type(start_t), allocatable :: everywhere(:)
    logical, allocatable :: given(:)
    character(len=:), allocatable :: formula
    integer, allocatable :: cards(:)
    real(wp) :: value
    integer :: i, f

    allocate (given(0), cards(0), everywhere(0), draft%scene%starts(0))
    if (draft%groups_sound) given = spread(.false., 1, size(draft%scene%fields))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'START') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_field(cursor, draft, f)
      if (f > 0) then
        start%field = f
        start%body = ''
        if (size(deck%cards(i)%head%fields) < 3 .and. given(f)) &
          call cursor%fail('the start of '//draft%scene%fields(f)%word//' is given twice')
        call cursor%real_or_formula('the value at the start', value, formula, draft%scene%fields(f)%unit)
        call values_at_nodes(cursor, draft, value, formula, start%values)
        if (size(deck%cards(i)%head%fields) < 3) then
          given(f) = .true.
          if (formula == '') draft%scene%fields(f)%initial = value
          if (formula /= '') everywhere = [everywhere, start]
        else
          call read_start_of_body(cursor, draft, f, start)
          cards = [cards, i]
        end if
      end if
      call close_card(draft, cursor, deck%cards(i))
    end do
    if (draft%mesh_sound .and. draft%groups_sound .and. size(cards) == size(draft%scene%starts)) then
      do i = 1, size(cards)
        call cursor%open(deck%cards(cards(i)), diagnostics)
        call refuse_two_starts(cursor, draft, everywhere, draft%scene%starts(i))
      end do
    end if
    draft%scene%starts = [everywhere, draft%scene%starts]
  end subroutine read_start_values

  !> A value, or that of a formula, at every node of the mesh; none without a mesh.
  subroutine values_at_nodes(cursor, draft, value, formula, values)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    real(wp), intent(in) :: value
    character(len=*), intent(in) :: formula             !! empty where the value is a number
    real(wp), allocatable, intent(out) :: values(:)     !! (nnode) [of the field]
    type(parameters_t) :: none
    character(len=:), allocatable :: message
    integer :: k, position
    logical :: failed

    allocate (values(0))
    if (.not. draft%mesh_sound .or. cursor%failed()) return
    associate (places => draft%scene%mesh%origin)
      values = spread(value, 1, size(places, 2))
      if (formula == '') return
      do k = 1, size(places, 2)
        call evaluate(formula, none, values(k), failed, message, position, places(:, k))
        if (.not. failed) cycle
        call cursor%fail('at x = '//to_text(places(1, k), 6)//', y = '//to_text(places(2, k), 6)//': '//message)
        return
      end do
    end associate
  end subroutine values_at_nodes

  !> The body that a start is of.
  subroutine read_start_of_body(cursor, draft, field, start)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: field
    type(start_t), intent(inout) :: start
    integer :: body, k

    call read_body(cursor, draft, body)
    if (body == 0) return
    start%body = draft%scene%groups(body)%name
    call refuse_without_field(cursor, draft, field, [draft%scene%groups(body)%connectivity], start%body, own=.true.)
    do k = 1, size(draft%scene%starts)
      if (draft%scene%starts(k)%field == field .and. draft%scene%starts(k)%body == start%body) &
        call cursor%fail('the start of '//draft%scene%fields(field)%word//' of '''//start%body//''' is given twice')
    end do
    if (.not. cursor%failed()) draft%scene%starts = [draft%scene%starts, start]
  end subroutine read_start_of_body

  !> A node that two bodies share starts with one value.
  subroutine refuse_two_starts(cursor, draft, everywhere, start)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(start_t), intent(in) :: everywhere(:)   !! formulas for all nodes
    type(start_t), intent(in) :: start
    logical :: of_body(size(draft%scene%mesh%coordinates, 2))
    real(wp) :: values(size(draft%scene%mesh%coordinates, 2))
    integer :: g, k

    of_body = .false.
    do g = 1, size(draft%scene%groups)
      if (is_solid(draft%scene%groups(g)) .and. draft%scene%groups(g)%name == start%body) &
        of_body([draft%scene%groups(g)%connectivity]) = .true.
    end do
    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        if (.not. is_solid(group) .or. group%name == start%body) cycle
        if (.not. any(of_body([group%connectivity]))) cycle
        values = draft%scene%fields(start%field)%initial
        do k = 1, size(everywhere)
          if (everywhere(k)%field == start%field) values = everywhere(k)%values
        end do
        do k = 1, size(draft%scene%starts)
          if (draft%scene%starts(k)%field == start%field .and. draft%scene%starts(k)%body == group%name) &
            values = draft%scene%starts(k)%values
        end do
        if (any(of_body([group%connectivity]) .and. abs(values([group%connectivity]) - start%values([group%connectivity])) > 0)) &
          call cursor%fail('the bodies '''//start%body//''' and '''//group%name &
                           //''' share nodes: they must start with the same '//draft%scene%fields(start%field)%word)
      end associate
    end do
  end subroutine refuse_two_starts

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

    call only_card(deck, 'SOLVE', .false., diagnostics, k)
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
        if (fields(i)%declared .and. fields(j)%declared) yes = yes .or. fields(i)%quantity /= fields(j)%quantity
      end do
    end do
  end function several_quantities

end module cards_fields
