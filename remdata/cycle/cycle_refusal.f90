!> Why a try at a new mesh is refused: by how the program ended that was to make it, or to go on with it.
module cycle_refusal
  use cycle_action, only: act_refuse, action_t, new_action
  use cycle_situation, only: first_line, is_first_mesh, mesh_name, situation_t
  use cycle_table, only: way_anew, way_earlier
  use cycle_ways, only: next_way
  use errors, only: exit_done, exit_input, exit_signal
  use text, only: to_text
  implicit none
  private
  public :: refuse_made, refuse_restart, refuse_first_steps

contains

  !> The remesher made no mesh.
  pure function refuse_made(s, way) result(action)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: way
    type(action_t) :: action
    character(len=:), allocatable :: stage, why

    associate (code => s%ended%code)
      stage = s%new%made_stage
      if (stage == '') stage = 'mesh'
      if (s%ended%late > 0) then
        action = refuse(s, way, 'remdata: no answer', 'mesh', 'no answer in '//to_text(s%ended%late)//' s')
      else if (code == exit_done) then
        why = 'no new mesh in it'
        if (allocated(s%new%made%refused)) why = s%new%made%refused
        action = refuse(s, way, 'remdata: not a checkpoint', 'checkpoint', why)
      else if (code > exit_signal) then
        action = refuse(s, way, 'remdata: signal '//to_text(code - exit_signal), stage, &
                        'crashed, signal '//to_text(code - exit_signal))
      else
        action = refuse(s, way, 'remdata: exit code '//to_text(code), stage, first_line(s%ended%said))
      end if
    end associate
    action%with_restart = .false.
  end function refuse_made

  !> The solver did not accept the mesh.
  pure function refuse_restart(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action
    character(len=:), allocatable :: stage

    if (s%new%restart_refused) then
      action = refuse(s, next_way(s), 'lagamine: refused at restart', s%new%restart_stage, first_line(s%ended%said))
      return
    end if
    stage = 'transfer'
    ! a mesh that has taken over nothing, one on which the cards cannot be read, a checkpoint that cannot
    if (s%ended%code == exit_input .or. is_first_mesh(s%new%old_end%facts)) stage = 'mesh'
    if (index(s%ended%said, s%stem//'.'//s%ended%from) > 0) stage = 'checkpoint'
    action = refuse(s, next_way(s), 'lagamine: exit code '//to_text(s%ended%code)//' at restart', stage, first_line(s%ended%said))
    action%with_restart = .false.
    if (action%way /= way_anew) return
    ! the scene began anew, and the results with it: they are made again on the mesh before
    action%back = .true.
    action%from = mesh_name(s%new%generation - 1, 'start.h5')
  end function refuse_restart

  !> The mesh reached equilibrium, but failed in its first steps. The old mesh is restored before the row is written: after a kill
  !> in between, the try is made and refused again.
  pure function refuse_first_steps(s) result(action)
    type(situation_t), intent(in) :: s
    type(action_t) :: action
    character(len=:), allocatable :: stage, way

    way = next_way(s)
    stage = s%new%steps_stage
    if (stage == '') stage = 'mesh'
    action = refuse(s, way, 'lagamine: refused on probation', stage, first_line(s%ended%said))
    action%back = .true.
    action%from = mesh_name(s%new%generation - 1, 'end.h5')
    if (way == way_earlier) action%from = mesh_name(s%new%generation - 1, 'end.1.h5')
  end function refuse_first_steps

  pure function refuse(s, way, result, stage, reason) result(action)
    type(situation_t), intent(in) :: s
    character(len=*), intent(in) :: way, result, stage, reason
    type(action_t) :: action

    action = new_action(act_refuse, say='mesh '//to_text(s%new%generation)//'  try '//to_text(s%new%number)//' ('//way// &
                        ') refused, stage '//stage//': '//reason)
    action%way = way
    action%result = result
    action%stage = stage
    action%reason = reason
  end function refuse

end module cycle_refusal
