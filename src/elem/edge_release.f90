!> A point of the side that slides past an edge from the face that presses it loses its pressure steadily, as on a rigid die
!> (corner_release): the face goes on beyond its end. With a multiplier and no depth there would be no normal: that of the fan at
!> the edge turns by a right angle within no way at all.
!>
!> The side may rise beside the edge as it turns round it. What is left of the face is no wall that it rises into: with the share s
!> of the pressure the depth that acts is at most a/(1 - s), with the penetration a that is allowed. So the penalty presses with no
!> more than AKP a s/(1 - s), which is none at the end of the way, and all that the depth makes at its beginning.
!>
!> Beyond the open end of the curve its last side goes on a little way, for bodies that are flush there (kept_side). On the last
!> third of that way a point loses its pressure steadily: one that ended at once would leave positions without equilibrium.
module edge_release
  use closest_point, only: closest_point_t, past_end
  use contact_state, only: at_piece, at_status
  use corner_faces, only: closest_on_piece
  use corner_weights, only: handing_over
  use dies, only: die_t
  use kept_side, only: beyond_all
  use kinds, only: wp
  use law_api, only: contact_open
  use piecewise_curves, only: adjacent_piece
  use vectors, only: length_of
  implicit none
  private
  public :: edge_release_t, slide_past_edge, slide_past_end

  !> A point on the other face of an edge is on its own as long as it is less deep than this share of its side.
  real(wp), parameter :: shallow = 0.01_wp
  !> Bodies that are flush bear on each other in full up to here beyond the open end of the curve [-].
  real(wp), parameter :: flush = 2.0_wp/3*beyond_all

  !> What is left of the pressure of a point beyond an edge, and its change with the parent coordinate on the face [-].
  type :: edge_release_t
    real(wp) :: share = 1.0_wp, slope = 0.0_wp
    !> The depth that acts is this one, and its change with that coordinate, where it is less than that of the point [length].
    real(wp) :: depth = 0.0_wp, depth_slope = 0.0_wp
    logical :: limited = .false.
  end type edge_release_t

contains

  !> A point that one face of an edge pressed as the step began is on it still, beside or beyond the edge, and loses its pressure on
  !> the way; `closest` stays where that is not so.
  pure subroutine slide_past_edge(first, die, point, length, allowed, committed, nearest, closest, release)
    real(wp), intent(in) :: first(:, :)    !! (2, nnode) nodes of the mesh as it began [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)       !! [length]
    real(wp), intent(in) :: length         !! of the side of the point [length]
    real(wp), intent(in) :: allowed        !! penetration, 0 for none stated [length]
    real(wp), intent(in) :: committed(:)   !! (nstate) of the point [unit of each component]
    type(closest_point_t), intent(inout) :: nearest   !! where the next step begins
    type(closest_point_t), intent(inout) :: closest   !! of this step
    type(edge_release_t), intent(out) :: release
    type(closest_point_t) :: found
    real(wp) :: end, beyond
    integer :: k, face, other
    logical :: inside

    face = nint(committed(at_piece))
    if (face == 0 .or. nint(committed(at_status)) == contact_open) return
    do k = 1, size(die%corners, 2)
      end = 1
      other = adjacent_piece(die, die%corner_piece(k), 1)
      if (face == other) then
        end = -1
        other = die%corner_piece(k)
      else if (face /= die%corner_piece(k)) then
        cycle
      end if
      inside = closest%piece > 0 .and. closest%d > 0
      if (inside .and. closest%piece /= other) cycle
      ! the way of corner_release, in the parent coordinate on the face
      beyond = handing_over*length/length_of(first(:, die%nodes(3, face)) - first(:, die%nodes(1, face)))
      call closest_on_piece(die, face, point, end, beyond, found)
      if (found%piece == 0) then
        ! neither the fan of the edge nor its other face takes over what is left of a multiplier
        if (.not. inside .and. (closest%piece == other .or. closest%at_vertex .and. closest%piece == die%corner_piece(k))) &
          release%share = 0
        cycle
      end if
      if (inside .and. .not. abs(found%d) < shallow*length) cycle
      if (.not. end*found%xi > 1) then
        if (.not. inside) cycle
        closest = found
        nearest = found
        return
      end if
      release%slope = -end/beyond
      release%share = max(0.0_wp, 1 + release%slope*(found%xi - end))
      release%limited = allowed > 0 .and. found%d*(1 - release%share) > allowed
      if (release%limited) then
        release%depth = allowed/(1 - release%share)
        release%depth_slope = release%depth*release%slope/(1 - release%share)
      end if
      closest = found
      nearest = found
      ! the state of the point is beyond the end of the face, where there is no die to be deep in (is_released)
      nearest%xi = sign(past_end, end)
      return
    end do
  end subroutine slide_past_edge

  !> A point beyond the open end of the curve loses its pressure on the way.
  pure subroutine slide_past_end(die, closest, release)
    type(die_t), intent(in) :: die
    type(closest_point_t), intent(in) :: closest    !! on the piece, or as far beyond its end as that goes on
    type(edge_release_t), intent(inout) :: release

    if (closest%piece == 0) return
    if (.not. abs(closest%xi) > 1 + flush) return
    if (adjacent_piece(die, closest%piece, nint(sign(1.0_wp, closest%xi))) /= 0) return
    release%slope = -sign(1.0_wp, closest%xi)/(beyond_all - flush)
    release%share = max(0.0_wp, 1 - (abs(closest%xi) - 1 - flush)/(beyond_all - flush))
  end subroutine slide_past_end

end module edge_release
