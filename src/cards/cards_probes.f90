!> PROBE cards: columns of the history.
module cards_probes
  use cards_cuts, only: may_be_cut
  use cards_node_probes, only: read_node_probe, read_reaction_probe
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use field_places, only: refuse_without_field
  use history_columns, only: own_columns_named
  use kinds, only: wp
  use probe_components, only: find_component, read_component, set_component
  use probe_places, only: is_off, nearest_point, read_point
  use probes, only: probe_maximum, probe_mean, probe_minimum, probe_node, probe_point, probe_reaction, probe_t
  use scene, only: role_body, role_second
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t
  implicit none
  private
  public :: read_probes

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
      if (.not. cursor%failed() .and. own_columns_named(draft%scene, probe%name) > 0) &
        call cursor%fail('the history has a column '''//probe%name//''' of its own, take another name')
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

  !> `component x y`: the integration point nearest to a point of the mesh as it begins.
  subroutine read_point_probe(cursor, is_cut, draft, probe)
    type(cursor_t), intent(inout) :: cursor
    logical, intent(in) :: is_cut   !! bodies may have been cut
    type(draft_t), intent(in) :: draft
    type(probe_t), intent(inout) :: probe
    character(len=:), allocatable :: component
    real(wp) :: x(2), place(2), distance
    integer :: g, k, e, p

    call read_component(cursor, draft, component)
    call read_point(cursor, draft, is_cut, x)
    if (cursor%failed() .or. .not. draft%groups_sound) return
    if (.not. draft%mesh_sound) then
      ! its unit is known before there is a mesh, and is that of the column of all operations
      do g = size(draft%scene%groups), 1, -1
        if (find_component(draft%scene%groups(g), component) > 0) call set_component(draft%scene%groups(g), component, probe)
      end do
      return
    end if
    probe%apart = huge(distance)
    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        k = find_component(group, component)
        if (k == 0) cycle
        call nearest_point(draft%scene%mesh%origin, group, x, e, p, place, distance)
        if (.not. distance < probe%apart) cycle
        probe%apart = distance
        probe%place = place
        probe%group = g
        probe%element = e
        probe%point = p
        call set_component(group, component, probe)
      end associate
    end do
    if (.not. is_cut) return
    probe%is_gone = is_off(draft, x)
  end subroutine read_point_probe

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

end module cards_probes
