!> What a march starts from: equations, an instant in equilibrium, and files that are open.
module march_start
  use acceptance, only: begin_probation
  use blas, only: blas_buffer
  use bookkeeping, only: measure_scene
  use cut_report, only: lines_of_cuts
  use driver_values, only: start_drivers
  use energy_books, only: start_stored
  use equation_set_up, only: set_up
  use errors, only: error_t, exit_no_convergence, fail
  use estimator_parts, only: set_up_estimator
  use fields, only: displacement_field
  use history, only: open_history
  use judge_remesh, only: limit_lines, refuse_remesh, taken_up_words
  use listing, only: list_balance, list_lines, list_note
  use memory_limits, only: require_memory
  use placed_walls, only: place_walls, placed_wall_t
  use restart_report, only: write_restart
  use restore_balance, only: balance_t, keep_balance, restore_equilibrium
  use results, only: open_results, save_fields
  use run_record, only: run_t, save_all
  use run_warnings, only: add_warning
  use scene, only: operation_of, scene_t
  use solution, only: present_coordinates, solution_t
  use step_outcome, only: outcome_t
  use sudden_loads, only: sudden_load_words
  use system, only: join_path
  use text, only: to_text, two_digits
  use wall_contact, only: find_wall_sides
  use watch_mesh, only: ask_for_trims, estimate_stress, mesh_is_due, note_first_narrow
  implicit none
  private
  public :: start_march

contains

  !> Equations, the scene at rest, and files. A mesh that is refused has touched none of the results.
  subroutine start_march(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    logical :: new_mesh

    new_mesh = solution%unbalanced
    call set_up(scene, run%equations, error)
    if (.not. allocated(error)) call require_memory(8*sum(run%equations%solves%solver%estimated_entries), &
      'the factors of the matrix', error, address_space=run%equations%team%most*blas_buffer)
    if (allocated(error)) return
    ! an operation begins with the deck's own mesh and the motion of those before it
    if (scene%fields(displacement_field)%declared) &
      call find_wall_sides(scene, run%equations%laws, run%equations%dofs, present_coordinates(scene, solution), run%equations%wall)
    call note_dropped_walls(scene, solution, run)
    call start_drivers(scene, run%equations%laws, solution, run%equations%drivers)
    call measure_scene(scene, run%equations, solution, run%totals)
    if (scene%remesh%estimate) call set_up_estimator(scene, run%equations%laws, run%estimator)
    if (.not. run%estimator%elastic) call list_note(run%listing, 'note: a law has no elastic moduli, so error_stress is in the ' &
                                                    //'norm of the deviator, not of the energy')
    if (.not. solution%initial_volume > 0) solution%initial_volume = run%totals%volume
    if (new_mesh .and. .not. run%begins_operation) then
      call balance_new_mesh(scene, solution, run, error)
    else if (new_mesh) then
      call release_part(scene, solution, run, error)
    end if
    if (allocated(error)) return
    if (new_mesh) call list_lines(run%listing, lines_of_cuts(scene, solution, scene%generation))
    call start_stored(run%totals, solution)
    call open_history(scene, solution, join_path(run%folder, 'history.csv'), run%resume, run%columns, run%table, error)
    if (allocated(error)) return
    call open_results(scene, solution, run%stem, merge(solution%step, -1, run%resume), new_mesh, run%results, error)
    if (allocated(error)) return
    if (allocated(run%results%note)) call list_note(run%listing, run%results%note)
    call ask_for_trims(scene, run%listing, solution)
    if (new_mesh .or. mesh_is_due(solution)) then
      call save_all(scene, solution, run, error)
    else if (.not. run%resume) then
      call save_fields(scene, solution, run%results, error)
    end if
  end subroutine start_march

  !> Walls of the deck that are none for this operation.
  subroutine note_dropped_walls(scene, solution, run)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(placed_wall_t), allocatable :: placed(:)
    integer, allocatable :: dropped(:)
    integer :: k

    call place_walls(scene, present_coordinates(scene, solution), placed, dropped)
    do k = 1, size(dropped)
      call list_note(run%listing, 'note: '//scene%walls(dropped(k))%label//' is no wall now: its line has been bent, or its body ' &
                     //'is behind it, since the deck''s own mesh')
    end do
  end subroutine note_dropped_walls

  !> An operation begins: what the dies of the one before and its supports carried is taken off the part, at fixed time. What this
  !> changes of the elastic energy is kept apart, as on a new mesh.
  subroutine release_part(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(balance_t) :: balance
    type(outcome_t) :: outcome

    solution%friction_apart = solution%friction_work - run%totals%friction_work
    run%totals%friction_work = solution%friction_work
    solution%unbalanced = .false.
    if (.not. scene%fields(displacement_field)%declared) return
    balance%before = run%totals
    run%equations%let_go = .not. run%equations%kinematics%hypoelastic
    call restore_equilibrium(scene, run%equations, solution, balance, outcome)
    run%equations%let_go = .false.
    if (allocated(outcome%error)) then
      call move_alloc(outcome%error, error)
      return
    end if
    call list_balance(run%listing, scene, solution, balance, outcome)
    if (.not. balance%restored) then
      call fail(error, exit_no_convergence, 'operation '//scene%operation_name//': the part, released from the operation before, ' &
                //'finds no equilibrium at time '//to_text(solution%time)//': '//balance%reason, &
                sudden_load_words(scene, solution, at_release=.true.)//'hold it by supports (FIXED) or by a die that it lies on, ' &
                //'or lift the dies at the end of the operation before')
      return
    end if
    run%totals = balance%after
    call estimate_stress(scene, run%estimator, solution)
  end subroutine release_part

  !> Equilibrium on a new mesh, judged; later steps begin from it.
  subroutine balance_new_mesh(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    type(outcome_t) :: outcome
    character(len=:), allocatable :: words

    allocate (run%balance)
    ! friction work that the new points of contact do not hold is kept apart
    solution%friction_apart = solution%friction_work - run%totals%friction_work
    run%totals%friction_work = solution%friction_work
    run%balance%before = run%totals
    if (.not. scene%fields(displacement_field)%declared) then
      call keep_balance(scene, solution, run%balance)
      call write_restart(run%stem//'.g'//two_digits(scene%generation)//'.restart.json', scene, solution, run%balance, error)
      return
    end if
    call restore_equilibrium(scene, run%equations, solution, run%balance, outcome)
    if (allocated(outcome%error)) then
      call move_alloc(outcome%error, error)
      return
    end if
    run%totals = run%balance%after
    call list_balance(run%listing, scene, solution, run%balance, outcome)
    call list_lines(run%listing, limit_lines(scene, run%balance))
    call refuse_remesh(scene, solution, run%force_agreed, run%balance, error)
    run%mesh_refused = run%balance%refused
    if (.not. run%mesh_refused) call begin_probation(solution%probation)
    if (run%balance%restored) call estimate_stress(scene, run%estimator, solution)
    solution%estimate%first_stress = solution%estimate%stress
    if (run%balance%restored) call note_first_narrow(scene, solution)
    words = taken_up_words(scene%remesher%accept, run%balance)
    if (len(words) > 0) call add_warning(solution%warnings, operation_of(scene), &
                                         'mesh '//to_text(scene%generation)//': '//words)
    call write_restart(run%stem//'.g'//two_digits(scene%generation)//'.restart.json', scene, solution, run%balance, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
  end subroutine balance_new_mesh

end module march_start
