!> Volume inside closed boundary curves by Green's formula, and the displacement of free sides that restores it.
!>
!> Plane: A = 1/2 of the integral of x dy - y dx [area]; axisymmetric: V = 1/2 of the integral of r**2 dy, per radian
!> [volume]. On a parabola the integrands are of degree 3 and 5 in xi, for which Gauss's four points are exact (degree 7); at
!> a depth the range is halved until the sum no longer changes. Loops around holes count negative.
module contour_volume
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t
  use boundary_sides, only: loop_t
  use kinds, only: eps, wp
  use offset_parabolas, only: point_at, tangent_at
  use plane_vectors, only: cross, right_of
  use quadrature, only: gauss_line
  use vectors, only: length_of
  implicit none
  private
  public :: volume_inside, volume_of_section, volume_of_loop, shift_sides

  !> Gauss's rule on the halves and on the whole agree to this share of the arc length times its lever arm.
  real(wp), parameter :: accuracy = 16*eps
  integer, parameter :: most_halvings = 12
  !> Volumes that differ by less than this share are equal.
  real(wp), parameter :: round_off = 64*eps
  !> Nodes at corners sharper than 30 degrees are fixed: 1 + cos(150 degrees).
  real(wp), parameter :: sharpest = 0.134_wp

contains

  !> Volume inside a boundary curve.
  pure function volume_inside(boundary, axisymmetric) result(volume)
    type(boundary_curve_t), intent(in) :: boundary
    logical, intent(in) :: axisymmetric
    real(wp) :: volume
    real(wp) :: origin(2)
    integer :: k

    origin = point_at(boundary%arcs(1), boundary%arcs(1)%range(1))
    volume = 0
    do k = 1, size(boundary%arcs)
      volume = volume + below(boundary%arcs(k), axisymmetric, origin)
    end do
  end function volume_inside

  !> Volume inside a boundary curve of a section with the thickness a1 + a2 x + a3 y (sections): a1 times the area and a2 and a3
  !> times its first moments, the integrals of x and y. A section of 0, 1, 0 is axisymmetric: per radian.
  pure function volume_of_section(boundary, section) result(volume)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: section(3)   !! a1 [length], a2 and a3 [-]
    real(wp) :: volume                   !! [length^3], of an axisymmetric section per radian
    type(boundary_curve_t) :: turned
    integer :: k

    volume = 0
    if (abs(section(1)) > 0) volume = section(1)*volume_inside(boundary, .false.)
    if (abs(section(2)) > 0) volume = volume + section(2)*volume_inside(boundary, .true.)
    if (.not. abs(section(3)) > 0) return
    ! by a quarter turn clockwise y becomes x
    turned = boundary
    do k = 1, size(turned%arcs)
      turned%arcs(k)%points(1, :) = boundary%arcs(k)%points(2, :)
      turned%arcs(k)%points(2, :) = -boundary%arcs(k)%points(1, :)
    end do
    volume = volume + section(3)*volume_inside(turned, .true.)
  end function volume_of_section

  !> Volume inside a loop of sides without contact.
  pure function volume_of_loop(loop, coordinates, axisymmetric) result(volume)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) [length]
    logical, intent(in) :: axisymmetric
    real(wp) :: volume
    type(arc_t) :: side
    integer :: k

    volume = 0
    do k = 1, size(loop%sides, 2)
      side%points = coordinates(:, loop%sides(:, k))
      volume = volume + below(side, axisymmetric, coordinates(:, loop%sides(1, 1)))
    end do
  end function volume_of_loop

  !> Contribution of an arc; areas are taken about `origin` to avoid cancellation.
  pure function below(arc, axisymmetric, origin) result(part)
    type(arc_t), intent(in) :: arc
    logical, intent(in) :: axisymmetric
    real(wp), intent(in) :: origin(2)
    real(wp) :: part
    real(wp), allocatable :: x(:), w(:)
    real(wp) :: unit, t(2)

    call gauss_line(4, x, w)
    t = tangent_at(arc, arc%range(1))
    unit = length_of(t)*(arc%range(2) - arc%range(1))
    if (axisymmetric) then
      unit = unit*maxval(arc%points(1, :)**2)
    else
      unit = unit*max(length_of(arc%points(:, 1) - origin), length_of(arc%points(:, 3) - origin))
    end if
    part = by_rule(arc%range(1), arc%range(2))
    if (any(abs(arc%depth) > 0)) part = measured(arc%range(1), arc%range(2), part, most_halvings)

  contains

    pure recursive function measured(a, b, whole, halvings) result(sum)
      real(wp), intent(in) :: a, b, whole
      integer, intent(in) :: halvings
      real(wp) :: sum
      real(wp) :: middle, left, right

      middle = 0.5_wp*(a + b)
      left = by_rule(a, middle)
      right = by_rule(middle, b)
      sum = left + right
      if (abs(sum - whole) <= accuracy*unit .or. halvings == 0) return
      sum = measured(a, middle, left, halvings - 1) + measured(middle, b, right, halvings - 1)
    end function measured

    pure function by_rule(a, b) result(sum)
      real(wp), intent(in) :: a, b
      real(wp) :: sum
      real(wp) :: xi, p(2), t(2)
      integer :: i

      sum = 0
      do i = 1, size(x)
        xi = 0.5_wp*(a + b) + 0.5_wp*(b - a)*x(i)
        p = point_at(arc, xi)
        t = tangent_at(arc, xi)
        if (axisymmetric) then
          sum = sum + 0.25_wp*(b - a)*w(i)*p(1)**2*t(2)
        else
          p = p - origin
          sum = sum + 0.25_wp*(b - a)*w(i)*cross(p, t)
        end if
      end do
    end function by_rule

  end function below

  !> Move free sides along their normals by one distance so that the loop gains a volume. A node moves if all sides of the loop that
  !> it belongs to may; at a corner it moves so that both sides do. The distance is found by the secant method: the volume is a
  !> polynomial in it, of degree 2 in the plane and 3 around an axis.
  pure subroutine shift_sides(loop, may_move, held, axisymmetric, gain, coordinates, shift, restored)
    type(loop_t), intent(in) :: loop
    logical, intent(in) :: may_move(:)   !! (nside) of the loop
    logical, intent(in) :: held(:)       !! (nnode) fixed whatever the sides of the node do
    logical, intent(in) :: axisymmetric
    real(wp), intent(in) :: gain                   !! required, as `volume_of_loop`
    real(wp), intent(inout) :: coordinates(:, :)   !! (2, nnode) [length]
    real(wp), intent(out) :: shift                 !! outwards [length]
    logical, intent(out) :: restored               !! the loop gained the required volume; else nothing has moved
    real(wp) :: before(2, size(coordinates, 2)), displacements(2, size(coordinates, 2))
    real(wp) :: start, excess, last_excess, last_shift, step, surface
    integer :: iteration
    integer, parameter :: most_iterations = 30

    shift = 0
    before = coordinates
    call normals_of_nodes(loop, coordinates, may_move, held, displacements, surface)
    start = volume_of_loop(loop, coordinates, axisymmetric)
    last_shift = 0
    last_excess = -gain
    restored = abs(gain) <= round_off*abs(start)
    if (restored .or. .not. surface > 0) return
    ! the first guess is exact for a plane surface; around an axis it measures the volume of a thin layer
    step = merge(sign(eps**0.5_wp*surface, gain), gain/surface, axisymmetric)
    do iteration = 1, most_iterations
      shift = last_shift + step
      coordinates = before + shift*displacements
      ! nothing crosses the axis
      if (axisymmetric) coordinates(1, :) = max(coordinates(1, :), min(before(1, :), 0.0_wp))
      excess = volume_of_loop(loop, coordinates, axisymmetric) - start - gain
      restored = abs(excess) <= round_off*abs(start)
      if (restored .or. .not. abs(excess - last_excess) > 0) exit
      step = -excess*(shift - last_shift)/(excess - last_excess)
      last_shift = shift
      last_excess = excess
    end do
    if (restored) return
    coordinates = before
    shift = 0
  end subroutine shift_sides

  !> Displacement of nodes for a unit displacement of all free sides, and the length of these sides [length].
  pure subroutine normals_of_nodes(loop, coordinates, may_move, held, displacements, surface)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: coordinates(:, :)
    logical, intent(in) :: may_move(:), held(:)
    real(wp), intent(out) :: displacements(:, :), surface
    type(arc_t) :: side, next
    real(wp) :: one(2), other(2)
    integer :: k, after

    displacements = 0
    surface = 0
    do k = 1, size(loop%sides, 2)
      if (.not. may_move(k)) cycle
      side%points = coordinates(:, loop%sides(:, k))
      surface = surface + length_of(side%points(:, 3) - side%points(:, 1))
      displacements(:, loop%sides(2, k)) = outward(side, 0.0_wp)
      after = mod(k, size(loop%sides, 2)) + 1
      if (.not. may_move(after)) cycle
      next%points = coordinates(:, loop%sides(:, after))
      one = outward(side, 1.0_wp)
      other = outward(next, -1.0_wp)
      ! at a corner both sides move by one: the sum of the normals over one plus the cosine between them
      if (1 + dot_product(one, other) > sharpest) displacements(:, loop%sides(3, k)) = (one + other)/(1 + dot_product(one, other))
    end do
    do k = 1, size(held)
      if (held(k)) displacements(:, k) = 0
    end do
  end subroutine normals_of_nodes

  !> Outward unit normal, to the right of the arc.
  pure function outward(side, xi) result(n)
    type(arc_t), intent(in) :: side
    real(wp), intent(in) :: xi
    real(wp) :: n(2)
    real(wp) :: t(2)

    t = tangent_at(side, xi)
    n = right_of(t)
  end function outward

end module contour_volume
