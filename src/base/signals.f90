!> Signals: those that ask for an end are recorded, those of a failed write become its error.
module signals
  use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int, c_intptr_t, c_null_funptr
  implicit none
  private
  public :: catch_signals, caught_signal, raise_termination, signals_to_errors

  !> The numbers that POSIX and Linux give to signals.
  integer(c_int), parameter :: signal_interrupt = 2, signal_pipe = 13, signal_terminate = 15, signal_file_size = 25
  !> What stands for a handler that does nothing (SIG_IGN).
  integer(c_intptr_t), parameter :: signal_ignore = 1

  !> The last signal caught, 0 = none. The only mutable variable of a module in the system: a signal
  !> handler is called by the kernel between any two instructions, with the number as its only
  !> argument, so there is no object it could be handed. Volatile, since no code seen by the
  !> compiler changes it.
  integer(c_int), volatile, save :: last_signal = 0

  interface
    function c_raise(number) bind(c, name='raise') result(status)
      import :: c_int
      integer(c_int), value :: number
      integer(c_int) :: status
    end function c_raise

    function c_signal(number, handler) bind(c, name='signal') result(previous)
      import :: c_funptr, c_int
      integer(c_int), value :: number
      type(c_funptr), value :: handler
      type(c_funptr) :: previous
    end function c_signal
  end interface

contains

  !> From now on a reader that goes away (SIGPIPE) and a file that may not grow (SIGXFSZ) are reported by the write that fails.
  subroutine signals_to_errors()
    type(c_funptr) :: previous, ignore

    ignore = transfer(signal_ignore, c_null_funptr)
    previous = c_signal(signal_pipe, ignore)
    previous = c_signal(signal_file_size, ignore)
  end subroutine signals_to_errors

  !> From now on SIGINT and SIGTERM no longer end the program: they are only recorded.
  subroutine catch_signals()
    type(c_funptr) :: previous

    previous = c_signal(signal_interrupt, c_funloc(record_signal))
    previous = c_signal(signal_terminate, c_funloc(record_signal))
  end subroutine catch_signals

  !> The number of the last signal caught, 0 = none.
  function caught_signal() result(number)
    integer :: number

    number = int(last_signal)
  end function caught_signal

  !> TERM to this process, for one that a library has taken for itself: caught, or the end of the program.
  subroutine raise_termination()
    integer(c_int) :: status

    status = c_raise(signal_terminate)
  end subroutine raise_termination

  !> The handler. Recursive: a second signal may arrive inside it, which -fcheck=recursion would
  !> otherwise take for a mistake.
  recursive subroutine record_signal(number) bind(c)
    integer(c_int), value :: number

    last_signal = number
  end subroutine record_signal

end module signals
