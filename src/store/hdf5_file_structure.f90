!> Allowed contents of a file: a tree of groups and datasets as this module writes them, and nothing else.
submodule(hdf5_file) hdf5_file_structure
  use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_funloc, c_funptr, c_int, c_int64_t, c_loc, c_ptr
  use hdf5, only: h5_index_name_f, h5_iter_inc_f, h5aclose_f, h5aget_space_f, h5aget_storage_size_f, h5aget_type_f, h5aopen_f, &
    h5d_compact_f, h5d_contiguous_f, h5dget_create_plist_f, h5dget_space_f, h5dget_storage_size_f, h5dget_type_f, h5gn_members_f, &
    h5i_dataset_f, h5i_group_f, h5iget_type_f, h5l_type_hard_f, h5literate_f, h5o_info_basic_f, h5o_info_t, h5oclose_f, &
    h5oget_info_f, h5oopen_f, h5pclose_f, h5pget_external_count_f, h5pget_layout_f, h5pget_nfilters_f, h5sclose_f, &
    h5sget_simple_extent_dims_f, h5sget_simple_extent_ndims_f, h5t_float_f, h5t_ieee_f64le, h5t_integer_f, h5t_std_i32le, &
    h5t_string_f, h5tclose_f, h5tequal_f, h5tget_class_f, h5tget_size_f, h5tis_variable_str_f, hsize_t, size_t
  use errors, only: exit_input
  use kinds, only: i8
  use system, only: text_of_c
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

  !> Names in a group or of attributes, in alphabetic order, gathered in one pass: by their numbers HDF5 would begin anew for each.
  type :: name_list_t
    integer :: number = 0
    type(string_t), allocatable :: name(:)   !! (number or more)
    logical, allocatable :: hard(:)          !! (number or more); of links
  end type name_list_t

  interface
    function c_aiterate(object, index, order, place, visit, names) bind(c, name='H5Aiterate2') result(status)
      import :: c_funptr, c_int, c_int64_t, c_ptr
      integer(c_int64_t), value :: object   ! hid_t
      integer(c_int), value :: index, order
      integer(c_int64_t), intent(inout) :: place   ! hsize_t
      type(c_funptr), value :: visit
      type(c_ptr), value :: names
      integer(c_int) :: status
    end function c_aiterate
  end interface

