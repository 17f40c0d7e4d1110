!> Contact intervals of a loop: from where contact begins to where it ends, in order.
!>
!> The solver finds the ends of contact group by group (contact_ends). Here they are sorted along the loop and paired. On the axis
!> an integration point has no surface and is never closed: an interval whose last point before the axis is closed is extended to
!> it. An interval that begins or ends close to a kept corner begins or ends in it, so that no short arc is left to be meshed; the
!> side it was found on is held fixed (part_contour), so that the contour passes through both points. Where intervals of two groups
!> overlap, what they share is halved, and one inside another is dropped. An interval that covers less than a share of one side is
!> set apart: no element would fit, and what presses there is a point of contact (point_contacts).
module contact_intervals
  use boundary_sides, only: loop_t
  use contact_ends, only: contact_end_t
  use kinds, only: wp
  use quadrature, only: line_rule
  use scene, only: group_t, scene_t
  use side_tags, only: side_tags_t
  implicit none
  private
  public :: side_point_t, contact_interval_t
  public :: along, coincide, find_intervals, is_before_corner, is_shared, sort_intervals, wrap_start

  !> A point on a side of a loop. An interval across the start of the loop counts sides on beyond the last one.
  type :: side_point_t
    integer :: side = 0
    real(wp) :: xi = 0.0_wp
    !> Piece of the die there, 0 where it is unknown.
    integer :: piece = 0
  end type side_point_t

  type :: contact_interval_t
    integer :: group = 0
    type(side_point_t) :: from, to
    !> Ends as the solver found them, which may differ by less than the shortest interval.
    type(side_point_t) :: found(2)
    !> It was extended from these ends to a corner of the die in contact (die_corner_contact).
    logical :: to_corner(2) = .false.
    !> A small gap follows: contact with the same die continues behind it (contact_gaps).
    logical :: small_gap = .false.
  end type contact_interval_t

  !> Points closer than this, in sides, coincide, with each other and with nodes.
  real(wp), parameter :: coincidence_tolerance = 1.0e-9_wp

