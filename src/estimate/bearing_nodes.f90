!> How many nodes of a mesh bear a rigid die.
!>
!> Contact is known to within one node: m of them may stand for m + 1, of a die that has come so near to the next one. The force of
!> a plastic body goes with the width of contact in plane scenes, with its area in axisymmetric ones, as limit loads of indenters do
!> (R. Hill, The Mathematical Theory of Plasticity, Oxford 1950, ch. IX); where the point of a die or a rim enters large elements it
!> is theirs.
module bearing_nodes
  use dies, only: is_deformable
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use quadrature, only: line_rule
  use scene, only: axisymmetric, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: bears_load, count_nodes, error_of_width, open_share

  !> A die bears the load that has at least this share of the largest force on any.
  real(wp), parameter :: main_force = 0.5_wp
  !> Two sides have five nodes: fewer are a contact that has just begun.
  integer, parameter :: few = 4

contains

  !> Share of the load that the nodes in contact leave open where they are few: of the die where it is most, among those that bear
  !> the load.
  pure function open_share(scene, solution) result(share)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: share
    logical :: bears(size(scene%dies))
    integer :: nodes(size(scene%dies)), d

    share = 0
    if (size(nodes) == 0 .or. .not. scene%fields(displacement_field)%declared) return
    nodes = count_nodes(scene, solution)
    bears = bears_load(scene, solution)
    do d = 1, size(nodes)
      if (nodes(d) < 1 .or. nodes(d) > few .or. .not. bears(d)) cycle
      share = max(share, error_of_width(nodes(d), scene%plane_state))
    end do
  end function open_share

  !> Dies with at least half of the largest force on any.
  pure function bears_load(scene, solution) result(bears)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: bears(size(scene%dies))
    real(wp) :: force(size(scene%dies))
    integer :: d

    force = [(length_of(solution%fields(pilot_field)%applied(1:2, d)), d=1, size(force))]
    bears = force >= main_force*maxval(force) .and. force > 0
  end function bears_load

  !> Nodes, and points within sides, by which each rigid die is pressed; none on dies made of sides.
  pure function count_nodes(scene, solution) result(number)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: number(size(scene%dies))
    logical :: pressed(size(scene%mesh%coordinates, 2))
    integer :: d, g

    number = 0
    do d = 1, size(number)
      if (is_deformable(scene%dies(d))) cycle
      pressed = .false.
      do g = 1, size(scene%groups)
        if (scene%groups(g)%die == d .and. scene%groups(g)%material > 0) &
          call mark_nodes(scene, g, solution%groups(g)%committed, pressed, number(d))
      end do
      number(d) = number(d) + count(pressed)
    end do
  end function count_nodes

  !> Share of the force that a contact of so many nodes leaves open.
  pure function error_of_width(nodes, plane_state) result(error)
    integer, intent(in) :: nodes         !! from 1
    integer, intent(in) :: plane_state
    real(wp) :: error

    error = 1.0_wp/nodes
    if (plane_state == axisymmetric) error = (1 + error)**2 - 1
  end function error_of_width

  !> Nodes at ends and middles of sides that press, and the number of other points that do.
  pure subroutine mark_nodes(scene, g, state, pressed, others)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: state(:, :, :)   !! (component, point, side) [unit of each component]
    logical, intent(inout) :: pressed(:)     !! (nnode)
    integer, intent(inout) :: others
    real(wp), allocatable :: xi(:), weight(:)
    integer :: pressure, of_corner, place, e, p

    call line_rule(scene%groups(g)%rule, xi, weight)
    associate (variables => scene%groups(g)%variables, sides => scene%groups(g)%connectivity)
      pressure = variables(find_variable(variables, 'pressure'))%first
      of_corner = find_variable(variables, 'corner_pressure')
      place = find_variable(variables, 'corner_place')
      do e = 1, size(state, 3)
        do p = 1, size(state, 2)
          if (state(pressure, p, e) > 0) call mark(sides(:, e), xi(p), pressed, others)
          if (of_corner == 0 .or. place == 0) cycle
          if (state(variables(of_corner)%first, p, e) > 0) &
            call mark(sides(:, e), state(variables(place)%first, p, e), pressed, others)
        end do
      end do
    end associate
  end subroutine mark_nodes

  pure subroutine mark(side, at, pressed, others)
    integer, intent(in) :: side(3)   !! nodes
    real(wp), intent(in) :: at       !! on the side [-]
    logical, intent(inout) :: pressed(:)
    integer, intent(inout) :: others

    if (abs(at) >= 1) then
      pressed(merge(side(1), side(3), at < 0)) = .true.
    else if (abs(at) > 0) then
      others = others + 1
    else
      pressed(side(2)) = .true.
    end if
  end subroutine mark

end module bearing_nodes
