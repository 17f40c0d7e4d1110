!> Where a straight cut crosses the contours of a body.
!>
!> The distance from the line of the cut changes its sign along a contour; the place is found by bisection on the arc. Crossings are
!> sorted along the cut: from the first to the second it runs through the body, from the third to the fourth, and so on. One that
!> lies close to a corner, or to an end of contact, is put there, so that no short side is left to be meshed.
module cut_crossings
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t, closest_position, joint_point, kind_end, point_on, position_t
  use corrected_contours, only: contour_t
  use kinds, only: wp
  use offset_parabolas, only: point_at
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: cut_crossing_t, close_to_joint, crossings_of_line, crossings_of_way, is_after

  type :: cut_crossing_t
    integer :: contour = 0
    type(position_t) :: position
    !> Share of the cut up to there.
    real(wp) :: along = 0.0_wp
    !> The contour, along its direction, enters there what is kept.
    logical :: enters = .false.
    !> Crossing at the other end of the cut through the body.
    integer :: mate = 0
  end type cut_crossing_t

  !> Where they meet, cuts and joints closer than this share of the smallest element are one point.
  real(wp), parameter :: close_to_joint = 0.25_wp
  !> Parts of an arc that are looked at, and halvings.
  integer, parameter :: parts = 8, halvings = 60
  !> A cut may end on the contour, within this share of its length.
  real(wp), parameter :: at_its_end = 1.0e-9_wp

