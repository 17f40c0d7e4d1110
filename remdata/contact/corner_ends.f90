!> Ends of contact beside a corner of the part that a corner of a die has pressed into it.
!>
!> Where matter flows around a sharp corner of a die, the part has a re-entrant corner there, and contact ends a fraction of a side
!> before it: the last side cannot follow both faces. No mesh resolves the rest; and the corner is where the new mesh needs its
!> node, for a side across it would have the die's corner inside. So contact ends in the part's corner.
module corner_ends
  use boundary_curves, only: boundary_curve_t, boundary_of_loop, joint_after, turn_at
  use boundary_sides, only: loop_t
  use die_closest_points, only: point_on_side
  use kinds, only: wp
  use loop_intervals, only: along, contact_interval_t, side_point_t
  use side_tags, only: same_tags, side_tags_t
  use vectors, only: length_of
  implicit none
  private
  public :: end_in_corners

contains

  !> Move ends of intervals, but those in corners of a die already, to the re-entrant corners of the part that are nearer than
  !> `least`, as long as no other interval is between them.
  pure subroutine end_in_corners(loop, tags, x, turn, least, intervals)
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: turn      !! of a corner [radian]
    real(wp), intent(in) :: least     !! [length]
    type(contact_interval_t), intent(inout) :: intervals(:)   !! (ninterval) in their order along the loop
    type(boundary_curve_t) :: boundary
    type(side_point_t) :: corner
    integer :: k, nside, other
    logical :: found

    nside = size(loop%sides, 2)
    boundary = boundary_of_loop(loop, x, turn)
    do k = 1, size(intervals)
      other = modulo(k, size(intervals)) + 1
      call find_corner(intervals(k)%to, 1, corner, found)
      found = found .and. .not. intervals(k)%to_corner(2)
      if (found .and. is_before(corner, intervals(other)%from, other <= k)) then
        corner%piece = intervals(k)%to%piece
        intervals(k)%to = corner
        intervals(k)%found(2) = corner
      end if
      other = modulo(k - 2, size(intervals)) + 1
      call find_corner(intervals(k)%from, -1, corner, found)
      found = found .and. .not. intervals(k)%to_corner(1)
      if (found .and. is_before(intervals(other)%to, corner, other >= k)) then
        corner%piece = intervals(k)%from%piece
        intervals(k)%from = corner
        intervals(k)%found(1) = corner
      end if
    end do

  contains

    !> First corner past an end of contact, in the sense of the loop (1) or against it (-1), over sides of the same tags.
    pure subroutine find_corner(from, towards, corner, found)
      type(side_point_t), intent(in) :: from
      integer, intent(in) :: towards
      type(side_point_t), intent(out) :: corner
      logical, intent(out) :: found
      real(wp) :: length
      integer :: first, side, joint

      found = .false.
      length = 0
      corner = from
      first = from%side
      do
        side = corner%side
        length = length + length_of(point_on_side(loop, x, side_point_t(side, real(towards, wp))) - point_on_side(loop, x, corner))
        if (length > least .or. abs(side - first) >= nside .or. side < 1) return
        corner = side_point_t(side, real(towards, wp))
        joint = merge(joint_after(boundary, wrapped(side)), wrapped(side), towards > 0)
        if (abs(turn_at(boundary, joint)) > turn) then
          ! the part is on the left of its contour; an end that is there already stays
          found = turn_at(boundary, joint) < 0 .and. length > 0
          return
        end if
        if (.not. same_tags(tags, wrapped(side), wrapped(side + towards))) return
        corner = side_point_t(side + towards, real(-towards, wp))
      end do
    end subroutine find_corner

    !> A point of one interval comes before that of the next one, counted on around the loop where that is the first.
    pure function is_before(one, next, around) result(yes)
      type(side_point_t), intent(in) :: one, next
      logical, intent(in) :: around
      logical :: yes

      yes = along(one) <= along(next) + merge(nside, 0, around)
    end function is_before

    pure function wrapped(side) result(number)
      integer, intent(in) :: side
      integer :: number

      number = modulo(side - 1, nside) + 1
    end function wrapped

  end subroutine end_in_corners

end module corner_ends
