!> File descriptors of the C library: opening for reading, and closing.
module file_descriptors
  use, intrinsic :: iso_c_binding, only: c_char, c_int
  implicit none
  private
  public :: c_close, c_open, read_only

  !> O_RDONLY.
  integer(c_int), parameter :: read_only = 0

  interface
    function c_open(path, flags) bind(c, name='open') result(descriptor)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags
      integer(c_int) :: descriptor
    end function c_open

    function c_close(descriptor) bind(c, name='close') result(status)
      import :: c_int
      integer(c_int), value :: descriptor
      integer(c_int) :: status
    end function c_close
  end interface

end module file_descriptors
