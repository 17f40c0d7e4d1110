!> Variables of the environment of this process.
module environment
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  use c_errors, only: reason
  use errors, only: error_t, exit_machine, fail
  implicit none
  private
  public :: from_environment, in_environment, set_environment

  interface
    function c_setenv(name, value, overwrite) bind(c, name='setenv') result(status)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: name(*), value(*)
      integer(c_int), value :: overwrite
      integer(c_int) :: status
    end function c_setenv
  end interface

contains

  !> Is there a variable of one of these names, be it empty?
  function in_environment(names) result(is_set)
    character(len=*), intent(in) :: names(:)   !! (nname)
    logical :: is_set
    integer :: k, status

    is_set = .false.
    do k = 1, size(names)
      call get_environment_variable(trim(names(k)), status=status)
      is_set = is_set .or. status /= 1
    end do
  end function in_environment

  !> The value of a variable, '' where there is none.
  function from_environment(name) result(value)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: value
    integer :: length

    call get_environment_variable(name, length=length)
    allocate (character(len=length) :: value)
    if (length > 0) call get_environment_variable(name, value)
  end function from_environment

  !> Set a variable of the environment of this process, unless it is set and `overwrite` is false.
  subroutine set_environment(name, value, error, overwrite)
    character(len=*), intent(in) :: name, value
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: overwrite
    integer(c_int) :: replace

    replace = 1
    if (present(overwrite)) replace = merge(1_c_int, 0_c_int, overwrite)
    if (c_setenv(name//c_null_char, value//c_null_char, replace) /= 0) &
      call fail(error, exit_machine, 'cannot set the environment variable '//name//': '//reason())
  end subroutine set_environment

end module environment
