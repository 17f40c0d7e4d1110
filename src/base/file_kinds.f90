!> Kind of file that has a name in the file system: only regular files are read back, and only they are replaced by output.
!>
!> Binding to `statx` of Linux, whose structure is the same on every processor (that of `stat` is not).
module file_kinds
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_int16_t, c_int32_t, c_int64_t, c_null_char
  use errors, only: error_t, exit_machine, fail
  implicit none
  private
  public :: file_kind, kind_in_words, refuse_to_replace, same_file
  public :: nothing, regular_file, directory, symbolic_link, device, pipe_or_socket

  !> Kinds of file.
  integer, parameter :: nothing = 0, regular_file = 1, directory = 2, symbolic_link = 3, device = 4, pipe_or_socket = 5

  !> `struct statx`: what is asked for, and the rest of its 256 bytes.
  type, bind(c) :: status_t
    integer(c_int32_t) :: mask, block_size
    integer(c_int64_t) :: attributes
    integer(c_int32_t) :: links, user, group
    integer(c_int16_t) :: mode, spare
    integer(c_int64_t) :: number, before(12), device, after(14)
  end type status_t

  !> Paths are seen from the working directory; a link itself is meant, not what it leads to, or an open file; its type and number
  !> are asked for.
  integer(c_int), parameter :: working_directory = -100, no_follow = 256, empty_path = 4096, file_type = 1, file_number = 256
  !> The four bits of a mode that hold the type, and its values.
  integer, parameter :: type_place = 12, type_length = 4
  integer, parameter :: type_character = 2, type_directory = 4, type_block = 6, type_regular = 8, type_link = 10

  interface
    function c_statx(folder, path, flags, mask, status) bind(c, name='statx') result(answer)
      import :: c_char, c_int, status_t
      integer(c_int), value :: folder
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags, mask
      type(status_t), intent(out) :: status
      integer(c_int) :: answer
    end function c_statx
  end interface

contains

  !> Kind of file that has a name. A link is followed, unless `itself`; one that leads nowhere is `symbolic_link` all the same.
  function file_kind(path, itself) result(kind)
    character(len=*), intent(in) :: path
    logical, intent(in), optional :: itself
    integer :: kind
    type(status_t) :: status

    kind = nothing
    if (c_statx(working_directory, path//c_null_char, no_follow, file_type, status) /= 0) return
    kind = kind_of(status)
    if (present(itself)) then
      if (itself) return
    end if
    if (kind /= symbolic_link) return
    if (c_statx(working_directory, path//c_null_char, 0_c_int, file_type, status) == 0) kind = kind_of(status)
  end function file_kind

  !> Is an open file the one that has this name?
  function same_file(path, descriptor) result(same)
    character(len=*), intent(in) :: path
    integer, intent(in) :: descriptor   !! its number in this process; below 0: none
    logical :: same
    type(status_t) :: named, opened

    same = .false.
    if (descriptor < 0) return
    if (c_statx(working_directory, path//c_null_char, no_follow, file_number, named) /= 0) return
    if (c_statx(int(descriptor, c_int), c_null_char, empty_path, file_number, opened) /= 0) return
    same = named%number == opened%number .and. named%device == opened%device
  end function same_file

  pure function kind_of(status) result(kind)
    type(status_t), intent(in) :: status
    integer :: kind

    select case (ibits(int(status%mode), type_place, type_length))
    case (type_regular)
      kind = regular_file
    case (type_directory)
      kind = directory
    case (type_link)
      kind = symbolic_link
    case (type_character, type_block)
      kind = device
    case default
      kind = pipe_or_socket
    end select
  end function kind_of

  !> A kind of file in words, with its article.
  pure function kind_in_words(kind) result(words)
    integer, intent(in) :: kind
    character(len=:), allocatable :: words

    select case (kind)
    case (regular_file)
      words = 'a regular file'
    case (directory)
      words = 'a directory'
    case (symbolic_link)
      words = 'a symbolic link'
    case (device)
      words = 'a device'
    case (pipe_or_socket)
      words = 'a pipe or a socket'
    case default
      words = 'no file'
    end select
  end function kind_in_words

  !> Output may be put where nothing is, and in the place of a regular file; anything else is left as it is.
  subroutine refuse_to_replace(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    integer :: kind

    kind = file_kind(path, itself=.true.)
    if (kind == nothing .or. kind == regular_file) return
    call fail(error, exit_machine, "'"//path//"' is "//kind_in_words(kind)//': output replaces regular files only', &
              'move it away, or choose another name with --out')
  end subroutine refuse_to_replace

end module file_kinds
