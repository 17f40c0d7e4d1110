!> Corners of a die between the integration points of a side as points of contact of their own.
!>
!> The corners in the interval between two points (side_corners) act there, each with the length of
!> the interval as its weight, on what is deeper than half the allowed penetration, where one is given:
!> a side that lies on the die by a corner has its points for that. Toward an end of the side the weight
!> goes to zero (corner_weights). Were it the deepest one alone, a rib of the die that is narrower than the interval would have
!> no equilibrium: pressed by one of its corners the side turns onto the other.
!>
!> One corner of an interval has a state (corner_states). The friction of others there begins anew with every step (as in
!> contact_between), no multiplier holds them, and pressure, energy and work of friction are added to those of the first, as
!> what makes the same on its area.
!> The normal force of a corner is pressure only, whatever the law. In the interval at a node on
!> the axis either the corner acts or that node (axis_contact).
!>
!> A corner that passes a point within the side goes on in the next interval, with its multiplier and its friction: nothing
!> changes there. The point itself stays open as it passes, where it was (corner_beside): were it pressed in place of the corner,
!> it would be held on the face beyond the corner until its pressure is released, and the part would stop and jump.
module corner_contact
  use contact_overlap, only: share_to_contact
  use contact_penalties, only: allowed_penetration
  use contact_state, only: at_between, at_energy, at_penetration, at_piece, at_pressure, at_status, at_tau, at_work, at_xi, &
                           contact_block
  use corner_states, only: bears, corner_at_start, free_depth, keep_corner
  use corner_weights, only: handing_over, interval_before
  use dies, only: die_t
  use elem_api, only: report_t
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use passing_corners, only: corner_at_side, deepest_at_side, share_of, slope_of_share
  use plane_vectors, only: turned
  use rigid_contact, only: drift_t, ndof, nodes_in_axes, outer, place_point, press, side_t
  use shape_functions, only: line3
  use side_corners, only: closest_at_corner, corner_t
  use side_points, only: area_at, contact_point_t, most_unknowns, no_surface, thinning
  implicit none
  private
  public :: corner_beside, end_on_axis, press_corner, press_corners

