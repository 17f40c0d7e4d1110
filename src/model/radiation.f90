!> Radiation between two surfaces: the difference of the fourth powers of their absolute temperatures (J. Stefan 1879; L. Boltzmann
!> 1884).
!>
!> An iterate of a long step may lie below absolute zero. There T**4 would release more heat the colder it is, and the balance would
!> have a second solution, of no meaning; as T**3 |T| it is monotone, and has one.
module radiation
  use kinds, only: wp
  implicit none
  private
  public :: fourth_powers

contains

  !> a**4 - b**4 of absolute temperatures, and its derivatives.
  pure subroutine fourth_powers(a, b, difference, by_a, by_b)
    real(wp), intent(in) :: a, b         !! [absolute temperature]
    real(wp), intent(out) :: difference  !! [temperature^4]
    real(wp), intent(out) :: by_a, by_b  !! [temperature^3]

    if (min(a, b) >= 0) then
      ! without the loss of digits where they are close
      difference = (a - b)*(a + b)*(a**2 + b**2)
    else
      difference = a**3*abs(a) - b**3*abs(b)
    end if
    by_a = 4*abs(a)**3
    by_b = -4*abs(b)**3
  end subroutine fourth_powers

end module radiation
