!> Corners of a rigid die near the ends of a side.
!>
!> A side that lies along a face of the corner slides past it node by node: the load of the corner goes over to the node, which the
!> face presses then (corner_weights). Where both faces turn away from the side there is none to press the node, as at the edge of
!> a knife or of a die that a strip is drawn over: the node would be left with less than the corner had, and the edge would fall
!> into the node and have to be pushed out of it again. Such a corner passes the node as the edge of a body does: it acts on both
!> sides, on each as if that went on beyond its end, with shares whose sum is one, and takes the pressure at the node meanwhile.
!>
!> How far a corner passes, 0 to 1, goes with the sine by which the nearer face turns away from the side at its end as the step
!> begins; it is the same for all of the step. No corner passes a node on the axis.
module passing_corners
  use corner_weights, only: handing_over, interval_before, share_at_node, share_past_node
  use dies, only: die_t
  use kinds, only: wp
  use plane_vectors, only: left_of
  use rigid_contact, only: nodes_in_axes, side_at_start, side_t
  use shape_functions, only: line3
  use side_corners, only: corner_t, corner_within
  implicit none
  private
  public :: corner_at_side, deepest_at_side, share_of, slope_of_share, taken_by_corners

  !> Sine by which the nearer face turns away from a side: none of a corner passes the node below the first, all above the second.
  real(wp), parameter :: along_face = 0.2_wp, away = 0.4_wp
  !> It takes the pressure of a node that is as near to it as this, in xi, and none of one twice as far away.
  real(wp), parameter :: near = 0.25_wp

contains

  !> A corner of a die, if it is between two positions on a side, or passes the node at an end of it.
  pure subroutine corner_at_side(die, number, side, nodes, from, to, corner)
    type(die_t), intent(in) :: die
    integer, intent(in) :: number         !! of the corner
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: nodes(2, 3)   !! of the side, in the pilot's axes [length]
    real(wp), intent(in) :: from, to      !! positions on the side; `to` belongs to the next interval
    type(corner_t), intent(out) :: corner

    call corner_within(die, number, nodes, from, to, side%length, handing_over, corner)
    if (.not. corner%found) return
    if (1 - abs(corner%place) < handing_over) corner%passing = passing(die, number, side, corner%place)
    corner%found = abs(corner%place) < 1 .or. corner%passing > 0
  end subroutine corner_at_side

  !> The deepest of them.
  pure subroutine deepest_at_side(die, side, nodes, from, to, corner)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: nodes(2, 3)   !! of the side, in the pilot's axes [length]
    real(wp), intent(in) :: from, to      !! positions on the side; `to` belongs to the next interval
    type(corner_t), intent(out) :: corner
    type(corner_t) :: one
    integer :: k

    do k = 1, size(die%corners, 2)
      call corner_at_side(die, k, side, nodes, from, to, one)
      if (.not. one%found) cycle
      if (.not. corner%found .or. one%d > corner%d) corner = one
    end do
  end subroutine deepest_at_side

  !> How far a corner passes the node at the end of a side that is nearer to a place on it.
  pure function passing(die, number, side, place)
    type(die_t), intent(in) :: die
    integer, intent(in) :: number     !! of the corner
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place     !! [-]
    real(wp) :: passing               !! 0 to 1
    real(wp) :: phi(3), dphi(3), inner(2)

    passing = 0
    if (side%axis_end == merge(1, 2, place < 0)) return
    call line3(sign(1.0_wp, place), phi, dphi)
    inner = left_of(matmul(nodes_in_axes(side_at_start(side)), dphi))
    passing = min(dot_product(inner, die%corners(3:4, number)), -dot_product(inner, die%corners(5:6, number)))
    passing = max(0.0_wp, min(1.0_wp, (passing - along_face)/(away - along_face)))
  end function passing

  !> How much of the pressure at this point, at a node, corners that pass have taken as the step began, 0 to 1. A step may be longer
  !> than the way on which they go over to the next side: they have it before.
  pure function taken_by_corners(die, side, xi, p) result(taken)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)   !! (npoint) [-]
    integer, intent(in) :: p
    real(wp) :: taken
    type(corner_t) :: corner
    type(side_t) :: start
    real(wp) :: nodes(2, 3), from, to
    integer :: k

    taken = 0
    if (abs(xi(p)) < 1 .or. size(die%corners, 2) == 0) return
    start = side_at_start(side)
    nodes = nodes_in_axes(start)
    call interval_before(xi, max(p, 2), from, to)
    do k = 1, size(die%corners, 2)
      call corner_at_side(die, k, start, nodes, from, to, corner)
      if (.not. corner%found) cycle
      taken = max(taken, passing(die, k, side, xi(p))*max(0.0_wp, min(1.0_wp, 2 - abs(corner%place - xi(p))/near)))
    end do
  end function taken_by_corners

  !> Share of its weight that a corner has on a side.
  elemental function share_of(corner) result(share)
    type(corner_t), intent(in) :: corner
    real(wp) :: share

    share = (1 - corner%passing)*share_at_node(corner%place) + corner%passing*share_past_node(corner%place)
  end function share_of

  !> Derivative of it by the place of the corner.
  elemental function slope_of_share(corner) result(slope)
    type(corner_t), intent(in) :: corner
    real(wp) :: slope

    slope = 0
    if (1 - abs(corner%place) < handing_over) slope = -corner%passing/(2*handing_over)
    if (1 - abs(corner%place) < handing_over .and. abs(corner%place) < 1) slope = slope - (1 - corner%passing)/handing_over
    slope = slope*sign(1.0_wp, corner%place)
  end function slope_of_share

end module passing_corners
