!> Conditions on numbers in a checkpoint before they are used: each rule names the member, its value, and what is wanted.
!>
!> A file records its first error and does nothing after it, so that a rule may be applied to members that were not read any more.
module exchange_rules
  use errors, only: exit_input
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: require, require_range

  !> `require_range(file, place, values, low, high)`: all values are from `low` to `high`.
  interface require_range
    module procedure :: require_integer
    module procedure :: require_integers
    module procedure :: require_reals
  end interface require_range

contains

  !> Something must hold; `wanted` is put behind the name of the member.
  subroutine require(file, place, holds, wanted)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place   !! path of the member
    logical, intent(in) :: holds
    character(len=*), intent(in) :: wanted

    if (.not. holds) call file%record_error(exit_input, "'"//place//"' "//wanted)
  end subroutine require

  subroutine require_integer(file, place, value, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: value
    integer, intent(in), optional :: low, high

    call require_integers(file, place, [value], low, high)
  end subroutine require_integer

  subroutine require_integers(file, place, values, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: values(:)   !! (n)
    integer, intent(in), optional :: low, high
    integer :: k, lowest, highest

    lowest = -huge(lowest)
    highest = huge(highest)
    if (present(low)) lowest = low
    if (present(high)) highest = high
    do k = 1, size(values)
      if (values(k) >= lowest .and. values(k) <= highest) cycle
      if (highest < huge(highest)) then
        call refuse(file, place, to_text(values(k)), to_text(lowest)//' to '//to_text(highest))
      else
        call refuse(file, place, to_text(values(k)), to_text(lowest)//' or more')
      end if
      return
    end do
  end subroutine require_integers

  subroutine require_reals(file, place, values, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(in) :: values(:)   !! (n) [of any unit]
    real(wp), intent(in), optional :: low, high
    real(wp) :: lowest, highest
    integer :: k

    lowest = -huge(lowest)
    highest = huge(highest)
    if (present(low)) lowest = low
    if (present(high)) highest = high
    do k = 1, size(values)
      if (values(k) >= lowest .and. values(k) <= highest) cycle
      if (highest < huge(highest)) then
        call refuse(file, place, to_text(values(k)), to_text(lowest)//' to '//to_text(highest))
      else
        call refuse(file, place, to_text(values(k)), to_text(lowest)//' or more')
      end if
      return
    end do
  end subroutine require_reals

  subroutine refuse(file, place, found, wanted)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place, found, wanted

    call require(file, place, .false., 'holds '//found//', where '//wanted//' is wanted')
  end subroutine refuse

end module exchange_rules
