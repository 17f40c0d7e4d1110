!> `lagamine --met FILE`: martensite of a steel after holds at temperatures of tempering, on the screen and in `NAME.temper.csv`.
module steel_temper_print
  use csv_writer, only: csv_t
  use errors, only: error_t
  use hardness, only: has_hardness
  use kinds, only: wp
  use phase_state, only: at_hardness, at_hollomon_jaffe, state_size
  use run_options, only: run_options_t
  use standard_streams, only: print_line
  use steel_tables, only: hold_martensite
  use steels, only: steel_t, tempered, unknown_temperature
  use text, only: string_t, to_text
  implicit none
  private
  public :: print_tempering

  !> Holds [h]; first and last temperature and width of the rows [degC].
  real(wp), parameter :: hours(4) = [0.5_wp, 1.0_wp, 2.0_wp, 10.0_wp], coldest = 100.0_wp, hottest = 700.0_wp, width = 50.0_wp
  real(wp), parameter :: seconds_per_hour = 3600.0_wp

contains

  !> Nothing of a steel that is not tempered.
  subroutine print_tempering(steel, options, stem, error)
    type(steel_t), intent(in) :: steel
    type(run_options_t), intent(in) :: options
    character(len=*), intent(in) :: stem   !! of the names of files
    type(error_t), allocatable, intent(out) :: error
    type(csv_t) :: table
    type(string_t) :: columns(5)
    character(len=120) :: line
    character(len=:), allocatable :: head
    real(wp) :: state(state_size), t, top
    integer :: k, i

    if (.not. any(steel%temper_rate > 0)) return
    columns(1)%s = 'temperature [degC]'
    columns(2)%s = 'time [s]'
    columns(3)%s = 'tempered [-]'
    columns(4)%s = 'hollomon_jaffe [1e3 K]'
    columns(5)%s = 'hardness [HV]'
    head = 'martensite after'
    do i = 1, size(hours)
      head = head//' '//to_text(hours(i))
    end do
    head = head//' hours: share tempered'
    if (has_hardness(steel)) then
      call hold_martensite(steel, 0.0_wp, coldest, state)
      write (line, '(a, f0.0)') ' and HV, as quenched ', state(at_hardness)
      head = head//trim(line)
    end if
    if (.not. options%quiet) call print_line(head, error)
    if (.not. (options%check .or. allocated(error))) call table%create(stem//'.temper.csv', columns, error)
    ! no austenite forms
    top = hottest
    if (steel%ac1 > unknown_temperature) top = min(top, steel%ac1)
    do k = 0, floor((top - coldest)/width)
      if (allocated(error)) return
      t = coldest + k*width
      write (line, '(f8.1)') t
      do i = 1, size(hours)
        call hold_martensite(steel, hours(i)*seconds_per_hour, t, state)
        write (line(17*i - 8:17*i + 8), '(f9.4)') state(tempered)
        if (has_hardness(steel)) write (line(17*i + 1:17*i + 8), '(f6.0)') state(at_hardness)
        if (options%check) cycle
        call table%put(t)
        call table%put(hours(i)*seconds_per_hour)
        call table%put(state(tempered))
        call table%put(state(at_hollomon_jaffe))
        call table%put(state(at_hardness))
        call table%end_row()
      end do
      if (.not. options%quiet) call print_line(trim(line), error)
    end do
    if (.not. (options%check .or. allocated(error))) call table%close(error)
  end subroutine print_tempering

end module steel_temper_print
