!> Dies of known shape, and what is closest on them found by trying, for the tests of the search.
module curve_cases
  use kinds, only: wp
  use piecewise_curves, only: piecewise_curve_t, prepare_search
  use sample_numbers, only: sample_t
  implicit none
  private
  public :: curve_of, segment, polyline, bowl, direction, s_shape, random_curve, height_of, closest_by_trying

contains

  !> A curve of pieces, ready to be searched.
  pure function curve_of(pieces) result(curve)
    real(wp), intent(in) :: pieces(:, :, :)
    type(piecewise_curve_t) :: curve

    allocate (curve%pieces, source=pieces)
    call prepare_search(curve)
  end function curve_of

  !> The three points of a straight piece.
  pure function segment(from, to) result(piece)
    real(wp), intent(in) :: from(2), to(2)
    real(wp) :: piece(2, 3, 1)

    piece(:, 1, 1) = from
    piece(:, 2, 1) = 0.5_wp*(from + to)
    piece(:, 3, 1) = to
  end function segment

  !> A die of straight pieces through points, walked with the part on the left.
  function polyline(points) result(die)
    real(wp), intent(in) :: points(:, :)
    type(piecewise_curve_t) :: die
    real(wp) :: pieces(2, 3, size(points, 2) - 1)
    integer :: k

    do k = 1, size(pieces, 3)
      pieces(:, :, k:k) = segment(points(:, k), points(:, k + 1))
    end do
    die = curve_of(pieces)
  end function polyline

  !> The parabola y = a x**2 between x = -2 and 2, walked along x: the body is below it.
  function bowl(a) result(die)
    real(wp), intent(in) :: a
    type(piecewise_curve_t) :: die

    die = curve_of(reshape([-2.0_wp, 4*a, 0.0_wp, 0.0_wp, 2.0_wp, 4*a], [2, 3, 1]))
  end function bowl

  !> A hill y = 1 - x**2 and a valley y = (x - 2)**2 - 1 that goes on from it in tangent at (1, 0) (annex 3, fig. 5).
  function s_shape() result(die)
    type(piecewise_curve_t) :: die

    die = curve_of(reshape([-1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, &
                          1.0_wp, 0.0_wp, 2.0_wp, -1.0_wp, 3.0_wp, 0.0_wp], [2, 3, 2]))
  end function s_shape

  !> Three pieces over x from -3 to 3, each a segment or a parabola, joined in corners of either sense.
  subroutine random_curve(sample, die)
    type(sample_t), intent(inout) :: sample
    type(piecewise_curve_t), intent(out) :: die
    real(wp) :: pieces(2, 3, 3), heights(4), bend, straight
    integer :: k

    call sample%fill(-0.8_wp, 0.8_wp, heights)
    do k = 1, 3
      call sample%draw(-0.5_wp, 0.5_wp, bend)
      call sample%draw(0.0_wp, 1.0_wp, straight)
      if (straight < 0.4_wp) bend = 0
      pieces(1, :, k) = 2*k - 5 + [0, 1, 2]
      pieces(2, :, k) = [heights(k), 0.5_wp*(heights(k) + heights(k + 1)) + bend, heights(k + 1)]
    end do
    die = curve_of(pieces)
  end subroutine random_curve

  pure function on_piece(piece, xi) result(y)
    real(wp), intent(in) :: piece(2, 3), xi
    real(wp) :: y(2)

    y = 0.5_wp*xi*(xi - 1)*piece(:, 1) + (1 - xi*xi)*piece(:, 2) + 0.5_wp*xi*(xi + 1)*piece(:, 3)
  end function on_piece

  !> Height of a curve over x, where x is even along each piece.
  pure function height_of(die, x) result(height)
    type(piecewise_curve_t), intent(in) :: die
    real(wp), intent(in) :: x
    real(wp) :: height
    real(wp) :: y(2)
    integer :: k

    height = huge(x)
    do k = 1, size(die%pieces, 3)
      if (x < die%pieces(1, 1, k) .or. x > die%pieces(1, 3, k)) cycle
      y = on_piece(die%pieces(:, :, k), (x - die%pieces(1, 2, k))/(die%pieces(1, 3, k) - die%pieces(1, 2, k)))
      height = y(2)
    end do
  end function height_of

  !> Closest point of a die: the best of many places, then thirds of the intervals beside it.
  pure subroutine closest_by_trying(die, point, closest, distance)
    type(piecewise_curve_t), intent(in) :: die
    real(wp), intent(in) :: point(2)
    real(wp), intent(out) :: closest(2), distance
    real(wp) :: low, high, third, y(2), best_xi
    integer, parameter :: nplace = 400
    integer :: k, i, best

    distance = huge(1.0_wp)
    best = 1
    best_xi = 0
    do k = 1, size(die%pieces, 3)
      do i = -nplace, nplace
        y = on_piece(die%pieces(:, :, k), real(i, wp)/nplace)
        if (norm2(y - point) >= distance) cycle
        distance = norm2(y - point)
        best = k
        best_xi = real(i, wp)/nplace
      end do
    end do
    low = max(best_xi - 1.0_wp/nplace, -1.0_wp)
    high = min(best_xi + 1.0_wp/nplace, 1.0_wp)
    associate (piece => die%pieces(:, :, best))
      do i = 1, 90
        third = (high - low)/3
        if (norm2(on_piece(piece, low + third) - point) < norm2(on_piece(piece, high - third) - point)) then
          high = high - third
        else
          low = low + third
        end if
      end do
      y = on_piece(piece, 0.5_wp*(low + high))
    end associate
    closest = y
    distance = norm2(y - point)
  end subroutine closest_by_trying

  pure function direction(angle) result(e)
    real(wp), intent(in) :: angle
    real(wp) :: e(2)

    e = [cos(angle), sin(angle)]
  end function direction

end module curve_cases
