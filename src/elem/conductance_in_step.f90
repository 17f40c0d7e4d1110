!> Conductances of heat through contact within a step, between those at its ends.
module conductance_in_step
  use heat_contact_point, only: facing_t
  use heat_contacts, only: conductance_of, heat_contact_t
  use kinds, only: wp
  implicit none
  private
  public :: conductance_within

  !> Conductances at both ends of a step are alike where they differ by less than this share of them.
  real(wp), parameter :: least_change = 1.0e-6_wp

contains

  !> Conductances of a point within the step: pressure and gap are linear in time, and what they make goes from that of the start to
  !> that of the end as they say. A point that opens or closes does so where the gap passes 0, its depth counting as one. What is
  !> handed over for the end (exchange_in_turns) may be off what contact has reached: of that only how far it has come counts.
  pure function conductance_within(contact, facing, share) result(h)
    type(heat_contact_t), intent(in) :: contact
    type(facing_t), intent(in) :: facing
    real(wp), intent(in) :: share   !! of the step [-]
    real(wp) :: h(2)                !! as conductance_of
    real(wp) :: first(2), now(2), last(2), come
    integer :: c

    h = (1 - share)*facing%conductance(:, 1) + share*facing%conductance(:, 2)
    if (.not. facing%followed .or. share <= 0 .or. share >= 1) return
    first = conductance_on_path(contact, facing, 0.0_wp)
    now = conductance_on_path(contact, facing, share)
    last = conductance_on_path(contact, facing, 1.0_wp)
    do c = 1, 2
      if (.not. abs(last(c) - first(c)) > least_change*max(abs(first(c)), abs(last(c)))) cycle
      come = min(max((now(c) - first(c))/(last(c) - first(c)), 0.0_wp), 1.0_wp)
      h(c) = (1 - come)*facing%conductance(c, 1) + come*facing%conductance(c, 2)
    end do
  end function conductance_within

  !> Conductances by the pressure or the gap after a share of the step, both linear in time.
  pure function conductance_on_path(contact, facing, share) result(h)
    type(heat_contact_t), intent(in) :: contact
    type(facing_t), intent(in) :: facing
    real(wp), intent(in) :: share   !! of the step [-]
    real(wp) :: h(2)                !! as conductance_of
    real(wp) :: distance(2), meets, part
    integer :: k

    if (facing%closed(1) .eqv. facing%closed(2)) then
      h = conductance_of(contact, facing%closed(1), (1 - share)*facing%pressure(1) + share*facing%pressure(2), &
                         (1 - share)*facing%gap(1) + share*facing%gap(2))
      return
    end if
    distance = abs(facing%gap)
    meets = 0.5_wp
    if (sum(distance) > 0) meets = distance(1)/sum(distance)
    k = merge(1, 2, share < meets .or. .not. share > 0)
    ! how much is left to where it opens or closes
    part = 1
    if (k == 1 .and. meets > 0) part = 1 - share/meets
    if (k == 2 .and. meets < 1) part = (share - meets)/(1 - meets)
    h = conductance_of(contact, facing%closed(k), part*facing%pressure(k), part*facing%gap(k))
  end function conductance_on_path

end module conductance_in_step
