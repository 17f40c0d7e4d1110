!> Entries of the lists that Linux has in /proc, as `VmHWM:   5120 kB`: a name, a colon and a value.
!>
!> Where a list is missing, or has another format, nothing is known.
module proc_entries
  use kinds, only: i8, wp
  implicit none
  private
  public :: bytes_in, longest_line, value_in

  !> A line of flags, of a list of processors or of their times is no longer than this.
  integer, parameter :: longest_line = 8192

contains

  !> What follows the colon in the first line of a file that begins with `name`; '' where there is none.
  subroutine value_in(file, name, value)
    character(len=*), intent(in) :: file, name
    character(len=:), allocatable, intent(out) :: value
    character(len=longest_line) :: line
    character(len=*), parameter :: blanks = ' '//achar(9)
    integer :: unit, status, colon, start

    value = ''
    open (newunit=unit, file=file, status='old', action='read', iostat=status)
    if (status /= 0) return
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      colon = index(line, ':')
      if (colon <= len(name) .or. line(:len(name)) /= name) cycle
      if (verify(line(len(name) + 1:colon - 1), blanks) > 0) cycle
      start = verify(line(colon + 1:), blanks)
      if (start > 0) value = line(colon + start:len_trim(line))
      exit
    end do
    close (unit)
  end subroutine value_in

  !> A number of kilobytes that follows the colon [bytes], -1 where it is not there.
  subroutine bytes_in(file, name, bytes)
    character(len=*), intent(in) :: file, name
    real(wp), intent(out) :: bytes
    character(len=:), allocatable :: value
    integer(i8) :: kilobytes
    integer :: status

    bytes = -1
    call value_in(file, name, value)
    read (value, *, iostat=status) kilobytes
    if (status == 0) bytes = 1024*real(kilobytes, wp)
  end subroutine bytes_in

end module proc_entries
