!> The solver: arguments -> run -> exit code.
program lagamine
  use, intrinsic :: iso_fortran_env, only: error_unit
  use errors, only: error_t, exit_done
  use point_run, only: run_point
  use run_deck, only: print_law, run_options_on_deck
  use run_options, only: read_options, run_options_t, usage_text
  use run_version, only: version_text
  use system, only: program_stop
  implicit none
  type(run_options_t) :: options
  type(error_t), allocatable :: error
  integer :: code

  code = exit_done
  call read_options(options, error)
  if (allocated(error)) then
    code = error%code
  else if (options%help) then
    write (*, '(a)') usage_text()
  else if (options%version) then
    write (*, '(a)') 'lagamine '//version_text
  else if (allocated(options%law)) then
    call print_law(options%law, error)
  else if (options%point) then
    call run_point(options, error)
  else
    call run_options_on_deck(options, code, error)
  end if
  if (allocated(error)) then
    code = error%code
    write (error_unit, '(a)') error%message
    if (allocated(error%advice)) write (error_unit, '(a)') error%advice
  end if
  call program_stop(code)
end program lagamine
