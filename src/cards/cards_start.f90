!> START: values of fields at the start, as numbers, by formulas of the place, or the temperatures of another run; and the phases.
module cards_start
  use cards_fields, only: read_body, read_field
  use cards_sleep, only: may_sleep
  use cards_start_phases, only: read_start_phases
  use deck_cursor, only: cursor_t
  use deck_expression, only: evaluate
  use deck_parameters, only: parameters_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use element_fields, only: acts_on
  use field_places, only: refuse_without_field
  use kinds, only: wp
  use loads, only: instants_around, start_t
  use other_run, only: nodes_of_body, read_file_of_run, read_instant_of_run, temperatures_at_nodes
  use run_temperatures, only: run_temperatures_t
  use scene, only: host_of, is_solid
  use scene_draft, only: close_card, draft_t
  use text, only: to_text
  implicit none
  private
  public :: read_start_values

contains

  !> All START cards: `PHASES phase share ... [body]`, the phases; `field value [body]` or `field FROM file AT time [body]`, the
  !> value of a field at the start, everywhere or on a body: a number, a formula of the place where the material is in the deck's
  !> own mesh, or the temperatures of another run.
  subroutine read_start_values(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(start_t) :: start
    type(start_t), allocatable :: everywhere(:)
    type(run_temperatures_t) :: run
    logical, allocatable :: given(:), with_phases(:)
    character(len=:), allocatable :: formula, file
    integer, allocatable :: cards(:)
    real(wp) :: value
    integer :: i, f
    logical :: whole, from_run

    allocate (given(0), cards(0), everywhere(0), draft%scene%starts(0))
    allocate (with_phases(size(draft%scene%groups)), source=.false.)
    if (draft%groups_sound) given = spread(.false., 1, size(draft%scene%fields))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'START') cycle
      call cursor%open(deck%cards(i), diagnostics)
      if (cursor%peek_word() == 'PHASES') then
        call read_start_phases(cursor, draft, with_phases)
        call close_card(draft, cursor, deck%cards(i))
        cycle
      end if
      call read_field(cursor, draft, f)
      if (f > 0) then
        start%field = f
        start%body = ''
        from_run = cursor%peek_word() == 'FROM'
        whole = size(deck%cards(i)%head%fields) < merge(6, 3, from_run)
        if (whole .and. given(f)) call cursor%fail('the start of '//draft%scene%fields(f)%word//' is given twice')
        formula = ''
        if (from_run) then
          if (draft%scene%fields(f)%name /= 'temperature') call cursor%fail('another run gives temperatures, T')
          call read_file_of_run(cursor, draft%elems, deck%path, file, run)
          call read_instant_of_run(cursor, run, 'an instant of that run', value)
        else
          call cursor%real_or_formula('the value at the start', value, formula, draft%scene%fields(f)%unit)
          call values_at_nodes(cursor, draft, value, formula, start%values)
        end if
        if (.not. whole) then
          call read_body_of_start(cursor, draft, f, start%body)
          cards = [cards, i]
        end if
        if (from_run) call values_of_run(cursor, draft, run, file, value, start)
        if (whole) then
          given(f) = .true.
          if (formula == '' .and. .not. from_run) then
            draft%scene%fields(f)%initial = value
          else
            everywhere = [everywhere, start]
          end if
        else if (.not. cursor%failed()) then
          draft%scene%starts = [draft%scene%starts, start]
        end if
      end if
      if (f == 0) call cursor%leave()
      call close_card(draft, cursor, deck%cards(i))
    end do
    if (draft%mesh_sound .and. draft%groups_sound .and. size(cards) == size(draft%scene%starts)) then
      do i = 1, size(cards)
        call cursor%open(deck%cards(cards(i)), diagnostics)
        call refuse_two_starts(cursor, deck, draft, everywhere, draft%scene%starts(i))
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

  !> The body that a start is of; empty after a mistake.
  subroutine read_body_of_start(cursor, draft, field, name)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: field
    character(len=:), allocatable, intent(out) :: name
    integer :: body, k

    name = ''
    call read_body(cursor, draft, body)
    if (body == 0) return
    name = draft%scene%groups(body)%name
    call refuse_without_field(cursor, draft, field, [draft%scene%groups(body)%connectivity], name, own=.true.)
    do k = 1, size(draft%scene%starts)
      if (draft%scene%starts(k)%field == field .and. draft%scene%starts(k)%body == name) &
        call cursor%fail('the start of '//draft%scene%fields(field)%word//' of '''//name//''' is given twice')
    end do
  end subroutine read_body_of_start

  !> The temperatures of another run at the nodes of a body, or of all that have a temperature. A new mesh has those of the old one.
  subroutine values_of_run(cursor, draft, run, file, time, start)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(run_temperatures_t), intent(in) :: run
    character(len=*), intent(in) :: file    !! as the card names it
    real(wp), intent(in) :: time            !! [time]
    type(start_t), intent(inout) :: start   !! its body is known
    integer, allocatable :: nodes(:)
    real(wp), allocatable :: values(:, :)
    real(wp) :: share
    integer :: g, k, before

    if (allocated(start%values)) deallocate (start%values)
    allocate (start%values(0))
    if (.not. (draft%mesh_sound .and. draft%groups_sound) .or. cursor%failed()) return
    start%values = spread(0.0_wp, 1, size(draft%scene%mesh%coordinates, 2))
    if (draft%scene%generation > 1) return
    call instants_around(run%time, time, before, share)
    do g = 1, size(draft%scene%groups)
      associate (body => draft%scene%groups(g))
        if (.not. is_solid(body) .or. (start%body /= '' .and. body%name /= start%body)) cycle
        if (.not. any([(has_temperature(k), k=1, size(draft%scene%groups))])) cycle
        call nodes_of_body(draft, g, nodes)
        call temperatures_at_nodes(cursor, draft, run, file, body%name, nodes, values)
        if (cursor%failed()) return
        start%values(nodes) = values(:, before)
        if (share > 0) start%values(nodes) = (1 - share)*values(:, before) + share*values(:, before + 1)
      end associate
    end do

  contains

    !> A formulation on the body has a temperature.
    pure function has_temperature(group) result(yes)
      integer, intent(in) :: group
      logical :: yes

      yes = host_of(draft%scene, group) == g .and. acts_on(draft%elems(draft%scene%groups(group)%elem_id), 'temperature')
    end function has_temperature

  end subroutine values_of_run

  !> A node that two bodies share starts with one value, unless one of them comes later (ASLEEP).
  subroutine refuse_two_starts(cursor, deck, draft, everywhere, start)
    type(cursor_t), intent(inout) :: cursor
    type(deck_t), intent(in) :: deck
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
        if (may_sleep(deck, group%name) .or. may_sleep(deck, start%body)) cycle
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

end module cards_start
