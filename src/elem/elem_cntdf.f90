!> CNTDF: contact of a 3-node side of a body with a die made of sides of other bodies.
!>
!> Depth, normal, law and state are those of CNT2D: the die is the curve of the other sides where they
!> now are, Y(xi) = sum_k psi_k(xi) Y_k. The closest point, at xi, to a point X makes (X - Y).Y' = 0; with its unit
!> tangent t, the inner normal n, the curvature kappa and w = -n.dY'/|Y'|, the turn of the tangent at
!> fixed xi, the depth d = (X - Y).n and the normal change by
!>
!>     dd = n.(dX - dY),   dn = t (kappa t.(dX - dY) + w)/(1 + kappa d),   dY at fixed xi.
!>
!> The closest point itself moves by dxi = (t.(dX - dY) - d w)/(|Y'| (1 + kappa d)).
!>
!> The slip of a step is the displacement of the point relative to the material point closest to it, in axes that
!> turn with the tangent there: with X0, Y0(xi), t0(xi) at the start of the step it is t0.(Y0 - X0),
!> since t.(X - Y) = 0 at its end. A rigid motion of both bodies makes none. At a vertex between two
!> sides the axes turn with the end of the first.
!>
!> The point gets the traction, the nodes of the side with the closest point psi_k of its opposite: what one body gains
!> the other loses, point by point. Each side is coupled with a few pieces only (pairs): a closest point on
!> another piece is reported, and the pairs are renewed before the result is used.
!>
!> An edge of the other body between two points is one more point of contact of the side (edge_contact).
!>
!> A body may face itself (own_contact, own_closest_point).
module elem_cntdf
  use contact_point, only: act, at_penetration, at_piece, at_status, at_work, at_xi, contact_block, contact_point_t, meeting_t, &
                           most_unknowns, no_surface, penalties, rest, share_to_contact, show_on_axis, side_length, &
                           side_point, thinning
  use closest_point, only: closest_point_t
  use contact_penalties, only: allowed_penetration
  use curve_search, only: box_distance, closest_facing_point
  use dies, only: die_t
  use edge_contact, only: press_edges
  use edge_release, only: edge_release_t, slide_past_edge, slide_past_end
  use elem_api, only: elem_t, goes_on, instant_t, layout_t, of_displacement, of_section, report_t, section_motion
  use elem_cnt2d, only: elem_cnt2d_row
  use kept_side, only: handed_over_t, keep_closest_point
  use kinds, only: eps, wp
  use kinematics_api, only: kinematics_t
  use law_api, only: contact_open, law_t
  use own_closest_point, only: find_own_closest_point
  use own_contact, only: faces_itself, pieces_to_meet
  use pair_forces, only: spread_force, spread_matrix
  use pairs, only: list_pieces, nodes_per_piece, pieces_in_reach
  use plane_vectors, only: cross
  use quadrature, only: line_rule
  use rigid_contact, only: side_t
  use scene, only: axisymmetric, generalised_plane_strain, group_t, scene_t
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: elem_cntdf_row

  !> At a vertex the normal turns about the closest point: turn d = 1 to some round-off.
  real(wp), parameter :: at_vertex = 64*eps

contains

  !> As CNT2D, but for the die.
  function elem_cntdf_row() result(row)
    type(elem_t) :: row

    row = elem_cnt2d_row()
    row%name = 'CNTDF'
    row%purpose = 'contact of a side with sides of another body'
    deallocate (row%unknowns)
    allocate (row%unknowns, source=[of_displacement(), of_section()])
    row%compute => compute
  end function elem_cntdf_row

  subroutine compute(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
                     force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :), start(:, :), drivers(:, :, :, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report
    type(contact_point_t) :: point
    type(closest_point_t) :: closest, nearest
    type(edge_release_t) :: release
    type(handed_over_t) :: handed
    real(wp), allocatable :: xi(:), weight(:), there(:)
    real(wp) :: side, section(3), phi(3), dphi(3), psi(3), dpsi(3), q(2), dxi(most_unknowns), way(most_unknowns)
    integer :: e, p, n, nnode, npiece, nblock, place(most_unknowns), along(most_unknowns), &
               pieces(pieces_in_reach*group%rule%n)
    logical, allocatable :: may(:, :)
    logical :: axisym

    axisym = scene%plane_state == axisymmetric
    nnode = size(x, 2)
    nblock = contact_block(.true., size(trial, 1))
    if (faces_itself(scene, group)) then
      allocate (may(size(scene%dies(group%die)%nodes, 2), size(x, 3)))
      call pieces_to_meet(scene, group, first, may)
    end if
    n = merge(most_unknowns, most_unknowns - 3, scene%plane_state == generalised_plane_strain)
    call line_rule(group%rule, xi, weight)
    associate (die => instant%dies(group%die), middle => instant%pairs(group%pairs)%piece(:, first:first + size(x, 3) - 1))
      do e = 1, size(x, 3)
        call begin_side()
        if (box_distance(die, box_of(x(:, 1:3, e), du(place(1:6), e))) > side) cycle
        call list_pieces(die, middle(:, e), npiece, pieces)
        do p = 1, size(xi)
          call press_point(die, middle(p, e))
        end do
        if (.not. allocated(may)) call press_edges_met(die)
        if (axisym) call show_on_axis(xi, x(1, 1:3, e) + du(1:3, e), side, trial(:, :, e))
      end do
    end associate
    if (.not. goes_on(instant, group%die)) report%jump = 0

  contains

    !> A side that nothing presses on: its length, its section, and where its unknowns stand; its points are at rest, with the
    !> friction work that they had, per area of now.
    subroutine begin_side()
      force(:, e) = 0
      if (instant%tangent) stiffness(:, :, e) = 0
      trial(:, :, e) = committed(:, :, e)
      call rest(trial(:nblock, :, e))
      call rest(trial(nblock + 1:2*nblock, :, e))
      side = side_length(scene, group%connectivity(:, first + e - 1))
      section = scene%section
      if (scene%finite) section = instant%section + section_motion(layout, du(:, e))
      place(1:6) = [1, 2, 3, nnode + 1, nnode + 2, nnode + 3]
      place(13:15) = [2*nnode + 1, 2*nnode + 2, 2*nnode + 3]
      associate (thickening => section_motion(layout, du(:, e)), at_edge => committed(2*nblock + 1, :, e))
        trial(at_work, :, e) = committed(at_work, :, e)*thinning(xi, xi, section, thickening, x(:, 1:3, e), du(place(1:6), e))
        trial(nblock + at_work, :, e) = committed(nblock + at_work, :, e) &
                                        *thinning(at_edge, at_edge, section, thickening, x(:, 1:3, e), du(place(1:6), e))
      end associate
    end subroutine begin_side

    !> The point meets the die, or is handed over from a side of it to the next.
    subroutine press_point(die, middle)
      type(die_t), intent(in) :: die
      integer, intent(in) :: middle   !! piece of the die that the point is paired with

      call line3(xi(p), phi, dphi)
      call side_point(phi, dphi, section, x(:, 1:3, e), du(place(1:6), e), most_unknowns, point)
      call find_closest_point(die, middle)
      ! a point on the axis has no surface: nothing acts there, and no contact is evaluated
      if (closest%piece == 0 .or. axisym .and. point%x(1) <= no_surface*side) return
      trial(at_penetration, p, e) = merge(release%depth, closest%d, release%limited)
      trial([at_piece, at_xi], p, e) = [real(nearest%piece, wp), nearest%xi]
      ! past an edge its pressure is gone
      if (.not. release%share > 0) return
      if (handed%share > 0) there = trial(:nblock, p, e)
      call press(closest, (1 - handed%share)*release%share, trial(:nblock, p, e))
      if (handed%share > 0) call press_next()
      if (nint(committed(at_status, p, e)) /= contact_open) then
        report%jump = max(report%jump, abs(trial(at_penetration, p, e) - committed(at_penetration, p, e))/side)
      end if
      report%event = min(report%event, share_to_contact(committed(:nblock, p, e), trial(:nblock, p, e), side))
    end subroutine press_point

    !> The closest point, on no piece where there is none; the nearest one, to which the point may be handed over, and what an edge
    !> that it slides past leaves of it.
    subroutine find_closest_point(die, middle)
      type(die_t), intent(in) :: die
      integer, intent(in) :: middle   !! piece of the die that the point is paired with
      integer :: kept_piece

      closest = closest_point_t()
      if (allocated(may)) then
        call find_own_closest_point(scene, group, first + e - 1, die, may(:, e), point, phi, side, committed(:, p, e), nearest)
      else
        call closest_facing_point(die, point%x, point%e_r, side, nearest)
      end if
      ! a stale pair of a body's own side may be the far face of a wall
      if (allocated(may) .and. nearest%piece == 0) return
      call keep_closest_point(die, point, side, committed(:nblock, p, e), middle, nearest, closest, handed)
      kept_piece = closest%piece
      release = edge_release_t()
      if (.not. allocated(may)) then
        call slide_past_edge(scene%mesh%coordinates, die, point%x, side, &
                             allowed_penetration(scene%materials(group%material))*side, committed(:nblock, p, e), nearest, &
                             closest, release)
      end if
      if (.not. release%share < 1) call slide_past_end(die, closest, release)
      if (release%share < 1 .or. closest%piece /= kept_piece .or. nearest%piece == kept_piece) handed = handed_over_t()
    end subroutine find_closest_point

    !> What the next side bears of a point that is handed over to it.
    subroutine press_next()
      way = handed%slope*dxi
      along = place
      call hand_over(-way/(1 - handed%share))
      there(at_penetration) = nearest%d
      call press(nearest, handed%share, there)
      call hand_over(way/handed%share)
      call share_state(handed%share, there, trial(:nblock, p, e))
    end subroutine press_next

    !> The edges of the die that the side meets between its points.
    subroutine press_edges_met(die)
      type(die_t), intent(in) :: die
      type(side_t) :: own

      own%x = x(:, 1:3, e)
      own%du(1:6) = du(place(1:6), e)
      own%section = section
      own%thickening = section_motion(layout, du(:, e))
      own%length = side
      own%penalty = penalties(scene%materials(group%material), group, side)
      own%dt = instant%dt
      own%tangent = instant%tangent
      own%kept = instant%kept .and. goes_on(instant, group%die)
      own%penalty_share = instant%penalty_share
      call press_edges(die, law, scene%materials(group%material), drivers(:, :, :, e), axisym, own, xi, pieces(:npiece), &
                       x(:, :, e), du(:, e), committed(:, :, e), trial(:, :, e), force(:, e), stiffness(:, :, e), report)
    end subroutine press_edges_met

    !> The force between the point and a side that it meets, which bears this share of it; its state goes on to `state`.
    subroutine press(met, share, state)
      type(closest_point_t), intent(in) :: met
      real(wp), intent(in) :: share
      real(wp), intent(inout) :: state(:)   !! (nstate) [unit of each component]
      type(meeting_t) :: meeting
      real(wp) :: dq(2, most_unknowns)
      integer :: j, k, at

      q = 0
      dxi = 0
      k = findloc(pieces(:npiece), met%piece, 1)
      if (k == 0) then
        report%unpaired = .true.
        return
      end if
      at = 3 + nodes_per_piece*(k - 1)
      place(7:12) = [at + 1, at + 2, at + 3, nnode + at + 1, nnode + at + 2, nnode + at + 3]
      call line3(met%xi, psi, dpsi)
      call meet(met, matmul(x(:, 1:3, e), phi), x(:, at + 1:at + 3, e), du(place(7:12), e), point, meeting, dxi)
      if (release%limited) then
        meeting%d = release%depth
        meeting%dd = release%depth_slope*dxi
      end if
      meeting%kept = instant%kept .and. goes_on(instant, group%die)
      meeting%penalty_share = instant%penalty_share
      call act(law, scene%materials(group%material), instant%dt, drivers(:, :, p, e), &
               penalties(scene%materials(group%material), group, side), point, meeting, weight(p)*share, instant%tangent, &
               committed(:nblock, p, e), state, q, dq)
      if (nint(state(at_status)) == contact_open) return
      call spread_force([-phi, psi], q, place, force(:, e))
      if (.not. instant%tangent) return
      call spread_matrix([-phi, psi], dq(:, :n), place(:n), stiffness(:, :, e))
      ! the closest point moves along its side
      do j = 1, n
        call spread_force([0.0_wp, 0.0_wp, 0.0_wp, dpsi*dxi(j)], q, place, stiffness(:, place(j), e))
        if (release%share < 1) call spread_force([-phi, psi]*(release%slope*dxi(j)/release%share), q, place, &
                                                 stiffness(:, place(j), e))
      end do
    end subroutine press

    !> The share of the force just made changes with the way along the side that the point began with.
    subroutine hand_over(change)
      real(wp), intent(in) :: change(:)   !! (nunknown) of the share over the share, along the unknowns of that side [1/unknown]
      integer :: j

      if (.not. instant%tangent) return
      do j = 1, n
        call spread_force([-phi, psi]*change(j), q, place, stiffness(:, along(j), e))
      end do
    end subroutine hand_over
  end subroutine compute

  !> The state of a point that is on two sides: that of the first becomes the mean of both; it is in contact where one of them is.
  pure subroutine share_state(share, other, state)
    real(wp), intent(in) :: share, other(:)   !! of the other one, and its state [unit of each component]
    real(wp), intent(inout) :: state(:)
    real(wp) :: status

    status = state(at_status)
    if (nint(status) == contact_open .or. share > 0.5_wp .and. nint(other(at_status)) /= contact_open) status = other(at_status)
    state = state + share*(other - state)
    state(at_status) = status
  end subroutine share_state

  !> Smallest box around the nodes of a side (xmin, ymin, xmax, ymax).
  pure function box_of(x, du) result(box)
    real(wp), intent(in) :: x(2, 3), du(6)
    real(wp) :: box(4)

    box = [minval(x(1, :) + du(1:3)), minval(x(2, :) + du(4:6)), maxval(x(1, :) + du(1:3)), maxval(x(2, :) + du(4:6))]
  end function box_of

  !> Depth, slip and turn of the normal where a point meets a side, with their derivatives, and the motion of the closest
  !> point along the side. Unknowns 7 to 12 are those of the side met.
  pure subroutine meet(closest, start, x, du, point, meeting, dxi)
    type(closest_point_t), intent(in) :: closest
    real(wp), intent(in) :: start(2)   !! the point at the start of the step [length]
    real(wp), intent(in) :: x(2, 3)    !! the side met, at the start of the step [length]
    real(wp), intent(in) :: du(6)      !! motion of its nodes, x then y
    type(contact_point_t), intent(in) :: point
    type(meeting_t), intent(out) :: meeting
    real(wp), intent(out) :: dxi(most_unknowns)
    real(wp) :: psi(3), dpsi(3), y(2, 3), t(2), n(2), first0(2), first(2), axis0(2), axis(2), t0(2), n0(2), gap0(2)
    real(wp) :: relative(2, most_unknowns), tangential(most_unknowns), turn_of_axes(most_unknowns), still, bend0

    call line3(closest%xi, psi, dpsi)
    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    first0 = matmul(x, dpsi)
    first = matmul(y, dpsi)
    axis0 = first0/length_of(first0)
    axis = first/length_of(first)
    n = closest%normal
    t = [-n(2), n(1)]
    meeting%d = closest%d
    meeting%normal = n

    relative = point%dx
    relative(1, 7:9) = -psi
    relative(2, 10:12) = -psi
    meeting%dd = matmul(n, relative)
    tangential = matmul(t, relative)
    turn_of_axes = 0
    turn_of_axes(7:9) = -axis(2)*dpsi/length_of(first)
    turn_of_axes(10:12) = axis(1)*dpsi/length_of(first)
    ! 1/(1 + kappa d), 0 at a vertex
    still = 1 - closest%turn*closest%d
    if (abs(still) <= at_vertex) still = 0
    meeting%turn = closest%turn*tangential + still*turn_of_axes

    dxi = still*(tangential - closest%d*turn_of_axes)/length_of(first)

    ! the tangent of the fan at a vertex, in axes that turn with the side
    t0 = dot_product(axis, t)*axis0 + cross(axis, t)*[-axis0(2), axis0(1)]
    n0 = [t0(2), -t0(1)]
    gap0 = start - matmul(x, psi)
    meeting%slip = -dot_product(t0, gap0)
    if (abs(still) > 0) then
      bend0 = cross(first0, x(:, 1) - 2*x(:, 2) + x(:, 3))/length_of(first0)**3
      meeting%dslip = length_of(first0)*(1 + bend0*dot_product(n0, gap0))*dxi
    else
      meeting%dslip = dot_product(n0, gap0)*(meeting%turn - turn_of_axes)
    end if
  end subroutine meet

end module elem_cntdf
