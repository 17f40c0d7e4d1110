!> What libraries read from the environment when they are loaded, before the program begins, is set, and the program then replaces
!> itself: the same process with the same arguments and files, as `exec` does. Called before anything is read or written.
!>
!> A variable that the user has set stays as it is. What is set here is found set the second time, so there is no third.
module start_again
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char, c_ptr, c_size_t
  use arguments, only: argument
  use blas_core, only: core_to_ask_for
  use child_process, only: words_for_c
  use errors, only: error_t
  use processors, only: processor_flags
  use system, only: from_environment, in_environment, set_environment
  use text, only: string_t
  implicit none
  private
  public :: start_as_fits

  !> Rounds of waiting before a thread goes to sleep (libgomp; others know sleep only): 0.1 to 0.5 ms, where libgomp's own 300000
  !> take 3 to 15 ms, all of it kept from those that are waited for when the machine has other work too.
  character(len=*), parameter :: rounds_of_waiting = '10000'

  !> Variable that holds the core of OpenBLAS asked for here; OpenBLAS's own variable.
  character(len=*), parameter :: asked_here = 'LAGAMINE_BLAS_CORE', core_setting = 'OPENBLAS_CORETYPE'

  interface
    function c_readlink(path, target_path, length) bind(c, name='readlink') result(read_length)
      import :: c_char, c_size_t
      character(kind=c_char), intent(in) :: path(*)
      integer(c_size_t), value :: length
      character(kind=c_char), intent(out) :: target_path(length)
      integer(c_size_t) :: read_length
    end function c_readlink

    function c_execv(path, words) bind(c, name='execv') result(status)
      import :: c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(in) :: words(*)
      integer(c_int) :: status
    end function c_execv
  end interface

contains

  !> Start again if the libraries need other settings; returns when they do not, or when it is not possible.
  subroutine start_as_fits(threads, blas_core)
    integer, intent(in) :: threads               !! the most there will be
    character(len=*), intent(in) :: blas_core    !! kernels that OpenBLAS has picked, '' where it is not there
    character(len=:), allocatable :: core
    logical :: again, settled

    again = .false.
    settled = in_environment([character(len=15) :: 'OMP_WAIT_POLICY', 'GOMP_SPINCOUNT'])
    if (threads > 1 .and. .not. settled) then
      call put('OMP_WAIT_POLICY', 'passive', again)
      call put('GOMP_SPINCOUNT', rounds_of_waiting, again)
    end if
    call better_core(blas_core, core)
    if (core /= '') then
      call put(core_setting, core, again)
      call put(asked_here, core, again)
    end if
    if (.not. again) return
    ! OpenBLAS's threads are not used (module blas), but they would be started, and wait for a while at work.
    settled = in_environment(['OPENBLAS_NUM_THREADS'])
    if (.not. settled) call put('OPENBLAS_NUM_THREADS', '1', again)
    if (again) call take_own_place()
  end subroutine start_as_fits

  !> The core to ask for, '' = none: the present one is good, or the user has chosen.
  subroutine better_core(present_core, core)
    character(len=*), intent(in) :: present_core
    character(len=:), allocatable, intent(out) :: core
    character(len=:), allocatable :: asked, set, flags

    core = ''
    asked = from_environment(asked_here)
    set = from_environment(core_setting)
    if (present_core == '' .or. set /= asked) return
    call processor_flags(flags)
    core = core_to_ask_for(present_core, asked, flags)
  end subroutine better_core

  !> Set a variable; where that fails the program goes on as it was started.
  subroutine put(name, value, again)
    character(len=*), intent(in) :: name, value
    logical, intent(out) :: again
    type(error_t), allocatable :: error

    call set_environment(name, value, error)
    again = .not. allocated(error)
  end subroutine put

  !> Returns only where the system has no /proc or the program's file is gone.
  subroutine take_own_place()
    character(kind=c_char, len=:), allocatable, target :: text
    character(kind=c_char, len=4096) :: path
    type(string_t) :: words(command_argument_count() + 1)
    type(c_ptr) :: pointers(size(words) + 1)
    integer :: k
    integer(c_size_t) :: length
    integer(c_int) :: ignored

    length = c_readlink('/proc/self/exe'//c_null_char, path, len(path, c_size_t) - 1)
    if (length < 1 .or. length >= len(path, c_size_t) - 1) return
    path(length + 1:) = c_null_char
    do k = 1, size(words)
      call argument(k - 1, words(k)%s)
    end do
    call words_for_c(words, text, pointers)
    ignored = c_execv(path, pointers)
  end subroutine take_own_place

end module start_again
