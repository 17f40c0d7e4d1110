!> STATE and SECTN: the plane state, its thickness, and what drives the section in generalised plane strain.
module cards_section
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: wp
  use scene, only: axisymmetric, generalised_plane_strain, plane_state_names
  use scene_draft, only: close_card, draft_t, head_location, only_card, words_of
  use sections, only: section_drive_t, section_forced, section_moved, section_names
  use text, only: join, string_t
  implicit none
  private
  public :: read_state, read_section

contains

  !> `STATE name [thickness]`.
  subroutine read_state(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: names(:)
    integer :: k, i

    draft%scene%section = [1.0_wp, 0.0_wp, 0.0_wp]
    allocate (names(size(plane_state_names)))
    do i = 1, size(names)
      names(i)%s = trim(plane_state_names(i))
    end do
    call only_card(deck, 'STATE', diagnostics, k, 'a plane state, one of '''//join(names, ''' ''')//'''')
    if (k == 0) return
    call cursor%open(deck%cards(k), diagnostics)
    call cursor%name('a plane state', names, draft%scene%plane_state)
    if (draft%scene%plane_state == axisymmetric) then
      draft%scene%section = [0.0_wp, 1.0_wp, 0.0_wp]
    else if (cursor%more()) then
      call cursor%real('the thickness', draft%scene%section(1), lower=0.0_wp, strict_lower=.true., unit='length')
    end if
    call close_card(draft, cursor, deck%cards(k))
  end subroutine read_state

  !> `SECTN E|KX|KY  HELD` or `FREE`, `MOVE lic [amplitude]`, `FORCE amplitude lic`: one card for each, in generalised plane strain.
  subroutine read_section(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: components(:)
    type(location_t) :: given(3)
    logical :: is_given(3)
    integer :: i, c

    call words_of('E KX KY', components)
    is_given = .false.
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'SECTN') cycle
      call cursor%open(deck%cards(i), diagnostics)
      if (draft%scene%plane_state > 0 .and. draft%scene%plane_state /= generalised_plane_strain) &
        call cursor%fail('only a scene in STATE GPLSTN has a section with unknowns')
      call cursor%name('a component of the section', components, c)
      if (c > 0) then
        if (is_given(c)) call cursor%fail(components(c)%s//' of the section is already given at '//diagnostics%place(given(c)))
        is_given(c) = .true.
        given(c) = cursor%where()
        call read_drive(cursor, draft, draft%scene%section_drives(c))
      end if
      call close_card(draft, cursor, deck%cards(i))
    end do
    if (draft%scene%plane_state /= generalised_plane_strain) return
    call only_card(deck, 'STATE', diagnostics, i)
    do c = 1, 3
      if (is_given(c)) cycle
      call diagnostics%add(head_location(deck%cards(i)), 'STATE', 'GPLSTN wants a card ''SECTN '//trim(section_names(c)) &
                           //'  HELD, FREE, MOVE or FORCE''; the deck has none')
    end do
  end subroutine read_section

  subroutine read_drive(cursor, draft, drive)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(section_drive_t), intent(out) :: drive
    type(string_t), allocatable :: ways(:)
    integer :: way, k

    call words_of('HELD FREE MOVE FORCE', ways)
    call cursor%name('HELD, FREE, MOVE or FORCE', ways, way)
    k = 0
    select case (way)
    case (2)
      drive%kind = section_forced
    case (3)
      drive%kind = section_moved
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      drive%amplitude = 1
      if (cursor%more()) call cursor%real('the amplitude', drive%amplitude)
    case (4)
      drive%kind = section_forced
      call cursor%real('the amplitude of the load', drive%amplitude)
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
    end select
    if (k > 0) drive%multiplier = draft%multipliers%item(k)
  end subroutine read_drive

end module cards_section
