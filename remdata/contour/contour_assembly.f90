!> The corrected contour of a loop: its own parabolas where it is free, the die's at the depth of contact where it is not.
!>
!> The stretches of part and die follow each other from one beginning or end of contact to the next. No order of nodes in a
!> list is asked (annex 2, fig. 4): each stretch brings its curve and the range of xi that counts.
module contour_assembly
  use boundary_sides, only: loop_t
  use contact_knots, only: section_t
  use contact_runs, only: along, is_shared, run_t, spot_t
  use contact_stretches, only: follow_die, knot_t
  use contour_chain, only: chain_t, close_chain, kind_end, kind_entry, kind_exit, kind_joint
  use dies, only: die_t, is_deformable
  use kinds, only: wp
  use side_tags, only: same_tags, side_tags_t
  use stretches, only: cross, point_at, straight, stretch_t, tangent_at
  use sunken_ends, only: find_tail, stretches_of_tail, tail_t
  use vectors, only: length_of
  implicit none
  private
  public :: contact_t, assemble_chain

  !> A run of contact with its die in its present place, and where it stands in the chain.
  type :: contact_t
    type(run_t) :: run
    type(section_t), allocatable :: sections(:)
    type(die_t) :: die
    integer :: number = 0               !! of the die in the scene
    real(wp) :: pilot(3) = 0.0_wp
    !> Stretch it begins with, and the one that comes after it.
    integer :: first = 0, next = 0
    !> Contact begins there, and ends; else another run goes on, or a pocket is between them.
    logical :: begins = .true., ends = .true.
  end type contact_t

  !> The chain while it grows.
  type :: draft_t
    type(stretch_t), allocatable :: stretches(:)
    integer, allocatable :: kinds(:)
    integer :: n = 0
    !> Widest gap that is none [length].
    real(wp) :: closed_gap = 0.0_wp
    !> Kind of the joint before the next stretch.
    integer :: pending = kind_end
  end type draft_t

  !> What is left of a side in half sides, when it is nothing.
  real(wp), parameter :: nothing = 1.0e-10_wp
  !> No joint within a side leaves less than this of it, in half sides.
  real(wp), parameter :: crumb = 1.0e-6_wp
  !> Sides of another body that turn by less than this sine where they meet follow a curve.
  real(wp), parameter :: edge = 0.1_wp
  !> Gaps wider than this share of the contour are closed by a straight stretch.
  real(wp), parameter :: closed_gap = 1.0e-10_wp

