!> The length that a corner of a die stands for where it presses into a side between two points (corner_contact).
!>
!> It is that of the interval between them. Toward an end of the side the weight goes to zero: the load of a corner that a node
!> slides past goes over to the node gradually, and back again; a sudden change would leave positions without equilibrium.
module corner_weights
  use kinds, only: wp
  implicit none
  private
  public :: corner_weight, handing_over, interval_before, share_of_corner

  !> A corner nearer than this to an end of the side, in xi, has lost a part of its weight to the node there.
  real(wp), parameter :: handing_over = 0.05_wp

contains

  !> Share of its weight that a corner at a position on the side has.
  elemental function share_of_corner(place) result(share)
    real(wp), intent(in) :: place
    real(wp) :: share

    share = min(1.0_wp, (1 - abs(place))/handing_over)
  end function share_of_corner

  !> Weight of a corner at a position on the side, in the interval before a point.
  pure function corner_weight(xi, p, place) result(weight)
    real(wp), intent(in) :: xi(:)   !! (npoint) of the side [-]
    integer, intent(in) :: p
    real(wp), intent(in) :: place   !! [-]
    real(wp) :: weight
    real(wp) :: from, to

    call interval_before(xi, p, from, to)
    weight = (to - from)*share_of_corner(place)
  end function corner_weight

  !> The part of the side between a point and the one before; the last one goes on to the end of the side.
  pure subroutine interval_before(xi, p, from, to)
    real(wp), intent(in) :: xi(:)   !! (npoint) [-]
    integer, intent(in) :: p
    real(wp), intent(out) :: from, to   !! [-]

    from = -1
    if (p > 1) from = xi(p - 1)
    to = xi(p)
    if (p == size(xi)) to = 1
  end subroutine interval_before

end module corner_weights
