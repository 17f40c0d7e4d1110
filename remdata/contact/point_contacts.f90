!> Contact at a point of the contour: a node, or a corner of the die in a side, with nothing in contact beside it.
!>
!> A die that stands on the rim of a part, or the point of a wedge, presses on one node. What is in the die around it is a small
!> share of a side (contact_intervals), over which no element would fit, and no pressure on sides stands for it. The contour stays
!> the part's own there, the new mesh has a node at the place, and the force goes on to it (contact_carry).
module point_contacts
  use boundary_sides, only: loop_t
  use corner_weights, only: corner_length, place_within
  use die_closest_points, only: point_on_side
  use die_corner_contact, only: find_corners
  use kinds, only: wp
  use loop_intervals, only: along, contact_interval_t, side_point_t
  use quadrature, only: is_control_point, line_rule
  use scene, only: scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: point_contact_t, find_points, lies_beside

  type :: point_contact_t
    !> What is in contact around the point.
    type(contact_interval_t) :: interval
    !> The point in contact that presses most, its coordinates [length] and the length of its side.
    type(side_point_t) :: place
    real(wp) :: point(2) = 0.0_wp, side_length = 0.0_wp
  end type point_contact_t

  !> A point nearer than this to an interval of contact belongs to it [sides]: contact that opens and closes beside its end.
  real(wp), parameter :: beside = 0.5_wp
  !> Points closer than this, in sides, coincide.
  real(wp), parameter :: coincidence_tolerance = 1.0e-9_wp

contains

  !> Points of contact: of intervals too short for elements, and corners of dies that press into sides outside of all intervals.
  pure subroutine find_points(scene, solution, loop, x, short, intervals, points)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)                           !! nodes now (2, nnode) [length]
    type(contact_interval_t), intent(in) :: short(:)          !! (nshort)
    type(contact_interval_t), intent(in) :: intervals(:)      !! (ninterval)
    type(point_contact_t), allocatable, intent(out) :: points(:)   !! (n)
    type(side_point_t), allocatable :: corners(:)
    type(contact_interval_t) :: one
    integer :: k, g

    allocate (points(0))
    do k = 1, size(short)
      call add(short(k), points)
    end do
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0) cycle
      call find_corners(scene, solution, loop, g, corners)
      do k = 1, size(corners)
        one%group = g
        one%from = corners(k)
        one%to = corners(k)
        one%found = corners(k)
        call add(one, points)
      end do
    end do

  contains

    pure subroutine add(interval, points)
      type(contact_interval_t), intent(in) :: interval
      type(point_contact_t), allocatable, intent(inout) :: points(:)
      type(point_contact_t) :: point
      logical :: presses
      integer :: i

      do i = 1, size(intervals)
        if (lies_beside(interval, intervals(i), size(loop%sides, 2))) return
      end do
      do i = 1, size(points)
        if (points(i)%interval%group /= interval%group) cycle
        if (lies_beside(interval, points(i)%interval, size(loop%sides, 2))) return
      end do
      point%interval = interval
      call strongest_point(scene, solution, loop, interval, point%place, presses)
      if (.not. presses) return
      point%point = point_on_side(loop, x, point%place)
      point%side_length = length_of(x(:, loop%sides(3, point%place%side)) - x(:, loop%sides(1, point%place%side)))
      points = [points, point]
    end subroutine add

  end subroutine find_points

  !> Two intervals have a point in common, or are nearer than half a side.
  pure function lies_beside(one, other, nside) result(yes)
    type(contact_interval_t), intent(in) :: one, other
    integer, intent(in) :: nside   !! of the loop
    logical :: yes
    integer :: turn

    yes = .false.
    do turn = -nside, nside, nside
      if (along(one%from) + turn < along(other%to) + beside .and. along(one%to) + turn > along(other%from) - beside) yes = .true.
    end do
  end function lies_beside

  !> The point or corner in contact in an interval that presses most; a control point only where it does so alone: its place is
  !> then the middle node, which no pressure says.
  pure subroutine strongest_point(scene, solution, loop, interval, place, presses)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    type(contact_interval_t), intent(in) :: interval
    type(side_point_t), intent(out) :: place
    logical, intent(out) :: presses   !! there is one
    real(wp), allocatable :: xi(:), weight(:)
    type(side_point_t) :: of_control
    real(wp) :: most, most_of_control
    integer :: pressure, corner_pressure, corner_place, corner_share, side, e, p

    most = 0
    most_of_control = 0
    presses = .false.
    if (find_variable(scene%groups(interval%group)%variables, 'pressure') == 0) return
    associate (group => scene%groups(interval%group), state => solution%groups(interval%group)%committed)
      pressure = group%variables(find_variable(group%variables, 'pressure'))%first
      corner_place = find_variable(group%variables, 'corner_place')
      corner_pressure = find_variable(group%variables, 'corner_pressure')
      if (corner_pressure == 0) corner_place = 0
      if (corner_place > 0) then
        corner_place = group%variables(corner_place)%first
        corner_share = group%variables(find_variable(group%variables, 'corner_share'))%first
        corner_pressure = group%variables(corner_pressure)%first
      end if
      call line_rule(group%rule, xi, weight)
      ! a node belongs to the sides before and after it
      do side = interval%from%side - 1, interval%to%side + 1
        e = findloc(group%connectivity(2, :), loop%sides(2, modulo(side - 1, size(loop%sides, 2)) + 1), 1)
        if (e == 0) cycle
        do p = 1, size(xi)
          if (is_control_point(group%rule, p)) then
            call try(xi(p), weight(p)*state(pressure, p, e), most_of_control, of_control)
          else
            call try(xi(p), weight(p)*state(pressure, p, e), most, place)
          end if
          if (corner_place == 0) cycle
          if (group%pairs == 0 .and. .not. abs(state(corner_place, p, e)) < 1) cycle
          call try(place_within(state(corner_place, p, e)), corner_length(xi, p, group%pairs > 0) &
                   *state(corner_share, p, e)*state(corner_pressure, p, e), most, place)
        end do
      end do
    end associate
    if (.not. most > 0) place = of_control
    presses = most > 0 .or. most_of_control > 0

  contains

    pure subroutine try(at, force, most, place)
      real(wp), intent(in) :: at, force   !! parent coordinate [-], force over the length of half a side [stress]
      real(wp), intent(inout) :: most     !! [stress]
      type(side_point_t), intent(inout) :: place
      type(side_point_t) :: one

      one = side_point_t(side, at)
      if (along(one) < along(interval%from) - coincidence_tolerance) return
      if (along(one) > along(interval%to) + coincidence_tolerance .or. .not. force > most) return
      most = force
      place = one
      place%side = modulo(side - 1, size(loop%sides, 2)) + 1
    end subroutine try

  end subroutine strongest_point

end module point_contacts
