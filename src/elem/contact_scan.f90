!> A whole side of the part against its die: its depth at many points, and where contact begins and ends on it.
module contact_scan
  use closest_point, only: closest_point_t
  use curve_boxes, only: box_distance
  use curve_search, only: closest_facing_point
  use dies, only: die_t
  use kinds, only: wp
  use plane_vectors, only: left_of
  use shape_functions, only: line3
  implicit none
  private
  public :: is_near, closest_to_side_point, deepest_sample, widest_gap, lies_inside, locate_end

  !> Points at which a side is sampled.
  integer, parameter :: nsample = 65

contains

  !> The side is no further from the die than `reach`.
  pure function is_near(die, side, reach) result(near)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes in the pilot's axes [length]
    real(wp), intent(in) :: reach        !! [length]
    logical :: near

    near = box_distance(die, [minval(side, 2), maxval(side, 2)]) <= reach
  end function is_near

  !> Largest depth of a side at many points along it; below zero when it is not in the die.
  pure function deepest_sample(die, side, reach) result(depth)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes in the pilot's axes [length]
    real(wp), intent(in) :: reach        !! [length]
    real(wp) :: depth
    type(closest_point_t) :: closest
    integer :: k

    depth = -reach
    do k = 1, nsample
      call closest_to_side_point(die, side, sample(k), reach, closest)
      if (closest%piece > 0) depth = max(depth, closest%d)
    end do
  end function deepest_sample

  !> Largest distance of a side from its die between two places that touch it [length].
  pure function widest_gap(die, side, reach, touch) result(gap)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes in the pilot's axes [length]
    real(wp), intent(in) :: reach        !! [length]
    real(wp), intent(in) :: touch        !! what is nearer touches the die [length]
    real(wp) :: gap
    type(closest_point_t) :: closest
    real(wp) :: since
    logical :: touched
    integer :: k

    gap = 0
    since = 0
    touched = .false.
    do k = 1, nsample
      call closest_to_side_point(die, side, sample(k), reach, closest)
      if (closest%piece == 0) cycle
      since = max(since, -closest%d)
      if (closest%d < -touch) cycle
      if (touched .and. since > touch) gap = max(gap, since)
      touched = .true.
      since = 0
    end do
  end function widest_gap

  !> Places at which a side is looked at, the ends among them.
  elemental function sample(k) result(place)
    integer, intent(in) :: k
    real(wp) :: place   !! [-]

    place = -1 + 2*real(k - 1, wp)/(nsample - 1)
  end function sample

  !> Where contact ends between a position on a side in contact and an open one: a linear guess from the penetrations there, then
  !> the zero of the depth by bisection and secants on the side itself. Where the die ends first that is the position; where the
  !> depth has no zero between, a side lifted by its law, the guess is kept.
  pure subroutine locate_end(die, side, closed, open, depths, reach, position, closest)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)              !! nodes in the pilot's axes [length]
    real(wp), intent(in) :: closed, open            !! positions on the side
    real(wp), intent(in) :: depths(2)               !! penetrations there, below zero for a gap [length]
    real(wp), intent(in) :: reach                   !! [length]
    real(wp), intent(out) :: position                  !! on the side
    type(closest_point_t), intent(out) :: closest   !! on the die, its piece 0 where there is none
    real(wp) :: inside, outside, middle
    type(closest_point_t) :: trial
    integer :: iteration
    integer, parameter :: halvings = 50    ! to round-off of a position

    position = closed
    if (depths(1) > depths(2)) position = closed + (open - closed)*max(0.0_wp, min(1.0_wp, depths(1)/(depths(1) - depths(2))))
    call closest_to_side_point(die, side, closed, reach, closest)
    call closest_to_side_point(die, side, open, reach, trial)
    if (is_inside(closest) .neqv. is_inside(trial)) then
      inside = closed
      outside = open
      do iteration = 1, halvings
        middle = 0.5_wp*(inside + outside)
        call closest_to_side_point(die, side, middle, reach, trial)
        if (is_inside(trial)) then
          inside = middle
        else
          outside = middle
        end if
      end do
      position = inside
    end if
    call closest_to_side_point(die, side, position, reach, trial)
    if (trial%piece > 0) closest = trial
  end subroutine locate_end

  !> A position on a side is in the die.
  pure function lies_inside(die, side, position, reach) result(inside)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes in the pilot's axes [length]
    real(wp), intent(in) :: position
    real(wp), intent(in) :: reach   !! [length]
    logical :: inside
    type(closest_point_t) :: closest

    call closest_to_side_point(die, side, position, reach, closest)
    inside = is_inside(closest)
  end function lies_inside

  pure function is_inside(closest) result(inside)
    type(closest_point_t), intent(in) :: closest
    logical :: inside

    inside = closest%piece > 0 .and. closest%d >= 0
  end function is_inside

  !> Closest point to a position on a side.
  pure subroutine closest_to_side_point(die, side, position, reach, closest)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes in the pilot's axes [length]
    real(wp), intent(in) :: position     !! parent coordinate [-]
    real(wp), intent(in) :: reach        !! [length]
    type(closest_point_t), intent(out) :: closest
    real(wp) :: phi(3), dphi(3), tangent(2)

    call line3(position, phi, dphi)
    tangent = matmul(side, dphi)
    ! where a side has no tangent it faces nothing
    if (.not. any(abs(tangent) > 0)) return
    call closest_facing_point(die, matmul(side, phi), left_of(tangent), reach, closest)
  end subroutine closest_to_side_point

end module contact_scan
