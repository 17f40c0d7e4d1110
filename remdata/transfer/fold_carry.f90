!> State of contact in folds, where sides of a body lie on other sides of it, carried to the new sides of both flanks.
!>
!> A fold is no contact interval: its contour is that of the old sides (folded_sides). So each new point has the state of the place
!> on the old side that it lies on, linear between the points of that side. Multipliers hold most of the pressure there: without
!> them the flanks would be free of force where equilibrium is restored. The depth is that of the new sides, whose waves are others:
!> the solver keeps the pressure at it (restore_balance).
module fold_carry
  use boundary_curves, only: arc_length_at, boundary_length, position_at_arc_length, position_t
  use closest_point, only: closest_point_t
  use contact_carry, only: list_carried
  use corrected_contours, only: contour_t
  use curve_search, only: closest_opposed_point
  use interval_points, only: status_row
  use kinds, only: wp
  use opposed_pieces, only: list_opposed_pieces
  use own_contact, only: faces_itself, pieces_to_meet
  use plane_vectors, only: right_of
  use quadrature, only: line_rule
  use scene, only: group_t, scene_t
  use shape_functions, only: line3
  use solution, only: solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  use zone_mesh, only: contour_side_t, new_mesh_t
  implicit none
  private
  public :: carry_folds

  !> At its ends a side is looked at by this share of its length inside: at the ground of a fold another side begins.
  real(wp), parameter :: at_end = 1.0e-9_wp

contains

  !> Contact variables and status of all groups that face their own body.
  pure subroutine carry_folds(old, from, contours, mesh, new, to)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: from
    type(contour_t), intent(in) :: contours(:)   !! (ncontour) of the old mesh
    type(new_mesh_t), intent(in) :: mesh
    type(solution_t), intent(inout) :: to        !! on the new mesh
    integer :: g, k, e

    do g = 1, size(old%groups)
      if (.not. faces_itself(old, old%groups(g))) cycle
      do k = 1, size(mesh%sides)
        e = findloc(new%groups(g)%connectivity(2, :), mesh%sides(k)%nodes(2), 1)
        if (e > 0) call carry_side(old, g, from%groups(g)%committed, contours, mesh%sides(k), new, e, to%groups(g)%committed)
      end do
      to%groups(g)%trial = to%groups(g)%committed
    end do
  end subroutine carry_folds

  !> The points of one new side.
  pure subroutine carry_side(old, g, before, contours, side, new, element, after)
    type(scene_t), intent(in) :: old, new
    integer, intent(in) :: g                        !! group
    real(wp), intent(in) :: before(:, :, :)         !! (nstate, npoint, nside) old [unit of each component]
    type(contour_t), intent(in) :: contours(:)      !! (ncontour)
    type(contour_side_t), intent(in) :: side
    integer, intent(in) :: element                  !! of the new group
    real(wp), intent(inout) :: after(:, :, :)       !! (nstate, npoint, nside) new [unit of each component]
    real(wp), allocatable :: xi(:), xi_old(:), weight(:)
    integer, allocatable :: carried(:)
    logical, allocatable :: conserved(:)
    type(position_t) :: place
    real(wp) :: start, length, share
    integer :: p, q, e, status

    call line_rule(new%groups(g)%rule, xi, weight)
    call line_rule(old%groups(g)%rule, xi_old, weight)
    call list_carried(old, g, carried, conserved)
    status = status_row(old, g)
    associate (boundary => contours(side%boundary)%boundary, loop => contours(side%boundary)%loop)
      start = arc_length_at(boundary, side%from)
      length = modulo(arc_length_at(boundary, side%to) - start, boundary_length(boundary))
      do p = 1, size(xi)
        share = min(max(0.5_wp*(1 + xi(p)), at_end), 1 - at_end)
        place = position_at_arc_length(boundary, modulo(start + share*length, boundary_length(boundary)))
        associate (arc => boundary%arcs(place%arc))
          if (arc%die > 0 .or. arc%side > size(loop%sides, 2)) cycle   ! not of the old contour
          e = findloc(old%groups(g)%connectivity(2, :), loop%sides(2, arc%side), 1)
        end associate
        if (e == 0) cycle
        q = min(max(count(xi_old <= place%xi), 1), size(xi_old) - 1)
        share = min(max((place%xi - xi_old(q))/(xi_old(q + 1) - xi_old(q)), 0.0_wp), 1.0_wp)
        after(carried, p, element) = (1 - share)*before(carried, q, e) + share*before(carried, q + 1, e)
        if (status == 0) cycle
        after(status, p, element) = before(status, merge(q + 1, q, share > 0.5_wp), e)
        if (nint(after(status, p, element)) /= 0) call place_on_flank(new, new%groups(g), element, xi(p), after(:, p, element))
      end do
    end associate
  end subroutine carry_side

  !> Where a point touches the other flank, and how deep: from there the solver goes on.
  pure subroutine place_on_flank(scene, group, element, xi, state)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: element
    real(wp), intent(in) :: xi            !! of the point on its side [-]
    real(wp), intent(inout) :: state(:)   !! (nstate) [unit of each component]
    type(closest_point_t) :: gap, depth
    logical :: may(size(scene%dies(group%die)%nodes, 2), 1)
    integer :: number, pieces(size(may, 1))
    real(wp) :: phi(3), dphi(3), point(2), tangent(2), inner(2), reach

    call pieces_to_meet(scene, group, element, may)
    call line3(xi, phi, dphi)
    associate (x => scene%mesh%coordinates(:, group%connectivity(:, element)))
      point = matmul(x, phi)
      tangent = matmul(x, dphi)
      inner = -right_of(tangent)
      reach = length_of(x(:, 3) - x(:, 1))
      call list_opposed_pieces(scene%dies(group%die), x, reach, may(:, 1), number, pieces)
    end associate
    call closest_opposed_point(scene%dies(group%die), point, inner, reach, pieces(:number), may(:, 1), -1.0_wp, gap)
    call closest_opposed_point(scene%dies(group%die), point, inner, reach, pieces(:number), may(:, 1), 1.0_wp, depth)
    if (gap%piece > 0 .and. (depth%piece == 0 .or. -gap%d < depth%d)) depth = gap
    if (depth%piece == 0) return
    state(group%variables(find_variable(group%variables, 'penetration'))%first) = depth%d
    state(group%variables(find_variable(group%variables, 'die_piece'))%first) = depth%piece
    state(group%variables(find_variable(group%variables, 'die_xi'))%first) = min(max(depth%xi, -1.0_wp), 1.0_wp)
  end subroutine place_on_flank

end module fold_carry
