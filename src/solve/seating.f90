!> Dies under a force that touch nothing: a step starts where the force has taken them to the part.
!>
!> Over a gap nothing resists a free die, and the matrix is singular: Newton's method cannot find the way that a force has to push
!> it. But where it comes to is known: along the force, to the first side that it meets. There the step starts, just in touch; the
!> equilibrium is found from there as ever. A die that meets no side so stays where it is.
!>
!> The node of a round part on the axis bears nothing before it is a little way in the die (axis_contact). Where a pointed die
!> meets it alone, the step starts where it bears.
!>
!> The way is made of steps as long as the least gap (conservative advancement: B. Mirtich, PhD thesis, Berkeley 1996, ch. 2): none
!> goes too far, and along the normal of the die there is one.
module seating
  use axis_contact, only: depth_of_bearing
  use closest_point, only: closest_point_t
  use curve_search, only: closest_facing_point
  use dies, only: in_pilot_axes, is_deformable
  use dofs, only: dofs_t
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use plane_vectors, only: turned
  use resting_dies, only: has_spring, idle_dies
  use scene, only: axisymmetric, role_contact, scene_t
  use side_points, only: touching
  use solution, only: present_coordinates, solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: seat_dies

  !> Depth over the length of the side at which a die is in touch: above round-off of coordinates, far below what contact allows.
  real(wp), parameter :: in_touch = 1.0e-9_wp
  !> Steps of the way at most; and its length over the size of the scene.
  integer, parameter :: most_steps = 100
  real(wp), parameter :: longest_way = 2.0_wp

