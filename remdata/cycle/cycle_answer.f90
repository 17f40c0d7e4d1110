!> `remdata --next`: what a cycle does next, for the script that does it: a word and its value on each line.
!>
!>     say TEXT            for the user
!>     error TEXT          for the user too: why the cycle ends, with the exit code of this program
!>     from NAME           checkpoint to begin with, as its name ends (ckp.h5, g01.end.h5)
!>     new NAME            file for the new mesh, the same way
!>     sizes NAME          checkpoint of the run whose errors the new mesh is made by, the same way
!>     transfer N          options of the remesher
!>     finer F
!>     mesher free
!>     option WORD         of the solver
!>     do WORD             start, check, resume, remesh or end: comes last
module cycle_answer
  use cycle_action, only: act_check, act_end, act_refuse, act_remesh, act_resume, act_start, action_t, is_inner
  use cycle_bookkeeping, only: carry_out
  use cycle_decision, only: next_action
  use cycle_folder, only: read_situation, seen_files_t
  use cycle_options, only: cycle_options_t, read_cycle_options
  use cycle_situation, only: ended_known, situation_t
  use errors, only: error_t, exit_bug, exit_done, fail
  use standard_streams, only: print_line
  use text, only: to_text
  implicit none
  private
  public :: answer_next

  !> More inner actions one after the other than there are kinds of them: the decisions repeat themselves.
  integer, parameter :: most_in_a_row = 12

contains

  !> Read the folder, decide and do the inner actions, until there is an action for the script.
  subroutine answer_next(code, error)
    integer, intent(out) :: code   !! with which the cycle ends; 0: it goes on, or is done
    type(error_t), allocatable, intent(out) :: error
    type(cycle_options_t) :: options
    type(seen_files_t) :: seen
    type(situation_t) :: situation
    type(action_t) :: action
    character(len=:), allocatable :: line
    integer :: k

    code = exit_done
    call read_cycle_options(options, error)
    do k = 1, most_in_a_row
      if (allocated(error)) return
      call read_situation(options, seen, situation, error)
      if (allocated(error)) return
      action = next_action(situation)
      call carry_out(situation, action, line, error)
      if (allocated(error)) return
      if (line /= '') call print_word('say', line, error)
      ! the end of the program has been dealt with
      if (action%kind == act_refuse) options%ended%program = ended_known
      if (is_inner(action)) cycle
      if (allocated(action%error)) then
        code = action%error%code
        call print_refusal(action%error, error)
      else
        call print_action(action, error)
      end if
      return
    end do
    call fail(error, exit_bug, options%stem//': the same is done over and over (action '//to_text(action%kind)//')')
  end subroutine answer_next

  subroutine print_action(action, error)
    type(action_t), intent(in) :: action
    type(error_t), allocatable, intent(inout) :: error

    if (action%from /= '') call print_word('from', action%from, error)
    if (action%new /= '') call print_word('new', action%new, error)
    if (action%sizes /= '') call print_word('sizes', action%sizes, error)
    if (action%transfer >= 0) call print_word('transfer', to_text(action%transfer), error)
    if (action%finer > 0) call print_word('finer', to_text(action%finer), error)
    if (action%without_zones) call print_word('mesher', 'free', error)
    if (action%force_agreed) call print_word('option', '--agreed', error)
    select case (action%kind)
    case (act_start)
      call print_word('do', 'start', error)
    case (act_check)
      call print_word('do', 'check', error)
    case (act_resume)
      call print_word('do', 'resume', error)
    case (act_remesh)
      call print_word('do', 'remesh', error)
    case (act_end)
      call print_word('do', 'end', error)
    end select
  end subroutine print_action

  !> Why the cycle ends: a word for each line.
  subroutine print_refusal(refusal, error)
    type(error_t), intent(in) :: refusal
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: rest
    integer :: last

    rest = refusal%message//new_line('a')
    if (allocated(refusal%advice)) rest = rest//refusal%advice//new_line('a')
    do while (len(rest) > 0)
      last = index(rest, new_line('a'))
      call print_word('error', rest(:last - 1), error)
      rest = rest(last + 1:)
    end do
  end subroutine print_refusal

  subroutine print_word(word, its_value, error)
    character(len=*), intent(in) :: word, its_value
    type(error_t), allocatable, intent(inout) :: error

    call print_line(word//' '//its_value, error)
  end subroutine print_word

end module cycle_answer
