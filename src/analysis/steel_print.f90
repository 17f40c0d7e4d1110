!> `lagamine --met FILE`: the steels of a file as tables on the screen and in CSV files.
!>
!> Of each steel NAME: its temperatures, the isothermal diagram (`NAME.ttt.PHASE.csv`), mixtures and hardness after cooling at
!> constant rates (`NAME.cct.csv`), martensite after tempering (`NAME.temper.csv`, `steel_temper_print`), and what diagrams are
!> drawn from (`NAME.steel.json`, `steel_diagrams`).
module steel_print
  use csv_writer, only: csv_t
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use hardness, only: has_hardness
  use hardness_check, only: words_of_range
  use kinetics_check, only: words_of_li
  use steel_numbers, only: words_of_numbers
  use steel_temperatures, only: words_of_temperatures
  use kinds, only: wp
  use phase_state, only: at_hardness, state_size
  use run_options, only: run_options_t, stem_of
  use standard_streams, only: print_line, print_lines
  use steel_diagrams, only: write_diagrams
  use steel_reader, only: read_steels
  use steel_temper_print, only: print_tempering
  use steel_tables, only: cool_at_rate, isothermal_rows
  use steels, only: element_names, expansion_incremental, expansion_total, first_diffusive, last_diffusive, phase_count, &
                    phase_names, plasticity_names, plasticity_none, prop_alpha, prop_memory, prop_modulus, prop_plasticity, &
                    prop_poisson, prop_rise, prop_saturation, prop_strain, prop_yield, prop_young, property_names, steel_t, &
                    unknown_temperature
  use temperature_curves, only: curve_at, is_given
  use system, only: join_path, make_directory
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: print_steels

  !> Shares of the isothermal diagram; width of its rows [degC]; cooling rates [K/s]; ends of the coolings, and
  !> where numbers of mechanics are shown [degC].
  real(wp), parameter :: shares(3) = [0.01_wp, 0.5_wp, 0.99_wp], row_width = 20.0_wp, file_width = 5.0_wp
  real(wp), parameter :: rates(14) = [0.01_wp, 0.02_wp, 0.05_wp, 0.1_wp, 0.2_wp, 0.5_wp, 1.0_wp, 2.0_wp, 5.0_wp, 10.0_wp, &
                                      20.0_wp, 50.0_wp, 100.0_wp, 200.0_wp]
  real(wp), parameter :: mechanics_at(3) = [20.0_wp, 400.0_wp, 800.0_wp]
  real(wp), parameter :: least_start = 900.0_wp, finish = 20.0_wp

