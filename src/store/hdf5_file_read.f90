!> Reading datasets of a known type and rank.
submodule(hdf5_file) hdf5_file_read
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
  use hdf5, only: h5dget_space_f, h5dget_type_f, h5dread_f, h5i_dataset_f, h5iget_type_f, h5sclose_f, &
    h5sget_simple_extent_dims_f, h5sget_simple_extent_ndims_f, h5t_float_f, h5t_integer_f, h5t_native_double, h5t_native_integer, &
    h5t_string_f, h5tclose_f, h5tget_class_f, h5tget_size_f, h5tis_variable_str_f, hsize_t, size_t
  use errors, only: exit_input
  use hdf5_text, only: get_words, make_text_type
  use kinds, only: i8
  use text, only: to_text
  implicit none

contains

  module procedure read_real
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(0)

    value = 0
    call open_dataset(self, path, h5t_float_f, extent, dataset)
    call read_block(self, path, dataset, h5t_native_double, c_loc(value))
    if (ieee_is_finite(value)) return
    call refuse_not_finite(self, path)
    value = 0
  end procedure read_real

  module procedure read_reals
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(1)

    call open_dataset(self, path, h5t_float_f, extent, dataset)
    allocate (values(extent(1)))
    call read_block(self, path, dataset, h5t_native_double, c_loc(values))
    if (all(ieee_is_finite(values))) return
    call refuse_not_finite(self, path)
    values = 0
  end procedure read_reals

  module procedure read_reals_2
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(2)

    call open_dataset(self, path, h5t_float_f, extent, dataset)
    allocate (values(extent(1), extent(2)))
    call read_block(self, path, dataset, h5t_native_double, c_loc(values))
    if (all(ieee_is_finite(values))) return
    call refuse_not_finite(self, path)
    values = 0
  end procedure read_reals_2

  module procedure read_reals_3
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(3)

    call open_dataset(self, path, h5t_float_f, extent, dataset)
    allocate (values(extent(1), extent(2), extent(3)))
    call read_block(self, path, dataset, h5t_native_double, c_loc(values))
    if (all(ieee_is_finite(values))) return
    call refuse_not_finite(self, path)
    values = 0
  end procedure read_reals_3

  module procedure read_integer
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(0)

    value = 0
    call open_dataset(self, path, h5t_integer_f, extent, dataset)
    call read_block(self, path, dataset, h5t_native_integer, c_loc(value))
  end procedure read_integer

  module procedure read_integers
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(1)

    call open_dataset(self, path, h5t_integer_f, extent, dataset)
    allocate (values(extent(1)))
    call read_block(self, path, dataset, h5t_native_integer, c_loc(values))
  end procedure read_integers

  module procedure read_integers_2
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(2)

    call open_dataset(self, path, h5t_integer_f, extent, dataset)
    allocate (values(extent(1), extent(2)))
    call read_block(self, path, dataset, h5t_native_integer, c_loc(values))
  end procedure read_integers_2

  module procedure read_text
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(0)
    type(string_t) :: words(1)

    call open_dataset(self, path, h5t_string_f, extent, dataset)
    call read_letters(self, path, dataset, words)
    call move_alloc(words(1)%s, value)
  end procedure read_text

  module procedure read_words
    integer(hid_t) :: dataset
    integer(hsize_t) :: extent(1)

    call open_dataset(self, path, h5t_string_f, extent, dataset)
    allocate (values(extent(1)))
    call read_letters(self, path, dataset, values)
  end procedure read_words

  !> NaN and infinity are refused: they would spread through all that is computed with them.
  subroutine refuse_not_finite(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path

    call self%record_error(exit_input, "dataset '"//path//"' holds a number that is not finite")
  end subroutine refuse_not_finite

  module procedure require_shape
    integer(hsize_t) :: extent(32), largest(32)
    integer(hid_t) :: space
    character(len=:), allocatable :: found
    integer :: rank, k, flag

    if (self%failed()) return
    call open_found(self, path)
    if (self%failed()) return
    call h5dget_space_f(self%object, space, flag)
    call h5sget_simple_extent_ndims_f(space, rank, flag)
    if (flag /= 0) rank = 0
    if (rank > 0) call h5sget_simple_extent_dims_f(space, extent, largest, flag)
    call h5sclose_f(space, flag)
    if (rank == size(wanted)) then
      if (all(extent(:rank) == wanted .or. wanted < 0)) return
    end if
    found = ''
    do k = 1, rank
      found = found//' '//to_text(int(extent(k), i8))
    end do
    call self%record_error(exit_input, "dataset '"//path//"' has the extents"//found//', where'//extents_in_words(wanted)// &
                           ' is wanted')
  end procedure require_shape

  pure function extents_in_words(wanted) result(words)
    integer, intent(in) :: wanted(:)
    character(len=:), allocatable :: words
    integer :: k

    words = ''
    do k = 1, size(wanted)
      if (wanted(k) < 0) then
        words = words//' any'
      else
        words = words//' '//to_text(wanted(k))
      end if
    end do
  end function extents_in_words

  !> Make the dataset `path` the object used last, or record why that is not possible.
  subroutine open_found(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer :: kind, flag

    call self%open_object(path)
    kind = -1
    if (self%object /= closed) call h5iget_type_f(self%object, kind, flag)
    if (kind == h5i_dataset_f) return
    if (self%has(path)) then
      call self%record_error(exit_input, "'"//path//"' is not a dataset, or a damaged one")
    else
      call self%record_error(exit_input, "dataset '"//path//"' is missing")
    end if
  end subroutine open_found

  !> Open the dataset `path` and learn its `extent`, whose size is the rank wanted. When the dataset
  !> is not there or is something else, `dataset` is `closed` and the extent zero.
  subroutine open_dataset(self, path, class, extent, dataset)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer, intent(in) :: class
    integer(hsize_t), intent(out) :: extent(:)
    integer(hid_t), intent(out) :: dataset
    integer(hsize_t) :: found_extent(32), largest(32)
    integer(hid_t) :: type, space
    integer(size_t) :: width, wanted_width
    integer :: found_class, found_rank, flag(8)

    extent = 0
    dataset = closed
    if (self%failed()) return
    call open_found(self, path)
    if (self%failed()) return
    dataset = self%object
    found_class = -1
    found_rank = -1
    width = 0
    call h5dget_type_f(dataset, type, flag(1))
    call h5tget_class_f(type, found_class, flag(2))
    call h5tget_size_f(type, width, flag(3))
    call h5tclose_f(type, flag(4))
    call h5dget_space_f(dataset, space, flag(5))
    call h5sget_simple_extent_ndims_f(space, found_rank, flag(6))
    if (found_rank == size(extent) .and. found_rank > 0) then
      call h5sget_simple_extent_dims_f(space, found_extent, largest, flag(7))
      extent = found_extent(:size(extent))
    end if
    call h5sclose_f(space, flag(8))

    wanted_width = width
    if (class == h5t_float_f) wanted_width = 8
    if (class == h5t_integer_f) wanted_width = 4
    if (found_class == class .and. found_rank == size(extent) .and. width <= wanted_width) return
    call self%record_error(exit_input, "dataset '"//path//"' is "//described(found_class, int(width), found_rank)// &
      ', where '//described(class, int(wanted_width), size(extent))//' is wanted')
    dataset = closed
    extent = 0
  end subroutine open_dataset

  !> A type and a rank in words.
  pure function described(class, width, rank) result(words)
    integer, intent(in) :: class, width, rank
    character(len=:), allocatable :: words

    if (class == h5t_float_f) then
      words = 'real('//to_text(8*width)//' bits)'
    else if (class == h5t_integer_f) then
      words = 'integer('//to_text(8*width)//' bits)'
    else if (class == h5t_string_f) then
      words = 'text'
    else
      words = 'of another type'
    end if
    words = words//' of rank '//to_text(rank)
  end function described

  !> Fill memory from an open dataset.
  subroutine read_block(self, path, dataset, memory_type, address)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(hid_t), intent(in) :: dataset, memory_type
    type(c_ptr), intent(in) :: address
    type(c_ptr) :: target_address
    integer :: flag

    if (dataset == closed) return
    target_address = address
    call h5dread_f(dataset, memory_type, target_address, flag)
    if (flag /= 0) call self%record_error(exit_input, "dataset '"//path//"' cannot be read: the file is damaged")
  end subroutine read_block

  !> Fill `words` from an open dataset of text; they are empty when that fails.
  subroutine read_letters(self, path, dataset, words)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(hid_t), intent(in) :: dataset
    type(string_t), intent(out) :: words(:)
    character(len=1), allocatable, target :: letters(:)
    integer(hid_t) :: type
    integer(size_t) :: width
    integer :: i, flag
    logical :: variable

    do i = 1, size(words)
      words(i)%s = ''
    end do
    if (dataset == closed) return
    call h5dget_type_f(dataset, type, flag)
    call h5tget_size_f(type, width, flag)
    call h5tis_variable_str_f(type, variable, flag)
    call h5tclose_f(type, flag)
    if (variable) then
      call self%record_error(exit_input, "dataset '"//path//"' is text of variable length, where fixed length is wanted")
    end if
    if (variable .or. size(words) == 0) return
    allocate (letters(width*size(words)))
    call make_text_type(int(width), type)
    call read_block(self, path, dataset, type, c_loc(letters))
    call h5tclose_f(type, flag)
    if (.not. self%failed()) call get_words(letters, words)
  end subroutine read_letters

end submodule hdf5_file_read