contains

  pure subroutine assemble_chain(loop, tags, x, corner_turn, places, contacts, chain)
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)                    !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: corner_turn                !! [radian]
    type(spot_t), intent(in) :: places(:)              !! of free sides where the chain is to have a joint
    type(contact_t), intent(inout) :: contacts(:)      !! in their order along the loop; where they stand is found here
    type(chain_t), intent(out) :: chain
    type(draft_t) :: draft
    type(spot_t) :: here
    type(tail_t) :: tail
    integer :: nside, k

    nside = size(loop%sides, 2)
    here = spot_t(1, -1.0_wp)
    do k = 1, size(contacts)
      if (contacts(k)%run%to%side > nside) here = spot_t(contacts(k)%run%to%side - nside, contacts(k)%run%to%xi)
    end do
    draft%closed_gap = closed_gap*maxval(maxval(x(:, loop%sides(1, :)), 2) - minval(x(:, loop%sides(1, :)), 2))
    call mark_neighbours(nside, contacts)
    do k = 1, size(contacts)
      tail = tail_t()
      if (contacts(k)%begins) &
        call find_tail(loop, x, contacts(k)%die, contacts(k)%pilot, contacts(k)%run%from, first_knot(contacts(k)), -1, tail)
      if (tail%there) tail%there = along(tail%out) > along(here) + crumb
      if (tail%there) then
        call add_sides(loop, tags, x, places, here, tail%out, draft)
        call add_tail(contacts(k), tail, -1, nside, draft)
      else
        call add_sides(loop, tags, x, places, here, contacts(k)%run%from, draft)
      end if
      if (contacts(k)%begins) then
        draft%pending = kind_entry
      else
        draft%pending = kind_joint
      end if
      contacts(k)%first = draft%n + 1
      call add_contact(contacts(k), k, draft)
      contacts(k)%next = draft%n + 1
      here = contacts(k)%run%to
      if (.not. contacts(k)%ends) cycle
      draft%pending = kind_exit
      call find_tail(loop, x, contacts(k)%die, contacts(k)%pilot, here, last_knot(contacts(k)), 1, tail)
      if (.not. tail%there .or. along(tail%out) > next_spot(contacts, k, nside) - crumb) cycle
      call add_tail(contacts(k), tail, 1, nside, draft)
      here = tail%out
    end do
    if (size(contacts) == 0) then
      call add_sides(loop, tags, x, places, here, spot_t(nside, 1.0_wp), draft)
    else
      call add_sides(loop, tags, x, places, here, first_spot(contacts, nside), draft)
    end if
    call finish_chain(draft, corner_turn, chain)
    do k = 1, size(contacts)
      if (contacts(k)%next > size(chain%stretches)) contacts(k)%next = 1
      if (.not. contacts(k)%run%pocket) cycle
      call make_plain(tags, contacts(k)%next, chain)
      call make_plain(tags, contacts(mod(k, size(contacts)) + 1)%first, chain)
    end do
  end subroutine assemble_chain

  !> How far the free sides after a run may go: to the next run, or to where the walk ends.
  pure function next_spot(contacts, k, nside) result(s)
    type(contact_t), intent(in) :: contacts(:)
    integer, intent(in) :: k, nside
    real(wp) :: s

    if (k < size(contacts)) then
      s = along(contacts(k + 1)%run%from)
    else
      s = along(first_spot(contacts, nside))
    end if
  end function next_spot

  !> The die on the way on which a side lies in it before a run (towards = -1) or after it.
  pure subroutine add_tail(contact, tail, towards, nside, draft)
    type(contact_t), intent(in) :: contact
    type(tail_t), intent(in) :: tail
    integer, intent(in) :: towards, nside
    type(draft_t), intent(inout) :: draft
    type(stretch_t), allocatable :: list(:)
    type(knot_t) :: knots(2)
    integer :: k

    if (towards < 0) then
      draft%pending = kind_joint
      knots = [tail%knot, first_knot(contact)]
    else
      knots = [last_knot(contact), tail%knot]
    end if
    call stretches_of_tail(contact%die, contact%pilot, contact%number, modulo(tail%out%side - 1, nside) + 1, knots, list)
    do k = 1, size(list)
      call add(list(k), draft)
    end do
    if (towards > 0) draft%pending = kind_joint
  end subroutine add_tail

  pure function first_knot(contact) result(knot)
    type(contact_t), intent(in) :: contact
    type(knot_t) :: knot

    knot = contact%sections(1)%knots(1)
  end function first_knot

  pure function last_knot(contact) result(knot)
    type(contact_t), intent(in) :: contact
    type(knot_t) :: knot

    associate (section => contact%sections(size(contact%sections)))
      knot = section%knots(size(section%knots))
    end associate
  end function last_knot

  !> The ends of a pocket are no corners, but sets may meet there.
  pure subroutine make_plain(tags, joint, chain)
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: joint
    type(chain_t), intent(inout) :: chain
    integer :: before

    before = merge(size(chain%stretches), joint - 1, joint == 1)
    chain%kinds(joint) = merge(kind_end, kind_joint, &
                               same_tags(tags, chain%stretches(before)%side, chain%stretches(joint)%side))
  end subroutine make_plain

  !> Where the walk that starts behind a run across the start of the loop, or at the start, comes to its end.
  pure function first_spot(contacts, nside) result(spot)
    type(contact_t), intent(in) :: contacts(:)
    integer, intent(in) :: nside
    type(spot_t) :: spot

    spot = spot_t(nside, 1.0_wp)
    if (contacts(size(contacts))%run%to%side > nside) spot = contacts(size(contacts))%run%to
  end function first_spot

  !> A run that begins where another one ends, or behind a pocket, goes on with it.
  pure subroutine mark_neighbours(nside, contacts)
    integer, intent(in) :: nside
    type(contact_t), intent(inout) :: contacts(:)
    integer :: k

    do k = 1, size(contacts)
      contacts(k)%begins = .not. is_shared(contacts%run, k, 1, nside)
      contacts(k)%ends = .not. is_shared(contacts%run, k, 2, nside)
    end do
  end subroutine mark_neighbours

  !> Sides and parts of sides of the part between two places.
  pure subroutine add_sides(loop, tags, x, places, from, to, draft)
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)
    type(spot_t), intent(in) :: places(:), from, to
    type(draft_t), intent(inout) :: draft
    type(stretch_t) :: one
    real(wp) :: last
    integer :: k, nside, before

    nside = size(loop%sides, 2)
    do k = from%side, to%side
      one = stretch_t()
      one%side = modulo(k - 1, nside) + 1
      if (k == from%side) one%range(1) = from%xi
      if (k == to%side) one%range(2) = to%xi
      if (one%range(2) - one%range(1) <= nothing) cycle
      before = modulo(one%side - 2, nside) + 1
      if (draft%pending == kind_end .and. .not. (one%range(1) > -1 .or. same_tags(tags, before, one%side))) &
        draft%pending = kind_joint
      one%points = x(:, loop%sides(:, one%side))
      one%middle = loop%sides(2, one%side)
      last = one%range(2)
      do
        one%range(2) = minval([last, pack(places%xi, places%side == one%side .and. places%xi > one%range(1) + crumb &
                                          .and. places%xi < last - crumb)])
        call add(one, draft)
        if (.not. one%range(2) < last) exit
        one%range(1) = one%range(2)
        draft%pending = kind_joint
      end do
    end do
  end subroutine add_sides

  !> The die at the depths of a run's knots.
  pure subroutine add_contact(contact, number, draft)
    type(contact_t), intent(in) :: contact
    integer, intent(in) :: number
    type(draft_t), intent(inout) :: draft
    type(stretch_t), allocatable :: list(:)
    integer :: i, k

    do i = 1, size(contact%sections)
      call follow_die(contact%die, contact%pilot, contact%number, contact%sections(i)%knots, list)
      if (i > 1) draft%pending = kind_joint
      do k = 1, size(list)
        if (k > 1 .and. is_deformable(contact%die)) then
          if (bends(list(k - 1), list(k))) draft%pending = kind_joint
        end if
        list(k)%side = contact%sections(i)%side
        list(k)%group = contact%run%group
        list(k)%run = number
        call add(list(k), draft)
      end do
    end do
  end subroutine add_contact

  !> Where sides of the other body meet in an edge no parabola fits both: a node is wanted.
  pure function bends(before, after) result(yes)
    type(stretch_t), intent(in) :: before, after
    logical :: yes
    real(wp) :: one(2), other(2)

    one = tangent_at(before, before%range(2))
    other = tangent_at(after, after%range(1))
    yes = abs(cross(one, other)) > edge*length_of(one)*length_of(other)
  end function bends

  !> Add a stretch, and a straight one before it where the contour would not be closed.
  pure subroutine add(one, draft)
    type(stretch_t), intent(in) :: one
    type(draft_t), intent(inout) :: draft

    if (draft%n > 0) call close_gap(draft%stretches(draft%n), one, draft)
    call append(one, draft)
  end subroutine add

  pure subroutine close_gap(before, after, draft)
    type(stretch_t), intent(in) :: before, after
    type(draft_t), intent(inout) :: draft
    type(stretch_t) :: bridge

    bridge = straight(point_at(before, before%range(2)), point_at(after, after%range(1)))
    if (length_of(bridge%points(:, 3) - bridge%points(:, 1)) <= draft%closed_gap) return
    bridge%side = after%side
    bridge%die = after%die
    bridge%piece = after%piece
    bridge%group = after%group
    bridge%run = after%run
    call append(bridge, draft)
  end subroutine close_gap

  pure subroutine append(one, draft)
    type(stretch_t), intent(in) :: one
    type(draft_t), intent(inout) :: draft
    type(stretch_t), allocatable :: stretches(:)
    integer, allocatable :: kinds(:)
    integer, parameter :: first_size = 64

    if (.not. allocated(draft%stretches)) allocate (draft%stretches(first_size), draft%kinds(first_size))
    if (draft%n == size(draft%stretches)) then
      allocate (stretches(2*draft%n), kinds(2*draft%n))
      stretches(:draft%n) = draft%stretches
      kinds(:draft%n) = draft%kinds
      call move_alloc(stretches, draft%stretches)
      call move_alloc(kinds, draft%kinds)
    end if
    draft%n = draft%n + 1
    draft%stretches(draft%n) = one
    draft%kinds(draft%n) = draft%pending
    draft%pending = kind_end
  end subroutine append

  !> Close the chain. What waits for a stretch at the end of the walk belongs to the first one.
  pure subroutine finish_chain(draft, corner_turn, chain)
    type(draft_t), intent(inout) :: draft
    real(wp), intent(in) :: corner_turn
    type(chain_t), intent(out) :: chain
    integer :: pending

    pending = draft%pending
    call close_gap(draft%stretches(draft%n), draft%stretches(1), draft)
    allocate (chain%stretches, source=draft%stretches(:draft%n))
    allocate (chain%kinds, source=draft%kinds(:draft%n))
    if (pending /= kind_end) chain%kinds(1) = pending
    call close_chain(corner_turn, chain)
  end subroutine finish_chain

end module contour_assembly
