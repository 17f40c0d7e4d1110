!> The cheapest fineness for an accuracy, by the laws of its errors (accuracy_laws).
module fineness_choice
  use accuracy_laws, only: accuracy_law_t, errors_of
  use accuracy_rules, only: fineness_t
  use kinds, only: wp
  implicit none
  private
  public :: asked_for, choose_fineness

  !> Share of what is asked that is used up, so that what the laws miss has room; and of that by penetration.
  real(wp), parameter :: used_share = 0.7_wp, depth_share = 0.35_wp
  !> Least factors of penetration and steps, largest of the mesh.
  real(wp), parameter :: least_depth = 1/64.0_wp, least_steps = 1/256.0_wp
  integer, parameter :: largest_mesh = 64
  !> Time over elements along a line, for the choice between mesh and steps: between loops (2) and factorisations (3).
  real(wp), parameter :: cost_exponent = 2.4_wp

contains

  !> What would have to be asked for an error to be expected.
  pure function asked_for(error) result(asked)
    real(wp), intent(in) :: error   !! [-]
    real(wp) :: asked

    asked = error/used_share
  end function asked_for

  !> The cheapest fineness whose errors are below what is asked; never coarser than the deck, nor than the third mesh where one
  !> was needed: steps that a scene chooses by itself differ from mesh to mesh, and their errors may hide those of the mesh.
  !> `met` is false where none is found: then the mesh is that of the finest pilot, with steps as if half of what is asked were left
  !> for them.
  pure subroutine choose_fineness(law, asked, divisible, fineness, met, parts)
    type(accuracy_law_t), intent(in) :: law
    real(wp), intent(in) :: asked         !! [-]
    logical, intent(in) :: divisible      !! the mesh can be made finer
    type(fineness_t), intent(out) :: fineness
    logical, intent(out) :: met
    integer, intent(in), optional :: parts   !! factors of the mesh are whole over this (default: whole)
    real(wp), dimension(size(law%space)) :: space, time, depth
    type(fineness_t) :: trial
    real(wp) :: left, cost, least
    integer :: m, k, coarsest, over

    met = .false.
    least = huge(least)
    over = 1
    if (present(parts)) over = parts
    coarsest = over
    if (law%order_measured) coarsest = nint(max(law%mesh, 1.0_wp))*over
    do m = coarsest, merge(largest_mesh*over, coarsest, divisible)
      trial = fineness_t(real(m, wp)/over, 1.0_wp, 1.0_wp)
      trial%depth = depth_within(law, trial, asked)
      call errors_of(law, trial, space, time, depth)
      do k = 1, size(space)
        left = used_share*asked - space(k) - depth(k)
        if (.not. left > 0) exit
        if (time(k) > left) trial%steps = min(trial%steps, (left/time(k))**(1/law%time_order))
      end do
      if (k <= size(space) .or. trial%steps < least_steps) cycle
      cost = trial%mesh**cost_exponent/trial%steps
      if (met .and. .not. cost < least) cycle
      least = cost
      fineness = trial
      met = .true.
    end do
    if (met) return
    fineness = fineness_t(max(law%mesh, 1.0_wp), 1.0_wp, 1.0_wp)
    fineness%depth = depth_within(law, fineness, asked)
    call errors_of(law, fineness, space, time, depth)
    left = used_share*asked/2
    if (maxval(time) > left) fineness%steps = max((left/maxval(time))**(1/law%time_order), least_steps)
  end subroutine choose_fineness

  !> Factor of the penetration that leaves its share of what is asked, on the mesh of a fineness.
  pure function depth_within(law, fineness, asked) result(factor)
    type(accuracy_law_t), intent(in) :: law
    type(fineness_t), intent(in) :: fineness   !! with penetrations as the deck has them
    real(wp), intent(in) :: asked              !! [-]
    real(wp) :: factor
    real(wp), dimension(size(law%space)) :: space, time, depth

    call errors_of(law, fineness, space, time, depth)
    factor = 1
    if (maxval(depth) > depth_share*used_share*asked) factor = max(depth_share*used_share*asked/maxval(depth), least_depth)
  end function depth_within

end module fineness_choice
