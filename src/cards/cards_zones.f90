!> ZPNT and ZONE: quadrilateral zones that the remesher fills with elements.
module cards_zones
  use card_names, only: names_t
  use card_places, only: read_rigid_die
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t
  use zone_marks, only: mark_crossing, mark_inside, mark_matter, zone_card_t, zone_mark_t
  implicit none
  private
  public :: read_zones

contains

  !> All ZPNT and ZONE cards: points first, as zones name them.
  subroutine read_zones(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(names_t) :: points
    logical :: sound

    sound = .true.
    call points%clear()
    call read_points(deck, draft, points, sound, diagnostics)
    call read_quadrilaterals(deck, draft, points, sound, diagnostics)
    if (sound) call points%refuse_unused('ZPNT', ': a ZONE card must name it', diagnostics)
  end subroutine read_zones

  !> `ZPNT name CORNER|MATTER|ON|AT ...`
  subroutine read_points(deck, draft, points, sound, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(names_t), intent(inout) :: points
    logical, intent(inout) :: sound
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(zone_mark_t) :: marks(count_cards(deck, 'ZPNT'))
    character(len=:), allocatable :: word
    integer :: i, n

    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'ZPNT') cycle
      n = n + 1
      call cursor%open(deck%cards(i), diagnostics)
      call points%define(cursor, 'the name of the point', 'ZPNT', n, diagnostics, word)
      marks(n)%name = word
      call read_form(cursor, draft, marks(n))
      call close_card(draft, cursor, deck%cards(i))
      sound = sound .and. .not. cursor%failed()
    end do
    allocate (draft%scene%remesher%marks, source=marks)
  end subroutine read_points

  subroutine read_form(cursor, draft, mark)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(zone_mark_t), intent(inout) :: mark
    type(string_t), allocatable :: forms(:)

    call words_of('CORNER MATTER ON AT', forms)
    call cursor%name('what the point is', forms, mark%form)
    select case (mark%form)
    case (mark_crossing)
      call read_line(cursor, mark)
      call read_options(cursor, draft, 'DIE', mark)
    case (mark_matter)
      call read_xy(cursor, 'the point', mark%x)
      mark%by_matter = .true.
    case (mark_inside)
      call read_xy(cursor, 'the point', mark%x)
      call read_options(cursor, draft, 'MATTER DIE FIXED', mark)
    case default
      call read_xy(cursor, 'the point', mark%x)
      call read_options(cursor, draft, 'MATTER DIE', mark)
    end select
  end subroutine read_form

  !> `X value UPPER|LOWER` or `Y value LEFT|RIGHT`
  subroutine read_line(cursor, mark)
    type(cursor_t), intent(inout) :: cursor
    type(zone_mark_t), intent(inout) :: mark
    type(string_t), allocatable :: words(:)
    integer :: k

    call words_of('X Y', words)
    call cursor%name('X or Y', words, mark%axis)
    call cursor%real('where the line is', mark%x(1), unit='length')
    mark%x(2) = mark%x(1)
    if (mark%axis == 1) then
      call words_of('LOWER UPPER', words)
    else
      call words_of('LEFT RIGHT', words)
    end if
    call cursor%name('which of the places where the contour crosses it', words, k)
    mark%pick = 2*k - 3
  end subroutine read_line

  !> Words that may follow, each once; MATTER and DIE exclude each other.
  subroutine read_options(cursor, draft, known, mark)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    character(len=*), intent(in) :: known
    type(zone_mark_t), intent(inout) :: mark
    type(string_t), allocatable :: words(:)
    integer :: k

    call words_of(known, words)
    do while (cursor%more())
      call cursor%name('one of '//known, words, k)
      if (k == 0) return
      select case (words(k)%s)
      case ('MATTER')
        if (mark%by_matter) call cursor%fail('MATTER is given twice')
        mark%by_matter = .true.
      case ('FIXED')
        if (mark%stays) call cursor%fail('FIXED is given twice')
        mark%stays = .true.
      case default
        if (mark%die > 0) call cursor%fail('DIE is given twice')
        call read_rigid_die(cursor, draft, mark%die, 'MATTER')
      end select
      if (mark%by_matter .and. mark%die > 0) call cursor%fail('a point goes with the matter or with a die, not with both')
    end do
  end subroutine read_options

  !> `ZONE name body` and a row of four points.
  subroutine read_quadrilaterals(deck, draft, points, sound, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(names_t), intent(inout) :: points
    logical, intent(inout) :: sound
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(names_t) :: names
    type(zone_card_t) :: zones(count_cards(deck, 'ZONE'))
    type(location_t) :: first
    character(len=:), allocatable :: word
    integer :: i, n, g

    call names%clear()
    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'ZONE') cycle
      n = n + 1
      call cursor%open(deck%cards(i), diagnostics)
      call names%define(cursor, 'the name of the zone', 'ZONE', n, diagnostics, word)
      if (n == 1) first = cursor%where()
      zones(n)%name = word
      call read_body(cursor, draft, zones(n)%group)
      call read_corners(cursor, points, zones(n)%marks)
      if (sound) call refuse_loose_sides(cursor, draft%scene%remesher%marks, zones(:n))
      call close_card(draft, cursor, deck%cards(i))
      sound = sound .and. .not. cursor%failed()
    end do
    allocate (draft%scene%remesher%zones, source=zones)
    if (n == 0 .or. .not. sound) return
    call refuse_open_sides(draft%scene%remesher%marks, zones, names, diagnostics)
    do g = 1, size(draft%scene%groups)
      if (any(zones%group == g)) cycle
      call diagnostics%add(first, 'ZONE', 'with ZONE cards every body has its zones: expected one of the body ''' &
                           //draft%scene%groups(g)%name//''' too')
    end do
  end subroutine read_quadrilaterals

  subroutine read_body(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(out) :: group
    integer :: k, g

    group = 0
    call draft%places%find(cursor, 'the name of a body', k, not_of='DIE SIDES')
    if (k == 0) return
    if (any(draft%places%keywords(k)%s == ['SIDES', 'DIE  '])) then
      call cursor%fail(''''//draft%places%words(k)%s//''' is a '//draft%places%keywords(k)%s//', expected a body')
      return
    end if
    do g = 1, size(draft%scene%groups)
      if (draft%scene%groups(g)%name == draft%places%words(k)%s) group = g
    end do
  end subroutine read_body

  subroutine read_corners(cursor, points, marks)
    type(cursor_t), intent(inout) :: cursor
    type(names_t), intent(inout) :: points
    integer, intent(out) :: marks(4)
    integer :: i, k

    marks = 0
    call cursor%next_row('four points of ZPNT cards')
    do i = 1, 4
      call points%find(cursor, 'the name of a ZPNT', k)
      if (k == 0) return
      if (any(marks(:i - 1) == points%item(k))) call cursor%fail('the point '''//points%words(k)%s//''' is given twice')
      marks(i) = points%item(k)
    end do
  end subroutine read_corners

  !> A side belongs to one zone or to two.
  subroutine refuse_loose_sides(cursor, marks, zones)
    type(cursor_t), intent(inout) :: cursor
    type(zone_mark_t), intent(in) :: marks(:)
    type(zone_card_t), intent(in) :: zones(:)
    integer :: k

    if (cursor%failed()) return
    do k = 1, 4
      associate (ends => ends_of(zones(size(zones)), k))
        if (zones_at(zones, ends) > 2) call cursor%fail('the side between '''//trim(marks(ends(1))%name)//''' and ''' &
                                                  //trim(marks(ends(2))%name)//''' is that of two other zones already')
      end associate
    end do
  end subroutine refuse_loose_sides

  !> The side of one zone is on the contour: no point inside ends it.
  subroutine refuse_open_sides(marks, zones, names, diagnostics)
    type(zone_mark_t), intent(in) :: marks(:)
    type(zone_card_t), intent(in) :: zones(:)
    type(names_t), intent(in) :: names
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: ends(2), z, k, i

    do z = 1, size(zones)
      do k = 1, 4
        ends = ends_of(zones(z), k)
        i = findloc(marks(ends)%form == mark_inside, .true., 1)
        if (i == 0 .or. zones_at(zones, ends) == 2) cycle
        call diagnostics%add(names%location(z), 'ZONE', 'no other zone has the side between ''' &
                             //trim(marks(ends(1))%name)//''' and '''//trim(marks(ends(2))%name) &
                             //''', so it is on the contour, but '''//trim(marks(ends(i))%name)//''' is a point inside (AT)')
        exit
      end do
    end do
  end subroutine refuse_open_sides

  !> Points at the ends of side k of a zone.
  pure function ends_of(zone, k) result(ends)
    type(zone_card_t), intent(in) :: zone
    integer, intent(in) :: k
    integer :: ends(2)

    ends = zone%marks([k, mod(k, 4) + 1])
  end function ends_of

  !> How many zones have a side between two points.
  pure function zones_at(zones, ends) result(n)
    type(zone_card_t), intent(in) :: zones(:)
    integer, intent(in) :: ends(2)
    integer :: n
    integer :: z, k, other(2)

    n = 0
    do z = 1, size(zones)
      do k = 1, 4
        other = ends_of(zones(z), k)
        if (all(other == ends) .or. all(other == ends([2, 1]))) n = n + 1
      end do
    end do
  end function zones_at

  pure function count_cards(deck, keyword) result(n)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: keyword
    integer :: n
    integer :: i

    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == keyword) n = n + 1
    end do
  end function count_cards

end module cards_zones
