!> Contact intervals of a contour with the dies they are in contact with, and their neighbours along the loop.
module contour_contacts
  use closest_point, only: closest_point_t
  use dies, only: die_t
  use interval_sections, only: section_t
  use kinds, only: wp
  use loop_intervals, only: along, contact_interval_t, is_shared, side_point_t
  implicit none
  private
  public :: contact_t
  public :: next_contact, first_closest_point, last_closest_point, end_of_walk, mark_neighbours

  !> A contact interval with its die in its present position, and its arcs on the boundary curve.
  type :: contact_t
    type(contact_interval_t) :: interval
    type(section_t), allocatable :: sections(:)
    type(die_t) :: die
    integer :: number = 0   !! of the die in the scene
    real(wp) :: pilot(3) = 0.0_wp
    !> First arc of the interval, and the arc after its last.
    integer :: first = 0, next = 0
    !> Contact begins or ends there; otherwise another interval is adjacent, or a small gap separates them.
    logical :: begins = .true., ends = .true.
  end type contact_t

contains

  !> Limit of the free sides after an interval: the next interval, or the end of the loop.
  pure function next_contact(contacts, k, nside) result(s)
    type(contact_t), intent(in) :: contacts(:)   !! (ncontact) in their order along the loop
    integer, intent(in) :: k, nside
    real(wp) :: s   !! [sides]

    if (k < size(contacts)) then
      s = along(contacts(k + 1)%interval%from)
    else
      s = along(end_of_walk(contacts, nside))
    end if
  end function next_contact

  !> Closest point on the die where an interval begins.
  pure function first_closest_point(contact) result(closest)
    type(contact_t), intent(in) :: contact
    type(closest_point_t) :: closest

    closest = contact%sections(1)%closest_points(1)
  end function first_closest_point

  !> Closest point on the die where an interval ends.
  pure function last_closest_point(contact) result(closest)
    type(contact_t), intent(in) :: contact
    type(closest_point_t) :: closest

    associate (section => contact%sections(size(contact%sections)))
      closest = section%closest_points(size(section%closest_points))
    end associate
  end function last_closest_point

  !> End of the traversal that starts behind an interval across the start of the loop, or at that start.
  pure function end_of_walk(contacts, nside) result(side_point)
    type(contact_t), intent(in) :: contacts(:)   !! (ncontact) in their order along the loop
    integer, intent(in) :: nside
    type(side_point_t) :: side_point

    side_point = side_point_t(nside, 1.0_wp)
    if (contacts(size(contacts))%interval%to%side > nside) side_point = contacts(size(contacts))%interval%to
  end function end_of_walk

  !> An interval that begins where another one ends, or behind a small gap, continues it.
  pure subroutine mark_neighbours(nside, contacts)
    integer, intent(in) :: nside
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact) in their order along the loop
    integer :: k

    do k = 1, size(contacts)
      contacts(k)%begins = .not. is_shared(contacts%interval, k, 1, nside)
      contacts(k)%ends = .not. is_shared(contacts%interval, k, 2, nside)
    end do
  end subroutine mark_neighbours

end module contour_contacts
