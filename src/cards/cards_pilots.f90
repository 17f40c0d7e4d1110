!> What drives the pilots of dies beside MOVE: FORCE and FREE release a component, SPRNG ties it to its position at the start.
module cards_pilots
  use card_groups, only: append_group, start_group
  use card_places, only: place_t, read_place
  use cards_body_forces, only: names_body
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: pi, wp
  use loads, only: die_force_t
  use scene, only: axisymmetric, group_t
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t
  implicit none
  private
  public :: read_pilots, acts_on_die

contains

  !> All FORCE and SPRNG cards on dies, and FREE cards.
  subroutine read_pilots(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(location_t), allocatable :: given(:)
    type(cursor_t) :: cursor
    integer :: i

    allocate (draft%scene%die_forces(0), given(0))
    do i = 1, size(deck%cards)
      select case (deck%cards(i)%keyword)
      case ('FORCE', 'FREE')
        if (deck%cards(i)%keyword == 'FORCE' .and. .not. acts_on_die(deck, i)) cycle
        call cursor%open(deck%cards(i), diagnostics)
        call read_load(cursor, draft, deck%cards(i)%keyword == 'FORCE', given, diagnostics)
      case ('SPRNG')
        if (names_body(deck, draft, i)) cycle
        call cursor%open(deck%cards(i), diagnostics)
        call read_spring(cursor, draft, diagnostics)
      case default
        cycle
      end select
      call close_card(draft, cursor, deck%cards(i))
    end do
  end subroutine read_pilots

  !> A FORCE card names a die, not a node: its first field is neither NODE nor POINT.
  pure function acts_on_die(deck, card) result(on_die)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: card
    logical :: on_die

    on_die = size(deck%cards(card)%head%fields) > 0
    if (.not. on_die) return
    associate (word => deck%cards(card)%head%fields(1)%text)
      on_die = word /= 'NODE' .and. word /= 'POINT'
    end associate
  end function acts_on_die

  !> `die X|Y|A`, for a force also `amplitude lic`.
  subroutine read_load(cursor, draft, has_force, given, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    logical, intent(in) :: has_force
    type(location_t), allocatable, intent(inout) :: given(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    type(die_force_t) :: load
    integer :: k

    call read_component(cursor, draft, load%die, load%component)
    if (has_force) then
      call cursor%real('the amplitude', load%amplitude, unit='force, or moment for A; of the full circumference')
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      if (k > 0) load%multiplier = draft%multipliers%item(k)
      load%amplitude = load%amplitude/per_circumference(draft)
    end if
    if (cursor%failed()) return
    do k = 1, size(draft%scene%die_motions)
      associate (motion => draft%scene%die_motions(k))
        if (motion%die == load%die .and. motion%component == load%component) &
          call cursor%fail('the motion of this die in this direction is given by a MOVE card')
      end associate
    end do
    do k = 1, size(draft%scene%die_forces)
      associate (other => draft%scene%die_forces(k))
        if (other%die == load%die .and. other%component == load%component) &
          call cursor%fail('this die is already free in this direction, see '//diagnostics%place(given(k)))
      end associate
    end do
    draft%scene%die_forces = [draft%scene%die_forces, load]
    given = [given, cursor%where()]
  end subroutine read_load

  !> `die X|Y|A stiffness`: a group of one spring.
  subroutine read_spring(cursor, draft, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(in), target :: diagnostics
    type(group_t) :: group
    character(len=1), parameter :: components(3) = ['X', 'Y', 'A']
    integer :: g

    call start_group('SPRNG', draft, group)
    call read_component(cursor, draft, group%die, group%component)
    call cursor%real('the stiffness', group%stiffness, lower=0.0_wp, strict_lower=.true., &
                     unit='force/length, for A moment/angle; of the full circumference')
    if (cursor%failed()) return
    group%stiffness = group%stiffness/per_circumference(draft)
    group%name = draft%scene%dies(group%die)%name//'/spring.'//components(group%component)
    do g = 1, size(draft%scene%groups)
      if (draft%scene%groups(g)%name == group%name) &
        call cursor%fail('this die has a spring in this direction already, see '//diagnostics%place(draft%group_where(g)))
    end do
    group%rule%n = 1
    allocate (group%connectivity(0, 1))
    call append_group(draft, group, cursor%where())
  end subroutine read_spring

  subroutine read_component(cursor, draft, die, component)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(out) :: die, component
    type(string_t), allocatable :: directions(:)
    type(place_t) :: place

    call words_of('X Y A', directions)
    call read_place(cursor, draft, .true., place)
    die = place%die
    if (die == 0) call cursor%fail('expected the name of a DIE (or NODE, POINT on a FORCE card), found ''' &
                                   //place%label//'''; TRACT and PRES2D load sides')
    call cursor%name('a direction', directions, component)
  end subroutine read_component

  !> Values of the card are for the full circumference, forces in the solver are per radian.
  pure function per_circumference(draft) result(factor)
    type(draft_t), intent(in) :: draft
    real(wp) :: factor

    factor = merge(2*pi, 1.0_wp, draft%scene%plane_state == axisymmetric)
  end function per_circumference

end module cards_pilots
