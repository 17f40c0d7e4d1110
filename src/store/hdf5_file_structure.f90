!> Allowed contents of a file: a tree of groups and datasets as this module writes them, and nothing else.
submodule(hdf5_file) hdf5_file_structure
  use hdf5, only: h5_index_name_f, h5_iter_inc_f, h5aclose_f, h5aget_name_f, h5aget_num_attrs_f, h5aget_space_f, &
    h5aget_storage_size_f, h5aget_type_f, h5aopen_by_idx_f, h5d_compact_f, h5d_contiguous_f, h5dclose_f, h5dget_create_plist_f, &
    h5dget_space_f, h5dget_storage_size_f, h5dget_type_f, h5dopen_f, h5g_dataset_f, h5g_group_f, h5gclose_f, &
    h5gget_obj_info_idx_f, h5gn_members_f, h5gopen_f, h5lget_name_by_idx_f, h5o_info_t, h5oget_info_f, h5pclose_f, &
    h5pget_external_count_f, h5pget_layout_f, h5pget_nfilters_f, h5sclose_f, h5sget_simple_extent_dims_f, &
    h5sget_simple_extent_ndims_f, h5t_ieee_f64le, h5t_std_i32le, h5t_string_f, h5tclose_f, h5tequal_f, h5tget_class_f, &
    h5tget_size_f, h5tis_variable_str_f, hsize_t, size_t
  use errors, only: exit_input
  use kinds, only: i8
  use text, only: to_text
  implicit none

  !> Groups within groups, at most.
  integer, parameter :: deepest = 8
  !> Dimensions of an array, at most.
  integer, parameter :: largest_rank = 3
  !> Bytes that the entry of one link takes in a file, at least.
  integer, parameter :: least_link = 40

  !> What is still left of the room that all links and all data together have in a file.
  type :: room_t
    integer(i8) :: links, bytes
  end type room_t

