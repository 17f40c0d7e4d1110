!> Contours of polygons, and lines across them, for the tests of cuts.
module cut_cases
  use arcs, only: straight
  use boundary_curves, only: close_boundary, kind_corner
  use corrected_contours, only: contour_t
  use kinds, only: wp
  implicit none
  private
  public :: bend, polygon, rectangle

  !> A corner is where the tangent turns by more than this [radian].
  real(wp), parameter :: turn = 0.35_wp

contains

  !> The contour of a polygon, all of its joints corners: a body on the left of its sides, counter-clockwise, or a hole, clockwise.
  pure function polygon(points) result(contour)
    real(wp), intent(in) :: points(:, :)   !! (2, n) [length]
    type(contour_t) :: contour
    integer :: k, n

    n = size(points, 2)
    allocate (contour%boundary%arcs(n), contour%boundary%kinds(n), contour%contacts(0))
    do k = 1, n
      contour%boundary%arcs(k) = straight(points(:, k), points(:, mod(k, n) + 1))
      contour%boundary%arcs(k)%side = k
    end do
    contour%boundary%kinds = kind_corner
    contour%loop%element = [(1, k=1, n)]
    allocate (contour%tags%on_set(n, n), contour%tags%on_group(1, n), contour%tags%on_fixation(1, n), contour%tags%on_die(1, n), &
              contour%tags%on_axis(n), contour%tags%on_wall(n), source=.false.)
    ! each side is a set of its own
    do k = 1, n
      contour%tags%on_set(k, k) = .true.
    end do
    call close_boundary(turn, contour%boundary)
  end function polygon

  !> Sides 1 to 4: bottom, right, top, left; of a hole left, top, right, bottom.
  pure function rectangle(low, high, is_hole) result(contour)
    real(wp), intent(in) :: low(2), high(2)   !! opposite corners [length]
    logical, intent(in), optional :: is_hole
    type(contour_t) :: contour
    real(wp) :: points(2, 4)

    points = reshape([low, high(1), low(2), high, low(1), high(2)], [2, 4])
    if (present(is_hole)) then
      if (is_hole) points = points(:, [1, 4, 3, 2])
    end if
    contour = polygon(points)
  end function rectangle

  !> Bend a side into the parabola whose middle lies so far to the right of the chord, which is outwards.
  pure subroutine bend(contour, side, by)
    type(contour_t), intent(inout) :: contour
    integer, intent(in) :: side
    real(wp), intent(in) :: by   !! [length]
    real(wp) :: chord(2)

    associate (points => contour%boundary%arcs(side)%points)
      chord = points(:, 3) - points(:, 1)
      points(:, 2) = 0.5_wp*(points(:, 1) + points(:, 3)) + by*[chord(2), -chord(1)]/sqrt(sum(chord**2))
    end associate
    call close_boundary(turn, contour%boundary)
  end subroutine bend

end module cut_cases
