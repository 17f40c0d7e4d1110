!> Nodes on the axis, brought back to the depth of the points in contact beside them.
!>
!> A point on the axis has no surface: with rules that have points in the ends of a side nothing holds its node there, and it may
!> sink in the die. The contour of a new mesh would run through it, and points of that mesh would find themselves so deep. (The
!> node has no part in the load of an even pressure, nor in the volume: to second order nothing hangs on it.)
module loose_nodes
  use contact_knots, only: find_knot
  use contact_stretches, only: knot_t, placed_piece
  use dies, only: die_t, is_deformable
  use kinds, only: wp
  use quadrature, only: line_rule
  use scene, only: axisymmetric, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use stretches, only: stretch_t, tangent_at
  use vectors, only: length_of
  implicit none
  private
  public :: hold_nodes

  !> A radius below this share of the largest one is the axis.
  real(wp), parameter :: no_radius = 1.0e-9_wp
  !> Dies that stand steeper on the axis are left: along it their depth means nothing.
  real(wp), parameter :: least_cosine = 0.5_wp

contains

  !> Nodes on the axis that lie deeper in a rigid die than the closed point next to them.
  pure subroutine hold_nodes(scene, solution, x)
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
        call line_rule(group%npoint, xi, weight)
        if (is_deformable(scene%dies(group%die)) .or. status == 0 .or. penetration == 0 .or. size(xi) < 2) cycle
        if (xi(size(xi)) < 1) cycle
        status = group%variables(status)%first
        penetration = group%variables(penetration)%first
        do e = 1, size(group%connectivity, 2)
          do i = 1, 3, 2
            p = merge(2, size(xi) - 1, i == 1)
            associate (point => x(:, group%connectivity(i, e)))
              if (abs(point(1)) > least .or. nint(state(status, p, e)) <= 0) cycle
              call lift(scene%dies(group%die), solution%pilots(:, group%die), max(state(penetration, p, e), 0.0_wp), point)
            end associate
          end do
        end do
      end associate
    end do
  end subroutine hold_nodes

  !> Bring a point on the axis out of a die to a depth.
  pure subroutine lift(die, pilot, depth, point)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3), depth
    real(wp), intent(inout) :: point(2)
    type(knot_t) :: knot
    type(stretch_t) :: piece
    real(wp) :: normal(2)
    logical :: over

    call find_knot(die, pilot, point, [1, size(die%pieces, 3)], .true., knot, over)
    if (.not. (over .and. knot%depth > depth)) return
    piece = placed_piece(die, pilot, knot%piece)
    normal = tangent_at(piece, knot%xi)
    normal = [normal(2), -normal(1)]/length_of(normal)
    if (abs(normal(2)) > least_cosine) point(2) = point(2) + (depth - knot%depth)/normal(2)
  end subroutine lift

end module loose_nodes
