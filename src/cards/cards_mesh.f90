!> NODES, element cards (PL8LS) and SIDES: a mesh written out.
module cards_mesh
  use card_points, only: read_xy
  use cards_laws, only: read_material
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use elem_api, only: elem_t
  use element_fields, only: list_body_elems
  use mesh, only: side_set_t
  use mesh_parts, only: body_t, find_label, mesh_parts_t, sort_labels
  use scene, only: plane_stress, role_body
  use scene_draft, only: close_card, draft_t, find_elem
  use shape_functions, only: quad8_side
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_nodes, read_elements, read_side_sets, read_body_head, read_option

  !> Nodes of an element of a body; a rule of Gauss points it may have.
  integer, parameter :: nnode = 8
  integer, parameter :: rules(2) = [4, 9]

contains

  !> Whether a keyword is an element that bodies are made of.
  pure function is_body_elem(elem) result(yes)
    type(elem_t), intent(in) :: elem
    logical :: yes

    yes = elem%role == role_body
  end function is_body_elem

  !> All NODES cards: labels and coordinates, and the index of labels.
  subroutine read_nodes(deck, draft, parts, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    integer, allocatable :: order(:)
    integer :: i, n, most

    most = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == 'NODES') most = most + size(deck%cards(i)%rows)
    end do
    deallocate (parts%coordinates, parts%labels, parts%location)
    allocate (parts%coordinates(2, most), parts%labels(most), parts%location(most))
    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'NODES') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call cursor%next_row('label, x and y of a node')
      do while (.not. cursor%failed())
        n = n + 1
        call cursor%integer('the label of a node', parts%labels(n), lower=1)
        parts%location(n) = cursor%where()
        call read_xy(cursor, 'the node', parts%coordinates(:, n))
        if (cursor%failed()) n = n - 1
        if (.not. cursor%more_rows()) exit
        call cursor%next_row('label, x and y of a node')
      end do
      call close_card(draft, cursor, deck%cards(i))
      parts%sound = parts%sound .and. .not. cursor%failed()
    end do
    parts%nexplicit = n
    parts%coordinates = parts%coordinates(:, :n)
    parts%labels = parts%labels(:n)
    parts%location = parts%location(:n)
    parts%parent = [(i, i=1, n)]

    call sort_labels(parts%labels, order)
    draft%sorted_labels = parts%labels(order)
    draft%labelled_nodes = order
    do i = 2, n
      if (draft%sorted_labels(i) /= draft%sorted_labels(i - 1)) cycle
      parts%sound = .false.
      call diagnostics%add(parts%location(order(i)), 'NODES', 'node '//to_text(draft%sorted_labels(i))//' is already given at ' &
                           //diagnostics%place(parts%location(order(i - 1))))
    end do
  end subroutine read_nodes

  !> All cards of elements written out: one body each.
  subroutine read_elements(deck, draft, parts, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(body_t) :: body
    integer :: i, k
    logical :: all_sound

    all_sound = parts%sound
    do i = 1, size(deck%cards)
      do k = 1, size(draft%elems)
        if (is_body_elem(draft%elems(k)) .and. draft%elems(k)%name == deck%cards(i)%keyword) exit
      end do
      if (k > size(draft%elems)) cycle
      call cursor%open(deck%cards(i), diagnostics)
      body%elem = draft%elems(k)%name
      call read_body_head(cursor, draft, diagnostics, body%elem, 0, body)
      call read_rows(cursor, size(deck%cards(i)%rows), draft, parts%sound, body)
      call close_card(draft, cursor, deck%cards(i))
      all_sound = all_sound .and. .not. cursor%failed()
      parts%bodies = [parts%bodies, body]
    end do
    parts%sound = all_sound
    call refuse_same_labels(parts, diagnostics)
  end subroutine read_elements

  !> `name [element] npoint law [MEAN]`, as on the cards of elements, and on BLOCK and BODY.
  subroutine read_body_head(cursor, draft, diagnostics, keyword, item, body)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(in), target :: diagnostics
    character(len=*), intent(in) :: keyword
    integer, intent(in) :: item      !! what the name stands for: 0, or the first set of sides of a block
    type(body_t), intent(inout) :: body
    type(string_t), allocatable :: known(:)
    logical :: names_element
    integer :: k

    body%is_block = keyword == 'BLOCK'
    names_element = any(keyword == ['BLOCK', 'BODY '])
    call draft%places%define(cursor, 'the name of the body', keyword, item, diagnostics, body%name)
    if (names_element) then
      call list_body_elems(draft%elems, known)
      call cursor%name('an element', known, k)
      body%elem = known(max(k, 1))%s
    end if
    call cursor%integer('the number of integration points, 4 or 9', body%npoint)
    if (all(rules /= body%npoint)) then
      call cursor%fail('expected 4 or 9 integration points, found '//to_text(body%npoint))
      body%npoint = rules(1)
    end if
    k = find_elem(draft%elems, body%elem)
    call read_material(cursor, draft, draft%elems(k)%law_kind, body%material)
    call read_option(cursor, draft%elems(k), draft%scene%plane_state, body%npoint, body%option)
    call cursor%end_row()
  end subroutine read_body_head

  !> A word of the element that a card may end with.
  subroutine read_option(cursor, elem, plane_state, npoint, option)
    type(cursor_t), intent(inout) :: cursor
    type(elem_t), intent(in) :: elem
    integer, intent(in) :: plane_state, npoint
    integer, intent(out) :: option
    character(len=:), allocatable :: words
    integer :: k

    option = 0
    if (.not. cursor%more() .or. size(elem%options) == 0) return
    words = elem%options(1)%s
    do k = 2, size(elem%options)
      words = words//' or '//elem%options(k)%s
    end do
    call cursor%name(words, elem%options, option)
    if (option == 0) return
    if (elem%options(option)%s /= 'MEAN') return
    if (npoint /= rules(2)) call cursor%fail('the mean dilatation wants 9 integration points: with 4 nothing locks')
    if (plane_state == plane_stress) &
      call cursor%fail('nothing locks in plane stress: the mean dilatation is for the other states')
  end subroutine read_option

  !> Rows of an element card: label and nodes, their labels replaced by numbers.
  subroutine read_rows(cursor, nrow, draft, nodes_known, body)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: nrow
    type(draft_t), intent(in) :: draft
    logical, intent(in) :: nodes_known     !! false after a mistake on NODES: then an unknown label is no news
    type(body_t), intent(inout) :: body
    integer :: i, j, k, label, missing

    if (allocated(body%labels)) deallocate (body%labels, body%location, body%connectivity)
    allocate (body%labels(nrow), body%location(nrow), body%connectivity(nnode, nrow))
    if (nrow == 0) call cursor%next_row('the label of an element and its 8 nodes')
    missing = 0
    do i = 1, nrow
      call cursor%next_row('the label of an element and its 8 nodes')
      call cursor%integer('the label of an element', body%labels(i), lower=1)
      body%location(i) = cursor%where()
      do j = 1, nnode
        call cursor%integer('the label of node '//to_text(j), label, lower=1)
        k = find_label(draft%sorted_labels, label)
        body%connectivity(j, i) = 0
        if (k > 0) then
          body%connectivity(j, i) = draft%labelled_nodes(k)
          if (any(body%connectivity(:j - 1, i) == body%connectivity(j, i))) &
            call cursor%fail('node '//to_text(label)//' is given twice')
        else
          missing = missing + 1
          if (nodes_known) call cursor%fail('there is no node '//to_text(label))
        end if
        if (cursor%failed()) exit
      end do
      if (cursor%failed()) exit
    end do
    if (missing == 0 .and. .not. cursor%failed()) return
    body%labels = body%labels(:0)
    body%location = body%location(:0)
    body%connectivity = body%connectivity(:, :0)
  end subroutine read_rows

  subroutine refuse_same_labels(parts, diagnostics)
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout) :: diagnostics
    integer, allocatable :: labels(:), order(:)
    type(location_t), allocatable :: location(:)
    integer :: i

    allocate (labels(0), location(0))
    do i = 1, size(parts%bodies)
      labels = [labels, parts%bodies(i)%labels]
      location = [location, parts%bodies(i)%location]
    end do
    call sort_labels(labels, order)
    do i = 2, size(labels)
      if (labels(order(i)) /= labels(order(i - 1))) cycle
      parts%sound = .false.
      call diagnostics%add(location(order(i)), 'PL8LS', 'element '//to_text(labels(order(i)))//' is already given at ' &
                           //diagnostics%place(location(order(i - 1))))
    end do
  end subroutine refuse_same_labels

  !> All SIDES cards: sets of sides of labelled elements.
  subroutine read_side_sets(deck, draft, parts, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(side_set_t) :: set
    integer, allocatable :: labels(:), order(:), nodes(:, :)
    integer :: i, k, n, label, side
    logical :: all_sound

    call all_elements(parts, labels, nodes)
    call sort_labels(labels, order)
    labels = labels(order)
    all_sound = parts%sound
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'SIDES') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call draft%places%define(cursor, 'the name of the set of sides', 'SIDES', size(draft%scene%mesh%sides) + 1, &
                               diagnostics, set%name)
      if (allocated(set%nodes)) deallocate (set%nodes)
      allocate (set%nodes(3, size(deck%cards(i)%rows)))
      n = 0
      call cursor%next_row('the label of an element and a side')
      do while (.not. cursor%failed())
        call cursor%integer('the label of an element', label, lower=1)
        k = find_label(labels, label)
        if (k == 0 .and. parts%sound) call cursor%fail('no element card has element '//to_text(label))
        call cursor%integer('a side of the element', side, lower=1, upper=4)
        if (cursor%failed()) exit
        if (k > 0) then
          n = n + 1
          set%nodes(:, n) = nodes(quad8_side(:, side), order(k))
          if (any(set%nodes(2, :n - 1) == set%nodes(2, n))) &
            call cursor%fail('side '//to_text(side)//' of element '//to_text(label)//' is given twice')
        end if
        if (.not. cursor%more_rows()) exit
        call cursor%next_row('the label of an element and a side')
      end do
      call close_card(draft, cursor, deck%cards(i))
      all_sound = all_sound .and. .not. cursor%failed()
      set%nodes = set%nodes(:, :n)
      draft%scene%mesh%sides = [draft%scene%mesh%sides, set]
      parts%joined = [parts%joined, location_t()]
    end do
    parts%sound = all_sound
  end subroutine read_side_sets

  !> Labels and nodes of all elements that cards write out.
  subroutine all_elements(parts, labels, nodes)
    type(mesh_parts_t), intent(in) :: parts
    integer, allocatable, intent(out) :: labels(:), nodes(:, :)
    integer :: i, n

    n = 0
    do i = 1, size(parts%bodies)
      n = n + size(parts%bodies(i)%labels)
    end do
    allocate (labels(n), nodes(nnode, n))
    n = 0
    do i = 1, size(parts%bodies)
      associate (body => parts%bodies(i))
        if (size(body%labels) == 0) cycle
        labels(n + 1:n + size(body%labels)) = body%labels
        nodes(:, n + 1:n + size(body%labels)) = body%connectivity
        n = n + size(body%labels)
      end associate
    end do
  end subroutine all_elements

end module cards_mesh
