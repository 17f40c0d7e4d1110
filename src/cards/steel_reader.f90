!> `.MET` files: steels, a section each from its card STEEL to the next one. Cards, rows, numbers and comments as in decks; all
!> mistakes at once. The manual (decks/README.md) has the cards.
module steel_reader
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t, of_steels, read_deck, refuse_other_kind, refuse_unknown
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use latent_heat, only: complete_latent
  use steel_build, only: check_steel, complete_from_composition, set_nodes, use_li
  use steel_data_cards, only: read_austenite, read_composition, read_grain, read_martensite, read_phase_data, read_source, &
                              read_temperatures, read_tempering
  use steel_kinetics_cards, only: read_avrami, read_cct, read_li, read_ttt
  use steel_mechanics_cards, only: read_expansion, read_transformation_plasticity, read_weight
  use steel_stress_cards, only: read_isig
  use steels, only: steel_t
  use text, only: string_t
  implicit none
  private
  public :: read_steels

  character(len=6), parameter :: keywords(19) = ['STEEL ', 'SOURCE', 'COMPO ', 'TEMPS ', 'MARTEN', 'TTT   ', 'AVRAMI', 'LI    ', &
                                                 'CCT   ', 'AUSTEN', 'GRAIN ', 'TEMPER', 'HARDN ', 'PHASE ', 'GRID  ', 'EXPAND', &
                                                 'TRIP  ', 'WEIGHT', 'ISIG  ']
  !> Cards of which a section has one at most: those of one phase are checked where they are read.
  logical, parameter :: once(19) = [.true., .true., .true., .true., .true., .false., .false., .true., .true., .true., .true., &
                                    .true., .true., .false., .true., .true., .true., .true., .true.]

contains

  !> All steels of a file.
  subroutine read_steels(path, overrides, steels, diagnostics)
    character(len=*), intent(in) :: path
    type(string_t), intent(in) :: overrides(:)              !! (noverride) NAME=VALUE
    type(steel_t), allocatable, intent(out) :: steels(:)    !! (nsteel)
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(deck_t), target :: file
    type(string_t) :: known(size(keywords))
    integer :: i, n, first, past
    logical :: refused

    call read_deck(path, overrides, file, diagnostics)
    call refuse_other_kind(file, of_steels, diagnostics, refused)
    if (refused) then
      allocate (steels(0))
      return
    end if
    do i = 1, size(keywords)
      known(i)%s = trim(keywords(i))
    end do
    call refuse_unknown(file, known, diagnostics)
    allocate (steels(count_sections(file)))
    if (size(file%cards) == 0) return
    call refuse_without_section(file, diagnostics)
    n = 0
    first = 1
    do while (first <= size(file%cards))
      past = first + 1
      do while (past <= size(file%cards))
        if (file%cards(past)%keyword == 'STEEL') exit
        past = past + 1
      end do
      if (file%cards(first)%keyword == 'STEEL') then
        n = n + 1
        call read_section(file, first, past - 1, steels(:n), diagnostics)
      end if
      first = past
    end do
  end subroutine read_steels

  pure function count_sections(file) result(n)
    type(deck_t), intent(in) :: file
    integer :: n, i

    n = 0
    do i = 1, size(file%cards)
      if (file%cards(i)%keyword == 'STEEL') n = n + 1
    end do
  end function count_sections

  !> The first card must be STEEL.
  subroutine refuse_without_section(file, diagnostics)
    type(deck_t), intent(inout), target :: file
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor

    if (file%cards(1)%keyword == 'STEEL') return
    call cursor%open(file%cards(1), diagnostics)
    call cursor%fail('expected STEEL, which begins a section, before any other card')
  end subroutine refuse_without_section

  !> Cards first to last: the last one of `steels`.
  subroutine read_section(file, first, last, steels, diagnostics)
    type(deck_t), intent(inout), target :: file
    integer, intent(in) :: first, last
    type(steel_t), intent(inout) :: steels(:)
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor, head
    type(string_t), allocatable :: problems(:)
    logical :: given(size(keywords)), li
    integer :: i, k, n, mistakes

    n = size(steels)
    associate (steel => steels(n))
      li = .false.
      given = .false.
      mistakes = diagnostics%count()
      call head%open(file%cards(first), diagnostics)
      call head%word('the name of the steel', steel%name)
      steel%where_defined = diagnostics%place(head%where())
      do k = 1, n - 1
        if (steels(k)%name == steel%name) call head%fail('the steel '''//steel%name//''' is defined twice, the first is at ' &
                                                         //steels(k)%where_defined)
      end do
      call head%end_card()
      do i = first + 1, last
        do k = 1, size(keywords)
          if (keywords(k) == file%cards(i)%keyword) exit
        end do
        if (k > size(keywords)) cycle   ! refused with the unknown ones
        call cursor%open(file%cards(i), diagnostics)
        if (given(k) .and. once(k)) call cursor%fail('given twice in the section of '''//steel%name//'''')
        given(k) = .true.
        call read_card(file%cards(i)%keyword, cursor, steel, li)
        call cursor%end_card()
      end do
      if (.not. any(given .and. keywords == 'SOURCE')) &
        call diagnostics%add(head%where(), 'STEEL', 'expected a card SOURCE, found none: numbers have a source')
      if (li .and. .not. any(given .and. keywords == 'COMPO')) &
        call diagnostics%add(head%where(), 'STEEL', 'LI needs the composition: COMPO')
      if (diagnostics%count() > mistakes) return
      call complete_from_composition(steel)
      if (li) call use_li(steel)
      call complete_latent(steel)
      call check_steel(steel, problems)
      do k = 1, size(problems)
        call diagnostics%add(head%where(), 'STEEL', problems(k)%s)
      end do
      if (size(problems) == 0) call set_nodes(steel)
    end associate
  end subroutine read_section

  subroutine read_card(keyword, cursor, steel, li)
    character(len=*), intent(in) :: keyword
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    logical, intent(inout) :: li
    type(string_t) :: word(1)
    integer :: k

    select case (keyword)
    case ('SOURCE')
      call read_source(cursor, steel)
    case ('COMPO')
      call read_composition(cursor, steel)
    case ('TEMPS')
      call read_temperatures(cursor, steel)
    case ('MARTEN')
      call read_martensite(cursor, steel)
    case ('TTT')
      call read_ttt(cursor, steel)
    case ('AVRAMI')
      call read_avrami(cursor, steel)
    case ('LI')
      call read_li(cursor, steel, li)
    case ('CCT')
      call read_cct(cursor, steel)
    case ('AUSTEN')
      call read_austenite(cursor, steel)
    case ('GRAIN')
      call read_grain(cursor, steel)
    case ('TEMPER')
      call read_tempering(cursor, steel)
    case ('HARDN')
      word(1)%s = 'MAYNIER'
      call cursor%name('MAYNIER', word, k)
      steel%maynier = .true.
    case ('PHASE')
      call read_phase_data(cursor, steel)
    case ('EXPAND')
      call read_expansion(cursor, steel)
    case ('TRIP')
      call read_transformation_plasticity(cursor, steel)
    case ('WEIGHT')
      call read_weight(cursor, steel)
    case ('ISIG')
      call read_isig(cursor, steel)
    case ('GRID')
      call cursor%real('the width of sub-steps', steel%substep, lower=0.0_wp, upper=100.0_wp, strict_lower=.true., unit='K')
    end select
  end subroutine read_card

end module steel_reader
