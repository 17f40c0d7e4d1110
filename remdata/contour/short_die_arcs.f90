!> Short arcs that follow a die past one of its corners to where the free contour leaves it.
!>
!> An old side that ends in a corner of a die, or passes one, meets the die's other face a small way from the corner: by its depth,
!> or by its bend between points of contact. The contour would follow that face for so long, and the new mesh have a side there that
!> is smaller than any element is wanted, with the pressures of the corner on it. The free contour goes to the die's corner itself
!> instead; contact that began or ended on the other face begins or ends in the corner.
module short_die_arcs
  use boundary_curves, only: boundary_curve_t, kind_corner, kind_entry, kind_exit, turn_at
  use contour_contacts, only: contact_t
  use kinds, only: wp
  use offset_parabolas, only: point_at
  use short_free_sides, only: is_free, redrawn, remove_arcs
  use side_tags, only: same_tags, side_tags_t
  implicit none
  private
  public :: drop_short_die_arcs

contains

  !> Drop all runs of arcs on a die, shorter than `least`, from a corner between two pieces of it to a free arc, unless all of a
  !> contact interval is among them. The arcs of contacts are renumbered.
  pure subroutine drop_short_die_arcs(least, tags, contacts, boundary)
    real(wp), intent(in) :: least   !! [length]
    type(side_tags_t), intent(in) :: tags
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact)
    type(boundary_curve_t), intent(inout) :: boundary
    logical :: dropped(size(boundary%arcs))
    integer :: joint, towards

    dropped = .false.
    do joint = 1, size(dropped)
      if (.not. abs(turn_at(boundary, joint)) > boundary%corner_turn) cycle
      do towards = -1, 1, 2
        call drop_run(least, tags, joint, towards, contacts, boundary, dropped)
      end do
    end do
    if (any(dropped)) call remove_arcs(dropped, contacts, boundary)
  end subroutine drop_short_die_arcs

  !> The run from a corner on, along the contour (towards = 1) or against it (-1).
  pure subroutine drop_run(least, tags, corner, towards, contacts, boundary, dropped)
    real(wp), intent(in) :: least   !! [length]
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: corner, towards   !! arc that begins there
    type(contact_t), intent(inout) :: contacts(:)
    type(boundary_curve_t), intent(inout) :: boundary
    logical, intent(inout) :: dropped(:)   !! (narc)
    logical :: run(size(dropped))
    real(wp) :: length, point(2)
    integer :: k, behind, before, first

    before = neighbour(corner, -1)
    first = merge(corner, before, towards > 0)
    behind = merge(before, corner, towards > 0)
    if (dropped(first) .or. dropped(behind)) return
    associate (one => boundary%arcs(first), other => boundary%arcs(behind))
      ! a corner of the die
      if (one%die == 0 .or. one%die /= other%die .or. one%piece == other%piece) return
      point = point_at(other, other%range(merge(2, 1, towards > 0)))
    end associate
    run = .false.
    length = 0
    k = first
    do while (boundary%arcs(k)%die == boundary%arcs(behind)%die)
      length = length + boundary%arc_length(k) - boundary%arc_length(k - 1)
      if (length > least .or. run(k) .or. dropped(k)) return
      run(k) = .true.
      k = neighbour(k, towards)
      if (.not. same_tags(tags, boundary%arcs(k)%side, boundary%arcs(first)%side)) return
    end do
    if (.not. is_free(boundary%arcs(k)) .or. dropped(k) .or. takes_interval()) return
    call end_contacts(run, corner, k, behind, towards, contacts, boundary)
    boundary%arcs(k) = redrawn(boundary%arcs(k), point, merge(1, 2, towards > 0))
    dropped = dropped .or. run

  contains

    pure integer function neighbour(arc, step)
      integer, intent(in) :: arc, step

      neighbour = modulo(arc + step - 1, size(run)) + 1
    end function neighbour

    !> All arcs of a contact interval are in the run.
    pure logical function takes_interval()
      integer :: i

      takes_interval = .false.
      do i = 1, size(run)
        if (run(i) .and. boundary%arcs(i)%interval > 0) &
          takes_interval = takes_interval .or. .not. any(boundary%arcs%interval == boundary%arcs(i)%interval .and. .not. run)
      end do
    end function takes_interval

  end subroutine drop_run

  !> Contact on the run begins, or ends, in the corner.
  pure subroutine end_contacts(run, corner, free, behind, towards, contacts, boundary)
    logical, intent(in) :: run(:)                          !! (narc)
    integer, intent(in) :: corner, free, behind, towards   !! arcs: that begins there, beside the run, on the other face
    type(contact_t), intent(inout) :: contacts(:)
    type(boundary_curve_t), intent(inout) :: boundary
    integer :: i

    if (towards > 0) then
      if (boundary%kinds(free) /= kind_exit) &
        boundary%kinds(free) = merge(kind_exit, kind_corner, boundary%kinds(corner) == kind_exit)
    else if (boundary%arcs(behind)%interval > 0) then
      if (any(run .and. boundary%kinds == kind_entry)) boundary%kinds(corner) = kind_entry
    end if
    do i = 1, size(contacts)
      if (.not. any(run .and. boundary%arcs%interval == i)) cycle
      if (towards > 0) contacts(i)%interval%found(2) = contacts(i)%interval%to
      if (towards < 0) contacts(i)%interval%found(1) = contacts(i)%interval%from
    end do
  end subroutine end_contacts

end module short_die_arcs
