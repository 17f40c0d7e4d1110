!> Paths as text: their last name, the directory before it, and names seen from a directory.
module file_paths
  implicit none
  private
  public :: base_name, directory_of, join_path, path_beside, plain_path

contains

  !> Cut a path at its last slash: `directory` ('.' when there is none) and `name`.
  pure subroutine split_path(path, directory, name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: directory, name
    integer :: slash

    slash = index(path, '/', back=.true.)
    name = path(slash + 1:)
    if (slash == 0) then
      directory = '.'
    else
      directory = path(:max(slash - 1, 1))
    end if
  end subroutine split_path

  !> What follows the last slash.
  pure function base_name(path) result(name)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: name, directory

    call split_path(path, directory, name)
  end function base_name

  !> What stands before the last slash, '.' when there is none.
  pure function directory_of(path) result(directory)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: directory, name

    call split_path(path, directory, name)
  end function directory_of

  !> `name` seen from `directory`; an absolute name stays as it is.
  pure function join_path(directory, name) result(path)
    character(len=*), intent(in) :: directory, name
    character(len=:), allocatable :: path

    path = name
    if (index(name, '/') == 1 .or. directory == '' .or. directory == '.') return
    path = directory//'/'//name
    if (directory(len(directory):) == '/') path = directory//name
  end function join_path

  !> `a/./b/../c` -> `a/c`, so that a cycle is seen whatever way it is written.
  pure function plain_path(path) result(plain)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: plain
    integer :: first, past, cut

    plain = ''
    first = 1
    do while (first <= len(path))
      past = first + index(path(first:)//'/', '/') - 1
      select case (path(first:past - 1))
      case ('.')
      case ('..')
        cut = index(plain, '/', back=.true.)
        if (cut == 0 .or. plain(cut + 1:) == '..') then
          plain = plain//'/..'
        else
          plain = plain(:cut - 1)
        end if
      case default
        plain = plain//'/'//path(first:past - 1)
      end select
      first = past + 1
    end do
  end function plain_path

  !> `name` seen from the folder of the file `path`, in the way that is written; an absolute name stays as it is.
  pure function path_beside(path, name) result(beside)
    character(len=*), intent(in) :: path, name
    character(len=:), allocatable :: beside

    beside = name
    if (index(name, '/') /= 1) beside = path(:index(path, '/', back=.true.))//name
  end function path_beside

end module file_paths
