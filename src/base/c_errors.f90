!> What the C library says of its last failure (errno is found as glibc and musl keep it), and texts that it keeps.
module c_errors
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_int, c_ptr, c_size_t
  implicit none
  private
  public :: last_failure, reason, text_of_c

  interface
    function c_errno() bind(c, name='__errno_location') result(address)
      import :: c_ptr
      type(c_ptr) :: address
    end function c_errno

    function c_strerror(number) bind(c, name='strerror') result(address)
      import :: c_int, c_ptr
      integer(c_int), value :: number
      type(c_ptr) :: address
    end function c_strerror

    function c_strlen(address) bind(c, name='strlen') result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: address
      integer(c_size_t) :: length
    end function c_strlen
  end interface

contains

  !> Why the last call to the C library failed: the system's number.
  function last_failure() result(number)
    integer :: number
    integer(c_int), pointer :: kept

    call c_f_pointer(c_errno(), kept)
    number = int(kept)
  end function last_failure

  !> The same in the system's words.
  function reason() result(words)
    character(len=:), allocatable :: words

    words = text_of_c(c_strerror(int(last_failure(), c_int)))
    if (words == '') words = 'unknown reason'
  end function reason

  !> The text that C keeps at an address, '' where there is none.
  function text_of_c(address) result(words)
    type(c_ptr), intent(in) :: address
    character(len=:), allocatable :: words
    character(kind=c_char), pointer :: letters(:)
    integer :: i

    words = ''
    if (.not. c_associated(address)) return
    call c_f_pointer(address, letters, [c_strlen(address)])
    words = repeat(' ', size(letters))
    do i = 1, size(letters)
      words(i:i) = letters(i)
    end do
  end function text_of_c

end module c_errors
