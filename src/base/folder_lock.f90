!> One program at a time writes its results into a folder.
!>
!> The lock is the kernel's, on the file `lagamine.lock` in the folder: it ends with the last process that holds the file open,
!> however that one ends. So there is no stale lock; a file that is left behind by a kill locks nothing. The text of the file
!> (program, process, machine, since when) is for messages alone.
!>
!> `lagacycle` holds the file open, under the number in LAGAMINE_LOCK, for all programs it starts: a process that has inherited the
!> open file has the lock. The kernel decides that, the variable only holds the number of the open file.
module folder_lock
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char, c_size_t
  use child_process, only: nap, own_process
  use errors, only: error_t, exit_machine, fail
  use file_descriptors, only: c_close
  use file_kinds, only: refuse_to_replace, same_file
  use kinds, only: i8, wp
  use system, only: from_environment, join_path, last_failure, reason, remove_file
  use text, only: to_text
  implicit none
  private
  public :: folder_lock_t, lock_folder, unlock_folder, lock_for_cycle
  public :: is_locked, is_replaced, is_left_at_work

  type :: folder_lock_t
    private
    !> Number of the open file; -1: no lock, or an inherited one.
    integer(c_int) :: descriptor = -1
    character(len=:), allocatable :: path
  end type folder_lock_t

  character(len=*), parameter :: lock_name = 'lagamine.lock', inherited_number = 'LAGAMINE_LOCK'

  !> Results of a try to lock a folder for a cycle: done; the file has been removed or replaced since it was opened; programs
  !> that a cycle which is gone has started are still at work.
  integer, parameter :: is_locked = 0, is_replaced = 1, is_left_at_work = 2

  !> Who holds a lock.
  type :: holder_t
    logical :: known = .false.
    integer :: process = 0
    integer(i8) :: started = 0                 !! of the process, in ticks since the machine started
    character(len=64) :: program_name = '', machine = '', day = '', time = ''
  end type holder_t

  interface
    function c_open(path, flags, permissions) bind(c, name='open') result(descriptor)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags, permissions
      integer(c_int) :: descriptor
    end function c_open

    function c_flock(descriptor, operation) bind(c, name='flock') result(status)
      import :: c_int
      integer(c_int), value :: descriptor, operation
      integer(c_int) :: status
    end function c_flock

    function c_truncate(descriptor, length) bind(c, name='ftruncate') result(status)
      import :: c_int, c_size_t
      integer(c_int), value :: descriptor
      integer(c_size_t), value :: length
      integer(c_int) :: status
    end function c_truncate

    function c_write_at(descriptor, bytes, length, offset) bind(c, name='pwrite') result(written)
      import :: c_char, c_int, c_size_t
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: bytes(*)
      integer(c_size_t), value :: length, offset
      integer(c_size_t) :: written
    end function c_write_at
  end interface

