!> Triangles merged in pairs to quadrilaterals.
!>
!> The pairs are a matching of the triangles' neighbourhood: J.-F. Remacle et al., Blossom-Quad, Int. J. Num. Meth. Engng 89 (2012)
!> 1102-1119, with the quality of eq. (3) there. The best pairs are taken first; triangles that are left are reached by alternating
!> paths, with odd cycles contracted (J. Edmonds, Paths, trees, and flowers, Canadian J. Math. 17 (1965) 449-467), first over good
!> pairs, then over any. Cleaning repairs what a path has cost.
module triangle_pairs
  use alternating_paths, only: begin_search, exchange_pairs, find_path, forget, path_search_t
  use directed_sizes, only: to_squares
  use kinds, only: pi, wp
  use plane_vectors, only: angle_between
  use triangulation, only: after, before, place_of, triangulation_t
  implicit none
  private
  public :: pair_triangles

  !> Steps of quality in which pairs are sorted, and qualities that paths may use: good pairs, then any.
  integer, parameter :: steps = 1000
  real(wp), parameter :: least_quality(2) = [0.2_wp, -1.0_wp]
  !> Widest corner that one quadrilateral fills: 120 degrees.
  real(wp), parameter :: widest_corner = 2*pi/3

contains

  !> The quadrilaterals, counter-clockwise; triangles that remain have a fourth corner of 0.
  pure subroutine pair_triangles(mesh, stretch, corners)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: stretch(:, :)              !! of quadrilaterals around each point (2, npoint) [-]
    integer, allocatable, intent(out) :: corners(:, :)   !! (4, n) points of the triangulation
    real(wp), allocatable :: quality(:, :)
    integer, allocatable :: partner(:)
    type(path_search_t) :: search
    integer :: t, k, round, n, last

    allocate (quality(3, mesh%ntriangle), source=-2.0_wp)
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t)) cycle
      do k = 1, 3
        if (mesh%kept(k, t)) cycle
        if (mesh%across(k, t) > t) then
          quality(k, t) = quality_of(mesh, stretch, t, k)
        else
          quality(k, t) = quality(place_of(mesh, t, mesh%across(k, t)), mesh%across(k, t))
        end if
      end do
    end do
    allocate (partner(mesh%ntriangle), source=0)
    call fill_corners(mesh, quality, partner)
    call take_best(mesh, quality, partner)
    call begin_search(mesh%ntriangle, search)
    do round = 1, size(least_quality)
      do t = 1, mesh%ntriangle
        if (.not. mesh%inside(t) .or. partner(t) > 0) cycle
        call find_path(mesh, quality, least_quality(round), t, partner, search, last)
        call exchange_pairs(last, search%from, partner)
        call forget(search)
      end do
    end do
    n = count(mesh%inside(:mesh%ntriangle) .and. partner <= 0)
    n = (count(mesh%inside(:mesh%ntriangle)) - n)/2 + n
    allocate (corners(4, n))
    n = 0
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t) .or. (partner(t) > 0 .and. partner(t) < t)) cycle
      n = n + 1
      corners(:, n) = [mesh%node(:, t), 0]
      if (partner(t) > 0) then
        k = place_of(mesh, partner(t), t)
        corners(:, n) = merged(mesh, t, k)
      end if
    end do
  end subroutine pair_triangles

  !> The quadrilateral of triangle t and the one beyond its side k.
  pure function merged(mesh, t, k) result(quad)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: t, k
    integer :: quad(4)

    associate (u => mesh%across(k, t))
      quad = [mesh%node(k, t), mesh%node(after(k), t), mesh%node(place_of(mesh, t, u), u), mesh%node(before(k), t)]
    end associate
  end function merged

  !> 1 for a rectangle, 0 or less where a corner is flat or beyond.
  pure function quality_of(mesh, stretch, t, k) result(quality)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: stretch(:, :)
    integer, intent(in) :: t, k
    real(wp) :: quality
    real(wp) :: x(2, 4), angle, worst
    integer :: corners(4), i

    corners = merged(mesh, t, k)
    x = matmul(to_squares(0.25_wp*sum(stretch(:, corners), 2)), mesh%x(:, corners))
    worst = 0
    do i = 1, 4
      angle = angle_between(x(:, mod(i, 4) + 1) - x(:, i), x(:, modulo(i - 2, 4) + 1) - x(:, i))
      if (angle < 0) angle = angle + 2*pi
      worst = max(worst, abs(pi/2 - angle))
    end do
    quality = max(1 - 2/pi*worst, -1.0_wp)
  end function quality_of

  !> At a corner of a contour that one quadrilateral fills, its triangle is paired with the neighbour, or two with each other.
  !> No path takes them apart.
  pure subroutine fill_corners(mesh, quality, partner)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(inout) :: quality(:, :)
    integer, intent(inout) :: partner(:)
    real(wp) :: angle(mesh%npoint), best
    integer :: number(mesh%npoint), t, u, k, side

    angle = 0
    number = 0
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t)) cycle
      do k = 1, 3
        associate (a => mesh%node(k, t), b => mesh%node(after(k), t), c => mesh%node(before(k), t))
          angle(a) = angle(a) + angle_between(mesh%x(:, b) - mesh%x(:, a), mesh%x(:, c) - mesh%x(:, a))
          number(a) = number(a) + 1
        end associate
      end do
    end do
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t)) cycle
      do k = 1, 3
        associate (point => mesh%node(k, t))
          if (angle(point) > widest_corner .or. number(point) > 2 .or. partner(t) > 0) cycle
          best = 0
          side = 0
          do u = 1, 3
            ! the side opposite to the corner where it has one triangle, one at the corner where it has two
            if (number(point) == 1 .neqv. u == k) cycle
            if (.not. quality(u, t) > best) cycle
            best = quality(u, t)
            side = u
          end do
        end associate
        if (side == 0) cycle
        u = mesh%across(side, t)
        if (partner(u) > 0) cycle
        partner(t) = u
        partner(u) = t
        quality(:, t) = -2
        quality(:, u) = -2
        call close_sides(mesh, t, quality)
        call close_sides(mesh, u, quality)
      end do
    end do
  end subroutine fill_corners

  !> No other triangle is paired with this one.
  pure subroutine close_sides(mesh, t, quality)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: t
    real(wp), intent(inout) :: quality(:, :)
    integer :: k

    do k = 1, 3
      if (mesh%across(k, t) > 0) quality(place_of(mesh, t, mesh%across(k, t)), mesh%across(k, t)) = -2
    end do
  end subroutine close_sides

  !> Pairs in the order of their quality.
  pure subroutine take_best(mesh, quality, partner)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: quality(:, :)
    integer, intent(inout) :: partner(:)
    integer :: begin(0:steps + 1), t, k, step
    integer, allocatable :: sorted(:, :)

    begin = 0
    do t = 1, mesh%ntriangle
      do k = 1, 3
        if (.not. quality(k, t) > 0 .or. mesh%across(k, t) < t) cycle
        step = bin(quality(k, t)) + 1
        begin(step) = begin(step) + 1
      end do
    end do
    do step = 1, steps + 1
      begin(step) = begin(step) + begin(step - 1)
    end do
    allocate (sorted(2, begin(steps + 1)))
    do t = 1, mesh%ntriangle
      do k = 1, 3
        if (.not. quality(k, t) > 0 .or. mesh%across(k, t) < t) cycle
        step = bin(quality(k, t))
        begin(step) = begin(step) + 1
        sorted(:, begin(step)) = [t, mesh%across(k, t)]
      end do
    end do
    do k = 1, size(sorted, 2)
      if (any(partner(sorted(:, k)) > 0)) cycle
      partner(sorted(1, k)) = sorted(2, k)
      partner(sorted(2, k)) = sorted(1, k)
    end do

  contains

    !> From 0 for the best.
    pure function bin(q) result(number)
      real(wp), intent(in) :: q
      integer :: number

      number = min(max(int((1 - q)*steps), 0), steps)
    end function bin

  end subroutine take_best

end module triangle_pairs
