!> Closest points of a contact interval on its die: positions and depths that the corrected contour passes through.
!>
!> The depth of an old contact point in its die carries its pressure, p = multiplier + AKP d, so that a contour through the old
!> depths reproduces the old pressures. Only integration points are used: between them the old side deviates from the die. At its
!> ends the interval passes through the part's own point, so that the contour stays closed; so it does where the solver found an end
!> that was moved outwards (contact_intervals).
!>
!> Closest points are searched between those of the ends, along the die, and must be in sequence: a point that folded back over its
!> neighbour is skipped.
module interval_sections
  use boundary_sides, only: loop_t
  use closest_point, only: closest_point_t
  use die_closest_points, only: distance_along, find_closest_point, point_on_side
  use dies, only: die_t
  use kinds, only: wp
  use loop_intervals, only: along, contact_interval_t, is_before_corner, side_point_t
  use quadrature, only: line_rule, rule_t
  use side_tags, only: same_tags, side_tags_t
  use vectors, only: length_of
  implicit none
  private
  public :: section_t, start_at_contact_point, sections_of_interval

  !> Part of an interval on sides with the same tags.
  type :: section_t
    integer :: side = 0   !! the first side it replaces
    type(closest_point_t), allocatable :: closest_points(:)
  end type section_t

  !> Closest points nearer than this, in half pieces, coincide.
  real(wp), parameter :: coincidence_tolerance = 1.0e-9_wp

