!> Contours, zones and measures of quality for the tests of meshes of zones.
module zone_cases
  use boundary_curves, only: boundary_curve_t, close_boundary, closest_position, kind_corner, kind_end, point_on, position_t
  use derived_zones, only: one_zone
  use errors, only: error_t
  use kinds, only: pi, wp
  use quadrature, only: square_rule
  use shape_functions, only: quad8, quad8_corner, quad8_side
  use size_field, only: need_t, set_up_sizes, size_field_t, size_limits_t
  use vectors, only: length_of
  use zone_mesh, only: mesh_settings_t, mesh_zones, new_mesh_t
  use zones, only: zone_point_t, zone_t
  implicit none
  private
  public :: boundary_of_points, polygon, circle, blob, barrel, point_at_contour, point_inside, zone_of, uniform_field
  public :: rectangle_mesh, l_shape, ring
  public :: quality_t, quality_of, off_contour, area_of, shared_exactly

  type :: quality_t
    !> Smallest over Gauss points (3 x 3), corners and middles, over the largest of the element.
    real(wp) :: least_jacobian = huge(1.0_wp)
    !> Smallest sine between the sides of an element at a corner, with its sign.
    real(wp) :: scaled_jacobian = huge(1.0_wp)
    !> Farthest a middle node is from the half of its chord, as a share of the chord (1/6 leaves the middle third).
    real(wp) :: off_middle = 0.0_wp
  end type quality_t

