!> HDF5 files that are whole or not there, and in which only what this program writes is read.
!>
!>     call create_atomic(file, 'NAME.ckp.h5', error)
!>     call file%write(...)
!>     call commit_atomic(file, error, keep_previous=.true.)
!>
!> Every file carries a hash of all its bytes (hdf5_file). `commit_atomic` opens the closed file, whose hash was made by reading it,
!> before it takes the place of the older one; `open_verified` opens a file whose hash is right and in which there is nothing that
!> this program does not write. Hash and structure are two checks: the first finds every accidental change, however HDF5 would read
!> it; the second holds also for a file that was written by another program, with a valid hash.
module hdf5_atomic
  use atomic, only: refuse_place, replace_file, temporary_name
  use errors, only: error_t, exit_bug, exit_machine
  use hdf5_file, only: hdf5_file_t
  use system, only: file_exists, remove_file
  implicit none
  private
  public :: create_atomic, commit_atomic, open_verified

contains

  !> Begin a file that shows under its name `path` only after `commit_atomic`.
  subroutine create_atomic(file, path, error)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error

    call refuse_place(path, error)
    if (.not. allocated(error)) call file%create(temporary_name(path), error)
  end subroutine create_atomic

  !> Close the file, read it back, put it in the place of the older one, which stays as
  !> `previous_name` when `keep_previous`. After any error since `create_atomic` the older file is
  !> untouched, and the new one is gone.
  subroutine commit_atomic(file, error, keep_previous)
    type(hdf5_file_t), intent(inout) :: file
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: keep_previous
    character(len=:), allocatable :: temporary

    temporary = file%path()
    if (.not. is_temporary(temporary)) call file%record_error(exit_bug, 'commit of a file that create_atomic did not begin')
    call file%close(error)
    if (.not. allocated(error)) then
      call verify(temporary, error)
      ! An error here is one of the disk.
      if (allocated(error)) error%code = exit_machine
    end if
    if (.not. allocated(error)) call replace_file(final_name(temporary), error, keep_previous)
    if (allocated(error)) call discard(temporary)
  end subroutine commit_atomic

  !> Open a committed file for reading, unaltered and made of nothing but what this program writes.
  subroutine open_verified(file, path, error)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: ignored

    call file%open(path, error)
    if (allocated(error)) return
    call file%check_structure()
    call file%status(error)
    if (allocated(error)) call file%close(ignored)
  end subroutine open_verified

  !> Is the file as long as it was written, and does HDF5 open it? Its hash was made a moment ago by reading all of it: to read it
  !> once more would find the same bytes in the memory of the system.
  subroutine verify(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file

    call file%open(path, error, hashed=.true.)
    if (.not. allocated(error)) call file%close(error)
  end subroutine verify

  !> Remove a temporary file, and only such a one.
  subroutine discard(path)
    character(len=*), intent(in) :: path
    type(error_t), allocatable :: ignored

    if (is_temporary(path)) then
      if (file_exists(path)) call remove_file(path, ignored)
    end if
  end subroutine discard

  !> Is this a name that `temporary_name` makes?
  pure function is_temporary(path)
    character(len=*), intent(in) :: path
    logical :: is_temporary

    is_temporary = temporary_name(final_name(path)) == path
  end function is_temporary

  !> The inverse of `temporary_name`.
  pure function final_name(path) result(name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name

    name = path(:max(len(path) - len(temporary_name('')), 0))
  end function final_name

end module hdf5_atomic
