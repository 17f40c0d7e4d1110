!> Positions of points between quadrilaterals, by optimisation of their shape.
!>
!> A corner with the sides u and v has f = (u.u + v.v)/(2 u x v), the inverse of the mean ratio: 1 for a right angle between equal
!> sides, more for any other, infinite for a flat one (P. M. Knupp, SIAM J. Sci. Comput. 23 (2001) 193-218). The sum of f^4 over
!> the corners that a point changes is minimised by Newton's method, point by point. Where corners are flat or inverted the area
!> is replaced by a positive one that grows with it (J. M. Escobar et al., Comput. Methods Appl. Mech. Engng 192 (2003)
!> 2775-2787). Where quadrilaterals are wanted longer than wide, sides are measured by the map that makes squares of these.
module quad_smoothing
  use directed_sizes, only: to_squares
  use kinds, only: wp
  use plane_vectors, only: cross
  use quad_mesh, only: quad_mesh_t
  use vectors, only: length_of
  implicit none
  private
  public :: smooth_point, smooth_all, worst_sine

  !> Corners with less than this share of the square of the mean side are treated as flat.
  real(wp), parameter :: flat = 0.05_wp
  !> Halvings of a step, and the longest step over the mean side.
  integer, parameter :: halvings = 6
  real(wp), parameter :: longest = 0.5_wp
  !> A point has moved when it did so by more than this share of its sides.
  real(wp), parameter :: rest = 1.0e-3_wp

  !> Of the corners around a point, lengths over the mean side.
  type :: sums_t
    real(wp) :: energy = 0.0_wp, slope(2) = 0.0_wp
    real(wp) :: matrix(3) = 0.0_wp         !! second derivatives xx, xy, yy
    real(wp) :: least = huge(1.0_wp)       !! smallest area between two sides
  end type sums_t

