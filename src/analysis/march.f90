!> The march in time: the page that reads like the method.
module march
  use accept_step, only: accept, measure_scene
  use contact_contour, only: find_contact_ends
  use contact_ends, only: contact_end_t
  use contact_flow, only: update_flow_stress
  use csv_writer, only: csv_t
  use dies, only: present_die
  use elem_api, only: totals_t
  use equations, only: equations_t, set_up
  use errors, only: error_t, exit_done, exit_no_convergence, exit_remesh, exit_signal, fail
  use estimator, only: estimator_t, set_up_estimator
  use exchange, only: write_checkpoint
  use history, only: open_history, write_row
  use kinds, only: eps, wp
  use listing, only: list_balance, list_cut, list_event, list_note, list_step, listing_t, show_progress
  use newton, only: outcome_t, solve_step
  use restore_balance, only: balance_t, refuse_remesh, restore_equilibrium
  use restart_report, only: write_restart
  use results, only: open_results, results_t, save_failure, save_fields
  use scene, only: scene_t
  use solution, only: solution_t
  use spurious_mode, only: may_stand_alone, spurious_limit
  use state_variables, only: find_variable
  use step_strategy, only: after_failure, after_success, choose_step
  use system, only: caught_signal, join_path
  use text, only: to_text, two_digits
  use watch_mesh, only: answer_distress, estimate, estimate_stress, look_at_mesh, mesh_is_due, remesh_reason
  implicit none
  private
  public :: run_t, march_to_end

  !> A run: its files, and what is needed to write them.
  type :: run_t
    !> Folder of the results, path of the run's own files without endings; the deck's path and canonical text.
    character(len=:), allocatable :: folder, stem, deck_path, deck_text
    logical :: resume = .false.
    type(equations_t) :: equations
    !> Set up where errors are estimated.
    type(estimator_t) :: estimator
    type(listing_t) :: listing
    type(csv_t) :: table
    type(results_t) :: results
    type(totals_t) :: totals
    !> How the run got into equilibrium on a new mesh; not allocated where it did not have to.
    type(balance_t), allocatable :: balance
    !> The note on a spurious mode has been given.
    logical :: spurious_told = .false.
    integer :: exit_code = exit_done
    character(len=:), allocatable :: stop_reason
  end type run_t

  !> A step shortened to an event is shortened by something, so that the event is met in a few trials.
  real(wp), parameter :: largest_event = 0.95_wp

