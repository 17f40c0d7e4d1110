!> Contact intervals of a loop: from where contact begins to where it ends, in order.
!>
!> The solver finds the ends of contact group by group (contact_ends). Here they are paired (paired_ends) and sorted along the loop.
!> On the axis an integration point has no surface and is never closed: an interval whose last point before the axis is closed is
!> extended to it. An interval that begins or ends close to a kept corner begins or ends in it, so that no short arc is left to be
!> meshed; the side it was found on is held fixed (volume_correction), so that the contour passes through both points. Where
!> intervals of two groups overlap, what they share is halved, and one inside another is dropped. An interval that covers less than
!> a share of one side is set apart: no element would fit, and what presses there is a point of contact (point_contacts).
module contact_intervals
  use boundary_sides, only: loop_t
  use contact_ends, only: contact_end_t
  use kinds, only: wp
  use loop_intervals, only: along, coincidence_tolerance, contact_interval_t, side_point_t, sort_intervals, wrap_start
  use paired_ends, only: pair_ends
  use quadrature, only: line_rule
  use scene, only: group_t, scene_t
  use side_tags, only: side_tags_t
  implicit none
  private
  public :: find_intervals

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
