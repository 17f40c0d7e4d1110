!> An error: a message of one line, and the exit code for scripts.
!> An unallocated `error_t` means success; only the mains stop a program.
module errors
  implicit none
  private
  public :: error_t, fail
  public :: exit_done, exit_input, exit_no_convergence, exit_remesh, exit_machine, exit_bug, exit_pilot, exit_signal

  !> Exit codes, the same for every program of the system.
  integer, parameter :: exit_done = 0
  integer, parameter :: exit_input = 2           !! deck, file or option refused
  integer, parameter :: exit_no_convergence = 3  !! smallest step reached; the last good checkpoint is there
  integer, parameter :: exit_remesh = 4          !! a new mesh is due; checkpoint ready
  integer, parameter :: exit_machine = 5         !! disk, memory or a library failed us
  integer, parameter :: exit_bug = 6             !! a check of our own failed
  integer, parameter :: exit_pilot = 7           !! a pilot of ACCURACY is due that lagacycle makes
  integer, parameter :: exit_signal = 128        !! plus the number of the signal

  type :: error_t
    integer :: code = exit_bug
    !> One line: what, where, what was expected (several lines when a deck has several mistakes).
    character(len=:), allocatable :: message
    !> What the user may try next; may be unallocated.
    character(len=:), allocatable :: advice
  end type error_t

contains

  !> Fill `error` with a code and a message written where the cause is known.
  pure subroutine fail(error, code, message, advice)
    type(error_t), allocatable, intent(out) :: error
    integer, intent(in) :: code
    character(len=*), intent(in) :: message
    character(len=*), intent(in), optional :: advice

    allocate (error)
    error%code = code
    error%message = message
    if (present(advice)) error%advice = advice
  end subroutine fail

end module errors
