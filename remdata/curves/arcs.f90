!> Arcs of the contour: a range of a parabola of the part, or of a die at a given depth.
!>
!> Part and die are both traversed with the part on the left, so that xi increases along the contour on either; the depth of the
!> part's own parabolas is zero.
module arcs
  use kinds, only: wp
  use offset_parabolas, only: depth_at, offset_parabola_t
  implicit none
  private
  public :: arc_t, cut, straight

  type, extends(offset_parabola_t) :: arc_t
    !> Middle node of the part's side, 0 on a die.
    integer :: middle = 0
    !> Side of the loop that the arc is part of, or the first side of the loop that it replaces.
    integer :: side = 0
    !> Die and piece of it, 0 on the part; contact group and contact interval (loop_intervals), 0 on free sides.
    integer :: die = 0, piece = 0, group = 0, interval = 0
  end type arc_t

contains

  !> The same curve between other ends; its depth is extrapolated linearly.
  pure function cut(arc, first, last) result(shorter)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: first, last
    type(arc_t) :: shorter

    shorter = arc
    shorter%range = [first, last]
    shorter%depth = [depth_at(arc, first), depth_at(arc, last)]
  end function cut

  !> A straight arc between two points.
  pure function straight(from, to) result(arc)
    real(wp), intent(in) :: from(2), to(2)   !! [length]
    type(arc_t) :: arc

    arc%points(:, 1) = from
    arc%points(:, 2) = 0.5_wp*(from + to)
    arc%points(:, 3) = to
  end function straight

end module arcs
