!> Gaps between two contact intervals with one die that are too narrow to be resolved by the contour.
!>
!> Behind a side that folds onto a die, or where contact points open and close alternately, contact opens by less than the
!> penetration. Two intervals with such a gap between them are joined: the contour keeps its distance from the die there (a negative
!> depth), but no beginning and no end of contact is left for the mesh to resolve. A small gap is wider but only one or two elements
!> long, as a coarse side leaves where it folds: it keeps its shape, and its ends are not resolved by the mesh either.
!>
!> A side that spans a bend of the die may be deep in it beside a point that is open. That is no gap: a node of the new mesh at such
!> a place would press with all of the depth. Only where the contour is off the die a gap has a width; and a small gap with such a
!> place in it is closed.
module contact_gaps
  use closest_point, only: closest_point_t
  use boundary_sides, only: loop_t
  use die_closest_points, only: find_closest_point, point_on_side
  use dies, only: die_t, present_die
  use fields, only: pilot_field
  use kinds, only: wp
  use loop_intervals, only: along, coincide, contact_interval_t, side_point_t, sort_intervals, wrap_start
  use scene, only: scene_t
  use side_tags, only: side_tags_t
  use solution, only: solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: close_gaps, mark_small_gaps

  !> Parent coordinates at which a side is sampled.
  real(wp), parameter :: samples(5) = [-1.0_wp, -0.5_wp, 0.0_wp, 0.5_wp, 1.0_wp]
  !> Depth between points of contact up to which a side is taken to span a bend of the die, as a share of the side.
  real(wp), parameter :: deepest = 0.25_wp

