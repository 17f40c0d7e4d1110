!> The remesher: arguments -> new mesh and state -> exit code. With `--next`: what a cycle of solver and remesher does next.
program remdata
  use atomic, only: refuse_place
  use checkpoint_summary, only: print_about, print_schema
  use cost_file, only: add_remesher
  use cycle_answer, only: answer_next
  use cycle_options, only: asks_for_next
  use cycle_processes, only: asks_for_lock, asks_for_start, lock_cycle, start_program
  use errors, only: error_t, exit_done
  use kinds, only: wp
  use remesh_facts, only: remesh_facts_t
  use remesh_options, only: read_remesh_options, remesh_options_t, remesh_usage
  use remesh_report, only: print_facts, write_facts
  use remesh_scene, only: remesh_checkpoint
  use run_version, only: blas_words, print_version
  use solver_blas, only: ask_blas
  use standard_streams, only: claim_standard_streams, print_error, print_line
  use start_again, only: start_as_fits
  use system, only: cpu_seconds, program_stop, wall_seconds
  use threads, only: number_of_threads, start_team, team_t
  implicit none
  type(remesh_options_t) :: options
  type(remesh_facts_t) :: facts
  type(error_t), allocatable :: error
  integer :: code

  code = exit_done
  call claim_standard_streams()
  if (asks_for_next()) then
    call answer_next(code, error)
  else if (asks_for_lock()) then
    call lock_cycle(code, error)
  else if (asks_for_start()) then
    call start_program(error)
  else
    call read_remesh_options(options, error)
    if (.not. allocated(error)) call carry_out(error)
  end if
  if (allocated(error)) then
    code = error%code
    call print_error(error%message)
    if (allocated(error%advice)) call print_error(error%advice)
  end if
  call program_stop(code)

contains

  subroutine carry_out(error)
    type(error_t), allocatable, intent(out) :: error

    if (options%help) then
      call print_line(remesh_usage(), error)
    else if (options%version) then
      call show_version(error)
    else if (options%schema) then
      call print_schema(error)
    else if (options%about) then
      call print_about(options%checkpoint, error)
    else
      call run(error)
    end if
  end subroutine carry_out

  subroutine run(error)
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    type(team_t) :: team
    real(wp) :: started

    call refuse_place(options%out, error)
    if (.not. allocated(error)) call refuse_place(options%out//'.json', error)
    if (allocated(error)) return
    started = wall_seconds()
    call start_team(team, 0)
    call remesh_checkpoint(options, facts, error)
    call write_facts(options%out//'.json', facts, wall_seconds() - started, error, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
    if (allocated(options%cost)) call add_remesher(options%cost, cpu_seconds(), late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
    if (.not. options%quiet .and. .not. allocated(error)) call print_facts(facts, wall_seconds() - started, error)
  end subroutine run

  !> The BLAS is the solver's, with the kernels that it takes there.
  subroutine show_version(error)
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: build, core

    call ask_blas(build, core)
    call start_as_fits(1, core)
    call print_version('remdata', blas_words(build, core), number_of_threads(), error)
  end subroutine show_version

end program remdata
