!> Opening, closing, groups and names of HDF5 files.
submodule(hdf5_file) hdf5_file_access
  use hdf5, only: h5_index_name_f, h5_iter_inc_f, h5dont_atexit_f, h5eset_auto_f, h5f_acc_rdonly_f, h5f_acc_rdwr_f, &
    h5f_acc_trunc_f, h5f_close_strong_f, h5f_libver_latest_f, h5f_libver_v18_f, h5f_scope_local_f, h5fclose_f, h5fcreate_f, &
    h5fflush_f, h5fopen_f, h5gcreate_f, h5gn_members_f, h5iis_valid_f, h5lcreate_external_f, h5ldelete_f, h5lexists_f, &
    h5lget_name_by_idx_f, h5oclose_f, h5oopen_f, h5open_f, h5p_dataset_create_f, h5p_file_access_f, h5p_file_create_f, &
    h5p_group_create_f, h5pclose_f, h5pcreate_f, h5pset_attr_phase_change_f, &
    h5pset_fclose_degree_f, h5pset_libver_bounds_f, h5pset_link_phase_change_f, h5pset_obj_track_times_f, h5pset_userblock_f, &
    h5s_scalar_f, h5sclose_f, h5screate_f, h5t_native_double, hsize_t
  use errors, only: exit_bug, exit_input, exit_machine, fail
  use system, only: set_environment
  implicit none

  !> Links or attributes of a group from which on HDF5 keeps them in a tree of their own; it allows no more.
  integer, parameter :: most_in_header = 65535

