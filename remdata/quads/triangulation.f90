!> A Delaunay triangulation that grows point by point, with sides that are kept.
!>
!> A point splits the triangle it lies in; sides that fail the circle test are then exchanged until none does (C. L. Lawson,
!> Software for C1 surface interpolation, in: Mathematical Software III, Academic Press, 1977, 161-194). Signs are exact
!> (`exact_signs`), an exchange needs a point strictly inside the circle: this ends for any points. Side k of a triangle is
!> opposite to its node k.
module triangulation
  use exact_signs, only: grid_frame_t, grid, grid_width, in_circle, on_grid, orientation, set_up_frame
  use kinds, only: wp
  implicit none
  private
  public :: triangulation_t, after, before, start_triangulation, add_point, find_triangle, exchange_side, place_of

  !> Positions in a triangle after and before each.
  integer, parameter :: after(3) = [2, 3, 1], before(3) = [3, 1, 2]

  type :: triangulation_t
    type(grid_frame_t) :: frame
    integer :: npoint = 0, ntriangle = 0
    real(wp), allocatable :: x(:, :)           !! (2, npoint) and space for more [length]
    integer(grid), allocatable :: p(:, :)      !! (2, npoint) the same on the grid
    integer, allocatable :: node(:, :)         !! (3, ntriangle) counter-clockwise
    integer, allocatable :: across(:, :)       !! (3, ntriangle) triangle beyond each side, 0 for none
    logical, allocatable :: kept(:, :)         !! (3, ntriangle) the side is not exchanged
    logical, allocatable :: inside(:)          !! (ntriangle) in the body
    integer, allocatable :: triangle_at(:)     !! (npoint) one of each point's triangles
  end type triangulation_t

