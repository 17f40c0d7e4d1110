!> The actions a cycle may take next, and their constructors.
module cycle_action
  use cycle_situation, only: checkpoint_file_t
  use errors, only: error_t, fail
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: action_t, new_action, give_up, is_inner, place_of
  public :: act_start, act_check, act_resume, act_remesh, act_end
  public :: act_roll_back, act_keep_end, act_accept, act_refuse, act_keep_old_mesh

  !> For the script: the solver from the beginning, its check of a checkpoint, the solver from a checkpoint, the remesher, the end.
  integer, parameter :: act_start = 1, act_check = 2, act_resume = 3, act_remesh = 4, act_end = 5
  !> Inner: the checkpoint before replaces one that is not whole; the checkpoint at which the old mesh stops is kept; a new mesh is
  !> entered in the table; a refused try is entered; the continuation of the old mesh is entered.
  integer, parameter :: act_roll_back = 6, act_keep_end = 7, act_accept = 8, act_refuse = 9, act_keep_old_mesh = 10

  type :: action_t
    integer :: kind = act_end
    !> Checkpoint to begin with, and file for the new mesh, as their names end; '' for none.
    character(len=:), allocatable :: from, new
    !> Checkpoint of a run on a first mesh that is made again, as its name ends; '' for none.
    character(len=:), allocatable :: sizes
    !> In place of the deck's: method of transfer (negative: the deck's), divisor of sizes (0: none).
    integer :: transfer = -1
    real(wp) :: finer = 0.0_wp
    !> The free mesher, whatever zones the deck has.
    logical :: without_zones = .false.
    !> The solver need not refuse the mesh by the force of a die.
    logical :: force_agreed = .false.
    !> For the user; '' for nothing.
    character(len=:), allocatable :: say
    !> Of a try: the way it was made; of a refused one also its result, the responsible stage, and the reason.
    character(len=:), allocatable :: way, result, stage, reason
    !> The measures of the restart on it belong in its row.
    logical :: with_restart = .true.
    !> A refused mesh is in the run's checkpoint: the old one is restored.
    logical :: back = .false.
    !> Why the cycle failed.
    type(error_t), allocatable :: error
  end type action_t

contains

  pure function new_action(kind, from, new, say) result(action)
    integer, intent(in) :: kind
    character(len=*), intent(in), optional :: from, new, say
    type(action_t) :: action

    action%kind = kind
    action%from = ''
    action%new = ''
    action%sizes = ''
    action%say = ''
    if (present(from)) action%from = from
    if (present(new)) action%new = new
    if (present(say)) action%say = say
    action%way = ''
    action%result = ''
    action%stage = ''
    action%reason = ''
  end function new_action

  pure function give_up(code, message, advice) result(action)
    integer, intent(in) :: code
    character(len=*), intent(in) :: message
    character(len=*), intent(in), optional :: advice
    type(action_t) :: action

    action = new_action(act_end)
    call fail(action%error, code, message, advice)
  end function give_up

  !> Only the folder changes; decide again.
  pure function is_inner(action)
    type(action_t), intent(in) :: action
    logical :: is_inner

    is_inner = action%kind > act_end
  end function is_inner

  !> Instant of a checkpoint, for messages.
  pure function place_of(file) result(words)
    type(checkpoint_file_t), intent(in) :: file
    character(len=:), allocatable :: words

    words = 'step '//to_text(file%facts%step)//', time '//to_text(file%facts%time)
  end function place_of

end module cycle_action
