!> Corners of a die that press into a side of the part, and contact intervals that go on to them.
!>
!> Where matter flows around a sharp corner of a die, the corner is a point of contact of its own between two points of a side,
!> often with open ones before it (corner_contact): contact on the face ends there, not at the last point of the side that is
!> closed. A contour that left the die before would have its corner inside, and miss its force.
module die_corner_contact
  use boundary_sides, only: loop_t
  use corner_weights, only: handing_over
  use kinds, only: wp
  use loop_intervals, only: along, contact_interval_t, side_point_t
  use quadrature, only: line_rule
  use scene, only: scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: extend_to_corners, find_corners

contains

  !> Extend intervals to the corners in contact with sides of their group that are no farther than `longest` past their ends,
  !> as long as no other interval is between them. An interval whose first or last point in contact is a corner ends there already:
  !> what is left of it on the corner's other face is as long as the corner is deep. So does one whose last node has slid past
  !> the corner, and hands its force over to it.
  pure subroutine extend_to_corners(scene, solution, loop, longest, intervals)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: longest                           !! [sides]
    type(contact_interval_t), intent(inout) :: intervals(:)   !! (ninterval) in their order along the loop
    type(side_point_t), allocatable :: corners(:)
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: until
    integer :: g, k, i, nside, before, after

    nside = size(loop%sides, 2)
    do g = 1, size(scene%groups)
      if (all(intervals%group /= g)) cycle
      call find_corners(scene, solution, loop, g, corners)
      call line_rule(scene%groups(g)%rule, xi, weight)
      do k = 1, size(intervals)
        if (intervals(k)%group /= g) cycle
        after = modulo(k, size(intervals)) + 1
        before = modulo(k - 2, size(intervals)) + 1
        do i = 1, size(corners)
          until = along(intervals(after)%from) + merge(nside, 0, after <= k)
          call try_end(corners(i), min(until, along(intervals(k)%to) + longest), nside, intervals(k))
          until = along(intervals(before)%to) - merge(nside, 0, before >= k)
          call try_beginning(corners(i), max(until, along(intervals(k)%from) - longest), intervals(k))
          if (is_outermost(xi, intervals(k)%from, corners(i), 1)) intervals(k)%to_corner(1) = .true.
          if (is_outermost(xi, intervals(k)%to, corners(i), -1)) intervals(k)%to_corner(2) = .true.
          call end_at_corner(corners(i), nside, intervals(k))
        end do
      end do
    end do
  end subroutine extend_to_corners

  !> A corner is the first point of contact behind an end of an interval on its side, along the loop (1) or against it (-1).
  pure function is_outermost(xi, limit, corner, towards) result(yes)
    real(wp), intent(in) :: xi(:)   !! (npoint) of the side [-]
    type(side_point_t), intent(in) :: limit, corner
    integer, intent(in) :: towards
    logical :: yes

    yes = corner%side == limit%side .and. towards*(corner%xi - limit%xi) >= 0 &
          .and. .not. any(towards*(xi - limit%xi) >= 0 .and. towards*(corner%xi - xi) >= 0)
  end function is_outermost

  !> The node between a corner and the end of an interval has slid past the corner, and loses its force on this way
  !> (corner_release): the interval ends in the corner.
  pure subroutine end_at_corner(corner, nside, interval)
    type(side_point_t), intent(in) :: corner
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: interval
    type(side_point_t) :: one
    real(wp) :: past

    past = along(corner) - along(interval%from)
    if (corner%xi < 0 .and. past >= 0 .and. past <= handing_over) then
      interval%from = corner
      interval%found(1) = corner
      interval%to_corner(1) = .true.
    end if
    one = corner
    if (along(one) < along(interval%from)) one%side = one%side + nside
    past = along(interval%to) - along(one)
    if (corner%xi > 0 .and. past >= 0 .and. past <= handing_over) then
      interval%to = one
      interval%found(2) = one
      interval%to_corner(2) = .true.
    end if
  end subroutine end_at_corner

  !> An interval ends in a corner that is past its end.
  pure subroutine try_end(corner, until, nside, interval)
    type(side_point_t), intent(in) :: corner
    real(wp), intent(in) :: until   !! farthest place, from the start of the loop [sides]
    integer, intent(in) :: nside
    type(contact_interval_t), intent(inout) :: interval
    type(side_point_t) :: one

    one = corner
    if (along(one) < along(interval%to)) one%side = one%side + nside
    if (along(one) > until .or. .not. along(one) > along(interval%to)) return
    interval%to = one
    interval%to_corner(2) = .true.
  end subroutine try_end

  !> An interval begins in a corner that is before its beginning.
  pure subroutine try_beginning(corner, from, interval)
    type(side_point_t), intent(in) :: corner
    real(wp), intent(in) :: from   !! farthest place, from the start of the loop [sides]
    type(contact_interval_t), intent(inout) :: interval

    if (along(corner) < from .or. .not. along(corner) < along(interval%from)) return
    interval%from = corner
    interval%to_corner(1) = .true.
  end subroutine try_beginning

  !> Corners in contact with the sides of a group; not the node of a side on the axis, which has the state of one too.
  pure subroutine find_corners(scene, solution, loop, g, corners)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    integer, intent(in) :: g
    type(side_point_t), allocatable, intent(out) :: corners(:)   !! (ncorner)
    integer :: status, place, piece, e, p, side

    allocate (corners(0))
    associate (variables => scene%groups(g)%variables, state => solution%groups(g)%committed)
      place = find_variable(variables, 'corner_place')
      if (place == 0) return
      place = variables(place)%first
      status = variables(find_variable(variables, 'corner_contact_status'))%first
      piece = variables(find_variable(variables, 'corner_die_piece'))%first
      do e = 1, size(state, 3)
        side = findloc(loop%sides(2, :), scene%groups(g)%connectivity(2, e), 1)
        if (side == 0) cycle
        do p = 1, size(state, 2)
          ! zero when open
          if (nint(state(status, p, e)) == 0 .or. .not. abs(state(place, p, e)) < 1) cycle
          corners = [corners, side_point_t(side, state(place, p, e), nint(state(piece, p, e)))]
        end do
      end do
    end associate
  end subroutine find_corners

end module die_corner_contact