contains

  !> Two triangles in a square around all points to come; its corners are the first four points.
  pure subroutine start_triangulation(points, mesh)
    real(wp), intent(in) :: points(:, :)   !! that the square shall contain (2, n) [length]
    type(triangulation_t), intent(out) :: mesh
    integer(grid), parameter :: far = grid_width

    call set_up_frame(points, mesh%frame)
    call reserve(mesh, size(points, 2) + 4)
    mesh%npoint = 4
    mesh%p(:, :4) = reshape([0_grid, 0_grid, far, 0_grid, far, far, 0_grid, far], [2, 4])
    mesh%x(:, :4) = spread(mesh%frame%low, 2, 4) + mesh%frame%step*real(mesh%p(:, :4), wp)
    mesh%ntriangle = 2
    mesh%node(:, 1) = [1, 2, 3]
    mesh%node(:, 2) = [1, 3, 4]
    mesh%across(:, 1) = [0, 2, 0]
    mesh%across(:, 2) = [0, 0, 1]
    mesh%kept(:, :2) = .false.
    mesh%inside(:2) = .false.
    mesh%triangle_at(:4) = [1, 1, 1, 2]
  end subroutine start_triangulation

  !> Space for so many points.
  pure subroutine reserve(mesh, npoint)
    type(triangulation_t), intent(inout) :: mesh
    integer, intent(in) :: npoint
    type(triangulation_t) :: larger
    integer :: n, m

    if (allocated(mesh%x)) then
      if (size(mesh%x, 2) >= npoint) return
    end if
    n = 2*npoint
    allocate (larger%x(2, n), larger%p(2, n), larger%triangle_at(n), larger%node(3, 2*n), larger%across(3, 2*n), &
              larger%kept(3, 2*n), larger%inside(2*n))
    if (allocated(mesh%x)) then
      n = mesh%npoint
      m = mesh%ntriangle
      larger%x(:, :n) = mesh%x(:, :n)
      larger%p(:, :n) = mesh%p(:, :n)
      larger%triangle_at(:n) = mesh%triangle_at(:n)
      larger%node(:, :m) = mesh%node(:, :m)
      larger%across(:, :m) = mesh%across(:, :m)
      larger%kept(:, :m) = mesh%kept(:, :m)
      larger%inside(:m) = mesh%inside(:m)
    end if
    call move_alloc(larger%x, mesh%x)
    call move_alloc(larger%p, mesh%p)
    call move_alloc(larger%triangle_at, mesh%triangle_at)
    call move_alloc(larger%node, mesh%node)
    call move_alloc(larger%across, mesh%across)
    call move_alloc(larger%kept, mesh%kept)
    call move_alloc(larger%inside, mesh%inside)
  end subroutine reserve

  !> Add a point; its number, or 0 where it coincides with another one or lies on a side that is kept.
  pure subroutine add_point(mesh, x, near, point)
    type(triangulation_t), intent(inout) :: mesh
    real(wp), intent(in) :: x(2)    !! [length]
    integer, intent(in) :: near     !! a triangle where the search begins
    integer, intent(out) :: point
    integer(grid) :: p(2)
    integer :: t, k, u, v, a, b, c, on, j

    point = 0
    p = on_grid(mesh%frame, x)
    call find_triangle(mesh, p, near, t)
    on = 0
    do k = 1, 3
      if (all(mesh%p(:, mesh%node(k, t)) == p)) return
      if (orientation(mesh%p(:, mesh%node(after(k), t)), mesh%p(:, mesh%node(before(k), t)), p) == 0) on = k
    end do
    if (on > 0) then
      if (mesh%kept(on, t)) return
    end if
    call reserve(mesh, mesh%npoint + 1)
    mesh%npoint = mesh%npoint + 1
    point = mesh%npoint
    mesh%x(:, point) = x
    mesh%p(:, point) = p
    ! triangles t = (p b c), u = (p c a), v = (p a b)
    u = mesh%ntriangle + 1
    v = u + 1
    mesh%ntriangle = v
    a = mesh%node(1, t)
    b = mesh%node(2, t)
    c = mesh%node(3, t)
    mesh%inside([u, v]) = mesh%inside(t)
    mesh%node(:, u) = [point, c, a]
    mesh%node(:, v) = [point, a, b]
    mesh%across(:, u) = [mesh%across(2, t), v, t]
    mesh%across(:, v) = [mesh%across(3, t), t, u]
    mesh%kept(:, u) = [mesh%kept(2, t), .false., .false.]
    mesh%kept(:, v) = [mesh%kept(3, t), .false., .false.]
    call replace_neighbour(mesh, mesh%across(1, u), t, u)
    call replace_neighbour(mesh, mesh%across(1, v), t, v)
    mesh%node(1, t) = point
    mesh%across(2:3, t) = [u, v]
    mesh%kept(2:3, t) = .false.
    mesh%triangle_at([point, b, c]) = t
    mesh%triangle_at(a) = u
    if (on > 0) then
      ! the triangle on the side that the point lies on has no area
      j = merge(t, merge(u, v, on == 2), on == 1)
      k = mesh%across(1, j)
      call exchange_side(mesh, j, 1)
      call restore(mesh, point, k)
    end if
    call restore(mesh, point, v)
    call restore(mesh, point, u)
    call restore(mesh, point, t)
  end subroutine add_point

  !> Exchange sides opposite to a point until all around it satisfy the circle test, beginning in one of its triangles.
  pure subroutine restore(mesh, point, first)
    type(triangulation_t), intent(inout) :: mesh
    integer, intent(in) :: point, first
    integer, allocatable :: stack(:)
    integer :: n, t, k, u

    allocate (stack(16))
    n = 1
    stack(1) = first
    do while (n > 0)
      t = stack(n)
      n = n - 1
      k = findloc(mesh%node(:, t), point, 1)
      if (k == 0) cycle
      u = mesh%across(k, t)
      if (u == 0 .or. mesh%kept(k, t)) cycle
      if (in_circle(mesh%p(:, mesh%node(1, t)), mesh%p(:, mesh%node(2, t)), mesh%p(:, mesh%node(3, t)), &
                    mesh%p(:, mesh%node(place_of(mesh, t, u), u))) <= 0) cycle
      call exchange_side(mesh, t, k)
      if (n + 2 > size(stack)) stack = [stack, stack]
      stack(n + 1:n + 2) = [u, t]
      n = n + 2
    end do
  end subroutine restore

  !> Replace side k of triangle t by the other diagonal of its two triangles: t = (a b d), u = (a d c).
  pure subroutine exchange_side(mesh, t, k)
    type(triangulation_t), intent(inout) :: mesh
    integer, intent(in) :: t, k
    integer :: u, j, a, b, c, d, beyond(4)
    logical :: kept(4)

    u = mesh%across(k, t)
    j = place_of(mesh, t, u)
    a = mesh%node(k, t)
    b = mesh%node(after(k), t)
    c = mesh%node(before(k), t)
    d = mesh%node(j, u)
    ! beyond the sides a b, b d, d c, c a
    beyond = [mesh%across(before(k), t), mesh%across(after(j), u), mesh%across(before(j), u), mesh%across(after(k), t)]
    kept = [mesh%kept(before(k), t), mesh%kept(after(j), u), mesh%kept(before(j), u), mesh%kept(after(k), t)]
    mesh%node(:, t) = [a, b, d]
    mesh%node(:, u) = [a, d, c]
    mesh%across(:, t) = [beyond(2), u, beyond(1)]
    mesh%across(:, u) = [beyond(3), beyond(4), t]
    mesh%kept(:, t) = [kept(2), .false., kept(1)]
    mesh%kept(:, u) = [kept(3), kept(4), .false.]
    call replace_neighbour(mesh, beyond(2), u, t)
    call replace_neighbour(mesh, beyond(4), t, u)
    mesh%triangle_at([a, b, d]) = t
    mesh%triangle_at(c) = u
  end subroutine exchange_side

  pure subroutine replace_neighbour(mesh, t, old, new)
    type(triangulation_t), intent(inout) :: mesh
    integer, intent(in) :: t, old, new

    if (t > 0) then
      where (mesh%across(:, t) == old) mesh%across(:, t) = new
    end if
  end subroutine replace_neighbour

  !> Which side of triangle u is shared with t.
  pure function place_of(mesh, t, u) result(j)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: t, u
    integer :: j

    j = merge(1, merge(2, 3, mesh%across(2, u) == t), mesh%across(1, u) == t)
  end function place_of

  !> The triangle that contains a point of the grid: by walking towards it; should kept sides lead the walk in a circle, by
  !> examination of all.
  pure subroutine find_triangle(mesh, p, near, t)
    type(triangulation_t), intent(in) :: mesh
    integer(grid), intent(in) :: p(2)
    integer, intent(in) :: near    !! a triangle where the walk begins
    integer, intent(out) :: t
    integer :: step, k

    t = near
    do step = 1, mesh%ntriangle
      k = side_towards(mesh, t, p)
      if (k == 0) return
      t = mesh%across(k, t)
    end do
    do t = 1, mesh%ntriangle
      if (side_towards(mesh, t, p) == 0) return
    end do
  end subroutine find_triangle

  !> A side of a triangle that has a point on its other hand; 0 for none.
  pure function side_towards(mesh, t, p) result(k)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: t
    integer(grid), intent(in) :: p(2)
    integer :: k

    do k = 1, 3
      if (orientation(mesh%p(:, mesh%node(after(k), t)), mesh%p(:, mesh%node(before(k), t)), p) < 0) return
    end do
    k = 0
  end function side_towards

end module triangulation