contains

  module procedure check_structure
    type(room_t) :: room
    integer(i8) :: length

    if (self%failed()) return
    inquire (file=self%file_path, size=length)
    room = room_t(links=length/least_link, bytes=length)
    call check_group(self, self%id, '/', '/', 0, room)
  end procedure check_structure

  !> A group and all below it.
  recursive subroutine check_group(self, parent, name, path, depth, room)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: parent
    character(len=*), intent(in) :: name   !! in the parent
    character(len=*), intent(in) :: path   !! in the file
    integer, intent(in) :: depth
    type(room_t), intent(inout) :: room
    integer(hid_t) :: group
    character(len=256) :: member, name_again
    character(len=:), allocatable :: below
    integer :: n, i, kind, flag

    call h5gopen_f(parent, name, group, flag)
    if (flag /= 0) then
      call self%record_error(exit_input, "group '"//path//"' cannot be read")
      return
    end if
    call check_object(self, group, path)
    call h5gn_members_f(group, '.', n, flag)
    if (flag /= 0) n = huge(n)
    room%links = room%links - n
    if (depth > deepest .or. room%links < 0) &
      call self%record_error(exit_input, "group '"//path//"' has more below it than a file of this length holds")
    do i = 1, n
      if (self%failed()) exit
      call h5lget_name_by_idx_f(group, '.', h5_index_name_f, h5_iter_inc_f, int(i - 1, hsize_t), member, flag)
      if (flag /= 0) member = ''
      if (flag == 0) call h5gget_obj_info_idx_f(group, '.', i - 1, name_again, kind, flag)
      if (flag /= 0) kind = -1
      below = trim(member)
      if (path /= '/') below = path//'/'//below
      if (kind == h5g_group_f) then
        call check_group(self, group, trim(member), below, depth + 1, room)
      else if (kind == h5g_dataset_f) then
        call check_dataset(self, group, trim(member), below, room)
      else
        call self%record_error(exit_input, "'"//below//"' is a link to elsewhere, or neither a group nor a dataset")
      end if
    end do
    call h5gclose_f(group, flag)
  end subroutine check_group

  subroutine check_dataset(self, group, name, path, room)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: group
    character(len=*), intent(in) :: name, path
    type(room_t), intent(inout) :: room
    integer(hid_t) :: dataset, space, type, properties
    integer(hsize_t) :: stored
    integer :: flag(6), layout, filters, elsewhere

    call h5dopen_f(group, name, dataset, flag(1))
    if (flag(1) /= 0) then
      call self%record_error(exit_input, "dataset '"//path//"' cannot be read")
      return
    end if
    call check_object(self, dataset, path)
    call h5dget_create_plist_f(dataset, properties, flag(1))
    call h5pget_layout_f(properties, layout, flag(2))
    call h5pget_nfilters_f(properties, filters, flag(3))
    call h5pget_external_count_f(properties, elsewhere, flag(4))
    call h5pclose_f(properties, flag(5))
    if (any(flag(:5) < 0)) layout = -1
    if (filters /= 0 .or. elsewhere /= 0 .or. all(layout /= [h5d_contiguous_f, h5d_compact_f])) &
      call self%record_error(exit_input, "dataset '"//path//"' is stored in pieces or outside the file, where one block is wanted")
    call h5dget_space_f(dataset, space, flag(1))
    call h5dget_type_f(dataset, type, flag(2))
    call h5dget_storage_size_f(dataset, stored, flag(3))
    if (flag(3) /= 0) stored = 0   ! an error is what HDF5 answers where nothing is stored
    call check_data(self, "dataset '"//path//"'", space, type, int(stored, i8), largest_rank, room)
    call h5tclose_f(type, flag(4))
    call h5sclose_f(space, flag(5))
    call h5dclose_f(dataset, flag(6))
  end subroutine check_dataset

  !> What groups and datasets have in common: one link leads to them, and their attributes are single values.
  subroutine check_object(self, object, path)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: object
    character(len=*), intent(in) :: path
    type(h5o_info_t) :: info
    type(room_t) :: room
    integer(hid_t) :: attribute, space, type
    integer(hsize_t) :: stored
    character(len=256) :: name
    integer :: n, i, flag

    call h5oget_info_f(object, info, flag)
    if (flag /= 0) info%rc = 0
    if (info%rc /= 1) &
      call self%record_error(exit_input, "'"//path//"': "//to_text(info%rc)//' links lead to it, where one is wanted')
    call h5aget_num_attrs_f(object, n, flag)
    if (flag /= 0) call self%record_error(exit_input, "attributes of '"//path//"' cannot be read")
    do i = 1, n
      if (self%failed()) exit
      call h5aopen_by_idx_f(object, '.', h5_index_name_f, h5_iter_inc_f, int(i - 1, hsize_t), attribute, flag)
      call h5aget_name_f(attribute, len(name, size_t), name, flag)
      if (flag < 0) name = ''
      call h5aget_space_f(attribute, space, flag)
      call h5aget_type_f(attribute, type, flag)
      call h5aget_storage_size_f(attribute, stored, flag)
      if (flag /= 0) stored = 0
      room%bytes = int(stored, i8)   ! it is in memory already
      call check_data(self, "attribute '"//trim(name)//"' of '"//path//"'", space, type, int(stored, i8), 0, room)
      call h5tclose_f(type, flag)
      call h5sclose_f(space, flag)
      call h5aclose_f(attribute, flag)
    end do
  end subroutine check_object

  !> Data of one of the three types that are written, wholly stored, and no more of them than the file has room for.
  subroutine check_data(self, what, space, type, stored, most_dimensions, room)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: what
    integer(hid_t), intent(in) :: space, type
    integer(i8), intent(in) :: stored        !! [byte]
    integer, intent(in) :: most_dimensions
    type(room_t), intent(inout) :: room
    integer(hsize_t) :: extent(32), largest(32)
    integer(size_t) :: width
    integer :: rank, class, flag(5)
    logical :: is_real, is_integer, is_text, is_variable

    flag = 0
    is_variable = .false.
    call h5tget_class_f(type, class, flag(1))
    call h5tget_size_f(type, width, flag(2))
    call h5tequal_f(type, h5t_ieee_f64le, is_real, flag(3))
    call h5tequal_f(type, h5t_std_i32le, is_integer, flag(4))
    is_text = class == h5t_string_f
    if (is_text) call h5tis_variable_str_f(type, is_variable, flag(5))
    if (any(flag < 0) .or. .not. (is_real .or. is_integer .or. is_text) .or. is_variable) then
      call self%record_error(exit_input, what//' is neither real(64 bits), integer(32 bits) nor text of fixed length')
      return
    end if
    call h5sget_simple_extent_ndims_f(space, rank, flag(1))
    if (flag(1) < 0) rank = -1
    if (rank < 0 .or. rank > most_dimensions) then
      call self%record_error(exit_input, what//' is of rank '//to_text(rank)//', where at most '//to_text(most_dimensions)// &
                             ' is wanted')
      return
    end if
    if (rank > 0) call h5sget_simple_extent_dims_f(space, extent, largest, flag(2))
    room%bytes = room%bytes - stored
    if (length_of_data(int(width, i8), int(extent(:rank), i8), stored) /= stored .or. room%bytes < 0) &
      call self%record_error(exit_input, what//': '//to_text(stored)//' bytes are stored, which do not fit its extent and the file')
  end subroutine check_data

  !> Bytes of an array; one more than `limit` where there are more, whose number may be past all integers.
  pure function length_of_data(width, extent, limit) result(bytes)
    integer(i8), intent(in) :: width       !! of one number or text [byte]
    integer(i8), intent(in) :: extent(:)
    integer(i8), intent(in) :: limit
    integer(i8) :: bytes
    integer :: i

    bytes = 0
    if (any(extent == 0)) return
    bytes = width
    do i = 1, size(extent)
      if (extent(i) < 0 .or. bytes > limit/max(extent(i), 1_i8)) then
        bytes = limit + 1
        return
      end if
      bytes = bytes*extent(i)
    end do
  end function length_of_data

end submodule hdf5_file_structure
