!> Short free sides between a corner and the beginning or end of contact beside it.
!>
!> A surface that folds onto a die leaves a corner just before the place where contact begins. No mesh resolves a side
!> much shorter than its smallest element, nor has it good elements in both ends of such a side: the free contour goes
!> straight to the end of contact instead, which stays where it is. Nor has it elements for the sides of a rounded ground that has
!> crumpled, where a fold has closed.
module short_free_sides
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t, close_boundary, kind_corner, kind_end
  use contour_contacts, only: contact_t
  use kinds, only: wp
  use offset_parabolas, only: point_at
  use side_tags, only: same_tags, side_tags_t
  implicit none
  private
  public :: drop_short_sides, drop_short_grounds, is_free, redrawn, remove_arcs

contains

  !> Drop all runs of free arcs, shorter than `least`, from an end of contact to a corner that only bends: where another set of
  !> sides, a support or a die begins the corner stays. The arcs of contacts are renumbered. Behind a corner that was dropped
  !> another may follow as near, where a die's corner has crumpled the contour: until none does.
  pure subroutine drop_short_sides(least, tags, contacts, boundary)
    real(wp), intent(in) :: least   !! [length]
    type(side_tags_t), intent(in) :: tags
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact)
    type(boundary_curve_t), intent(inout) :: boundary
    logical :: any_dropped

    any_dropped = .true.
    do while (any_dropped)
      call drop_once(least, tags, contacts, boundary, any_dropped)
    end do
  end subroutine drop_short_sides

  pure subroutine drop_once(least, tags, contacts, boundary, any_dropped)
    real(wp), intent(in) :: least   !! [length]
    type(side_tags_t), intent(in) :: tags
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact)
    type(boundary_curve_t), intent(inout) :: boundary
    logical, intent(out) :: any_dropped
    logical :: dropped(size(boundary%arcs))
    integer :: k, last

    dropped = .false.
    do k = 1, size(contacts)
      associate (interval => contacts(k)%interval)
        ! the solver may have found the end on the sides that are dropped, a little off the node where it is kept
        if (contacts(k)%ends) then
          call drop_run(least, tags, contacts(k)%next, 1, boundary, dropped)
          if (dropped(contacts(k)%next)) interval%found(2) = interval%to
        end if
        if (contacts(k)%begins) then
          last = neighbour(contacts(k)%first, -1, size(dropped))
          call drop_run(least, tags, last, -1, boundary, dropped)
          if (dropped(last)) interval%found(1) = interval%from
        end if
      end associate
    end do
    any_dropped = any(dropped)
    if (any_dropped) call remove_arcs(dropped, contacts, boundary)
  end subroutine drop_once

  !> Drop all runs of sides that face their own body, shorter than `least`, from one corner that only bends to the next: where the
  !> rounded ground of a fold has crumpled as it closed. The side before them goes to their end.
  pure subroutine drop_short_grounds(least, own, tags, contacts, boundary)
    real(wp), intent(in) :: least   !! [length]
    logical, intent(in) :: own(:)   !! (nside) sides that face their own body
    type(side_tags_t), intent(in) :: tags
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact) their arcs are renumbered
    type(boundary_curve_t), intent(inout) :: boundary
    logical, allocatable :: run(:)
    integer :: k, before

    do
      call find_ground(least, own, tags, boundary, run, before, k)
      if (.not. any(run)) return
      associate (next => boundary%arcs(k))
        boundary%arcs(before) = redrawn(boundary%arcs(before), point_at(next, next%range(1)), 2)
      end associate
      call remove_arcs(run, contacts, boundary)
    end do
  end subroutine drop_short_grounds

  !> The first of these runs, none where there is no more.
  pure subroutine find_ground(least, own, tags, boundary, run, before, k)
    real(wp), intent(in) :: least   !! [length]
    logical, intent(in) :: own(:)   !! (nside)
    type(side_tags_t), intent(in) :: tags
    type(boundary_curve_t), intent(in) :: boundary
    logical, allocatable, intent(out) :: run(:)   !! (narc)
    integer, intent(out) :: before, k             !! arcs before and after it
    real(wp) :: length
    integer :: first

    allocate (run(size(boundary%arcs)))
    do first = 1, size(run)
      run = .false.
      length = 0
      before = neighbour(first, -1, size(run))
      k = first
      do while (boundary%kinds(first) == kind_corner .and. k /= before)
        if (.not. (in_fold(before) .and. in_fold(k))) exit
        if (.not. same_tags(tags, boundary%arcs(before)%side, boundary%arcs(k)%side)) exit
        if (any(run) .and. boundary%kinds(k) == kind_corner) return
        length = length + boundary%arc_length(k) - boundary%arc_length(k - 1)
        if (length > least) exit
        run(k) = .true.
        k = neighbour(k, 1, size(run))
      end do
    end do
    run = .false.

  contains

    pure function in_fold(arc) result(yes)
      integer, intent(in) :: arc
      logical :: yes

      yes = is_free(boundary%arcs(arc)) .and. own(boundary%arcs(arc)%side)
    end function in_fold

  end subroutine find_ground

  !> Take arcs out of a boundary curve, and renumber those of the contacts.
  pure subroutine remove_arcs(dropped, contacts, boundary)
    logical, intent(in) :: dropped(:)               !! (narc)
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact)
    type(boundary_curve_t), intent(inout) :: boundary
    integer, allocatable :: kept(:)
    integer :: k

    do k = 1, size(contacts)
      contacts(k)%first = new_number(contacts(k)%first, dropped)
      contacts(k)%next = new_number(contacts(k)%next, dropped)
    end do
    kept = pack([(k, k=1, size(dropped))],.not. dropped)
    boundary%arcs = boundary%arcs(kept)
    boundary%kinds = boundary%kinds(kept)
    call close_boundary(boundary%corner_turn, boundary)
  end subroutine remove_arcs

  !> Next arc of n along the curve (towards = 1), or the one before (-1).
  pure function neighbour(k, towards, n) result(number)
    integer, intent(in) :: k, towards, n
    integer :: number

    number = modulo(k + towards - 1, n) + 1
  end function neighbour

  !> Number of an arc, or of the first one after it that is kept, among those that are kept.
  pure function new_number(k, dropped) result(number)
    integer, intent(in) :: k
    logical, intent(in) :: dropped(:)   !! (narc)
    integer :: number
    integer :: arc

    arc = k
    do while (dropped(arc))
      arc = neighbour(arc, 1, size(dropped))
    end do
    number = count(.not. dropped(:arc))
  end function new_number

  !> The run from an arc at an end of contact on, away from it.
  pure subroutine drop_run(least, tags, from, towards, boundary, dropped)
    real(wp), intent(in) :: least   !! [length]
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: from, towards
    type(boundary_curve_t), intent(inout) :: boundary
    logical, intent(inout) :: dropped(:)   !! (narc)
    real(wp) :: length
    logical :: run(size(dropped))
    integer :: k, next, joint

    run = .false.
    length = 0
    k = from
    do
      next = neighbour(k, towards, size(dropped))
      ! the joint between both is where the later one begins
      joint = merge(next, k, towards > 0)
      if (.not. (is_free(boundary%arcs(k)) .and. is_free(boundary%arcs(next))) .or. dropped(k) .or. dropped(next)) return
      if (.not. same_tags(tags, boundary%arcs(k)%side, boundary%arcs(next)%side)) return
      length = length + boundary%arc_length(k) - boundary%arc_length(k - 1)
      if (length > least) return
      run(k) = .true.
      if (boundary%kinds(joint) == kind_corner) exit
      if (boundary%kinds(joint) /= kind_end) return
      k = next
    end do
    associate (first => boundary%arcs(from))
      if (towards > 0) then
        boundary%arcs(next) = redrawn(boundary%arcs(next), point_at(first, first%range(1)), 1)
        boundary%kinds(next) = boundary%kinds(from)
      else
        boundary%arcs(next) = redrawn(boundary%arcs(next), point_at(first, first%range(2)), 2)
      end if
    end associate
    dropped = dropped .or. run
  end subroutine drop_run

  !> It follows neither a die nor a contact interval.
  pure function is_free(arc) result(yes)
    type(arc_t), intent(in) :: arc
    logical :: yes

    yes = arc%interval == 0 .and. arc%die == 0
  end function is_free

  !> The part's parabola with one of its ends at another point.
  pure function redrawn(arc, point, which) result(one)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: point(2)   !! [length]
    integer, intent(in) :: which       !! end: 1 or 2
    type(arc_t) :: one
    integer :: i

    one = arc
    do i = 1, 3
      one%points(:, i) = point_at(arc, arc%range(1) + 0.5_wp*(i - 1)*(arc%range(2) - arc%range(1)))
    end do
    one%points(:, 2*which - 1) = point
    one%range = [-1.0_wp, 1.0_wp]
  end function redrawn

end module short_free_sides
