!> Points of a contour where contact with another body begins or ends: the pressure is discontinuous there and a node is needed.
!>
!> The body that faces a die made of sides has its own nodes there: entries and exits of its contour. The body whose sides form the
!> die carries the same pressure from the closest points of these ends on.
module body_contact_ends
  use closest_point, only: closest_point_t
  use boundary_sides, only: loop_t
  use contour_contacts, only: contact_t
  use dies, only: die_t, is_deformable
  use loop_intervals, only: side_point_t
  implicit none
  private
  public :: add_body_contact_ends

contains

  !> Add the ends of the contact intervals of a contour that lie on a loop.
  pure subroutine add_body_contact_ends(contacts, dies, loop, joints)
    type(contact_t), intent(in) :: contacts(:)   !! (ncontact) of any contour
    type(die_t), intent(in) :: dies(:)           !! (ndie) of the scene, with their nodes
    type(loop_t), intent(in) :: loop
    type(side_point_t), allocatable, intent(inout) :: joints(:)   !! (njoint)
    integer :: k, n

    do k = 1, size(contacts)
      if (.not. is_deformable(dies(contacts(k)%number))) cycle
      associate (sections => contacts(k)%sections)
        n = size(sections)
        if (contacts(k)%interval%small_gap .or. n == 0) cycle
        call add_closest_point(dies(contacts(k)%number), sections(1)%closest_points(1), loop, joints)
        call add_closest_point(dies(contacts(k)%number), sections(n)%closest_points(size(sections(n)%closest_points)), loop, joints)
      end associate
    end do
  end subroutine add_body_contact_ends

  !> Add a closest point on a piece of a die, whose direction is opposite to that of its loop; none beyond the ends of the die.
  pure subroutine add_closest_point(die, closest, loop, joints)
    type(die_t), intent(in) :: die
    type(closest_point_t), intent(in) :: closest
    type(loop_t), intent(in) :: loop
    type(side_point_t), allocatable, intent(inout) :: joints(:)
    integer :: side

    if (abs(closest%xi) > 1) return
    side = findloc(loop%sides(2, :), die%nodes(2, closest%piece), 1)
    if (side > 0) joints = [joints, side_point_t(side, -closest%xi)]
  end subroutine add_closest_point

end module body_contact_ends
