!> Places of a contour where contact with another body begins or ends: the pressure jumps there, and a node is wanted.
!>
!> The body that faces a die made of sides has its own nodes there: entries and exits of its contour. The body whose sides
!> the die is made of carries the same pressure, from the feet of these places on.
module meeting_places
  use boundary_sides, only: loop_t
  use contact_runs, only: spot_t
  use contact_stretches, only: knot_t
  use contour_assembly, only: contact_t
  use dies, only: die_t, is_deformable
  use kinds, only: wp
  implicit none
  private
  public :: add_meeting_places

contains

  !> Add those that the runs of a contour leave on a loop.
  pure subroutine add_meeting_places(contacts, dies, loop, places)
    type(contact_t), intent(in) :: contacts(:)               !! of any contour
    type(die_t), intent(in) :: dies(:)                       !! of the scene, with their nodes
    type(loop_t), intent(in) :: loop
    type(spot_t), allocatable, intent(inout) :: places(:)
    integer :: k, n

    do k = 1, size(contacts)
      if (.not. is_deformable(dies(contacts(k)%number))) cycle
      associate (sections => contacts(k)%sections)
        n = size(sections)
        if (contacts(k)%run%pocket .or. n == 0) cycle
        call add_foot(dies(contacts(k)%number), sections(1)%knots(1), loop, places)
        call add_foot(dies(contacts(k)%number), sections(n)%knots(size(sections(n)%knots)), loop, places)
      end associate
    end do
  end subroutine add_meeting_places

  !> Add a foot on a piece of a die, which is walked against its loop; none beyond the ends of the die.
  pure subroutine add_foot(die, knot, loop, places)
    type(die_t), intent(in) :: die
    type(knot_t), intent(in) :: knot
    type(loop_t), intent(in) :: loop
    type(spot_t), allocatable, intent(inout) :: places(:)
    integer :: side

    if (abs(knot%xi) > 1) return
    side = findloc(loop%sides(2, :), die%nodes(2, knot%piece), 1)
    if (side > 0) places = [places, spot_t(side, -knot%xi)]
  end subroutine add_foot

end module meeting_places
