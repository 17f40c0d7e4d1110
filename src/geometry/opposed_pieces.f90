!> Pieces of a curve that a side of it may look at: near enough, and turned so that the side and the piece, or the vertex behind it,
!> can face each other. On a smooth body the pieces beside a side never are, so that most sides have none.
module opposed_pieces
  use curve_boxes, only: box_gap, start_at_root, wait_below, waiting_nodes_t
  use curve_search, only: opposed, slack_of
  use kinds, only: wp
  use parabolas, only: box_of_parabola, tangent_on
  use piecewise_curves, only: adjacent_piece, piecewise_curve_t
  use plane_vectors, only: angle_between
  use vectors, only: length_of
  implicit none
  private
  public :: list_opposed_pieces

  !> Angle between the tangents of a side and of a piece, walked as the curve is, up to which they look at each other, with room for
  !> round-off [radian].
  real(wp), parameter :: widest = acos(-opposed) + 1.0e-6_wp

contains

  !> Pieces on which `closest_opposed_point` may find something for points of a side, in ascending order.
  pure subroutine list_opposed_pieces(curve, side, reach, may, number, pieces)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: side(2, 3)   !! its nodes, walked against the curve [length]
    real(wp), intent(in) :: reach        !! [length]
    logical, intent(in) :: may(:)        !! (npiece) that the side may meet
    integer, intent(out) :: number
    integer, intent(out) :: pieces(:)    !! (npiece) the first `number` of them
    type(waiting_nodes_t) :: waiting
    real(wp) :: box(4), farthest, way(2), spread
    logical :: found(size(may))
    integer :: k, node

    found = .false.
    box = box_of_parabola(side)
    farthest = (reach + max(slack_of(curve, box(1:2)), slack_of(curve, box(3:4))))**2
    way = side(:, 3) - side(:, 1)
    spread = spread_about(way, tangent_on(side, -1.0_wp), tangent_on(side, 1.0_wp))
    call start_at_root(curve, box, waiting)
    do while (waiting%n > 0)
      node = waiting%node(waiting%n)
      waiting%n = waiting%n - 1
      if (waiting%gap(waiting%n + 1) > farthest) cycle
      k = node - size(curve%tree, 2)
      if (k <= 0) then
        call wait_below(curve, box, node, waiting)
      else if (may(k)) then
        found(k) = may_look_at(curve, k, way, spread)
      end if
    end do
    number = 0
    do k = 1, size(found)
      if (.not. found(k)) cycle
      number = number + 1
      pieces(number) = k
    end do
  end subroutine list_opposed_pieces

  !> Some tangent of the side and some tangent of a piece, or of the fans of its vertices, look at each other.
  pure function may_look_at(curve, piece, way, spread) result(yes)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece
    real(wp), intent(in) :: way(2)   !! of the side [length]
    real(wp), intent(in) :: spread   !! of the side's tangents about it [radian]
    logical :: yes
    real(wp) :: chord(2), own
    integer :: before, after

    before = adjacent_piece(curve, piece, -1)
    after = adjacent_piece(curve, piece, 1)
    associate (points => curve%pieces(:, :, piece))
      chord = points(:, 3) - points(:, 1)
      own = spread_about(chord, tangent_on(points, -1.0_wp), tangent_on(points, 1.0_wp))
    end associate
    if (before > 0) own = max(own, turn_from(chord, tangent_on(curve%pieces(:, :, before), 1.0_wp)))
    if (after > 0) own = max(own, turn_from(chord, tangent_on(curve%pieces(:, :, after), -1.0_wp)))
    yes = turn_from(chord, way) <= widest + spread + own
  end function may_look_at

  !> The largest angle between a chord and the tangents of its parabola, which turn from one end to the other [radian].
  pure function spread_about(chord, first, last) result(spread)
    real(wp), intent(in) :: chord(2), first(2), last(2)   !! [length]
    real(wp) :: spread

    spread = max(turn_from(chord, first), turn_from(chord, last))
  end function spread_about

  !> Angle between two directions; the largest there is where one has no length, and may be any [radian].
  pure function turn_from(one, other) result(angle)
    real(wp), intent(in) :: one(2), other(2)   !! [length]
    real(wp) :: angle

    angle = acos(-1.0_wp)
    if (length_of(one) > 0 .and. length_of(other) > 0) angle = abs(angle_between(one, other))
  end function turn_from

end module opposed_pieces
