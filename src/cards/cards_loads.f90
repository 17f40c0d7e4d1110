!> LIC, FIXED, MOVE and FORCE (on nodes): multipliers in time, and the motions and forces that they drive.
module cards_loads
  use card_places, only: node_text, place_t, read_place
  use cards_pilots, only: acts_on_die
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use dies, only: is_deformable
  use diagnostics, only: diagnostics_t, location_t
  use field_places, only: refuse_without_field
  use fields, only: displacement_field
  use kinds, only: wp
  use loads, only: die_motion_t, fixation_t, multiplier_t, nodal_force_t
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t
  implicit none
  private
  public :: read_multipliers, read_loads

contains

  !> All LIC cards: pairs of time and value, as many on a row as one likes.
  subroutine read_multipliers(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(multiplier_t) :: multiplier
    real(wp), allocatable :: pairs(:, :)
    real(wp) :: time, value
    integer :: i, n

    allocate (draft%scene%multipliers(0))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'LIC') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call draft%multipliers%define(cursor, 'the name of the multiplier', 'LIC', size(draft%scene%multipliers) + 1, &
                                    diagnostics, multiplier%name)
      allocate (pairs(2, 0))
      n = 0
      call cursor%next_row('pairs of time and value')
      do while (.not. cursor%failed())
        if (n == 0) then
          call cursor%real('a first time', time, upper=0.0_wp, unit='time')
        else
          call cursor%real('a time later than the one before', time, lower=pairs(1, n), strict_lower=.true., unit='time')
        end if
        call cursor%real('the value at this time', value)
        if (cursor%failed()) exit
        ! twice the room when there is none: a long card is read in a time that grows with its rows
        if (n == size(pairs, 2)) pairs = reshape(pairs, [2, max(2*n, 16)], pad=[0.0_wp])
        n = n + 1
        pairs(:, n) = [time, value]
        if (cursor%more()) cycle
        if (.not. cursor%more_rows()) exit
        call cursor%next_row('pairs of time and value')
      end do
      call close_card(draft, cursor, deck%cards(i))
      multiplier%time = pairs(1, :n)
      multiplier%value = pairs(2, :n)
      deallocate (pairs)
      ! One that could not be read has no times: what depends on them is not judged.
      if (cursor%failed()) multiplier%time = multiplier%time(:0)
      draft%scene%multipliers = [draft%scene%multipliers, multiplier]
    end do
  end subroutine read_multipliers

  !> All FIXED, MOVE and FORCE cards.
  subroutine read_loads(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(location_t), allocatable :: fixation_where(:), motion_where(:)
    integer, allocatable :: prescribed(:, :)
    type(cursor_t) :: cursor
    integer :: i, n

    n = size(draft%scene%mesh%labels)
    allocate (prescribed(2, n), source=0)
    allocate (fixation_where(0), motion_where(0))
    allocate (draft%scene%fixations(0), draft%scene%die_motions(0), draft%scene%forces(0))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'FIXED' .and. deck%cards(i)%keyword /= 'MOVE') cycle
      call cursor%open(deck%cards(i), diagnostics)
      if (deck%cards(i)%keyword == 'FIXED') then
        call read_fixed(cursor, draft, prescribed, fixation_where, diagnostics)
      else
        call read_move(cursor, draft, prescribed, fixation_where, motion_where, diagnostics)
      end if
      call close_card(draft, cursor, deck%cards(i))
    end do
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'FORCE') cycle
      if (acts_on_die(deck, i)) cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_force(cursor, draft, prescribed, fixation_where, diagnostics)
      call close_card(draft, cursor, deck%cards(i))
    end do
  end subroutine read_loads

  !> `place X|Y|XY [NOWALL]`: held where it is.
  subroutine read_fixed(cursor, draft, prescribed, given, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(inout) :: prescribed(:, :)
    type(location_t), allocatable, intent(inout) :: given(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    type(string_t), allocatable :: directions(:), options(:)
    type(place_t) :: place
    type(fixation_t) :: fixation
    integer :: direction, component, option

    call words_of('NOWALL', options)
    call words_of('X Y XY', directions)
    call read_place(cursor, draft, .false., place)
    call refuse_without_field(cursor, draft, displacement_field, place%nodes, place%label, own=.true.)
    call cursor%name('a direction', directions, direction)
    if (cursor%more()) then
      call cursor%name('NOWALL or nothing', options, option)
      fixation%may_pass = option == 1
    end if
    do component = 1, 2
      if (direction /= component .and. direction /= 3) cycle
      fixation%nodes = place%nodes
      fixation%component = component
      fixation%label = 'FIXED '//place%label//' '//directions(component)%s
      call add_fixation(cursor, draft, fixation, prescribed, given, diagnostics)
    end do
  end subroutine read_fixed

  !> `place X|Y lic [amplitude]` or `die X|Y|A lic [amplitude]`.
  subroutine read_move(cursor, draft, prescribed, given, motion_where, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(inout) :: prescribed(:, :)
    type(location_t), allocatable, intent(inout) :: given(:), motion_where(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    type(string_t), allocatable :: directions(:)
    type(place_t) :: place
    type(fixation_t) :: fixation
    type(die_motion_t) :: motion
    real(wp) :: amplitude
    integer :: direction, k

    call words_of('X Y A', directions)
    call read_place(cursor, draft, .true., place)
    if (place%die == 0) &
      call refuse_without_field(cursor, draft, displacement_field, place%nodes, place%label, own=.true.)
    if (place%die > 0) then
      if (is_deformable(draft%scene%dies(place%die))) call cursor%fail('the DIE '''//place%label &
                                                                       //''' is made of sides: it moves with their bodies')
    end if
    call cursor%name('a direction', directions, direction)
    if (direction == 3 .and. place%die == 0) call cursor%fail('only a DIE can turn (A); '''//place%label//''' is none')
    call draft%multipliers%find(cursor, 'the name of a LIC', k)
    amplitude = 1
    if (cursor%more()) call cursor%real('the amplitude', amplitude)
    if (cursor%failed()) return
    if (place%die > 0) then
      motion = die_motion_t(place%die, direction, amplitude, draft%multipliers%item(k))
      call add_motion(cursor, draft, motion, motion_where, diagnostics)
    else
      fixation%nodes = place%nodes
      fixation%component = direction
      fixation%amplitude = amplitude
      fixation%multiplier = draft%multipliers%item(k)
      fixation%label = 'MOVE '//place%label//' '//directions(direction)%s//' '//draft%multipliers%words(k)%s
      call add_fixation(cursor, draft, fixation, prescribed, given, diagnostics)
    end if
  end subroutine read_move

  !> A node's component has one motion: the same again is accepted, another is refused.
  subroutine add_fixation(cursor, draft, fixation, prescribed, given, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(fixation_t), intent(in) :: fixation
    integer, intent(inout) :: prescribed(:, :)
    type(location_t), allocatable, intent(inout) :: given(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    integer :: i, other

    do i = 1, size(fixation%nodes)
      other = prescribed(fixation%component, fixation%nodes(i))
      prescribed(fixation%component, fixation%nodes(i)) = size(given) + 1
      if (other == 0) cycle
      if (other == size(given) + 1) cycle
      if (same_motion(draft%scene%fixations(other), fixation)) cycle
      call cursor%fail('another motion of '//node_text(draft, fixation%nodes(i))//' in this direction is given at ' &
                       //diagnostics%place(given(other)))
      exit
    end do
    draft%scene%fixations = [draft%scene%fixations, fixation]
    given = [given, cursor%where()]
  end subroutine add_fixation

  pure function same_motion(a, b) result(same)
    type(fixation_t), intent(in) :: a, b
    logical :: same

    same = .not. (abs(a%amplitude) > 0 .or. abs(b%amplitude) > 0)
    if (.not. same) same = a%multiplier == b%multiplier .and. .not. abs(a%amplitude - b%amplitude) > 0
  end function same_motion

  subroutine add_motion(cursor, draft, motion, given, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(die_motion_t), intent(in) :: motion
    type(location_t), allocatable, intent(inout) :: given(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    integer :: i

    do i = 1, size(given)
      associate (other => draft%scene%die_motions(i))
        if (other%die == motion%die .and. other%component == motion%component) &
          call cursor%fail('a motion of this die in this direction is already given at '//diagnostics%place(given(i)))
      end associate
    end do
    draft%scene%die_motions = [draft%scene%die_motions, motion]
    given = [given, cursor%where()]
  end subroutine add_motion

  !> `NODE label|POINT x y  X|Y  amplitude  lic`.
  subroutine read_force(cursor, draft, prescribed, given, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: prescribed(:, :)
    type(location_t), intent(in) :: given(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    type(string_t), allocatable :: directions(:)
    type(place_t) :: place
    type(nodal_force_t) :: force
    integer :: k

    call words_of('X Y', directions)
    call read_place(cursor, draft, .false., place)
    call refuse_without_field(cursor, draft, displacement_field, place%nodes, place%label, own=.true.)
    call cursor%name('a direction', directions, force%component)
    if (size(place%nodes) > 0 .and. .not. cursor%failed()) then
      force%node = place%nodes(1)
      k = prescribed(force%component, force%node)
      if (k > 0) call cursor%fail('the force is without effect: the motion of '//node_text(draft, force%node) &
                                  //' in this direction is given at '//diagnostics%place(given(k)))
    end if
    call cursor%real('the amplitude', force%amplitude, unit='force, per radian when axisymmetric')
    call draft%multipliers%find(cursor, 'the name of a LIC', k)
    if (cursor%failed()) return
    force%multiplier = draft%multipliers%item(k)
    draft%scene%forces = [draft%scene%forces, force]
  end subroutine read_force

end module cards_loads
