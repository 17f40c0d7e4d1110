!> Cards of a steel's data beside its kinetics: COMPO, TEMPS, MARTEN, AUSTEN, GRAIN, TEMPER, PHASE.
module steel_data_cards
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use steel_curves, only: read_curve
  use steel_mechanics_cards, only: check_range
  use steels, only: austenite, el_c, element_names, martensite, bainite, phase_count, phase_names, prop_content, prop_rhoc, &
                    prop_strain, property_count, property_names, property_units, steel_t, unknown_temperature
  use temperature_curves, only: curve_table, is_given, temperature_curve_t
  use text, only: string_t
  implicit none
  private
  public :: read_source, read_composition, read_temperatures, read_martensite, read_austenite, read_grain, read_tempering, &
            read_phase_data

  !> No steel is colder or hotter [degC].
  real(wp), parameter :: coldest = -273.15_wp, hottest = 2000.0_wp
  !> Cast iron has 4 or 5 per cent of carbon, and no steel as much; half an alloy of iron is iron [mass per cent].
  real(wp), parameter :: most_carbon = 5.0_wp, most_alloy = 50.0_wp
  !> Carbon moves through iron at some 80 kJ/mol, what tempers steel needs that and more: less is a number in kJ/mol [J/mol].
  real(wp), parameter :: least_temper_energy = 1.0e4_wp

