!> `points --point DECK`: paths of points, as `lagamine --point` runs them, with the laws of this project.
program points
  use, intrinsic :: iso_fortran_env, only: error_unit
  use errors, only: error_t, exit_done
  use point_run, only: run_point
  use run_options, only: read_options, run_options_t
  use system, only: program_stop
  implicit none
  type(run_options_t) :: options
  type(error_t), allocatable :: error

  call read_options(options, error)
  if (.not. allocated(error)) call run_point(options, error)
  if (allocated(error)) then
    write (error_unit, '(a)') error%message
    call program_stop(error%code)
  end if
  call program_stop(exit_done)
end program points
