!> Writing datasets.
submodule(hdf5_file) hdf5_file_write
  use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
  use hdf5, only: h5dcreate_f, h5dwrite_f, h5pclose_f, h5pcopy_f, h5pset_chunk_f, h5pset_deflate_f, h5pset_shuffle_f, h5sclose_f, &
    h5screate_simple_f, h5t_ieee_f64le, h5t_native_double, h5t_native_integer, h5t_std_i32le, h5tclose_f, hsize_t
  use errors, only: exit_bug, exit_machine
  use hdf5_text, only: letters_of, make_text_type
  implicit none

  !> Extent of a scalar.
  integer(hsize_t), parameter :: scalar(0) = [integer(hsize_t) ::]
  !> Numbers in one compressed chunk: about a megabyte of doubles, the size of HDF5's chunk cache.
  integer(hsize_t), parameter :: chunk_size = 131072_hsize_t

contains

  module procedure write_real
    call write_block(self, path, h5t_ieee_f64le, h5t_native_double, scalar, c_loc(value))
  end procedure write_real

  module procedure write_reals
    call write_block(self, path, h5t_ieee_f64le, h5t_native_double, shape(values, hsize_t), c_loc(values))
  end procedure write_reals

  module procedure write_reals_2
    call write_block(self, path, h5t_ieee_f64le, h5t_native_double, shape(values, hsize_t), c_loc(values))
  end procedure write_reals_2

  module procedure write_reals_3
    call write_block(self, path, h5t_ieee_f64le, h5t_native_double, shape(values, hsize_t), c_loc(values))
  end procedure write_reals_3

  module procedure write_integer
    call write_block(self, path, h5t_std_i32le, h5t_native_integer, scalar, c_loc(value))
  end procedure write_integer

  module procedure write_integers
    call write_block(self, path, h5t_std_i32le, h5t_native_integer, shape(values, hsize_t), c_loc(values))
  end procedure write_integers

  module procedure write_integers_2
    call write_block(self, path, h5t_std_i32le, h5t_native_integer, shape(values, hsize_t), c_loc(values))
  end procedure write_integers_2

  module procedure write_text
    character(len=1), allocatable, target :: letters(:)
    integer(hid_t) :: type
    integer :: flag

    if (self%failed()) return
    call letters_of([string_t(value)], letters)
    call make_text_type(size(letters), type)
    call write_block(self, path, type, type, scalar, c_loc(letters))
    call h5tclose_f(type, flag)
  end procedure write_text

  module procedure write_words
    character(len=1), allocatable, target :: letters(:)
    integer(hid_t) :: type
    integer :: flag

    if (self%failed()) return
    call letters_of(values, letters)
    call make_text_type(size(letters)/max(size(values), 1), type)
    call write_block(self, path, type, type, shape(values, hsize_t), c_loc(letters))
    call h5tclose_f(type, flag)
  end procedure write_words

  !> Make the dataset `path` and fill it from memory. HDF5 refuses the handle of whatever could not
  !> be made, so all flags are checked at once.
  subroutine write_block(self, path, file_type, memory_type, extent, address)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(hid_t), intent(in) :: file_type, memory_type
    integer(hsize_t), intent(in) :: extent(:)
    type(c_ptr), intent(in) :: address
    integer(hid_t) :: space, properties, dataset
    integer(hsize_t) :: chunk(size(extent))
    integer :: flag(9), rank
    logical :: compressed

    if (self%failed()) return
    if (.not. self%writable .or. self%id == closed) then
      call self%record_error(exit_bug, "'"//path//"' was to be written, but the file is not open for writing")
      return
    end if

    flag = 0
    rank = size(extent)
    space = self%single_value
    if (rank > 0) call h5screate_simple_f(rank, extent, space, flag(1))
    properties = self%dataset_properties
    compressed = self%compression > 0 .and. rank > 0 .and. product(extent) > 0
    if (compressed) then
      call h5pcopy_f(self%dataset_properties, properties, flag(2))
      chunk = extent
      chunk(rank) = max(1_hsize_t, min(extent(rank), chunk_size/product(extent(:rank - 1))))
      call h5pset_chunk_f(properties, rank, chunk, flag(3))
      call h5pset_shuffle_f(properties, flag(4))
      call h5pset_deflate_f(properties, self%compression, flag(5))
    end if
    call h5dcreate_f(self%id, path, file_type, space, dataset, flag(6), dcpl_id=properties)
    if (flag(6) /= 0) then
      if (self%has(path)) then
        call self%record_error(exit_bug, "'"//path//"' is already there")
      else
        call self%group(path(:index(path, '/', back=.true.) - 1))
        call h5dcreate_f(self%id, path, file_type, space, dataset, flag(6), dcpl_id=properties)
      end if
    end if
    if (flag(6) == 0) then
      if (product(extent) > 0) call h5dwrite_f(dataset, memory_type, address, flag(7))
      call self%keep_object(path, dataset)
    end if
    if (compressed) call h5pclose_f(properties, flag(8))
    if (rank > 0) call h5sclose_f(space, flag(9))
    if (any(flag /= 0)) call self%record_error(exit_machine, "the dataset '"//path//"' cannot be written (disk full?)")
  end subroutine write_block

end submodule hdf5_file_write
