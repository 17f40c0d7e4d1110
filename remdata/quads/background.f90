!> Sizes and directions over a body, as values at the points of a coarse triangulation, linear in between.
!>
!> The triangulation of the contours is refined at the centres of circles larger than the requested size there (L. P. Chew,
!> Guaranteed-quality triangular meshes, Cornell University TR 89-983, 1989). Sides of contours that are shorter than requested,
!> for a side has a whole number of them, limit the size around by the gradation.
module background
  use cross_directions, only: align_directions
  use directed_sizes, only: no_stretch, size_along
  use exact_signs, only: on_grid
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use plane_vectors, only: cross
  use size_field, only: directed_size_at, size_field_t
  use triangulation, only: add_point, after, before, find_triangle, triangulation_t
  use vectors, only: length_of
  implicit none
  private
  public :: background_t, set_up_background, look_up

  !> Largest radius of a circle through three points, over the size.
  real(wp), parameter :: largest_radius = 1.0_wp
  !> Passes of refinement and of gradation at most; what is coarser after them is less accurate, not wrong.
  integer, parameter :: passes = 200
  !> A size is not made smaller by less than this share.
  real(wp), parameter :: gain = 1.0e-3_wp

  type :: background_t
    type(triangulation_t) :: mesh
    real(wp), allocatable :: h(:)         !! (npoint), of squares; else the root of width times length [length]
    !> Along and across the directions, in which elements are longer than wide (2, npoint) [-].
    real(wp), allocatable :: stretch(:, :)
    !> Cosine and sine of four times the angle of the directions (2, npoint).
    real(wp), allocatable :: fourfold(:, :)
  end type background_t