contains

  !> Crossings of the contours `among` with a line, paired; `odd`: the line begins or ends within the body.
  pure subroutine crossings_of_line(contours, among, line, kept, close, list, odd)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: among(:)              !! (ncontour)
    real(wp), intent(in) :: line(4), kept(2)     !! points at its ends, a point on the side that is kept [length]
    real(wp), intent(in) :: close                !! to a joint [length]
    type(cut_crossing_t), allocatable, intent(out) :: list(:)   !! (ncrossing) along the line
    logical, intent(out) :: odd
    real(wp) :: before
    integer :: c, k

    allocate (list(0))
    do c = 1, size(contours)
      if (.not. among(c)) cycle
      associate (arcs => contours(c)%boundary%arcs)
        before = height(point_at(arcs(size(arcs)), arcs(size(arcs))%range(2)))
        do k = 1, size(arcs)
          call follow_arc(c, k, before, list)
        end do
      end associate
    end do
    odd = mod(size(list), 2) == 1
    do k = 1, size(list) - 1, 2
      list(k)%mate = k + 1
      list(k + 1)%mate = k
      odd = odd .or. (list(k)%enters .eqv. list(k + 1)%enters)
    end do

  contains

    !> Crossings of an arc; `before` is the height where it begins, and then where it ends.
    pure subroutine follow_arc(c, k, before, list)
      integer, intent(in) :: c, k   !! contour, and arc of it
      real(wp), intent(inout) :: before
      type(cut_crossing_t), allocatable, intent(inout) :: list(:)
      real(wp) :: now, xi, last
      integer :: i

      associate (arc => contours(c)%boundary%arcs(k))
        last = arc%range(1)
        do i = 0, parts
          xi = arc%range(1) + (arc%range(2) - arc%range(1))*i/parts
          now = height(point_at(arc, xi))
          if ((now < 0) .neqv. (before < 0)) &
            call add_crossing(c, position_t(k, root(arc, last, xi, before < 0)), before < 0, list)
          before = now
          last = xi
        end do
      end associate
    end subroutine follow_arc

    !> A crossing of the line through the ends of the cut is one of the cut where it is between them.
    pure subroutine add_crossing(c, position, enters, list)
      integer, intent(in) :: c
      type(position_t), intent(in) :: position
      logical, intent(in) :: enters
      type(cut_crossing_t), allocatable, intent(inout) :: list(:)
      type(cut_crossing_t) :: one

      one%contour = c
      one%position = position
      one%enters = enters
      associate (boundary => contours(c)%boundary, way => line(3:4) - line(1:2))
        one%along = dot_product(point_on(boundary, position) - line(1:2), way)/dot_product(way, way)
        if (one%along < -at_its_end .or. one%along > 1 + at_its_end) return
        call put_at_joint(boundary, close, one%position)
      end associate
      call insert(one, list)
    end subroutine add_crossing

    !> Distance from the line, positive where it is kept, times its length.
    pure function height(point) result(h)
      real(wp), intent(in) :: point(2)
      real(wp) :: h

      h = cross(line(3:4) - line(1:2), point - line(1:2))
      if (cross(line(3:4) - line(1:2), kept - line(1:2)) < 0) h = -h
    end function height

    !> Where the arc crosses the line between two of its parent coordinates.
    pure function root(arc, from, to, is_below) result(middle)
      type(arc_t), intent(in) :: arc
      real(wp), intent(in) :: from, to
      logical, intent(in) :: is_below   !! at `from`
      real(wp) :: middle
      real(wp) :: low, high
      integer :: n

      low = from
      high = to
      do n = 1, halvings
        middle = 0.5_wp*(low + high)
        if ((height(point_at(arc, middle)) < 0) .eqv. is_below) then
          low = middle
        else
          high = middle
        end if
      end do
      middle = high
    end function root

  end subroutine crossings_of_line

  !> The two ends of a way through the body; `enters` is true of the first.
  pure subroutine crossings_of_way(contours, among, from, to, close, list)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: among(:)              !! (ncontour)
    real(wp), intent(in) :: from(2), to(2), close           !! close to a joint [length]
    type(cut_crossing_t), allocatable, intent(out) :: list(:)   !! (2)
    type(position_t) :: position
    real(wp) :: ends(2, 2), distance, least
    integer :: c, k

    ends = reshape([from, to], [2, 2])
    allocate (list(2))
    do k = 1, 2
      least = huge(least)
      do c = 1, size(contours)
        if (.not. among(c)) cycle
        position = closest_position(contours(c)%boundary, ends(:, k))
        distance = length_of(point_on(contours(c)%boundary, position) - ends(:, k))
        if (.not. distance < least) cycle
        least = distance
        list(k)%contour = c
        list(k)%position = position
      end do
      if (list(k)%contour > 0) call put_at_joint(contours(list(k)%contour)%boundary, close, list(k)%position)
      list(k)%along = k - 1
      list(k)%mate = 3 - k
    end do
    list(1)%enters = .true.
  end subroutine crossings_of_way

  !> A position close to a joint that a new mesh has a node at moves there.
  pure subroutine put_at_joint(boundary, close, position)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: close
    type(position_t), intent(inout) :: position
    real(wp) :: point(2), distance, least
    integer :: joint, k

    point = point_on(boundary, position)
    least = close
    joint = 0
    do k = 1, size(boundary%arcs)
      if (boundary%kinds(k) == kind_end) cycle
      distance = length_of(joint_point(boundary, k) - point)
      if (.not. distance < least) cycle
      least = distance
      joint = k
    end do
    if (joint > 0) position = position_t(joint, boundary%arcs(joint)%range(1))
  end subroutine put_at_joint

  !> Sorted along the cut.
  pure subroutine insert(one, list)
    type(cut_crossing_t), intent(in) :: one
    type(cut_crossing_t), allocatable, intent(inout) :: list(:)
    type(cut_crossing_t), allocatable :: longer(:)
    integer :: n

    n = count(list%along <= one%along)
    allocate (longer(size(list) + 1))
    longer(:n) = list(:n)
    longer(n + 1) = one
    longer(n + 2:) = list(n + 1:)
    call move_alloc(longer, list)
  end subroutine insert

  !> Does a position come after another one, from the start of their contour?
  pure function is_after(one, other) result(yes)
    type(position_t), intent(in) :: one, other
    logical :: yes

    yes = one%arc > other%arc .or. (one%arc == other%arc .and. one%xi > other%xi)
  end function is_after

end module cut_crossings
