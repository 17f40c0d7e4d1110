!> Shape of 8-node quadrilaterals, measured without units.
!>
!> With the parent axes' tangents a = dx/dxi, b = dx/deta and J = a x b, an element has
!> - corner angles between its sides, by their tangents, so that curved sides count: above 180 degrees where it is concave;
!> - the position of its middle nodes: twice the distance of their projection on the chord from the chord's middle, over the chord
!>   (1/3 is the end of the middle third);
!> - the Jacobian ratio min J / max |J| and the scaled Jacobian min J/(|a||b|), both over corners and 3 x 3 points;
!> - the aspect ratio of its two medians.
!> Sources: J. Robinson, Comput. Struct. 25 (1987) 161-176 (aspect); P.M. Knupp, Int. J. Num. Meth. Engng 48 (2000) 401-420 (scaled
!> Jacobian); R.D. Henshell, K.G. Shaw, Int. J. Num. Meth. Engng 9 (1975) 495-507 (the quarter point, where J is zero at a corner).
module mesh_quality
  use kinds, only: pi, wp
  use plane_vectors, only: cross
  use quadrature, only: square_rule
  use remeshing, only: aspect_ratio, is_upper, jacobian_ratio, largest_angle, least_angle, middle_share, ncriteria, scaled_jacobian
  use shape_functions, only: quad8, quad8_corner, quad8_side
  use vectors, only: length_of
  implicit none
  private
  public :: corner_angles, shape_places_t, shape_places, element_shape, mesh_shape, is_bad

  integer, parameter :: ncorner = 4, npoint = 9, nplace = ncorner + npoint

  !> Derivatives of the shape functions at the corners and points where elements are measured.
  type :: shape_places_t
    real(wp) :: dphi(2, 8, nplace) = 0.0_wp
  end type shape_places_t

contains

  pure function shape_places() result(places)
    type(shape_places_t) :: places
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8)
    integer :: k

    call square_rule(npoint, xi, weight)
    do k = 1, ncorner
      call quad8(quad8_corner(1, k), quad8_corner(2, k), phi, places%dphi(:, :, k))
    end do
    do k = 1, npoint
      call quad8(xi(1, k), xi(2, k), phi, places%dphi(:, :, ncorner + k))
    end do
  end function shape_places

  !> All measures of an element, in the order of the criteria; angles in degrees.
  pure function element_shape(places, x) result(measures)
    type(shape_places_t), intent(in) :: places
    real(wp), intent(in) :: x(2, 8)   !! nodes [length]
    real(wp) :: measures(ncriteria)
    real(wp), dimension(2, nplace) :: a, b
    real(wp) :: det(nplace), sides(nplace), angle(ncorner), chord(2), arm(2), place, medians(2)
    integer :: k

    do k = 1, nplace
      a(:, k) = matmul(x, places%dphi(1, :, k))
      b(:, k) = matmul(x, places%dphi(2, :, k))
      det(k) = cross(a(:, k), b(:, k))
      sides(k) = length_of(a(:, k))*length_of(b(:, k))
    end do
    angle = corner_angles(places, x)
    measures(least_angle) = minval(angle)*180/pi
    measures(largest_angle) = maxval(angle)*180/pi

    measures(middle_share) = 0
    do k = 1, 4
      chord = x(:, quad8_side(3, k)) - x(:, quad8_side(1, k))
      arm = 2*x(:, quad8_side(2, k)) - x(:, quad8_side(1, k)) - x(:, quad8_side(3, k))
      place = abs(dot_product(chord, arm))
      measures(middle_share) = max(measures(middle_share), over(place, dot_product(chord, chord)))
    end do
    measures(jacobian_ratio) = over(minval(det), maxval(abs(det)))
    measures(scaled_jacobian) = 1
    do k = 1, nplace
      measures(scaled_jacobian) = min(measures(scaled_jacobian), over(det(k), sides(k)))
    end do
    medians = [length_of(x(:, 7) - x(:, 5)), length_of(x(:, 6) - x(:, 8))]
    measures(aspect_ratio) = over(maxval(medians), minval(medians))
  end function element_shape

  !> Angles at the corners of an element, between the tangents of its sides; above pi where it is concave [rad].
  pure function corner_angles(places, x) result(angle)
    type(shape_places_t), intent(in) :: places
    real(wp), intent(in) :: x(2, 8)   !! nodes [length]
    real(wp) :: angle(ncorner)
    real(wp) :: a(2), b(2), along
    integer :: k

    ! sides leave a corner along (a, b), (b, -a), (-a, -b), (-b, a)
    do k = 1, ncorner
      a = matmul(x, places%dphi(1, :, k))
      b = matmul(x, places%dphi(2, :, k))
      along = dot_product(a, b)
      angle(k) = modulo(atan2(cross(a, b), merge(along, -along, mod(k, 2) == 1)), 2*pi)
    end do
  end function corner_angles

  !> A quotient, for elements that may be of no size.
  pure function over(a, b) result(ratio)
    real(wp), intent(in) :: a, b
    real(wp) :: ratio

    ratio = sign(huge(1.0_wp), a)
    if (.not. abs(a) > 0) ratio = 0
    if (b > abs(a)/huge(1.0_wp) .and. b > 0) ratio = a/b
  end function over

  !> Measures of all elements of a mesh.
  pure subroutine mesh_shape(coordinates, connectivity, measures)
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) [length]
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    real(wp), intent(out) :: measures(:, :)     !! (ncriteria, nelem) [unit of each criterion]
    type(shape_places_t) :: places
    integer :: e

    places = shape_places()
    do e = 1, size(connectivity, 2)
      measures(:, e) = element_shape(places, coordinates(:, connectivity(:, e)))
    end do
  end subroutine mesh_shape

  !> Which criteria an element fails.
  pure function is_bad(measures, limits) result(bad)
    real(wp), intent(in) :: measures(ncriteria), limits(ncriteria)   !! [unit of each criterion]
    logical :: bad(ncriteria)

    bad = merge(measures > limits, measures < limits, is_upper)
  end function is_bad

end module mesh_quality
