!> What a run begins with, before its first step: threads, files, and what is reported of the deck.
module run_beginning
  use accuracy_plan, only: plan_lines
  use atomic, only: refuse_place
  use blas, only: blas_buffer
  use deck_check, only: as_warnings, look_at_deck
  use errors, only: error_t
  use kinds, only: wp
  use listing, only: list_lines, list_resumed, open_listing, share_done
  use memory_limits, only: require_memory
  use operation_outlook, only: look_at_beginning, warn_of_overlap
  use results, only: forget_failure
  use run_options, only: run_options_t
  use run_record, only: run_t
  use scene, only: scene_t
  use scene_summary, only: scene_lines
  use solution, only: solution_t
  use standard_streams, only: print_lines
  use system, only: join_path, remove_file
  use text, only: string_t, to_text
  use threads, only: start_team
  implicit none
  private
  public :: begin_run

contains

  !> Begin a run, resumed or not, or an operation of one. `warnings` are those of the deck; with progress they are printed.
  subroutine begin_run(options, scene, solution, run, warnings, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution   !! how deep a die begins in the part is noted
    type(run_t), intent(inout) :: run
    type(string_t), allocatable, intent(out) :: warnings(:)   !! (nwarning)
    type(error_t), allocatable, intent(out) :: error
    type(string_t), allocatable :: lines(:)

    call start_team(run%equations%team, options%threads)
    call require_memory(0.0_wp, 'the threads of a run', error, address_space=run%equations%team%most*blas_buffer)
    if (.not. allocated(error)) call prepare_files(options, scene, solution, run, error)
    if (allocated(error)) return
    if (run%begins_operation) then
      call list_lines(run%listing, [string_t('operation '//scene%operation_name//' begins after step ' &
                                             //to_text(solution%step)//', time '//to_text(solution%time))])
    else if (run%resume) then
      call list_resumed(run%listing, options%resume, solution)
    end if
    call scene_lines(scene, lines)
    call list_lines(run%listing, lines)
    call look_at_deck(options, scene, lines, warnings, error)
    if (allocated(error)) return
    if (run%begins_operation) call look_at_beginning(scene, solution, lines)
    call warn_of_overlap(scene, solution, warnings)
    if (options%progress .and. .not. allocated(options%resume)) call print_lines(as_warnings(warnings), error)
    if (allocated(error)) return
    call list_lines(run%listing, lines)
    call list_lines(run%listing, as_warnings(warnings))
    if (allocated(run%plan) .and. .not. run%begins_operation) then
      call plan_lines(run%plan, lines)
      call list_lines(run%listing, lines)
      if (.not. (options%quiet .or. run%resume)) call print_lines(lines, error)
    end if
  end subroutine begin_run

  !> The listing is opened. The result of an earlier call is not that of this one: its summary, end and failure are removed.
  subroutine prepare_files(options, scene, solution, run, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error

    call open_listing(run%stem//'.log', run%resume, options%quiet, options%progress, share_done(scene, solution%time), &
                      run%listing, error)
    if (.not. allocated(error)) call remove_file(join_path(run%folder, 'summary.json'), error)
    if (.not. allocated(error) .and. scene%operation > 0) &
      call remove_file(join_path(run%folder, 'summary.'//scene%operation_name//'.json'), error)
    if (.not. allocated(error)) call forget_failure(run%stem, scene%generation, error)
    ! written only after a while
    if (.not. allocated(error)) call refuse_place(run%stem//'.ckp.h5', error)
  end subroutine prepare_files

end module run_beginning
