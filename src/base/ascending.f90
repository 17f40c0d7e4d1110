!> Places in ascending numbers.
module ascending
  use kinds, only: wp
  implicit none
  private
  public :: count_up_to

contains

  !> How many of ascending numbers are not above a number, by halving.
  pure function count_up_to(numbers, x) result(n)
    real(wp), intent(in) :: numbers(:), x   !! (nnumber) and one more, all of one unit
    integer :: n
    integer :: above, middle

    n = 0
    above = size(numbers) + 1
    do while (above - n > 1)
      middle = (n + above)/2
      if (numbers(middle) <= x) then
        n = middle
      else
        above = middle
      end if
    end do
  end function count_up_to

end module ascending
