!> How much of a step may be made until a point that comes into contact overlaps what it meets.
module contact_overlap
  use contact_state, only: at_penetration, at_piece, at_status
  use kinds, only: wp
  use law_api, only: contact_open
  implicit none
  private
  public :: share_of_way, share_to_contact

  !> A point that comes into contact may overlap the die by this share of the side in the predictor of a step.
  real(wp), parameter :: overlap_limit = 0.01_wp
  !> A step that is shortened for it aims at less, so that the next check does not depend on the last bit.
  real(wp), parameter :: overlap_aim = 0.008_wp

contains

  !> Share of the step after which a point that was open, its gap known, overlaps the die by `overlap_aim` of the side;
  !> one that overlaps by less than `overlap_limit` is left alone.
  pure function share_to_contact(committed, trial, side) result(share)
    real(wp), intent(in) :: committed(:), trial(:)   !! (nstate) [unit of each component]
    real(wp), intent(in) :: side                     !! length of the side [length]
    real(wp) :: share

    share = 1
    if (nint(committed(at_status)) /= contact_open .or. nint(trial(at_status)) == contact_open) return
    if (nint(committed(at_piece)) == 0) return
    share = share_of_way(-committed(at_penetration), trial(at_penetration), side)
  end function share_to_contact

  !> Share of the way from a gap at the start to a depth at the end of the step after which the overlap is `overlap_aim` of the
  !> side; the whole way where it ends below `overlap_limit`. Of a point that overlaps as the step begins, and was open (a new mesh
  !> has laid it deeper than the old one, and the multiplier that held it there without pressure ended as it opened), what the step
  !> adds: no shorter one avoids the rest.
  pure function share_of_way(gap, depth, side) result(share)
    real(wp), intent(in) :: gap, depth   !! [length]
    real(wp), intent(in) :: side         !! length of the side [length]
    real(wp) :: share
    real(wp) :: open, overlap

    share = 1
    open = max(gap, 0.0_wp)
    overlap = depth - max(-gap, 0.0_wp)
    if (overlap <= overlap_limit*side) return
    share = (open + overlap_aim*side)/(open + overlap)
  end function share_of_way

end module contact_overlap
