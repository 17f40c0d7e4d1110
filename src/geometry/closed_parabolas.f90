!> Closed contours of parabolas: their area, and whether points are inside.
module closed_parabolas
  use kinds, only: wp
  use plane_vectors, only: cross
  implicit none
  private
  public :: area_beside, area_in, lies_within

contains

  !> Area on the left of closed parabolas: half the integral of x dy - y dx, exact for each [length^2].
  pure function area_in(pieces) result(area)
    real(wp), intent(in) :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    real(wp) :: area
    integer :: k

    area = 0
    do k = 1, size(pieces, 3)
      area = area + area_beside(pieces(:, :, k), pieces(:, 1, 1))
    end do
  end function area_in

  !> Share of a parabola in the area around an origin, positive where the origin is on its left [length^2].
  pure function area_beside(points, origin) result(area)
    real(wp), intent(in) :: points(2, 3), origin(2)   !! [length]
    real(wp) :: area

    associate (a => points(:, 1) - origin, m => points(:, 2) - origin, b => points(:, 3) - origin)
      area = 0.5_wp*cross(a, b) + 2*cross(m - a, b - a)/3
    end associate
  end function area_beside

  !> All ends and middle points of parabolas are inside a closed contour of others, by the crossings of a ray along x with its
  !> chords, two to each parabola.
  pure function lies_within(pieces, others) result(within)
    real(wp), intent(in) :: pieces(:, :, :), others(:, :, :)   !! (2, 3, npiece) [length]
    logical :: within
    integer :: i, k

    within = .true.
    do k = 1, size(pieces, 3)
      do i = 1, 2
        within = within .and. is_inside(pieces(:, i, k), others)
      end do
    end do
  end function lies_within

  pure function is_inside(x, pieces) result(inside)
    real(wp), intent(in) :: x(2), pieces(:, :, :)   !! (2), (2, 3, npiece) [length]
    logical :: inside
    integer :: k, m

    inside = .false.
    do k = 1, size(pieces, 3)
      do m = 1, 2
        associate (a => pieces(:, m, k), b => pieces(:, m + 1, k))
          if ((a(2) > x(2)) .eqv. (b(2) > x(2))) cycle
          if (x(1) < a(1) + (x(2) - a(2))*(b(1) - a(1))/(b(2) - a(2))) inside = .not. inside
        end associate
      end do
    end do
  end function is_inside

end module closed_parabolas
