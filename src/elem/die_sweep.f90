!> What a side passes in a step: a die that moves further than the search for closest points reaches, relative to the side, may be
!> on its other side at the end of the step, where nothing tells that they met.
!>
!> Paths of places along the side are straight in the axes of the die.
module die_sweep
  use dies, only: die_t
  use kinds, only: wp
  use path_crossings, only: share_before_passing
  use plane_vectors, only: turned
  use rigid_contact, only: place_point, side_t
  use side_points, only: contact_point_t
  use vectors, only: length_of
  implicit none
  private
  public :: share_to_pass

  !> Relative motion within this share of the reach cannot lose a die: a point ends within reach of the wall that it went through.
  real(wp), parameter :: safe = 0.5_wp
  !> Places along a side.
  integer, parameter :: nplace = 9

contains

  !> Share of the step after which a side begins to go through its die; 1 when it does not.
  pure function share_to_pass(die, side) result(share)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp) :: share
    type(side_t) :: start
    type(contact_point_t) :: before, after
    real(wp) :: xi, from(2), to(2), way
    integer :: k

    share = 1
    if (.not. largest_motion(side) > safe*side%length) return
    start = side
    start%du = 0
    do k = 1, nplace
      xi = -1 + 2*real(k - 1, wp)/(nplace - 1)
      call place_point(start, xi, before)
      call place_point(side, xi, after)
      from = turned(before%x - side%pilot(1:2, 1), -side%pilot(3, 1))
      to = turned(after%x - side%pilot(1:2, 2), -side%pilot(3, 2))
      way = length_of(to - from)
      if (.not. way > safe*side%length) cycle
      xi = share_before_passing(die, from, to, turned(after%e_r, -side%pilot(3, 2)), side%length)
      if (xi < 1) share = min(share, max(xi, safe*side%length/way))
    end do
  end function share_to_pass

  !> Largest motion of the side's nodes in the axes of the die [length].
  pure function largest_motion(side) result(motion)
    type(side_t), intent(in) :: side
    real(wp) :: motion
    integer :: k

    motion = 0
    do k = 1, 3
      motion = max(motion, length_of(turned(side%x(:, k) + side%du([k, k + 3]) - side%pilot(1:2, 2), -side%pilot(3, 2)) &
                                     - turned(side%x(:, k) - side%pilot(1:2, 1), -side%pilot(3, 1))))
    end do
  end function largest_motion

end module die_sweep
