!> Memory that this process may still take: by its own limit (RLIMIT_AS, `ulimit -v`), by that of its control group, by what the
!> machine has free. And the end of the program when an allocation is refused all the same.
!>
!> Libraries do not survive a refusal (OpenBLAS asks for its buffer without end), so the memory needed is checked beforehand. The
!> run-time library of gfortran would end the program with a message and a code of its own: its two procedures for that are
!> replaced here, the linker takes the first of a name.
module memory_limits
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_size_t
  use errors, only: error_t, exit_machine, fail
  use kinds, only: i8, wp
  use proc_entries, only: bytes_in
  use standard_streams, only: print_error
  use text, only: to_text
  implicit none
  private
  public :: require_memory, memory_left, megabytes

  real(wp), parameter :: mega = 2.0_wp**20
  !> Memory of small things that is not counted one by one [bytes].
  real(wp), parameter :: reserve = 8*mega

  type, bind(c) :: limit_t
    integer(c_long) :: soft, hard
  end type limit_t

  interface
    function c_getrlimit(resource, limit) bind(c, name='getrlimit') result(status)
      import :: c_int, limit_t
      integer(c_int), value :: resource
      type(limit_t), intent(out) :: limit
      integer(c_int) :: status
    end function c_getrlimit

    subroutine c_leave(code) bind(c, name='_exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine c_leave
  end interface

contains

  !> An error when less memory is left than this and the reserve.
  subroutine require_memory(bytes, purpose, error, address_space)
    real(wp), intent(in) :: bytes            !! that will be written to, perhaps allocated already: counts for machine and group
    character(len=*), intent(in) :: purpose
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(in) :: address_space    !! that will be asked for, of which little may be used: counts for the process
    real(wp) :: left, addresses
    character(len=:), allocatable :: by_what

    call memory_left(left, addresses, by_what)
    if (address_space + reserve > addresses) then
      call refuse(address_space + reserve, addresses, 'by the limit of the process (ulimit -v)')
    else if (bytes + reserve > left) then
      call refuse(bytes + reserve, left, by_what)
    end if

  contains

    subroutine refuse(needed, there, limited)
      real(wp), intent(in) :: needed, there
      character(len=*), intent(in) :: limited

      call fail(error, exit_machine, 'not enough memory for '//purpose//': '//megabytes(needed)//' are needed, ' &
                //megabytes(there)//' are left '//limited, 'use a coarser mesh, fewer threads, or a machine with more memory')
    end subroutine refuse

  end subroutine require_memory

  pure function megabytes(bytes) result(words)
    real(wp), intent(in) :: bytes
    character(len=:), allocatable :: words

    words = to_text(bytes/mega, 3)//' MB'
  end function megabytes

  !> Memory that may still be taken [bytes] and what sets the limit; addresses that may still be asked for, huge without a limit.
  subroutine memory_left(left, addresses, by_what)
    real(wp), intent(out) :: left, addresses
    character(len=:), allocatable, intent(out) :: by_what
    integer(c_int), parameter :: address_space = 9
    type(limit_t) :: limit
    real(wp) :: other, used

    left = huge(left)
    addresses = huge(addresses)
    by_what = 'by no limit'
    call bytes_in('/proc/meminfo', 'MemAvailable', other)
    if (other >= 0) then
      left = other
      by_what = 'on this machine'
    end if
    call number_in('/sys/fs/cgroup/memory.max', other)
    call number_in('/sys/fs/cgroup/memory.current', used)
    if (other >= 0 .and. used >= 0 .and. other - used < left) then
      left = max(other - used, 0.0_wp)
      by_what = 'by the limit of the control group'
    end if
    if (c_getrlimit(address_space, limit) /= 0) return
    call bytes_in('/proc/self/status', 'VmSize', used)
    if (limit%soft >= 0 .and. used >= 0) addresses = max(real(limit%soft, wp) - used, 0.0_wp)
  end subroutine memory_left

  !> The number that a file consists of, -1 where there is none.
  subroutine number_in(file, number)
    character(len=*), intent(in) :: file
    real(wp), intent(out) :: number
    integer(i8) :: value
    integer :: unit, status

    number = -1
    open (newunit=unit, file=file, status='old', action='read', iostat=status)
    if (status /= 0) return
    read (unit, *, iostat=status) value
    if (status == 0) number = real(value, wp)
    close (unit)
  end subroutine number_in

  !> What `allocate` without `stat` calls; `bytes` is the number in the message.
  subroutine allocation_refused(place, message, bytes) bind(c, name='_gfortran_os_error_at')
    character(kind=c_char), intent(in) :: place(*), message(*)
    integer(c_size_t), value :: bytes

    call end_without_memory(message, real(bytes, wp))
  end subroutine allocation_refused

  !> What temporaries of the compiler call (-fcheck=mem).
  subroutine temporary_refused(message) bind(c, name='_gfortran_os_error')
    character(kind=c_char), intent(in) :: message(*)

    call end_without_memory(message, 0.0_wp)
  end subroutine temporary_refused

  !> At once, without the ends of libraries, which may wait for one another.
  subroutine end_without_memory(message, bytes)
    character(kind=c_char), intent(in) :: message(*)
    real(wp), intent(in) :: bytes

    if (message(1) == 'E' .and. bytes > 0) then
      call print_error('not enough memory: '//megabytes(bytes)//' more were asked for and refused')
    else
      call print_error('not enough memory: more was asked for and refused')
    end if
    call c_leave(int(exit_machine, c_int))
  end subroutine end_without_memory

end module memory_limits
