!> Lines for the standard output and the stream of errors, each written at once; what cannot be written is an error.
!>
!> Fortran's own unit ends the program with a message of the run-time library, or loses the lines silently, depending on when
!> its buffer is emptied. So lines go to the system directly.
module standard_streams
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char, c_size_t
  use errors, only: error_t, exit_machine, fail
  use file_descriptors, only: c_close, c_open, read_only
  use system, only: last_failure, reason, signals_to_errors
  use text, only: string_t
  implicit none
  private
  public :: claim_standard_streams, print_line, print_lines, print_part, print_error

  integer(c_int), parameter :: input = 0, output = 1, errors_stream = 2
  !> Codes of failure (Linux): interrupted by a signal, the reader has gone away.
  integer, parameter :: interrupted = 4, reader_gone = 32

  interface
    function c_write(descriptor, bytes, length) bind(c, name='write') result(written)
      import :: c_char, c_int, c_size_t
      integer(c_int), value :: descriptor
      character(kind=c_char), intent(in) :: bytes(*)
      integer(c_size_t), value :: length
      integer(c_size_t) :: written
    end function c_write
  end interface

contains

  !> To be called first. A stream that the program was started without is taken by /dev/null, open for reading only: the next file
  !> opened would have its number otherwise, and lines meant for the terminal would go into it; this way they are refused.
  !> The write that fails reports a reader that goes away.
  subroutine claim_standard_streams()
    integer(c_int) :: descriptor, ignored

    do
      descriptor = c_open('/dev/null'//c_null_char, read_only)
      if (descriptor < input .or. descriptor > errors_stream) exit
    end do
    if (descriptor > errors_stream) ignored = c_close(descriptor)
    call signals_to_errors()
  end subroutine claim_standard_streams

  !> A line for the standard output; none once there is an error. A reader that has gone away (`| head`) is no error.
  subroutine print_line(line, error)
    character(len=*), intent(in) :: line
    type(error_t), allocatable, intent(inout) :: error

    call print_part(line//new_line('a'), error)
  end subroutine print_line

  subroutine print_lines(lines, error)
    type(string_t), intent(in) :: lines(:)   !! (lines)
    type(error_t), allocatable, intent(inout) :: error
    integer :: k

    do k = 1, size(lines)
      call print_line(lines(k)%s, error)
    end do
  end subroutine print_lines

  !> Text for the standard output as it is, without the end of a line.
  subroutine print_part(text, error)
    character(len=*), intent(in) :: text
    type(error_t), allocatable, intent(inout) :: error
    logical :: whole

    if (allocated(error)) return
    call write_whole(output, text, whole)
    if (whole) return
    if (last_failure() == reader_gone) return
    call fail(error, exit_machine, 'cannot write to the standard output: '//reason())
  end subroutine print_part

  !> An error or a note, on the stream of errors. Where that cannot be written, only the exit code shows the error.
  subroutine print_error(message)
    character(len=*), intent(in) :: message
    logical :: ignored

    call write_whole(errors_stream, message//new_line('a'), ignored)
  end subroutine print_error

  subroutine write_whole(descriptor, text, whole)
    integer(c_int), intent(in) :: descriptor
    character(len=*), intent(in) :: text
    logical, intent(out) :: whole
    integer :: done
    integer(c_size_t) :: written

    done = 0
    do while (done < len(text))
      written = c_write(descriptor, text(done + 1:), int(len(text) - done, c_size_t))
      if (written > 0) then
        done = done + int(written)
      else if (last_failure() /= interrupted) then
        exit
      end if
    end do
    whole = done == len(text)
  end subroutine write_whole

end module standard_streams
