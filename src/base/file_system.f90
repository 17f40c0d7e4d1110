!> Files and directories: whether they are there, made, renamed, linked, removed, and on the disk.
module file_system
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  use c_errors, only: reason
  use errors, only: error_t, exit_machine, fail
  use file_descriptors, only: c_close, c_open, read_only
  use file_kinds, only: file_kind, nothing, refuse_to_replace
  use file_paths, only: directory_of
  implicit none
  private
  public :: directory_exists, file_exists, flush_to_disk, link_file, make_directory, remove_file, rename_file

  interface
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

    function c_fsync(descriptor) bind(c, name='fsync') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_fsync
  end interface

contains

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

end module file_system
