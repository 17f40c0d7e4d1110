!> Contact along the contour of a contact group: where it begins and ends, and how deep the part is in the die.
!>
!> Between a point in contact and an open one of the same side, or of two sides that share a node,
!> contact ends where the depth of the side is zero (contact_scan): on the one side or on the other, as the node they share is
!> in the die or not. It also ends where the contour does.
module contact_contour
  use closest_point, only: closest_point_t
  use contact_ends, only: contact_end_t
  use contact_scan, only: deepest_sample, is_near, lies_inside, locate_end
  use dies, only: die_t, in_pilot_axes
  use kinds, only: wp
  use law_api, only: contact_open
  use quadrature, only: line_rule, rule_control
  use scene, only: group_t
  use vectors, only: length_of
  implicit none
  private
  public :: find_contact_ends, sample_depth

  !> What is needed of a side: which it is, its nodes in the pilot's axes, the distance within which it searches.
  type :: side_t
    integer :: number = 0
    real(wp) :: nodes(2, 3) = 0.0_wp, reach = 0.0_wp
  end type side_t

contains

  !> Points of the contour where contact begins and ends, side after side.
  subroutine find_contact_ends(group, number, die, pilot, first, x, status, penetration, ends)
    type(group_t), intent(in) :: group
    integer, intent(in) :: number   !! of the group in the scene
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)                             !! (x, y, angle) now [length and radian]
    real(wp), intent(in) :: first(:, :)                          !! (2, nnode) nodes of the mesh as it began [length]
    real(wp), intent(in) :: x(:, :)                              !! (2, nnode) and now [length]
    integer, intent(in) :: status(:, :)                          !! (npoint, nside) of the points
    real(wp), intent(in) :: penetration(:, :)                    !! (npoint, nside) [length]
    type(contact_end_t), allocatable, intent(inout) :: ends(:)   !! (nend) those of this group are added
    type(side_t) :: side, next
    real(wp), allocatable :: xi(:), weight(:)
    integer :: e, p, n, after
    logical, allocatable :: closed(:, :)

    call line_rule(group%rule, xi, weight)
    n = size(xi)
    allocate (closed(n, size(status, 2)))
    closed = status /= contact_open
    ! a control point holds the direction in which a side leaves the die at its end: contact ends there
    if (group%rule%family == rule_control) closed(2, :) = merge(all(closed([1, 3], :), 1), closed(2, :), any(closed([1, 3], :), 1))
    do e = 1, size(status, 2)
      side = side_of(group, e, pilot, first, x)
      if (closed(1, e) .and. neighbour(group, e, -1) == 0) call add(side, -1.0_wp, -1.0_wp, [1.0_wp, 1.0_wp], .true.)
      do p = 1, n - 1
        if (closed(p, e) .and. .not. closed(p + 1, e)) call add(side, xi(p), xi(p + 1), penetration([p, p + 1], e), .false.)
        if (closed(p + 1, e) .and. .not. closed(p, e)) call add(side, xi(p + 1), xi(p), penetration([p + 1, p], e), .true.)
      end do
      after = neighbour(group, e, 1)
      if (after == 0) then
        if (closed(n, e)) call add(side, 1.0_wp, 1.0_wp, [1.0_wp, 1.0_wp], .false.)
      else if (closed(n, e) .neqv. closed(1, after)) then
        next = side_of(group, after, pilot, first, x)
        if (closed(n, e) .neqv. lies_inside(die, side%nodes, 1.0_wp, side%reach)) then
          ! the zero is on the closed point's own side
          if (closed(n, e)) call add(side, xi(n), 1.0_wp, [penetration(n, e), min(penetration(n, e), 0.0_wp)], .false.)
          if (closed(1, after)) call add(side, 1.0_wp, xi(n), [0.0_wp, penetration(n, e)], .true.)
        else
          if (closed(n, e)) call add(next, -1.0_wp, xi(1), [0.0_wp, penetration(1, after)], .false.)
          if (closed(1, after)) call add(next, xi(1), -1.0_wp, [penetration(1, after), min(penetration(1, after), 0.0_wp)], .true.)
        end if
      end if
    end do

  contains

    subroutine add(side, closed, open, depths, begins)
      type(side_t), intent(in) :: side
      real(wp), intent(in) :: closed, open, depths(2)
      logical, intent(in) :: begins
      type(contact_end_t) :: one
      type(closest_point_t) :: closest

      call locate_end(die, side%nodes, closed, open, depths, side%reach, one%place, closest)
      one%begins = begins
      one%group = number
      one%side = side%number
      one%piece = closest%piece
      one%xi = closest%xi
      ends = [ends, one]
    end subroutine add

  end subroutine find_contact_ends

  !> Largest depth of the sides of a group in their die over a dense sampling, and that over what each side allows.
  pure subroutine sample_depth(group, die, pilot, first, x, allowed, depth, ratio)
    type(group_t), intent(in) :: group
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)      !! (x, y, angle) now [length and radian]
    real(wp), intent(in) :: first(:, :)   !! (2, nnode) nodes of the mesh as it began [length]
    real(wp), intent(in) :: x(:, :)       !! (2, nnode) and now [length]
    real(wp), intent(in) :: allowed       !! penetration over the side, 0 when none is stated
    real(wp), intent(out) :: depth        !! [length], 0 when all is outside
    real(wp), intent(out) :: ratio
    type(side_t) :: side
    real(wp) :: deepest
    integer :: e

    depth = 0
    ratio = 0
    do e = 1, size(group%connectivity, 2)
      side = side_of(group, e, pilot, first, x)
      if (.not. is_near(die, side%nodes, side%reach)) cycle
      deepest = deepest_sample(die, side%nodes, side%reach)
      depth = max(depth, deepest)
      if (allowed > 0) ratio = max(ratio, deepest/(allowed*side%reach))
    end do
  end subroutine sample_depth

  pure function side_of(group, number, pilot, first, x) result(side)
    type(group_t), intent(in) :: group
    integer, intent(in) :: number
    real(wp), intent(in) :: pilot(3), first(:, :), x(:, :)
    type(side_t) :: side

    associate (nodes => group%connectivity(:, number))
      side%number = number
      side%nodes = in_pilot_axes(x(:, nodes), pilot)
      side%reach = length_of(first(:, nodes(3)) - first(:, nodes(1)))
    end associate
  end function side_of

  !> The side of the group before (-1) or after (1) a side, 0 when there is none.
  pure function neighbour(group, side, way) result(next)
    type(group_t), intent(in) :: group
    integer, intent(in) :: side, way
    integer :: next

    if (way > 0) then
      next = findloc(group%connectivity(1, :), group%connectivity(3, side), 1)
    else
      next = findloc(group%connectivity(3, :), group%connectivity(1, side), 1)
    end if
  end function neighbour

end module contact_contour