contains

  pure subroutine close_gaps(scene, solution, loop, tags, x, widest, intervals, width, longest)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)                                        !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: widest                                         !! gap that is closed, as a share of the side
    type(contact_interval_t), allocatable, intent(inout) :: intervals(:)   !! (ninterval) in their order along the loop
    real(wp), intent(in), optional :: width, longest   !! of small gaps (mark_small_gaps); none without them
    integer :: into(size(intervals)), i, next, n, nside
    logical :: stays
    type(contact_interval_t), allocatable :: list(:)

    if (size(intervals) < 2) return
    n = size(intervals)
    nside = size(loop%sides, 2)
    into = 0
    do i = 1, n
      ! the interval that has replaced the next one, if they were joined already
      next = mod(i, n) + 1
      do while (into(next) > 0)
        next = into(next)
      end do
      if (next == i .or. scene%groups(intervals(i)%group)%die /= scene%groups(intervals(next)%group)%die) cycle
      if (.not. is_closed(intervals(i), first_after(intervals(i), intervals(next), nside))) cycle
      call join_intervals(tags, nside, intervals(i), intervals(next), stays)
      if (.not. stays) into(i) = next
    end do
    allocate (list, source=pack(intervals, into == 0))
    call move_alloc(list, intervals)
    call wrap_start(nside, intervals)
    call sort_intervals(intervals)

  contains

    !> The gap is narrow, or a small one with a place that is deep in the die.
    pure function is_closed(interval, until) result(closed)
      type(contact_interval_t), intent(in) :: interval
      type(side_point_t), intent(in) :: until
      logical :: closed
      real(wp) :: depths(2), wide

      depths = depths_between(scene, solution, loop, x, interval%group, last_in_contact(interval), until)
      wide = widest
      if (present(width) .and. depths(2) > widest) then
        if (along(until) - along(interval%to) <= longest) wide = width
      end if
      closed = depths(1) >= -wide .and. depths(2) <= deepest
    end function is_closed
  end subroutine close_gaps

  !> Mark the intervals that are followed by a small gap.
  pure subroutine mark_small_gaps(scene, solution, loop, x, widest, longest, intervals)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)                           !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: widest, longest                   !! width as a share of the side, and length in sides
    type(contact_interval_t), intent(inout) :: intervals(:)   !! (ninterval) in their order along the loop
    type(side_point_t) :: until
    real(wp) :: depths(2)
    integer :: i, next

    do i = 1, size(intervals)
      next = mod(i, size(intervals)) + 1
      if (next == i .or. scene%groups(intervals(i)%group)%die /= scene%groups(intervals(next)%group)%die) cycle
      until = begins_after(intervals(i), intervals(next), size(loop%sides, 2))
      if (coincide(until, intervals(i)%to) .or. along(until) - along(intervals(i)%to) > longest) cycle
      depths = depths_between(scene, solution, loop, x, intervals(i)%group, intervals(i)%to, until)
      intervals(i)%small_gap = depths(1) >= -widest .and. depths(2) <= deepest
    end do
  end subroutine mark_small_gaps

  !> Where the next interval begins, counted on from the end of an interval.
  pure function begins_after(interval, next, nside) result(side_point)
    type(contact_interval_t), intent(in) :: interval, next
    integer, intent(in) :: nside
    type(side_point_t) :: side_point

    side_point = next%from
    if (along(side_point) < along(interval%to)) side_point%side = side_point%side + nside
  end function begins_after

  !> Where contact before a gap ends: what was extended to a corner of the die is open from there to the corner.
  pure function last_in_contact(interval) result(side_point)
    type(contact_interval_t), intent(in) :: interval
    type(side_point_t) :: side_point

    side_point = interval%to
    if (interval%to_corner(2)) side_point = interval%found(2)
  end function last_in_contact

  !> Where contact behind a gap begins, in the same way, counted on from the end of an interval.
  pure function first_after(interval, next, nside) result(side_point)
    type(contact_interval_t), intent(in) :: interval, next
    integer, intent(in) :: nside
    type(side_point_t) :: side_point

    side_point = begins_after(interval, next, nside)
    if (.not. next%to_corner(1)) return
    side_point = next%found(1)
    if (along(side_point) < along(interval%to)) side_point%side = side_point%side + nside
  end function first_after

  !> Smallest and largest depth in the die between two points of a contour, over the side there; huge where the die is not beside
  !> it.
  pure function depths_between(scene, solution, loop, x, group, from, until) result(depths)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    integer, intent(in) :: group      !! that faces the die
    type(side_point_t), intent(in) :: from, until
    real(wp) :: depths(2)
    type(die_t) :: die
    type(closest_point_t) :: closest
    type(side_point_t) :: side_point
    logical :: projected
    real(wp) :: chord, share
    integer :: k, i, side, number

    depths = 0
    number = scene%groups(group)%die
    die = present_die(scene%dies(number), x)
    associate (pilot => solution%fields(pilot_field)%value(:, number))
      do k = from%side, until%side
        side = modulo(k - 1, size(loop%sides, 2)) + 1
        chord = length_of(x(:, loop%sides(3, side)) - x(:, loop%sides(1, side)))
        do i = 1, size(samples)
          side_point = side_point_t(k, samples(i))
          if (along(side_point) <= along(from) .or. along(side_point) >= along(until)) cycle
          call find_closest_point(die, pilot, point_on_side(loop, x, side_point), [1, size(die%pieces, 3)], .true., closest, &
                                  projected)
          if (.not. projected) then
            depths = [-huge(chord), huge(chord)]
            return
          end if
          if (.not. abs(closest%d) > 0) cycle
          ! a side of no length has any depth over it
          share = closest%d/max(chord, epsilon(chord)*abs(closest%d))
          depths = [min(depths(1), share), max(depths(2), share)]
        end do
      end do
    end associate
  end function depths_between

  !> Join two intervals: into the second one if they are of one group, otherwise they meet where the group of the first one ends.
  pure subroutine join_intervals(tags, nside, interval, next, stays)
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: interval, next
    logical, intent(out) :: stays   !! the first one
    type(side_point_t) :: until
    integer :: k, last, side

    stays = .true.
    until = begins_after(interval, next, nside)
    last = interval%to%side
    do k = interval%to%side + 1, until%side
      side = modulo(k - 1, nside) + 1
      if (k == until%side .and. until%xi <= -1) exit
      if (last == k - 1 .and. tags%on_group(interval%group, side)) then
        last = k
      else if (.not. tags%on_group(next%group, side)) then
        return
      end if
    end do
    if (interval%group == next%group) then
      if (last < until%side - merge(1, 0, until%xi <= -1)) return
      next%to%side = next%to%side + until%side - next%from%side
      next%found(2)%side = next%found(2)%side + until%side - next%from%side
      next%from = interval%from
      next%found(1) = interval%found(1)
      stays = .false.
    else if (last < until%side) then
      interval%to = side_point_t(last, 1.0_wp)
      interval%found(2) = interval%to
      next%from = side_point_t(modulo(last, nside) + 1, -1.0_wp)
      next%found(1) = next%from
      if (next%from%side > next%to%side) then
        next%to%side = next%to%side + nside
        next%found(2)%side = next%found(2)%side + nside
      end if
    end if
  end subroutine join_intervals

end module contact_gaps
