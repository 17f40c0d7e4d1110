!> Nodes on the axis, moved back to the depth of the adjacent integration points in contact.
!>
!> A point on the axis has no surface: with integration rules that have points at the ends of a side no contact force acts on its
!> node there, and it may penetrate the die. The contour of a new mesh would pass through it, and integration points of that mesh
!> would have the same depth. (The node has no part in the load of a uniform pressure, nor, to second order, in the volume.)
module axis_nodes
  use closest_point, only: closest_point_t
  use die_closest_points, only: find_closest_point
  use dies, only: die_t, is_deformable
  use fields, only: pilot_field
  use kinds, only: wp
  use plane_vectors, only: turned
  use quadrature, only: line_rule
  use scene, only: axisymmetric, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: limit_depths

  !> A radius below this share of the largest one is zero.
  real(wp), parameter :: no_radius = 1.0e-9_wp
  !> Dies steeper than this on the axis are ignored: the depth along the axis has no meaning there.
  real(wp), parameter :: least_cosine = 0.5_wp

contains

  !> Nodes on the axis that lie deeper in a rigid die than the closed point next to them.
  pure subroutine limit_depths(scene, solution, x)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(inout) :: x(:, :)   !! nodes now (2, nnode) [length]
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: least
    integer :: status, penetration, g, e, i, p

    if (scene%plane_state /= axisymmetric) return
    least = no_radius*maxval(abs(x(1, :)))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g)%committed)
        if (group%die == 0) cycle
        status = find_variable(group%variables, 'contact_status')
        penetration = find_variable(group%variables, 'penetration')
        call line_rule(group%rule, xi, weight)
        if (is_deformable(scene%dies(group%die)) .or. status == 0 .or. penetration == 0 .or. size(xi) < 2) cycle
        if (xi(size(xi)) < 1) cycle
        status = group%variables(status)%first
        penetration = group%variables(penetration)%first
        do e = 1, size(group%connectivity, 2)
          do i = 1, 3, 2
            p = merge(2, size(xi) - 1, i == 1)
            associate (point => x(:, group%connectivity(i, e)))
              if (abs(point(1)) > least .or. nint(state(status, p, e)) <= 0) cycle
              call lift(scene%dies(group%die), solution%fields(pilot_field)%value(:, group%die), &
                        max(state(penetration, p, e), 0.0_wp), point)
            end associate
          end do
        end do
      end associate
    end do
  end subroutine limit_depths

  !> Move a point along the axis to a given depth in a die.
  pure subroutine lift(die, pilot, depth, point)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3), depth
    real(wp), intent(inout) :: point(2)
    type(closest_point_t) :: closest
    real(wp) :: normal(2)
    logical :: over

    call find_closest_point(die, pilot, point, [1, size(die%pieces, 3)], .true., closest, over)
    if (.not. (over .and. closest%d > depth)) return
    normal = turned(closest%normal, pilot(3))
    if (abs(normal(2)) > least_cosine) point(2) = point(2) + (depth - closest%d)/normal(2)
  end subroutine lift

end module axis_nodes
