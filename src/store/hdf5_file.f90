!> HDF5 files as the system uses them: named arrays in groups, attributes beside them.
!>
!> A file object keeps its first error, and every later call is then a cheap no-op (what is read
!> is empty or zero), so that a sequence of writes or reads needs one check at its end:
!>
!>     call file%create('out/a.h5', error)
!>     call file%write('mesh/nodes', x)
!>     call file%write_attribute('mesh/nodes', 'unit', 'mm')
!>     call file%close(error)
!>
!> Arrays keep the natural Fortran order: what is (a, b) here shows as (b, a) in C, h5py, ParaView.
!> Numbers are stored as little-endian IEEE doubles and 32-bit integers and without times, so that
!> the same run gives the same bytes on any machine. Text is UTF-8 of fixed length, padded with nulls.
!> Every file carries a hash of all its bytes, written when it is closed and compared before it is opened again.
!> The procedures live in the submodules `hdf5_file_{access,hash,write,read,attributes,structure}`.
module hdf5_file
  use hdf5, only: hid_t
  use errors, only: error_t
  use kinds, only: wp
  use text, only: string_t
  implicit none
  private
  public :: hdf5_file_t

  !> What HDF5 never gives to an open object.
  integer(hid_t), parameter :: closed = -1
  !> What stands before the part of the file that is HDF5's (hdf5_file_hash).
  integer, parameter :: user_block_length = 512

  type :: hdf5_file_t
    !> Gzip level 0-9 of the arrays written from now on; 0, the default, is none.
    integer :: compression = 0
    integer(hid_t), private :: id = closed
    logical, private :: writable = .false.
    character(len=:), allocatable, private :: file_path
    type(error_t), allocatable, private :: first_error
    !> Dataset or group used last, left open: its attributes, and its extents and values, are asked for one after the other.
    integer(hid_t), private :: object = closed
    character(len=:), allocatable, private :: object_path
    !> How groups and datasets are made, and the extent of single values; of files open for writing.
    integer(hid_t), private :: group_properties = closed, dataset_properties = closed, single_value = closed
  contains
    procedure :: create
    procedure :: open => open_to_read
    procedure :: open_append
    procedure :: close => close_file
    procedure :: status
    procedure :: failed
    procedure :: record_error
    procedure :: path => path_of_file
    procedure :: group
    procedure :: link
    procedure :: has
    procedure :: list
    procedure :: remove
    procedure :: require_shape
    procedure :: check_structure
    procedure, private :: open_object
    procedure, private :: keep_object
    procedure, private :: write_hash
    procedure, private :: check_hash

    !> `write(path, value)`: a new dataset; missing groups are made. A second one of the same name is an error.
    generic :: write => write_real, write_reals, write_reals_2, write_reals_3, write_integer, write_integers, write_integers_2, &
      write_text, write_words
    procedure, private :: write_real
    procedure, private :: write_reals
    procedure, private :: write_reals_2
    procedure, private :: write_reals_3
    procedure, private :: write_integer
    procedure, private :: write_integers
    procedure, private :: write_integers_2
    procedure, private :: write_text
    procedure, private :: write_words

    !> `read(path, value)`: a dataset of just this type and rank; arrays and texts are allocated.
    generic :: read => read_real, read_reals, read_reals_2, read_reals_3, read_integer, read_integers, read_integers_2, &
      read_text, read_words
    procedure, private :: read_real
    procedure, private :: read_reals
    procedure, private :: read_reals_2
    procedure, private :: read_reals_3
    procedure, private :: read_integer
    procedure, private :: read_integers
    procedure, private :: read_integers_2
    procedure, private :: read_text
    procedure, private :: read_words

    !> `write_attribute(path, name, value)` of a dataset or group ('/' is the root); an old value is replaced.
    generic :: write_attribute => write_text_attribute, write_integer_attribute, write_real_attribute
    procedure, private :: write_text_attribute
    procedure, private :: write_integer_attribute
    procedure, private :: write_real_attribute

    !> `read_attribute(path, name, value)`; a missing attribute is an error (ask `has_attribute`).
    generic :: read_attribute => read_text_attribute, read_integer_attribute, read_real_attribute
    procedure, private :: read_text_attribute
    procedure, private :: read_integer_attribute
    procedure, private :: read_real_attribute
    procedure :: has_attribute
  end type hdf5_file_t

  ! Opening, closing, listing: hdf5_file_access.
  interface
    !> Make a new file, in the place of any older one of this name.
    module subroutine create(self, path, error)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(error_t), allocatable, intent(out) :: error
    end subroutine create

    !> Open a file for reading. What is missing, not written by this system, cut short or altered since it was closed is refused.
    module subroutine open_to_read(self, path, error, hashed)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(error_t), allocatable, intent(out) :: error
      logical, intent(in), optional :: hashed   !! a moment ago, by reading all of it: its length is enough
    end subroutine open_to_read

    !> Open an existing file for reading and writing.
    module subroutine open_append(self, path, error)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(error_t), allocatable, intent(out) :: error
    end subroutine open_append

    !> Write out what is still in memory, close the file, and deliver the first error since it was opened.
    module subroutine close_file(self, error)
      class(hdf5_file_t), intent(inout) :: self
      type(error_t), allocatable, intent(out) :: error
    end subroutine close_file

    !> The first error so far; unallocated when there was none. The file stays open.
    pure module subroutine status(self, error)
      class(hdf5_file_t), intent(in) :: self
      type(error_t), allocatable, intent(out) :: error
    end subroutine status

    !> Was there an error since the file was opened?
    pure module function failed(self)
      class(hdf5_file_t), intent(in) :: self
      logical :: failed
    end function failed

    !> Let the file object carry an error found by the caller (a wrong schema, say), unless it has one.
    !> The path of the file is put before `message`.
    pure module subroutine record_error(self, code, message)
      class(hdf5_file_t), intent(inout) :: self
      integer, intent(in) :: code
      character(len=*), intent(in) :: message
    end subroutine record_error

    !> The path under which the file was opened last.
    pure module function path_of_file(self) result(path)
      class(hdf5_file_t), intent(in) :: self
      character(len=:), allocatable :: path
    end function path_of_file

    !> Make a group and those above it; one that is there already is fine.
    recursive module subroutine group(self, path)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
    end subroutine group

    !> Is there a dataset or a group of this name?
    module function has(self, path)
      class(hdf5_file_t), intent(in) :: self
      character(len=*), intent(in) :: path
      logical :: has
    end function has

    !> Names of the members of a group, in alphabetic order.
    module subroutine list(self, path, names)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(string_t), allocatable, intent(out) :: names(:)   !! (nname)
    end subroutine list

    !> Let `path` stand for what is at the root of another file, named as seen from the folder of this one.
    module subroutine link(self, path, other_file)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, other_file
    end subroutine link

    !> Remove a link, a dataset, or a group with all in it; nothing there is fine. The room in the file is not won back.
    module subroutine remove(self, path)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
    end subroutine remove

    !> Open the dataset or group `path`, unless it is the one used last; `self%object` is `closed` where there is none.
    module subroutine open_object(self, path)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
    end subroutine open_object

    !> An object just made, or `closed`, takes the place of the one used last.
    module subroutine keep_object(self, path, object)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer(hid_t), intent(in) :: object
    end subroutine keep_object
  end interface

  ! The hash of all bytes: hdf5_file_hash.
  interface
    !> Enter length and hash of the closed file in its user block.
    module subroutine write_hash(self)
      class(hdf5_file_t), intent(inout) :: self
    end subroutine write_hash

    !> Is the file, not opened yet, just as it was when its hash was written?
    module subroutine check_hash(self, length_alone)
      class(hdf5_file_t), intent(inout) :: self
      logical, intent(in) :: length_alone   !! its beginning and its length are compared, not its bytes
    end subroutine check_hash
  end interface

  ! Allowed contents of a file: hdf5_file_structure.
  interface
    !> Refuse an open file that has anything in it which this module does not write: links that are soft, external or lead twice to
    !> the same thing; types of other sizes, signs or byte orders; data that are not wholly there.
    module subroutine check_structure(self)
      class(hdf5_file_t), intent(inout) :: self
    end subroutine check_structure
  end interface

  ! Writing datasets: hdf5_file_write.
  interface
    module subroutine write_real(self, path, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), intent(in), target :: value
    end subroutine write_real

    module subroutine write_reals(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), intent(in), target, contiguous :: values(:)   !! (n) [of any unit]
    end subroutine write_reals

    module subroutine write_reals_2(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), intent(in), target, contiguous :: values(:, :)   !! (n1, n2) [of any unit]
    end subroutine write_reals_2

    module subroutine write_reals_3(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), intent(in), target, contiguous :: values(:, :, :)   !! (n1, n2, n3) [of any unit]
    end subroutine write_reals_3

    module subroutine write_integer(self, path, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, intent(in), target :: value
    end subroutine write_integer

    module subroutine write_integers(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, intent(in), target, contiguous :: values(:)   !! (n)
    end subroutine write_integers

    module subroutine write_integers_2(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, intent(in), target, contiguous :: values(:, :)   !! (n1, n2)
    end subroutine write_integers_2

    module subroutine write_text(self, path, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      character(len=*), intent(in) :: value
    end subroutine write_text

    module subroutine write_words(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(string_t), intent(in) :: values(:)   !! (n)
    end subroutine write_words
  end interface

  ! Reading datasets: hdf5_file_read. Reals are finite numbers, or the dataset is refused.
  interface
    !> Refuse a dataset that has not these extents (negative: any). Ask before reading where memory is allocated for a count stated
    !> elsewhere, and where what is read replaces an array of known shape.
    module subroutine require_shape(self, path, wanted)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, intent(in) :: wanted(:)   !! (rank)
    end subroutine require_shape

    module subroutine read_real(self, path, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), intent(out), target :: value
    end subroutine read_real

    module subroutine read_reals(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), allocatable, intent(out), target :: values(:)   !! (n) [of any unit]
    end subroutine read_reals

    module subroutine read_reals_2(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), allocatable, intent(out), target :: values(:, :)   !! (n1, n2) [of any unit]
    end subroutine read_reals_2

    module subroutine read_reals_3(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      real(wp), allocatable, intent(out), target :: values(:, :, :)   !! (n1, n2, n3) [of any unit]
    end subroutine read_reals_3

    module subroutine read_integer(self, path, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, intent(out), target :: value
    end subroutine read_integer

    module subroutine read_integers(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, allocatable, intent(out), target :: values(:)   !! (n)
    end subroutine read_integers

    module subroutine read_integers_2(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      integer, allocatable, intent(out), target :: values(:, :)   !! (n1, n2)
    end subroutine read_integers_2

    module subroutine read_text(self, path, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      character(len=:), allocatable, intent(out) :: value
    end subroutine read_text

    module subroutine read_words(self, path, values)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(string_t), allocatable, intent(out) :: values(:)   !! (n)
    end subroutine read_words
  end interface

  ! Attributes: hdf5_file_attributes.
  interface
    module subroutine write_text_attribute(self, path, name, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, name
      character(len=*), intent(in) :: value
    end subroutine write_text_attribute

    module subroutine write_integer_attribute(self, path, name, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, name
      integer, intent(in), target :: value
    end subroutine write_integer_attribute

    module subroutine write_real_attribute(self, path, name, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, name
      real(wp), intent(in), target :: value
    end subroutine write_real_attribute

    module subroutine read_text_attribute(self, path, name, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, name
      character(len=:), allocatable, intent(out) :: value
    end subroutine read_text_attribute

    module subroutine read_integer_attribute(self, path, name, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, name
      integer, intent(out), target :: value
    end subroutine read_integer_attribute

    module subroutine read_real_attribute(self, path, name, value)
      class(hdf5_file_t), intent(inout) :: self
      character(len=*), intent(in) :: path, name
      real(wp), intent(out), target :: value
    end subroutine read_real_attribute

    !> Is there a dataset or group of this path with an attribute of this name?
    module function has_attribute(self, path, name)
      class(hdf5_file_t), intent(in) :: self
      character(len=*), intent(in) :: path, name
      logical :: has_attribute
    end function has_attribute
  end interface

end module hdf5_file