contains

  module procedure check_structure
    type(room_t) :: room
    integer(i8) :: length

    if (self%failed()) return
    inquire (file=self%file_path, size=length)
    room = room_t(links=length/least_link, bytes=length)
    call check_member(self, self%id, '/', '/', 0, room)
  end procedure check_structure

  !> A group and all below it, or a dataset.
  recursive subroutine check_member(self, parent, name, path, depth, room)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: parent
    character(len=*), intent(in) :: name   !! in the parent
    character(len=*), intent(in) :: path   !! in the file
    integer, intent(in) :: depth
    type(room_t), intent(inout) :: room
    integer(hid_t) :: object
    integer :: kind, flag

    call h5oopen_f(parent, name, object, flag)
    if (flag /= 0) then
      call self%record_error(exit_input, "'"//path//"' cannot be read")
      return
    end if
    call h5iget_type_f(object, kind, flag)
    if (kind == h5i_group_f) then
      call check_object(self, object, path)
      call check_group(self, object, path, depth, room)
    else if (kind == h5i_dataset_f) then
      call check_object(self, object, path)
      call check_dataset(self, object, path, room)
    else
      call refuse_link(self, path)
    end if
    call h5oclose_f(object, flag)
  end subroutine check_member

  recursive subroutine check_group(self, group, path, depth, room)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: group
    character(len=*), intent(in) :: path
    integer, intent(in) :: depth
    type(room_t), intent(inout) :: room
    type(name_list_t), target :: members
    character(len=:), allocatable :: below
    type(c_funptr) :: visit
    integer(hsize_t) :: place
    integer :: n, i, status, flag

    call h5gn_members_f(group, '.', n, flag)
    if (flag /= 0) n = huge(n)
    room%links = room%links - n
    if (depth > deepest .or. room%links < 0) &
      call self%record_error(exit_input, "group '"//path//"' has more below it than a file of this length holds")
    if (n == 0 .or. self%failed()) return
    place = 0
    status = 0
    visit = c_funloc(note_link)   ! a constant would be a relocation in a part of the program that is not written to
    call h5literate_f(group, h5_index_name_f, h5_iter_inc_f, place, visit, c_loc(members), status, flag)
    if (flag < 0 .or. members%number /= n) &
      call self%record_error(exit_input, "the members of '"//path//"' cannot be read")
    do i = 1, members%number
      if (self%failed()) exit
      below = members%name(i)%s
      if (path /= '/') below = path//'/'//below
      if (members%hard(i)) then
        call check_member(self, group, members%name(i)%s, below, depth + 1, room)
      else
        call refuse_link(self, below)
      end if
    end do
  end subroutine check_group

  subroutine refuse_link(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path

    call self%record_error(exit_input, "'"//path//"' is a link to elsewhere, or neither a group nor a dataset")
  end subroutine refuse_link

  !> Called by HDF5 for each link: a H5L_info_t begins with the type of the link.
  function note_link(group, name, info, names) bind(c) result(status)
    integer(c_int64_t), value :: group   ! hid_t
    type(c_ptr), value :: name, info, names
    integer(c_int) :: status
    type(name_list_t), pointer :: list
    integer(c_int), pointer :: kind

    call c_f_pointer(names, list)
    call c_f_pointer(info, kind)
    call add_name(list, text_of_c(name), kind == h5l_type_hard_f)
    status = 0
  end function note_link

  !> Called by HDF5 for each attribute.
  function note_attribute(object, name, info, names) bind(c) result(status)
    integer(c_int64_t), value :: object   ! hid_t
    type(c_ptr), value :: name, info, names
    integer(c_int) :: status
    type(name_list_t), pointer :: list

    call c_f_pointer(names, list)
    call add_name(list, text_of_c(name), .true.)
    status = 0
  end function note_attribute

  subroutine add_name(list, name, hard)
    type(name_list_t), intent(inout) :: list
    character(len=*), intent(in) :: name
    logical, intent(in) :: hard
    type(name_list_t) :: longer

    if (.not. allocated(list%name)) allocate (list%name(16), list%hard(16))
    if (list%number == size(list%name)) then
      allocate (longer%name(2*list%number), longer%hard(2*list%number))
      longer%name(:list%number) = list%name
      longer%hard(:list%number) = list%hard
      call move_alloc(longer%name, list%name)
      call move_alloc(longer%hard, list%hard)
    end if
    list%number = list%number + 1
    list%name(list%number)%s = name
    list%hard(list%number) = hard
  end subroutine add_name

  subroutine check_dataset(self, dataset, path, room)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: dataset
    character(len=*), intent(in) :: path
    type(room_t), intent(inout) :: room
    integer(hid_t) :: space, type, properties
    integer(hsize_t) :: stored
    integer :: flag(5), layout, filters, elsewhere

    call h5dget_create_plist_f(dataset, properties, flag(1))
    call h5pget_layout_f(properties, layout, flag(2))
    call h5pget_nfilters_f(properties, filters, flag(3))
    call h5pget_external_count_f(properties, elsewhere, flag(4))
    call h5pclose_f(properties, flag(5))
    if (any(flag < 0)) layout = -1
    if (filters /= 0 .or. elsewhere /= 0 .or. all(layout /= [h5d_contiguous_f, h5d_compact_f])) &
      call self%record_error(exit_input, "dataset '"//path//"' is stored in pieces or outside the file, where one block is wanted")
    call h5dget_space_f(dataset, space, flag(1))
    call h5dget_type_f(dataset, type, flag(2))
    call h5dget_storage_size_f(dataset, stored, flag(3))
    if (flag(3) /= 0) stored = 0   ! an error is what HDF5 answers where nothing is stored
    call check_data(self, "dataset '"//path//"'", space, type, int(stored, i8), largest_rank, room)
    call h5tclose_f(type, flag(4))
    call h5sclose_f(space, flag(5))
  end subroutine check_dataset

  !> What groups and datasets have in common: one link leads to them, and their attributes are single values.
  subroutine check_object(self, object, path)
    class(hdf5_file_t), intent(inout) :: self
    integer(hid_t), intent(in) :: object
    character(len=*), intent(in) :: path
    type(h5o_info_t) :: info
    type(room_t) :: room
    type(name_list_t), target :: names
    integer(hid_t) :: attribute, space, type
    integer(hsize_t) :: stored, place
    integer :: i, flag

    call h5oget_info_f(object, info, flag, h5o_info_basic_f)
    if (flag /= 0) info%rc = 0
    if (info%rc /= 1) &
      call self%record_error(exit_input, "'"//path//"': "//to_text(info%rc)//' links lead to it, where one is wanted')
    place = 0
    if (c_aiterate(object, int(h5_index_name_f, c_int), int(h5_iter_inc_f, c_int), place, c_funloc(note_attribute), &
                   c_loc(names)) < 0) call self%record_error(exit_input, "attributes of '"//path//"' cannot be read")
    do i = 1, names%number
      if (self%failed()) exit
      call h5aopen_f(object, names%name(i)%s, attribute, flag)
      call h5aget_space_f(attribute, space, flag)
      call h5aget_type_f(attribute, type, flag)
      call h5aget_storage_size_f(attribute, stored, flag)
      if (flag /= 0) stored = 0
      room%bytes = int(stored, i8)   ! it is in memory already
      call check_data(self, "attribute '"//names%name(i)%s//"' of '"//path//"'", space, type, int(stored, i8), 0, room)
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
    integer :: rank, class, flag(3)
    logical :: is_ours, is_variable

    flag = 0
    is_ours = .false.
    call h5tget_class_f(type, class, flag(1))
    call h5tget_size_f(type, width, flag(2))
    if (class == h5t_float_f) then
      call h5tequal_f(type, h5t_ieee_f64le, is_ours, flag(3))
    else if (class == h5t_integer_f) then
      call h5tequal_f(type, h5t_std_i32le, is_ours, flag(3))
    else if (class == h5t_string_f) then
      call h5tis_variable_str_f(type, is_variable, flag(3))
      is_ours = .not. is_variable
    end if
    if (any(flag < 0) .or. .not. is_ours) then
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
