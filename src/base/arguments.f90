!> Words of the command line.
module arguments
  use errors, only: error_t, exit_input, fail
  use text, only: nearest_word, string_t
  implicit none
  private
  public :: argument, value_of, refuse_option

contains

  subroutine argument(k, word)
    integer, intent(in) :: k
    character(len=:), allocatable, intent(out) :: word
    integer :: length

    call get_command_argument(k, length=length)
    allocate (character(len=length) :: word)
    if (length > 0) call get_command_argument(k, word)
  end subroutine argument

  !> The argument after an option.
  subroutine value_of(option, k, value, error)
    character(len=*), intent(in) :: option
    integer, intent(inout) :: k
    character(len=:), allocatable, intent(inout) :: value
    type(error_t), allocatable, intent(inout) :: error

    if (k == command_argument_count()) then
      call fail(error, exit_input, option//': a value is missing after it', '--help shows how to call')
      return
    end if
    k = k + 1
    call argument(k, value)
  end subroutine value_of

  !> An option that `program` does not know.
  subroutine refuse_option(word, known, program, error)
    character(len=*), intent(in) :: word, program
    type(string_t), intent(in) :: known(:)   !! (nknown)
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: nearest

    nearest = nearest_word(word, known)
    if (nearest /= '') nearest = '; nearest: '''//nearest//''''
    call fail(error, exit_input, 'unknown option '''//word//''''//nearest, program//' --help shows how to call')
  end subroutine refuse_option

end module arguments
