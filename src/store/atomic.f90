!> Files that are whole or not there: written under a temporary name, flushed to the disk, then
!> renamed, so that no reader and no power cut ever meets half a file. For small texts in one call;
!> for HDF5 see `hdf5_atomic`.
module atomic
  use errors, only: error_t, exit_input, exit_machine, fail
  use file_kinds, only: file_kind, kind_in_words, nothing, refuse_to_replace, regular_file
  use kinds, only: i8
  use system, only: directory_of, file_exists, flush_to_disk, link_file, remove_file, rename_file
  use text, only: string_t
  implicit none
  private
  public :: temporary_name, previous_name, refuse_place, replace_file, copy_to_temporary, write_text, read_text

contains

  !> The name under which `path` is written until it is whole.
  pure function temporary_name(path) result(name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name

    name = path//'.tmp'
  end function temporary_name

  !> The name of the one before: `NAME.ckp.h5` -> `NAME.ckp.1.h5`.
  pure function previous_name(path) result(name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name
    integer :: dot

    dot = index(path, '.', back=.true.)
    if (dot <= index(path, '/', back=.true.) + 1) then
      name = path//'.1'
    else
      name = path(:dot - 1)//'.1'//path(dot:)
    end if
  end function previous_name

  !> Can a file be put under the name `path`, by way of its temporary name? Only where regular files are, or nothing.
  subroutine refuse_place(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error

    call refuse_to_replace(path, error)
    if (.not. allocated(error)) call refuse_to_replace(temporary_name(path), error)
  end subroutine refuse_place

  !> Put `temporary_name(path)`, written and closed, in the place of `path`. With `keep_previous`
  !> the older file stays as `previous_name(path)`; a file called `path` is there at every moment.
  !> Files `unnamed` that only the older one names are removed at once: a kill before that would leave them for ever.
  subroutine replace_file(path, error, keep_previous, unnamed)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: keep_previous
    type(string_t), intent(in), optional :: unnamed(:)   !! (nfile) paths
    integer :: k
    logical :: keep

    keep = .false.
    if (present(keep_previous)) keep = keep_previous
    if (keep) keep = file_exists(path)
    call flush_to_disk(temporary_name(path), error)
    if (allocated(error)) return
    if (keep) then
      call keep_as_previous(path, error)
      if (allocated(error)) return
    end if
    call rename_file(temporary_name(path), path, error)
    if (allocated(error)) return
    if (present(unnamed)) then
      do k = 1, size(unnamed)
        call remove_file(unnamed(k)%s, error)
        if (allocated(error)) return
      end do
    end if
    call flush_directory(path)
  end subroutine replace_file

  !> Give the older file its second name, or, on disks without links, move it.
  subroutine keep_as_previous(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error

    call remove_file(previous_name(path), error)
    if (allocated(error)) return
    call link_file(path, previous_name(path), error)
    if (allocated(error)) call rename_file(path, previous_name(path), error)
  end subroutine keep_as_previous

  !> Make the new name itself survive a power cut. Some file systems refuse this for a directory;
  !> the file is whole all the same, so that is no error.
  subroutine flush_directory(path)
    character(len=*), intent(in) :: path
    type(error_t), allocatable :: ignored

    call flush_to_disk(directory_of(path), ignored)
  end subroutine flush_directory

  !> Write `text` as the whole content of the file `path`, in one step that cannot be half done.
  subroutine write_text(path, text, error)
    character(len=*), intent(in) :: path, text
    type(error_t), allocatable, intent(out) :: error

    call write_temporary(path, text, error)
    if (.not. allocated(error)) call replace_file(path, error)
  end subroutine write_text

  !> A copy of the file `path` under its temporary name, to be changed and then put in its place by `replace_file`.
  subroutine copy_to_temporary(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: bytes

    call read_text(path, bytes, error)
    if (.not. allocated(error)) call write_temporary(path, bytes, error)
  end subroutine copy_to_temporary

  !> Write `text` into `temporary_name(path)`; after an error nothing is left of it.
  subroutine write_temporary(path, text, error)
    character(len=*), intent(in) :: path, text
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: ignored
    character(len=200) :: why
    integer(i8) :: length
    integer :: unit, status

    call refuse_place(path, error)
    if (allocated(error)) return
    open (newunit=unit, file=temporary_name(path), status='replace', action='write', access='stream', form='unformatted', &
      iostat=status, iomsg=why)
    if (status /= 0) then
      call fail(error, exit_machine, "cannot write '"//path//"': "//trim(why))
      return
    end if
    write (unit, iostat=status, iomsg=why) text
    close (unit)
    ! gfortran's close does not report a full disk: the length of the file shows it
    if (status == 0) then
      inquire (file=temporary_name(path), size=length)
      status = merge(0, 1, length == len(text, i8))
      why = 'disk full?'
    end if
    if (status /= 0) then
      call remove_file(temporary_name(path), ignored)
      call fail(error, exit_machine, "cannot write '"//path//"': "//trim(why))
    end if
  end subroutine write_temporary

  !> The whole content of the file `path`; '' when it cannot be read.
  subroutine read_text(path, text, error)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: text
    type(error_t), allocatable, intent(out) :: error
    character(len=200) :: why
    integer(i8) :: length
    integer :: kind, unit, status

    text = ''
    kind = file_kind(path)
    if (kind /= nothing .and. kind /= regular_file) then
      ! a pipe would have to be waited for
      call fail(error, exit_input, "cannot read '"//path//"': it is "//kind_in_words(kind)//', expected a regular file')
      return
    end if
    open (newunit=unit, file=path, status='old', action='read', access='stream', form='unformatted', iostat=status, iomsg=why)
    if (status == 0) then
      inquire (unit=unit, size=length)
      deallocate (text)
      allocate (character(len=max(length, 0_i8)) :: text)
      if (length > 0) read (unit, iostat=status, iomsg=why) text
      close (unit)
    end if
    if (status == 0) return
    text = ''
    call fail(error, exit_input, "cannot read '"//path//"': "//trim(why))
  end subroutine read_text

end module atomic