contains

  !> Read the file, print its steels, write their tables into the folder of the results.
  subroutine print_steels(options, error)
    type(run_options_t), intent(in) :: options
    type(error_t), allocatable, intent(out) :: error
    type(diagnostics_t), target :: diagnostics
    type(steel_t), allocatable :: steels(:)
    type(string_t), allocatable :: lines(:)
    character(len=:), allocatable :: stem
    integer :: k

    call read_steels(options%met, options%overrides, steels, diagnostics)
    call diagnostics%error(error)
    if (allocated(error)) return
    if (.not. options%check) call make_directory(options%out, error)
    do k = 1, size(steels)
      if (allocated(error)) return
      stem = join_path(options%out, stem_of(steels(k)%name//'.met'))
      call head_lines(steels(k), lines)
      if (.not. options%quiet) call print_lines(lines, error)
      call mechanics_lines(steels(k), lines)
      if (.not. (options%quiet .or. allocated(error))) call print_lines(lines, error)
      if (.not. allocated(error)) call print_isothermal(steels(k), options, stem, error)
      if (.not. allocated(error)) call print_coolings(steels(k), options, stem, error)
      if (.not. allocated(error)) call print_tempering(steels(k), options, stem, error)
      if (.not. (allocated(error) .or. options%check)) call write_diagrams(steels(k), stem//'.steel.json', error)
      if (.not. (allocated(error) .or. options%quiet)) call print_line('', error)
    end do
  end subroutine print_steels

  !> Name, source, composition, temperatures, numbers of martensite.
  subroutine head_lines(steel, lines)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    character(len=:), allocatable :: s
    integer :: i

    allocate (lines(0))
    call add_text(lines, 'steel '//steel%name)
    call add_text(lines, 'source: '//steel%source)
    if (steel%composition%given) then
      s = 'mass per cent:'
      do i = 1, size(element_names)
        if (steel%composition%w(i) > 0) s = s//' '//trim(element_names(i))//' '//to_text(steel%composition%w(i))
      end do
      call add_text(lines, s)
    end if
    s = 'degC:'
    call add_temperature('Ae1', steel%ae1)
    call add_temperature('Ae3', steel%ae3)
    call add_temperature('Ac1', steel%ac1)
    call add_temperature('Ac3', steel%ac3)
    call add_temperature('Bs', steel%bs)
    call add_temperature('Ms', steel%ms)
    if (s /= 'degC:') call add_text(lines, s)
    if (steel%beta > 0) call add_text(lines, 'martensite: 1 - exp(-'//to_text(steel%beta)//' (Ms - T))')
    s = words_of_li(steel)
    if (s /= '') call add_text(lines, 'WARNING: '//s)
    s = words_of_temperatures(steel)
    if (s /= '') call add_text(lines, 'WARNING: '//s)
    s = words_of_numbers(steel)
    if (s /= '') call add_text(lines, 'WARNING: '//s)
    s = words_of_range(steel)
    if (s /= '') call add_text(lines, 'WARNING: '//s)

  contains

    subroutine add_temperature(name, value)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: value

      if (value > unknown_temperature) s = s//'  '//name//' '//to_text(value, 5)
    end subroutine add_temperature

  end subroutine head_lines

  !> Forms of strains and transformation plasticity, and the numbers of each phase at a few temperatures; no line where there are
  !> none.
  subroutine mechanics_lines(steel, lines)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    integer, parameter :: shown(10) = [prop_young, prop_poisson, prop_alpha, prop_strain, prop_yield, prop_modulus, prop_rise, &
                                       prop_saturation, prop_plasticity, prop_memory]
    character(len=130) :: line
    integer :: i, j, k

    allocate (lines(0))
    select case (steel%expansion)
    case (expansion_total)
      call add_text(lines, 'strains by temperature and phases: total form from '//to_text(steel%reference)//' degC')
    case (expansion_incremental)
      call add_text(lines, 'strains by temperature and phases: incremental form')
    end select
    if (steel%plasticity /= plasticity_none) &
      call add_text(lines, 'transformation plasticity: '//trim(plasticity_names(steel%plasticity)))
    if (.not. any(is_given(steel%properties(shown, :)))) return
    write (line, '(a10, a6, 10(1x, a10))') 'phase     ', 'degC', (adjustr(property_names(shown(j))), j=1, size(shown))
    call add_text(lines, trim(line))
    do i = 1, phase_count
      if (.not. any(is_given(steel%properties(shown, i)))) cycle
      do k = 1, size(mechanics_at)
        write (line, '(a10, f6.0)') lower(i), mechanics_at(k)
        do j = 1, size(shown)
          associate (curve => steel%properties(shown(j), i))
            if (is_given(curve)) write (line(6 + 11*j:16 + 11*j), '(1x, g10.4)') curve_at(curve, mechanics_at(k))
          end associate
        end do
        call add_text(lines, trim(line))
      end do
    end do
  end subroutine mechanics_lines

  !> The isothermal diagram of each phase that has one.
  subroutine print_isothermal(steel, options, stem, error)
    type(steel_t), intent(in) :: steel
    type(run_options_t), intent(in) :: options
    character(len=*), intent(in) :: stem
    type(error_t), allocatable, intent(out) :: error
    type(csv_t) :: table
    type(string_t) :: columns(1 + size(shares))
    character(len=90) :: line
    real(wp), allocatable :: t(:), times(:, :)
    integer :: phase, k, i, far

    columns(1)%s = 'temperature [degC]'
    do i = 1, size(shares)
      columns(1 + i)%s = 'time_of_'//to_text(100*shares(i))//'_pct [s]'
    end do
    do phase = first_diffusive, last_diffusive
      call isothermal_rows(steel, phase, file_width, shares, t, times)
      if (size(t) == 0) cycle
      if (.not. options%quiet) call print_line(lower(phase)//': seconds to 1, 50, 99 % of what can form', error)
      if (.not. options%check) call table%create(stem//'.ttt.'//lower(phase)//'.csv', columns, error)
      do k = 1, size(t)
        if (allocated(error)) return
        write (line, '(f8.1, 3es14.5)') t(k), times(:, k)
        far = nint((steel%kinetics(phase)%high - t(k))/file_width)
        if (mod(far, nint(row_width/file_width)) == 0 .and. .not. options%quiet) call print_line(trim(line), error)
        if (options%check) cycle
        call table%put(t(k))
        call table%put(times(:, k))
        call table%end_row()
      end do
      if (.not. (options%check .or. allocated(error))) call table%close(error)
    end do
  end subroutine print_isothermal

  !> Mixtures and hardness after cooling at constant rates.
  subroutine print_coolings(steel, options, stem, error)
    type(steel_t), intent(in) :: steel
    type(run_options_t), intent(in) :: options
    character(len=*), intent(in) :: stem
    type(error_t), allocatable, intent(out) :: error
    type(csv_t) :: table
    type(string_t) :: columns(3 + phase_count)
    character(len=120) :: line
    real(wp) :: state(state_size), begin, start
    integer :: k, i

    columns(1)%s = 'rate [K/s]'
    columns(2)%s = 'begin [degC]'
    do i = 1, phase_count
      columns(2 + i)%s = lower(i)//' [-]'
    end do
    columns(3 + phase_count)%s = 'hardness [HV]'
    if (size(steel%nodes) == 0) return   ! nothing changes at any temperature
    start = max(least_start, steel%data_end)
    if (.not. options%quiet) then
      call print_line('cooled from '//to_text(start, 5)//' to '//to_text(finish)//' degC', error)
      write (line, '(a, 6(1x, a10), a)') '     K/s  1 % at', (lower(i)//repeat(' ', 10 - len(lower(i))), i=1, phase_count), '   HV'
      call print_line(trim(line), error)
    end if
    if (.not. (options%check .or. allocated(error))) call table%create(stem//'.cct.csv', columns, error)
    do k = 1, size(rates)
      if (allocated(error)) return
      call cool_at_rate(steel, rates(k), start, finish, state, begin)
      write (line, '(f8.2, f8.1, 6f11.4, f6.0)') rates(k), begin, state(:phase_count), state(at_hardness)
      if (.not. has_hardness(steel)) line(83:) = ''
      if (.not. options%quiet) call print_line(trim(line), error)
      if (options%check) cycle
      call table%put(rates(k))
      call table%put(begin)
      call table%put(state(:phase_count))
      call table%put(state(at_hardness))
      call table%end_row()
    end do
    if (.not. (options%check .or. allocated(error))) call table%close(error)
  end subroutine print_coolings

  !> Name of a phase in small letters.
  pure function lower(phase) result(s)
    integer, intent(in) :: phase
    character(len=:), allocatable :: s
    integer :: i

    s = trim(phase_names(phase))
    do i = 1, len(s)
      s(i:i) = achar(iachar(s(i:i)) + 32)
    end do
  end function lower

end module steel_print
