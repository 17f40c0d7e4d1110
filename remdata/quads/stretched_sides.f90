!> Sides of triangles between points whose elements are wanted longer than wide.
!>
!> Delaunay's triangulation joins points that are near, across the rows of long elements where these are not abreast. Sides are
!> exchanged until the circle test holds for distances measured by the map that makes squares of these elements, the mean of
!> the four points of a side (M. J. Castro-Diaz et al., Int. J. Num. Meth. Fluids 25 (1997) 475-491). That map differs
!> from side to side, so that an end is not proven: sweeps are bounded, and what is left costs shape, not soundness, as the signs
!> that decide whether a side may be exchanged are exact.
module stretched_sides
  use background, only: background_t, look_up
  use directed_sizes, only: to_squares
  use exact_signs, only: orientation
  use kinds, only: wp
  use plane_vectors, only: cross
  use triangulation, only: after, before, exchange_side, place_of, triangulation_t
  implicit none
  private
  public :: stretch_of_points, exchange_stretched

  !> Sweeps over all sides at most.
  integer, parameter :: sweeps = 20
  !> Sine of the sum of two opposite angles above which points count as on one circle: round-off of distances that are equal.
  real(wp), parameter :: on_circle = -1.0e-9_wp

contains

  !> Stretch at the points of a triangulation.
  pure subroutine stretch_of_points(field, mesh, stretch)
    type(background_t), intent(in) :: field
    type(triangulation_t), intent(in) :: mesh
    real(wp), allocatable, intent(out) :: stretch(:, :)   !! (2, npoint) [-]
    real(wp) :: h, direction(2)
    integer :: k, near

    allocate (stretch(2, mesh%npoint), source=0.0_wp)
    if (.not. any(abs(field%stretch) > 0)) return
    near = 0
    do k = 5, mesh%npoint
      call look_up(field, mesh%x(:, k), near, h, direction, stretch(:, k))
    end do
  end subroutine stretch_of_points

  pure subroutine exchange_stretched(stretch, mesh)
    real(wp), intent(in) :: stretch(:, :)   !! (2, npoint) [-]
    type(triangulation_t), intent(inout) :: mesh
    integer :: sweep, t, k
    logical :: changed

    if (.not. any(abs(stretch) > 0)) return
    do sweep = 1, sweeps
      changed = .false.
      do t = 1, mesh%ntriangle
        if (.not. mesh%inside(t)) cycle
        do k = 1, 3
          if (mesh%kept(k, t) .or. mesh%across(k, t) < t) cycle
          if (.not. mesh%inside(mesh%across(k, t))) cycle
          if (.not. is_shorter(stretch, mesh, t, k)) cycle
          call exchange_side(mesh, t, k)
          changed = .true.
        end do
      end do
      if (.not. changed) exit
    end do
  end subroutine exchange_stretched

  !> Is the other diagonal possible, and the one that the circle test asks for?
  pure function is_shorter(stretch, mesh, t, k) result(yes)
    real(wp), intent(in) :: stretch(:, :)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: t, k
    logical :: yes
    integer :: a, b, c, d
    real(wp) :: x(2, 4)

    a = mesh%node(k, t)
    b = mesh%node(after(k), t)
    c = mesh%node(before(k), t)
    d = mesh%node(place_of(mesh, t, mesh%across(k, t)), mesh%across(k, t))
    yes = orientation(mesh%p(:, a), mesh%p(:, b), mesh%p(:, d)) > 0 .and. orientation(mesh%p(:, a), mesh%p(:, d), mesh%p(:, c)) > 0
    if (.not. yes) return
    x = matmul(to_squares(0.25_wp*sum(stretch(:, [a, b, c, d]), 2)), mesh%x(:, [a, b, c, d]))
    yes = sine_of_sum(x(:, 2) - x(:, 1), x(:, 3) - x(:, 1), x(:, 3) - x(:, 4), x(:, 2) - x(:, 4)) < on_circle
  end function is_shorter

  !> Sine of the angle from u to v and that from w to z together.
  pure function sine_of_sum(u, v, w, z) result(sine)
    real(wp), intent(in) :: u(2), v(2), w(2), z(2)
    real(wp) :: sine

    sine = (cross(u, v)*dot_product(w, z) + dot_product(u, v)*cross(w, z))/(norm2(u)*norm2(v)*norm2(w)*norm2(z))
  end function sine_of_sum

end module stretched_sides
