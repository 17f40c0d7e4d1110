!> Overlaps of free sides with a die past an end of contact.
!>
!> The solver checks a side at its integration points only: between the last point in contact and the first free one a coarse side
!> may penetrate a curved die. Integration points of a new mesh would lie in the die there, with pressures that were not in
!> equilibrium before. So the contour follows the die itself over this distance, to where the old side leaves it.
module contact_overlaps
  use arcs, only: arc_t
  use arcs_on_die, only: follow_die
  use boundary_sides, only: loop_t
  use closest_point, only: closest_point_t
  use die_closest_points, only: distance_along, find_closest_point, point_on_side
  use dies, only: die_t, is_deformable
  use kinds, only: eps, wp
  use loop_intervals, only: side_point_t
  use vectors, only: length_of
  implicit none
  private
  public :: overlap_t, find_overlap, arcs_of_overlap

  type :: overlap_t
    logical :: found = .false.
    !> Point where the side leaves the die, and the closest point on the die.
    type(side_point_t) :: out
    type(closest_point_t) :: closest
  end type overlap_t

  !> Samples of the rest of a side.
  integer, parameter :: samples = 32
  !> An overlap is at least as deep as the first share of the side, and at most as deep as the second: a deeper one is the opposite
  !> face of the die.
  real(wp), parameter :: shallow = 1.0e-7_wp, deep = 0.1_wp
  !> A shorter rest of a side, in half sides, is ignored.
  real(wp), parameter :: shortest_part = 1.0e-6_wp

contains

  !> Overlap of a side with the die past a beginning (towards = -1) or an end (1) of contact, on the side of that end. None where
  !> the side does not leave the die, or has no closest point on it.
  pure subroutine find_overlap(loop, x, die, pilot, from, end_point, towards, overlap)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)                 !! (x, y, angle) of the die now [length and radian]
    type(side_point_t), intent(in) :: from           !! beginning or end of contact
    type(closest_point_t), intent(in) :: end_point   !! the die there
    integer, intent(in) :: towards
    type(overlap_t), intent(out) :: overlap
    type(side_point_t) :: here
    type(closest_point_t) :: closest
    real(wp) :: start, last, deepest, low, high, length
    integer :: k
    logical :: projected

    if (is_deformable(die)) return
    here = from
    if (towards*here%xi > 1 - shortest_part) here = side_point_t(from%side + towards, real(-towards, wp))
    start = here%xi
    last = start
    deepest = 0
    do k = 1, samples
      here%xi = start + (towards - start)*real(k, wp)/samples
      call project(here, closest, projected)
      if (.not. projected) return
      if (.not. closest%d > 0) exit
      deepest = max(deepest, closest%d)
      last = here%xi
    end do
    length = length_of(point_on_side(loop, x, side_point_t(here%side, 1.0_wp)) &
                       - point_on_side(loop, x, side_point_t(here%side, -1.0_wp)))
    if (k > samples .or. deepest <= shallow*length .or. deepest > deep*length) return
    low = last
    high = here%xi
    do while (abs(high - low) > 4*eps)
      here%xi = 0.5_wp*(low + high)
      if (.not. (here%xi > min(low, high) .and. here%xi < max(low, high))) exit
      call project(here, closest, projected)
      if (closest%d > 0) then
        low = here%xi
      else
        high = here%xi
      end if
    end do
    call project(here, closest, projected)
    if (.not. projected .or. abs(towards - here%xi) <= shortest_part) return
    if (.not. towards*distance_along(die, end_point, closest) > 0) return
    closest%d = 0
    overlap = overlap_t(.true., here, closest)

  contains

    pure subroutine project(side_point, closest, over)
      type(side_point_t), intent(in) :: side_point
      type(closest_point_t), intent(out) :: closest
      logical, intent(out) :: over

      call find_closest_point(die, pilot, point_on_side(loop, x, side_point), [1, size(die%pieces, 3)], towards < 0, closest, over)
    end subroutine project

  end subroutine find_overlap

  !> The die between two closest points as free arcs of a side.
  pure subroutine arcs_of_overlap(die, pilot, number, side, ends, list)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)      !! (x, y, angle) of the die now [length and radian]
    integer, intent(in) :: number, side   !! of the die and of the loop
    type(closest_point_t), intent(in) :: ends(2)
    type(arc_t), allocatable, intent(out) :: list(:)   !! (narc)

    call follow_die(die, pilot, number, ends, list)
    list%side = side
  end subroutine arcs_of_overlap

end module contact_overlaps
