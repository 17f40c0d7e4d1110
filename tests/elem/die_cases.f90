!> Dies of straight pieces for the tests of contact elements.
module die_cases
  use dies, only: die_t
  use element_cases, only: die_of, segment
  use kinds, only: wp
  implicit none
  private
  public :: polyline

contains

  !> A die of straight pieces through points, walked with the part on the left.
  function polyline(points) result(die)
    real(wp), intent(in) :: points(:, :)
    type(die_t) :: die
    real(wp) :: pieces(2, 3, size(points, 2) - 1)
    integer :: k

    do k = 1, size(pieces, 3)
      pieces(:, :, k:k) = segment(points(:, k), points(:, k + 1))
    end do
    die = die_of(pieces)
  end function polyline

end module die_cases
