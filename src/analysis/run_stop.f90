!> How a run ends: at the end of the scene, at a limit, by a signal, or because it cannot go on.
module run_stop
  use confinement, only: confinement_words
  use confinement_record, only: no_room_words
  use equations, only: equations_t
  use errors, only: error_t, exit_done, exit_no_convergence, exit_remesh, exit_signal, fail
  use fields, only: displacement_field, find_field
  use kinds, only: wp
  use law_api, only: find_parameter, law_t
  use own_contact, only: passes_itself_advice, passes_itself_words, thins_out_advice, thins_out_words
  use results, only: save_failure
  use run_record, only: run_t, save_all, at_end
  use scene, only: role_side_load, scene_t
  use sliding_bodies, only: sliding_words
  use solution, only: solution_t
  use spurious_mode, only: may_stand_alone
  use step_outcome, only: outcome_t
  use strategy, only: coupling_once
  use sudden_loads, only: sudden_load_words
  use system, only: caught_signal
  use text, only: to_text
  use unheld_dies, only: limit_load_words, unheld_die_t, unheld_die_words
  use unsettled_contact, only: loses_touch, touch_advice
  use watch_mesh, only: mesh_is_due, remesh_reason
  implicit none
  private
  public :: finish, stop_here

contains

  !> The smallest step has failed: report why, where, and what to try; write the field of the residual.
  subroutine stop_here(scene, solution, dt, outcome, unheld, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(in) :: outcome
    type(unheld_die_t), intent(in) :: unheld   !! what nothing held in the last attempt
    type(run_t), intent(in) :: run
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    real(wp), allocatable :: residual(:, :)
    character(len=:), allocatable :: where_at, advice, limit, what, slides

    where_at = ''
    if (outcome%group > 0) where_at = ', element '//to_text(outcome%element)//' of '//scene%groups(outcome%group)%name
    advice = ''
    if (allocated(outcome%residual)) then
      call residual_at_nodes(scene, run%equations, outcome%of_heat, outcome%residual, residual)
      if (any(abs(residual) > 0)) where_at = where_at//', worst at node ' &
        //to_text(scene%mesh%labels(maxloc(sum(residual**2, 1), 1)))//trim(merge(' (heat)', '       ', outcome%of_heat))
      if (.not. outcome%of_heat) then
        call save_failure(scene, solution, run%stem, residual, late)
        advice = 'the residual force is in '//run%stem//'.failed.xdmf; '
      end if
    end if
    ! attempts beyond a limit load lose the die too
    limit = limit_load_words(scene, solution, unheld%die == 0 .and. any(outcome%history%past_limit))
    if (unheld%die > 0 .and. limit == '') advice = advice//unheld_die_words(scene, solution, unheld)
    slides = ''
    if (.not. outcome%of_heat .and. unheld%die == 0) slides = sliding_words(scene, run%equations%loose, solution)
    if (outcome%of_heat) then
      advice = advice//'numbers that jump along the temperature, NORMS near round-off or a least step too large in ' &
               //'STRAT are the usual causes'
    else if (slides /= '') then
      advice = slides//'; '//advice//'a limit load'//way_past_limit(scene)//' is another cause'
    else if (unheld%die == 0 .or. limit /= '') then
      advice = sudden_load_words(scene, solution, at_release=.false.)//limit//advice//'a limit load'//way_past_limit(scene) &
               //', a mesh too distorted or a least step too large in STRAT are the usual causes'
    else if (index(outcome%reason, 'singular') == 0) then
      advice = advice//'; a mesh too distorted or a least step too large in STRAT are other causes'
    end if
    if (solution%confinement%now) advice = confinement_words(scene, solution%confinement)//'; '//advice
    if (index(outcome%reason, 'singular') > 0 .and. any(may_stand_alone(scene%groups))) advice = advice//'; a body of few ' &
      //'elements with 4 integration points has a motion that nothing resists, 9 points with MEAN have none'
    if (scene%strategy%coupling /= coupling_once .and. scene%fields(displacement_field)%declared .and. loses_touch(scene)) &
      advice = advice//'; heat that jumps as a point opens (COU2DC) may leave no equilibrium to a part that shrinks away from a ' &
               //'die: '//touch_advice
    what = 'no convergence'
    if (solution%confinement%now) what = no_room_words
    if (is_steep(scene, run%equations%laws)) advice = advice//'; friction by M has no bound by the pressure but PHI: PHI 1 ' &
      //'beside M, above which an equilibrium need not exist'
    if (outcome%thins_out) then
      what = thins_out_words
      advice = thins_out_advice
    else if (outcome%passes_itself) then
      what = passes_itself_words
      advice = passes_itself_advice
    end if
    if (solution%step > 0) advice = 'the last good state is in '//run%stem//'.ckp.h5, '//advice
    call fail(error, exit_no_convergence, what//': step '//to_text(solution%step + 1)//' from time ' &
              //to_text(solution%time)//', length '//to_text(dt)//where_at//': '//outcome%reason, &
              advice)
    if (allocated(late)) error%advice = error%advice//' (and '//late%message//')'
  end subroutine stop_here

  !> What leads past a limit load: the multiplier of loads is found (LOADF), or another measure where that turns back; a die is
  !> moved. Nothing where no load acts that may be found.
  pure function way_past_limit(scene)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: way_past_limit

    way_past_limit = ''
    if (scene%load_factor%multiplier > 0) then
      way_past_limit = ' at which the measure of LOADF turns back (that of a node may go on, as across a crack, a neck or a dent)'
    else if (size(scene%forces) > 0 .or. any(scene%groups%role == role_side_load .and. .not. scene%groups%brings_heat)) then
      way_past_limit = ' (LOADF finds the loads beyond it)'
    else if (size(scene%die_forces) > 0) then
      if (any(scene%die_forces%multiplier > 0)) way_past_limit = ' (a die that MOVE drives, in place of FORCE, goes beyond it)'
    end if
  end function way_past_limit

  !> A law of contact has friction by M, with a coefficient PHI above 1 or none of the deck.
  pure function is_steep(scene, laws)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical :: is_steep
    integer :: m

    is_steep = .false.
    do m = 1, size(scene%materials)
      associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
        if (find_parameter(law, 'M') == 0 .or. find_parameter(law, 'PHI') == 0) cycle
        is_steep = is_steep .or. (material%values(find_parameter(law, 'M')) < huge(1.0_wp) &
                                  .and. material%values(find_parameter(law, 'PHI')) > 1)
      end associate
    end do
  end function is_steep

  !> Residual of the free unknowns of the nodes: forces on their motion, or of a solve of heat alone the heat flow in the first
  !> component. Where the motion or the temperature is given it is a reaction, left out.
  pure subroutine residual_at_nodes(scene, equations, of_heat, residual, at_nodes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: of_heat                          !! the solve was one of heat alone
    real(wp), intent(in) :: residual(:)                     !! (ndof) [force or power]
    real(wp), allocatable, intent(out) :: at_nodes(:, :)    !! (2, nnode)
    integer :: k, c, d, f

    f = displacement_field
    if (of_heat) f = find_field(scene%fields, 'temperature')
    associate (number => equations%dofs%fields(f)%number)
      allocate (at_nodes(2, size(number, 2)), source=0.0_wp)
      do k = 1, size(at_nodes, 2)
        do c = 1, size(number, 1)
          d = number(c, k)
          if (d == 0) cycle
          if (equations%dofs%is_free(d)) at_nodes(c, k) = residual(d)
        end do
      end do
    end associate
  end subroutine residual_at_nodes

  !> Leave files that state how the run ended.
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
      ! a refused mesh changes none of the saved results
      if (error%code == exit_no_convergence .and. solution%step > 0 .and. .not. run%mesh_refused) then
        call save_all(scene, solution, run, late)
      end if
    else if (run%folding > 0) then
      ! goes on at once, with contact there (folding_run)
      run%exit_code = exit_remesh
      run%stop_reason = run%folds
    else if (mesh_is_due(solution)) then
      run%exit_code = exit_remesh
      run%stop_reason = remesh_reason(scene, solution)
    else if (caught_signal() /= 0 .and. .not. at_end(scene, solution)) then
      run%exit_code = exit_signal + caught_signal()
      run%stop_reason = 'stopped by signal '//to_text(caught_signal())//' at step '//to_text(solution%step)
    end if
    call run%table%close(late)
  end subroutine finish

end module run_stop
