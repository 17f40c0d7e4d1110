!> What contact groups say of themselves at an accepted instant, and their augmentation.
!>
!> The state of a point is that of contact_point; behind it there may be the same of a corner of the
!> die, and its place on the side (corner_contact).
module contact_measure
  use contact_point, only: area_at, at_augmentation, at_penetration, at_piece, at_pressure, at_status, at_work, dissipated, &
                           npoint_state, penalties, side_length
  use corner_contact, only: at_place, stretch_before
  use elem_api, only: totals_t
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip, contact_stick, law_t
  use quadrature, only: line_rule
  use scene, only: group_t, scene_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: augment, measure

  !> Place of the largest number of augmentations among a contact law's values (contact_penalties).
  integer, parameter :: at_augment = 4
  !> Augmentation takes away the depth of points, not the bend of the side between them: points that are deep by less than
  !> this share of the allowed penetration have no more to give.
  real(wp), parameter :: worth_augmenting = 0.5_wp

contains

  !> Uzawa: the pressure (or pull, of glue) reached becomes the multiplier, p = multiplier + AKP d, so that the same
  !> pressure needs no penetration any more. The side is judged at its points and between them.
  subroutine augment(scene, group, times, committed, trial, changed)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: times
    real(wp), intent(inout) :: committed(:, :, :)
    real(wp), intent(in) :: trial(:, :, :)
    logical, intent(out) :: changed
    real(wp) :: allowed
    integer :: e, k

    changed = .false.
    associate (values => scene%materials(group%material)%values)
      if (times >= nint(values(at_augment)) .or. .not. values(1) > 0) return
      do e = 1, size(trial, 3)
        allowed = values(1)*side_length(scene, group%connectivity(:, e))
        do k = 0, last_block(group), npoint_state
          changed = changed .or. any(abs(trial(k + at_penetration, :, e)) > allowed &
                                     .and. nint(trial(k + at_status, :, e)) /= contact_open)
        end do
        changed = changed .or. any(peaks(trial(:, :, e), group%npoint, worth_augmenting*allowed) > allowed)
      end do
    end associate
    if (.not. changed) return
    do k = 0, last_block(group), npoint_state
      committed(k + at_augmentation, :, :) = trial(k + at_pressure, :, :)
    end do
  end subroutine augment

  !> Where the last block of a point's state begins: that of its corner, or its own.
  pure function last_block(group) result(k)
    type(group_t), intent(in) :: group
    integer :: k

    k = merge(npoint_state, 0, find_variable(group%variables, 'corner_place') > 0)
  end function last_block

  !> Depth of the side at its points in contact or beside them: the top of the parabola through three points at equal
  !> distances, when it lies between them; zero elsewhere.
  pure function peaks(state, npoint, least) result(depth)
    real(wp), intent(in) :: state(:, :)
    integer, intent(in) :: npoint
    real(wp), intent(in) :: least   !! depth of a point that is judged [length]
    real(wp) :: depth(size(state, 2))
    real(wp) :: slope, bend
    integer :: p

    depth = 0
    if (npoint > 0) return
    do p = 2, size(state, 2) - 1
      if (nint(state(at_status, p)) == contact_open .or. .not. state(at_penetration, p) > least) cycle
      if (any(nint(state(at_piece, p - 1:p + 1)) == 0)) cycle
      slope = 0.5_wp*(state(at_penetration, p + 1) - state(at_penetration, p - 1))
      bend = state(at_penetration, p + 1) - 2*state(at_penetration, p) + state(at_penetration, p - 1)
      if (abs(slope) < -bend) depth(p) = state(at_penetration, p) - 0.5_wp*slope**2/bend
    end do
  end function peaks

  !> Friction work, penetration found and allowed, number of points in each contact state.
  subroutine measure(scene, group, law, section, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: section(3), x(:, :, :), state(:, :, :), before(:, :, :)
    type(totals_t), intent(out) :: totals
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: side, penalty(2), from, to
    integer :: e, p
    logical :: corners

    call line_rule(group%npoint, xi, weight)
    corners = last_block(group) > 0
    do e = 1, size(x, 3)
      side = side_length(scene, group%connectivity(:, e))
      penalty = penalties(scene%materials(group%material), group%amplitude, side)
      do p = 1, size(xi)
        select case (nint(state(at_status, p, e)))
        case (contact_stick)
          totals%stick = totals%stick + 1
        case (contact_slip)
          totals%slip = totals%slip + 1
        case default
          totals%open = totals%open + 1
        end select
        call add_point(state(:npoint_state, p, e), before(:npoint_state, p, e), xi(p), weight(p))
        if (.not. corners) cycle
        call stretch_before(xi, p, from, to)
        call add_point(state(npoint_state + 1:2*npoint_state, p, e), before(npoint_state + 1:2*npoint_state, p, e), &
                       state(at_place, p, e), to - from)
      end do
    end do

  contains

    !> Penetration and friction of a point of side e.
    subroutine add_point(now, old, place, share)
      real(wp), intent(in) :: now(:), old(:), place, share
      real(wp) :: allowed

      allowed = scene%materials(group%material)%values(1)*side
      if (nint(now(at_status)) /= contact_open) then
        totals%max_penetration = max(totals%max_penetration, now(at_penetration))
        if (allowed > 0) totals%penetration_ratio = max(totals%penetration_ratio, now(at_penetration)/allowed)
      end if
      totals%friction_work = totals%friction_work + area_at(place, section, x(:, :, e))*share*now(at_work)
      totals%least_dissipation = min(totals%least_dissipation, dissipated(old, now, penalty(2)))
    end subroutine add_point

  end subroutine measure

end module contact_measure
