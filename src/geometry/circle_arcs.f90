!> Arcs of circle as parabolas within a tolerance.
module circle_arcs
  use kinds, only: pi, wp
  use plane_vectors, only: angle_between, cross
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: arc_pieces

  !> More parabolas for one arc are an error of input.
  integer, parameter :: most_parabolas = 10000
  !> Three points lie on a line when the sine of the angle between two chords is below this.
  real(wp), parameter :: on_a_line = 1.0e-9_wp

contains

  !> Equal parabolas along the arc through three points, as few as stay within `tolerance` of the circle.
  !>
  !> With its ends at angles -a, a and its middle at 0 the isoparametric parabola has
  !> r(xi)^2/R^2 = 1 - (1 - cos a)^2 xi^2 (1 - xi^2): it is inside the circle, by most at xi^2 = 1/2.
  pure subroutine arc_pieces(first, middle, last, tolerance, pieces, message)
    real(wp), intent(in) :: first(2), middle(2), last(2)    !! [length]
    real(wp), intent(in) :: tolerance                       !! > 0 [length]
    real(wp), allocatable, intent(out) :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    character(len=:), allocatable, intent(out) :: message   !! empty when all is well
    real(wp) :: a(2), b(2), area, centre(2), radius, turn, start
    integer :: n, k

    message = ''
    a = middle - first
    b = last - first
    area = cross(a, b)
    if (length_of(a) > 0) then
      if (abs(area) > on_a_line*length_of(a)*length_of(b)) then
        centre = first + [b(2)*dot_product(a, a) - a(2)*dot_product(b, b), &
                          a(1)*dot_product(b, b) - b(1)*dot_product(a, a)]/(2*area)
        radius = length_of(first - centre)
        ! the sense of rotation in which the arc passes through the middle point
        turn = angle_between(first - centre, last - centre)
        if (area > 0 .and. turn < 0) turn = turn + 2*pi
        if (area < 0 .and. turn > 0) turn = turn - 2*pi
        n = 1
        do while (n <= most_parabolas)
          if (abs(turn)/n <= pi .and. deviation(abs(turn)/(2*n))*radius <= tolerance) exit
          n = n + 1
        end do
        if (n > most_parabolas) then
          message = 'the arc would take more than '//to_text(most_parabolas)//' parabolas: the tolerance is too small'
          return
        end if
        start = atan2(first(2) - centre(2), first(1) - centre(1))
        allocate (pieces(2, 3, n))
        do k = 1, n
          pieces(:, 1, k) = on_circle(start + (k - 1)*turn/n)
          pieces(:, 2, k) = on_circle(start + (k - 0.5_wp)*turn/n)
          pieces(:, 3, k) = on_circle(start + k*turn/n)
        end do
        pieces(:, 1, 1) = first
        pieces(:, 3, n) = last
        return
      end if
    end if
    message = 'the three points of the arc lie on a line'

  contains

    pure function on_circle(angle) result(x)
      real(wp), intent(in) :: angle
      real(wp) :: x(2)

      x = centre + radius*[cos(angle), sin(angle)]
    end function on_circle

  end subroutine arc_pieces

  !> Largest distance from the circle, over the radius, of a parabola over twice the angle a.
  pure function deviation(a) result(d)
    real(wp), intent(in) :: a
    real(wp) :: d
    real(wp) :: q

    q = 0.25_wp*(2*sin(0.5_wp*a)**2)**2
    d = q/(1 + sqrt(1 - q))
  end function deviation

end module circle_arcs
