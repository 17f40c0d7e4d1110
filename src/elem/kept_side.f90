!> The side of another body that a point of contact keeps for the length of a step.
module kept_side
  use closest_point, only: closest_point_t
  use contact_state, only: at_piece, at_status
  use corner_faces, only: closest_on_piece
  use dies, only: die_t, edge_turn
  use kinds, only: wp
  use law_api, only: contact_open
  use pairs, only: pieces_in_reach, place_in_reach
  use piecewise_curves, only: adjacent_piece
  use plane_vectors, only: cross
  use side_points, only: contact_point_t
  implicit none
  private
  public :: beyond_all, handed_over_t, keep_closest_point

  !> A side reaches this far beyond its ends (parent coordinate) for a point that was on it; beyond the open end of the curve less.
  real(wp), parameter :: beyond = 0.2_wp, beyond_all = 0.075_wp
  !> From this parent coordinate on it hands over a point that was in contact; all the way of one that was not begins at its end.
  real(wp), parameter :: hands_over = 1.1_wp

  !> Share of a point that is on the side where it is now, and its change with the parent coordinate on that it began with [-].
  type :: handed_over_t
    real(wp) :: share = 0.0_wp, slope = 0.0_wp
  end type handed_over_t

contains

  !> Closest point to a point of contact; but for the length of a step the point keeps the side it began with, beyond its ends too.
  !>
  !> Sides of a bent mesh make slight corners, less slight where a node presses beside them, and the normal jumps there within a
  !> motion smaller than any iteration's: points at a corner would change sides without end. Likewise points at the open end of the
  !> curve, where two bodies are flush: round-off would decide whether they are on it, also those whose multiplier bears a pressure
  !> at a gap; and where a node presses in the ground of a notch that it has made, with one face steep. Other corners as sharp as
  !> an edge are left to the search.
  !>
  !> Which side it is depends on where the point is alone, not on the sign of its depth: both sides have another depth beyond the
  !> corner, and one that has met the die in the step, with its multiplier at a depth of 0, would change sides there.
  pure subroutine keep_closest_point(die, point, reach, committed, middle, nearest, closest, handed)
    type(die_t), intent(in) :: die
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: reach
    real(wp), intent(in) :: committed(:)   !! (nstate) of the point [unit of each component]
    integer, intent(in) :: middle    !! middle piece of the point's pairs, 0 for none
    type(closest_point_t), intent(inout) :: nearest   !! where the next step begins
    type(closest_point_t), intent(out) :: closest     !! of this step
    type(handed_over_t), intent(out) :: handed
    type(closest_point_t) :: same
    real(wp) :: from, way(2)
    integer :: piece
    logical :: pressed

    closest = nearest
    pressed = nint(committed(at_status)) /= contact_open
    piece = nint(committed(at_piece))
    if (piece == 0) piece = middle
    if (piece == 0) return
    from = closest%xi
    if (closest%piece /= piece) from = merge(1.0_wp, -1.0_wp, place_in_reach(die, piece, closest%piece) == pieces_in_reach)
    if (closest%piece == 0) then
      from = merge(1.0_wp, -1.0_wp, piece == size(die%nodes, 2))
      if (adjacent_piece(die, piece, nint(from)) /= 0) return
    end if
    call closest_on_piece(die, piece, point%x, from, merge(beyond_all, beyond, closest%piece == 0), same)
    if (same%piece == 0 .or. .not. abs(same%d) < reach) return
    if (closest%piece == 0) then
      if (.not. dot_product(same%normal, point%e_r) < 0) return
      nearest = same
    else
      if (place_in_reach(die, closest%piece, piece) == 0) return
      if (dot_product(same%normal, closest%normal) < edge_turn .and. .not. (pressed .and. turns_to_part())) return
      way = merge([hands_over, 1 + beyond], [1.0_wp, hands_over], pressed)
      if (closest%piece /= piece) handed%share = (abs(same%xi) - way(1))/(way(2) - way(1))
      if (.not. handed%share < 1) then
        handed%share = 0
        return
      end if
      handed%share = max(0.0_wp, handed%share)
      handed%slope = sign(1/(way(2) - way(1)), same%xi)
    end if
    closest = same

  contains

    !> The die turns toward the part from the side that the point began with to the one where it is the closest.
    pure function turns_to_part() result(yes)
      logical :: yes
      real(wp) :: turn

      turn = cross(same%normal, closest%normal)
      if (closest%piece == adjacent_piece(die, piece, -1)) turn = -turn
      yes = closest%piece /= piece .and. turn > 0
    end function turns_to_part
  end subroutine keep_closest_point

end module kept_side
