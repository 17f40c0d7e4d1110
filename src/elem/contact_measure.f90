!> Measures of contact groups at an accepted instant, and their augmentation.
!>
!> The state of a point is that of contact_point; behind it there may be the same of a corner of the
!> die, and its position on the side (corner_contact).
module contact_measure
  use axis_contact, only: area_at_corner
  use contact_areas, only: area_of_point
  use contact_penalties, only: allowed_penetration, penalties_of_card, penalties_t
  use contact_point, only: dissipated, penalties
  use contact_state, only: at_augmentation, at_between, at_penetration, at_piece, at_pressure, at_status, at_work, at_xi, &
                           contact_block, is_released
  use contact_work, only: kept_work
  use corner_states, only: corner_before
  use corner_weights, only: corner_length
  use edge_states, only: augment_edges, beside_edges, interval_at_start
  use elem_api, only: totals_t
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip, contact_stick, law_t
  use quadrature, only: is_control_point, line_rule, rule_equidistant, rule_t
  use scene, only: group_t, scene_t
  use side_points, only: side_length
  use state_variables, only: find_variable
  implicit none
  private
  public :: augment, measure

  !> Augmentation removes the depth of points, not the curvature of the side between them: points that are deep by less than
  !> this share of the allowed penetration are not augmented further.
  real(wp), parameter :: worth_augmenting = 0.5_wp
  !> A corner of which no more than this acts needs ten times the pressure of others to hold the side, and more as it leaves.
  real(wp), parameter :: least_share = 0.1_wp

