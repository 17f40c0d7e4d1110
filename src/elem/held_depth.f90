!> The depth of points that see a side along its whole length (rule_along): held near half of the penetration allowed.
!>
!> A side that cannot follow the bend of a die rests on it in a few places, each of which carries the force of a large part of the
!> side: with the penalty of a uniform pressure it would be as many times deeper. So, with the allowed penetration a,
!>
!>     p = multiplier + AKP D,   D = d where d <= a/2, else d + 9 (d - a/2)
!>
!> and with each accepted step the multiplier takes what AKP D is beyond AKP a/2, so that the point comes back to that depth in the
!> next step and not in further iterations of this one. Where a point is lifted, d < 0, the multiplier gives way. Between the two
!> it stays: where a side follows its die no point has one, and the pressures are those of the penalty. Multipliers that were taken
!> back wherever the depth is below a/2 would keep no pattern of pressures that makes no force at the nodes, but a fold rolls on
!> them from one point to the next in every step, and stalls. Source of multipliers that are updated before a minimum is exact:
!> D. P. Bertsekas, Constrained Optimization and Lagrange Multiplier Methods, Academic Press 1982, chapter 2.
module held_depth
  use contact_penalties, only: allowed_penetration
  use kinds, only: wp
  use materials, only: material_t
  use quadrature, only: rule_along, rule_t
  implicit none
  private
  public :: soft_depth, stiffened, next_multiplier

  !> Half of the penetration allowed.
  real(wp), parameter :: soft_share = 0.5_wp
  !> Penalty beyond it over that before.
  real(wp), parameter :: stiffer = 10.0_wp

contains

  !> Depth up to which AKP is the penalty; 0: anywhere, with other rules and where a penalty is given instead.
  pure function soft_depth(rule, material, length) result(depth)
    type(rule_t), intent(in) :: rule
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: length   !! of the side [length]
    real(wp) :: depth                !! [length]

    depth = 0
    if (rule%family == rule_along) depth = soft_share*allowed_penetration(material)*length
  end function soft_depth

  !> Pressure without multiplier over AKP, and its derivative by the depth.
  pure subroutine stiffened(d, soft, depth, slope)
    real(wp), intent(in) :: d        !! [length]
    real(wp), intent(in) :: soft     !! of soft_depth [length]
    real(wp), intent(out) :: depth   !! [length]
    real(wp), intent(out) :: slope   !! [-]

    depth = d
    slope = 1
    if (.not. (soft > 0 .and. d > soft)) return
    depth = d + (stiffer - 1)*(d - soft)
    slope = stiffer
  end subroutine stiffened

  !> Multiplier for the next step.
  pure function next_multiplier(multiplier, penalty, depth, soft) result(next)
    real(wp), intent(in) :: multiplier   !! in this step [stress]
    real(wp), intent(in) :: penalty      !! AKP [stress/length]
    real(wp), intent(in) :: depth        !! D, of stiffened [length]
    real(wp), intent(in) :: soft         !! a/2, of soft_depth [length]
    real(wp) :: next                     !! [stress]

    next = multiplier
    if (soft > 0) next = multiplier + penalty*(min(depth, 0.0_wp) + max(depth - soft, 0.0_wp))
  end function next_multiplier

end module held_depth
