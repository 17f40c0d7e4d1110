!> The force between a point of a side in contact and what it meets, with all derivatives.
!>
!> What is met enters by its motion alone: depth, slip, and the turn of the normal. Local unknowns: side_points.
module contact_point
  use contact_penalties, only: penalties_of_card, penalties_t
  use contact_state, only: at_augmentation, at_penetration, at_pressure, at_slip, at_status, at_tau, at_work, npoint_state
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip, law_t
  use materials, only: material_t
  use scene, only: group_t
  use side_points, only: contact_point_t, most_unknowns
  implicit none
  private
  public :: meeting_t, act, answer, dissipated, penalties, usual_bearing

  !> Pressure over Young's modulus at which the whole penalties that follow from an allowed penetration make that penetration.
  real(wp), parameter :: usual_bearing = 0.01_wp

  !> How the point meets the die: depth and slip of the step [length], inner normal of the die, and the
  !> derivatives of all three; the normal n turns by `turn`, dn = turn t with the tangent t.
  type :: meeting_t
    real(wp) :: d, slip, normal(2)
    !> Depth that needs no pressure [length].
    real(wp) :: allowed = 0.0_wp
    !> Share of the area that bears the pressure: friction is that of the pressure there [-].
    real(wp) :: bearing = 1.0_wp
    !> A point in contact at the start of the step follows its law linearised at the depth it had then (instant_t).
    logical :: kept = .false.
    !> Share of the penalties of a point without a pressure at the start of the step (instant_t) [-].
    real(wp) :: penalty_share = 1.0_wp
    real(wp), dimension(most_unknowns) :: dd, dslip, turn
  end type meeting_t

