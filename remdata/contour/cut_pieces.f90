!> The pieces of a body on the kept side of a cut: along its contours from where they enter that side to where they leave it, and
!> back along the cut.
module cut_pieces
  use arcs, only: arc_t, cut, straight
  use boundary_curves, only: boundary_curve_t, close_boundary, kind_corner, point_on
  use corrected_contours, only: contour_t
  use cut_crossings, only: cut_crossing_t, is_after
  use kinds, only: wp
  implicit none
  private
  public :: piece_t, follow_pieces

  !> One closed curve.
  type :: piece_t
    type(boundary_curve_t) :: boundary
    !> Contour and arc that each arc comes from; 0 along the cut (n).
    integer, allocatable :: contour(:), arc(:)
  end type piece_t

  !> A shorter part of an arc, in half sides, is dropped.
  real(wp), parameter :: shortest_part = 1.0e-10_wp

contains

  !> All closed curves along the crossings; `clean` is false where they do not close.
  pure subroutine follow_pieces(contours, crossings, pieces, clean)
    type(contour_t), intent(in) :: contours(:)       !! (ncontour)
    type(cut_crossing_t), intent(in) :: crossings(:)     !! (ncrossing) paired
    type(piece_t), allocatable, intent(out) :: pieces(:)   !! (npiece)
    logical, intent(out) :: clean
    type(piece_t) :: piece
    logical :: used(size(crossings))
    integer :: first, k, next

    allocate (pieces(0))
    used = .false.
    clean = .true.
    do first = 1, size(crossings)
      if (used(first) .or. .not. crossings(first)%enters) cycle
      call start(piece)
      k = first
      do
        used(k) = .true.
        next = next_crossing(crossings, k)
        clean = .not. crossings(next)%enters
        if (.not. clean) return
        call add_run(contours, crossings(k), crossings(next), piece)
        k = crossings(next)%mate
        call add_arc(straight(place(contours, crossings(next)), place(contours, crossings(k))), 0, 0, kind_corner, piece)
        if (k == first) exit
        clean = .not. used(k)
        if (.not. clean) return
      end do
      call close_boundary(contours(crossings(first)%contour)%boundary%corner_turn, piece%boundary)
      pieces = [pieces, piece]
    end do
  end subroutine follow_pieces

  pure subroutine start(piece)
    type(piece_t), intent(out) :: piece

    allocate (piece%boundary%arcs(0), piece%boundary%kinds(0), piece%contour(0), piece%arc(0))
  end subroutine start

  pure function place(contours, crossing) result(point)
    type(contour_t), intent(in) :: contours(:)
    type(cut_crossing_t), intent(in) :: crossing
    real(wp) :: point(2)

    point = point_on(contours(crossing%contour)%boundary, crossing%position)
  end function place

  !> The crossing that follows along the contour.
  pure function next_crossing(crossings, k) result(next)
    type(cut_crossing_t), intent(in) :: crossings(:)
    integer, intent(in) :: k
    integer :: next
    logical :: behind, better
    integer :: i

    next = k
    behind = .false.   ! `next` comes after k without passing the start of the contour
    do i = 1, size(crossings)
      if (i == k .or. crossings(i)%contour /= crossings(k)%contour) cycle
      associate (after => is_after(crossings(i)%position, crossings(k)%position))
        better = next == k .or. (after .and. .not. behind)
        if (.not. better .and. (after .eqv. behind)) better = is_after(crossings(next)%position, crossings(i)%position)
        if (.not. better) cycle
        next = i
        behind = after
      end associate
    end do
  end function next_crossing

  !> The arcs of a contour from one crossing to another.
  pure subroutine add_run(contours, from, to, piece)
    type(contour_t), intent(in) :: contours(:)
    type(cut_crossing_t), intent(in) :: from, to
    type(piece_t), intent(inout) :: piece
    real(wp) :: range(2)
    integer :: k
    logical :: last, begun

    associate (boundary => contours(from%contour)%boundary)
      k = from%position%arc
      range(1) = from%position%xi
      begun = .false.
      do
        last = k == to%position%arc .and. to%position%xi >= range(1)
        range(2) = merge(to%position%xi, boundary%arcs(k)%range(2), last)
        if (range(2) - range(1) > shortest_part) then
          call add_arc(cut(boundary%arcs(k), range(1), range(2)), from%contour, k, &
                       merge(boundary%kinds(k), kind_corner, begun), piece)
          begun = .true.
        end if
        if (last) return
        k = mod(k, size(boundary%arcs)) + 1
        range(1) = boundary%arcs(k)%range(1)
      end do
    end associate
  end subroutine add_run

  pure subroutine add_arc(arc, contour, number, kind, piece)
    type(arc_t), intent(in) :: arc
    integer, intent(in) :: contour, number, kind
    type(piece_t), intent(inout) :: piece
    type(arc_t), allocatable :: arcs(:)
    integer :: n

    n = size(piece%boundary%arcs)
    allocate (arcs(n + 1))
    arcs(:n) = piece%boundary%arcs
    arcs(n + 1) = arc
    call move_alloc(arcs, piece%boundary%arcs)
    piece%boundary%kinds = [piece%boundary%kinds, kind]
    piece%contour = [piece%contour, contour]
    piece%arc = [piece%arc, number]
  end subroutine add_arc

end module cut_pieces