contains

  !> Contact of a side with the corners of a die, but in the interval at the axis. States are of all points of the side
  !> (nstate, npoint).
  pure subroutine press_corners(die, law, material, drivers, axisym, side, xi, committed, trial, force, stiffness, report)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :, :)   !! (ndriver, 2, npoint) of the law [unit of each driver]
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)                      !! (npoint) [-]
    real(wp), intent(in) :: committed(:, :)            !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: trial(:, :)             !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(report_t), intent(inout) :: report
    integer :: p, apart

    if (size(die%corners, 2) == 0 .or. .not. allowed_penetration(material) > 0) return
    apart = 0
    if (axisym) apart = end_on_axis(side)
    if (apart > 0) apart = merge(1, size(xi), apart == 1)
    do p = 1, size(xi)
      if (p /= apart) call press_corner(die, law, material, drivers(:, :, p), axisym, side, xi, p, committed, trial(:, p), force, &
                                        stiffness, report)
    end do
  end subroutine press_corners

  !> End of a side that is a node on the axis: 1 or 2, 0 for none. A side along the axis has no surface at all.
  pure function end_on_axis(side) result(k)
    type(side_t), intent(in) :: side
    integer :: k

    if (min(side%x(1, 2), side%x(1, 2) + side%du(2)) > no_surface*side%length) then
      do k = 1, 2
        if (max(side%x(1, 2*k - 1), side%x(1, 2*k - 1) + side%du(2*k - 1)) <= no_surface*side%length) return
      end do
    end if
    k = 0
  end function end_on_axis

  !> Contact with the deepest corner of a die in the interval before a point.
  pure subroutine press_corner(die, law, material, drivers, axisym, side, xi, p, committed, trial, force, stiffness, report)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law [unit of each driver]
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)                      !! (npoint) [-]
    integer, intent(in) :: p
    real(wp), intent(in) :: committed(:, :)            !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: trial(:)                !! (nstate) of the point [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(report_t), intent(inout) :: report
    type(corner_t) :: corner, other
    real(wp) :: nodes(2, 3), from, to, worn(1), done, before(contact_block(.true., size(trial)))
    integer :: k, n, at_place

    if (size(die%corners, 2) == 0 .or. .not. allowed_penetration(material) > 0) return
    call interval_before(xi, p, from, to)
    if (.not. to > from) return
    n = contact_block(.true., size(trial))
    at_place = 2*n + 1
    nodes = nodes_in_axes(side)
    call deepest_at_side(die, side, nodes, from, to, corner)
    if (.not. corner%found) return
    call keep_corner(die, material, side, nodes, from, to, committed(n + 1:2*n, p), corner)
    trial(at_place:) = [shown_place(corner), share_of(corner)]
    before = corner_at_start(die, material, side, committed, p, corner, first=.true.)
    associate (now => trial(n + 1:2*n))
      worn = thinning(committed(at_place:at_place, p), [corner%place], side%section, side%thickening, side%x, side%du(1:6))
      now(at_work) = before(at_work)*worn(1)
      done = now(at_work)
      call corner_at(law, material, drivers, axisym, side, corner, to - from, before, now, force, stiffness)
      ! friction acts with the share of the corner
      now(at_work) = done + share_of(corner)*(now(at_work) - done)
      call report_corner(side, before, now, report)
    end associate
    do k = 1, size(die%corners, 2)
      if (k == corner%number) cycle
      call corner_at_side(die, k, side, nodes, from, to, other)
      if (.not. other%found) cycle
      before = corner_at_start(die, material, side, committed, p, other, first=.false.)
      before(at_work) = 0
      call press_another(law, material, drivers, axisym, side, other, to - from, before, corner%place, trial(n + 1:2*n), force, &
                         stiffness, report)
    end do
  end subroutine press_corner

  !> What is in contact goes on without a jump, what comes into contact within a step does so at its beginning.
  pure subroutine report_corner(side, before, now, report)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: before(:), now(:)   !! (nstate) of the corner [unit of each component]
    type(report_t), intent(inout) :: report

    if (nint(before(at_status)) /= contact_open) then
      report%jump = max(report%jump, abs(now(at_penetration) - before(at_penetration))/side%length)
    end if
    report%event = min(report%event, share_to_contact(before, now, side%length))
  end subroutine report_corner

  !> Contact of a corner beside the one whose state is kept, added to that.
  pure subroutine press_another(law, material, drivers, axisym, side, corner, weight, before, place, kept, force, stiffness, report)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law [unit of each driver]
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    type(corner_t), intent(in) :: corner
    real(wp), intent(in) :: weight, before(:)   !! of the interval [-]; (nstate) of this corner [unit of each component]
    real(wp), intent(in) :: place               !! of the corner whose state is kept [-]
    real(wp), intent(inout) :: kept(:)          !! (nstate) of that corner [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(report_t), intent(inout) :: report
    real(wp) :: now(size(before)), part, taken, y(2, 3)

    now = before
    now([at_pressure, at_tau, at_status]) = 0
    call corner_at(law, material, drivers, axisym, side, corner, weight, before, now, force, stiffness)
    call report_corner(side, before, now, report)
    if (nint(now(at_status)) == contact_open) return
    y(1, :) = side%x(1, :) + side%du(1:3)
    y(2, :) = side%x(2, :) + side%du(4:6)
    part = area_at(place, side%section, y)
    if (.not. part > 0) return
    part = share_of(corner)*area_at(corner%place, side%section, y)/part
    taken = now(at_work) + 0.5_wp*now(at_tau)**2/side%penalty(2)
    kept([at_pressure, at_between]) = kept([at_pressure, at_between]) + part*now(at_pressure)
    kept(at_energy) = kept(at_energy) + part*0.5_wp*now(at_pressure)*(now(at_penetration) - free_depth(material, side))
    kept(at_work) = kept(at_work) + part*taken
  end subroutine press_another

  !> A corner of the die was in contact beside a point within the side as the step began, nearer than an end of a side would
  !> take its load over from it.
  pure function corner_beside(xi, p, committed) result(yes)
    real(wp), intent(in) :: xi(:)              !! (npoint) [-]
    integer, intent(in) :: p
    real(wp), intent(in) :: committed(:, :)    !! (nstate, npoint) [unit of each component]
    logical :: yes
    integer :: q, n

    n = contact_block(.true., size(committed, 1))
    yes = .false.
    if (1 - abs(xi(p)) < handing_over) return
    do q = p, min(size(xi), p + 1)
      if (nint(committed(n + at_status, q)) == contact_open) cycle
      if (abs(committed(2*n + 1, q) - xi(p)) < handing_over) yes = .true.
    end do
  end function corner_beside

  !> Place in the state of a corner: one that passes a node is within its side; at an end of it is the state of a node on the axis
  !> alone (axis_contact).
  elemental function shown_place(corner) result(place)
    type(corner_t), intent(in) :: corner
    real(wp) :: place
    real(wp), parameter :: last = 1 - epsilon(1.0_wp)

    place = max(-last, min(last, corner%place))
  end function shown_place

  !> Contact at one corner: state, forces, matrix.
  pure subroutine corner_at(law, material, drivers, axisym, side, corner, weight, committed, trial, force, stiffness)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    type(corner_t), intent(in) :: corner
    real(wp), intent(in) :: weight, committed(:)
    real(wp), intent(inout) :: trial(:), force(ndof), stiffness(ndof, ndof)
    type(contact_point_t) :: point
    type(drift_t) :: drift
    real(wp) :: share, before(ndof)

    call place_point(side, corner%place, point)
    if (axisym .and. point%x(1) <= no_surface*side%length) return
    share = share_of(corner)
    if (.not. bears(material, side, corner, committed)) then
      ! its gap is known; at the very end of the side the next one has it
      trial([at_penetration, at_piece, at_xi]) = [corner%d, real(corner%piece, wp), corner%xi]
      return
    end if
    call follow_corner(side, corner, point, drift)
    before = force
    call press(law, material, drivers, side, corner%place, point, closest_at_corner(corner), &
               free_depth(material, side), weight*share, committed, trial, force, stiffness, drift)
    if (.not. (side%tangent .and. share < 1)) return
    ! the share changes with the position
    stiffness = stiffness + slope_of_share(corner)/share*spread(force - before, 2, ndof)*spread(drift%dxi, 1, ndof)
  end subroutine corner_at

  !> The position of a corner on the side moves with nodes and pilot, and the point with it: from (V - y).y' = 0,
  !> ((V - y).y'' - y'.y') dxi = -(dV - dy).y' - (V - y).dy'.
  pure subroutine follow_corner(side, corner, point, drift)
    type(side_t), intent(in) :: side
    type(corner_t), intent(in) :: corner
    type(contact_point_t), intent(inout) :: point
    type(drift_t), intent(out) :: drift
    real(wp) :: phi(3), dphi(3), arm(2), way(2), bend(2), dv(2, ndof), dtangent(2, ndof), dxi(most_unknowns)
    real(wp), parameter :: second(3) = [1.0_wp, -2.0_wp, 1.0_wp]
    integer :: j

    call line3(corner%place, phi, dphi)
    arm = turned(corner%vertex, side%pilot(3, 2))
    way = side%pilot(1:2, 2) + arm - point%x
    bend = matmul(side%x, second) + [dot_product(second, side%du(1:3)), dot_product(second, side%du(4:6))]
    dv = 0
    dv(1, 7) = 1
    dv(2, 8) = 1
    dv(:, 9) = [-arm(2), arm(1)]
    dtangent = 0
    dtangent(1, 1:3) = dphi
    dtangent(2, 4:6) = dphi
    drift%dxi = (matmul(point%tangent, dv - point%dx(:, :ndof)) + matmul(way, dtangent)) &
                /(point%length**2 - dot_product(way, bend))
    dxi = 0
    dxi(:ndof) = drift%dxi
    point%dx(:, :ndof) = point%dx(:, :ndof) + outer(point%tangent, drift%dxi)
    point%dlength = point%dlength + dot_product(point%tangent, bend)/point%length*dxi
    point%dthickness = point%dthickness + dot_product(side%section(2:3), point%tangent)*dxi
    drift%spin(9) = 1
    if (.not. corner%own) return
    do j = 1, ndof
      drift%spin(j) = dot_product(point%e_r, dtangent(:, j) + bend*drift%dxi(j))/point%length
    end do
  end subroutine follow_corner

end module corner_contact