contains

  !> `SOURCE 'text'`, more texts on rows.
  subroutine read_source(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    character(len=:), allocatable :: line

    call cursor%word('the source of the numbers, in quotes', line)
    if (.not. allocated(steel%source)) steel%source = line
    do while (cursor%more_rows())
      call cursor%next_row('a text in quotes')
      call cursor%word('a text in quotes', line)
      steel%source = steel%source//new_line('a')//line
    end do
  end subroutine read_source

  !> `COMPO element mass_per_cent ...`.
  subroutine read_composition(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: words(size(element_names))
    logical :: given(size(element_names))
    integer :: i

    do i = 1, size(words)
      words(i)%s = trim(element_names(i))
    end do
    given = .false.
    do
      call cursor%name('an element', words, i)
      if (i == 0) return
      if (given(i)) call cursor%fail(words(i)%s//' is given twice')
      given(i) = .true.
      call cursor%real('the content of '//words(i)%s, steel%composition%w(i), lower=0.0_wp, &
                       upper=merge(most_carbon, most_alloy, i == el_c), unit='mass per cent')
      if (.not. cursor%more()) exit
    end do
    steel%composition%given = .true.
  end subroutine read_composition

  !> `TEMPS name temperature ...`.
  subroutine read_temperatures(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    character(len=3), parameter :: names(6) = ['AE1', 'AE3', 'AC1', 'AC3', 'BS ', 'MS ']
    type(string_t) :: words(size(names))
    real(wp) :: values(size(names))
    integer :: i

    do i = 1, size(words)
      words(i)%s = trim(names(i))
    end do
    values = unknown_temperature
    do
      call cursor%name('a characteristic temperature', words, i)
      if (i == 0) return
      if (values(i) > unknown_temperature) call cursor%fail(words(i)%s//' is given twice')
      call cursor%real(words(i)%s, values(i), lower=coldest, upper=hottest, strict_lower=.true., unit='degC')
      if (.not. cursor%more()) exit
    end do
    steel%ae1 = values(1)
    steel%ae3 = values(2)
    steel%ac1 = values(3)
    steel%ac3 = values(4)
    steel%bs = values(5)
    steel%ms = values(6)
  end subroutine read_temperatures

  !> `MARTEN [BETA rate] [SHIFT from slope offset] [INCREM|TOTAL]`.
  subroutine read_martensite(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: words(4)
    integer :: k
    logical :: given(4)

    words(1)%s = 'BETA'
    words(2)%s = 'SHIFT'
    words(3)%s = 'INCREM'
    words(4)%s = 'TOTAL'
    given = .false.
    do
      call cursor%name('BETA, SHIFT, INCREM or TOTAL', words, k)
      if (k == 0) return
      if (given(k)) call cursor%fail(words(k)%s//' is given twice')
      given(k) = .true.
      if (all(given(3:))) call cursor%fail('INCREM and TOTAL exclude each other')
      steel%martensite_total = given(4)
      if (k == 1) then
        call cursor%real('BETA, the rate of martensite', steel%beta, lower=0.0_wp, strict_lower=.true., unit='1/K')
      else if (k == 2) then
        call cursor%real('the fraction from which Ms moves', steel%shift_from, lower=0.0_wp, upper=1.0_wp)
        call cursor%real('the slope of Ms over the fraction', steel%shift_slope, unit='K')
        call cursor%real('the offset of Ms', steel%shift_offset, unit='K')
      end if
      if (.not. cursor%more()) exit
    end do
  end subroutine read_martensite

  !> `AUSTEN tau1 tau3`.
  subroutine read_austenite(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel

    call cursor%real('the time constant at AC1', steel%tau1, lower=0.0_wp, strict_lower=.true., unit='s')
    call cursor%real('the time constant at AC3', steel%tau3, lower=0.0_wp, strict_lower=.true., unit='s')
  end subroutine read_austenite

  !> `GRAIN size [LAMBDA lambda0 energy LIMIT limit0 energy]`.
  subroutine read_grain(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: word(1)
    integer :: k

    call cursor%real('the size of the grains of austenite at the start', steel%grain, lower=0.0_wp, unit='um')
    if (.not. cursor%more()) return
    word(1)%s = 'LAMBDA'
    call cursor%name('LAMBDA', word, k)
    call cursor%real('lambda0', steel%lambda0, lower=0.0_wp, strict_lower=.true., unit='s/um2')
    call cursor%real('the energy of lambda over R', steel%lambda_energy, lower=0.0_wp, unit='K')
    word(1)%s = 'LIMIT'
    call cursor%name('LIMIT', word, k)
    call cursor%real('the factor of the largest size', steel%limit0, lower=0.0_wp, strict_lower=.true., unit='um')
    call cursor%real('the energy of the largest size over R', steel%limit_energy, lower=0.0_wp, unit='K')
  end subroutine read_grain

  !> `TEMPER [C value]`, rows `MARTENSITE k0 Q n`, `BAINITE k0 Q n`, `HV function of P/1000`.
  subroutine read_tempering(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: words(3), c(1)
    integer :: k

    c(1)%s = 'C'
    if (cursor%more()) then
      call cursor%name('C', c, k)
      call cursor%real('the constant of Hollomon and Jaffe', steel%hollomon, lower=0.0_wp, strict_lower=.true.)
    end if
    words(1)%s = trim(phase_names(martensite))
    words(2)%s = trim(phase_names(bainite))
    words(3)%s = 'HV'
    call cursor%next_row('MARTENSITE, BAINITE or HV')
    do
      call cursor%name('MARTENSITE, BAINITE or HV', words, k)
      if (k == 0) return
      if (k == 3) then
        if (is_given(steel%tempered_hardness)) call cursor%fail('HV is given twice')
        call read_curve(cursor, 'HV of what is tempered', steel%tempered_hardness, abscissa='P, in thousands of K')
      else
        if (steel%temper_rate(k) > 0) call cursor%fail(words(k)%s//' is given twice')
        call cursor%real('the rate k0', steel%temper_rate(k), lower=0.0_wp, strict_lower=.true., unit='1/s')
        call cursor%real('the activation energy Q', steel%temper_energy(k), lower=least_temper_energy, unit='J/mol')
        call cursor%real('the exponent n', steel%temper_exponent(k), lower=0.0_wp, strict_lower=.true.)
      end if
      if (.not. cursor%more_rows()) exit
      call cursor%next_row('MARTENSITE, BAINITE or HV')
    end do
  end subroutine read_tempering

  !> `PHASE name|ALL`, rows of a property and its function.
  subroutine read_phase_data(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(temperature_curve_t) :: curve
    type(string_t) :: phases(phase_count + 1), names(property_count)
    integer :: i, k, first, last

    do i = 1, phase_count
      phases(i)%s = trim(phase_names(i))
    end do
    phases(phase_count + 1)%s = 'ALL'
    do i = 1, property_count
      names(i)%s = trim(property_names(i))
    end do
    call cursor%name('a phase, or ALL', phases, i)
    if (i == 0) return
    first = merge(1, i, i > phase_count)
    last = min(i, phase_count)
    do while (cursor%more_rows())
      call cursor%next_row('a property and its function')
      call cursor%name('a property', names, k)
      if (k == 0) return
      if (any(is_given(steel%properties(k, first:last)))) call cursor%fail(names(k)%s//' of '//phases(i)%s//' is given twice')
      call read_curve(cursor, names(k)%s//' ('//trim(property_units(k))//')', curve)
      call check_range(cursor, k, curve)
      if (k == prop_strain .and. first == austenite) call cursor%fail('DEPS is the strain from austenite to a phase: '// &
                                                                      phases(i)%s//' has none')
      if (cursor%failed()) return
      steel%properties(k, first:last) = curve
      steel%one_heat = steel%one_heat .or. (i > phase_count .and. any(k == [prop_rhoc, prop_content]))
      if (k /= prop_content) cycle
      if (curve%form == curve_table) then
        if (all(curve%v(2:) > curve%v(:size(curve%v) - 1))) cycle
      end if
      call cursor%fail('H must be a TABLE that grows with the temperature')
    end do
  end subroutine read_phase_data

end module steel_data_cards
