!> Corners of a die that stick into a side of the part between its integration points.
!>
!> Contact is a condition on the whole side, evaluated at integration points. How far
!> a smooth die can go in between them depends on their number; a corner goes in however many they
!> are. So corners are evaluated too: with y(xi) the side's point closest to the corner V,
!> (V - y).y' = 0, its depth is d = (V - y).e_R, along the side's own inner normal e_R. Where e_R
!> leaves the corner's fan the side lies along a face, and the face's normal is taken.
module side_corners
  use closest_point, only: closest_point_t, stationary_points, whole_piece
  use dies, only: die_t
  use kinds, only: wp
  use parabolas, only: point_on
  use plane_vectors, only: left_of, right_of
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: corner_t, corner_within, deepest_corner, closest_at_corner

  !> The corner deepest in an interval of a side.
  type :: corner_t
    logical :: found = .false.
    !> Which one of the die it is.
    integer :: number = 0
    !> Position on the side.
    real(wp) :: place = 0.0_wp
    !> Piece and position on the die; in the pilot's axes the corner, and the normal of depth, inner for the die.
    integer :: piece = 0
    real(wp) :: xi = 0.0_wp, vertex(2) = 0.0_wp, normal(2) = 0.0_wp
    !> That normal is the side's own and turns with it, else that of the face before the corner (1) or behind it (2).
    logical :: own = .false.
    integer :: face = 0
    !> Depth [length].
    real(wp) :: d = 0.0_wp
    !> How far it passes the node at an end of the side, 0 to 1 (passing_corners).
    real(wp) :: passing = 0.0_wp
  end type corner_t

  !> Beyond this sine outside the fan the side faces away from the corner.
  real(wp), parameter :: beside = 0.3_wp

contains

  !> The corner that is deepest between two positions on a side, if there is one nearer than `reach`.
  pure subroutine deepest_corner(die, side, from, to, reach, corner, beyond)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes of the side in the pilot's axes [length]
    real(wp), intent(in) :: from, to     !! positions on the side; `to` belongs to the next interval
    real(wp), intent(in) :: reach        !! [length]
    type(corner_t), intent(out) :: corner
    real(wp), intent(in), optional :: beyond   !! the side goes on so far beyond its ends, 0 where absent [-]
    type(corner_t) :: one
    real(wp) :: more
    integer :: k

    more = 0
    if (present(beyond)) more = beyond
    do k = 1, size(die%corners, 2)
      call corner_within(die, k, side, from, to, reach, more, one)
      if (.not. one%found) cycle
      if (.not. corner%found .or. one%d > corner%d) corner = one
    end do
  end subroutine deepest_corner

  !> A corner of a die, if it is between two positions on a side and nearer than `reach`.
  pure subroutine corner_within(die, number, side, from, to, reach, beyond, corner)
    type(die_t), intent(in) :: die
    integer, intent(in) :: number        !! of the corner
    real(wp), intent(in) :: side(2, 3)   !! nodes of the side in the pilot's axes [length]
    real(wp), intent(in) :: from, to     !! positions on the side; `to` belongs to the next interval
    real(wp), intent(in) :: reach        !! [length]
    real(wp), intent(in) :: beyond       !! the side goes on so far beyond its ends [-]
    type(corner_t), intent(out) :: corner
    real(wp) :: range(2)

    corner%number = number
    corner%vertex = die%corners(1:2, number)
    if (any(corner%vertex < minval(side, 2) - reach) .or. any(corner%vertex > maxval(side, 2) + reach)) return
    range = [from, to] + beyond*[merge(0, -1, from > -1), merge(0, 1, to < 1)]
    corner%place = nearest_place(side, corner%vertex, beyond)
    if (corner%place < range(1) .or. .not. corner%place < range(2)) return
    corner%piece = die%corner_piece(number)
    corner%xi = die%corner_xi(number)
    call measure_corner(die%corners(3:4, number), die%corners(5:6, number), side, corner)
    corner%found = corner%found .and. abs(corner%d) < reach
  end subroutine corner_within

  !> Place on a side that is the nearest to a corner, beyond the side where an end of it is. Where a side is bent the distance is
  !> stationary at others as well: beyond the centre of curvature it has a maximum, and another minimum appears at a distance.
  pure function nearest_place(side, vertex, beyond) result(place)
    real(wp), intent(in) :: side(2, 3), vertex(2)   !! [length]
    real(wp), intent(in) :: beyond                  !! length by which the side goes on [-]
    real(wp) :: place
    real(wp) :: xi(3), range(2), least, distance
    integer :: r, n

    range = whole_piece + [-beyond, beyond]
    place = 2*range(2)
    least = min(length_of(point_on(side, range(1)) - vertex), length_of(point_on(side, range(2)) - vertex))
    call stationary_points(side, vertex, range, n, xi)
    do r = 1, n
      distance = length_of(point_on(side, xi(r)) - vertex)
      if (.not. distance <= least) cycle
      least = distance
      place = xi(r)
    end do
  end function nearest_place

  !> Normal and depth of a corner between tangents t1 and t2.
  pure subroutine measure_corner(t1, t2, side, corner)
    real(wp), intent(in) :: t1(2), t2(2), side(2, 3)
    type(corner_t), intent(inout) :: corner
    real(wp) :: phi(3), dphi(3), tangent(2), inner(2)

    call line3(corner%place, phi, dphi)
    tangent = matmul(side, dphi)
    inner = left_of(tangent)
    corner%found = dot_product(inner, t1) >= -beside .and. dot_product(inner, t2) <= beside
    corner%own = dot_product(inner, t1) >= 0 .and. dot_product(inner, t2) <= 0
    corner%normal = -inner
    corner%face = 0
    if (.not. corner%own) then
      corner%face = merge(1, 2, dot_product(inner, t1) < 0)
      corner%normal = right_of(merge(t1, t2, corner%face == 1))
    end if
    corner%d = dot_product(matmul(side, phi) - corner%vertex, corner%normal)
  end subroutine measure_corner

  !> A corner as the closest point to the side's point.
  pure function closest_at_corner(corner) result(closest)
    type(corner_t), intent(in) :: corner
    type(closest_point_t) :: closest

    closest%piece = corner%piece
    closest%xi = corner%xi
    closest%d = corner%d
    closest%normal = corner%normal
  end function closest_at_corner

end module side_corners
