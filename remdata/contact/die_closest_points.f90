!> Points of sides of a part, their closest points on a die and depths in it, and distances along the die.
module die_closest_points
  use arcs, only: arc_t
  use boundary_sides, only: loop_t
  use closest_point, only: closest_point_t, closest_within_piece
  use curve_search, only: closest_on_pieces
  use dies, only: die_t
  use kinds, only: eps, wp
  use loop_intervals, only: side_point_t
  use offset_parabolas, only: closest_xi, offset_parabola_t, point_at
  use plane_vectors, only: turned
  use vectors, only: length_of
  implicit none
  private
  public :: point_on_side, find_closest_point, distance_along

  !> Pieces are extrapolated past their ends, in half pieces, where a point lies behind a corner of the die.
  real(wp), parameter :: beyond = 2.0_wp

contains

  !> Point of a side [length].
  pure function point_on_side(loop, x, side_point) result(point)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) coordinates [length]
    type(side_point_t), intent(in) :: side_point
    real(wp) :: point(2)
    type(arc_t) :: side

    side%points = x(:, loop%sides(:, modulo(side_point%side - 1, size(loop%sides, 2)) + 1))
    point = point_at(side, side_point%xi)
  end function point_on_side

  !> Distance along the die from one closest point to another, in half pieces, negative backwards; the shorter way on a closed die.
  pure function distance_along(die, from, to) result(distance)
    type(die_t), intent(in) :: die
    type(closest_point_t), intent(in) :: from, to
    real(wp) :: distance
    integer :: npiece

    npiece = size(die%pieces, 3)
    distance = 2*(to%piece - from%piece) + (to%xi - from%xi)
    if (.not. die%closed) return
    if (distance > npiece) distance = distance - 2*npiece
    if (distance <= -npiece) distance = distance + 2*npiece
  end function distance_along

  !> Closest point on some pieces, and its depth, the same number as the solver's. A point near the vertex between two pieces
  !> belongs to both: the piece before the vertex is taken where contact ends, the piece behind it where contact begins. In the fan
  !> of a corner, or past an end, that piece is extrapolated, and the depth is that in its extrapolation: the contour passes through
  !> the point.
  pure subroutine find_closest_point(die, pilot, point, pieces, begins, closest, projected)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3), point(2)   !! (x, y, angle) of the die now [length and radian]; coordinates [length]
    integer, intent(in) :: pieces(2)             !! first and last; across the start of a closed die when the last is lower
    logical, intent(in) :: begins
    type(closest_point_t), intent(out) :: closest
    logical, intent(out) :: projected   !! the point lies over the piece, not in the fan of a corner
    type(offset_parabola_t) :: one
    real(wp) :: local(2), least, slack, past_ends, xi
    integer :: i, k, piece, npiece, count

    local = turned(point - pilot(1:2), -pilot(3))
    slack = 16*eps*max(maxval(abs(point)), maxval(abs(pilot(1:2))), maxval(abs(local)))
    npiece = size(die%pieces, 3)
    count = modulo(pieces(2) - pieces(1), npiece) + 1
    if (.not. die%closed .and. pieces(2) < pieces(1)) count = 1
    call closest_on_pieces(die, local, pieces(1), count, closest)
    projected = closest%piece > 0 .and. .not. closest%at_vertex
    least = huge(least)
    if (closest%piece > 0) least = abs(closest%d)
    past_ends = min(length_of(local - die%pieces(:, 1, pieces(1))), &
                    length_of(local - die%pieces(:, 3, modulo(pieces(1) + count - 2, npiece) + 1)))
    if (past_ends < least - slack) then
      projected = .false.
      least = past_ends
    end if
    do i = 1, count
      k = merge(count - i, i - 1, begins)
      piece = modulo(pieces(1) + k - 1, npiece) + 1
      if (projected .and. piece == closest%piece) exit
      if (length_of(max(die%boxes(1:2, piece) - local, local - die%boxes(3:4, piece), 0.0_wp)) > least + slack) cycle
      one%points = die%pieces(:, :, piece)
      xi = closest_xi(one, local)
      if (length_of(point_at(one, xi) - local) > least + slack) cycle
      closest%piece = piece
      closest%xi = xi
      exit
    end do
    ! distances that overflow are all the same
    if (closest%piece == 0) closest%piece = pieces(1)
    if (projected) then
      closest%xi = min(max(closest%xi, -1.0_wp), 1.0_wp)
    else
      call extrapolate_piece(die, local, closest)
    end if
  end subroutine find_closest_point

  !> Closest point on the extrapolation of its piece.
  pure subroutine extrapolate_piece(die, local, closest)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: local(2)   !! point in the pilot's axes
    type(closest_point_t), intent(inout) :: closest
    type(offset_parabola_t) :: longer
    integer :: piece

    piece = closest%piece
    longer%points = die%pieces(:, :, piece)
    longer%range = [-beyond, beyond]
    call closest_within_piece(longer%points, local, closest_xi(longer, local), closest)
    closest%piece = piece
  end subroutine extrapolate_piece

end module die_closest_points
