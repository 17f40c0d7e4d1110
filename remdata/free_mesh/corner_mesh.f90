!> Corners of a mesh between contours and seams: ends of elements along them, and the loops around each outline.
module corner_mesh
  use boundary_curves, only: boundary_curve_t, position_t, turn_at
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: pi, wp
  use plane_vectors, only: cross
  use side_curves, only: curve_point, curve_t
  use zones, only: follows_contour, zone_layout_t
  implicit none
  private
  public :: corner_mesh_t, loops_t, loops_around, put_points

  !> No element has both its sides along a contour that turns by less between them: 35 degrees.
  real(wp), parameter :: flat_turn = 35*pi/180

  type :: seam_points_t
    integer, allocatable :: points(:)   !! (0:n)
  end type seam_points_t

  !> The corners of a mesh under construction. Points along the contours come first, side by side, then those along seams, then
  !> those inside, outline by outline.
  type :: corner_mesh_t
    real(wp), allocatable :: x(:, :)        !! (2, nend) [length]
    integer, allocatable :: corners(:, :)   !! (4, nelem) counter-clockwise
    integer, allocatable :: zone(:)         !! (nelem)
    !> Point each side along a contour begins with, and one past the last (ncontour_side + 1).
    integer, allocatable :: start(:)
    !> Points along each side that follows a seam; no points for the others (nside).
    type(seam_points_t), allocatable :: seams(:)
    !> Points along contours and seams.
    integer :: nfixed = 0
    !> Point after each along its contour.
    integer, allocatable :: next(:)
    !> Position of each, and whether the contour has no corner there.
    type(position_t), allocatable :: position(:)
    logical, allocatable :: smooth(:)
  end type corner_mesh_t

  !> Loops around an outline, with it on their left.
  type :: loops_t
    integer, allocatable :: points(:)   !! of the corner mesh, loop after loop (n)
    integer, allocatable :: first(:)    !! of each loop among these, and one past the last (nloop + 1)
    integer, allocatable :: next(:)     !! after each, as a number among these (n)
    !> The contour or seam has no corner there (n).
    logical, allocatable :: smooth(:)
    !> Some of it is a seam.
    logical :: has_seams = .false.
  end type loops_t

