!> Integration points of a contact interval in sequence, with the surface that each stands for.
module interval_points
  use boundary_sides, only: loop_t
  use kinds, only: wp
  use quadrature, only: line_rule, rule_control
  use scene, only: axisymmetric, scene_t
  use shape_functions, only: line3
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: component_row, interval_points_t, status_row, surface
  public :: add_neighbour, line_jacobian, add_point

  !> Integration points of an interval in sequence: arc length from its start, length each represents, point and element.
  type :: interval_points_t
    real(wp) :: length = 0.0_wp                !! of the interval [length]
    real(wp), allocatable :: s(:), weight(:)   !! [length], times the radius when axisymmetric
    integer, allocatable :: point(:), element(:)
    !> What is added to the numbers of components: 0, or for a corner of the die those of its own state.
    integer, allocatable :: offset(:)
    !> How far beside a corner of the die the node is that it shares its force with, below 0 where there is none [length].
    real(wp), allocatable :: reach(:)
  end type interval_points_t

contains

  !> Number of the component that is the status of a group's points; 0 where there is none.
  pure function status_row(scene, g) result(row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! group
    integer :: row

    row = component_row(scene, g, 'contact_status')
  end function status_row

  !> Number of the first component of a variable of a group; 0 where there is none.
  pure function component_row(scene, g, name) result(row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! group
    character(len=*), intent(in) :: name
    integer :: row

    row = find_variable(scene%groups(g)%variables, name)
    if (row > 0) row = scene%groups(g)%variables(row)%first
  end function component_row

  !> The integration point of an adjacent side in the node where the interval begins or ends.
  pure subroutine add_neighbour(scene, g, loop, x, side, at, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, side
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: at        !! xi of that node on the side
    type(interval_points_t), intent(inout) :: row
    real(wp), allocatable :: xi(:), weight(:)
    integer :: n, e, p

    n = modulo(side - 1, size(loop%sides, 2)) + 1
    e = findloc(scene%groups(g)%connectivity(2, :), loop%sides(2, n), 1)
    if (e == 0) return
    call line_rule(scene%groups(g)%rule, xi, weight)
    do p = 1, size(xi)
      if (abs(xi(p) - at) > 0) cycle
      call add_point(row%length, surface(scene, g, x(:, loop%sides(:, n)), xi, weight, p), p, e, row)
    end do
  end subroutine add_neighbour

  !> Surface that a point of a side stands for: its weight, or with a control point the integral of its Bernstein polynomial by
  !> Simpson's rule, as the solver has it.
  pure function surface(scene, g, x, xi, weight, p) result(area)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, p                !! group, point
    real(wp), intent(in) :: x(2, 3)            !! nodes of the side [length]
    real(wp), intent(in) :: xi(:), weight(:)   !! (npoint) of the rule [-]
    real(wp) :: area                           !! [length], times the radius when axisymmetric
    logical :: round

    round = scene%plane_state == axisymmetric
    if (scene%groups(g)%rule%family /= rule_control) then
      area = weight(p)*line_jacobian(x, xi(p), round)
    else if (p == 2) then
      area = 2*line_jacobian(x, 0.0_wp, round)/3
    else
      area = (line_jacobian(x, xi(p), round) + line_jacobian(x, 0.0_wp, round))/3
    end if
  end function surface

  !> d(length)/d(xi), times the radius.
  pure function line_jacobian(x, xi, round) result(jacobian)
    real(wp), intent(in) :: x(2, 3)   !! nodes of the side [length]
    real(wp), intent(in) :: xi
    logical, intent(in) :: round      !! axisymmetric
    real(wp) :: jacobian
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    jacobian = length_of(matmul(x, dphi))
    if (round) jacobian = jacobian*dot_product(x(1, :), phi)
  end function line_jacobian

  !> Append a point.
  pure subroutine add_point(s, weight, point, element, row, offset)
    real(wp), intent(in) :: s        !! from the start of the interval [length]
    real(wp), intent(in) :: weight   !! [length], times the radius when axisymmetric
    integer, intent(in) :: point, element
    type(interval_points_t), intent(inout) :: row
    integer, intent(in), optional :: offset
    integer :: added

    row%s = [row%s, s]
    row%weight = [row%weight, weight]
    row%point = [row%point, point]
    row%element = [row%element, element]
    added = 0
    if (present(offset)) added = offset
    row%offset = [row%offset, added]
    row%reach = [row%reach, -1.0_wp]
  end subroutine add_point

end module interval_points
