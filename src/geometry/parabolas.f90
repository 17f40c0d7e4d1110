!> The parabola through three points, a piece of a die or a side of a part: y(xi) = sum_k phi_k(xi) Y_k, -1 <= xi <= 1.
!>
!> A segment is one with its middle point in the middle.
module parabolas
  use kinds, only: wp
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: point_on, tangent_on, bend_of, curvature_on, part_of, box_of_parabola

contains

  !> Point at a parent coordinate [length].
  pure function point_on(piece, xi) result(y)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: xi            !! [-]
    real(wp) :: y(2)

    y = 0.5_wp*xi*(xi - 1)*piece(:, 1) + (1 - xi*xi)*piece(:, 2) + 0.5_wp*xi*(xi + 1)*piece(:, 3)
  end function point_on

  !> dy/dxi [length].
  pure function tangent_on(piece, xi) result(tangent)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: xi            !! [-]
    real(wp) :: tangent(2)

    tangent = (xi - 0.5_wp)*piece(:, 1) - 2*xi*piece(:, 2) + (xi + 0.5_wp)*piece(:, 3)
  end function tangent_on

  !> d2y/dxi2, the same everywhere [length].
  pure function bend_of(piece) result(second)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp) :: second(2)

    second = piece(:, 1) - 2*piece(:, 2) + piece(:, 3)
  end function bend_of

  !> Curvature, positive where the parabola turns left [1/length].
  pure function curvature_on(piece, xi) result(curvature)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: xi            !! [-]
    real(wp) :: curvature
    real(wp) :: first(2)

    first = tangent_on(piece, xi)
    curvature = cross(first, bend_of(piece))/length_of(first)**3
  end function curvature_on

  !> The part between two parent coordinates, exactly: a part of a parabola is a parabola.
  pure function part_of(piece, from, to) result(part)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp), intent(in) :: from, to      !! [-]
    real(wp) :: part(2, 3)

    part(:, 1) = point_on(piece, from)
    part(:, 2) = point_on(piece, 0.5_wp*(from + to))
    part(:, 3) = point_on(piece, to)
    if (from <= -1) part(:, 1) = piece(:, 1)
    if (to >= 1) part(:, 3) = piece(:, 3)
  end function part_of

  !> A box that contains the parabola: that of its Bezier points (xmin, ymin, xmax, ymax) [length].
  pure function box_of_parabola(piece) result(box)
    real(wp), intent(in) :: piece(2, 3)   !! points [length]
    real(wp) :: box(4)
    real(wp) :: bezier(2)

    bezier = 2*piece(:, 2) - 0.5_wp*(piece(:, 1) + piece(:, 3))
    box = [min(piece(:, 1), piece(:, 3), bezier), max(piece(:, 1), piece(:, 3), bezier)]
  end function box_of_parabola

end module parabolas
