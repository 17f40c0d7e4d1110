!> One value out of a JSON file that `json_writer` wrote: those of the outermost object, a line each. No reader for JSON of others.
module json_lookup
  use atomic, only: read_text
  use errors, only: error_t
  use kinds, only: wp
  use system, only: file_exists
  implicit none
  private
  public :: json_number, json_text, read_json

contains

  !> The text of a file; '' where there is none, or where it cannot be read.
  subroutine read_json(path, json)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: json
    type(error_t), allocatable :: ignored

    json = ''
    if (file_exists(path)) call read_text(path, json, ignored)
  end subroutine read_json

  !> The value called `name` as it is written, a text without its quotes; '' where there is none, or it is null.
  pure function json_text(json, name) result(found)
    character(len=*), intent(in) :: json, name
    character(len=:), allocatable :: found
    character(len=:), allocatable :: start
    integer :: first, last

    found = ''
    start = new_line('a')//'  "'//name//'": '
    first = index(json, start)
    if (first == 0) return
    first = first + len(start)
    last = first + scan(json(first:)//new_line('a'), new_line('a')) - 2
    if (last >= first) last = last - merge(1, 0, json(last:last) == ',')
    if (last > first) then
      if (json(first:first) == '"' .and. json(last:last) == '"') then
        first = first + 1
        last = last - 1
      end if
    end if
    found = json(first:last)
    if (found == 'null') found = ''
  end function json_text

  !> The same as a number; `default` where there is none.
  pure function json_number(json, name, default) result(number)
    character(len=*), intent(in) :: json, name
    real(wp), intent(in) :: default
    real(wp) :: number
    character(len=:), allocatable :: written
    integer :: status

    number = default
    written = json_text(json, name)
    if (written == '') return
    read (written, *, iostat=status) number
    if (status /= 0) number = default
  end function json_number

end module json_lookup
