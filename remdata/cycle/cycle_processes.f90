!> Services of the system for the script of a cycle: the lock of its folder, and a program that ends when the script ends.
!>
!>     remdata --lock DIR --for PROCESS [--quiet]                by the open file that LAGAMINE_LOCK names; 1: open it again
!>     remdata --start PROCESS SECONDS PROGRAM WORDS...          becomes the program; SECONDS 0: no limit
module cycle_processes
  use arguments, only: argument
  use child_process, only: become_for, nap
  use errors, only: error_t, exit_bug, exit_done, exit_machine, exit_signal, fail
  use folder_lock, only: is_locked, is_replaced, lock_for_cycle
  use kinds, only: wp
  use standard_streams, only: print_line
  use system, only: catch_signals, caught_signal, wall_seconds
  use text, only: string_t
  implicit none
  private
  public :: asks_for_lock, asks_for_start, lock_cycle, start_program

  !> Exit code: the script must open the file again.
  integer, parameter :: exit_again = 1
  !> Programs of an earlier cycle still at work: reported after, waited for at most, checked every so often [s].
  real(wp), parameter :: reported_after = 3.0_wp, longest_wait = 600.0_wp, look_again = 0.1_wp

contains

  function asks_for_lock() result(asks)
    logical :: asks

    asks = word_at(1) == '--lock' .and. command_argument_count() >= 4
  end function asks_for_lock

  function asks_for_start() result(asks)
    logical :: asks

    asks = word_at(1) == '--start' .and. command_argument_count() >= 4
  end function asks_for_start

  !> Lock the folder for the script. Programs that a killed script has left at work end by themselves, and are waited for.
  subroutine lock_cycle(code, error)
    integer, intent(out) :: code
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: folder
    real(wp) :: begun, waited
    integer :: process, state
    logical :: reported

    code = exit_done
    folder = word_at(2)
    call number_at(4, process, error)
    if (allocated(error)) return
    call catch_signals()
    begun = wall_seconds()
    reported = word_at(5) == '--quiet'
    do
      call lock_for_cycle(folder, 'lagacycle', process, state, error)
      if (state == is_replaced) code = exit_again
      if (allocated(error) .or. state == is_locked .or. state == is_replaced) return
      if (caught_signal() > 0) then
        code = exit_signal + caught_signal()
        return
      end if
      waited = wall_seconds() - begun
      if (waited > longest_wait) then
        call fail(error, exit_machine, "what an earlier lagacycle has started in '"//folder//"' is still at work")
        return
      end if
      if (.not. reported .and. waited > reported_after) then
        call print_line("waiting for the end of what an earlier lagacycle has started in '"//folder//"'", error)
        reported = .true.
      end if
      call nap(look_again)
    end do
  end subroutine lock_cycle

  !> Become the program.
  subroutine start_program(error)
    type(error_t), allocatable, intent(out) :: error
    type(string_t) :: words(command_argument_count() - 3)
    integer :: parent, limit, k

    call number_at(2, parent, error)
    if (.not. allocated(error)) call number_at(3, limit, error)
    if (allocated(error)) return
    do k = 1, size(words)
      call argument(k + 3, words(k)%s)
    end do
    call become_for(parent, limit, words, error)
  end subroutine start_program

  !> A word of the command line, '' where there are fewer.
  function word_at(k) result(word)
    integer, intent(in) :: k
    character(len=:), allocatable :: word

    word = ''
    if (command_argument_count() >= k) call argument(k, word)
  end function word_at

  subroutine number_at(k, number, error)
    integer, intent(in) :: k
    integer, intent(out) :: number
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: word
    integer :: status

    number = 0
    word = word_at(k)
    status = 1
    if (word /= '' .and. verify(word, '0123456789') == 0) read (word, *, iostat=status) number
    if (status /= 0) call fail(error, exit_bug, word_at(1)//": expected a whole number, found '"//word//"'")
  end subroutine number_at

end module cycle_processes
