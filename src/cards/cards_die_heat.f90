!> TDIE: the temperature of a rigid die, given in time or of a heat capacity.
module cards_die_heat
  use card_groups, only: append_group, start_group
  use cards_heat, only: read_multiplier
  use deck_cursor, only: cursor_t
  use deck_reader, only: card_t
  use diagnostics, only: diagnostics_t, location_t
  use dies, only: is_deformable
  use heat_contacts, only: die_heat_t
  use kinds, only: pi, wp
  use scene, only: axisymmetric, group_t
  use scene_draft, only: close_card, draft_t, head_location, next_of_words, words_of
  use text, only: string_t
  implicit none
  private
  public :: find_die, read_die

contains

  !> `TDIE die T temperature [lic] [C capacity]`.
  subroutine read_die(cursor, draft, card, given, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(card_t), intent(in) :: card
    type(location_t), allocatable, intent(inout) :: given(:)
    type(diagnostics_t), intent(in), target :: diagnostics
    type(die_heat_t) :: heat
    type(group_t) :: group
    type(string_t), allocatable :: words(:)
    logical :: stated(2)
    integer :: k

    call find_die(cursor, draft, heat%die)
    if (heat%die > 0) then
      if (is_deformable(draft%scene%dies(heat%die))) &
        call cursor%fail('this die is made of sides: it has the temperature of its body')
    end if
    call words_of('T C', words)
    stated = .false.
    do while (cursor%more() .and. .not. cursor%failed())
      call next_of_words(cursor, words, stated, k)
      if (k == 1) then
        call cursor%real('the temperature of the die', heat%temperature, unit='temperature')
        call read_multiplier(cursor, draft, words, heat%multiplier)
      else if (k == 2) then
        call cursor%real('the heat capacity of the die', heat%capacity, lower=0.0_wp, strict_lower=.true., &
                         unit='energy/temperature; of the full circumference')
      end if
    end do
    if (.not. stated(1)) call cursor%fail('expected T and the temperature of the die, found none')
    if (stated(2) .and. heat%multiplier > 0) &
      call cursor%fail('a die with a heat capacity has the temperature T at the start: expected no LIC after it')
    do k = 1, size(draft%scene%die_heats)
      if (draft%scene%die_heats(k)%die == heat%die) &
        call cursor%fail('the temperature of this die is given already, see '//diagnostics%place(given(k)))
    end do
    call close_card(draft, cursor, card)
    if (cursor%failed()) return
    if (draft%scene%plane_state == axisymmetric) heat%capacity = heat%capacity/(2*pi)
    draft%scene%die_heats = [draft%scene%die_heats, heat]
    given = [given, head_location(card)]
    if (.not. heat%capacity > 0) return
    call start_group('DIETM', draft, group)
    group%name = draft%scene%dies(heat%die)%name//'/DIETM'
    group%die = heat%die
    group%amplitude = heat%capacity
    group%rule%n = 1
    allocate (group%connectivity(0, 1))
    call append_group(draft, group, cursor%where())
  end subroutine read_die

  !> The name of a DIE; 0 after a mistake.
  subroutine find_die(cursor, draft, die)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(out) :: die
    integer :: k

    die = 0
    call draft%places%find(cursor, 'the name of a DIE', k, of='DIE')
    if (k == 0) return
    if (draft%places%keywords(k)%s == 'DIE') then
      die = draft%places%item(k)
    else
      call cursor%fail(''''//draft%places%words(k)%s//''' is a '//draft%places%keywords(k)%s//', expected a DIE')
    end if
  end subroutine find_die

end module cards_die_heat
