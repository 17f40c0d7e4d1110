!> Directions of squares over a body: along the contours there, and as smooth as possible between them.
!>
!> Directions that are a right angle apart are the same for a square, so that the cosine and sine of four times the angle are
!> sought, which satisfy Laplace's equation in the mean (J.-F. Remacle et al., Int. J. Num. Meth. Engng 94 (2013) 494-512, section
!> 3). Linear triangles, conjugate gradients with the diagonal as preconditioner.
module cross_directions
  use kinds, only: wp
  use plane_vectors, only: cross
  use triangulation, only: after, before, triangulation_t
  implicit none
  private
  public :: align_directions

  !> Iterations at most, and the fall of the residual that ends them: an error of a degree does no harm.
  integer, parameter :: most_iterations = 500
  real(wp), parameter :: fall = 1.0e-4_wp

contains

  pure subroutine align_directions(mesh, sides, fourfold)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: sides(:, :)                       !! ends of kept sides (2, nside)
    real(wp), allocatable, intent(out) :: fourfold(:, :)     !! cosine and sine of four times the angle (2, npoint) [-]
    real(wp), allocatable :: weight(:, :), diagonal(:), residual(:, :), step(:, :), image(:, :)
    logical, allocatable :: free(:)
    real(wp) :: along(2), norm, start, product, previous, power
    integer :: s, t, k, iteration, n

    n = mesh%npoint
    allocate (fourfold(2, n), source=0.0_wp)
    do s = 1, size(sides, 2)
      along = mesh%x(:, sides(2, s)) - mesh%x(:, sides(1, s))
      along = turned_fourfold(along)
      fourfold(:, sides(1, s)) = fourfold(:, sides(1, s)) + along
      fourfold(:, sides(2, s)) = fourfold(:, sides(2, s)) + along
    end do
    allocate (free(n), source=.true.)
    do k = 1, n
      norm = sqrt(sum(fourfold(:, k)**2))
      ! where the sides contradict each other, as at corners of 45 degrees, neither is followed
      free(k) = norm < 0.1_wp
      fourfold(:, k) = merge(0.0_wp, fourfold(:, k)/max(norm, 0.1_wp), free(k))
    end do
    call set_up_weights(mesh, weight, diagonal)
    free = free .and. diagonal > 0
    allocate (residual(2, n), step(2, n), image(2, n))
    call multiply(mesh, weight, fourfold, image)
    call keep_free(free, image)
    residual = -image
    step = residual/spread(max(diagonal, tiny(1.0_wp)), 1, 2)
    call keep_free(free, step)
    previous = sum(residual*step)
    start = previous
    do iteration = 1, most_iterations
      if (.not. previous > fall**2*start) exit
      call multiply(mesh, weight, step, image)
      call keep_free(free, image)
      power = sum(step*image)
      if (.not. power > 0) exit
      fourfold = fourfold + previous/power*step
      residual = residual - previous/power*image
      image = residual/spread(max(diagonal, tiny(1.0_wp)), 1, 2)
      product = sum(residual*image)
      step = image + product/previous*step
      call keep_free(free, step)
      previous = product
    end do
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t)) cycle
      do k = 1, 3
        associate (node => mesh%node(k, t))
          norm = sqrt(sum(fourfold(:, node)**2))
          if (norm > 0) fourfold(:, node) = fourfold(:, node)/norm
        end associate
      end do
    end do
  end subroutine align_directions

  !> Cosine and sine of four times the angle of a vector.
  pure function turned_fourfold(v) result(w)
    real(wp), intent(in) :: v(2)
    real(wp) :: w(2), angle

    angle = 4*atan2(v(2), v(1))
    w = [cos(angle), sin(angle)]
  end function turned_fourfold

  pure subroutine keep_free(free, values)
    logical, intent(in) :: free(:)
    real(wp), intent(inout) :: values(:, :)
    integer :: k

    do k = 1, size(free)
      if (.not. free(k)) values(:, k) = 0
    end do
  end subroutine keep_free

  !> Half the cotangent of the angle opposite to each side: the stiffness of linear triangles (U. Pinkall, K. Polthier, Experimental
  !> Mathematics 2 (1993) 15-36).
  pure subroutine set_up_weights(mesh, weight, diagonal)
    type(triangulation_t), intent(in) :: mesh
    real(wp), allocatable, intent(out) :: weight(:, :), diagonal(:)
    real(wp) :: u(2), v(2), area
    integer :: t, k

    allocate (weight(3, mesh%ntriangle), diagonal(mesh%npoint), source=0.0_wp)
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t)) cycle
      do k = 1, 3
        associate (a => mesh%node(k, t), b => mesh%node(after(k), t), c => mesh%node(before(k), t))
          u = mesh%x(:, b) - mesh%x(:, a)
          v = mesh%x(:, c) - mesh%x(:, a)
          area = cross(u, v)
          if (.not. area > 0) cycle
          ! a slight lower limit keeps triangles along a contour, which may be obtuse, from turning values round
          weight(k, t) = max(0.5_wp*dot_product(u, v)/area, 0.0_wp)
          diagonal([b, c]) = diagonal([b, c]) + weight(k, t)
        end associate
      end do
    end do
  end subroutine set_up_weights

  pure subroutine multiply(mesh, weight, values, image)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: weight(:, :), values(:, :)
    real(wp), intent(out) :: image(:, :)
    real(wp) :: flow(2)
    integer :: t, k

    image = 0
    do t = 1, mesh%ntriangle
      if (.not. mesh%inside(t)) cycle
      do k = 1, 3
        associate (b => mesh%node(after(k), t), c => mesh%node(before(k), t))
          flow = weight(k, t)*(values(:, b) - values(:, c))
          image(:, b) = image(:, b) + flow
          image(:, c) = image(:, c) - flow
        end associate
      end do
    end do
  end subroutine multiply

end module cross_directions
