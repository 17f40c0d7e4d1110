!> Sizes and directions over a body, as values at the points of a coarse triangulation, linear in between.
!>
!> The triangulation of the contours is refined at the centres of circles larger than the requested size there (L. P. Chew,
!> Guaranteed-quality triangular meshes, Cornell University TR 89-983, 1989). Sides of contours that are shorter than requested,
!> for a side has a whole number of them, limit the size around by the gradation.
module background
  use cross_directions, only: align_directions
  use exact_signs, only: on_grid
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use plane_vectors, only: cross
  use size_field, only: size_at, size_field_t
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
    real(wp), allocatable :: h(:)         !! (npoint) [length]
    !> Cosine and sine of four times the angle of the directions (2, npoint).
    real(wp), allocatable :: fourfold(:, :)
  end type background_t

contains

  !> Refine the triangulation of the contours, and find sizes and directions.
  pure subroutine set_up_background(contours, sides, sizes, material, factor, field)
    type(triangulation_t), intent(in) :: contours
    integer, intent(in) :: sides(:, :)          !! ends of kept sides, points of the triangulation (2, nside)
    type(size_field_t), intent(in) :: sizes
    integer, intent(in) :: material             !! as `size_at` takes it
    real(wp), intent(in) :: factor              !! ratio of the sizes to those of the field
    type(background_t), intent(out) :: field
    real(wp), allocatable :: h(:)
    integer :: k, n

    field%mesh = contours
    n = contours%npoint
    allocate (h(2*n))
    do k = 5, n
      h(k) = factor*size_at(sizes, material, contours%x(:, k))
    end do
    call refine(field%mesh, sizes, material, factor, h)
    allocate (field%h, source=h(:field%mesh%npoint))
    call respect_sides(field%mesh, sides, field%h)
    call grade_sizes(field%mesh, slope_of(sizes%limits%gradation), field%h)
    call align_directions(field%mesh, sides, field%fourfold)
  end subroutine set_up_background

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
        here = factor*size_at(sizes, material, centre)
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

  !> At kept sides the size is no larger than the mean of the sides there.
  pure subroutine respect_sides(mesh, sides, h)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: sides(:, :)
    real(wp), intent(inout) :: h(:)
    real(wp) :: total(size(h)), length
    integer :: number(size(h)), s

    total = 0
    number = 0
    do s = 1, size(sides, 2)
      length = length_of(mesh%x(:, sides(2, s)) - mesh%x(:, sides(1, s)))
      total(sides(:, s)) = total(sides(:, s)) + length
      number(sides(:, s)) = number(sides(:, s)) + 1
    end do
    where (number > 0) h = min(h, total/max(number, 1))
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
  pure subroutine look_up(field, x, near, h, direction)
    type(background_t), intent(in) :: field
    real(wp), intent(in) :: x(2)             !! [length]
    integer, intent(inout) :: near
    real(wp), intent(out) :: h               !! [length]
    real(wp), intent(out) :: direction(2)    !! unit vector [-]
    real(wp) :: share(3), fourfold(2), angle
    integer :: t, k

    h = 0
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
    end associate
    angle = 0.25_wp*atan2(fourfold(2), fourfold(1))
    direction = [cos(angle), sin(angle)]
  end subroutine look_up

end module background
