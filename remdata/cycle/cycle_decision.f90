!> The next action of a cycle, from its situation: pure, so that every situation can be tested without a run.
!>
!> Some actions only tidy the folder (`is_inner`); the situation is then read anew and decided again. The others are for the script:
!> a program to call, or the end. A cycle that was killed at any moment is in one of these situations too.
module cycle_decision
  use cycle_action, only: act_accept, act_check, act_end, act_keep_end, act_keep_old_mesh, act_remesh, act_resume, act_roll_back, &
    act_start, action_t, give_up, new_action, place_of
  use cycle_refusal, only: refuse_first_steps, refuse_made, refuse_restart
  use cycle_situation, only: current_name, due_reason, ended_check, ended_lagamine, ended_nothing, ended_remdata, is_due, &
    is_first_mesh, is_read, mesh_name, situation_t, try_name
  use cycle_table, only: way_agreed, way_anew, way_coarser, way_earlier, way_finer, way_mesher, way_old_mesh, way_transfer
  use cycle_tries, only: agreed_way, any_agreed, first_reason
  use cycle_ways, only: is_whole, next_way, old_mesh_goes_on, old_state
  use confinement_record, only: no_room_advice, no_room_words
  use cuts, only: stage_of_cuts
  use errors, only: exit_done, exit_input, exit_machine, exit_no_convergence, exit_remesh, exit_signal
  use kinds, only: wp
  use own_contact, only: passes_itself_advice, passes_itself_words
  use text, only: to_text
  implicit none
  private
  public :: next_action

  !> Wanted sizes are divided by this where finer elements are tried, and multiplied where coarser ones are.
  real(wp), parameter :: finer_by = 1.5_wp, coarser_by = 1.25_wp
  !> Methods of state transfer, and how far the other one is from the deck's.
  integer, parameter :: transfer_methods = 3, other_transfer = 2
  !> Why a mesh is taken up that was refused by the force of a die.
  character(len=*), parameter :: wrong_before = 'the force of a die was wrong on an old mesh: several new ones agree on another'
  character(len=*), parameter :: begin_anew = 'lagacycle --fresh begins anew'