contains

  !> Refine the triangulation of the contours, and find sizes and directions.
  pure subroutine set_up_background(contours, sides, sizes, material, factor, field)
    type(triangulation_t), intent(in) :: contours
    integer, intent(in) :: sides(:, :)          !! ends of kept sides, points of the triangulation (2, nside)
    type(size_field_t), intent(in) :: sizes
    integer, intent(in) :: material             !! as `directed_size_at` takes it
    real(wp), intent(in) :: factor              !! ratio of the sizes to those of the field
    type(background_t), intent(out) :: field
    real(wp), allocatable :: h(:)
    integer :: k, n

    field%mesh = contours
    n = contours%npoint
    allocate (h(2*n))
    do k = 5, n
      h(k) = factor*width_at(sizes, material, contours%x(:, k))
    end do
    call refine(field%mesh, sizes, material, factor, h)
    allocate (field%h, source=h(:field%mesh%npoint))
    allocate (field%stretch(2, field%mesh%npoint), source=0.0_wp)
    call align_directions(field%mesh, sides, field%fourfold)
    if (sizes%is_directed) call stretch_along_directions(sizes, material, factor, field)
    call respect_sides(field%mesh, sides, field%fourfold, field%h, field%stretch)
    call grade_sizes(field%mesh, slope_of(sizes%limits%gradation), field%h)
  end subroutine set_up_background

  !> Sizes along both directions: the mean, and the stretch between them.
  pure subroutine stretch_along_directions(sizes, material, factor, field)
    type(size_field_t), intent(in) :: sizes
    integer, intent(in) :: material
    real(wp), intent(in) :: factor
    type(background_t), intent(inout) :: field
    real(wp) :: across, stretch(2), d(2), h(2)
    integer :: k

    do k = 5, field%mesh%npoint
      call directed_size_at(sizes, material, field%mesh%x(:, k), across, stretch)
      d = direction_of(field%fourfold(:, k))
      h = [size_along(across, stretch, d), size_along(across, stretch, [-d(2), d(1)])]
      field%h(k) = factor*sqrt(h(1)*h(2))
      field%stretch(:, k) = 0.5_wp*log(h(1)/h(2))*twofold(d)
    end do
  end subroutine stretch_along_directions

  !> Direction of a fourfold angle.
  pure function direction_of(fourfold) result(direction)
    real(wp), intent(in) :: fourfold(2)   !! [-]
    real(wp) :: direction(2), angle

    angle = 0.25_wp*atan2(fourfold(2), fourfold(1))
    direction = [cos(angle), sin(angle)]
  end function direction_of

  !> Cosine and sine of twice the angle of a unit vector.
  pure function twofold(d) result(double)
    real(wp), intent(in) :: d(2)   !! [-]
    real(wp) :: double(2)

    double = [d(1)**2 - d(2)**2, 2*d(1)*d(2)]
  end function twofold

  pure subroutine refine(mesh, sizes, material, factor, h)
    type(triangulation_t), intent(inout) :: mesh
    type(size_field_t), intent(in) :: sizes
    integer, intent(in) :: material
    real(wp), intent(in) :: factor
    real(wp), allocatable, intent(inout) :: h(:)
    real(wp), allocatable :: more(:)
    real(wp) :: centre(2), radius, here
    integer :: pass, t, u, point, old

    do pass = 1, passes
      old = mesh%npoint
      t = 0
      do while (t < mesh%ntriangle)
        t = t + 1
        if (.not. mesh%inside(t)) cycle
        associate (a => mesh%x(:, mesh%node(1, t)), b => mesh%x(:, mesh%node(2, t)), c => mesh%x(:, mesh%node(3, t)))
          call circle(a, b, c, centre, radius)
          ! sizes of the three corners first: they cost nothing
          if (radius <= largest_radius*minval(h(mesh%node(:, t)))) cycle
          call find_triangle(mesh, on_grid(mesh%frame, centre), t, u)
          if (.not. mesh%inside(u)) then
            centre = (a + b + c)/3
            radius = 0.5_wp*min(length_of(b - a), length_of(c - b), length_of(a - c))
            u = t
          end if
        end associate
        here = factor*width_at(sizes, material, centre)
        if (radius <= largest_radius*here) cycle
        call add_point(mesh, centre, u, point)
        if (point == 0) cycle
        if (point > size(h)) then
          allocate (more(2*point))
          more(:point - 1) = h(:point - 1)
          call move_alloc(more, h)
        end if
        h(point) = here
      end do
      if (mesh%npoint == old) exit
    end do
  end subroutine refine

  !> Width of elements.
  pure function width_at(sizes, material, x) result(h)
    type(size_field_t), intent(in) :: sizes
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)
    real(wp) :: h, stretch(2)

    call directed_size_at(sizes, material, x, h, stretch)
  end function width_at

  !> Centre and radius of the circle through three points.
  pure subroutine circle(a, b, c, centre, radius)
    real(wp), intent(in) :: a(2), b(2), c(2)
    real(wp), intent(out) :: centre(2), radius
    real(wp) :: u(2), v(2), r(2), det

    u = b - a
    v = c - a
    det = 2*cross(u, v)
    if (det > 0) then
      r = [v(2)*sum(u*u) - u(2)*sum(v*v), u(1)*sum(v*v) - v(1)*sum(u*u)]/det
      centre = a + r
    else
      ! flat on the grid's scale
      r = u
      centre = (a + b + c)/3
    end if
    radius = length_of(r)
  end subroutine circle

  !> At kept sides the size is no larger than the mean of the sides there; where sizes differ by direction, that along each
  !> direction than the mean of the sides nearest to it. Where there is none, elements keep their shape or become squares.
  pure subroutine respect_sides(mesh, sides, fourfold, h, stretch)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: sides(:, :)
    real(wp), intent(in) :: fourfold(:, :)
    real(wp), intent(inout) :: h(:), stretch(:, :)
    real(wp) :: total(2, size(h)), length, way(2), d(2), double(2), size_now(2), most(2)
    integer :: number(2, size(h)), s, i, k, n

    total = 0
    number = 0
    do s = 1, size(sides, 2)
      way = mesh%x(:, sides(2, s)) - mesh%x(:, sides(1, s))
      length = length_of(way)
      do i = 1, 2
        associate (point => sides(i, s))
          d = direction_of(fourfold(:, point))
          k = merge(1, 2, abs(dot_product(d, way)) >= abs(cross(d, way)))
          total(k, point) = total(k, point) + length
          number(k, point) = number(k, point) + 1
        end associate
      end do
    end do
    do i = 1, size(h)
      n = sum(number(:, i))
      if (n == 0) cycle
      if (.not. any(abs(stretch(:, i)) > 0)) then
        h(i) = min(h(i), sum(total(:, i))/n)
        cycle
      end if
      double = twofold(direction_of(fourfold(:, i)))
      size_now = h(i)*exp(dot_product(stretch(:, i), double)*[1, -1])
      do k = 1, 2
        most(k) = total(k, i)/max(number(k, i), 1)
        if (number(k, i) == 0) most(k) = total(3 - k, i)/number(3 - k, i)*max(1.0_wp, size_now(k)/size_now(3 - k))
      end do
      size_now = min(size_now, most)
      h(i) = sqrt(size_now(1)*size_now(2))
      stretch(:, i) = 0.5_wp*log(size_now(1)/size_now(2))*double
    end do
  end subroutine respect_sides

  !> No size is larger than another one by more than the slope times their distance, along the triangles' sides.
  pure subroutine grade_sizes(mesh, slope, h)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: slope
    real(wp), intent(inout) :: h(:)
    integer :: pass, t, k
    real(wp) :: most
    logical :: changed

    do pass = 1, passes
      changed = .false.
      do t = 1, mesh%ntriangle
        if (.not. mesh%inside(t)) cycle
        do k = 1, 3
          associate (a => mesh%node(k, t), b => mesh%node(after(k), t))
            most = slope*length_of(mesh%x(:, b) - mesh%x(:, a)) + min(h(a), h(b))
            if (max(h(a), h(b)) <= (1 + gain)*most) cycle
            h(a) = min(h(a), most)
            h(b) = min(h(b), most)
            changed = .true.
          end associate
        end do
      end do
      if (.not. changed) exit
    end do
  end subroutine grade_sizes

  !> Size and direction at a place; `near` is a triangle to search from (0: any), and then the one that contains the place, or 0
  !> outside the body.
  pure subroutine look_up(field, x, near, h, direction, stretch)
    type(background_t), intent(in) :: field
    real(wp), intent(in) :: x(2)             !! [length]
    integer, intent(inout) :: near
    real(wp), intent(out) :: h               !! root of width times length [length]
    real(wp), intent(out) :: direction(2)    !! unit vector [-]
    real(wp), intent(out) :: stretch(2)      !! along or across the direction [-]
    real(wp) :: share(3), fourfold(2), double(2)
    integer :: t, k

    h = 0
    stretch = no_stretch
    direction = [1.0_wp, 0.0_wp]
    call find_triangle(field%mesh, on_grid(field%mesh%frame, x), max(near, 1), t)
    near = 0
    if (.not. field%mesh%inside(t)) return
    near = t
    associate (mesh => field%mesh, node => field%mesh%node(:, t))
      do k = 1, 3
        share(k) = max(cross(mesh%x(:, node(after(k))) - x, mesh%x(:, node(before(k))) - x), 0.0_wp)
      end do
      share = share/max(sum(share), tiny(1.0_wp))
      h = dot_product(share, field%h(node))
      fourfold = matmul(field%fourfold(:, node), share)
      stretch = matmul(field%stretch(:, node), share)
    end associate
    direction = direction_of(fourfold)
    double = twofold(direction)
    stretch = dot_product(stretch, double)*double
  end subroutine look_up

end module background
