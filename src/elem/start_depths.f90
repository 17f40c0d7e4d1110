!> Depth that places of a side had in a rigid die as the step began, where no state knows it: in the first step of a run, and where
!> a part comes from farther off than contact is looked for.
!>
!> Of the slip of a step in which contact begins only the share counts that is made in contact (contact_point), and that follows
!> from the gap there was. Without it a die that comes down on a part along its normal would rub it by all of its way, times the
!> tilt of the die there: enough for all of its friction, in a direction that changes sign where two pieces of the die meet.
module start_depths
  use closest_point, only: closest_point_t
  use contact_scan, only: closest_to_side_point
  use contact_state, only: at_penetration, at_piece, at_status
  use dies, only: die_t
  use kinds, only: wp
  use law_api, only: contact_open
  use rigid_contact, only: nodes_in_axes, side_at_start, side_t
  implicit none
  private
  public :: find_depth_at_start, state_at_start

contains

  !> State of a place as the step began, with its depth.
  pure function state_at_start(die, side, place, committed) result(state)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place          !! [-]
    real(wp), intent(in) :: committed(:)   !! (nstate) [unit of each component]
    real(wp) :: state(size(committed))     !! (nstate) [unit of each component]

    state = committed
    if (nint(state(at_status)) /= contact_open .or. nint(state(at_piece)) /= 0) return
    state(at_penetration) = find_depth_at_start(die, side, place)
  end function state_at_start

  !> Depth of a place at the start of the step; a side's length out of the die where nothing is nearer.
  pure function find_depth_at_start(die, side, place) result(depth)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place      !! [-]
    real(wp) :: depth                  !! [length]
    type(closest_point_t) :: closest

    call closest_to_side_point(die, nodes_in_axes(side_at_start(side)), place, side%length, closest)
    depth = -side%length
    if (closest%piece > 0) depth = closest%d
  end function find_depth_at_start

end module start_depths