contains

  pure function next_action(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action

    associate (ended => s%ended)
      if (ended%program == ended_nothing) then
        action = opening(s)
      else if (stopped_from_outside(s)) then
        action = give_up(ended%code, program_name(s)//' was stopped by signal '//to_text(ended%code - exit_signal)// &
                         ': the same command goes on')
      else if (ended%program == ended_check .and. ended%code /= exit_done) then
        action = give_up(ended%code, ended%said, begin_anew)
      else if (ended%program == ended_lagamine .and. ended%code /= exit_remesh) then
        action = after_lagamine(s)
      else if (is_no_cut(s)) then
        action = give_up(ended%code, ended%said)
      else if (ended%program == ended_remdata .and. ended%code == exit_machine .and. .not. s%has_room) then
        action = give_up(ended%code, ended%said)   ! a full disk is no fault of a mesh
      else
        action = onward(s)
      end if
    end associate
  end function next_action

  !> The remesher cannot cut a body as the deck says: no other mesh makes another cut.
  pure function is_no_cut(s)
    type(situation_t), intent(in) :: s
    logical :: is_no_cut

    is_no_cut = s%ended%program == ended_remdata .and. s%ended%code /= exit_done .and. allocated(s%new%made_stage)
    if (is_no_cut) is_no_cut = s%new%made_stage == stage_of_cuts
  end function is_no_cut

  !> Nothing was called yet: a checkpoint that is there must be whole, or the one before takes its place.
  pure function opening(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action

    if (s%fresh .or. .not. (s%current%found .or. s%previous%found)) then
      action = new_action(act_start, say='lagamine begins; results in '//s%folder)
    else if (is_read(s%current)) then
      action = new_action(act_check, from=current_name)
    else if (.not. s%current%found) then
      action = new_action(act_roll_back)
    else if (is_read(s%previous)) then
      action = new_action(act_roll_back, say=s%current%refused//': going on from the one before')
    else
      action = give_up(exit_input, s%current%refused, begin_anew)
    end if
  end function opening

  !> The solver has finished, or cannot go on: soon after a new mesh the mesh is held responsible.
  pure function after_lagamine(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action

    associate (code => s%ended%code, facts => s%current%facts)
      if (code == exit_machine .or. (code /= exit_done .and. .not. is_read(s%current))) then
        action = give_up(code, s%ended%said)
      else if (.not. is_read(s%current)) then
        action = onward(s)
      else if (code /= exit_done .and. began_with_try(s) .and. facts%generation < s%new%generation) then
        action = refuse_restart(s)
      else if (code /= exit_done .and. code /= exit_no_convergence) then
        action = give_up(code, s%ended%said)
      else if (is_to_be_entered(s)) then
        action = enter_new_mesh(s)
      else if (code == exit_done) then
        action = new_action(act_end, say='done: '//where_it_stands(s)//'; results in '//s%folder)
      else if (facts%generation > 1 .and. facts%probation > 0 .and. is_read(s%new%old_end) .and. is_read(s%new%made)) then
        action = refuse_first_steps(s)
      else
        action = give_up(code, s%ended%said)
      end if
    end associate
  end function after_lagamine

  !> The cycle can go on: with the run, or with the mesh that is due.
  pure function onward(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action

    if (.not. is_read(s%current)) then
      if (allocated(s%current%refused)) then
        action = give_up(exit_machine, s%current%refused)
      else
        action = give_up(exit_machine, s%stem//'.'//current_name//': is missing')
      end if
    else if (is_to_be_entered(s)) then
      action = enter_new_mesh(s)
    else if (s%ended%program == ended_check .and. s%finished) then
      action = new_action(act_end, say='finished already: '//where_it_stands(s)//'; nothing to do (--fresh begins anew)')
    else if (.not. is_due(s%current%facts)) then
      action = resume_run(s)
    else if (.not. s%end_is_kept) then
      action = new_action(act_keep_end)
    else if (old_mesh_goes_on(s)) then
      action = resume_run(s)
    else
      action = make_new_mesh(s)
    end if
  end function onward

  !> A mesh is due and the old one has stopped: the first way that was not tried yet, or the try that is there already.
  pure function make_new_mesh(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action
    character(len=:), allocatable :: way, made_by
    logical :: whole

    way = next_way(s)
    whole = is_whole(s, way)
    made_by = way
    if (way == way_agreed) made_by = agreed_way(s%rows, s%new%generation, s%new%old_end%facts%step)
    if (way == '') then
      action = no_way_left(s)
    else if (way == way_old_mesh) then
      action = new_action(act_keep_old_mesh, say='mesh '//to_text(s%new%generation - 1)//'  '//place_of(s%new%old_end)// &
                          ': goes on, every new mesh was refused')
      action%way = way
      action%result = 'goes on'
    else if (s%ended%program == ended_remdata .and. (s%ended%code /= exit_done .or. .not. whole)) then
      action = refuse_made(s, way)
    else if (whole) then
      action = new_action(act_resume, from=try_name(s%new%generation, s%new%number), &
                          say='lagamine takes up mesh '//to_text(s%new%generation)//' with '//to_text(s%new%made%facts%elements)// &
                          ' elements, '//place_of(s%new%made))
      action%force_agreed = way == way_agreed
    else
      action = new_action(act_remesh, from=mesh_name(s%new%generation - 1, 'end.h5'), &
                          new=try_name(s%new%generation, s%new%number), &
                          say='remdata makes mesh '//to_text(s%new%generation)//' ('//way//'), '// &
                          place_of(old_state(s, way))//': '//due_reason(s%new%old_end%facts))
      if (made_by == way_transfer) &
        action%transfer = mod(s%new%old_end%facts%transfer + other_transfer, transfer_methods)
      if (made_by == way_finer) action%finer = finer_by
      action%without_zones = made_by == way_mesher
      if (made_by == way_coarser) action%finer = 1/coarser_by
      if (way == way_anew) then
        action%from = mesh_name(s%new%generation - 2, 'end.h5')
        action%sizes = mesh_name(s%new%generation - 1, 'end.h5')
      end if
      if (way == way_earlier) action%from = mesh_name(s%new%generation - 1, 'end.1.h5')
    end if
  end function make_new_mesh

  !> The run is on a new mesh, its first steps are made, and its try is still there.
  pure function is_to_be_entered(s)
    type(situation_t), intent(in) :: s
    logical :: is_to_be_entered

    is_to_be_entered = s%current%facts%generation > 1 .and. s%current%facts%generation >= s%new%generation &
                       .and. s%current%facts%probation == 0 .and. s%new%has_tries
  end function is_to_be_entered

  pure function enter_new_mesh(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action

    action = new_action(act_accept)
    action%way = next_way(s)
    action%result = 'lagamine: goes on'
    if (action%way == way_agreed) action%reason = wrong_before
  end function enter_new_mesh

  pure function no_way_left(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action
    character(len=:), allocatable :: tried, heed, reason, first

    ! what is wrong with the scene, as a part that begins in a die or passes through itself, is reported there
    heed = 'warnings in '//s%stem//'.log come first'
    tried = to_text(s%new%number - 1)//' tried, see '//s%table
    reason = first_reason(s%rows, s%new%generation, s%new%old_end%facts%step)
    if (reason /= '') tried = tried//'; the first: '//reason
    first = ''
    if (index(reason, passes_itself_words) > 0) first = passes_itself_advice//'; '
    if (index(reason, no_room_words) > 0) first = no_room_advice//'; '
    if (is_first_mesh(s%new%old_end%facts)) then
      action = give_up(exit_no_convergence, 'no first mesh is good enough: '//tried, &
                       first//heed//'; else the contour may want other ZPNT and ZONE cards, or sizes: REMSH SIZE, TURN and COUNT')
    else
      action = give_up(exit_no_convergence, 'no new mesh is good enough at '//place_of(s%new%old_end)//': '//tried, &
                       first//'the checkpoint is '//s%stem//'.'//current_name//': lagamine --resume goes on with the old mesh; '// &
                       'shorter steps (STRAT), or other rows of REMSH (SIZE, ACCEPT, TRIES), beside the limits that --check '// &
                       'prints, may help; '//heed)
    end if
  end function no_way_left

  pure function resume_run(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action

    action = new_action(act_resume, from=current_name, say='lagamine goes on with mesh '// &
                        to_text(s%current%facts%generation)//', '//place_of(s%current))
  end function resume_run

  !> Was the program stopped by HUP, INT, KILL or TERM? Other signals are crashes.
  pure function stopped_from_outside(s) result(stopped)
    type(situation_t), intent(in) :: s
    logical :: stopped
    integer, parameter :: signals(4) = [1, 2, 9, 15]

    stopped = any(s%ended%code == exit_signal + signals) .and. s%ended%late == 0 &
              .and. any(s%ended%program == [ended_check, ended_lagamine, ended_remdata])
  end function stopped_from_outside

  pure function program_name(s) result(name)
    type(situation_t), intent(in) :: s
    character(len=:), allocatable :: name

    name = 'lagamine'
    if (s%ended%program == ended_remdata) name = 'remdata'
  end function program_name

  !> The solver began with the try at hand.
  pure function began_with_try(s)
    type(situation_t), intent(in) :: s
    logical :: began_with_try

    began_with_try = s%ended%from == try_name(s%new%generation, s%new%number)
  end function began_with_try

  pure function where_it_stands(s) result(words)
    type(situation_t), intent(in) :: s
    character(len=:), allocatable :: words

    associate (facts => s%current%facts)
      words = place_of(s%current)//', '//to_text(facts%remeshings)//' new mesh'
      if (facts%remeshings /= 1) words = words//'es'
      if (any_agreed(s%rows)) words = words//'; WARNING: '//wrong_before//' (cycle.csv)'
      if (s%warnings > 0) words = words//'; '//to_text(s%warnings)//' warning'
      if (s%warnings > 1) words = words//'s'
      if (s%warnings > 0) words = words//' (summary.json)'
    end associate
  end function where_it_stands

end module cycle_decision