contains

  !> Contact intervals of a loop sorted by their beginnings; only the last may extend across the start of the loop.
  pure subroutine find_intervals(scene, loop, tags, kept, ends, closed, least, intervals, short)
    type(scene_t), intent(in) :: scene
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    logical, intent(in) :: kept(:)                                       !! (nside) the side ends in a kept corner
    type(contact_end_t), intent(in) :: ends(:)                           !! (nend) of all groups
    logical, intent(in) :: closed(:)                                     !! (ngroup) some points of the group are in contact
    real(wp), intent(in) :: least                                        !! shortest interval, in sides
    type(contact_interval_t), allocatable, intent(out) :: intervals(:)   !! (ninterval)
    type(contact_interval_t), allocatable, intent(out) :: short(:)       !! (nshort) shorter than `least`
    type(contact_interval_t) :: list(size(ends) + size(scene%groups))
    integer :: side_at(size(scene%mesh%coordinates, 2)), g, k, n, before

    side_at = 0
    side_at(loop%sides(2, :)) = [(k, k=1, size(loop%sides, 2))]
    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. .not. closed(g)) cycle
      before = n
      call pair_ends(scene%groups(g), g, side_at, size(loop%sides, 2), ends, list, n)
      if (n == before .and. all(tags%on_group(g, :)) .and. all(ends%group /= g)) then
        ! a ring of contact, without end
        n = n + 1
        list(n)%group = g
        list(n)%from = side_point_t(1, -1.0_wp)
        list(n)%to = side_point_t(size(loop%sides, 2), 1.0_wp)
      end if
      do k = before + 1, n
        call extend_to_axis(scene%groups(g), tags, size(loop%sides, 2), list(k))
      end do
    end do
    do k = 1, n
      list(k)%found = [list(k)%from, list(k)%to]
    end do
    short = pack(list(:n), along(list(:n)%to) - along(list(:n)%from) < least)
    call keep(along(list(:n)%to) - along(list(:n)%from) >= least, list, n)
    do k = 1, n
      call snap(kept, least, list(k))
    end do
    call sort_intervals(list(:n))
    call separate_intervals(size(loop%sides, 2), list, n)
    call keep(along(list(:n)%to) - along(list(:n)%from) >= least, list, n)
    allocate (intervals, source=list(:n))
  end subroutine find_intervals

  !> Sides from the start of the loop.
  elemental function along(side_point) result(s)
    type(side_point_t), intent(in) :: side_point
    real(wp) :: s

    s = side_point%side - 1 + 0.5_wp*(1 + side_point%xi)
  end function along

  elemental function coincide(one, other) result(same)
    type(side_point_t), intent(in) :: one, other
    logical :: same

    same = abs(along(one) - along(other)) <= coincidence_tolerance
  end function coincide

  !> Whether another interval or a small gap is adjacent to the beginning (which = 1) or the end (2) of an interval.
  pure function is_shared(intervals, k, which, nside) result(shared)
    type(contact_interval_t), intent(in) :: intervals(:)   !! (ninterval) in their order along the loop
    integer, intent(in) :: k, which, nside
    logical :: shared
    real(wp) :: apart
    integer :: i

    if (which == 1) then
      shared = intervals(modulo(k - 2, size(intervals)) + 1)%small_gap
    else
      shared = intervals(k)%small_gap
    end if
    do i = 1, size(intervals)
      apart = merge(along(intervals(k)%from) - along(intervals(i)%to), along(intervals(i)%from) - along(intervals(k)%to), &
                    which == 1)
      shared = shared .or. abs(modulo(apart + 0.5_wp, real(nside, wp)) - 0.5_wp) <= coincidence_tolerance
    end do
  end function is_shared

  !> A point between the last one in contact and a corner of the die to which an interval was extended: it is open.
  pure function is_before_corner(interval, side_point) result(yes)
    type(contact_interval_t), intent(in) :: interval
    type(side_point_t), intent(in) :: side_point
    logical :: yes

    yes = (interval%to_corner(1) .and. along(side_point) < along(interval%found(1))) &
          .or. (interval%to_corner(2) .and. along(side_point) > along(interval%found(2)))
  end function is_before_corner

  !> Intervals of one group: each beginning is paired with the next end around the loop. Where one interval ends and another begins
  !> at the same point, as where a node between two sides in contact is open on one of them, the end is that of the first.
  pure subroutine pair_ends(group, number, side_at, nside, ends, list, n)
    type(group_t), intent(in) :: group
    integer, intent(in) :: number, side_at(:), nside
    type(contact_end_t), intent(in) :: ends(:)
    type(contact_interval_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    type(side_point_t) :: from, to, side_point
    integer :: i, j

    do i = 1, size(ends)
      if (ends(i)%group /= number .or. .not. ends(i)%begins) cycle
      from = side_point_of(ends(i))
      if (from%side == 0) cycle
      to = side_point_t()
      do j = 1, size(ends)
        if (ends(j)%group /= number .or. ends(j)%begins) cycle
        side_point = side_point_of(ends(j))
        if (side_point%side == 0) cycle
        if (coincide(side_point, from) .and. ends_another(j)) cycle
        if (along(side_point) < along(from) - coincidence_tolerance) side_point%side = side_point%side + nside
        if (to%side > 0 .and. along(side_point) >= along(to)) cycle
        to = side_point
      end do
      if (to%side == 0) cycle
      if (from%xi >= 1 - 2*coincidence_tolerance) from = side_point_t(from%side + 1, -1.0_wp, from%piece)
      if (to%xi <= -1 + 2*coincidence_tolerance) to = side_point_t(to%side - 1, 1.0_wp, to%piece)
      if (from%xi <= -1 + 2*coincidence_tolerance) from%xi = -1
      if (to%xi >= 1 - 2*coincidence_tolerance) to%xi = 1
      if (along(to) < along(from)) cycle
      n = n + 1
      list(n)%group = number
      list(n)%from = from
      list(n)%to = to
      call wrap_start(nside, list(n))
    end do

  contains

    !> Is an interval under way as the loop comes to an end? Its beginning is then what is passed last before it; where as many end
    !> as begin, nothing changes: they are points of contact, or intervals that meet.
    pure function ends_another(end) result(yes)
      integer, intent(in) :: end
      logical :: yes
      real(wp) :: back, nearest
      integer :: m

      yes = .false.
      nearest = huge(nearest)
      do m = 1, size(ends)
        back = distance(m, end)
        if (back <= coincidence_tolerance .or. back >= nearest .or. begun_at(m) == 0) cycle
        nearest = back
        yes = begun_at(m) > 0
      end do
    end function ends_another

    !> Intervals that begin where a contact end is, less those that end there.
    pure function begun_at(end) result(n)
      integer, intent(in) :: end
      integer :: n, m

      n = 0
      do m = 1, size(ends)
        if (abs(distance(m, end)) <= coincidence_tolerance) n = n + merge(1, -1, ends(m)%begins)
      end do
    end function begun_at

    !> Along the loop from one contact end of the group to another, 0 for the same place; below 0 where one is of another group or
    !> loop.
    pure function distance(from, to) result(d)
      integer, intent(in) :: from, to
      real(wp) :: d
      type(side_point_t) :: points(2)

      d = -1
      if (any(ends([from, to])%group /= number)) return
      points = [side_point_of(ends(from)), side_point_of(ends(to))]
      if (any(points%side == 0)) return
      d = modulo(along(points(2)) - along(points(1)), real(nside, wp))
      if (d >= nside - coincidence_tolerance) d = 0
    end function distance

    pure function side_point_of(one) result(side_point)
      type(contact_end_t), intent(in) :: one
      type(side_point_t) :: side_point

      side_point = side_point_t(side_at(group%connectivity(2, one%side)), one%place, one%piece)
    end function side_point_of

  end subroutine pair_ends

  !> Extend an interval over the last part of a side to the axis, where no point with a surface is left.
  pure subroutine extend_to_axis(group, tags, nside, interval)
    type(group_t), intent(in) :: group
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: interval
    real(wp), allocatable :: xi(:), weight(:)

    call line_rule(group%rule, xi, weight)
    if (tags%on_axis(wrapped(interval%to%side + 1, nside)) .and. .not. any(xi > interval%to%xi .and. xi < 1)) interval%to%xi = 1
    if (tags%on_axis(wrapped(interval%from%side - 1, nside)) .and. .not. any(xi < interval%from%xi .and. xi > -1)) &
      interval%from%xi = -1
  end subroutine extend_to_axis

  !> Move the ends of an interval to kept corners that are nearer than `least`.
  pure subroutine snap(kept, least, interval)
    logical, intent(in) :: kept(:)
    real(wp), intent(in) :: least   !! [sides]
    type(contact_interval_t), intent(inout) :: interval

    if (interval%from%xi > 1 - 2*least .and. is_kept(interval%from%side)) then
      interval%from = side_point_t(interval%from%side + 1, -1.0_wp, interval%from%piece)
    else if (interval%from%xi < -1 + 2*least .and. is_kept(interval%from%side - 1)) then
      interval%from%xi = -1
    end if
    if (interval%to%xi < -1 + 2*least .and. is_kept(interval%to%side - 1)) then
      interval%to = side_point_t(interval%to%side - 1, 1.0_wp, interval%to%piece)
    else if (interval%to%xi > 1 - 2*least .and. is_kept(interval%to%side)) then
      interval%to%xi = 1
    end if
    call wrap_start(size(kept), interval)

  contains

    pure function is_kept(side) result(yes)
      integer, intent(in) :: side
      logical :: yes

      yes = kept(wrapped(side, size(kept)))
    end function is_kept

  end subroutine snap

  !> Reduce the numbers of the sides of an interval that begins beyond the last side.
  elemental subroutine wrap_start(nside, interval)
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: interval

    if (interval%from%side <= nside) return
    interval%from%side = interval%from%side - nside
    interval%to%side = interval%to%side - nside
    interval%found%side = interval%found%side - nside
  end subroutine wrap_start

  !> Number of a side that is counted on around the loop.
  pure function wrapped(side, nside) result(k)
    integer, intent(in) :: side, nside
    integer :: k

    k = modulo(side - 1, nside) + 1
  end function wrapped

  pure subroutine keep(which, list, n)
    logical, intent(in) :: which(:)
    type(contact_interval_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    integer :: k, kept

    kept = 0
    do k = 1, n
      if (.not. which(k)) cycle
      kept = kept + 1
      list(kept) = list(k)
    end do
    n = kept
  end subroutine keep

  !> Sort by their beginnings; of two that begin together the longer one first. Insertion sort: there are few.
  pure subroutine sort_intervals(intervals)
    type(contact_interval_t), intent(inout) :: intervals(:)   !! (ninterval)
    type(contact_interval_t) :: one
    integer :: i, k

    do i = 2, size(intervals)
      one = intervals(i)
      do k = i - 1, 1, -1
        if (along(intervals(k)%from) < along(one%from) .or. coincide(intervals(k)%from, one%from) &
            .and. along(intervals(k)%to) >= along(one%to)) exit
        intervals(k + 1) = intervals(k)
      end do
      intervals(k + 1) = one
    end do
  end subroutine sort_intervals

  !> Make the intervals disjoint.
  pure subroutine separate_intervals(nside, list, n)
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    logical :: stays(n)
    integer :: i, k

    stays = .true.
    do i = 1, n
      do k = 1, n
        if (i == k .or. .not. (stays(i) .and. stays(k))) cycle
        call separate_two(list(i), list(k), stays(k))
      end do
    end do
    call keep(stays, list, n)
    call wrap_start(nside, list(:n))
    call sort_intervals(list(:n))

  contains

    !> The part that `next` shares with `interval`, which begins before it, is halved.
    pure subroutine separate_two(interval, next, stays)
      type(contact_interval_t), intent(inout) :: interval, next
      logical, intent(inout) :: stays
      real(wp) :: middle
      integer :: turn

      do turn = 0, nside, nside
        associate (begins => along(next%from) + turn, ends => along(next%to) + turn)
          if (begins < along(interval%from) - coincidence_tolerance .or. begins >= along(interval%to) - coincidence_tolerance) cycle
          if (ends <= along(interval%to) + coincidence_tolerance) then
            stays = .false.
            return
          end if
          middle = 0.5_wp*(begins + along(interval%to))
          interval%to = side_point_at(middle)
          interval%found(2) = interval%to
          next%from = side_point_at(middle - turn)
          next%found(1) = next%from
        end associate
      end do
    end subroutine separate_two

    pure function side_point_at(s) result(side_point)
      real(wp), intent(in) :: s
      type(side_point_t) :: side_point

      side_point%side = floor(s) + 1
      side_point%xi = 2*(s - floor(s)) - 1
    end function side_point_at

  end subroutine separate_intervals

end module contact_intervals
