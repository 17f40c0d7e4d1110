!> PROBE cards: columns of the history.
module cards_probes
  use card_places, only: node_text, place_t, read_place
  use card_points, only: read_xy
  use cards_cuts, only: may_be_cut
  use cards_fields, only: field_words
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use field_places, only: refuse_without_field
  use fields, only: displacement_field
  use diagnostics, only: diagnostics_t
  use kinds, only: pi, wp
  use mesh, only: nearest_node
  use probes, only: probe_maximum, probe_mean, probe_minimum, probe_node, probe_point, probe_reaction, probe_t
  use quadrature, only: line_rule, square_rule
  use scene, only: axisymmetric, group_t, is_solid, role_body, role_second
  use scene_draft, only: close_card, draft_t, words_of
  use shape_functions, only: line3, quad8
  use state_variables, only: component_names, find_variable, state_variable_t
  use stress_measures, only: measure_names, nmeasure
  use text, only: string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: read_probes

  !> A point further out of the box around the mesh than this share of its size is a typing error.
  real(wp), parameter :: outside_tolerance = 1.0e-3_wp

contains

  !> All PROBE cards.
  subroutine read_probes(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: kinds_of_probe(:)
    type(probe_t) :: probe, none
    logical :: is_cut
    integer :: i, k

    ! In the order of the numbers in module `probes`.
    call words_of('NODE REACT POINT MAX MIN MEAN', kinds_of_probe)
    allocate (draft%scene%probes(0))
    is_cut = draft%scene%generation > 1 .and. may_be_cut(deck)
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'PROBE') cycle
      call cursor%open(deck%cards(i), diagnostics)
      probe = none
      call draft%probes%define(cursor, 'the name of the probe', 'PROBE', size(draft%scene%probes) + 1, diagnostics, probe%name)
      call cursor%name('a kind of probe', kinds_of_probe, probe%kind)
      allocate (probe%nodes(0))
      probe%unit = '-'
      select case (probe%kind)
      case (probe_node)
        call read_node_probe(cursor, any([(deck%cards(k)%keyword == 'REMSH', k=1, size(deck%cards))]), is_cut, draft, probe)
      case (probe_reaction)
        call read_reaction_probe(cursor, draft, probe)
      case (probe_point)
        call read_point_probe(cursor, is_cut, draft, probe)
      case (probe_maximum, probe_minimum, probe_mean)
        call read_extreme_probe(cursor, draft, probe)
        if (is_cut .and. probe%group > 0) probe%is_gone = size(draft%scene%groups(probe%group)%connectivity, 2) == 0
      end select
      call close_card(draft, cursor, deck%cards(i))
      draft%scene%probes = [draft%scene%probes, probe]
    end do
  end subroutine read_probes

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
    if (probe%field > 0 .and. draft%scene%generation == 1) &
      call refuse_without_field(cursor, draft, probe%field, probe%nodes, node_text(draft, node), own=.false.)
    if (draft%scene%generation > 1) probe%offset = x - draft%scene%mesh%origin(:, node)
    if (is_cut) probe%is_gone = is_off(draft, node, x)
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

  !> The node of a body that is nearest to a point.
  pure function nearest_of_body(coordinates, body, x) result(node)
    real(wp), intent(in) :: coordinates(:, :)
    type(group_t), intent(in) :: body
    real(wp), intent(in) :: x(2)
    integer :: node
    integer :: n, e
    real(wp) :: distance, least

    node = 0
    least = huge(least)
    do e = 1, size(body%connectivity, 2)
      do n = 1, size(body%connectivity, 1)
        distance = length_of(coordinates(:, body%connectivity(n, e)) - x)
        if (.not. distance < least) cycle
        least = distance
        node = body%connectivity(n, e)
      end do
    end do
  end function nearest_of_body

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

  !> `component x y`: the integration point nearest to a point of the mesh as it begins.
  subroutine read_point_probe(cursor, is_cut, draft, probe)
    type(cursor_t), intent(inout) :: cursor
    logical, intent(in) :: is_cut   !! bodies may have been cut
    type(draft_t), intent(in) :: draft
    type(probe_t), intent(inout) :: probe
    character(len=:), allocatable :: component
    real(wp) :: x(2), distance, nearest
    integer :: g, k, e, p

    call read_component(cursor, draft, component)
    call read_point(cursor, draft, is_cut, x)
    if (cursor%failed() .or. .not. (draft%mesh_sound .and. draft%groups_sound)) return
    nearest = huge(nearest)
    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        k = find_component(group, component)
        if (k == 0) cycle
        call nearest_point(draft%scene%mesh%origin, group, x, e, p, distance)
        if (.not. distance < nearest) cycle
        nearest = distance
        probe%group = g
        probe%element = e
        probe%point = p
        call set_component(group, component, probe)
      end associate
    end do
    if (.not. is_cut) return
    call nearest_node(draft%scene%mesh%origin, x, k, distance)
    probe%is_gone = is_off(draft, k, x)
  end subroutine read_point_probe

  !> Is a point further from its nearest node than the elements there are long? The matter there was cut off.
  pure function is_off(draft, node, x) result(off)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: node
    real(wp), intent(in) :: x(2)
    logical :: off
    real(wp) :: longest
    integer :: g, e, k

    longest = 0
    do g = 1, size(draft%scene%groups)
      if (.not. is_solid(draft%scene%groups(g))) cycle
      do e = 1, size(draft%scene%groups(g)%connectivity, 2)
        associate (nodes => draft%scene%groups(g)%connectivity(:, e))
          if (all(nodes /= node)) cycle
          do k = 1, 4
            longest = max(longest, length_of(draft%scene%mesh%origin(:, nodes(k)) &
                                             - draft%scene%mesh%origin(:, nodes(mod(k, 4) + 1))))
          end do
        end associate
      end do
    end do
    off = length_of(draft%scene%mesh%origin(:, node) - x) > longest
  end function is_off

  !> `component group`: the largest or smallest over all points of a group, or with more groups the mean over their volumes; of the
  !> word of a field of nodes, over the nodes of a body, or the mean over its volume.
  subroutine read_extreme_probe(cursor, draft, probe)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(probe_t), intent(inout) :: probe
    character(len=:), allocatable :: component
    type(string_t), allocatable :: names(:)
    type(probe_t) :: one
    integer :: g

    call read_component(cursor, draft, component, probe%field)
    allocate (probe%more_groups(0), probe%more_components(0))
    if (.not. draft%groups_sound) then
      call cursor%word('the name of a group', component)
      do while (probe%kind == probe_mean .and. cursor%more())
        call cursor%word('the name of a group', component)
      end do
      return
    end if
    allocate (names(size(draft%scene%groups)))
    do g = 1, size(names)
      names(g)%s = draft%scene%groups(g)%name
    end do
    do
      call cursor%name('the name of a group', names, g)
      if (g == 0) return
      if (probe%kind == probe_mean .and. size(draft%scene%groups(g)%connectivity, 1) /= 8) &
        call cursor%fail('MEAN is over the volume of a body: '''//names(g)%s//''' has none')
      if (probe%group == g .or. any(probe%more_groups == g)) call cursor%fail('the group '''//names(g)%s//''' is given twice')
      if (probe%field > 0) then
        call find_values(cursor, draft, g, probe)
      else if (find_component(draft%scene%groups(g), component) == 0) then
        call cursor%fail('group '''//names(g)%s//''' has no component '''//component//''''//group_with(draft, component, g))
        return
      end if
      if (cursor%failed()) return
      if (probe%group == 0) then
        probe%group = g
        if (probe%field == 0) call set_component(draft%scene%groups(g), component, probe)
      else
        if (probe%field == 0) call set_component(draft%scene%groups(g), component, one)
        probe%more_groups = [probe%more_groups, g]
        probe%more_components = [probe%more_components, one%component]
      end if
      if (probe%kind /= probe_mean .or. .not. cursor%more()) exit
    end do
  end subroutine read_extreme_probe

  !> The group on the same elements that has a component, for a message; '' where there is none.
  pure function group_with(draft, component, asked) result(words)
    type(draft_t), intent(in) :: draft
    character(len=*), intent(in) :: component
    integer, intent(in) :: asked   !! number of the group that has not
    character(len=:), allocatable :: words
    integer :: g

    words = ''
    do g = 1, size(draft%scene%groups)
      if (g == asked .or. find_component(draft%scene%groups(g), component) == 0) cycle
      if (draft%scene%groups(g)%host == asked) words = '; '''//draft%scene%groups(g)%name//''' has'
    end do
  end function group_with

  !> A body whose nodes have values of a field.
  subroutine find_values(cursor, draft, g, probe)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g   !! number of the group
    type(probe_t), intent(inout) :: probe

    associate (group => draft%scene%groups(g), field => draft%scene%fields(probe%field))
      probe%unit = field%unit
      if (all(group%role /= [role_body, role_second])) then
        call cursor%fail('expected a body, '''//group%name//''' is none')
      else if (size(group%connectivity) > 0) then
        call refuse_without_field(cursor, draft, probe%field, pack(group%connectivity, .true.), group%name, own=.false.)
      end if
    end associate
  end subroutine find_values

  !> A component of the state of any group; or, where `field` is there, the word of a field of nodes.
  subroutine read_component(cursor, draft, component, field)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    character(len=:), allocatable, intent(out) :: component
    integer, intent(out), optional :: field   !! its place in the scene's list, 0 for a component
    type(string_t), allocatable :: known(:), names(:)
    integer, allocatable :: place(:)
    integer :: g, k

    if (present(field)) field = 0

    if (.not. draft%groups_sound) then
      call cursor%word('a component of the state', component)
      return
    end if
    allocate (known(0))
    if (present(field)) then
      call field_words(draft%scene%fields, place, known)
      do k = 1, size(known)
        if (known(k)%s == cursor%peek_word()) field = place(k)
      end do
    end if
    do g = 1, size(draft%scene%groups)
      call component_names(draft%scene%groups(g)%variables, names)
      known = [known, names]
      if (find_variable(draft%scene%groups(g)%variables, 'stress') == 0) cycle
      do k = 1, nmeasure
        known = [known, string_t(trim(measure_names(k)))]
      end do
    end do
    call cursor%name('a component of the state', known, k)
    component = ''
    if (k > 0) component = known(k)%s
  end subroutine read_component

  pure function find_component(group, component) result(k)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: component
    type(string_t), allocatable :: names(:)
    integer :: k

    call component_names(group%variables, names)
    do k = 1, size(names)
      if (names(k)%s == component) return
    end do
    k = 0
    if (find_measure(component) == 0) return
    k = find_variable(group%variables, 'stress')
    if (k > 0) k = group%variables(k)%first
  end function find_component

  !> Place of a word among the measures of stress, 0 where it is none.
  pure function find_measure(word) result(k)
    character(len=*), intent(in) :: word
    integer :: k

    do k = nmeasure, 1, -1
      if (measure_names(k) == word) return
    end do
  end function find_measure

  !> What the probe reads of a group that has it.
  pure subroutine set_component(group, component, probe)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: component
    type(probe_t), intent(inout) :: probe

    probe%component = find_component(group, component)
    probe%measure = find_measure(component)
    probe%unit = unit_of(group%variables, probe%component)
  end subroutine set_component

  pure function unit_of(variables, component) result(unit)
    type(state_variable_t), intent(in) :: variables(:)
    integer, intent(in) :: component
    character(len=:), allocatable :: unit
    integer :: k

    unit = '-'
    do k = 1, size(variables)
      if (component >= variables(k)%first .and. component < variables(k)%first + variables(k)%ncomp) unit = variables(k)%unit
    end do
  end function unit_of

  !> Coordinates, which must lie in the box around the mesh.
  subroutine read_point(cursor, draft, is_cut, x)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    logical, intent(in) :: is_cut   !! bodies may have been cut: the box says nothing
    real(wp), intent(out) :: x(2)
    real(wp) :: low(2), high(2)

    call read_xy(cursor, 'the point', x)
    if (cursor%failed() .or. is_cut .or. .not. draft%mesh_sound) return
    low = minval(draft%scene%mesh%origin, 2) - outside_tolerance*draft%mesh_size
    high = maxval(draft%scene%mesh%origin, 2) + outside_tolerance*draft%mesh_size
    if (any(x < low .or. x > high)) &
      call cursor%fail('the point '//to_text(x(1))//' '//to_text(x(2))//' lies outside of the mesh')
  end subroutine read_point

  !> Integration point of a group nearest to x.
  subroutine nearest_point(coordinates, group, x, element, point, distance)
    real(wp), intent(in) :: coordinates(:, :)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: x(2)
    integer, intent(out) :: element, point
    real(wp), intent(out) :: distance
    real(wp), allocatable :: phi(:, :), dphi(:, :), xi(:, :), line(:), weight(:)
    real(wp) :: d
    integer :: e, p, n

    n = size(group%connectivity, 1)
    allocate (phi(n, group%rule%n), dphi(2, n))
    if (n == 3) then
      call line_rule(group%rule, line, weight)
      do p = 1, size(line)
        call line3(line(p), phi(:, p), dphi(1, :))
      end do
    else
      call square_rule(group%rule%n, xi, weight)
      do p = 1, size(xi, 2)
        call quad8(xi(1, p), xi(2, p), phi(:, p), dphi)
      end do
    end if
    element = 0
    point = 0
    distance = huge(distance)
    do e = 1, size(group%connectivity, 2)
      do p = 1, size(phi, 2)
        d = length_of(matmul(coordinates(:, group%connectivity(:, e)), phi(:, p)) - x)
        if (.not. d < distance) cycle
        distance = d
        element = e
        point = p
      end do
    end do
  end subroutine nearest_point

end module cards_probes
