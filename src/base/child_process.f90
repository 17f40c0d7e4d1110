!> Another program, run as a process of its own and waited for within a limit of time.
!>
!> A crash or an endless loop of it becomes a message and does not end this program. Bindings to the
!> C library of a POSIX system; a status is read as Linux, the BSDs and macOS write it.
module child_process
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_loc, c_long, c_null_char, c_null_ptr, c_ptr
  use errors, only: error_t, exit_machine, exit_signal, fail
  use kinds, only: wp
  use system, only: reason, wall_seconds
  use text, only: string_t, to_text
  implicit none
  private
  public :: ending_t, run_child, own_process, words_for_c, become_for, nap

  !> How a child ended.
  type :: ending_t
    logical :: started = .true.
    !> It took longer than it may, and was ended.
    logical :: late = .false.
    !> Number of the signal that ended it, 0: it ended by itself, with this code.
    integer :: signal = 0, code = 0
  end type ending_t

  type, bind(c) :: timespec_t
    integer(c_long) :: seconds, nanoseconds
  end type timespec_t

  integer(c_int), parameter :: output = 1, errors = 2, signal_kill = 9, no_hang = 1
  !> Exit code of a shell for a program that it cannot start.
  integer(c_int), parameter :: not_started = 127
  !> Interval at which a running child is checked.
  real(wp), parameter :: look_again = 0.005_wp
  integer(c_int), parameter :: mode = int(o'666', c_int)

  interface
    function c_fork() bind(c, name='fork') result(process)
      import :: c_int
      integer(c_int) :: process
    end function c_fork

    function c_getppid() bind(c, name='getppid') result(process)
      import :: c_int
      integer(c_int) :: process
    end function c_getppid

    function c_prctl(option, number) bind(c, name='prctl') result(status)
      import :: c_int, c_long
      integer(c_int), value :: option
      integer(c_long), value :: number
      integer(c_int) :: status
    end function c_prctl

    function c_getpid() bind(c, name='getpid') result(process)
      import :: c_int
      integer(c_int) :: process
    end function c_getpid

    function c_execvp(file, words) bind(c, name='execvp') result(status)
      import :: c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: file(*)
      type(c_ptr), intent(in) :: words(*)
      integer(c_int) :: status
    end function c_execvp

    subroutine c_leave(code) bind(c, name='_exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine c_leave

    function c_alarm(seconds) bind(c, name='alarm') result(left)
      import :: c_int
      integer(c_int), value :: seconds
      integer(c_int) :: left
    end function c_alarm

    function c_creat(path, permissions) bind(c, name='creat') result(descriptor)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: permissions
      integer(c_int) :: descriptor
    end function c_creat

    function c_dup2(from, to) bind(c, name='dup2') result(descriptor)
      import :: c_int
      integer(c_int), value :: from, to
      integer(c_int) :: descriptor
    end function c_dup2

    function c_waitpid(process, status, options) bind(c, name='waitpid') result(ended)
      import :: c_int
      integer(c_int), value :: process, options
      integer(c_int), intent(out) :: status
      integer(c_int) :: ended
    end function c_waitpid

    function c_kill(process, number) bind(c, name='kill') result(status)
      import :: c_int
      integer(c_int), value :: process, number
      integer(c_int) :: status
    end function c_kill

    function c_nanosleep(wanted, left) bind(c, name='nanosleep') result(status)
      import :: c_int, c_ptr, timespec_t
      type(timespec_t), intent(in) :: wanted
      type(c_ptr), value :: left
      integer(c_int) :: status
    end function c_nanosleep
  end interface

contains

  !> Run a program and wait for its end; a name without a slash is looked for as a shell does.
  subroutine run_child(words, said, limit, ending)
    type(string_t), intent(in) :: words(:)   !! (nword) the program and its arguments
    character(len=*), intent(in) :: said     !! file for what it prints
    real(wp), intent(in) :: limit            !! longest time for it [s]
    type(ending_t), intent(out) :: ending
    character(kind=c_char, len=:), allocatable, target :: all_words
    type(c_ptr) :: pointers(size(words) + 1)
    character(kind=c_char, len=:), allocatable :: program_name, file
    integer(c_int) :: process

    call words_for_c(words, all_words, pointers)
    program_name = words(1)%s//c_null_char
    file = said//c_null_char
    process = c_fork()
    if (process == 0) call become(program_name, pointers, file, int(min(limit + 2, 0.5_wp*huge(1)), c_int))
    ending%started = process > 0
    if (ending%started) call wait_for(process, limit, ending)
  end subroutine run_child

  !> Words as C takes the arguments of a program: pointers to their first letters, and one to nothing.
  subroutine words_for_c(words, text, pointers)
    type(string_t), intent(in) :: words(:)                                    !! (nword)
    character(kind=c_char, len=:), allocatable, target, intent(out) :: text   !! holds the letters, and must last
    type(c_ptr), intent(out) :: pointers(:)                                   !! (nword + 1)
    integer :: first, k

    text = ''
    do k = 1, size(words)
      text = text//words(k)%s//c_null_char
    end do
    first = 1
    do k = 1, size(words)
      pointers(k) = c_loc(text(first:first))
      first = first + len(words(k)%s) + 1
    end do
    pointers(size(pointers)) = c_null_ptr
  end subroutine words_for_c

  !> The number of this process, for names of files that no other one uses meanwhile.
  function own_process() result(number)
    integer :: number

    number = int(c_getpid())
  end function own_process

  !> This process becomes another program, for a parent: the system signals it to stop (SIGTERM) when the parent ends, and it does
  !> not begin when the parent has ended already. After `limit` seconds, if there is a limit, the system ends it (SIGALRM). Returns
  !> only with an error.
  subroutine become_for(parent, limit, words, error)
    integer, intent(in) :: parent           !! number of the process that must be there
    integer, intent(in) :: limit            !! [s], 0: none
    type(string_t), intent(in) :: words(:)  !! (words) the program and its arguments
    type(error_t), allocatable, intent(out) :: error
    integer(c_int), parameter :: signal_at_end_of_parent = 1
    integer(c_long), parameter :: signal_terminate = 15
    character(kind=c_char, len=:), allocatable, target :: all_words
    type(c_ptr) :: pointers(size(words) + 1)
    integer(c_int) :: ignored

    ignored = c_prctl(signal_at_end_of_parent, signal_terminate)
    if (c_getppid() /= parent) then
      call fail(error, exit_signal + int(signal_kill), 'process '//to_text(parent)//' has ended: '//words(1)%s//' is not started')
      return
    end if
    if (limit > 0) ignored = c_alarm(int(limit, c_int))
    call words_for_c(words, all_words, pointers)
    ignored = c_execvp(words(1)%s//c_null_char, pointers)
    call fail(error, exit_machine, "cannot start '"//words(1)%s//"': "//reason())
  end subroutine become_for

  !> Do nothing for a while [s].
  subroutine nap(seconds)
    real(wp), intent(in) :: seconds
    integer(c_int) :: ignored

    ignored = c_nanosleep(timespec_t(int(seconds, c_long), int(1.0e9_wp*mod(seconds, 1.0_wp), c_long)), c_null_ptr)
  end subroutine nap

  !> The child's part: it never returns. Should its parent be killed, the alarm ends it.
  subroutine become(program_name, words, said, seconds)
    character(kind=c_char, len=*), intent(in) :: program_name, said
    type(c_ptr), intent(in) :: words(:)
    integer(c_int), intent(in) :: seconds
    integer(c_int) :: descriptor, ignored

    ignored = c_alarm(seconds)
    descriptor = c_creat(said, mode)
    if (descriptor >= 0) then
      ignored = c_dup2(descriptor, output)
      ignored = c_dup2(descriptor, errors)
    end if
    ignored = c_execvp(program_name, words)
    call c_leave(not_started)
  end subroutine become

  subroutine wait_for(process, limit, ending)
    integer(c_int), intent(in) :: process
    real(wp), intent(in) :: limit
    type(ending_t), intent(inout) :: ending
    integer(c_int) :: status, ended, ignored
    real(wp) :: started

    started = wall_seconds()
    do
      ended = c_waitpid(process, status, merge(0_c_int, no_hang, ending%late))
      if (ended == process) exit
      if (ended < 0) then
        ending%started = .false.
        return
      end if
      if (wall_seconds() - started > limit) then
        ending%late = .true.
        ignored = c_kill(process, signal_kill)
      else
        call nap(look_again)
      end if
    end do
    ending%signal = iand(int(status), 127)
    if (ending%signal == 0) ending%code = ibits(int(status), 8, 8)
    ending%started = ending%signal /= 0 .or. ending%code /= not_started
  end subroutine wait_for

end module child_process