contains

  module procedure create
    integer(hid_t) :: access, creation
    integer :: flag(4)

    call begin(self, path, .true.)
    call make_access(access)
    call h5pcreate_f(h5p_file_create_f, creation, flag(2))
    call h5pset_userblock_f(creation, int(user_block_length, hsize_t), flag(3))
    call set_compact(creation)
    call h5fcreate_f(path, h5f_acc_trunc_f, self%id, flag(1), creation_prp=creation, access_prp=access)
    call h5pclose_f(creation, flag(4))
    call h5pclose_f(access, flag(4))
    if (flag(1) /= 0) then
      self%id = closed
      call self%record_error(exit_machine, 'cannot be made (no such directory, no permission, or open elsewhere)')
    else
      call make_properties(self)
    end if
    call self%status(error)
  end procedure create

  module procedure open_to_read
    logical :: known

    known = .false.
    if (present(hashed)) known = hashed
    call begin(self, path, .false.)
    call open_existing(self, known)
    call self%status(error)
  end procedure open_to_read

  module procedure open_append
    call begin(self, path, .true.)
    call open_existing(self, .false.)
    call self%status(error)
  end procedure open_append

  !> Open the file at `self%file_path`, or record why it is refused.
  subroutine open_existing(self, hashed)
    class(hdf5_file_t), intent(inout) :: self
    logical, intent(in) :: hashed   !! its hash was made by reading it, a moment ago
    integer(hid_t) :: access
    integer :: flag, ignored

    call self%check_hash(length_alone=hashed)
    if (self%failed()) return
    call make_access(access)
    call h5fopen_f(self%file_path, merge(h5f_acc_rdwr_f, h5f_acc_rdonly_f, self%writable), self%id, flag, access_prp=access)
    call h5pclose_f(access, ignored)
    if (flag /= 0) then
      self%id = closed
      call self%record_error(exit_input, 'HDF5 cannot open it (no permission, or a damaged file)')
    else if (self%writable) then
      call make_properties(self)
    end if
  end subroutine open_existing

  !> Clear the object, and start the library.
  subroutine begin(self, path, writable)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    logical, intent(in) :: writable
    type(error_t), allocatable :: ignored

    if (self%id /= closed) call self%close(ignored)
    if (allocated(self%first_error)) deallocate (self%first_error)
    self%file_path = path
    self%writable = writable
    call start_library()
  end subroutine begin

  !> Start HDF5 once (each further h5open_f would leak its type handles), silence its own error
  !> printing, and do without file locks: they fail on some network disks, and a run must not stop
  !> because another program reads its results. The user's own setting of the variable prevails.
  !> HDF5's own closing of what is left at the end of the program is turned off too: after a failed
  !> write it crashes (1.10.8), and the exit code is lost.
  subroutine start_library()
    type(error_t), allocatable :: ignored
    integer :: flag
    logical :: started

    call set_environment('HDF5_USE_FILE_LOCKING', 'FALSE', ignored, overwrite=.false.)
    call h5dont_atexit_f(flag)
    call h5iis_valid_f(h5t_native_double, started, flag)
    if (flag /= 0 .or. .not. started) call h5open_f(flag)
    call h5eset_auto_f(0, flag)
  end subroutine start_library

  !> Access properties: closing the file closes all that is open in it. The format is that of HDF5 1.8, whose groups and attributes
  !> take a third of the room and of the time of the first one.
  subroutine make_access(access)
    integer(hid_t), intent(out) :: access
    integer :: flag

    call h5pcreate_f(h5p_file_access_f, access, flag)
    call h5pset_fclose_degree_f(access, h5f_close_strong_f, flag)
    call h5pset_libver_bounds_f(access, h5f_libver_v18_f, h5f_libver_latest_f, flag)
  end subroutine make_access

  !> Groups keep their links and attributes in their header, whatever their number, and no times.
  subroutine set_compact(properties)
    integer(hid_t), intent(in) :: properties   !! for groups, or for a file: those of its root
    integer :: flag

    call h5pset_link_phase_change_f(properties, most_in_header, most_in_header, flag)
    call h5pset_attr_phase_change_f(properties, most_in_header, most_in_header, flag)
    call h5pset_obj_track_times_f(properties, .false., flag)
  end subroutine set_compact

  !> What is made once for all objects of a file. HDF5 refuses the handle of whatever could not be made where it is used.
  subroutine make_properties(self)
    class(hdf5_file_t), intent(inout) :: self
    integer :: flag

    call h5pcreate_f(h5p_group_create_f, self%group_properties, flag)
    call set_compact(self%group_properties)
    call h5pcreate_f(h5p_dataset_create_f, self%dataset_properties, flag)
    call h5pset_obj_track_times_f(self%dataset_properties, .false., flag)
    call h5screate_f(h5s_scalar_f, self%single_value, flag)
  end subroutine make_properties

  subroutine close_properties(self)
    class(hdf5_file_t), intent(inout) :: self
    integer :: flag

    if (self%group_properties == closed) return
    call h5pclose_f(self%group_properties, flag)
    call h5pclose_f(self%dataset_properties, flag)
    call h5sclose_f(self%single_value, flag)
    self%group_properties = closed
  end subroutine close_properties

  module procedure open_object
    integer(hid_t) :: object
    integer :: flag

    if (self%object /= closed) then
      if (self%object_path == path) return
    end if
    call h5oopen_f(self%id, path, object, flag)
    if (flag /= 0) object = closed
    call self%keep_object(path, object)
  end procedure open_object

  module procedure keep_object
    integer :: flag

    if (self%object /= closed) call h5oclose_f(self%object, flag)
    self%object = object
    self%object_path = path
  end procedure keep_object

  module procedure close_file
    integer :: flag(2)

    if (self%id /= closed) then
      flag = 0
      call self%keep_object('', closed)
      call close_properties(self)
      if (self%writable) call h5fflush_f(self%id, h5f_scope_local_f, flag(1))
      call h5fclose_f(self%id, flag(2))
      self%id = closed
      if (any(flag /= 0)) call self%record_error(exit_machine, 'writing failed at the closing of the file (disk full?)')
      if (self%writable) call self%write_hash()
    end if
    call self%status(error)
    if (allocated(self%first_error)) deallocate (self%first_error)
  end procedure close_file

  module procedure status
    if (allocated(self%first_error)) allocate (error, source=self%first_error)
  end procedure status

  module procedure failed
    failed = allocated(self%first_error)
  end procedure failed

  module procedure record_error
    if (.not. allocated(self%first_error)) call fail(self%first_error, code, "'"//self%path()//"': "//message)
  end procedure record_error

  module procedure path_of_file
    path = ''
    if (allocated(self%file_path)) path = self%file_path
  end procedure path_of_file

  module procedure group
    integer(hid_t) :: id
    integer :: flag, last

    if (self%failed() .or. path == '') return
    last = len(path)
    if (path(last:) == '/') then
      call self%group(path(:last - 1))
      return
    end if
    call h5gcreate_f(self%id, path, id, flag, gcpl_id=self%group_properties)
    if (flag /= 0) then
      if (self%has(path)) return
      ! groups that HDF5 makes on the way to another one have not these properties
      call self%group(path(:index(path, '/', back=.true.) - 1))
      call h5gcreate_f(self%id, path, id, flag, gcpl_id=self%group_properties)
    end if
    if (flag == 0) then
      call self%keep_object(path, id)
    else
      call self%record_error(exit_machine, "the group '"//path//"' cannot be made")
    end if
  end procedure group

  module procedure link
    integer :: flag

    call self%group(path(:index(path, '/', back=.true.) - 1))
    if (self%failed()) return
    call h5lcreate_external_f(other_file, '/', self%id, path, flag)
    if (flag /= 0) call self%record_error(exit_machine, "the link '"//path//"' cannot be made")
  end procedure link

  module procedure has
    integer :: last, flag

    has = self%id /= closed .and. .not. self%failed()
    last = 0
    ! HDF5 reports on the last link of a path only when those before it exist.
    do while (has .and. last < len(path))
      last = last + max(index(path(last + 1:)//'/', '/'), 1)
      if (path(:last - 1) == '') cycle
      call h5lexists_f(self%id, path(:last - 1), has, flag)
      has = has .and. flag == 0
    end do
  end procedure has

  module procedure list
    character(len=256) :: name
    integer :: n, i, flag

    allocate (names(0))
    if (self%failed()) return
    call h5gn_members_f(self%id, path, n, flag)
    if (flag /= 0) then
      call self%record_error(exit_input, "no group '"//path//"'")
      return
    end if
    deallocate (names)
    allocate (names(n))
    do i = 1, n
      ! the name of the link: what it stands for need not be there
      call h5lget_name_by_idx_f(self%id, path, h5_index_name_f, h5_iter_inc_f, int(i - 1, hsize_t), name, flag)
      if (flag /= 0) name = ''
      names(i)%s = trim(name)
    end do
  end procedure list

  module procedure remove
    integer :: flag

    if (self%failed()) return
    if (.not. self%has(path)) return
    flag = -1
    call self%keep_object('', closed)
    if (self%writable) call h5ldelete_f(self%id, path, flag)
    if (flag /= 0) call self%record_error(exit_bug, "cannot remove '"//path//"'")
  end procedure remove

end submodule hdf5_file_access
