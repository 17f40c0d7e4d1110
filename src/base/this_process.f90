!> This process: its terminal, its memory, its time, and its end.
module this_process
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: i8, wp
  use proc_entries, only: bytes_in
  implicit none
  private
  public :: cpu_seconds, is_terminal, peak_memory_mb, program_stop, wall_seconds

  !> `struct rusage` of 64-bit Unix: two times (seconds, microseconds), then fourteen long integers.
  type, bind(c) :: usage_t
    integer(c_long) :: times(4)
    integer(c_long) :: peak_resident
    integer(c_long) :: others(13)
  end type usage_t

  interface
    function c_isatty(descriptor) bind(c, name='isatty') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_isatty

    function c_getrusage(who, usage) bind(c, name='getrusage') result(status)
      import :: c_int, usage_t
      integer(c_int), value :: who
      type(usage_t), intent(out) :: usage
      integer(c_int) :: status
    end function c_getrusage

    subroutine c_exit(code) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine c_exit
  end interface

contains

  !> Is the file descriptor (0 input, 1 output, 2 errors) a terminal?
  function is_terminal(unit_fd) result(terminal)
    integer, intent(in) :: unit_fd
    logical :: terminal

    terminal = c_isatty(int(unit_fd, c_int)) == 1
  end function is_terminal

  !> Largest resident memory of this process so far, in megabytes (2**20 bytes); 0 where unknown.
  !> Linux's own figure first: getrusage's also counts what the process was before exec.
  function peak_memory_mb() result(megabytes)
    real(wp) :: megabytes
    type(usage_t) :: usage

    call bytes_in('/proc/self/status', 'VmHWM', megabytes)
    megabytes = max(megabytes, 0.0_wp)/2**20
    if (megabytes > 0) return
    if (c_getrusage(0_c_int, usage) == 0) megabytes = real(usage%peak_resident, wp)/1024
  end function peak_memory_mb

  !> Processor time of this process, all its threads together, in seconds.
  function cpu_seconds() result(seconds)
    real(wp) :: seconds

    call cpu_time(seconds)
  end function cpu_seconds

  !> Time on the wall in seconds from an origin that is fixed while the program runs.
  function wall_seconds() result(seconds)
    real(wp) :: seconds
    integer(i8) :: ticks, rate

    call system_clock(ticks, rate)
    seconds = real(ticks, wp)/real(rate, wp)
  end function wall_seconds

  !> End the program with an exit code and without a message, which `stop` cannot do in Fortran 2008.
  subroutine program_stop(code)
    integer, intent(in) :: code

    call c_exit(int(code, c_int))
  end subroutine program_stop

end module this_process
