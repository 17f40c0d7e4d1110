!> GOLDAK: the heat of a welding torch (weld_sources).
module cards_weld
  use card_groups, only: append_group, start_group
  use cards_heat, only: read_heated_body, read_multiplier
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use fields, only: find_field
  use kinds, only: wp
  use quadrature, only: rule_gauss, rule_t
  use scene, only: axisymmetric, group_t
  use scene_draft, only: close_card, draft_t, next_of_words, words_of
  use text, only: string_t, to_text
  use vectors, only: length_of
  use weld_sources, only: has_front, weld_source_t
  implicit none
  private
  public :: read_torches

contains

  !> All cards `GOLDAK body [body ...] P power [lic] ETA efficiency FRONT c REAR c [WIDTH a] DEPTH b INTO x y [CROSS speed time]`;
  !> rows after them: time, x and y of the centre.
  subroutine read_torches(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(group_t), allocatable :: bodies(:)
    type(weld_source_t) :: source
    type(string_t), allocatable :: words(:)
    integer :: i, k

    allocate (draft%scene%sources(0))
    call words_of('P ETA FRONT REAR WIDTH DEPTH INTO CROSS', words)
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'GOLDAK') cycle
      call cursor%open(deck%cards(i), diagnostics)
      source = weld_source_t()
      source%where_defined = diagnostics%place(cursor%where())
      call read_bodies(cursor, draft, words, bodies)
      call read_words(cursor, draft, words, source)
      call read_path(cursor, source)
      if (.not. cursor%failed()) call judge(cursor, draft, source)
      call close_card(draft, cursor, deck%cards(i))
      if (cursor%failed()) then
        draft%groups_sound = .false.
        cycle
      end if
      draft%scene%sources = [draft%scene%sources, source]
      do k = 1, size(bodies)
        bodies(k)%source = size(draft%scene%sources)
        if (bodies(k)%source > 1) bodies(k)%name = bodies(k)%name//to_text(bodies(k)%source)
        call append_group(draft, bodies(k), cursor%where())
      end do
    end do
  end subroutine read_torches

  !> The bodies that are heated, at least one, each once.
  subroutine read_bodies(cursor, draft, words, bodies)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(string_t), intent(in) :: words(:)                !! (nword) of the card
    type(group_t), allocatable, intent(out) :: bodies(:)  !! (nbody)
    type(group_t) :: group
    character(len=:), allocatable :: label
    integer :: f, k

    allocate (bodies(0))
    f = 0
    if (draft%groups_sound) f = find_field(draft%scene%fields, 'temperature')
    do
      call start_group('GOLDAK', draft, group)
      call read_heated_body(cursor, draft, f, label, group)
      if (cursor%failed()) return
      if (draft%groups_sound .and. f == 0) call cursor%fail('no body of this scene has a temperature among its unknowns (PL8TM)')
      group%rule = rule_t(rule_gauss, 9)
      group%name = label//'/GOLDAK'
      do k = 1, size(bodies)
        if (bodies(k)%name == group%name) call cursor%fail('body '''//label//''' is named twice')
      end do
      bodies = [bodies, group]
      if (.not. cursor%more()) return
      do k = 1, size(words)
        if (cursor%peek_word() == words(k)%s) return
      end do
    end do
  end subroutine read_bodies

  !> Words with their numbers, each once, in any order.
  subroutine read_words(cursor, draft, words, source)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(string_t), intent(in) :: words(:)
    type(weld_source_t), intent(inout) :: source
    logical :: given(size(words)), wanted
    integer :: k

    given = .false.
    do while (cursor%more())
      call next_of_words(cursor, words, given, k)
      if (k == 0) return
      select case (words(k)%s)
      case ('P')
        call cursor%real('the power of the torch', source%power, lower=0.0_wp, unit='power')
        call read_multiplier(cursor, draft, words, source%multiplier)
        if (source%multiplier > 0) then
          if (minval(draft%scene%multipliers(source%multiplier)%value) < 0) &
            call cursor%fail('the LIC of a power must not be negative')
        end if
      case ('ETA')
        call cursor%real('the share of the power that the bodies take', source%efficiency, lower=0.0_wp, strict_lower=.true., &
                         upper=1.0_wp, unit='-')
      case ('FRONT')
        call read_axis('the semi-axis ahead of the centre', source%front)
      case ('REAR')
        call read_axis('the semi-axis behind the centre', source%rear)
      case ('WIDTH')
        call read_axis('the semi-axis across the travel', source%width)
      case ('DEPTH')
        call read_axis('the semi-axis into the body', source%depth)
      case ('INTO')
        call cursor%real('x of the direction into the body', source%into(1), unit='-')
        call cursor%real('y of the direction into the body', source%into(2), unit='-')
        if (.not. cursor%failed()) then
          if (length_of(source%into) > 0) then
            source%into = source%into/length_of(source%into)
          else
            call cursor%fail('the direction into the body must not be 0 0')
          end if
        end if
      case ('CROSS')
        source%crosses = .true.
        call cursor%real('the speed of the torch across the plane', source%speed, lower=0.0_wp, strict_lower=.true., &
                         unit='length/time')
        call cursor%real('the time when its centre is in the plane', source%crossing_time, unit='time')
      end select
      if (cursor%failed()) return
    end do
    do k = 1, size(words)
      wanted = words(k)%s /= 'CROSS' .and. (words(k)%s /= 'WIDTH' .or. source%crosses)
      if (wanted .and. .not. given(k)) call cursor%fail('expected '//words(k)%s//' and its number, found none')
    end do
    if (source%width > 0 .and. .not. source%crosses) &
      call cursor%fail('WIDTH is of a torch that crosses the plane (CROSS); one that stays in it is as wide as the section')

  contains

    subroutine read_axis(what, axis)
      character(len=*), intent(in) :: what
      real(wp), intent(out) :: axis

      call cursor%real(what, axis, lower=0.0_wp, strict_lower=.true., unit='length')
    end subroutine read_axis

  end subroutine read_words

  !> Rows of a time, ascending, and the place of the centre.
  subroutine read_path(cursor, source)
    type(cursor_t), intent(inout) :: cursor
    type(weld_source_t), intent(inout) :: source
    real(wp), allocatable :: path(:, :), longer(:, :)
    real(wp) :: row(3)
    integer :: n

    n = 0
    allocate (path(3, 16))
    do while ((cursor%more_rows() .or. n == 0) .and. .not. cursor%failed())
      call cursor%next_row('a time, and x and y of the centre of the source')
      if (n == 0) then
        call cursor%real('a time', row(1), unit='time')
      else
        call cursor%real('a time after the one before', row(1), lower=path(1, n), strict_lower=.true., unit='time')
      end if
      call cursor%real('x of the centre', row(2), unit='length')
      call cursor%real('y of the centre', row(3), unit='length')
      call cursor%end_row()
      if (n == size(path, 2)) then
        allocate (longer(3, 2*n))
        longer(:, :n) = path
        call move_alloc(longer, path)
      end if
      n = n + 1
      path(:, n) = row
    end do
    source%path = path(:, :n)
  end subroutine read_path

  !> What words and path must have in common.
  subroutine judge(cursor, draft, source)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(weld_source_t), intent(in) :: source

    if (source%crosses) then
      if (draft%scene%plane_state == axisymmetric) &
        call cursor%fail('no torch crosses an axisymmetric plane: there the source is a whole ring (no CROSS)')
    else if (abs(source%front - source%rear) > 0 .and. .not. has_front(source)) then
      call cursor%fail('the source does not move along the surface: which side is ahead is not known, FRONT and REAR must be equal')
    end if
  end subroutine judge

end module cards_weld
