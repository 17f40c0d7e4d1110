!> Points inside a body, as the corners of squares of the requested size side by side.
!>
!> A queue begins with the points along the contours. Each point taken from it proposes four more, one size away along the two
!> directions there; one that is too close to others, in the norm of the largest coordinate along the directions, is rejected; the
!> others enter the queue. First of all a corner of a contour proposes the fourth point of the square there: J.-F. Remacle et al.,
!> A frontal Delaunay quad mesh generator using the L-infinity norm, Int. J. Num. Meth. Engng 94 (2013) 494-512; T. C. Baudouin et
!> al., A frontal approach to hex-dominant mesh generation, Adv. Model. Simul. Engng Sci. 1 (2014) 8. Every point fills a square
!> of its own, so that their number, and the work, is bounded by the area.
module point_packing
  use background, only: background_t, look_up
  use directed_sizes, only: no_stretch, to_squares
  use errors, only: error_t, exit_no_convergence, fail
  use exact_signs, only: on_grid
  use kinds, only: pi, wp
  use plane_vectors, only: angle_between, cross
  use text, only: to_text
  use triangulation, only: add_point, after, before, find_triangle, triangulation_t
  use vectors, only: length_of
  implicit none
  private
  public :: pack_points

  !> A point has no other one within this distance, over the size, and no side that is kept within the second.
  real(wp), parameter :: closest = 0.71_wp, closest_side = 0.45_wp
  real(wp), parameter :: root_of_two = 1.41421356237309504880_wp
  !> Widest corner that is filled by one square, 120 degrees, and the share of the size that is its own: less, for in a sharp corner
  !> the next points of the contours are close.
  real(wp), parameter :: widest_corner = 2*pi/3, corner_share = 0.6_wp
  !> Triangles that wait for a visit; points that far are no neighbours.
  integer, parameter :: most_visits = 200
  !> More points than this are refused.
  integer, parameter :: most_points = 4000000