contains

  !> Where a side enters the die so steeply that a corner would be left within the shortest interval of an end of contact, at the
  !> first or last point in contact, the interval begins or ends in that point, and the corner with it. Ends shared with another
  !> interval are kept, and so is an interval that would become too short.
  pure subroutine start_at_contact_point(rule, loop, x, die, pilot, least, turn, shared, interval)
    type(rule_t), intent(in) :: rule   !! of the group's points
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)   !! (x, y, angle) of the die now [length and radian]
    real(wp), intent(in) :: least      !! shortest interval [sides]
    real(wp), intent(in) :: turn       !! of a corner [radian]
    logical, intent(in) :: shared(2)
    type(contact_interval_t), intent(inout) :: interval
    type(contact_interval_t) :: moved
    type(side_point_t) :: point
    real(wp), allocatable :: xi(:), weight(:)

    call line_rule(rule, xi, weight)
    moved = interval
    point = interval%from
    point%xi = minval(xi, mask=xi > interval%from%xi)
    if (point%xi < min(1.0_wp, interval%from%xi + 2*least) .and. .not. shared(1)) then
      if (is_steep(interval%from, point)) moved%from = point
    end if
    point = interval%to
    point%xi = maxval(xi, mask=xi < interval%to%xi)
    if (point%xi > max(-1.0_wp, interval%to%xi - 2*least) .and. .not. shared(2)) then
      if (is_steep(interval%to, point)) moved%to = point
    end if
    if (along(moved%to) - along(moved%from) >= least) interval = moved

  contains

    pure function is_steep(outer, inside) result(yes)
      type(side_point_t), intent(in) :: outer, inside
      logical :: yes
      type(closest_point_t) :: closest_points(2)
      real(wp) :: ends(2, 2)
      integer :: k
      logical :: projected(2)

      ends(:, 1) = point_on_side(loop, x, outer)
      ends(:, 2) = point_on_side(loop, x, inside)
      do k = 1, 2
        call find_closest_point(die, pilot, ends(:, k), [1, size(die%pieces, 3)], .true., closest_points(k), projected(k))
      end do
      yes = all(projected) .and. closest_points(2)%d - closest_points(1)%d > sin(turn)*length_of(ends(:, 2) - ends(:, 1))
    end function is_steep

  end subroutine start_at_contact_point

  !> Sections of an interval with their closest points; none when the interval runs backwards along the die.
  pure subroutine sections_of_interval(interval, rule, loop, tags, x, die, pilot, sections)
    type(contact_interval_t), intent(in) :: interval
    type(rule_t), intent(in) :: rule   !! of the group's points
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)                           !! (x, y, angle) of the die now [length and radian]
    type(section_t), allocatable, intent(out) :: sections(:)   !! (nsection)
    type(section_t) :: list(interval%to%side - interval%from%side + 1)
    type(closest_point_t) :: start, finish, before, after
    type(side_point_t) :: side_point, from
    integer :: k, n, whole(2)

    n = 0
    start = closest_of(point_on_side(loop, x, interval%from), around(die, interval%from%piece), .true.)
    finish = closest_of(point_on_side(loop, x, interval%to), around(die, interval%to%piece), .false.)
    whole = [start%piece, finish%piece]
    allocate (sections(0))
    if (.not. distance_along(die, start, finish) > coincidence_tolerance) return
    from = interval%from
    do k = interval%from%side, interval%to%side
      if (k < interval%to%side) then
        if (same_tags(tags, wrapped(loop, k), wrapped(loop, k + 1))) cycle
        side_point = side_point_t(k, 1.0_wp)
        before = closest_of(point_on_side(loop, x, side_point), whole, .false.)
        after = closest_of(point_on_side(loop, x, side_point), whole, .true.)
        ! a set of sides that folded back over another one is skipped
        if (.not. (distance_along(die, start, before) > coincidence_tolerance &
                   .and. distance_along(die, after, finish) > coincidence_tolerance)) cycle
      else
        side_point = interval%to
        before = finish
      end if
      n = n + 1
      list(n)%side = wrapped(loop, from%side)
      call list_closest_points(interval, rule, loop, x, die, pilot, from, side_point, start, before, list(n)%closest_points)
      start = after
      from = side_point_t(k + 1, -1.0_wp)
    end do
    deallocate (sections)
    allocate (sections, source=list(:n))

  contains

    pure function closest_of(point, pieces, begins) result(closest)
      real(wp), intent(in) :: point(2)
      integer, intent(in) :: pieces(2)
      logical, intent(in) :: begins
      type(closest_point_t) :: closest
      logical :: projected

      call find_closest_point(die, pilot, point, pieces, begins, closest, projected)
    end function closest_of

  end subroutine sections_of_interval

  !> Number of a side of the loop, which may be counted on past its end.
  pure function wrapped(loop, side) result(k)
    type(loop_t), intent(in) :: loop
    integer, intent(in) :: side
    integer :: k

    k = modulo(side - 1, size(loop%sides, 2)) + 1
  end function wrapped

  !> First and last of the pieces adjacent to a known one; of all pieces where none is known.
  pure function around(die, piece) result(pieces)
    type(die_t), intent(in) :: die
    integer, intent(in) :: piece   !! 0: not known
    integer :: pieces(2)

    pieces = [1, size(die%pieces, 3)]
    if (piece == 0) return
    if (.not. die%closed) then
      pieces = min(max([piece - 1, piece + 1], 1), pieces(2))
    else if (pieces(2) > 3) then
      pieces = modulo([piece - 2, piece], pieces(2)) + 1
    end if
  end function around

  !> The ends of a section, and between them the closest points of integration points, in sequence.
  pure subroutine list_closest_points(interval, rule, loop, x, die, pilot, first, last, start, finish, closest_points)
    type(contact_interval_t), intent(in) :: interval
    type(rule_t), intent(in) :: rule   !! of the group's points
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)    !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)   !! (x, y, angle) of the die now [length and radian]
    type(side_point_t), intent(in) :: first, last
    type(closest_point_t), intent(in) :: start, finish
    type(closest_point_t), allocatable, intent(out) :: closest_points(:)   !! (n)
    type(closest_point_t) :: list((rule%n + 1)*(last%side - first%side + 1) + 4)
    real(wp), allocatable :: xi(:), weight(:)
    integer :: k, p, n

    call line_rule(rule, xi, weight)
    n = 1
    list(1) = start
    if (.not. interval%to_corner(1)) call follow(interval%found(1), list, n)
    do k = first%side, last%side
      do p = 1, size(xi)
        if (is_before_corner(interval, side_point_t(k, xi(p)))) cycle
        call follow(side_point_t(k, xi(p)), list, n)
      end do
    end do
    if (.not. interval%to_corner(2)) call follow(interval%found(2), list, n)
    n = n + 1
    list(n) = finish
    allocate (closest_points, source=list(:n))

  contains

    !> Append the closest point of a point within the section, if it is behind those before.
    pure subroutine follow(side_point, list, n)
      type(side_point_t), intent(in) :: side_point
      type(closest_point_t), intent(inout) :: list(:)
      integer, intent(inout) :: n
      type(closest_point_t) :: closest
      logical :: projected

      if (along(side_point) <= along(first) .or. along(side_point) >= along(last)) return
      call find_closest_point(die, pilot, point_on_side(loop, x, side_point), [start%piece, finish%piece], .true., closest, &
                              projected)
      if (.not. projected) return
      if (.not. (distance_along(die, list(n), closest) > coincidence_tolerance &
                 .and. distance_along(die, closest, finish) > coincidence_tolerance)) return
      n = n + 1
      list(n) = closest
    end subroutine follow

  end subroutine list_closest_points

end module interval_sections