contains

  !> Move the pilots of such dies in the motion of a prediction.
  subroutine seat_dies(scene, dofs, solution, external, scale, du, seated, ways)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: external(:)   !! (ndof) forces at the end of the step [residual]
    real(wp), intent(in) :: scale         !! size of the scene [length]
    real(wp), intent(inout) :: du(:)      !! (ndof) motion of the step [unknown]
    real(wp), intent(out) :: seated(:)    !! (ndie) forces on those that are just in touch, moved there or not, 0 for others [force]
    real(wp), intent(out) :: ways(:, :)   !! (2, ndie) along X and Y, of those that are moved, 0 for others [length]
    logical :: idle(size(scene%dies)), in_touch_now
    real(wp), allocatable :: x(:, :)
    real(wp) :: pilot(3), push(2), way
    integer :: k

    seated = 0
    ways = 0
    if (size(scene%die_forces) == 0) return
    idle = idle_dies(scene, solution)
    do k = 1, size(scene%dies)
      if (.not. idle(k) .or. is_deformable(scene%dies(k))) cycle
      push = force_on(k)
      if (.not. any(abs(push) > 0)) cycle
      if (.not. allocated(x)) call place_nodes()
      pilot = solution%fields(pilot_field)%value(:, k)
      call add_motion(dofs%fields(pilot_field)%number(:, k), pilot)
      call find_way(scene, x, k, pilot, push/length_of(push), longest_way*scale, way, in_touch_now)
      if (.not. (way > 0 .or. in_touch_now)) cycle
      seated(k) = length_of(push)
      ways(:, k) = way*push/length_of(push)
      call move(dofs%fields(pilot_field)%number(1:2, k), ways(:, k))
    end do

  contains

    !> Force on what is free of a die, along X and Y, where no spring ties it.
    function force_on(die) result(force)
      integer, intent(in) :: die
      real(wp) :: force(2)   !! [force]
      integer :: i

      force = 0
      do i = 1, size(scene%die_forces)
        associate (load => scene%die_forces(i))
          if (load%die /= die .or. load%component > 2) cycle
          associate (d => dofs%fields(pilot_field)%number(load%component, die))
            if (d > 0 .and. .not. has_spring(scene, die, load%component)) force(load%component) = external(d)
          end associate
        end associate
      end do
    end function force_on

    !> Nodes at the motion of the prediction.
    subroutine place_nodes()
      integer :: n

      allocate (x, source=present_coordinates(scene, solution))
      do n = 1, size(x, 2)
        call add_motion(dofs%fields(displacement_field)%number(:, n), x(:, n))
      end do
    end subroutine place_nodes

    subroutine add_motion(number, value)
      integer, intent(in) :: number(:)          !! unknowns, 0 for none
      real(wp), intent(inout) :: value(:)       !! [unknown]
      integer :: c

      do c = 1, size(number)
        if (number(c) > 0) value(c) = value(c) + du(number(c))
      end do
    end subroutine add_motion

    subroutine move(number, by)
      integer, intent(in) :: number(:)   !! unknowns, 0 for none
      real(wp), intent(in) :: by(:)      !! [unknown]
      integer :: c

      do c = 1, size(number)
        if (number(c) > 0) du(number(c)) = du(number(c)) + by(c)
      end do
    end subroutine move
  end subroutine seat_dies

  !> How far a die goes in a direction until it is in touch with a side that faces it; 0 where it touches one now, or meets none.
  pure subroutine find_way(scene, x, die, pilot, direction, longest, way, in_touch_now)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)        !! (2, nnode) [length]
    integer, intent(in) :: die
    real(wp), intent(in) :: pilot(3)       !! (x, y, angle) [length and radian]
    real(wp), intent(in) :: direction(2)   !! [-]
    real(wp), intent(in) :: longest        !! [length]
    real(wp), intent(out) :: way           !! [length]
    logical, intent(out) :: in_touch_now   !! it touches one now
    real(wp) :: gap, side
    integer :: k

    way = 0
    in_touch_now = .false.
    do k = 1, most_steps
      call find_gap(scene, x, die, pilot + [way*direction, 0.0_wp], longest, gap, side)
      in_touch_now = k == 1 .and. gap <= touching*side
      if (gap <= touching*side) return
      way = way + gap + in_touch*side
      if (way > longest) exit
    end do
    way = 0
  end subroutine find_way

  !> Least gap between a die and the nodes of the sides that face it, below 0 for a depth, and the length of that side; huge where
  !> no side faces it. To the node on the axis it is the gap to where that bears.
  pure subroutine find_gap(scene, x, die, pilot, reach, gap, side)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)      !! (2, nnode) [length]
    integer, intent(in) :: die
    real(wp), intent(in) :: pilot(3)     !! (x, y, angle) [length and radian]
    real(wp), intent(in) :: reach        !! [length]
    real(wp), intent(out) :: gap, side   !! [length]
    real(wp) :: local(2, 3), chord(2), length, depth
    type(closest_point_t) :: closest
    integer :: g, e, i

    gap = huge(gap)
    side = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_contact .or. scene%groups(g)%die /= die .or. scene%groups(g)%material == 0) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        local = in_pilot_axes(x(:, scene%groups(g)%connectivity(:, e)), pilot)
        chord = local(:, 3) - local(:, 1)
        length = length_of(chord)
        do i = 1, 3
          call closest_facing_point(scene%dies(die), local(:, i), [-chord(2), chord(1)]/length, reach, closest)
          ! contact is sought within the length of a side
          if (closest%piece == 0 .or. closest%d > length) cycle
          depth = closest%d
          if (is_on_axis(scene%groups(g)%connectivity(i, e))) depth = depth - depth_to_bear(g)
          if (-depth > gap) cycle
          gap = -depth
          side = length
        end do
      end do
    end do

  contains

    !> A node of a round part that stays on the axis.
    pure function is_on_axis(node) result(yes)
      integer, intent(in) :: node
      logical :: yes

      yes = scene%plane_state == axisymmetric .and. abs(x(1, node)) <= touching*length
    end function is_on_axis

    !> Depth, along the normal of the die, at which the node on the axis bears.
    pure function depth_to_bear(g) result(depth)
      integer, intent(in) :: g   !! group of contact
      real(wp) :: depth          !! [length]
      real(wp) :: normal(2)

      normal = turned(closest%normal, pilot(3))
      depth = abs(normal(2))*depth_of_bearing(scene%materials(scene%groups(g)%material), length)
    end function depth_to_bear

  end subroutine find_gap

end module seating
