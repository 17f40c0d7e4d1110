!> A boundary curve under construction: arcs appended one after the other, with straight ones where it would not be closed.
module boundary_draft
  use arcs, only: arc_t, straight
  use boundary_curves, only: boundary_curve_t, close_boundary, kind_end
  use kinds, only: wp
  use offset_parabolas, only: point_at
  use vectors, only: length_of
  implicit none
  private
  public :: boundary_draft_t, add_arc, finish_boundary

  !> The boundary curve under construction.
  type :: boundary_draft_t
    type(arc_t), allocatable :: arcs(:)
    integer, allocatable :: kinds(:)
    integer :: n = 0
    !> Gaps up to this one are closed [length].
    real(wp) :: closed_gap = 0.0_wp
    !> Kind of the joint before the next arc.
    integer :: pending = kind_end
  end type boundary_draft_t

contains

  !> Append an arc, and a straight one before it where the contour would not be closed.
  pure subroutine add_arc(one, draft)
    type(arc_t), intent(in) :: one
    type(boundary_draft_t), intent(inout) :: draft

    if (draft%n > 0) call close_gap((draft%arcs(draft%n)), one, draft)
    call append(one, draft)
  end subroutine add_arc

  !> Copies are handed over: the arcs of the draft may move while one is appended.
  pure subroutine close_gap(before, after, draft)
    type(arc_t), intent(in) :: before, after
    type(boundary_draft_t), intent(inout) :: draft
    type(arc_t) :: bridge

    bridge = straight(point_at(before, before%range(2)), point_at(after, after%range(1)))
    if (length_of(bridge%points(:, 3) - bridge%points(:, 1)) <= draft%closed_gap) return
    bridge%side = after%side
    bridge%die = after%die
    bridge%piece = after%piece
    bridge%group = after%group
    bridge%interval = after%interval
    call append(bridge, draft)
  end subroutine close_gap

  pure subroutine append(one, draft)
    type(arc_t), intent(in) :: one
    type(boundary_draft_t), intent(inout) :: draft
    type(arc_t), allocatable :: arcs(:)
    integer, allocatable :: kinds(:)
    integer, parameter :: first_size = 64

    if (.not. allocated(draft%arcs)) allocate (draft%arcs(first_size), draft%kinds(first_size))
    if (draft%n == size(draft%arcs)) then
      allocate (arcs(2*draft%n), kinds(2*draft%n))
      arcs(:draft%n) = draft%arcs
      kinds(:draft%n) = draft%kinds
      call move_alloc(arcs, draft%arcs)
      call move_alloc(kinds, draft%kinds)
    end if
    draft%n = draft%n + 1
    draft%arcs(draft%n) = one
    draft%kinds(draft%n) = draft%pending
    draft%pending = kind_end
  end subroutine append

  !> Close the boundary curve. A pending kind at the end of the traversal belongs to the first joint.
  pure subroutine finish_boundary(draft, corner_turn, boundary)
    type(boundary_draft_t), intent(inout) :: draft
    real(wp), intent(in) :: corner_turn   !! a corner is where the tangent turns by more than this [radian]
    type(boundary_curve_t), intent(out) :: boundary
    integer :: pending

    pending = draft%pending
    call close_gap((draft%arcs(draft%n)), (draft%arcs(1)), draft)
    allocate (boundary%arcs, source=draft%arcs(:draft%n))
    allocate (boundary%kinds, source=draft%kinds(:draft%n))
    if (pending /= kind_end) boundary%kinds(1) = pending
    call close_boundary(corner_turn, boundary)
  end subroutine finish_boundary

end module boundary_draft
