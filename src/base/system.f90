!> System services that Fortran lacks: directories, signals, the terminal, memory, the disk.
!> Thin bindings to the C library of a POSIX system (errno is found as glibc and musl keep it).
module system
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_funloc, c_funptr, c_int, c_intptr_t, &
    c_long, c_null_char, c_null_funptr, c_ptr, c_size_t
  use errors, only: error_t, exit_machine, fail
  use file_kinds, only: file_kind, nothing, refuse_to_replace
  use kinds, only: i8, wp
  implicit none
  private
  public :: is_terminal, peak_memory_mb, cpu_seconds, wall_seconds
  public :: file_exists, directory_exists, make_directory, rename_file, link_file, remove_file, flush_to_disk
  public :: base_name, directory_of, join_path
  public :: catch_signals, caught_signal, raise_termination, signals_to_errors, program_stop, reason, last_failure
  public :: set_environment, in_environment, from_environment, text_of_c

  !> The numbers POSIX gives to the two requests to stop.
  integer(c_int), parameter :: signal_interrupt = 2, signal_pipe = 13, signal_terminate = 15, signal_file_size = 25
  !> What stands for a handler that does nothing (SIG_IGN).
  integer(c_intptr_t), parameter :: signal_ignore = 1

  !> The last signal caught, 0 = none. The only mutable variable of a module in the system: a signal
  !> handler is called by the kernel between any two instructions, with the number as its only
  !> argument, so there is no object it could be handed. Volatile, since no code seen by the
  !> compiler changes it.
  integer(c_int), volatile, save :: last_signal = 0

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

    function c_mkdir(path, mode) bind(c, name='mkdir') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
      integer(c_int) :: status
    end function c_mkdir

    function c_rename(from, to) bind(c, name='rename') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: from(*), to(*)
      integer(c_int) :: status
    end function c_rename

    function c_link(from, to) bind(c, name='link') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: from(*), to(*)
      integer(c_int) :: status
    end function c_link

    function c_unlink(path) bind(c, name='unlink') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int) :: status
    end function c_unlink

    function c_open(path, flags) bind(c, name='open') result(descriptor)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags
      integer(c_int) :: descriptor
    end function c_open

    function c_fsync(descriptor) bind(c, name='fsync') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_fsync

    function c_close(descriptor) bind(c, name='close') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_close

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

    function c_setenv(name, value, overwrite) bind(c, name='setenv') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: name(*), value(*)
      integer(c_int), value :: overwrite
      integer(c_int) :: status
    end function c_setenv

    subroutine c_exit(code) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: code
    end subroutine c_exit

    function c_errno() bind(c, name='__errno_location') result(address)
      import :: c_ptr
      type(c_ptr) :: address
    end function c_errno

    function c_strerror(number) bind(c, name='strerror') result(address)
      import :: c_int, c_ptr
      integer(c_int), value :: number
      type(c_ptr) :: address
    end function c_strerror

    function c_strlen(address) bind(c, name='strlen') result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: address
      integer(c_size_t) :: length
    end function c_strlen
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
    character(len=256) :: line
    type(usage_t) :: usage
    integer :: unit, status
    integer(i8) :: kilobytes

    megabytes = 0
    open (newunit=unit, file='/proc/self/status', status='old', action='read', iostat=status)
    if (status == 0) then
      do
        read (unit, '(a)', iostat=status) line
        if (status /= 0) exit
        if (line(:6) /= 'VmHWM:') cycle
        read (line(7:), *, iostat=status) kilobytes
        if (status == 0) megabytes = real(kilobytes, wp)/1024
        exit
      end do
      close (unit)
    end if
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

  !> Is there anything (a file, a directory) under this name?
  function file_exists(path) result(exists)
    character(len=*), intent(in) :: path
    logical :: exists

    inquire (file=path, exist=exists)
  end function file_exists

  !> Is there a directory under this name?
  function directory_exists(path) result(exists)
    character(len=*), intent(in) :: path
    logical :: exists

    inquire (file=path//'/.', exist=exists)
  end function directory_exists

  !> Make a directory and those above it; one that is there already is fine.
  recursive subroutine make_directory(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: above, why

    if (directory_exists(path)) return
    above = directory_of(path)
    if (len(above) < len(path)) then
      call make_directory(above, error)
      if (allocated(error)) return
    end if
    if (c_mkdir(path//c_null_char, int(o'777', c_int)) == 0) return
    why = reason()
    ! Another process, or a name such as 'out/.', may have made it meanwhile.
    if (directory_exists(path)) return
    call fail(error, exit_machine, "cannot make the directory '"//path//"': "//why)
  end subroutine make_directory

  !> Give a file another name; a regular file that has that name is replaced, in one step that cannot be half done.
  subroutine rename_file(from, to, error)
    character(len=*), intent(in) :: from, to
    type(error_t), allocatable, intent(out) :: error

    call refuse_to_replace(to, error)
    if (allocated(error)) return
    if (c_rename(from//c_null_char, to//c_null_char) /= 0) &
      call fail(error, exit_machine, "cannot rename '"//from//"' to '"//to//"': "//reason())
  end subroutine rename_file

  !> Give a file a second name (hard link); `to` must be free, and in the same file system.
  subroutine link_file(from, to, error)
    character(len=*), intent(in) :: from, to
    type(error_t), allocatable, intent(out) :: error

    if (c_link(from//c_null_char, to//c_null_char) /= 0) &
      call fail(error, exit_machine, "cannot link '"//from//"' to '"//to//"': "//reason())
  end subroutine link_file

  !> Remove a regular file; one that is not there is fine.
  subroutine remove_file(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error

    if (file_kind(path, itself=.true.) == nothing) return
    call refuse_to_replace(path, error)
    if (allocated(error)) return
    if (c_unlink(path//c_null_char) /= 0) call fail(error, exit_machine, "cannot remove '"//path//"': "//reason())
  end subroutine remove_file

  !> Wait until a file (or the entries of a directory) is on the disk and would survive a power cut.
  subroutine flush_to_disk(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    integer(c_int), parameter :: read_only = 0
    integer(c_int) :: descriptor, status, ignored
    character(len=:), allocatable :: why

    descriptor = c_open(path//c_null_char, read_only)
    if (descriptor < 0) then
      call fail(error, exit_machine, "cannot open '"//path//"' to flush it: "//reason())
      return
    end if
    status = c_fsync(descriptor)
    if (status /= 0) why = reason()
    ignored = c_close(descriptor)
    if (status /= 0) call fail(error, exit_machine, "cannot flush '"//path//"' to the disk: "//why)
  end subroutine flush_to_disk

  !> Cut a path at its last slash: `directory` ('.' when there is none) and `name`.
  pure subroutine split_path(path, directory, name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: directory, name
    integer :: slash

    slash = index(path, '/', back=.true.)
    name = path(slash + 1:)
    if (slash == 0) then
      directory = '.'
    else
      directory = path(:max(slash - 1, 1))
    end if
  end subroutine split_path

  !> What follows the last slash.
  pure function base_name(path) result(name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name, directory

    call split_path(path, directory, name)
  end function base_name

  !> What stands before the last slash, '.' when there is none.
  pure function directory_of(path) result(directory)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: directory, name

    call split_path(path, directory, name)
  end function directory_of

  !> `name` seen from `directory`; an absolute name stays as it is.
  pure function join_path(directory, name) result(path)
    character(len=*), intent(in) :: directory, name
    character(len=:), allocatable :: path

    path = name
    if (index(name, '/') == 1 .or. directory == '' .or. directory == '.') return
    path = directory//'/'//name
    if (directory(len(directory):) == '/') path = directory//name
  end function join_path

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

  !> Is there a variable of one of these names, be it empty?
  function in_environment(names) result(is_set)
    character(len=*), intent(in) :: names(:)   !! (nname)
    logical :: is_set
    integer :: k, status

    is_set = .false.
    do k = 1, size(names)
      call get_environment_variable(trim(names(k)), status=status)
      is_set = is_set .or. status /= 1
    end do
  end function in_environment

  !> The value of a variable, '' where there is none.
  function from_environment(name) result(value)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: value
    integer :: length

    call get_environment_variable(name, length=length)
    allocate (character(len=length) :: value)
    if (length > 0) call get_environment_variable(name, value)
  end function from_environment

  !> Set a variable of the environment of this process, unless it is set and `overwrite` is false.
  subroutine set_environment(name, value, error, overwrite)
    character(len=*), intent(in) :: name, value
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: overwrite
    integer(c_int) :: replace

    replace = 1
    if (present(overwrite)) replace = merge(1_c_int, 0_c_int, overwrite)
    if (c_setenv(name//c_null_char, value//c_null_char, replace) /= 0) &
      call fail(error, exit_machine, 'cannot set the environment variable '//name//': '//reason())
  end subroutine set_environment

  !> End the program with an exit code and without a message, which `stop` cannot do in Fortran 2008.
  subroutine program_stop(code)
    integer, intent(in) :: code

    call c_exit(int(code, c_int))
  end subroutine program_stop

  !> Why the last call to the C library failed: the system's number.
  function last_failure() result(number)
    integer :: number
    integer(c_int), pointer :: kept

    call c_f_pointer(c_errno(), kept)
    number = int(kept)
  end function last_failure

  !> The same in the system's words.
  function reason() result(words)
    character(len=:), allocatable :: words

    words = text_of_c(c_strerror(int(last_failure(), c_int)))
    if (words == '') words = 'unknown reason'
  end function reason

  !> The text that C keeps at an address, '' where there is none.
  function text_of_c(address) result(words)
    type(c_ptr), intent(in) :: address
    character(len=:), allocatable :: words
    character(kind=c_char), pointer :: letters(:)
    integer :: i

    words = ''
    if (.not. c_associated(address)) return
    call c_f_pointer(address, letters, [c_strlen(address)])
    words = repeat(' ', size(letters))
    do i = 1, size(letters)
      words(i:i) = letters(i)
    end do
  end function text_of_c

end module system
