!> COU2DC: heat between sides and dies; TDIE by cards_die_heat.
module cards_heat_contact
  use card_groups, only: append_group, refuse_second, start_group
  use card_places, only: read_sides
  use cards_die_heat, only: find_die, read_die
  use cards_sides, only: refuse_inner_sides
  use contact_rule, only: rule_on_body
  use deck_cursor, only: cursor_t
  use deck_reader, only: card_t, deck_t
  use diagnostics, only: diagnostics_t, location_t
  use dies, only: is_deformable
  use elem_heat_contact, only: name_of_due, name_of_piece
  use field_places, only: refuse_without_field
  use fields, only: displacement_field, find_field
  use heat_contacts, only: heat_contact_t
  use kinds, only: wp
  use own_contact, only: faces_itself
  use quadrature, only: rule_gauss, rule_t
  use scene, only: group_t, role_contact, role_heat_contact
  use scene_draft, only: close_card, draft_t, next_of_words, words_of
  use state_variables, only: state_variable, state_variable_t, transfer_contact, transfer_recompute
  use text, only: string_t
  implicit none
  private
  public :: read_heat_contacts

  !> Gauss points of a side in scenes of heat alone.
  integer, parameter :: npoint = 3

contains

  !> All TDIE cards, then all COU2DC cards: a group each, and one for the heat capacity of a die.
  subroutine read_heat_contacts(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(location_t), allocatable :: given(:)
    integer :: i, k, f
    logical :: sound

    allocate (draft%scene%die_heats(0), given(0))
    sound = .true.
    f = 0
    if (draft%groups_sound) f = find_field(draft%scene%fields, 'temperature')
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'TDIE') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_die(cursor, draft, deck%cards(i), given, diagnostics)
      sound = sound .and. .not. cursor%failed()
    end do
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'COU2DC') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_contact(cursor, draft, deck%cards(i), f, sound, diagnostics)
    end do
    if (.not. draft%groups_sound) return
    do k = 1, size(draft%scene%die_heats)
      if (any(draft%scene%groups%role == role_heat_contact .and. draft%scene%groups%die == draft%scene%die_heats(k)%die)) cycle
      call diagnostics%add(given(k), 'TDIE', 'no COU2DC card names this die: its temperature does nothing')
    end do
  end subroutine read_heat_contacts

  !> `COU2DC place die H h [HO h] [EPS emissivity SIGMA constant ZERO zero] [REACH gap] [FRIC share [SHARE share|EFFUS b]]` and
  !> tables.
  subroutine read_contact(cursor, draft, card, field, dies_sound, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(card_t), intent(in) :: card
    integer, intent(in) :: field        !! the temperature, 0 where the scene has none
    logical, intent(in) :: dies_sound   !! no TDIE card has a mistake
    type(diagnostics_t), intent(in), target :: diagnostics
    type(group_t) :: group
    character(len=:), allocatable :: label

    call start_group('CNTTM', draft, group)
    call read_sides(cursor, draft, huge(0), label, group%connectivity, field=field)
    call refuse_inner_sides(cursor, draft, group%connectivity)
    call find_die(cursor, draft, group%die)
    if (draft%groups_sound .and. field == 0) call cursor%fail('no body of this scene has a temperature among its unknowns (PL8TM)')
    if (group%die > 0) group%name = label//'/'//draft%scene%dies(group%die)%name
    if (.not. cursor%failed() .and. draft%groups_sound) call find_contact(cursor, draft, field, dies_sound, group)
    group%name = group%name//'/COU2DC'
    call refuse_second(cursor, draft, group, 'this', diagnostics)
    call read_numbers(cursor, draft, group)
    call close_card(draft, cursor, card)
    if (cursor%failed()) then
      draft%groups_sound = .false.
      return
    end if
    call declare_state(draft, group)
    call append_group(draft, group, cursor%where())
  end subroutine read_contact

  !> The contact of the same sides and die, whose points heat passes; in scenes of heat alone there is none, and dies stand still.
  !> Cards name it: it is found where contours (BODY) have no mesh yet, too.
  subroutine find_contact(cursor, draft, field, dies_sound, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: field
    logical, intent(in) :: dies_sound
    type(group_t), intent(inout) :: group
    integer :: g

    associate (die => draft%scene%dies(group%die), groups => draft%scene%groups)
      do g = 1, size(groups)
        if (groups(g)%role == role_contact .and. groups(g)%die == group%die .and. groups(g)%name == group%name) group%host = g
      end do
      if (group%host == 0 .and. draft%scene%fields(displacement_field)%declared) then
        call cursor%fail('expected a CNT2D card of the same place and die, found none')
      else if (group%host == 0 .and. any(draft%scene%die_motions%die == group%die)) then
        call cursor%fail('in a scene of heat alone dies stand still, and a MOVE card moves this one')
      else if (.not. is_deformable(die) .and. dies_sound .and. .not. any(draft%scene%die_heats%die == group%die)) then
        call cursor%fail('the temperature of DIE '''//die%name//''' is not known: expected a TDIE card')
      end if
      if (.not. draft%mesh_sound) return
      group%rule = rule_t(rule_gauss, npoint)
      if (is_deformable(die)) then
        group%elem = 'CNDTM'
        group%elem_id = findloc([(draft%elems(g)%name == group%elem, g=1, size(draft%elems))], .true., 1)
        group%pairs = maxval([0, groups%pairs]) + 1
        call refuse_without_field(cursor, draft, field, [die%nodes], 'DIE '''//die%name//'''', own=.true.)
        if (faces_itself(draft%scene, group)) call cursor%fail('heat does not pass where a body faces itself')
      end if
      if (group%host > 0) then
        group%rule = groups(group%host)%rule
        group%connectivity = groups(group%host)%connectivity
        if (group%pairs > 0) group%pairs = groups(group%host)%pairs
      else if (group%pairs > 0) then
        group%rule = rule_on_body(draft%scene, group)
        group%rule_is_chosen = .true.
      end if
    end associate
  end subroutine find_contact

  !> Words with their numbers, each once, in any order; then tables.
  subroutine read_numbers(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(group_t), intent(inout) :: group
    type(string_t), allocatable :: words(:)
    logical :: given(9)
    real(wp) :: emissivity, constant
    integer :: k

    call words_of('H HO EPS SIGMA ZERO REACH FRIC SHARE EFFUS', words)
    given = .false.
    emissivity = 0
    constant = 0
    associate (contact => group%heat_contact)
      do while (cursor%more() .and. .not. cursor%failed())
        call next_of_words(cursor, words, given, k)
        if (k == 0) return
        select case (words(k)%s)
        case ('H')
          call cursor%real('the conductance of contact', contact%conductance, lower=0.0_wp, unit='power/area/temperature')
        case ('HO')
          call cursor%real('the coefficient of convection across a gap', contact%convection, lower=0.0_wp, &
                           unit='power/area/temperature')
        case ('EPS')
          call cursor%real('the emissivity of both surfaces together', emissivity, lower=0.0_wp, upper=1.0_wp, unit='-')
        case ('SIGMA')
          call cursor%real('the constant of Stefan and Boltzmann', constant, lower=0.0_wp, strict_lower=.true., &
                           unit='power/area/temperature^4')
        case ('ZERO')
          call cursor%real('the temperature to add to make one absolute', contact%zero, lower=0.0_wp, unit='temperature')
        case ('REACH')
          call cursor%real('the largest gap across which heat is exchanged', contact%reach, lower=0.0_wp, strict_lower=.true., &
                           unit='length')
        case ('FRIC')
          call cursor%real('the share of the work of friction that becomes heat', contact%friction, lower=0.0_wp, upper=1.0_wp, &
                           strict_lower=.true., unit='-')
        case ('SHARE')
          call cursor%real('the share of friction heat that goes into the sides', contact%share, lower=0.0_wp, upper=1.0_wp, &
                           unit='-')
        case ('EFFUS')
          call cursor%real('the effusivity of the die', contact%effusivity, lower=0.0_wp, strict_lower=.true., &
                           unit='power time^(1/2)/area/temperature')
        end select
      end do
      contact%radiation = emissivity*constant
      call read_tables(cursor, contact)
      if (.not. given(1)) call cursor%fail('expected H and its number, found none')
      if (any(given(3:5)) .and. .not. all(given(3:5))) call cursor%fail('radiation needs EPS, SIGMA and ZERO together')
      if ((given(2) .or. given(3) .or. allocated(contact%by_gap)) .neqv. given(6)) &
        call cursor%fail('REACH goes with what passes a gap (HO, EPS, rows GAP): expected both or none')
      if (any(given(8:9)) .and. .not. given(7)) call cursor%fail('SHARE and EFFUS are of the heat of friction: expected FRIC too')
      if (given(8) .and. given(9)) call cursor%fail('SHARE or EFFUS says how heat of friction is shared: expected one of them')
      if (cursor%failed() .or. group%die == 0 .or. .not. given(7)) return
      if (draft%groups_sound .and. group%host == 0) call cursor%fail('FRIC is of contact: in a scene of heat alone nothing slides')
      if (is_deformable(draft%scene%dies(group%die))) then
        if (given(9)) call cursor%fail('this die is made of sides: its body has the effusivity, expected no EFFUS')
      else if (.not. (given(8) .or. given(9))) then
        call cursor%fail('expected SHARE, or EFFUS of the rigid die, which say how heat of friction is shared')
      end if
    end associate
  end subroutine read_numbers

  !> Rows `PRESS` and `GAP`, each followed by pairs of a pressure or a gap, ascending, and the factor of H there.
  subroutine read_tables(cursor, contact)
    type(cursor_t), intent(inout) :: cursor
    type(heat_contact_t), intent(inout) :: contact
    type(string_t), allocatable :: words(:)
    real(wp), allocatable :: by_pressure(:), by_gap(:)
    integer :: k

    call words_of('PRESS GAP', words)
    allocate (by_pressure(0), by_gap(0))
    k = 0
    do while (cursor%more_rows() .and. .not. cursor%failed())
      call cursor%next_row('PRESS or GAP and pairs')
      if (k == 0 .or. .not. cursor%next_is_number()) call cursor%name('PRESS or GAP', words, k)
      if (k == 1) call read_pairs(cursor, 'a pressure', 'stress', by_pressure)
      if (k == 2) call read_pairs(cursor, 'a gap', 'length', by_gap)
    end do
    if (size(by_pressure) > 0) contact%by_pressure = reshape(by_pressure, [2, size(by_pressure)/2])
    if (size(by_gap) > 0) contact%by_gap = reshape(by_gap, [2, size(by_gap)/2])
  end subroutine read_tables

  !> The pairs of one row, after those read so far.
  subroutine read_pairs(cursor, what, unit, points)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: what, unit
    real(wp), allocatable, intent(inout) :: points(:)
    real(wp) :: pair(2)
    integer :: n

    do while (cursor%more() .and. .not. cursor%failed())
      n = size(points)
      if (n == 0) then
        call cursor%real(what, pair(1), lower=0.0_wp, unit=unit)
      else
        call cursor%real(what//' above the one before', pair(1), lower=points(n - 1), strict_lower=.true., unit=unit)
      end if
      call cursor%real('the factor of H there', pair(2), lower=0.0_wp, unit='-')
      points = [points, pair]
    end do
  end subroutine read_pairs

  !> What the points keep.
  subroutine declare_state(draft, group)
    type(draft_t), intent(in) :: draft
    type(group_t), intent(inout) :: group
    type(state_variable_t), allocatable :: list(:)
    integer :: k

    allocate (list(0))
    if (group%heat_contact%friction > 0) list = [list, state_variable(name_of_due, 'stress*length', transfer_contact)]
    if (is_deformable(draft%scene%dies(group%die))) list = [list, state_variable(name_of_piece, '-', transfer_recompute)]
    do k = 1, size(list)
      list(k)%first = k
    end do
    call move_alloc(list, group%variables)
  end subroutine declare_state

end module cards_heat_contact