contains

  !> Ends of elements along all sides.
  pure subroutine put_points(boundaries, layout, curves, first, ends, draft)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)                !! (nside)
    integer, intent(in) :: first(:)                       !! (nside + 1) of each side among the ends
    real(wp), intent(in) :: ends(:)                       !! (first(nside + 1) - 1) along the sides [length]
    type(corner_mesh_t), intent(inout) :: draft
    integer :: s, k, n, node, nside

    nside = count(layout%sides%form == follows_contour)
    n = first(nside + 1) - 1 - nside
    draft%nfixed = n + count(layout%points%boundary == 0) + sum(first(nside + 2:) - first(nside + 1:size(curves)) - 2)
    allocate (draft%x(2, draft%nfixed), draft%position(n), draft%next(n), draft%smooth(n), draft%start(nside + 1))
    draft%start(1) = 1
    do s = 1, nside
      draft%start(s + 1) = draft%start(s) + first(s + 1) - first(s) - 1
      do k = first(s), first(s + 1) - 2
        node = draft%start(s) + k - first(s)
        call curve_point(boundaries, curves(s), ends(k), draft%x(:, node), draft%position(node))
        draft%next(node) = node + 1
        draft%smooth(node) = k > first(s)
      end do
      associate (node => draft%start(s))
        draft%smooth(node) = abs(turn_at(boundaries(curves(s)%boundary), draft%position(node)%arc)) <= flat_turn
      end associate
    end do
    n = 1
    do s = 1, nside
      ! the last side of a contour ends where its first one began
      if (layout%sides(s)%boundary /= layout%sides(n)%boundary) n = s
      draft%next(draft%start(s + 1) - 1) = merge(draft%start(n), draft%start(s + 1), closes(s))
    end do
    call put_seams(boundaries, layout, curves, first, ends, draft)

  contains

    pure function closes(side) result(yes)
      integer, intent(in) :: side
      logical :: yes

      yes = side == nside
      if (.not. yes) yes = layout%sides(side + 1)%boundary /= layout%sides(side)%boundary
    end function closes

  end subroutine put_points

  !> Points along seams: their ends inside the body, then those between the ends.
  pure subroutine put_seams(boundaries, layout, curves, first, ends, draft)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: first(:)
    real(wp), intent(in) :: ends(:)
    type(corner_mesh_t), intent(inout) :: draft
    type(position_t) :: ignored
    integer :: node_of(size(layout%points)), s, p, k, n

    allocate (draft%seams(size(curves)))
    if (draft%nfixed == size(draft%next)) return
    node_of = 0
    do s = 1, size(draft%start) - 1
      node_of(layout%sides(s)%points(1)) = draft%start(s)
    end do
    n = size(draft%next)
    do p = 1, size(node_of)
      if (layout%points(p)%boundary > 0) cycle
      n = n + 1
      node_of(p) = n
      draft%x(:, n) = layout%points(p)%x
    end do
    do s = size(draft%start), size(curves)
      associate (last => first(s + 1) - 1 - first(s))
        allocate (draft%seams(s)%points(0:last))
        draft%seams(s)%points([0, last]) = node_of(layout%sides(s)%points)
        do k = 1, last - 1
          n = n + 1
          draft%seams(s)%points(k) = n
          call curve_point(boundaries, curves(s), ends(first(s) + k), draft%x(:, n), ignored)
        end do
      end associate
    end do
  end subroutine put_seams

  !> The loops around an outline; `error` where it touches itself in a point.
  pure subroutine loops_around(layout, draft, outline, loops, error)
    type(zone_layout_t), intent(in) :: layout
    type(corner_mesh_t), intent(in) :: draft
    integer, intent(in) :: outline
    type(loops_t), intent(out) :: loops
    type(error_t), allocatable, intent(out) :: error
    integer :: after(draft%nfixed), before(draft%nfixed), number(draft%nfixed), s, k, n, node, start
    logical :: straight(draft%nfixed), clash

    after = 0
    clash = .false.
    do s = 1, size(layout%sides)
      associate (zones => layout%sides(s)%zones)
        if (s < size(draft%start)) then
          if (zones(1) /= outline) cycle
          do k = draft%start(s), draft%start(s + 1) - 1
            call join(k, draft%next(k), after, clash)
          end do
        else if (any(zones == outline)) then
          loops%has_seams = .true.
          do k = 1, ubound(draft%seams(s)%points, 1)
            associate (pair => draft%seams(s)%points(k - 1:k))
              call join(pair(merge(1, 2, zones(1) == outline)), pair(merge(2, 1, zones(1) == outline)), after, clash)
            end associate
          end do
        end if
      end associate
    end do
    if (clash .or. any(after > 0 .and. .not. [(any(after == k), k=1, size(after))])) then
      call fail(error, exit_no_convergence, 'remdata: bodies that share sides meet in a point where no mesh without zones '// &
                'separates them', 'give ZONE cards')
      return
    end if
    n = count(after > 0)
    allocate (loops%points(n), loops%next(n), loops%smooth(n), loops%first(0))
    number = 0
    n = 0
    do s = 1, size(layout%sides)
      if (all(layout%sides(s)%zones /= outline)) cycle
      if (s < size(draft%start)) then
        start = draft%start(s)
      else
        associate (points => draft%seams(s)%points)
          start = points(merge(0, ubound(points, 1), layout%sides(s)%zones(1) == outline))
        end associate
      end if
      if (number(start) > 0) cycle
      loops%first = [loops%first, n + 1]
      node = start
      do while (number(node) == 0)
        n = n + 1
        number(node) = n
        loops%points(n) = node
        node = after(node)
      end do
    end do
    loops%first = [loops%first, n + 1]
    loops%next = number(after(loops%points))
    if (loops%has_seams) then
      before(after(loops%points)) = loops%points
      straight = .false.
      do k = 1, n
        node = loops%points(k)
        straight(node) = bends_little(draft%x(:, before(node)), draft%x(:, node), draft%x(:, after(node)))
      end do
      loops%smooth = straight(loops%points)
    else
      loops%smooth = draft%smooth(loops%points)
    end if
  end subroutine loops_around

  !> One point follows another; `clash` where one does already.
  pure subroutine join(from, to, after, clash)
    integer, intent(in) :: from, to
    integer, intent(inout) :: after(:)   !! (npoint) 0 where none does
    logical, intent(inout) :: clash

    clash = clash .or. after(from) > 0
    after(from) = to
  end subroutine join

  !> The turn from one side to the next is that of a flat corner.
  pure function bends_little(a, b, c) result(flat)
    real(wp), intent(in) :: a(2), b(2), c(2)   !! three points in sequence [length]
    logical :: flat

    flat = abs(atan2(cross(b - a, c - b), dot_product(b - a, c - b))) <= flat_turn
  end function bends_little

end module corner_mesh