contains

  !> Sweeps over all points that may move, until none moves any more.
  pure subroutine smooth_all(mesh, sweeps)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: sweeps   !! at most
    logical :: active(mesh%npoint), next(mesh%npoint)
    integer :: sweep, k, i
    real(wp) :: moved

    active = .true.
    do sweep = 1, sweeps
      next = .false.
      do k = 1, mesh%npoint
        if (.not. active(k) .or. mesh%fixed(k) .or. mesh%count(k) == 0) cycle
        call smooth_point(mesh, k, moved)
        if (.not. moved > rest) cycle
        do i = 1, mesh%count(k)
          next(mesh%corner(:, mesh%around(i, k))) = .true.
        end do
      end do
      if (.not. any(next)) exit
      active = next
    end do
  end subroutine smooth_all

  !> Smallest sine at the corners of the quadrilaterals at a point.
  pure function worst_sine(mesh, quads) result(worst)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: quads(:)   !! (n)
    real(wp) :: worst
    real(wp) :: x(2, 4), u(2), v(2)
    integer :: i, k

    worst = 1
    do i = 1, size(quads)
      x = mesh%x(:, mesh%corner(:, quads(i)))
      do k = 1, 4
        u = x(:, mod(k, 4) + 1) - x(:, k)
        v = x(:, modulo(k - 2, 4) + 1) - x(:, k)
        worst = min(worst, cross(u, v)/max(length_of(u)*length_of(v), tiny(1.0_wp)))
      end do
    end do
  end function worst_sine

  !> One step of Newton's method for one point.
  pure subroutine smooth_point(mesh, point, moved)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: point
    real(wp), intent(out) :: moved   !! over the mean side
    real(wp) :: ring(2, 3, size(mesh%around, 1)), matrix(3), step(2), start(2), x(2), det, side, delta, energy, square(2, 2)
    type(sums_t) :: sums
    integer :: i, n, k

    n = mesh%count(point)
    square = to_squares(mesh%stretch(:, point))
    side = 0
    do i = 1, n
      associate (corner => mesh%corner(:, mesh%around(i, point)))
        k = findloc(corner, point, 1)
        ring(:, 1, i) = mesh%x(:, corner(mod(k, 4) + 1))
        ring(:, 2, i) = mesh%x(:, corner(mod(k + 1, 4) + 1))
        ring(:, 3, i) = mesh%x(:, corner(mod(k + 2, 4) + 1))
      end associate
      side = side + sum(matmul(square, ring(:, [2, 3], i) - ring(:, [1, 2], i))**2)
    end do
    moved = 0
    side = sqrt(side/(2*n))
    if (.not. side > 0) return
    start = mesh%x(:, point)
    ! lengths over the mean side
    do i = 1, n
      do k = 1, 3
        ring(:, k, i) = matmul(square, ring(:, k, i) - start)/side
      end do
    end do
    x = 0
    sums = evaluate(ring(:, :, :n), x, 0.0_wp)
    delta = merge(flat, 0.0_wp, sums%least < flat)
    if (delta > 0) sums = evaluate(ring(:, :, :n), x, delta)
    matrix = sums%matrix
    det = matrix(1)*matrix(3) - matrix(2)**2
    if (.not. (matrix(1) > 0 .and. det > 0)) then
      ! along the slope
      det = max(sum(abs(matrix)), tiny(1.0_wp))
      matrix = [det, 0.0_wp, det]
      det = det**2
    end if
    step = -[matrix(3)*sums%slope(1) - matrix(2)*sums%slope(2), matrix(1)*sums%slope(2) - matrix(2)*sums%slope(1)]/det
    if (length_of(step) > longest) step = longest*step/length_of(step)
    do k = 1, halvings
      energy = energy_at(ring(:, :, :n), x + step, delta)
      if (energy < sums%energy) then
        mesh%x(:, point) = start + side*matmul(to_squares(-mesh%stretch(:, point)), step)
        moved = length_of(step)
        return
      end if
      step = 0.5_wp*step
    end do
  end subroutine smooth_point

  !> Sum of f^4 over the corners around x.
  pure function evaluate(ring, x, delta) result(sums)
    real(wp), intent(in) :: ring(:, :, :)   !! the three other corners of each quadrilateral (2, 3, n)
    real(wp), intent(in) :: x(2), delta
    type(sums_t) :: sums
    real(wp) :: u(2), v(2), w(2)
    integer :: i

    do i = 1, size(ring, 3)
      associate (a => ring(:, 1, i), b => ring(:, 2, i), c => ring(:, 3, i))
        ! at the point, between a and c; its area u x v changes by the sides' difference
        u = a - x
        v = c - x
        call add_corner(sum(u*u) + sum(v*v), -2*(u + v), 4.0_wp, cross(u, v), [u(2) - v(2), v(1) - u(1)], delta, sums)
        ! at a, between b and the point
        u = b - a
        w = x - a
        call add_corner(sum(u*u) + sum(w*w), 2*w, 2.0_wp, cross(u, w), [-u(2), u(1)], delta, sums)
        ! at c, between the point and b
        u = b - c
        w = x - c
        call add_corner(sum(u*u) + sum(w*w), 2*w, 2.0_wp, cross(w, u), [u(2), -u(1)], delta, sums)
      end associate
    end do
  end function evaluate

  !> The energy of `evaluate` alone, a fifth of its work: huge where an area is negative and is taken as it is.
  pure function energy_at(ring, x, delta) result(energy)
    real(wp), intent(in) :: ring(:, :, :)   !! (2, 3, n)
    real(wp), intent(in) :: x(2), delta
    real(wp) :: energy
    real(wp) :: u(2), v(2), w(2), z(2), n(3), d(3)
    integer :: i, k

    energy = 0
    do i = 1, size(ring, 3)
      associate (a => ring(:, 1, i), b => ring(:, 2, i), c => ring(:, 3, i))
        u = a - x
        v = c - x
        w = b - a
        z = b - c
        n = [sum(u*u) + sum(v*v), sum(w*w) + sum(u*u), sum(z*z) + sum(v*v)]
        d = [cross(u, v), cross(u, w), cross(z, v)]
      end associate
      do k = 1, 3
        if (delta > 0) then
          d(k) = 0.5_wp*(d(k) + sqrt(d(k)*d(k) + 4*delta*delta))
        else if (.not. d(k) > 0) then
          energy = huge(energy)
          return
        end if
        energy = energy + (0.5_wp*n(k)/d(k))**4
      end do
    end do
  end function energy_at

  !> f = n/(2 d): n has the slope dn and the second derivative ddn in both directions, d the constant slope dd.
  pure subroutine add_corner(n, dn, ddn, d, dd, delta, sums)
    real(wp), intent(in) :: n, dn(2), ddn, d, dd(2), delta
    type(sums_t), intent(inout) :: sums
    real(wp) :: root, h, h1, h2, f, df(2), ddf(3), dh(2)

    sums%least = min(sums%least, d)
    if (delta > 0) then
      root = sqrt(d*d + 4*delta*delta)
      h = 0.5_wp*(d + root)
      h1 = 0.5_wp*(1 + d/root)
      h2 = 2*delta*delta/root**3
    else if (d > 0) then
      h = d
      h1 = 1
      h2 = 0
    else
      return
    end if
    f = 0.5_wp*n/h
    dh = h1*dd
    ! from 2 f h = n
    df = (0.5_wp*dn - f*dh)/h
    ddf(1) = (0.5_wp*ddn - 2*df(1)*dh(1) - f*h2*dd(1)**2)/h
    ddf(2) = (-df(1)*dh(2) - df(2)*dh(1) - f*h2*dd(1)*dd(2))/h
    ddf(3) = (0.5_wp*ddn - 2*df(2)*dh(2) - f*h2*dd(2)**2)/h
    sums%energy = sums%energy + f**4
    sums%slope = sums%slope + 4*f**3*df
    sums%matrix = sums%matrix + 4*f**2*[3*df(1)**2 + f*ddf(1), 3*df(1)*df(2) + f*ddf(2), 3*df(2)**2 + f*ddf(3)]
  end subroutine add_corner

end module quad_smoothing
