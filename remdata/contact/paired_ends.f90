!> Ends of contact of one group, paired to intervals: each beginning with the next end around the loop.
module paired_ends
  use contact_ends, only: contact_end_t
  use kinds, only: wp
  use loop_intervals, only: along, coincide, coincidence_tolerance, contact_interval_t, side_point_t, wrap_start
  use scene, only: group_t
  implicit none
  private
  public :: pair_ends

contains

  !> Intervals of one group: each beginning is paired with the next end around the loop. Where one interval ends and another begins
  !> at the same point, as where a node between two sides in contact is open on one of them, the end is that of the first.
  pure subroutine pair_ends(group, number, side_at, nside, ends, list, n)
    type(group_t), intent(in) :: group
    integer, intent(in) :: number       !! of the group in the scene
    integer, intent(in) :: side_at(:)   !! (nnode) side of the loop of which a node is the middle one, else 0
    integer, intent(in) :: nside        !! sides of the loop
    type(contact_end_t), intent(in) :: ends(:)           !! (nend) of all groups
    type(contact_interval_t), intent(inout) :: list(:)   !! (nend + ngroup) of which n are filled
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

end module paired_ends