contains

  !> A boundary through ends and middles in turn, the part on its left.
  pure function boundary_of_points(x, corner_turn) result(boundary)
    real(wp), intent(in) :: x(:, :)   !! (2, 2n)
    real(wp), intent(in) :: corner_turn
    type(boundary_curve_t) :: boundary
    integer :: k, n

    n = size(x, 2)/2
    allocate (boundary%arcs(n), boundary%kinds(n))
    do k = 1, n
      boundary%arcs(k)%points = x(:, [2*k - 1, 2*k, mod(2*k, 2*n) + 1])
      boundary%arcs(k)%middle = k
    end do
    boundary%kinds = kind_end
    call close_boundary(corner_turn, boundary)
  end function boundary_of_points

  !> Straight sides between corners, each cut into `cuts`.
  pure function polygon(corners, cuts) result(boundary)
    real(wp), intent(in) :: corners(:, :)
    integer, intent(in) :: cuts
    type(boundary_curve_t) :: boundary
    real(wp) :: x(2, 2*cuts*size(corners, 2))
    integer :: c, i

    do c = 1, size(corners, 2)
      do i = 1, 2*cuts
        x(:, 2*cuts*(c - 1) + i) = corners(:, c) + (corners(:, mod(c, size(corners, 2)) + 1) - corners(:, c)) &
                                   *(i - 1)/(2*cuts)
      end do
    end do
    boundary = boundary_of_points(x, 0.5_wp)
  end function polygon

  !> A full circle of `n` parabolas; a hole with a negative radius.
  pure function circle(centre, radius, n) result(boundary)
    real(wp), intent(in) :: centre(2), radius
    integer, intent(in) :: n
    type(boundary_curve_t) :: boundary
    real(wp) :: x(2, 2*n), angle
    integer :: i

    do i = 1, 2*n
      angle = sign(pi*(i - 1)/n, radius)
      x(:, i) = centre + abs(radius)*[cos(angle), sin(angle)]
    end do
    boundary = boundary_of_points(x, 0.9_wp)
  end function circle

  !> A wavy circle of n parabolas about a centre, by six shares from 0 to 1; a hole with a negative radius.
  pure function blob(centre, radius, share, n) result(boundary)
    real(wp), intent(in) :: centre(2), radius, share(6)
    integer, intent(in) :: n
    type(boundary_curve_t) :: boundary
    real(wp) :: x(2, 2*n), angle
    integer :: i

    do i = 1, 2*n
      angle = sign(pi*(i - 1)/n, radius)
      x(:, i) = centre + abs(radius)*[cos(angle), sin(angle)] &
                *(1 + 0.3_wp*(share(1) - 0.5_wp)*sin(2*angle + 6*share(2)) + 0.25_wp*(share(3) - 0.5_wp)*sin(3*angle + 6*share(4)) &
                  + 0.1_wp*(share(5) - 0.5_wp)*sin(5*angle + 6*share(6)))
    end do
    boundary = boundary_of_points(x, 0.9_wp)
  end function blob

  !> A square of side 1 whose right side bulges to 1 + bulge sin(pi s), at the height s - fold sin(2 pi s); the first corner
  !> at the origin, n parabolas a side. With a fold the bulge hangs over the corners.
  pure function barrel(bulge, fold, n) result(boundary)
    real(wp), intent(in) :: bulge, fold
    integer, intent(in) :: n
    type(boundary_curve_t) :: boundary
    real(wp) :: x(2, 8*n), s
    integer :: i

    do i = 1, 2*n
      s = (i - 1)/real(2*n, wp)
      x(:, i) = [s, 0.0_wp]
      x(:, 2*n + i) = [1 + bulge*sin(pi*s), s - fold*sin(2*pi*s)]
      x(:, 4*n + i) = [1 - s, 1.0_wp]
      x(:, 6*n + i) = [0.0_wp, 1 - s]
    end do
    boundary = boundary_of_points(x, 0.5_wp)
    boundary%kinds([1, n + 1, 2*n + 1, 3*n + 1]) = kind_corner
  end function barrel

  !> The zone point of a boundary closest to a target.
  pure function point_at_contour(number, boundary, target) result(point)
    integer, intent(in) :: number
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: target(2)
    type(zone_point_t) :: point

    point%boundary = number
    point%position = closest_position(boundary, target)
  end function point_at_contour

  pure function point_inside(x) result(point)
    real(wp), intent(in) :: x(2)
    type(zone_point_t) :: point

    point%x = x
  end function point_inside

  pure function zone_of(corners) result(zone)
    integer, intent(in) :: corners(4)
    type(zone_t) :: zone

    zone%corners = corners
  end function zone_of

  !> An L of three unit squares, one zone each.
  pure subroutine l_shape(boundaries, points, zones)
    type(boundary_curve_t), allocatable, intent(out) :: boundaries(:)
    type(zone_point_t), allocatable, intent(out) :: points(:)
    type(zone_t), allocatable, intent(out) :: zones(:)
    real(wp), parameter :: x(2, 8) = reshape([0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 2.0_wp, 0.0_wp, 2.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, &
                                              1.0_wp, 2.0_wp, 0.0_wp, 2.0_wp, 0.0_wp, 1.0_wp], [2, 8])
    integer :: i

    allocate (boundaries(1), points(8), zones(3))
    boundaries(1) = polygon(x(:, [1, 3, 4, 5, 6, 7]), 3)
    do i = 1, 8
      points(i) = point_at_contour(1, boundaries(1), x(:, i))
    end do
    zones = [zone_of([1, 2, 5, 8]), zone_of([2, 3, 4, 5]), zone_of([5, 6, 7, 8])]
  end subroutine l_shape

  !> A disc with a hole beside its centre, four zones around.
  pure subroutine ring(boundaries, points, zones)
    type(boundary_curve_t), allocatable, intent(out) :: boundaries(:)
    type(zone_point_t), allocatable, intent(out) :: points(:)
    type(zone_t), allocatable, intent(out) :: zones(:)
    real(wp) :: angle
    integer :: i

    allocate (boundaries(2), points(8), zones(4))
    boundaries(1) = circle([0.0_wp, 0.0_wp], 2.0_wp, 16)
    boundaries(2) = circle([0.3_wp, 0.0_wp], -0.7_wp, 12)
    do i = 1, 4
      angle = 0.5_wp*pi*(i - 1) + 0.3_wp
      points(i) = point_at_contour(1, boundaries(1), 2*[cos(angle), sin(angle)])
      points(4 + i) = point_at_contour(2, boundaries(2), [0.3_wp, 0.0_wp] + 0.7_wp*[cos(angle), sin(angle)])
    end do
    zones = [zone_of([1, 2, 6, 5]), zone_of([2, 3, 7, 6]), zone_of([3, 4, 8, 7]), zone_of([4, 1, 5, 8])]
  end subroutine ring

  pure function uniform_field(h) result(field)
    real(wp), intent(in) :: h
    type(size_field_t) :: field
    type(size_limits_t) :: limits

    limits%largest = h
    call set_up_sizes(limits, [need_t ::], field)
  end function uniform_field

  !> Uniform squares of about the size h on a rectangle from the origin.
  function rectangle_mesh(width, height, h) result(mesh)
    real(wp), intent(in) :: width, height, h
    type(new_mesh_t) :: mesh
    type(boundary_curve_t) :: boundaries(1)
    type(zone_point_t), allocatable :: points(:)
    type(zone_t), allocatable :: zones(:)
    type(mesh_settings_t) :: settings
    type(position_t) :: none(0)
    type(error_t), allocatable :: error

    boundaries(1) = polygon(reshape([0.0_wp, 0.0_wp, width, 0.0_wp, width, height, 0.0_wp, height], [2, 4]), 1)
    call one_zone(boundaries, none, points, zones, error)
    call mesh_zones(boundaries, points, zones, uniform_field(h), settings, mesh, error)
  end function rectangle_mesh

  pure function quality_of(mesh) result(quality)
    type(new_mesh_t), intent(in) :: mesh
    type(quality_t) :: quality
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8, 17), dphi(2, 8, 17), x(2, 8), j(2, 2), det(17), chord(2), half(2)
    integer :: p, e, s

    call square_rule(9, xi, weight)
    do p = 1, 9
      call quad8(xi(1, p), xi(2, p), phi(:, p), dphi(:, :, p))
    end do
    do p = 1, 4
      call quad8(quad8_corner(1, p), quad8_corner(2, p), phi(:, 9 + p), dphi(:, :, 9 + p))
      xi(:, 1) = 0.5_wp*(quad8_corner(:, p) + quad8_corner(:, mod(p, 4) + 1))
      call quad8(xi(1, 1), xi(2, 1), phi(:, 13 + p), dphi(:, :, 13 + p))
    end do
    do e = 1, size(mesh%connectivity, 2)
      x = mesh%coordinates(:, mesh%connectivity(:, e))
      do p = 1, 17
        j = matmul(x, transpose(dphi(:, :, p)))
        det(p) = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
        if (p < 10 .or. p > 13) cycle
        quality%scaled_jacobian = min(quality%scaled_jacobian, det(p)/(length_of(j(:, 1))*length_of(j(:, 2))))
      end do
      quality%least_jacobian = min(quality%least_jacobian, minval(det)/maxval(abs(det)))
      do s = 1, 4
        chord = x(:, quad8_side(3, s)) - x(:, quad8_side(1, s))
        half = 0.5_wp*(x(:, quad8_side(1, s)) + x(:, quad8_side(3, s)))
        quality%off_middle = max(quality%off_middle, &
                                 abs(dot_product(x(:, quad8_side(2, s)) - half, chord))/dot_product(chord, chord))
      end do
    end do
  end function quality_of

  !> Largest distance of a node of the contour from its boundary, by a search independent of its position.
  pure function off_contour(boundaries, mesh) result(distance)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(new_mesh_t), intent(in) :: mesh
    real(wp) :: distance
    type(position_t) :: position
    integer :: i, k

    distance = 0
    do i = 1, size(mesh%sides)
      do k = 1, 3
        associate (x => mesh%coordinates(:, mesh%sides(i)%nodes(k)), boundary => boundaries(mesh%sides(i)%boundary))
          position = closest_position(boundary, x)
          distance = max(distance, length_of(x - point_on(boundary, position)))
        end associate
      end do
    end do
  end function off_contour

  !> Area of all elements, by 3 x 3 Gauss points, exact for parabolas.
  pure function area_of(mesh) result(area)
    type(new_mesh_t), intent(in) :: mesh
    real(wp) :: area
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8), dphi(2, 8), j(2, 2)
    integer :: p, e

    call square_rule(9, xi, weight)
    area = 0
    do p = 1, 9
      call quad8(xi(1, p), xi(2, p), phi, dphi)
      do e = 1, size(mesh%connectivity, 2)
        j = matmul(mesh%coordinates(:, mesh%connectivity(:, e)), transpose(dphi))
        area = area + weight(p)*(j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1))
      end do
    end do
  end function area_of

  !> Whether the sides of elements that no other shares are those listed as contour, and no node stands alone.
  pure function shared_exactly(mesh) result(yes)
    type(new_mesh_t), intent(in) :: mesh
    logical :: yes
    integer :: owners(size(mesh%coordinates, 2)), ends(size(mesh%coordinates, 2)), e, i

    owners = 0
    ends = 0
    do e = 1, size(mesh%connectivity, 2)
      owners(mesh%connectivity(5:8, e)) = owners(mesh%connectivity(5:8, e)) + 1
      ends(mesh%connectivity(1:4, e)) = ends(mesh%connectivity(1:4, e)) + 1
    end do
    yes = all(owners + ends > 0) .and. maxval(owners) <= 2 .and. count(owners == 1) == size(mesh%sides)
    do i = 1, size(mesh%sides)
      associate (side => mesh%sides(i))
        yes = yes .and. owners(side%nodes(2)) == 1 .and. any(mesh%connectivity(5:8, side%element) == side%nodes(2))
      end associate
    end do
  end function shared_exactly

end module zone_cases
