!> Cards of a steel's kinetics: TTT, AVRAMI, LI, CCT.
module steel_kinetics_cards
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use steel_curves, only: make_table, read_curve
  use steels, only: first_diffusive, histories_t, kinetics_avrami, kinetics_none, kinetics_t, last_diffusive, phase_names, steel_t
  use temperature_curves, only: is_given
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_ttt, read_avrami, read_li, read_cct

  !> A diagram with more rows than this is an error of input.
  integer, parameter :: most_rows = 100000

contains

  !> `TTT phase ZERO|INCUB [FACTOR f] [VOLUME] [START z] [END z]`, rows `T t_start t_end [n]`, a row `LIMIT function`.
  subroutine read_ttt(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(kinetics_t) :: kinetics
    real(wp), allocatable :: t(:), start(:), finish(:), n(:)
    real(wp) :: row(4)
    integer :: phase

    call read_phase(cursor, steel, phase)
    call read_origin(cursor, kinetics, .true.)
    if (cursor%failed()) return
    kinetics%kind = kinetics_avrami
    kinetics%by_curves = .true.
    kinetics%waits = .true.
    allocate (t(0), start(0), finish(0), n(0))
    do while (cursor%more_rows())
      call cursor%next_row('temperature and times')
      if (cursor%peek_word() == 'LIMIT') then
        call read_limit(cursor, kinetics)
        cycle
      end if
      row = 1
      if (size(t) == 0) call cursor%real('the temperature', row(1), unit='degC')
      if (size(t) > 0) call cursor%real('the temperature', row(1), lower=t(size(t)), strict_lower=.true., unit='degC')
      call cursor%real('the time of the start', row(2), lower=0.0_wp, strict_lower=.true., unit='s')
      call cursor%real('the time of the end', row(3), lower=row(2), strict_lower=.true., unit='s')
      if (kinetics%from_incubation) call cursor%real('the exponent n', row(4), lower=0.0_wp, strict_lower=.true.)
      call cursor%end_row()
      if (cursor%failed()) return
      t = [t, row(1)]
      start = [start, row(2)]
      finish = [finish, row(3)]
      n = [n, row(4)]
    end do
    if (size(t) < 2) call cursor%fail('expected two rows of temperature and times at least')
    if (cursor%failed()) return
    call make_table(t, log(start), kinetics%start)
    call make_table(t, log(finish), kinetics%finish)
    kinetics%start%logarithmic = .true.
    kinetics%finish%logarithmic = .true.
    if (kinetics%from_incubation) call make_table(t, n, kinetics%exponent)
    kinetics%low = t(1)
    kinetics%high = t(size(t))
    steel%kinetics(phase) = kinetics
  end subroutine read_ttt

  !> `AVRAMI phase T_low T_high [ZERO|INCUB [FACTOR f] [VOLUME]]`, rows `LNB`, `N`, `START`, `LIMIT` with a function each.
  subroutine read_avrami(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(kinetics_t) :: kinetics
    type(string_t) :: words(4)
    logical :: given(4)
    integer :: phase, k

    call read_phase(cursor, steel, phase)
    call cursor%real('the lowest temperature at which it forms', kinetics%low, unit='degC')
    call cursor%real('the highest temperature at which it forms', kinetics%high, lower=kinetics%low, strict_lower=.true., &
                     unit='degC')
    if (cursor%more()) call read_origin(cursor, kinetics, .false.)
    kinetics%kind = kinetics_avrami
    words(1)%s = 'LNB'
    words(2)%s = 'N'
    words(3)%s = 'START'
    words(4)%s = 'LIMIT'
    given = .false.
    do while (cursor%more_rows())
      call cursor%next_row('LNB, N, START or LIMIT and a function')
      if (cursor%peek_word() == 'LIMIT') then
        call read_limit(cursor, kinetics)
        cycle
      end if
      call cursor%name('LNB, N, START or LIMIT', words, k)
      if (k == 0) return
      if (given(k)) call cursor%fail(words(k)%s//' is given twice')
      given(k) = .true.
      if (k == 1) call read_curve(cursor, 'LNB, the logarithm of b', kinetics%log_rate)
      if (k == 2) call read_curve(cursor, 'the exponent N', kinetics%exponent)
      if (k == 3) call read_curve(cursor, 'START, the time of incubation (s)', kinetics%start, positive=.true.)
    end do
    if (.not. given(1)) call cursor%fail('expected a row LNB, found none')
    if (.not. given(2)) call cursor%fail('expected a row N, found none')
    if (given(3) .neqv. kinetics%waits) call cursor%fail('a row START goes with ZERO or INCUB on the card, and they with it')
    if (.not. cursor%failed()) steel%kinetics(phase) = kinetics
  end subroutine read_avrami

  !> A phase that forms by diffusion, once.
  subroutine read_phase(cursor, steel, phase)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(in) :: steel
    integer, intent(out) :: phase
    type(string_t) :: words(last_diffusive - first_diffusive + 1)
    integer :: i

    do i = 1, size(words)
      words(i)%s = trim(phase_names(first_diffusive + i - 1))
    end do
    call cursor%name('a phase that forms by diffusion', words, i)
    phase = first_diffusive + max(i, 1) - 1
    if (cursor%failed()) return
    if (steel%kinetics(phase)%kind /= kinetics_none) call cursor%fail('the kinetics of '//words(i)%s//' are given twice')
  end subroutine read_phase

  !> `ZERO` or `INCUB`, `FACTOR f`, `VOLUME`, and of curves `START z`, `END z`.
  subroutine read_origin(cursor, kinetics, curves)
    type(cursor_t), intent(inout) :: cursor
    type(kinetics_t), intent(inout) :: kinetics
    logical, intent(in) :: curves
    type(string_t) :: origins(2), options(4)
    integer :: k

    origins(1)%s = 'ZERO'
    origins(2)%s = 'INCUB'
    call cursor%name('ZERO or INCUB, from where Avrami''s time counts', origins, k)
    kinetics%from_incubation = k == 2
    kinetics%waits = .true.
    options(1)%s = 'FACTOR'
    options(2)%s = 'VOLUME'
    options(3)%s = 'START'
    options(4)%s = 'END'
    do while (cursor%more())
      call cursor%name('an option', options(:merge(4, 2, curves)), k)
      select case (k)
      case (1)
        call cursor%real('the factor of germination', kinetics%factor, lower=0.0_wp, strict_lower=.true.)
      case (2)
        kinetics%start_of_volume = .true.
        if (kinetics%from_incubation) call cursor%fail('VOLUME goes with ZERO: counted from INCUB nothing forms before the start')
      case (3)
        call cursor%real('the share at the start', kinetics%start_share, lower=0.0_wp, upper=1.0_wp, strict_lower=.true., &
                         strict_upper=.true.)
      case (4)
        call cursor%real('the share at the end', kinetics%finish_share, lower=kinetics%start_share, upper=1.0_wp, &
                         strict_lower=.true., strict_upper=.true.)
      end select
    end do
  end subroutine read_origin

  !> `LIMIT function`.
  subroutine read_limit(cursor, kinetics)
    type(cursor_t), intent(inout) :: cursor
    type(kinetics_t), intent(inout) :: kinetics
    character(len=:), allocatable :: word

    call cursor%word('LIMIT', word)
    if (is_given(kinetics%limit)) call cursor%fail('LIMIT is given twice')
    call read_curve(cursor, 'LIMIT, the largest fraction', kinetics%limit)
  end subroutine read_limit

  !> `LI G`: kinetics from the composition for the phases that have no others.
  subroutine read_li(cursor, steel, chosen)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    logical, intent(out) :: chosen

    call cursor%real('G, the ASTM number of the grain', steel%grain_number, lower=-5.0_wp, upper=20.0_wp)
    chosen = .true.
  end subroutine read_li

  !> `CCT [GRAIN factor reference]`, rows `rate T ferrite pearlite bainite`, rates ascending, temperatures of a rate descending.
  subroutine read_cct(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(histories_t) :: cct
    character(len=:), allocatable :: word
    real(wp) :: rates(most_rows), log_rates(most_rows), t(most_rows), z(3, most_rows)
    integer :: first(most_rows), n, k

    if (steel%cct%n > 0) call cursor%fail('there are two CCT cards')
    if (cursor%more()) then
      call cursor%word('GRAIN', word)
      if (word /= 'GRAIN') call cursor%fail('expected GRAIN, found '''//word//'''')
      call cursor%real('the factor of the grain size', cct%grain_factor, unit='1/um')
      call cursor%real('the grain size of the diagram', cct%grain_reference, lower=0.0_wp, strict_lower=.true., unit='um')
    end if
    n = 0
    k = 0
    do while (cursor%more_rows())
      call cursor%next_row('rate, temperature and fractions')
      if (k == most_rows) call cursor%fail('a diagram has at most '//to_text(most_rows)//' rows')
      if (cursor%failed()) return
      k = k + 1
      call read_cct_row(cursor, k, n, rates, first, t, z)
      if (n > 0 .and. .not. cursor%failed()) log_rates(n) = log(rates(n))
    end do
    if (n < 2) call cursor%fail('expected rows of two cooling rates at least')
    if (cursor%failed()) return
    cct%n = n
    allocate (cct%rate, source=rates(:n))
    allocate (cct%log_rate, source=log_rates(:n))
    cct%first = [first(:n), k + 1]
    allocate (cct%t, source=t(:k))
    allocate (cct%z, source=z(:, :k))
    cct%hottest = maxval(cct%t)
    cct%coldest = minval(cct%t)
    steel%cct = cct
  end subroutine read_cct

  subroutine read_cct_row(cursor, k, n, rates, first, t, z)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: k         !! number of the row
    integer, intent(inout) :: n      !! histories so far
    real(wp), intent(inout) :: rates(:), t(:), z(:, :)   !! (n) [K/s], (k) [degC], (3, k) [-]
    integer, intent(inout) :: first(:)                   !! (n)
    character(len=8), parameter :: names(3) = ['ferrite ', 'pearlite', 'bainite ']
    real(wp) :: rate, low
    integer :: i

    low = 0
    if (n > 0) low = rates(n)
    call cursor%real('the cooling rate', rate, lower=low, strict_lower=n == 0, unit='K/s')
    if (n == 0) then
      n = 1
      first(1) = k
    else if (rate > rates(n)) then
      n = n + 1
      first(n) = k
    end if
    rates(n) = rate
    if (first(n) == k) then
      call cursor%real('the temperature', t(k), unit='degC')
    else
      call cursor%real('the temperature', t(k), upper=t(k - 1), strict_upper=.true., unit='degC')
    end if
    do i = 1, 3
      low = 0
      if (first(n) < k) low = z(i, k - 1)
      call cursor%real('the fraction of '//trim(names(i)), z(i, k), lower=low, upper=1.0_wp)
    end do
    ! sums of rounded shares may exceed 1 by a rounding of the third decimal
    if (sum(z(:, k)) > 1.0005_wp) call cursor%fail('the fractions add up to more than 1')
    call cursor%end_row()
  end subroutine read_cct_row

end module steel_kinetics_cards
