!> The solver: arguments -> run -> exit code.
program lagamine
  use blas, only: blas_build, blas_core_name
  use card_print, only: print_cards
  use errors, only: error_t, exit_done
  use kinds, only: wp
  use law_print, only: print_law
  use memory_limits, only: require_memory
  use point_run, only: run_point
  use run_deck, only: run_options_on_deck
  use run_options, only: read_options, run_options_t, usage_text
  use run_version, only: blas_words, print_version
  use standard_streams, only: claim_standard_streams, print_error, print_line
  use start_again, only: start_as_fits
  use steel_print, only: print_steels
  use system, only: program_stop
  use threads, only: number_of_threads, set_threads
  implicit none
  !> What any call takes at least [bytes].
  real(wp), parameter :: least_memory = 16*2.0_wp**20
  type(run_options_t) :: options
  type(error_t), allocatable :: error
  integer :: code

  code = exit_done
  call claim_standard_streams()
  call require_memory(0.0_wp, 'the program', error, address_space=least_memory)
  if (.not. allocated(error)) call read_options(options, error)
  if (allocated(error)) then
    code = error%code
  else if (options%help) then
    call print_line(usage_text(), error)
  else if (options%version) then
    call settle_libraries()
    call print_version('lagamine', blas_words(blas_build(), blas_core_name()), number_of_threads(), error)
  else if (options%cards) then
    call print_cards(error)
  else if (allocated(options%law)) then
    call print_law(options%law, error)
  else if (allocated(options%met)) then
    call print_steels(options, error)
  else if (options%point) then
    call run_point(options, error)
  else
    if (.not. options%check) call settle_libraries()
    call run_options_on_deck(options, code, error)
  end if
  if (allocated(error)) then
    code = error%code
    call print_error(error%message)
    if (allocated(error%advice)) call print_error(error%advice)
  end if
  call program_stop(code)

contains

  !> The environment the libraries want, by another start of the program where it is not so.
  subroutine settle_libraries()
    call set_threads(options%threads)
    call start_as_fits(number_of_threads(), blas_core_name())
  end subroutine settle_libraries

end program lagamine