contains

  !> Lock a folder that is there for a program, unless it has been, or fail with the name of its holder. A lock inherited from a
  !> cycle is enough.
  subroutine lock_folder(folder, program_name, lock, error)
    character(len=*), intent(in) :: folder, program_name
    type(folder_lock_t), intent(inout) :: lock
    type(error_t), allocatable, intent(out) :: error
    integer(c_int), parameter :: read_and_write = 2, make_it = int(o'100', c_int), permissions = int(o'666', c_int)
    integer(c_int) :: descriptor, ignored
    logical :: locked, kept

    if (lock%descriptor >= 0) return
    lock%path = join_path(folder, lock_name)
    descriptor = inherited()
    if (same_file(lock%path, int(descriptor))) then
      call try_lock(descriptor, lock%path, locked, error)
      if (allocated(error) .or. locked) return
    end if
    call refuse_to_replace(lock%path, error)
    do while (.not. allocated(error))
      descriptor = c_open(lock%path//c_null_char, ior(read_and_write, make_it), permissions)
      if (descriptor < 0) then
        call fail(error, exit_machine, "cannot write '"//lock%path//"': "//reason())
        return
      end if
      call try_lock(descriptor, lock%path, locked, error)
      ! its holder may have removed it meanwhile
      kept = same_file(lock%path, int(descriptor))
      if (locked .and. kept) exit
      ignored = c_close(descriptor)
      if (.not. (locked .or. allocated(error))) call refuse(folder, holder_of(lock%path), error)
    end do
    if (allocated(error)) return
    lock%descriptor = descriptor
    call sign(descriptor, program_name, own_process())
  end subroutine lock_folder

  !> The lock ends, and so does its file.
  subroutine unlock_folder(lock)
    type(folder_lock_t), intent(inout) :: lock
    type(error_t), allocatable :: ignored
    integer(c_int) :: status

    if (lock%descriptor < 0) return
    call remove_file(lock%path, ignored)
    status = c_close(lock%descriptor)
    lock%descriptor = -1
  end subroutine unlock_folder

  !> Lock a folder by the open file that a cycle lends, which keeps the lock. A cycle that is at work there is an error.
  subroutine lock_for_cycle(folder, cycle_name, process, state, error)
    character(len=*), intent(in) :: folder, cycle_name
    integer, intent(in) :: process       !! of the cycle
    integer, intent(out) :: state        !! is_locked, is_replaced or is_left_at_work
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: path
    type(holder_t) :: holder
    integer(c_int) :: descriptor
    logical :: locked

    path = join_path(folder, lock_name)
    state = is_replaced
    call refuse_to_replace(path, error)
    if (allocated(error)) return
    descriptor = inherited()
    if (.not. same_file(path, int(descriptor))) return
    call try_lock(descriptor, path, locked, error)
    if (allocated(error)) return
    if (locked) then
      state = is_locked
      call sign(descriptor, cycle_name, process)
      return
    end if
    state = is_left_at_work
    holder = holder_of(path)
    if (.not. is_gone(holder)) call refuse(folder, holder, error)
  end subroutine lock_for_cycle

  !> Number of the open file that the environment names, -1 where it names none.
  function inherited() result(descriptor)
    integer(c_int) :: descriptor
    character(len=:), allocatable :: word
    integer :: status

    descriptor = -1
    word = from_environment(inherited_number)
    if (word == '' .or. verify(word, '0123456789') > 0) return
    read (word, *, iostat=status) descriptor
    if (status /= 0) descriptor = -1
  end function inherited

  !> Not locked and no error: another process has the lock.
  subroutine try_lock(descriptor, path, locked, error)
    integer(c_int), intent(in) :: descriptor
    character(len=*), intent(in) :: path
    logical, intent(out) :: locked
    type(error_t), allocatable, intent(out) :: error
    integer(c_int), parameter :: exclusive = 2, without_waiting = 4
    integer, parameter :: interrupted = 4, held_by_another = 11

    do
      locked = c_flock(descriptor, ior(exclusive, without_waiting)) == 0
      if (locked) return
      if (last_failure() == held_by_another) return
      if (last_failure() /= interrupted) exit
    end do
    call fail(error, exit_machine, "cannot lock '"//path//"': "//reason(), &
              'results need a file system that has locks: choose another folder with --out')
  end subroutine try_lock

  subroutine refuse(folder, holder, error)
    character(len=*), intent(in) :: folder
    type(holder_t), intent(in) :: holder
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: who

    if (.not. holder%known) then
      call fail(error, exit_machine, "'"//folder//"' is in use by another program")
      return
    end if
    who = trim(holder%program_name)//' (process '//to_text(holder%process)//' on '//trim(holder%machine)//', since ' &
          //trim(holder%day)//' '//trim(holder%time)//')'
    if (is_gone(holder)) then
      call fail(error, exit_machine, "'"//folder//"' is in use by what "//who//' has started, which is gone itself', &
                'its program ends by itself')
    else
      call fail(error, exit_machine, "'"//folder//"' is in use by "//who, 'wait for its end, or choose another folder with --out')
    end if
  end subroutine refuse

  !> Write the holder of the lock into the file. On a full disk this fails, and the lock holds all the same.
  subroutine sign(descriptor, program_name, process)
    integer(c_int), intent(in) :: descriptor
    character(len=*), intent(in) :: program_name
    integer, intent(in) :: process
    character(len=:), allocatable :: line
    character(len=8) :: day
    character(len=10) :: time
    character(len=5) :: zone
    integer(c_int) :: status
    integer(c_size_t) :: written

    call date_and_time(day, time, zone)
    line = program_name//' '//to_text(process)//' '//this_machine()//' '//day(:4)//'-'//day(5:6)//'-'//day(7:)//' ' &
           //time(:2)//':'//time(3:4)//':'//time(5:6)//zone//' '//to_text(start_of(process))//new_line('a')
    status = c_truncate(descriptor, 0_c_size_t)
    if (status == 0) written = c_write_at(descriptor, line, len(line, c_size_t), 0_c_size_t)
  end subroutine sign

  !> The text of the file; it is empty for a moment while the holder writes it.
  function holder_of(path) result(holder)
    character(len=*), intent(in) :: path
    type(holder_t) :: holder
    integer, parameter :: looks = 20
    character(len=200) :: line
    integer :: unit, status, k

    do k = 1, looks
      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      if (status /= 0) return
      read (unit, '(a)', iostat=status) line
      close (unit)
      if (status == 0) read (line, *, iostat=status) holder%program_name, holder%process, holder%machine, holder%day, &
        holder%time, holder%started
      holder%known = status == 0
      if (holder%known) return
      call nap(0.05_wp)
    end do
  end function holder_of

  !> Has the process that signed ended? On another machine, or where it cannot be found out: no.
  function is_gone(holder) result(gone)
    type(holder_t), intent(in) :: holder
    logical :: gone

    gone = holder%known .and. holder%started > 0
    if (gone) gone = holder%machine == this_machine()
    if (gone) gone = holder%started /= start_of(holder%process)
  end function is_gone

  !> When a process was started, in ticks since the machine was: with its number it is unique. 0: there is none (any more).
  function start_of(process) result(ticks)
    integer, intent(in) :: process
    integer(i8) :: ticks
    !> Of the words after the name of its program in brackets: its state first, its start.
    integer, parameter :: place_of_start = 20
    character(len=20) :: words(place_of_start)
    character(len=1000) :: line
    integer :: unit, status

    ticks = 0
    open (newunit=unit, file='/proc/'//to_text(process)//'/stat', status='old', action='read', iostat=status)
    if (status /= 0) return
    read (unit, '(a)', iostat=status) line
    close (unit)
    if (status /= 0) return
    read (line(index(line, ')', back=.true.) + 1:), *, iostat=status) words
    ! a process that has ended and waits for its parent is gone
    if (status == 0 .and. words(1) /= 'Z') read (words(place_of_start), *, iostat=status) ticks
    if (status /= 0) ticks = 0
  end function start_of

  function this_machine() result(name)
    character(len=:), allocatable :: name
    character(len=64) :: line
    integer :: unit, status

    line = ''
    open (newunit=unit, file='/proc/sys/kernel/hostname', status='old', action='read', iostat=status)
    if (status == 0) then
      read (unit, '(a)', iostat=status) line
      close (unit)
      if (status /= 0) line = ''
    end if
    name = trim(line)
    if (name == '') name = 'unknown'
  end function this_machine

end module folder_lock
