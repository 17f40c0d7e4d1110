!> Where contact begins and ends along the contour of the part, at an accepted instant.
module contact_ends
  use kinds, only: wp
  implicit none
  private
  public :: contact_end_t

  !> One point of the contour. Along the contour, the part on the left, contact begins or ends there.
  type :: contact_end_t
    logical :: begins = .true.
    !> Contact group, side in it, parent coordinate on the side [-].
    integer :: group = 0
    integer :: side = 0
    real(wp) :: place = 0.0_wp
    !> Piece of the group's die, 0 where the die is out of reach, and parent coordinate on it [-].
    integer :: piece = 0
    real(wp) :: xi = 0.0_wp
  end type contact_end_t
end module contact_ends