contains

  !> Uzawa: the pressure (or pull, of glue) reached becomes the multiplier, p = multiplier + AKP d, so that the same
  !> pressure needs no penetration any more. The side is judged at its points and between them. A point that has lost
  !> more than half of its pressure beyond a corner keeps its multiplier: the share that acts goes to zero, no pressure holds it.
  !> So does a corner of which hardly anything acts any more near an end of the side: the node there holds the side. Points beside
  !> an edge of another body are left to it: they are many, their areas small, and what one of them bore would be lost as it slides
  !> past.
  subroutine augment(scene, group, times, committed, trial, changed)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: times
    real(wp), intent(inout) :: committed(:, :, :)   !! (nstate, npoint, nside) [unit of each component]
    real(wp), intent(in) :: trial(:, :, :)          !! (nstate, npoint, nside) [unit of each component]
    logical, intent(out) :: changed
    type(penalties_t) :: given
    real(wp) :: allowed
    logical, dimension(size(trial, 2), size(trial, 3)) :: held
    integer :: e, k, last, n

    changed = .false.
    given = penalties_of_card(scene%materials(group%material))
    if (times >= given%augmentations .or. .not. given%allowed > 0) return
    n = contact_block(has_corners(group), size(trial, 1))
    last = merge(n, 0, has_corners(group))
    do k = 0, last, n
      held = may_hold(group, trial, k, n)
      do e = 1, size(trial, 3)
        if (changed) exit
        allowed = given%allowed*side_length(scene, group%connectivity(:, e))
        changed = any(deep(trial(k + 1:k + n, :, e)) > allowed .and. nint(trial(k + at_status, :, e)) /= contact_open &
                      .and. held(:, e))
        if (k > 0) cycle
        changed = changed .or. any(peaks(trial(:, :, e), group%rule, worth_augmenting*allowed) > allowed &
                                   .and. (held(:, e) .or. group%pairs == 0))
      end do
    end do
    if (.not. changed) return
    do k = 0, last, n
      held = may_hold(group, trial, k, n)
      if (k > 0 .and. group%pairs > 0) then
        do e = 1, size(trial, 3)
          call augment_edges(held(:, e), committed(:, :, e), trial(:, :, e))
        end do
      else
        where (held) committed(k + at_augmentation, :, :) = trial(k + at_pressure, :, :) - trial(k + at_between, :, :)
      end if
    end do
  end subroutine augment

  !> Points that are augmented, in the block of rows that follows row k.
  pure function may_hold(group, state, k, n) result(yes)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (nstate, npoint, nside) [unit of each component]
    integer, intent(in) :: k, n
    logical :: yes(size(state, 2), size(state, 3))
    real(wp), allocatable :: xi(:), weight(:)
    integer :: e

    yes = is_held(state, k, n)
    if (k > 0 .or. group%pairs == 0) return
    call line_rule(group%rule, xi, weight)
    do e = 1, size(yes, 2)
      yes(:, e) = yes(:, e) .and. .not. beside_edges(state(:, :, e), xi)
    end do
  end function may_hold

  !> Points whose pressure can hold the side where it is, in the block of rows that follows row k: the points themselves, or the
  !> corners of the die.
  pure function is_held(state, k, n) result(yes)
    real(wp), intent(in) :: state(:, :, :)   !! (nstate, npoint, nside) [unit of each component]
    integer, intent(in) :: k, n
    logical :: yes(size(state, 2), size(state, 3))

    yes = .not. is_released(state(k + at_xi, :, :))
    if (k > 0) yes = yes .and. state(k + n + 2, :, :) > least_share
  end function is_held

  !> Depth of points, and height of those that their multipliers hold over the die.
  pure function deep(state) result(depth)
    real(wp), intent(in) :: state(:, :)   !! (nstate, npoint) [unit of each component]
    real(wp) :: depth(size(state, 2))     !! [length]

    depth = abs(state(at_penetration, :))
  end function deep

  !> Corners of the die are points of contact of their own.
  pure function has_corners(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = find_variable(group%variables, 'corner_place') > 0
  end function has_corners

  !> Depth of the side at its points in contact or beside them: the top of the parabola through three points at equal
  !> distances, when it lies between them; zero elsewhere.
  pure function peaks(state, rule, least) result(depth)
    real(wp), intent(in) :: state(:, :)
    type(rule_t), intent(in) :: rule
    real(wp), intent(in) :: least   !! depth of a point that is judged [length]
    real(wp) :: depth(size(state, 2))
    real(wp) :: slope, bend
    integer :: p

    depth = 0
    if (rule%family /= rule_equidistant) return
    do p = 2, size(state, 2) - 1
      if (nint(state(at_status, p)) == contact_open .or. .not. state(at_penetration, p) > least) cycle
      if (any(nint(state(at_piece, p - 1:p + 1)) == 0)) cycle
      slope = 0.5_wp*(state(at_penetration, p + 1) - state(at_penetration, p - 1))
      bend = state(at_penetration, p + 1) - 2*state(at_penetration, p) + state(at_penetration, p - 1)
      if (abs(slope) < -bend) depth(p) = state(at_penetration, p) - 0.5_wp*slope**2/bend
    end do
  end function peaks

  !> Friction work, penetration found and allowed, number of points in each contact state. What a control point has is no depth of
  !> the side; nor is there a die where a point is beyond the corner of its face.
  subroutine measure(scene, group, law, section, penalty_share, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: section(3)        !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: penalty_share     !! of penalties that follow from an allowed penetration (soft_penalties) [-]
    real(wp), intent(in) :: x(:, :, :)        !! (2, 3, nside) [length]
    real(wp), intent(in) :: state(:, :, :)    !! (nstate, npoint, nside) [unit of each component]
    real(wp), intent(in) :: before(:, :, :)   !! (nstate, npoint, nside) one step before [unit of each component]
    type(totals_t), intent(out) :: totals
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: side, penalty(2), begun(contact_block(has_corners(group), size(state, 1)))
    integer :: e, p, q, n
    logical :: corners

    call line_rule(group%rule, xi, weight)
    corners = has_corners(group)
    n = contact_block(corners, size(state, 1))
    do e = 1, size(x, 3)
      side = side_length(scene, group%connectivity(:, e))
      penalty = penalties(scene%materials(group%material), group, side, penalty_share)
      do p = 1, size(xi)
        select case (nint(state(at_status, p, e)))
        case (contact_stick)
          totals%stick = totals%stick + 1
        case (contact_slip)
          totals%slip = totals%slip + 1
        case default
          totals%open = totals%open + 1
        end select
        call add_point(state(:n, p, e), before(:n, p, e), before(:n, p, e), &
                       area_of_point(group%rule, xi, weight, p, section, x(:, :, e)), is_control_point(group%rule, p), &
                       [1.0_wp, 1.0_wp])
        if (.not. corners) cycle
        q = p
        if (group%pairs > 0) q = interval_at_start(before(:, :, e), state(:, :, e), p)
        if (q == 0) cycle
        begun = before(n + 1:2*n, q, e)
        if (group%pairs == 0) begun = corner_before(before(:, :, e), state(:, :, e), p)
        call add_point(state(n + 1:2*n, p, e), before(n + 1:2*n, q, e), begun, &
                       area_at_corner(state(2*n + 1, p, e), corner_length(xi, p, group%pairs > 0), section, x(:, :, e), side), &
                       .false., &
                       [before(2*n + 2, q, e), state(2*n + 2, p, e)])
      end do
    end do

  contains

    !> Penetration and friction of a point of side e, or of a corner, which may have begun the step in another interval.
    subroutine add_point(now, old, begun, area, control, share)
      real(wp), intent(in) :: now(:), old(:), begun(:), area
      logical, intent(in) :: control
      real(wp), intent(in) :: share(2)   ! of pressure and friction that acts before and now
      real(wp) :: allowed, lost

      allowed = allowed_penetration(scene%materials(group%material))*side
      if (nint(now(at_status)) /= contact_open .and. share(2) > least_share .and. .not. (control .or. is_released(now(at_xi)))) then
        totals%max_penetration = max(totals%max_penetration, now(at_penetration))
        if (allowed > 0) totals%penetration_ratio = max(totals%penetration_ratio, now(at_penetration)/allowed)
      end if
      lost = dissipated(begun, now, penalty(2))
      totals%friction_work = totals%friction_work + area*now(at_work)
      totals%contact_work = totals%contact_work + area*kept_work(old, now, penalty, share)
      totals%least_dissipation = min(totals%least_dissipation, lost)
    end subroutine add_point

  end subroutine measure

end module contact_measure
