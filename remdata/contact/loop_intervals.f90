!> Points on the sides of a loop, and contact intervals between two of them: where they are along the loop, and in which order.
module loop_intervals
  use kinds, only: wp
  implicit none
  private
  public :: side_point_t, contact_interval_t
  public :: along, coincide, is_before_corner, is_shared, sort_intervals, wrap_start
  public :: coincidence_tolerance

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

  !> Reduce the numbers of the sides of an interval that begins beyond the last side.
  elemental subroutine wrap_start(nside, interval)
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: interval

    if (interval%from%side <= nside) return
    interval%from%side = interval%from%side - nside
    interval%to%side = interval%to%side - nside
    interval%found%side = interval%found%side - nside
  end subroutine wrap_start

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

end module loop_intervals