contains

  !> Fill the triangles inside. Directions and sizes are those of the background.
  pure subroutine pack_points(field, contours, mesh, error)
    type(background_t), intent(in) :: field
    integer, intent(in) :: contours(:, :)   !! ends of the contours' sides, points of the triangulation (2, nside)
    type(triangulation_t), intent(inout) :: mesh
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: near(:), stamp(:)
    real(wp) :: h, direction(2), x(2), ahead, d(2), there(2), mean, own(2), stretch(2)
    integer :: k, point, new, t, u, place
    logical :: taken

    allocate (near(size(mesh%x, 2)), stamp(size(mesh%node, 2)), source=0)
    call fill_corners(contours, mesh, stamp)
    call grow(near, size(mesh%x, 2))
    point = 4
    do while (point < mesh%npoint)
      point = point + 1
      if (mesh%npoint > most_points) then
        call fail(error, exit_no_convergence, 'remdata: the requested sizes give more than '//to_text(most_points)//' points', &
                  'ask for larger elements')
        return
      end if
      call look_up(field, mesh%x(:, point), near(point), mean, direction, own)
      do k = 0, 3
        d = direction
        if (mod(k, 2) == 1) d = [-d(2), d(1)]
        if (k >= 2) d = -d
        h = mean*along(own, d)
        ! the mean size on the way
        u = near(point)
        call look_up(field, mesh%x(:, point) + h*d, u, ahead, there, stretch)
        if (u == 0) cycle
        ahead = ahead*along(stretch, d)
        x = mesh%x(:, point) + 0.5_wp*(h + ahead)*d
        place = near(point)
        call look_up(field, x, place, ahead, there, stretch)
        if (place == 0) cycle
        call find_triangle(mesh, on_grid(mesh%frame, x), mesh%triangle_at(point), t)
        if (.not. mesh%inside(t)) cycle
        call grow(stamp, size(mesh%node, 2))
        call find_neighbours(mesh, x, there, ahead, stretch, t, 4*point + k, stamp, taken)
        if (taken) cycle
        call add_point(mesh, x, t, new)
        if (new == 0) cycle
        call grow(near, size(mesh%x, 2))
        near(new) = place
      end do
    end do
  end subroutine pack_points

  !> The fourth points of parallelograms at convex corners of contours, where they are not too close to others.
  pure subroutine fill_corners(contours, mesh, stamp)
    integer, intent(in) :: contours(:, :)
    type(triangulation_t), intent(inout) :: mesh
    integer, allocatable, intent(inout) :: stamp(:)
    integer :: before(mesh%npoint), s, t, new
    real(wp) :: to(2), from(2), h, x(2)
    logical :: taken

    before = 0
    do s = 1, size(contours, 2)
      before(contours(2, s)) = contours(1, s)
    end do
    do s = 1, size(contours, 2)
      associate (point => contours(1, s))
        to = mesh%x(:, contours(2, s)) - mesh%x(:, point)
        from = mesh%x(:, before(point)) - mesh%x(:, point)
        if (.not. angle_between(to, from) > 0 .or. angle_between(to, from) > widest_corner) cycle
        h = min(length_of(to), length_of(from))
        x = mesh%x(:, point) + to + from
        call find_triangle(mesh, on_grid(mesh%frame, x), mesh%triangle_at(point), t)
      end associate
      if (.not. mesh%inside(t)) cycle
      call grow(stamp, size(mesh%node, 2))
      call find_neighbours(mesh, x, to/length_of(to), corner_share*h, no_stretch, t, -s, stamp, taken)
      if (.not. taken) call add_point(mesh, x, t, new)
    end do
  end subroutine fill_corners

  pure subroutine grow(list, n)
    integer, allocatable, intent(inout) :: list(:)
    integer, intent(in) :: n
    integer, allocatable :: larger(:)

    if (size(list) >= n) return
    allocate (larger(n), source=0)
    larger(:size(list)) = list
    call move_alloc(larger, list)
  end subroutine grow

  !> Is a place too close to points or kept sides? Triangles are visited from the one it lies in, as far as the distance reaches
  !> and no kept side hides them; `stamp` remembers the visit.
  pure subroutine find_neighbours(mesh, x, direction, h, stretch, first, visit, stamp, taken)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: x(2), direction(2), h   !! [length]
    real(wp), intent(in) :: stretch(2)              !! [-]
    integer, intent(in) :: first, visit
    integer, intent(inout) :: stamp(:)
    logical, intent(out) :: taken
    integer :: stack(most_visits), n, t, k
    real(wp) :: reach(2), gap, square(2, 2), ends(2, 3)

    square = to_squares(stretch)
    taken = .true.
    n = 1
    stack(1) = first
    stamp(first) = visit
    do while (n > 0)
      t = stack(n)
      n = n - 1
      do k = 1, 3
        reach = matmul(square, mesh%x(:, mesh%node(k, t)) - x)
        ends(:, k) = reach
        if (max(abs(dot_product(direction, reach)), abs(cross(direction, reach))) < closest*h) return
      end do
      do k = 1, 3
        gap = distance_to_side(ends(:, after(k)), ends(:, before(k)))
        if (mesh%kept(k, t)) then
          if (gap < closest_side*h) return
          cycle
        end if
        if (gap > root_of_two*closest*h .or. mesh%across(k, t) == 0 .or. n == most_visits) cycle
        if (stamp(mesh%across(k, t)) == visit) cycle
        stamp(mesh%across(k, t)) = visit
        n = n + 1
        stack(n) = mesh%across(k, t)
      end do
    end do
    taken = .false.
  end subroutine find_neighbours

  !> Distance of a side between two points from the origin.
  pure function distance_to_side(a, b) result(distance)
    real(wp), intent(in) :: a(2), b(2)
    real(wp) :: distance
    real(wp) :: way(2)

    way = b - a
    distance = length_of(a + min(max(-dot_product(a, way)/dot_product(way, way), 0.0_wp), 1.0_wp)*way)
  end function distance_to_side

  !> Size in a unit direction, along or across the stretch, over the mean one.
  pure function along(stretch, d) result(ratio)
    real(wp), intent(in) :: stretch(2), d(2)
    real(wp) :: ratio

    ratio = exp(stretch(1)*(d(1)**2 - d(2)**2) + 2*stretch(2)*d(1)*d(2))
  end function along

end module point_packing
