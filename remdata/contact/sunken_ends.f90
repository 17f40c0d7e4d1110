!> Free sides that lie in a die beyond an end of contact.
!>
!> The solver looks at a side in its points only: between the last point in contact and the first one that is free, a coarse side
!> may cut a round die. The points of a new mesh would find themselves in the die there, with pressures that nothing bore. So the
!> contour follows the die itself on that way, to where the old side comes out of it.
module sunken_ends
  use boundary_sides, only: loop_t
  use contact_knots, only: find_knot, point_of_spot, way_between
  use contact_runs, only: spot_t
  use contact_stretches, only: follow_die, knot_t
  use dies, only: die_t, is_deformable
  use kinds, only: eps, wp
  use stretches, only: stretch_t
  use vectors, only: length_of
  implicit none
  private
  public :: tail_t, find_tail, stretches_of_tail

  type :: tail_t
    logical :: there = .false.
    !> Where the side comes out of the die, and the die there.
    type(spot_t) :: out
    type(knot_t) :: knot
  end type tail_t

  !> Places of what is left of a side that are looked at.
  integer, parameter :: looks = 32
  !> A side that cuts a die is as deep in it as the first share of itself, and no deeper than the second: beyond it is another wall
  !> of the die that was met.
  real(wp), parameter :: shallow = 1.0e-7_wp, deep = 0.1_wp
  !> What is left of a side in half sides, when it is nothing.
  real(wp), parameter :: nothing = 1.0e-6_wp

contains

  !> The way of the side in the die beyond a beginning (towards = -1) or an end (1) of contact, on the side it is on. None where the
  !> side does not come out of the die, or has no foot on it.
  pure subroutine find_tail(loop, x, die, pilot, from, end_knot, towards, tail)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)        !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)
    type(spot_t), intent(in) :: from       !! beginning or end of contact
    type(knot_t), intent(in) :: end_knot   !! the die there
    integer, intent(in) :: towards
    type(tail_t), intent(out) :: tail
    type(spot_t) :: here
    type(knot_t) :: knot
    real(wp) :: start, last, deepest, low, high, length
    integer :: k
    logical :: sound

    if (is_deformable(die)) return
    here = from
    if (towards*here%xi > 1 - nothing) here = spot_t(from%side + towards, real(-towards, wp))
    start = here%xi
    last = start
    deepest = 0
    do k = 1, looks
      here%xi = start + (towards - start)*real(k, wp)/looks
      call look(here, knot, sound)
      if (.not. sound) return
      if (.not. knot%depth > 0) exit
      deepest = max(deepest, knot%depth)
      last = here%xi
    end do
    length = length_of(point_of_spot(loop, x, spot_t(here%side, 1.0_wp)) - point_of_spot(loop, x, spot_t(here%side, -1.0_wp)))
    if (k > looks .or. deepest <= shallow*length .or. deepest > deep*length) return
    low = last
    high = here%xi
    do while (abs(high - low) > 4*eps)
      here%xi = 0.5_wp*(low + high)
      if (.not. (here%xi > min(low, high) .and. here%xi < max(low, high))) exit
      call look(here, knot, sound)
      if (knot%depth > 0) then
        low = here%xi
      else
        high = here%xi
      end if
    end do
    call look(here, knot, sound)
    if (.not. sound .or. abs(towards - here%xi) <= nothing) return
    if (.not. towards*way_between(die, end_knot, knot) > 0) return
    knot%depth = 0
    tail = tail_t(.true., here, knot)

  contains

    pure subroutine look(spot, foot, over)
      type(spot_t), intent(in) :: spot
      type(knot_t), intent(out) :: foot
      logical, intent(out) :: over

      call find_knot(die, pilot, point_of_spot(loop, x, spot), [1, size(die%pieces, 3)], towards < 0, foot, over)
    end subroutine look

  end subroutine find_tail

  !> The die from one knot to another as free stretches of a side.
  pure subroutine stretches_of_tail(die, pilot, number, side, knots, list)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)
    integer, intent(in) :: number, side   !! of the die and of the loop
    type(knot_t), intent(in) :: knots(2)
    type(stretch_t), allocatable, intent(out) :: list(:)

    call follow_die(die, pilot, number, knots, list)
    list%side = side
  end subroutine stretches_of_tail

end module sunken_ends
