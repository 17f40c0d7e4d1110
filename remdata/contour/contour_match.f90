!> Places of the old loop on its corrected contour, and back: what was on a side is found again where contact replaced it.
!>
!> On free sides xi is the same on both. Inside a run of contact a place belongs to the closest one of that run, never to a
!> wall across a thin part.
module contour_match
  use boundary_sides, only: loop_t
  use contact_runs, only: along, spot_t
  use contour_assembly, only: contact_t
  use contour_chain, only: chain_t, place_t, point_on
  use kinds, only: wp
  use stretches, only: closest_xi, point_at, stretch_t
  use vectors, only: length_of
  implicit none
  private
  public :: place_of_old

contains

  !> Where a place on an old side has gone.
  pure function place_of_old(loop, chain, contacts, x, side, xi) result(place)
    type(loop_t), intent(in) :: loop
    type(chain_t), intent(in) :: chain           !! corrected
    type(contact_t), intent(in) :: contacts(:)
    real(wp), intent(in) :: x(:, :)              !! nodes before the correction (2, nnode) [length]
    integer, intent(in) :: side                  !! of the loop
    real(wp), intent(in) :: xi
    type(place_t) :: place
    type(stretch_t) :: old
    real(wp) :: here, distance, least, point(2)
    integer :: k, run

    run = run_at(loop, contacts, side, xi)
    old%points = x(:, loop%sides(:, side))
    point = point_at(old, xi)
    least = huge(least)
    do k = 1, size(chain%stretches)
      associate (one => chain%stretches(k))
        if (one%run /= run .or. run == 0 .and. one%side /= side) cycle
        here = xi
        ! a free side may follow the die on a part of its way
        if (one%middle == 0) here = closest_xi(one, point)
        if (here < one%range(1) .or. here > one%range(2)) cycle
        distance = length_of(point_at(one, here) - point)
        if (.not. distance < least) cycle
        least = distance
        place = place_t(k, here)
      end associate
    end do
  end function place_of_old

  !> Run of contact that a place on an old side is in, 0 for none.
  pure function run_at(loop, contacts, side, xi) result(run)
    type(loop_t), intent(in) :: loop
    type(contact_t), intent(in) :: contacts(:)
    integer, intent(in) :: side
    real(wp), intent(in) :: xi
    integer :: run
    integer :: k
    real(wp) :: s

    run = 0
    do k = 1, size(contacts)
      s = along(spot_t(side, xi))
      if (s < along(contacts(k)%run%from)) s = s + size(loop%sides, 2)
      if (s <= along(contacts(k)%run%to)) run = k
    end do
  end function run_at

end module contour_match
