!> One fingerprint for all that a file holds: a line per group, dataset and attribute with its path,
!> type, extent and the SHA-256 of its bytes, in alphabetic order, and the SHA-256 of these lines.
submodule(hdf5_file) hdf5_file_digest
  use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
  use hdf5, only: h5_index_name_f, h5_iter_inc_f, h5aclose_f, h5aget_name_f, h5aget_num_attrs_f, h5aget_space_f, h5aget_type_f, &
    h5aopen_by_idx_f, h5aread_f, h5dclose_f, h5dget_space_f, h5dget_type_f, h5dopen_f, h5dread_f, h5g_dataset_f, h5g_group_f, &
    h5gclose_f, h5gget_obj_info_idx_f, h5gn_members_f, h5gopen_f, h5sclose_f, h5sget_simple_extent_dims_f, &
    h5sget_simple_extent_ndims_f, h5tclose_f, h5tget_class_f, h5tget_size_f, hsize_t, size_t
  use errors, only: exit_input
  use hash, only: sha256
  use kinds, only: i8
  use text, only: to_text
  implicit none

contains

  module procedure digest_of_file
    character(len=:), allocatable :: lines
    integer :: flag

    digest = ''
    if (self%failed()) return
    lines = ''
    flag = 0
    call add_group(self%id, '/', '/', lines, flag)
    if (flag /= 0) then
      call self%record_error(exit_input, 'the file is damaged: not all of it can be read back')
    else
      digest = sha256(lines)
    end if
  end procedure digest_of_file

  !> The lines of a group and of all below it. `flag` stays 0 while all can be read.
  recursive subroutine add_group(parent, name, path, lines, flag)
    integer(hid_t), intent(in) :: parent
    character(len=*), intent(in) :: name   !! in the parent
    character(len=*), intent(in) :: path   !! in the file
    character(len=:), allocatable, intent(inout) :: lines
    integer, intent(inout) :: flag
    integer(hid_t) :: group
    character(len=256) :: member
    integer :: n, i, kind, ignored

    lines = lines//'group '//path//new_line('a')
    call h5gopen_f(parent, name, group, flag)
    if (flag /= 0) return
    n = 0
    call add_attributes(group, path, lines, flag)
    if (flag == 0) call h5gn_members_f(group, '.', n, flag)
    do i = 1, n
      if (flag == 0) call h5gget_obj_info_idx_f(group, '.', i - 1, member, kind, flag)
      if (flag /= 0) exit
      if (kind == h5g_group_f) then
        call add_group(group, trim(member), path//trim(member)//'/', lines, flag)
      else if (kind == h5g_dataset_f) then
        call add_dataset(group, trim(member), path//trim(member), lines, flag)
      else
        lines = lines//'other '//path//trim(member)//new_line('a')
      end if
    end do
    call h5gclose_f(group, ignored)
  end subroutine add_group

  !> The lines of a dataset and of its attributes.
  subroutine add_dataset(group, name, path, lines, flag)
    integer(hid_t), intent(in) :: group
    character(len=*), intent(in) :: name, path
    character(len=:), allocatable, intent(inout) :: lines
    integer, intent(out) :: flag
    integer(hid_t) :: dataset, space, type
    character(len=1), allocatable, target :: bytes(:)
    character(len=:), allocatable :: line
    type(c_ptr) :: address
    integer :: ignored

    call h5dopen_f(group, name, dataset, flag)
    if (flag /= 0) return
    call h5dget_space_f(dataset, space, flag)
    call h5dget_type_f(dataset, type, flag)
    call make_room(space, type, line, bytes, flag)
    if (flag == 0 .and. size(bytes) > 0) then
      address = c_loc(bytes)
      call h5dread_f(dataset, type, address, flag)
    end if
    if (flag == 0) lines = lines//'dataset '//path//line//sha256(bytes)//new_line('a')
    if (flag == 0) call add_attributes(dataset, path, lines, flag)
    call h5tclose_f(type, ignored)
    call h5sclose_f(space, ignored)
    call h5dclose_f(dataset, ignored)
  end subroutine add_dataset

  !> The lines of the attributes of an object.
  subroutine add_attributes(object, path, lines, flag)
    integer(hid_t), intent(in) :: object
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(inout) :: lines
    integer, intent(inout) :: flag
    integer(hid_t) :: attribute, space, type
    character(len=1), allocatable, target :: bytes(:)
    character(len=:), allocatable :: line
    character(len=256) :: name
    type(c_ptr) :: address
    integer :: n, i, ignored

    n = 0
    if (flag == 0) call h5aget_num_attrs_f(object, n, flag)
    do i = 1, n
      if (flag /= 0) exit
      call h5aopen_by_idx_f(object, '.', h5_index_name_f, h5_iter_inc_f, int(i - 1, hsize_t), attribute, flag)
      if (flag /= 0) exit
      name = ''
      call h5aget_name_f(attribute, len(name, size_t), name, ignored)
      call h5aget_space_f(attribute, space, flag)
      call h5aget_type_f(attribute, type, flag)
      call make_room(space, type, line, bytes, flag)
      if (flag == 0 .and. size(bytes) > 0) then
        address = c_loc(bytes)
        call h5aread_f(attribute, type, address, flag)
      end if
      if (flag == 0 .and. .not. (path == '/' .and. name == digest_attribute)) &
        lines = lines//'attribute '//path//' '//trim(name)//line//sha256(bytes)//new_line('a')
      call h5tclose_f(type, ignored)
      call h5sclose_f(space, ignored)
      call h5aclose_f(attribute, ignored)
    end do
  end subroutine add_attributes

  !> Room for the bytes of an object of this extent and type, and both in words.
  subroutine make_room(space, type, line, bytes, flag)
    integer(hid_t), intent(in) :: space, type
    character(len=:), allocatable, intent(out) :: line
    character(len=1), allocatable, intent(out) :: bytes(:)
    integer, intent(out) :: flag
    integer(hsize_t) :: extent(32), largest(32)
    integer(size_t) :: width
    integer :: class, rank, i, flags(4)

    flags = 0
    rank = 0
    width = 0
    call h5tget_class_f(type, class, flags(1))
    call h5tget_size_f(type, width, flags(2))
    call h5sget_simple_extent_ndims_f(space, rank, flags(3))
    if (rank > 0) call h5sget_simple_extent_dims_f(space, extent, largest, flags(4))
    flag = minval(flags) ! the last one is the rank when all is well
    if (flag < 0) return
    flag = 0
    line = ' '//to_text(class)//' '//to_text(int(width, i8))
    do i = 1, rank
      line = line//' '//to_text(int(extent(i), i8))
    end do
    line = line//' '
    allocate (bytes(product(extent(:rank))*width), stat=flag)
    if (flag > 0) flag = -flag
  end subroutine make_room

end submodule hdf5_file_digest
