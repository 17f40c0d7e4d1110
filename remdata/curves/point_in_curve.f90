!> Whether a point is within a closed curve.
module point_in_curve
  use boundary_curves, only: boundary_curve_t
  use kinds, only: wp
  use offset_parabolas, only: point_at
  implicit none
  private
  public :: is_around

  !> Points along an arc, for the question whether a curve is around a point.
  integer, parameter :: chords = 4

contains

  !> Is a point within a closed curve? By the crossings of a ray along x with its chords.
  pure function is_around(boundary, point) result(around)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: point(2)   !! [length]
    logical :: around
    real(wp) :: a(2), b(2)
    integer :: k, i

    around = .false.
    do k = 1, size(boundary%arcs)
      associate (arc => boundary%arcs(k))
        a = point_at(arc, arc%range(1))
        do i = 1, chords
          b = point_at(arc, arc%range(1) + (arc%range(2) - arc%range(1))*i/chords)
          if ((a(2) > point(2)) .neqv. (b(2) > point(2))) then
            if (point(1) < a(1) + (point(2) - a(2))*(b(1) - a(1))/(b(2) - a(2))) around = .not. around
          end if
          a = b
        end do
      end associate
    end do
  end function is_around

end module point_in_curve
