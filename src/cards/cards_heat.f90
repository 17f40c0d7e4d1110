!> FLUX, CONVE, RADIA and HEATS: heat that passes sides of bodies or faces of sheets, or comes from volumes; THETA: its balance
!> in time.
module cards_heat
  use card_groups, only: close_group, refuse_second, start_group
  use card_places, only: numbers_after_name, read_sides
  use cards_sides, only: refuse_inner_sides
  use deck_card, only: deck_field_t
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use field_places, only: refuse_without_field
  use fields, only: find_field
  use kinds, only: wp
  use loads, only: by_convection, by_flux, by_radiation, exchange_t
  use quadrature, only: rule_gauss, rule_t
  use scene, only: group_t, is_solid, plane_state_names, plane_stress
  use scene_draft, only: close_card, draft_t, next_of_words, only_card, words_of
  use strategy, only: coupling_monolithic, scheme_theta, scheme_tr_bdf2
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: read_exchanges, read_heated_body, read_multiplier, read_time_scheme

  !> Gauss points of a side.
  integer, parameter :: npoint = 3

contains

  !> All cards `FLUX place Q q [lic]`, `CONVE place H h [lic] TS temperature [lic]` and
  !> `RADIA place EPS emissivity SIGMA constant ZERO temperature TS temperature [lic]`; rows after them: pairs of a temperature of
  !> the surface and a factor. `HEATS body Q q [lic]` likewise. In plane stress the place may be `body FACES 1 2`.
  subroutine read_exchanges(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(group_t) :: group
    character(len=:), allocatable :: label
    logical :: on_faces
    integer :: i, f

    do i = 1, size(deck%cards)
      associate (keyword => deck%cards(i)%keyword)
        if (all(keyword /= [character(len=5) :: 'FLUX', 'CONVE', 'RADIA', 'HEATS'])) cycle
        call cursor%open(deck%cards(i), diagnostics)
        on_faces = keyword /= 'HEATS' .and. is_faces(deck%cards(i)%head%fields)
        if (on_faces) then
          call start_group('FACES', draft, group)
        else
          call start_group(keyword, draft, group)
        end if
        group%rule = rule_t(rule_gauss, npoint)
        f = 0
        if (draft%groups_sound) f = find_field(draft%scene%fields, 'temperature')
        if (keyword == 'HEATS' .or. on_faces) then
          call read_heated_body(cursor, draft, f, label, group)
          if (on_faces) call read_faces(cursor, draft, label, group%exchange%faces)
        else
          call read_sides(cursor, draft, numbers_after_name(deck%cards(i)), label, group%connectivity, field=f)
          call refuse_inner_sides(cursor, draft, group%connectivity)
        end if
        if (draft%groups_sound .and. f == 0) call cursor%fail('no body of this scene has a temperature among its unknowns (PL8TM)')
        call read_numbers(cursor, draft, keyword, group%exchange)
        call read_table(cursor, keyword, group%exchange)
        group%name = label//'/'//keyword
        call refuse_second(cursor, draft, group, 'this', diagnostics)
      end associate
      call close_group(draft, cursor, deck%cards(i), group)
    end do
  end subroutine read_exchanges

  !> A place that is the faces of a sheet: `body FACES`.
  pure function is_faces(fields) result(yes)
    type(deck_field_t), intent(in) :: fields(:)   !! (nfield) behind the keyword
    logical :: yes

    yes = size(fields) > 1
    if (yes) yes = fields(2)%text == 'FACES'
  end function is_faces

  !> `FACES 1 2`: the faces of a sheet that pass heat, one or both of them.
  subroutine read_faces(cursor, draft, label, faces)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    character(len=:), allocatable, intent(inout) :: label
    logical, intent(inout) :: faces(2)
    type(string_t), allocatable :: words(:)
    integer :: k

    if (cursor%failed()) return
    call words_of('FACES', words)
    call cursor%name('FACES', words, k)
    do while (cursor%next_is_number() .or. .not. any(faces))
      call cursor%integer('a face of the sheet, 1 or 2', k, lower=1, upper=2)
      if (cursor%failed()) return
      if (faces(k)) call cursor%fail('face '//to_text(k)//' is given twice')
      label = label//trim(merge('+    ', '.face', any(faces)))//to_text(k)
      faces(k) = .true.
    end do
    if (all(draft%scene%plane_state /= [0, plane_stress])) &
      call cursor%fail('FACES are those of a sheet, STATE PLSTS: in '//trim(plane_state_names(draft%scene%plane_state)) &
                       //' a body has no faces')
  end subroutine read_faces

  !> The body whose elements release heat, or pass it through their faces.
  subroutine read_heated_body(cursor, draft, field, label, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: field   !! the temperature, 0 where the scene has none
    character(len=:), allocatable, intent(out) :: label
    type(group_t), intent(inout) :: group
    integer :: k, g

    label = ''
    allocate (group%connectivity(8, 0))
    call draft%places%find(cursor, 'the name of a body', k, not_of='DIE SIDES')
    if (k == 0) return
    label = draft%places%words(k)%s
    do g = 1, size(draft%scene%groups)
      if (.not. is_solid(draft%scene%groups(g)) .or. draft%scene%groups(g)%name /= label) cycle
      group%host = g
      group%rule = draft%scene%groups(g)%rule
      group%connectivity = draft%scene%groups(g)%connectivity
    end do
    if (.not. draft%mesh_sound) return
    if (group%host == 0) then
      call cursor%fail(''''//label//''' is a '//draft%places%keywords(k)%s//', expected a body')
    else if (field > 0) then
      call refuse_without_field(cursor, draft, field, [group%connectivity], label, own=.true.)
    end if
  end subroutine read_heated_body

  !> Words with their numbers, each once, in any order.
  subroutine read_numbers(cursor, draft, keyword, exchange)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    character(len=*), intent(in) :: keyword
    type(exchange_t), intent(inout) :: exchange
    type(string_t), allocatable :: words(:)
    logical, allocatable :: given(:)
    real(wp) :: emissivity, constant
    integer :: k

    select case (keyword)
    case ('FLUX', 'HEATS')
      exchange%kind = by_flux
      call words_of('Q', words)
    case ('CONVE')
      exchange%kind = by_convection
      call words_of('H TS', words)
    case default
      exchange%kind = by_radiation
      call words_of('EPS SIGMA ZERO TS', words)
    end select
    allocate (given(size(words)), source=.false.)
    emissivity = 0
    constant = 0
    do while (cursor%more())
      call next_of_words(cursor, words, given, k)
      if (k == 0) return
      select case (words(k)%s)
      case ('Q')
        if (keyword == 'FLUX') then
          call cursor%real('the heat flow per area, into the body', exchange%amplitude, unit='power/area')
        else
          call cursor%real('the heat released per volume', exchange%amplitude, unit='power/volume')
        end if
        call read_multiplier(cursor, draft, words, exchange%multiplier)
      case ('H')
        call cursor%real('the coefficient of convection', exchange%amplitude, lower=0.0_wp, unit='power/area/temperature')
        call read_multiplier(cursor, draft, words, exchange%multiplier)
      case ('EPS')
        call cursor%real('the emissivity', emissivity, lower=0.0_wp, upper=1.0_wp, unit='-')
      case ('SIGMA')
        call cursor%real('the constant of Stefan and Boltzmann', constant, lower=0.0_wp, strict_lower=.true., &
                         unit='power/area/temperature^4')
      case ('ZERO')
        call cursor%real('the temperature to add to make one absolute', exchange%zero, lower=0.0_wp, unit='temperature')
      case ('TS')
        call cursor%real('the temperature of the surroundings', exchange%surroundings, unit='temperature')
        call read_multiplier(cursor, draft, words, exchange%surroundings_multiplier)
      end select
      if (cursor%failed()) return
    end do
    do k = 1, size(words)
      if (.not. given(k)) call cursor%fail('expected '//words(k)%s//' and its number, found none')
    end do
    if (keyword == 'RADIA') exchange%amplitude = emissivity*constant
    if (cursor%failed()) return
    if (keyword == 'CONVE' .and. least_value(draft, 1.0_wp, exchange%multiplier) < 0) &
      call cursor%fail('the LIC of a coefficient of convection must not be negative')
    if (keyword == 'RADIA' .and. least_value(draft, exchange%surroundings, exchange%surroundings_multiplier) < -exchange%zero) &
      call cursor%fail('the surroundings are below absolute zero, -'//to_text(exchange%zero))
  end subroutine read_numbers

  !> Least value at any time of an amplitude times a multiplier, 0 for none.
  pure function least_value(draft, amplitude, multiplier) result(least)
    type(draft_t), intent(in) :: draft
    real(wp), intent(in) :: amplitude
    integer, intent(in) :: multiplier
    real(wp) :: least

    least = amplitude
    if (multiplier > 0) least = minval(amplitude*draft%scene%multipliers(multiplier)%value)
  end function least_value

  !> The name of a LIC, where a word that is none of the card's follows; else 0.
  subroutine read_multiplier(cursor, draft, words, multiplier)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(string_t), intent(in) :: words(:)   !! (nword) of the card
    integer, intent(out) :: multiplier
    integer :: k

    multiplier = 0
    if (.not. cursor%more()) return
    do k = 1, size(words)
      if (cursor%peek_name() == words(k)%s) return
    end do
    call draft%multipliers%find(cursor, 'the name of a LIC', k)
    if (k > 0) multiplier = draft%multipliers%item(k)
  end subroutine read_multiplier

  !> Rows of pairs of a temperature, ascending, and a factor: below 0 of a flow only.
  subroutine read_table(cursor, keyword, exchange)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: keyword
    type(exchange_t), intent(inout) :: exchange
    real(wp), allocatable :: points(:), longer(:)
    real(wp) :: pair(2)
    integer :: n

    n = 0
    allocate (points(16))
    do while (cursor%more_rows() .and. .not. cursor%failed())
      call cursor%next_row('pairs of a temperature of the surface and a factor')
      do while (cursor%more() .and. .not. cursor%failed())
        if (n == 0) then
          call cursor%real('a temperature of the surface', pair(1), unit='temperature')
        else
          call cursor%real('a temperature above the one before', pair(1), lower=points(n - 1), strict_lower=.true., &
                           unit='temperature')
        end if
        if (any(keyword == ['CONVE', 'RADIA'])) then
          call cursor%real('the factor there', pair(2), lower=0.0_wp, unit='-')
        else
          call cursor%real('the factor there', pair(2), unit='-')
        end if
        if (n + 2 > size(points)) then
          allocate (longer(2*size(points)))
          longer(:n) = points(:n)
          call move_alloc(longer, points)
        end if
        points(n + 1:n + 2) = pair
        n = n + 2
      end do
    end do
    if (n > 0) exchange%table = reshape(points(:n), [2, n/2])
  end subroutine read_table

  !> `THETA theta [MEAN]` or `THETA TRBDF2`: balance of heat at the share theta of each step, in the mean of its ends, or by
  !> TR-BDF2; `TOL tolerance`: steps by their error, with theta = 1 or TR-BDF2.
  subroutine read_time_scheme(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: words(:)
    integer :: card, f, k

    call only_card(deck, 'THETA', diagnostics, card)
    if (card == 0) return
    call cursor%open(deck%cards(card), diagnostics)
    associate (strategy => draft%scene%strategy)
      if (cursor%next_is_number()) then
        call cursor%real('theta, 1/2 (second order, with oscillations after a shock) to 1 (implicit Euler)', strategy%theta, &
                         lower=0.5_wp, upper=1.0_wp)
        call words_of('MEAN TOL', words)
      else
        call words_of('TRBDF2', words)
        call cursor%name('theta, or TRBDF2', words, k)
        if (k > 0) strategy%scheme = scheme_tr_bdf2
        call words_of('TOL', words)
      end if
      if (cursor%more()) then
        call cursor%name(join(words, ', ')//', or nothing', words, k)
        if (k > 0) then
          strategy%theta_mean = words(k)%s == 'MEAN'
          if (words(k)%s == 'TOL') call read_tolerance(cursor, draft)
        end if
      end if
    end associate
    if (draft%groups_sound) then
      f = find_field(draft%scene%fields, 'temperature')
      if (f > 0) f = merge(0, f, draft%scene%fields(f)%given)
      if (f == 0) call cursor%fail('no body of this scene has a temperature among its unknowns (PL8TM)')
      associate (strategy => draft%scene%strategy)
        if (strategy%scheme == scheme_tr_bdf2 .and. strategy%coupling == coupling_monolithic &
            .and. count(draft%scene%fields%declared) > 1) &
          call cursor%fail('TRBDF2 is for temperatures that are solved for alone: with SOLVE MONOLITHIC take THETA 1. TOL')
      end associate
    end if
    call close_card(draft, cursor, deck%cards(card))
  end subroutine read_time_scheme

  !> `TOL tolerance`: the largest error in time of a step.
  subroutine read_tolerance(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft

    associate (strategy => draft%scene%strategy)
      call cursor%real('the largest error in time of a step', strategy%time_tolerance, lower=0.0_wp, strict_lower=.true., &
                       unit='temperature')
      if (strategy%scheme == scheme_theta .and. strategy%theta < 1) &
        call cursor%fail('TOL is of THETA 1. or THETA TRBDF2: other theta have no estimate of their error')
    end associate
  end subroutine read_tolerance

end module cards_heat