contains

  !> March from where the solution stands to the end of the scene, or to where it must stop.
  subroutine march_to_end(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(outcome_t) :: outcome
    real(wp) :: dt
    logical :: give_up
    integer :: cuts

    cuts = 0
    call start(scene, solution, run, error)
    do while (.not. allocated(error) .and. solution%time < scene%strategy%end_time*(1 - 64*eps))
      dt = choose_step(scene, solution%time, solution%next_step)

      call solve_step(scene, run%equations, solution, dt, outcome)
      do while (outcome%event < 1)
        dt = max(min(outcome%event, largest_event)*dt, scene%strategy%least_step)
        call list_event(run%listing, solution, dt)
        call solve_step(scene, run%equations, solution, dt, outcome)
      end do
      if (allocated(outcome%error)) then
        call move_alloc(outcome%error, error)
        exit
      end if

      if (.not. outcome%converged) then
        solution%cutbacks = solution%cutbacks + 1
        call after_failure(scene, dt, solution%next_step, give_up)
        call list_cut(run%listing, scene, solution, dt, solution%next_step, outcome)
        cuts = cuts + 1
        call answer_distress(scene, cuts, give_up, run%listing, solution)
        if (mesh_is_due(solution)) then
          call save_all(scene, solution, run, error)
          exit
        end if
        if (give_up) call stop_here(scene, solution, dt, outcome, run, error)
        cycle
      end if

      solution%next_step = after_success(scene, dt, solution%next_step, outcome%first_iterations, outcome%strain)
      call accept(scene, run%equations, dt, outcome, solution, run%totals, error)
      if (allocated(error)) exit
      cuts = 0
      call estimate(scene, run%estimator, run%equations%timers, solution)
      call list_step(run%listing, solution, outcome, run%totals)
      ! at the end a new mesh would have nothing to do
      if (.not. at_end(scene, solution)) call look_at_mesh(scene, run%equations%timers, run%listing, solution)
      call tell_spurious_mode(scene, solution, run)
      call show_progress(run%listing, scene, solution, outcome%iterations)
      call record(scene, solution, outcome, run, error)
      if (caught_signal() /= 0 .or. mesh_is_due(solution)) exit
    end do
    call finish(scene, solution, run, error)
  end subroutine march_to_end

  !> Equations, the scene at rest, and files. A mesh that is refused has touched none of the results.
  subroutine start(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    logical :: new_mesh

    new_mesh = solution%unbalanced
    call set_up(scene, run%equations, error)
    if (allocated(error)) return
    call update_flow_stress(scene, run%equations%laws, run%equations%bodies, solution)
    call measure_scene(scene, run%equations, solution, run%totals)
    if (scene%remesh%estimate) call set_up_estimator(scene, run%equations%laws, run%estimator)
    if (.not. run%estimator%elastic) call list_note(run%listing, 'note: a law has no elastic moduli, so error_stress is in the ' &
                                                    //'norm of the deviator, not of the energy')
    if (.not. solution%initial_volume > 0) solution%initial_volume = run%totals%volume
    if (new_mesh) call balance_new_mesh(scene, solution, run, error)
    if (allocated(error)) return
    call open_history(scene, solution, join_path(run%folder, 'history.csv'), run%resume, run%table, error)
    if (allocated(error)) return
    call open_results(scene, solution, run%stem, merge(solution%step, -1, run%resume), new_mesh, run%results, error)
    if (allocated(error)) return
    if (allocated(run%results%note)) call list_note(run%listing, run%results%note)
    if (new_mesh) then
      call save_all(scene, solution, run, error)
    else if (.not. run%resume) then
      call save_fields(scene, solution, run%results, error)
    end if
  end subroutine start

  !> Equilibrium on a new mesh, judged; later steps stand on the state that was carried.
  subroutine balance_new_mesh(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    type(outcome_t) :: outcome

    allocate (run%balance)
    run%balance%before = run%totals
    call restore_equilibrium(scene, run%equations, solution, run%balance, outcome)
    if (allocated(outcome%error)) then
      call move_alloc(outcome%error, error)
      return
    end if
    run%totals = run%balance%after
    call list_balance(run%listing, scene, solution, run%balance, outcome)
    call refuse_remesh(scene, solution, run%balance, error)
    if (run%balance%restored) call estimate_stress(scene, run%estimator, solution)
    call write_restart(run%stem//'.g'//two_digits(scene%generation)//'.restart.json', scene, solution, run%balance, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
  end subroutine balance_new_mesh

  !> A note, once, when an element has moved in a way that its points do not see.
  subroutine tell_spurious_mode(scene, solution, run)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run

    if (run%spurious_told .or. .not. solution%worst_spurious > spurious_limit) return
    run%spurious_told = .true.
    call list_note(run%listing, 'note: step '//to_text(solution%step)//': element '//to_text(solution%spurious_element)//' of ' &
                   //scene%groups(solution%spurious_group)%name//' moves in the way that 4 integration points do not see ('// &
                   to_text(100*solution%worst_spurious, 3)//' % of its strain); PL8LS with 9 points and MEAN has no such motion')
  end subroutine tell_spurious_mode

  !> History after every step; fields and checkpoint when they are due.
  subroutine record(scene, solution, outcome, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    logical :: fields_due

    call write_row(scene, solution, outcome, run%totals, run%table, error)
    if (allocated(error)) return
    fields_due = is_due(solution%step, scene%strategy%save_every) .or. at_end(scene, solution) &
                 .or. is_save_time(scene, solution) .or. mesh_is_due(solution)
    if (fields_due) then
      call save_all(scene, solution, run, error)
    else if (is_due(solution%step, scene%strategy%checkpoint_every) .or. caught_signal() /= 0) then
      call save_checkpoint(scene, solution, run, error)
    end if
  end subroutine record

  !> Fields and checkpoint of the accepted instant.
  subroutine save_all(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error

    call save_fields(scene, solution, run%results, error)
    if (.not. allocated(error)) call save_checkpoint(scene, solution, run, error)
  end subroutine save_all

  !> The checkpoint; the rows of the history up to it are on the disk before it is.
  subroutine save_checkpoint(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error

    call run%table%flush_rows(error)
    if (allocated(error)) return
    call write_checkpoint(run%stem//'.ckp.h5', run%deck_path, run%deck_text, scene, solution, ends_now(scene, solution), error)
  end subroutine save_checkpoint

  !> Where contact begins and ends in all contact groups.
  function ends_now(scene, solution) result(ends)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), allocatable :: ends(:)
    real(wp), allocatable :: x(:, :)
    integer :: g, status, penetration

    allocate (ends(0))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        penetration = group%variables(find_variable(group%variables, 'penetration'))%first
        x = scene%mesh%coordinates + solution%displacement
        call find_contact_ends(group, g, present_die(scene%dies(group%die), x), solution%pilots(:, group%die), &
                               scene%mesh%coordinates, x, &
                               nint(solution%groups(g)%committed(status, :, :)), &
                               solution%groups(g)%committed(penetration, :, :), ends)
      end associate
    end do
  end function ends_now

  pure function is_due(step, every) result(due)
    integer, intent(in) :: step, every
    logical :: due

    due = .false.
    if (every > 0) due = mod(step, every) == 0
  end function is_due

  pure function at_end(scene, solution) result(reached)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: reached

    reached = solution%time >= scene%strategy%end_time*(1 - 64*eps)
  end function at_end

  pure function is_save_time(scene, solution) result(due)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: due

    due = .false.
    if (allocated(scene%strategy%save_times)) then
      due = any(abs(scene%strategy%save_times - solution%time) <= 64*eps*scene%strategy%end_time)
    end if
  end function is_save_time

  !> The smallest step has failed: say why, where, and what to try; leave a picture of the residual.
  subroutine stop_here(scene, solution, dt, outcome, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(in) :: outcome
    type(run_t), intent(in) :: run
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    real(wp), allocatable :: residual(:, :)
    character(len=:), allocatable :: where_at, advice

    where_at = ''
    if (outcome%group > 0) where_at = ', element '//to_text(outcome%element)//' of '//scene%groups(outcome%group)%name
    if (allocated(outcome%residual)) then
      call residual_at_nodes(run%equations, outcome%residual, residual)
      where_at = where_at//', worst at node '//to_text(scene%mesh%labels(maxloc(sum(residual**2, 1), 1)))
      call save_failure(scene, solution, run%stem, residual, late)
    end if
    advice = 'the residual force is in '//run%stem//'.failed.xdmf; a limit load, a mesh too distorted or a least step too ' &
             //'large in STRAT are the usual causes'
    if (size(scene%die_forces) > 0) advice = 'a die that is free and touches nothing needs a SPRNG card until it does; '//advice
    if (index(outcome%reason, 'singular') > 0 .and. any(may_stand_alone(scene%groups))) advice = advice//'; a body of few ' &
      //'elements with 4 integration points has a motion that nothing resists, 9 points with MEAN have none'
    if (solution%step > 0) advice = 'the last good state is in '//run%stem//'.ckp.h5, '//advice
    call fail(error, exit_no_convergence, 'no convergence: step '//to_text(solution%step + 1)//' from time ' &
              //to_text(solution%time)//', length '//to_text(dt)//where_at//': '//outcome%reason, &
              advice)
    if (allocated(late)) error%advice = error%advice//' (and '//late%message//')'
  end subroutine stop_here

  !> Residual of the free unknowns of the nodes; where the motion is given it is a reaction, left out.
  pure subroutine residual_at_nodes(equations, residual, at_nodes)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: residual(:)
    real(wp), allocatable, intent(out) :: at_nodes(:, :)
    integer :: k, c, d

    allocate (at_nodes(2, size(equations%dofs%node, 2)), source=0.0_wp)
    do k = 1, size(at_nodes, 2)
      do c = 1, 2
        d = equations%dofs%node(c, k)
        if (d == 0) cycle
        if (equations%dofs%equation(d) > 0) at_nodes(c, k) = residual(d)
      end do
    end do
  end subroutine residual_at_nodes

  !> Leave files that tell how the run ended.
  subroutine finish(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: late

    run%exit_code = exit_done
    run%stop_reason = 'end of the scene'
    if (allocated(error)) then
      run%exit_code = error%code
      run%stop_reason = error%message
      if (error%code == exit_no_convergence .and. solution%step > 0 .and. .not. mesh_is_refused(run)) then
        call save_all(scene, solution, run, late)
      end if
    else if (mesh_is_due(solution)) then
      run%exit_code = exit_remesh
      run%stop_reason = remesh_reason(scene, solution)
    else if (caught_signal() /= 0 .and. .not. at_end(scene, solution)) then
      run%exit_code = exit_signal + caught_signal()
      run%stop_reason = 'stopped by signal '//to_text(caught_signal())//' at step '//to_text(solution%step)
    end if
    call run%table%close(late)
  end subroutine finish

  !> The new mesh was refused: what was there before it stays.
  pure function mesh_is_refused(run) result(refused)
    type(run_t), intent(in) :: run
    logical :: refused

    refused = .false.
    if (allocated(run%balance)) refused = run%balance%refused
  end function mesh_is_refused

end module march
