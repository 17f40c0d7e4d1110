!> The files of a mesh generation and of its saved instants: their names, links from the one to the others, and how each comes to
!> its place in one step.
!>
!> An instant that has been saved is never written to again. A kill or a power cut at any moment loses nothing: a file that grows by
!> appending would be lost as a whole, HDF5 keeps no journal.
module instant_files
  use atomic, only: copy_to_temporary, refuse_place, replace_file, temporary_name
  use errors, only: error_t
  use hdf5_file, only: hdf5_file_t
  use system, only: base_name, remove_file
  use text, only: string_t, two_digits
  implicit none
  private
  public :: mesh_path, instants_folder, instant_path
  public :: forget_later_steps, link_instant, begin_file, put_in_place

contains

  !> The file of a mesh generation.
  pure function mesh_path(stem, generation) result(path)
    character(len=*), intent(in) :: stem
    integer, intent(in) :: generation
    character(len=:), allocatable :: path

    path = instants_folder(stem, generation)//'.h5'
  end function mesh_path

  !> Where the instants of a generation lie.
  pure function instants_folder(stem, generation) result(path)
    character(len=*), intent(in) :: stem
    integer, intent(in) :: generation
    character(len=:), allocatable :: path

    path = stem//'.g'//two_digits(generation)
  end function instants_folder

  pure function instant_path(folder, number) result(path)
    character(len=*), intent(in) :: folder, number
    character(len=:), allocatable :: path

    path = folder//'/'//number//'.h5'
  end function instant_path

  !> Take the instants after `step` out of a generation: first their links, then their files. `saved` is the last one that stays.
  subroutine forget_later_steps(path, folder, step, saved, error)
    character(len=*), intent(in) :: path, folder
    integer, intent(in) :: step
    integer, intent(out) :: saved
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(string_t), allocatable :: names(:), paths(:)
    logical, allocatable :: gone(:)
    integer :: k, n, number, status

    saved = -1
    allocate (names(0))
    call file%open(path, error)
    if (allocated(error)) return
    if (file%has('steps')) call file%list('steps', names)
    call file%close(error)
    if (allocated(error)) return
    allocate (gone(size(names)), source=.false.)
    do k = 1, size(names)
      read (names(k)%s, *, iostat=status) number
      if (status /= 0) cycle
      gone(k) = number > step
      if (.not. gone(k)) saved = max(saved, number)
    end do
    if (.not. any(gone)) return
    call copy_to_temporary(path, error)
    if (.not. allocated(error)) call file%open_append(temporary_name(path), error)
    if (allocated(error)) return
    do k = 1, size(names)
      if (gone(k)) call file%remove('steps/'//names(k)%s)
    end do
    allocate (paths(count(gone)))
    n = 0
    do k = 1, size(names)
      if (.not. gone(k)) cycle
      n = n + 1
      paths(n)%s = instant_path(folder, names(k)%s)
    end do
    call put_in_place(file, path, error, unnamed=paths)
  end subroutine forget_later_steps

  !> Enter an instant in the file of its mesh.
  subroutine link_instant(mesh_file, folder, number, error)
    character(len=*), intent(in) :: mesh_file, folder, number
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file

    call copy_to_temporary(mesh_file, error)
    if (.not. allocated(error)) call file%open_append(temporary_name(mesh_file), error)
    if (allocated(error)) return
    call file%remove('steps/'//number)
    call file%link('steps/'//number, base_name(folder)//'/'//number//'.h5')
    call put_in_place(file, mesh_file, error)
  end subroutine link_instant

  !> A new file under the temporary name of `path`.
  subroutine begin_file(file, path, error)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: ignored

    call refuse_place(path, error)
    if (allocated(error)) return
    call file%create(temporary_name(path), error)
    if (allocated(error)) call remove_file(temporary_name(path), ignored)
  end subroutine begin_file

  !> Close a file written under its temporary name and give it its own; after an error the older one is there as it was.
  !> Files `unnamed` are no longer named in it, and are removed.
  subroutine put_in_place(file, path, error, unnamed)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(string_t), intent(in), optional :: unnamed(:)   !! (nfile) paths
    type(error_t), allocatable :: ignored

    call file%close(error)
    if (.not. allocated(error)) call replace_file(path, error, unnamed=unnamed)
    if (allocated(error)) call remove_file(temporary_name(path), ignored)
  end subroutine put_in_place

end module instant_files
