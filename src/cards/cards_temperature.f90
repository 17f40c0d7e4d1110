!> TEMPE: the temperature of a body, given in time or by another run, and the check that laws which need one have it.
module cards_temperature
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_api, only: elem_t
  use element_fields, only: acts_on
  use fields, only: field_t, find_field
  use kinds, only: wp
  use law_api, only: asks_for, law_t
  use loads, only: field_history_t, instants_around, start_t
  use materials, only: material_t
  use other_run, only: nodes_of_body, read_file_of_run, read_instant_of_run, temperatures_at_nodes
  use run_temperatures, only: run_temperatures_t
  use scene, only: role_body
  use scene_draft, only: close_card, draft_t
  use text, only: to_text
  implicit none
  private
  public :: read_temperatures_of_bodies, knows_temperature, refuse_short_histories

  !> A run may end so much before the scene, over its length: rounding of the last step.
  real(wp), parameter :: end_slack = 1.0e-9_wp

contains

  !> All TEMPE cards: `body amplitude lic`, or `body FROM file [AT time]`.
  subroutine read_temperatures_of_bodies(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    real(wp) :: amplitude
    integer :: i, k, g, before

    before = diagnostics%count()
    allocate (draft%scene%histories(0))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'TEMPE') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call draft%places%find(cursor, 'the name of a body', k, not_of='DIE SIDES')
      g = 0
      if (k > 0) g = body_group(draft, draft%places%words(k)%s)
      if (k > 0 .and. g == 0) call cursor%fail(''''//draft%places%words(k)%s//''' is a '//draft%places%keywords(k)%s &
                                               //', expected a body')
      if (g > 0) call check_body(cursor, draft, g)
      if (cursor%peek_word() == 'FROM') then
        call read_history(cursor, deck%path, draft, g, size(deck%cards(i)%head%fields) > 3)
        call close_card(draft, cursor, deck%cards(i))
        ! without it nothing is known of a temperature that others may ask for
        if (cursor%failed()) draft%groups_sound = .false.
        cycle
      end if
      call cursor%real('the amplitude of the temperature', amplitude, unit='temperature')
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      call close_card(draft, cursor, deck%cards(i))
      if (cursor%failed()) cycle
      draft%scene%groups(g)%temperature_amplitude = amplitude
      draft%scene%groups(g)%temperature_multiplier = draft%multipliers%item(k)
    end do
    ! a body whose ADDEL card has a mistake may have been meant to have one
    if (diagnostics%count() == before .and. draft%groups_sound) call refuse_bodies_without(draft, diagnostics)
  end subroutine read_temperatures_of_bodies

  !> `FROM file [AT time]`: the temperatures of another run, this scene beginning at an instant of it, 0 where none is given.
  !> Nodes of the body then have a temperature that is given.
  subroutine read_history(cursor, deck_path, draft, g, with_instant)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: deck_path
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: g   !! number of the body, 0 where there is none
    logical, intent(in) :: with_instant
    type(run_temperatures_t) :: run
    type(field_history_t) :: history
    type(start_t) :: start
    integer :: k, before
    real(wp) :: share

    call read_file_of_run(cursor, draft%elems, deck_path, history%source, run)
    if (with_instant .and. .not. cursor%failed()) &
      call read_instant_of_run(cursor, run, 'the instant of that run at which this scene begins', history%begins)
    if (cursor%failed() .or. g == 0 .or. .not. (draft%mesh_sound .and. draft%groups_sound)) return
    do k = 1, size(draft%scene%groups)
      if (acts_on(draft%elems(draft%scene%groups(k)%elem_id), 'temperature')) &
        call cursor%fail('the temperature is an unknown of this scene (body '//draft%scene%groups(k)%name &
                         //'): temperatures of another run are for scenes without')
    end do
    history%body = draft%scene%groups(g)%name
    call nodes_of_body(draft, g, history%nodes)
    call refuse_other_source(cursor, draft, history)
    call temperatures_at_nodes(cursor, draft, run, history%source, history%body, history%nodes, history%values)
    if (cursor%failed()) return
    if (run%time(1) > history%begins) then
      call cursor%fail('the first instant of '''//history%source//''' is at '//to_text(run%time(1), 6) &
                       //': expected AT, and the instant of that run at which this scene begins')
      return
    end if
    history%time = run%time - history%begins
    call declare_given(draft, history%field)
    ! what is free of thermal strain is so at the first of them
    call instants_around(history%time, 0.0_wp, before, share)
    start%field = history%field
    start%body = history%body
    allocate (start%values(size(draft%scene%mesh%coordinates, 2)), source=0.0_wp)
    start%values(history%nodes) = history%values(:, before)
    if (share > 0) start%values(history%nodes) = (1 - share)*history%values(:, before) + share*history%values(:, before + 1)
    draft%scene%starts = [draft%scene%starts, start]
    draft%scene%histories = [draft%scene%histories, history]
    draft%scene%groups(g)%temperature_history = size(draft%scene%histories)
  end subroutine read_history

  !> Bodies that share nodes have the temperatures of one run, from one instant on.
  subroutine refuse_other_source(cursor, draft, history)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(field_history_t), intent(in) :: history
    logical :: own(size(draft%scene%mesh%coordinates, 2))
    integer :: k

    own = .false.
    own(history%nodes) = .true.
    do k = 1, size(draft%scene%histories)
      if (.not. any(own(draft%scene%histories(k)%nodes))) cycle
      if (draft%scene%histories(k)%source == history%source &
          .and. .not. abs(draft%scene%histories(k)%begins - history%begins) > 0) cycle
      call cursor%fail('the bodies '''//history%body//''' and '''//draft%scene%histories(k)%body &
                       //''' share nodes: expected temperatures of the same run at the same instants')
    end do
  end subroutine refuse_other_source

  !> The temperature as a field that is given: as bodies that conduct heat have it, on eight nodes.
  subroutine declare_given(draft, place)
    type(draft_t), intent(inout) :: draft
    integer, intent(out) :: place   !! in the scene's list of fields
    type(field_t) :: field

    place = find_field(draft%scene%fields, 'temperature')
    if (place > 0) return
    call find_declared(draft%elems, field)
    field%given = .true.
    field%declared = .true.
    draft%scene%fields = [draft%scene%fields, field]
    place = size(draft%scene%fields)
  end subroutine declare_given

  !> The temperature as the first element of bodies that acts on it declares it.
  pure subroutine find_declared(elems, field)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(field_t), intent(out) :: field
    integer :: k, u

    do k = 1, size(elems)
      if (elems(k)%role /= role_body .or. .not. acts_on(elems(k), 'temperature')) cycle
      do u = 1, size(elems(k)%unknowns)
        field = elems(k)%unknowns(u)%field
        if (field%name == 'temperature') return
      end do
    end do
  end subroutine find_declared

  !> The temperatures of other runs must last until the end of the scene.
  subroutine refuse_short_histories(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    character(len=:), allocatable :: there
    real(wp) :: last
    integer :: i, k

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'TEMPE') cycle
      do k = 1, size(draft%scene%histories)
        if (deck%cards(i)%head%fields(1)%text /= draft%scene%histories(k)%body) cycle
        associate (history => draft%scene%histories(k), end_time => draft%scene%strategy%end_time)
          last = history%time(size(history%time))
          ! an instant of that run is known to the rounding of the whole time there
          if (.not. last < end_time - end_slack*max(end_time, last + history%begins)) cycle
          call cursor%open(deck%cards(i), diagnostics)
          there = ''
          if (history%begins > 0) there = ', '//to_text(end_time + history%begins, 6)//' of that run'
          call cursor%fail('the last instant of '''//history%source//''' is at '//to_text(last + history%begins, 6) &
                           //', before the end of this scene at '//to_text(end_time, 6)//there)
        end associate
      end do
    end do
  end subroutine refuse_short_histories

  !> The group of a body, 0 for other places.
  pure function body_group(draft, name) result(g)
    type(draft_t), intent(in) :: draft
    character(len=*), intent(in) :: name
    integer :: g

    do g = 1, size(draft%scene%groups)
      if (draft%scene%groups(g)%name == name .and. draft%scene%groups(g)%die == 0) return
    end do
    g = 0
  end function body_group

  !> One temperature for a body, and only where its law uses it.
  subroutine check_body(cursor, draft, g)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g
    integer :: law

    associate (group => draft%scene%groups(g))
      if (has_field(draft, g)) call cursor%fail('the temperature of '//group%name//' is an unknown of this scene')
      if (max(group%temperature_multiplier, group%temperature_history) > 0) &
        call cursor%fail('the temperature of '''//group%name//''' is given twice')
      if (group%material == 0) return
      associate (material => draft%scene%materials(group%material))
        law = material%law_id
        if (law == 0) return
        if (.not. knows_temperature(draft%laws(law), material)) &
          call cursor%fail('LAW '//material%name//' of body '//group%name//' does not depend on the temperature: it has no rows ' &
                           //'TEMP')
      end associate
    end associate
  end subroutine check_body

  !> A formulation on the body has the temperature among its unknowns.
  pure function has_field(draft, g) result(yes)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g   !! number of a body
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(draft%scene%groups)
      if (k /= g .and. draft%scene%groups(k)%host /= g) cycle
      yes = yes .or. acts_on(draft%elems(draft%scene%groups(k)%elem_id), 'temperature')
    end do
  end function has_field

  subroutine refuse_bodies_without(draft, diagnostics)
    type(draft_t), intent(in) :: draft
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: g, k

    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        if (group%material == 0 .or. max(group%temperature_multiplier, group%temperature_history) > 0) cycle
        if (has_field(draft, g)) cycle
        associate (material => draft%scene%materials(group%material))
          if (material%law_id == 0) cycle
          if (.not. knows_temperature(draft%laws(material%law_id), material)) cycle
          do k = 1, size(draft%places%words)
            if (draft%places%words(k)%s /= group%name) cycle
            call diagnostics%add(draft%places%location(k), draft%places%keywords(k)%s, 'LAW '//material%name//reason(material) &
                                 //': body '//group%name//' needs a TEMPE card, or ADDEL with PL8TM')
          end do
        end associate
      end associate
    end do
  end subroutine refuse_bodies_without

  pure function reason(material) result(s)
    type(material_t), intent(in) :: material
    character(len=:), allocatable :: s

    if (allocated(material%temperatures)) then
      s = ' is given at several temperatures'
    else
      s = ' asks for the temperature'
    end if
  end function reason

  !> The response of a material depends on the temperature.
  pure function knows_temperature(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes

    yes = allocated(material%temperatures) .or. asks_for(law, 'temperature')
  end function knows_temperature

end module cards_temperature
