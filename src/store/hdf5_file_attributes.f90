!> Attributes: small texts and numbers beside a dataset or a group.
submodule(hdf5_file) hdf5_file_attributes
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
  use hdf5, only: h5aclose_f, h5acreate_f, h5adelete_f, h5aexists_f, h5aget_space_f, h5aget_type_f, h5aopen_f, h5aread_f, &
    h5awrite_f, h5oclose_f, h5oopen_f, h5sclose_f, h5sget_simple_extent_ndims_f, h5t_float_f, &
    h5t_ieee_f64le, h5t_integer_f, h5t_native_double, h5t_native_integer, h5t_std_i32le, h5t_string_f, h5tclose_f, &
    h5tget_class_f, h5tget_size_f, h5tis_variable_str_f, size_t
  use errors, only: exit_bug, exit_input, exit_machine
  use hdf5_text, only: get_words, letters_of, make_text_type
  implicit none

  !> HDF5 keeps an attribute in the header of its object, which holds 64 KiB.
  integer, parameter :: longest_text = 64000

contains

  module procedure write_text_attribute
    character(len=1), allocatable, target :: letters(:)
    integer(hid_t) :: type
    integer :: flag

    if (self%failed()) return
    if (len(value) > longest_text) then
      call self%record_error(exit_bug, "the text of attribute '"//name//"' of '"//path//"' is too long: make it a dataset")
      return
    end if
    call letters_of([string_t(value)], letters)
    call make_text_type(size(letters), type)
    call write_value(self, path, name, type, type, c_loc(letters))
    call h5tclose_f(type, flag)
  end procedure write_text_attribute

  module procedure write_integer_attribute
    call write_value(self, path, name, h5t_std_i32le, h5t_native_integer, c_loc(value))
  end procedure write_integer_attribute

  module procedure write_real_attribute
    call write_value(self, path, name, h5t_ieee_f64le, h5t_native_double, c_loc(value))
  end procedure write_real_attribute

  module procedure read_text_attribute
    character(len=1), allocatable, target :: letters(:)
    type(string_t) :: words(1)
    integer(hid_t) :: attribute, type
    integer :: width, flag

    value = ''
    call open_attribute(self, path, name, h5t_string_f, attribute, width)
    if (attribute == closed) return
    allocate (letters(width))
    call make_text_type(width, type)
    call read_value(self, path, name, attribute, type, c_loc(letters))
    call h5tclose_f(type, flag)
    if (self%failed()) return
    call get_words(letters, words)
    value = words(1)%s
  end procedure read_text_attribute

  module procedure read_integer_attribute
    integer(hid_t) :: attribute
    integer :: width

    value = 0
    call open_attribute(self, path, name, h5t_integer_f, attribute, width)
    call read_value(self, path, name, attribute, h5t_native_integer, c_loc(value))
  end procedure read_integer_attribute

  module procedure read_real_attribute
    integer(hid_t) :: attribute
    integer :: width

    value = 0
    call open_attribute(self, path, name, h5t_float_f, attribute, width)
    call read_value(self, path, name, attribute, h5t_native_double, c_loc(value))
    if (ieee_is_finite(value)) return
    call self%record_error(exit_input, "attribute '"//name//"' of '"//path//"' holds a number that is not finite")
    value = 0
  end procedure read_real_attribute

  module procedure has_attribute
    integer(hid_t) :: object
    integer :: flag, ignored

    has_attribute = self%has(path)
    if (.not. has_attribute) return
    call h5oopen_f(self%id, path, object, flag)
    if (flag == 0) then
      call h5aexists_f(object, name, has_attribute, flag)
      call h5oclose_f(object, ignored)
    end if
    has_attribute = has_attribute .and. flag == 0
  end procedure has_attribute

  !> Write one value beside the object `path`, in the place of an older one.
  subroutine write_value(self, path, name, file_type, memory_type, address)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path, name
    integer(hid_t), intent(in) :: file_type, memory_type
    type(c_ptr), intent(in) :: address
    type(c_ptr) :: source_address
    integer(hid_t) :: attribute
    integer :: flag(3)

    if (self%failed()) return
    if (self%writable) call self%open_object(path)
    if (self%object == closed .or. .not. self%writable) then
      call self%record_error(exit_bug, "attribute '"//name//"': there is no '"//path//"', or the file is not open for writing")
      return
    end if
    source_address = address
    call h5acreate_f(self%object, name, file_type, self%single_value, attribute, flag(1))
    if (flag(1) /= 0) then   ! an older one, perhaps
      call h5adelete_f(self%object, name, flag(1))
      call h5acreate_f(self%object, name, file_type, self%single_value, attribute, flag(1))
    end if
    flag(2:) = 0
    if (flag(1) == 0) then
      call h5awrite_f(attribute, memory_type, source_address, flag(2))
      call h5aclose_f(attribute, flag(3))
    end if
    if (any(flag /= 0)) &
      call self%record_error(exit_machine, "attribute '"//name//"' of '"//path//"' cannot be written (disk full?)")
  end subroutine write_value

  !> Open an attribute of a given class of types; `closed` when it is missing or something else.
  subroutine open_attribute(self, path, name, class, attribute, width)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path, name
    integer, intent(in) :: class
    integer(hid_t), intent(out) :: attribute
    integer, intent(out) :: width
    integer(hid_t) :: type, space
    integer(size_t) :: bytes
    integer :: flag, found, rank
    logical :: variable

    attribute = closed
    width = 0
    if (self%failed()) return
    call self%open_object(path)
    flag = -1
    if (self%object /= closed) call h5aopen_f(self%object, name, attribute, flag)
    if (flag /= 0) then
      attribute = closed
      call self%record_error(exit_input, "attribute '"//name//"' of '"//path//"' is missing")
      return
    end if
    found = -1
    bytes = 0
    rank = -1
    variable = .false.
    call h5aget_space_f(attribute, space, flag)
    call h5sget_simple_extent_ndims_f(space, rank, flag)
    call h5sclose_f(space, flag)
    call h5aget_type_f(attribute, type, flag)
    call h5tget_class_f(type, found, flag)
    call h5tget_size_f(type, bytes, flag)
    if (found == h5t_string_f) call h5tis_variable_str_f(type, variable, flag)
    call h5tclose_f(type, flag)
    width = int(bytes)
    if (found == class .and. rank == 0 .and. .not. variable .and. .not. (class == h5t_integer_f .and. width > 4)) return
    call self%record_error(exit_input, "attribute '"//name//"' of '"//path//"' is not of the type wanted")
    call h5aclose_f(attribute, flag)
    attribute = closed
  end subroutine open_attribute

  !> Read one value from an open attribute, and close it.
  subroutine read_value(self, path, name, attribute, memory_type, address)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path, name
    integer(hid_t), intent(in) :: attribute, memory_type
    type(c_ptr), intent(in) :: address
    type(c_ptr) :: target_address
    integer :: flag, ignored

    if (attribute == closed) return
    target_address = address
    call h5aread_f(attribute, memory_type, target_address, flag)
    call h5aclose_f(attribute, ignored)
    if (flag /= 0) call self%record_error(exit_input, "attribute '"//name//"' of '"//path//"' cannot be read: the file is damaged")
  end subroutine read_value

end submodule hdf5_file_attributes
