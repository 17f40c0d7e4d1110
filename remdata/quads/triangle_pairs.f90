!> Triangles merged in pairs to quadrilaterals.
!>
!> The pairs are a matching of the triangles' neighbourhood: J.-F. Remacle et al., Blossom-Quad, Int. J. Num. Meth. Engng 89 (2012)
!> 1102-1119, with the quality of eq. (3) there. The best pairs are taken first; triangles that are left are reached by alternating
!> paths, with odd cycles contracted (J. Edmonds, Paths, trees, and flowers, Canadian J. Math. 17 (1965) 449-467), first over good
!> pairs, then over any. Cleaning repairs what a path has cost.
module triangle_pairs
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
  !> A path reaches so many triangles at most.
  integer, parameter :: most_reached = 20000

  !> Search for a path: one entry a triangle.
  type :: path_search_t
    integer, allocatable :: from(:), base(:)
    logical, allocatable :: queued(:), in_cycle(:), marked(:)
    integer, allocatable :: queue(:), reached(:)
    integer :: nqueue = 0, nreached = 0
  end type path_search_t

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
    n = mesh%ntriangle
    allocate (search%from(n), search%base(n), search%queue(n), search%reached(n), source=0)
    allocate (search%queued(n), search%in_cycle(n), search%marked(n), source=.false.)
    do t = 1, n
      search%base(t) = t
    end do
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

  !> Breadth-first search from a triangle without partner to another one; `last` is that one, 0 where none is reached.
  pure subroutine find_path(mesh, quality, least, root, partner, search, last)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: quality(:, :), least
    integer, intent(in) :: root, partner(:)
    type(path_search_t), intent(inout) :: search
    integer, intent(out) :: last
    integer :: next, v, to, k
    logical :: is_outer

    last = 0
    call reach(search, root)
    call put_in_queue(search, root)
    next = 0
    do while (next < search%nqueue .and. search%nreached < most_reached)
      next = next + 1
      v = search%queue(next)
      do k = 1, 3
        if (quality(k, v) < least) cycle
        to = mesh%across(k, v)
        if (search%base(v) == search%base(to) .or. partner(v) == to) cycle
        is_outer = to == root
        if (.not. is_outer .and. partner(to) > 0) is_outer = search%from(partner(to)) > 0
        if (is_outer) then
          call contract(v, to, partner, search)
        else if (search%from(to) == 0) then
          call reach(search, to)
          search%from(to) = v
          if (partner(to) == 0) then
            last = to
            return
          end if
          call reach(search, partner(to))
          call put_in_queue(search, partner(to))
        end if
      end do
    end do
  end subroutine find_path

  pure subroutine reach(search, t)
    type(path_search_t), intent(inout) :: search
    integer, intent(in) :: t

    if (search%marked(t)) return
    search%marked(t) = .true.
    search%nreached = search%nreached + 1
    search%reached(search%nreached) = t
  end subroutine reach

  pure subroutine put_in_queue(search, t)
    type(path_search_t), intent(inout) :: search
    integer, intent(in) :: t

    if (search%queued(t)) return
    search%queued(t) = .true.
    search%nqueue = search%nqueue + 1
    search%queue(search%nqueue) = t
  end subroutine put_in_queue

  !> Contract the odd cycle that the neighbours v and w close, to where their ways to the root meet.
  pure subroutine contract(v, w, partner, search)
    integer, intent(in) :: v, w, partner(:)
    type(path_search_t), intent(inout) :: search
    integer :: base, i

    base = meeting_point(v, w, partner, search)
    do i = 1, search%nreached
      search%in_cycle(search%reached(i)) = .false.
    end do
    call mark_way(v, base, w, partner, search)
    call mark_way(w, base, v, partner, search)
    do i = 1, search%nreached
      associate (t => search%reached(i))
        if (.not. search%in_cycle(search%base(t))) cycle
        search%base(t) = base
        call put_in_queue(search, t)
      end associate
    end do
  end subroutine contract

  pure function meeting_point(v, w, partner, search) result(base)
    integer, intent(in) :: v, w, partner(:)
    type(path_search_t), intent(in) :: search
    integer :: base
    integer :: t
    integer :: seen(search%nreached), n

    n = 0
    t = v
    do
      t = search%base(t)
      n = n + 1
      seen(n) = t
      if (partner(t) == 0) exit
      t = search%from(partner(t))
    end do
    base = w
    do
      base = search%base(base)
      if (any(seen(:n) == base)) return
      base = search%from(partner(base))
    end do
  end function meeting_point

  pure subroutine mark_way(from, base, to, partner, search)
    integer, intent(in) :: from, base, to, partner(:)
    type(path_search_t), intent(inout) :: search
    integer :: t, next

    t = from
    next = to
    do while (search%base(t) /= base)
      search%in_cycle(search%base(t)) = .true.
      search%in_cycle(search%base(partner(t))) = .true.
      search%from(t) = next
      next = partner(t)
      t = search%from(partner(t))
    end do
  end subroutine mark_way

  !> Along a path from its last triangle to the first, pairs are exchanged.
  pure subroutine exchange_pairs(last, from, partner)
    integer, intent(in) :: last, from(:)
    integer, intent(inout) :: partner(:)
    integer :: t, v, next

    t = last
    do while (t > 0)
      v = from(t)
      next = partner(v)
      partner(t) = v
      partner(v) = t
      t = next
    end do
  end subroutine exchange_pairs

  pure subroutine forget(search)
    type(path_search_t), intent(inout) :: search
    integer :: i

    do i = 1, search%nreached
      associate (t => search%reached(i))
        search%from(t) = 0
        search%base(t) = t
        search%queued(t) = .false.
        search%in_cycle(t) = .false.
        search%marked(t) = .false.
      end associate
    end do
    search%nreached = 0
    search%nqueue = 0
  end subroutine forget

end module triangle_pairs
