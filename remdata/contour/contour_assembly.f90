!> The corrected contour of a loop: its own parabolas where it is free, the die's at the depth of contact where it is not.
!>
!> The arcs of part and die follow each other from one beginning or end of contact to the next. The order of nodes in a list is not
!> used (annex 2, fig. 4): each arc has its curve and its range of xi.
module contour_assembly
  use arcs, only: arc_t
  use arcs_on_die, only: follow_die
  use boundary_curves, only: boundary_curve_t, kind_end, kind_entry, kind_exit, kind_joint
  use boundary_draft, only: add_arc, boundary_draft_t, finish_boundary
  use boundary_sides, only: loop_t
  use closest_point, only: closest_point_t
  use contact_overlaps, only: arcs_of_overlap, find_overlap, overlap_t
  use contour_contacts, only: contact_t, end_of_walk, first_closest_point, last_closest_point, mark_neighbours, next_contact
  use dies, only: is_deformable
  use kinds, only: wp
  use loop_intervals, only: along, side_point_t
  use offset_parabolas, only: tangent_at
  use plane_vectors, only: cross
  use side_tags, only: same_tags, side_tags_t
  use vectors, only: length_of
  implicit none
  private
  public :: assemble_boundary

  !> Coincidence tolerance: a shorter part of a side, in half sides, is dropped.
  real(wp), parameter :: shortest_part = 1.0e-10_wp
  !> A joint within a side leaves at least this part of it, in half sides.
  real(wp), parameter :: shortest_arc = 1.0e-6_wp
  !> Sine of the angle between sides of another body below which they approximate a smooth curve.
  real(wp), parameter :: kink_sine = 0.1_wp
  !> Gaps wider than this share of the contour are closed by a straight arc.
  real(wp), parameter :: closed_gap = 1.0e-10_wp