contains

  !> Force on what is met, the opposite of that on the side: traction p n + tau t times length, weight and
  !> thickness. The state of the point goes on from committed to trial.
  pure subroutine act(law, material, dt, drivers, penalty, point, meeting, weight, tangent_wanted, committed, trial, q, dq)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt              !! length of the step [time]
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law at both ends of the step [unit of each driver]
    real(wp), intent(in) :: penalty(2)      !! normal and tangential [stress/length]
    type(contact_point_t), intent(in) :: point
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: weight
    logical, intent(in) :: tangent_wanted
    real(wp), intent(in) :: committed(:)            !! (nstate) [unit of each component]
    real(wp), intent(inout) :: trial(:)             !! (nstate) [unit of each component]
    real(wp), intent(out) :: q(2)                   !! per radian when axisymmetric [force]
    real(wp), intent(out) :: dq(2, most_unknowns)   !! set where the tangent is wanted and there is contact [force/unknown]
    real(wp) :: dslip(most_unknowns), t(2), pressure, tau, law_tangent(2, 2), area, traction(2), dp, dtau
    logical :: open
    integer :: j

    q = 0
    call answer(law, material, dt, drivers, penalty, meeting, committed, trial, pressure, tau, law_tangent, dslip, open)
    if (open) return

    t = [-meeting%normal(2), meeting%normal(1)]
    area = point%length*weight*point%thickness
    traction = -(pressure*meeting%normal + tau*t)
    q = traction*area
    if (.not. tangent_wanted) return
    do j = 1, most_unknowns
      dp = law_tangent(1, 1)*meeting%dd(j) + law_tangent(1, 2)*dslip(j)
      dtau = law_tangent(2, 1)*meeting%dd(j) + law_tangent(2, 2)*dslip(j)
      dq(:, j) = -(dp*meeting%normal + dtau*t + meeting%turn(j)*(pressure*t - tau*meeting%normal))*area &
                 + traction*weight*(point%dlength(j)*point%thickness + point%length*point%dthickness(j))
    end do
  end subroutine act

  !> Pressure and friction of a meeting, and their derivatives by depth and slip; the state of the point goes on from committed to
  !> trial.
  !>
  !> When contact begins inside the step only the share d/(d - d_start) of the way counts as slip, with the depth d that the penalty
  !> needs for the pressure: what a multiplier has taken of it is in there, for it takes nothing of the way. (With the depth that is
  !> left the share would go to 0 as multipliers are carried forward, and all of the slip would count beyond depth 0.)
  pure subroutine answer(law, material, dt, drivers, penalty, meeting, committed, trial, pressure, tau, tangent, dslip, open)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt              !! length of the step [time]
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law at both ends of the step [unit of each driver]
    real(wp), intent(in) :: penalty(2)      !! normal and tangential [stress/length]
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: committed(:)    !! (nstate) [unit of each component]
    real(wp), intent(inout) :: trial(:)     !! (nstate) [unit of each component]
    real(wp), intent(out) :: pressure, tau   !! [stress]
    real(wp), intent(out) :: tangent(2, 2)   !! of both by depth and slip [stress/length]
    real(wp), intent(out) :: dslip(most_unknowns)   !! derivatives of the slip that counts [length/unknown]
    logical, intent(out) :: open
    real(wp) :: slip, depth, gap, reached, share, stiffness(2), stress(2), law_tangent(3, 3), change
    integer :: status

    stiffness = penalty
    if (.not. committed(at_pressure) > 0) stiffness = meeting%penalty_share*penalty
    slip = meeting%slip
    dslip = meeting%dslip
    depth = meeting%d - meeting%allowed
    gap = meeting%allowed - committed(at_penetration)
    reached = depth
    if (committed(at_augmentation) > 0) reached = depth + committed(at_augmentation)/stiffness(1)
    if (nint(committed(at_status)) == contact_open .and. gap > 0 .and. reached > 0) then
      share = reached/(reached + gap)
      dslip = share*dslip + slip*gap/(reached + gap)**2*meeting%dd
      slip = share*slip
    end if

    ! of the depth since the start of the step, where the law is linearised there
    change = 0
    if (meeting%kept .and. nint(committed(at_status)) /= contact_open) then
      change = depth - (committed(at_penetration) - meeting%allowed)
      depth = committed(at_penetration) - meeting%allowed
    end if
    ! nothing moves across the plane: the second tangential component stays at rest
    associate (bearing => meeting%bearing)
      call law%slide(material, dt, drivers, stiffness/bearing, committed(at_augmentation)/bearing, depth, [slip, 0.0_wp], &
                     [committed(at_tau)/bearing, 0.0_wp], committed(npoint_state + 1:), pressure, stress, &
                     trial(npoint_state + 1:), law_tangent, status)
      pressure = bearing*(pressure + law_tangent(1, 1)*change)
      tau = bearing*(stress(1) + law_tangent(2, 1)*change)
      tangent = bearing*law_tangent(:2, :2)
    end associate
    trial(at_pressure) = pressure
    trial(at_tau) = tau
    trial(at_status) = status
    open = status == contact_open
    if (open) return
    trial(at_augmentation) = committed(at_augmentation)
    trial(at_slip) = committed(at_slip) + slip
    trial(at_work) = trial(at_work) + dissipated(committed, trial, stiffness(2))
  end subroutine answer

  !> Work that friction took in a step, per present area: the part of the slip that the tangential penalty does not store.
  pure function dissipated(before, after, penalty) result(work)
    real(wp), intent(in) :: before(:), after(:)   !! (nstate) [unit of each component]
    real(wp), intent(in) :: penalty               !! tangential [stress/length]
    real(wp) :: work

    work = 0
    if (nint(after(at_status)) /= contact_slip) return
    work = after(at_tau)*(after(at_slip) - before(at_slip) - (after(at_tau) - before(at_tau))/penalty)
  end function dissipated

  !> Normal and tangential penalty of a group of contact: as given, or such that a pressure of one hundredth of the
  !> modulus of the group makes the allowed penetration, times a share for light contact, and a share of that.
  pure function penalties(material, group, side, light) result(penalty)
    type(material_t), intent(in) :: material
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: side    !! [length]
    real(wp), intent(in) :: light   !! share of penalties that follow from an allowed penetration (soft_penalties) [-]
    real(wp) :: penalty(2)
    type(penalties_t) :: given

    given = penalties_of_card(material)
    penalty(1) = given%normal
    if (.not. penalty(1) > 0) penalty(1) = min(light, group%most_share)*usual_bearing*group%modulus/(given%allowed*side)
    penalty(2) = given%tangential
    if (.not. penalty(2) > 0) penalty(2) = group%tangential_share*penalty(1)
  end function penalties

end module contact_point