contains

  pure subroutine assemble_boundary(loop, tags, x, corner_turn, joints, contacts, boundary)
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)                 !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: corner_turn             !! [radian]
    type(side_point_t), intent(in) :: joints(:)     !! (njoint) on free sides where the boundary is to have a joint
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact) in their order along the loop; their arcs are set here
    type(boundary_curve_t), intent(out) :: boundary
    type(boundary_draft_t) :: draft
    type(side_point_t) :: here
    type(overlap_t) :: overlap
    integer :: nside, k

    nside = size(loop%sides, 2)
    here = side_point_t(1, -1.0_wp)
    do k = 1, size(contacts)
      if (contacts(k)%interval%to%side > nside) &
        here = side_point_t(contacts(k)%interval%to%side - nside, contacts(k)%interval%to%xi)
    end do
    draft%closed_gap = closed_gap*maxval(maxval(x(:, loop%sides(1, :)), 2) - minval(x(:, loop%sides(1, :)), 2))
    call mark_neighbours(nside, contacts)
    do k = 1, size(contacts)
      overlap = overlap_t()
      if (contacts(k)%begins) &
        call find_overlap(loop, x, contacts(k)%die, contacts(k)%pilot, contacts(k)%interval%from, &
                          first_closest_point(contacts(k)), -1, overlap)
      if (overlap%found) overlap%found = along(overlap%out) > along(here) + shortest_arc
      if (overlap%found) then
        call add_sides(loop, tags, x, joints, here, overlap%out, draft)
        call add_overlap(contacts(k), overlap, -1, nside, draft)
      else
        call add_sides(loop, tags, x, joints, here, contacts(k)%interval%from, draft)
      end if
      if (contacts(k)%begins) then
        draft%pending = kind_entry
      else
        draft%pending = kind_joint
      end if
      contacts(k)%first = draft%n + 1
      call add_contact(contacts(k), k, draft)
      contacts(k)%next = draft%n + 1
      here = contacts(k)%interval%to
      if (.not. contacts(k)%ends) cycle
      draft%pending = kind_exit
      call find_overlap(loop, x, contacts(k)%die, contacts(k)%pilot, here, last_closest_point(contacts(k)), 1, overlap)
      if (.not. overlap%found .or. along(overlap%out) > next_contact(contacts, k, nside) - shortest_arc) cycle
      call add_overlap(contacts(k), overlap, 1, nside, draft)
      here = overlap%out
    end do
    if (size(contacts) == 0) then
      call add_sides(loop, tags, x, joints, here, side_point_t(nside, 1.0_wp), draft)
    else
      call add_sides(loop, tags, x, joints, here, end_of_walk(contacts, nside), draft)
    end if
    call finish_boundary(draft, corner_turn, boundary)
    do k = 1, size(contacts)
      if (contacts(k)%next > size(boundary%arcs)) contacts(k)%next = 1
      if (.not. contacts(k)%interval%small_gap) cycle
      call unmark_joint(tags, contacts(k)%next, boundary)
      call unmark_joint(tags, contacts(mod(k, size(contacts)) + 1)%first, boundary)
    end do
  end subroutine assemble_boundary

  !> The part of the die that a side overlaps before an interval (towards = -1) or after it.
  pure subroutine add_overlap(contact, overlap, towards, nside, draft)
    type(contact_t), intent(in) :: contact
    type(overlap_t), intent(in) :: overlap
    integer, intent(in) :: towards, nside
    type(boundary_draft_t), intent(inout) :: draft
    type(arc_t), allocatable :: list(:)
    type(closest_point_t) :: closest_points(2)
    integer :: k

    if (towards < 0) then
      draft%pending = kind_joint
      closest_points = [overlap%closest, first_closest_point(contact)]
    else
      closest_points = [last_closest_point(contact), overlap%closest]
    end if
    call arcs_of_overlap(contact%die, contact%pilot, contact%number, modulo(overlap%out%side - 1, nside) + 1, closest_points, list)
    do k = 1, size(list)
      call add_arc(list(k), draft)
    end do
    if (towards > 0) draft%pending = kind_joint
  end subroutine add_overlap

  !> The ends of a small gap are no corners, but sets of sides may meet there.
  pure subroutine unmark_joint(tags, joint, boundary)
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: joint
    type(boundary_curve_t), intent(inout) :: boundary
    integer :: before

    before = merge(size(boundary%arcs), joint - 1, joint == 1)
    boundary%kinds(joint) = merge(kind_end, kind_joint, &
                               same_tags(tags, boundary%arcs(before)%side, boundary%arcs(joint)%side))
  end subroutine unmark_joint

  !> Sides and parts of sides of the part between two points.
  pure subroutine add_sides(loop, tags, x, joints, from, to, draft)
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)
    type(side_point_t), intent(in) :: joints(:), from, to
    type(boundary_draft_t), intent(inout) :: draft
    type(arc_t) :: one
    real(wp) :: last
    integer :: k, nside, before

    nside = size(loop%sides, 2)
    do k = from%side, to%side
      one = arc_t()
      one%side = modulo(k - 1, nside) + 1
      if (k == from%side) one%range(1) = from%xi
      if (k == to%side) one%range(2) = to%xi
      if (one%range(2) - one%range(1) <= shortest_part) cycle
      before = modulo(one%side - 2, nside) + 1
      if (draft%pending == kind_end .and. .not. (one%range(1) > -1 .or. same_tags(tags, before, one%side))) &
        draft%pending = kind_joint
      if (draft%pending == kind_end .and. .not. one%range(1) > -1 &
          .and. (any(joints%side == before .and. joints%xi >= 1) &
                 .or. any(joints%side == one%side .and. joints%xi <= -1))) draft%pending = kind_joint
      one%points = x(:, loop%sides(:, one%side))
      one%middle = loop%sides(2, one%side)
      last = one%range(2)
      do
        one%range(2) = minval([last, pack(joints%xi, joints%side == one%side .and. joints%xi > one%range(1) + shortest_arc &
                                          .and. joints%xi < last - shortest_arc)])
        call add_arc(one, draft)
        if (.not. one%range(2) < last) exit
        one%range(1) = one%range(2)
        draft%pending = kind_joint
      end do
    end do
  end subroutine add_sides

  !> The die at the depths of the closest points of an interval.
  pure subroutine add_contact(contact, number, draft)
    type(contact_t), intent(in) :: contact
    integer, intent(in) :: number
    type(boundary_draft_t), intent(inout) :: draft
    type(arc_t), allocatable :: list(:)
    integer :: i, k

    do i = 1, size(contact%sections)
      call follow_die(contact%die, contact%pilot, contact%number, contact%sections(i)%closest_points, list)
      if (i > 1) draft%pending = kind_joint
      do k = 1, size(list)
        if (k > 1 .and. is_deformable(contact%die)) then
          if (has_kink(list(k - 1), list(k))) draft%pending = kind_joint
        end if
        list(k)%side = contact%sections(i)%side
        list(k)%group = contact%interval%group
        list(k)%interval = number
        call add_arc(list(k), draft)
      end do
    end do
  end subroutine add_contact

  !> No parabola fits two sides of the other body across a kink between them: a node is needed.
  pure function has_kink(before, after) result(yes)
    type(arc_t), intent(in) :: before, after
    logical :: yes
    real(wp) :: one(2), other(2)

    one = tangent_at(before, before%range(2))
    other = tangent_at(after, after%range(1))
    yes = abs(cross(one, other)) > kink_sine*length_of(one)*length_of(other)
  end function has_kink

end module contour_assembly
