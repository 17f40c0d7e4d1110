!> CNT2D: contact of a 3-node side of the part with a die (annex 3).
!>
!> Walking 1 -> 2 -> 3 the part is on the left. At an integration point d is the penetration below
!> the closest point of the die (die_search), n the die's inner normal and t its tangent there, in
!> the sense of the walk. The traction on the part is -p n - tau t, per length of the side. The
!> annex measures d and p along the part's own normal e_R; on a side that lies on the die they are
!> the same, on one that is about to fold the die's normal is the one that is continuous.
!>
!> The slip of a step is the way of the part's point relative to the die, taken in the axes of the
!> pilot, along t: a rigid motion of part and die together makes none. When contact begins inside
!> the step only the share d/(d - d_start) of the way counts.
!>
!> A corner of the die between two integration points is one more point of contact of the side
!> (side_corners), with the length of the stretch between them as its weight. It acts on what is deeper
!> than half the allowed penetration, where one is given.
!>
!> Forces are integrated consistently over the side. The reaction acts on the pilot: force, and
!> moment about it. Everything is linearised exactly, the curvature of the die included.
module elem_cnt2d
  use die_search, only: box_distance, find_foot, follow_foot, foot_t
  use dies, only: die_t
  use elem_api, only: elem_t, instant_t, report_t, totals_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: contact_law, contact_open, contact_slip, contact_stick, law_t
  use materials, only: material_t
  use quadrature, only: line_rule
  use scene, only: axisymmetric, group_t, scene_t
  use shape_functions, only: line3
  use side_corners, only: corner_t, deepest_corner, foot_at_corner
  use state_variables, only: state_variable, state_variable_t, transfer_contact, transfer_recompute
  implicit none
  private
  public :: elem_cnt2d_row

  !> Places in the state of a point.
  integer, parameter :: at_pressure = 1, at_tau = 2, at_penetration = 3, at_status = 4, at_slip = 5, &
                        at_augmentation = 6, at_work = 7, at_piece = 8, at_xi = 9
  !> After them the same of a corner of the die between this point and the one before, and its place on the side.
  integer, parameter :: npoint_state = 9, at_place = 2*npoint_state + 1
  !> Place of the largest number of augmentations among a contact law's values (contact_penalties).
  integer, parameter :: at_augment = 4
  !> Local unknowns: x of the side's nodes, y of them, pilot x, y, angle.
  integer, parameter :: ndof = 9

  !> A radius below this share of the side is the axis.
  real(wp), parameter :: no_surface = 1.0e-9_wp
  !> Tangential penalty over the normal one, where it is not given: an elastic slip of ten times the
  !> penetration, so that sticking and slipping points do not chatter; error of friction at PHI = 0.5
  !> about half a percent of a side, as in common use.
  real(wp), parameter :: tangential_share = 0.1_wp
  !> A point that comes into contact may overlap the die by this share of the side in the predictor of a step.
  real(wp), parameter :: overlap_limit = 0.01_wp

  !> A corner acts on what is deeper than this share of the allowed penetration: a side that lies on the die by a corner
  !> has its points for that.
  real(wp), parameter :: corner_share = 0.5_wp

  !> Augmentation takes away the depth of points, not the bend of the side between them: points that are deep by less than
  !> this share of the allowed penetration have no more to give.
  real(wp), parameter :: worth_augmenting = 0.5_wp

  !> A point of the side in the present geometry, with derivatives along the local unknowns.
  type :: contact_point_t
    real(wp) :: x(2), tangent(2), length, e_r(2), radius
    real(wp) :: dx(2, ndof), dlength(ndof), dradius(ndof)
  end type contact_point_t

contains

  function elem_cnt2d_row() result(row)
    type(elem_t) :: row

    row%name = 'CNT2D'
    row%purpose = 'contact of a side with a die'
    row%nnode = 3
    row%law_kind = contact_law
    row%pilot = .true.
    row%follows = .true.
    row%symmetric = .false.
    row%effect = 'contact'
    row%variables => variables
    row%compute => compute
    row%measure => measure
    row%augment => augment
  end function elem_cnt2d_row

  pure subroutine variables(law, list)
    type(law_t), intent(in) :: law
    type(state_variable_t), allocatable, intent(out) :: list(:)
    type(state_variable_t), allocatable :: own(:)
    integer :: k

    allocate (own, source=[state_variable('pressure', 'stress', transfer_contact), &
           state_variable('friction', 'stress', transfer_contact), &
           state_variable('penetration', 'length', transfer_recompute), &
           state_variable('contact_status', '-', transfer_recompute), &
           state_variable('slip', 'length', transfer_contact), &
           state_variable('augmentation', 'stress', transfer_contact), &
           state_variable('friction_work', 'stress*length', transfer_contact), &
           state_variable('die_piece', '-', transfer_recompute), &
           state_variable('die_xi', '-', transfer_recompute)])
    allocate (list, source=[own, own, state_variable('corner_place', '-', transfer_recompute), law%history])
    do k = 1, npoint_state
      list(npoint_state + k)%name = 'corner_'//own(k)%name
      list(npoint_state + k)%transfer = transfer_recompute
    end do
    do k = 1, size(list)
      list(k)%first = k
    end do
  end subroutine variables

  subroutine compute(scene, group, kinematics, law, instant, first, x, du, committed, trial, force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: side, pilot(3, 2)
    integer :: e, p
    logical :: axisym

    axisym = scene%plane_state == axisymmetric
    call line_rule(group%npoint, xi, weight)
    do e = 1, size(x, 3)
      force(:, e) = 0
      if (instant%tangent) stiffness(:, :, e) = 0
      trial(:, :, e) = committed(:, :, e)
      call rest(trial(:npoint_state, :, e))
      call rest(trial(npoint_state + 1:2*npoint_state, :, e))
      side = side_length(scene, group%connectivity(:, first + e - 1))
      pilot(:, 1) = instant%pilots(:, group%die)
      pilot(:, 2) = pilot(:, 1) + du(7:9, e)
      if (far(scene%dies(group%die), x(:, :, e), du(:, e), pilot(:, 2), side)) cycle
      do p = 1, size(xi)
        call contact_at(scene%dies(group%die), law, scene%materials(group%material), axisym, group%amplitude, side, &
                        x(:, :, e), du(:, e), pilot, xi(p), weight(p), instant%tangent, 0.0_wp, &
                        committed(:npoint_state, p, e), trial(:npoint_state, p, e), force(:, e), stiffness(:, :, e))
        if (nint(committed(at_status, p, e)) /= contact_open) then
          report%jump = max(report%jump, abs(trial(at_penetration, p, e) - committed(at_penetration, p, e))/side)
        end if
        report%event = min(report%event, share_to_contact(committed(:, p, e), trial(:, p, e), side))
      end do
      call contact_of_corners(scene%dies(group%die), law, scene%materials(group%material), axisym, group%amplitude, side, &
                              x(:, :, e), du(:, e), pilot, xi, instant%tangent, &
                              committed(:, :, e), trial(:, :, e), force(:, e), stiffness(:, :, e), report)
      if (axisym) call show_on_axis(xi, x(1, :, e) + du(1:3, e), side, trial(:, :, e))
    end do
  end subroutine compute

  !> A point without contact: what it has slipped and worn stays.
  pure subroutine rest(state)
    real(wp), intent(inout) :: state(:, :)

    state([at_pressure, at_tau, at_status, at_penetration, at_piece, at_xi, at_augmentation], :) = 0
  end subroutine rest

  !> Contact of the corners of the die between integration points.
  pure subroutine contact_of_corners(die, law, material, axisym, modulus, side, x, du, pilot, xi, tangent_wanted, &
                                     committed, trial, force, stiffness, report)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical, intent(in) :: axisym, tangent_wanted
    real(wp), intent(in) :: modulus, side, x(2, 3), du(ndof), pilot(3, 2), xi(:), committed(:, :)
    real(wp), intent(inout) :: trial(:, :), force(ndof), stiffness(ndof, ndof)
    type(report_t), intent(inout) :: report
    type(corner_t) :: corner
    real(wp) :: nodes(2, 3), from, to
    integer :: p, k

    if (size(die%corners, 2) == 0 .or. .not. material%values(1) > 0) return
    do k = 1, 3
      nodes(:, k) = turned([x(1, k) + du(k), x(2, k) + du(k + 3)] - pilot(1:2, 2), -pilot(3, 2))
    end do
    do p = 1, size(xi)
      call stretch_before(xi, p, from, to)
      if (.not. to > from) cycle
      call deepest_corner(die, nodes, from, to, side, corner)
      if (.not. corner%found) cycle
      trial(at_place, p) = corner%place
      associate (before => committed(npoint_state + 1:2*npoint_state, p), now => trial(npoint_state + 1:2*npoint_state, p))
        call contact_at(die, law, material, axisym, modulus, side, x, du, pilot, corner%place, to - from, tangent_wanted, &
                        corner_share*material%values(1)*side, before, now, force, stiffness, corner)
        if (nint(before(at_status)) /= contact_open) then
          report%jump = max(report%jump, abs(now(at_penetration) - before(at_penetration))/side)
        end if
        report%event = min(report%event, share_to_contact(before, now, side))
      end associate
    end do
  end subroutine contact_of_corners

  !> The stretch of the side between a point and the one before; the last one goes on to the end of the side.
  pure subroutine stretch_before(xi, p, from, to)
    real(wp), intent(in) :: xi(:)
    integer, intent(in) :: p
    real(wp), intent(out) :: from, to

    from = -1
    if (p > 1) from = xi(p - 1)
    to = xi(p)
    if (p == size(xi)) to = 1
  end subroutine stretch_before

  !> Stresses shown at a point on the axis, where none act: on the line through its two neighbours.
  pure subroutine show_on_axis(xi, x, side, trial)
    real(wp), intent(in) :: xi(:), x(3), side
    real(wp), intent(inout) :: trial(:, :)
    real(wp) :: phi(3), dphi(3), share
    integer :: p, step, n

    n = size(xi)
    if (n < 3) return
    do p = 1, n, n - 1
      call line3(xi(p), phi, dphi)
      if (dot_product(phi, x) > no_surface*side) cycle
      step = merge(1, -1, p == 1)
      share = (xi(p) - xi(p + step))/(xi(p + 2*step) - xi(p + step))
      trial([at_pressure, at_tau], p) = (1 - share)*trial([at_pressure, at_tau], p + step) &
                                        + share*trial([at_pressure, at_tau], p + 2*step)
    end do
  end subroutine show_on_axis

  !> Share of the step after which a point that was open, its gap known, overlaps the die by `overlap_limit` of the side.
  pure function share_to_contact(committed, trial, side) result(share)
    real(wp), intent(in) :: committed(:), trial(:), side
    real(wp) :: share
    real(wp) :: gap

    share = 1
    if (nint(committed(at_status)) /= contact_open .or. nint(trial(at_status)) == contact_open) return
    if (nint(committed(at_piece)) == 0) return
    if (trial(at_penetration) <= overlap_limit*side) return
    gap = max(-committed(at_penetration), 0.0_wp)
    share = (gap + overlap_limit*side)/(gap + trial(at_penetration))
  end function share_to_contact

  !> Side and die are further apart than the search would reach: the side sleeps.
  pure function far(die, x, du, pilot, reach) result(asleep)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: x(2, 3), du(:), pilot(3), reach
    logical :: asleep
    real(wp) :: y(2, 3)
    integer :: k

    do k = 1, 3
      y(:, k) = turned([x(1, k) + du(k), x(2, k) + du(k + 3)] - pilot(1:2), -pilot(3))
    end do
    asleep = box_distance(die, [minval(y(1, :)), minval(y(2, :)), maxval(y(1, :)), maxval(y(2, :))]) > reach
  end function far

  !> Contact at one integration point: state, forces, matrix.
  pure subroutine contact_at(die, law, material, axisym, modulus, side, x, du, pilot, xi, weight, tangent_wanted, &
                             allowed, committed, trial, force, stiffness, corner)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical, intent(in) :: axisym, tangent_wanted
    real(wp), intent(in) :: modulus, side, x(2, 3), du(ndof), pilot(3, 2), xi, weight
    real(wp), intent(in) :: committed(:)
    real(wp), intent(in) :: allowed          !! depth that needs no pressure [length]
    real(wp), intent(inout) :: trial(:), force(ndof), stiffness(ndof, ndof)
    type(corner_t), intent(in), optional :: corner   !! the point is where a corner of the die is
    type(contact_point_t) :: point
    type(foot_t) :: foot
    real(wp) :: phi(3), dphi(3), n(2), t(2), lever(2), way(2), turn(2), q(2), moment, share, slip, depth, depth_before
    real(wp), dimension(ndof) :: dd, along, dslip, dp, dtau, dmoment, dxi, spin
    real(wp), dimension(2, ndof) :: relative, dn, dt, dway, dlever, dq
    real(wp) :: penalty(2), pressure, tau, law_tangent(2, 2)
    integer :: status, j, k

    call line3(xi, phi, dphi)
    call side_point(phi, dphi, axisym, x, du, point)
    lever = point%x - pilot(1:2, 2)
    dxi = 0
    if (present(corner)) then
      foot = foot_at_corner(corner)
      call move_with_corner(dphi, x, du, pilot, corner, point, dxi, spin)
    else
      call foot_of(die, turned(lever, -pilot(3, 2)), turned(point%e_r, -pilot(3, 2)), side, committed, foot)
      if (foot%piece == 0) return
    end if
    ! a point on the axis has no surface: nothing acts there, and nothing is asked of it
    if (axisym .and. point%radius <= no_surface*side) return
    trial(at_penetration) = foot%d
    trial(at_piece) = foot%piece
    trial(at_xi) = foot%xi
    n = turned(foot%normal, pilot(3, 2))
    t = [-n(2), n(1)]

    ! motion of the point relative to the die, and what it does to depth and normal
    dlever = point%dx
    dlever(1, 7) = dlever(1, 7) - 1
    dlever(2, 8) = dlever(2, 8) - 1
    relative = dlever
    relative(:, 9) = relative(:, 9) - [-lever(2), lever(1)]
    dd = matmul(n, relative)
    along = foot%turn*matmul(t, relative)
    along(9) = along(9) + 1
    if (present(corner)) along = spin
    do j = 1, ndof
      dn(:, j) = along(j)*t
      dt(:, j) = -along(j)*n
    end do

    ! way relative to the die, in its axes, turned back into the present ones
    turn = turned(matmul(x, phi) - pilot(1:2, 1), pilot(3, 2) - pilot(3, 1))
    way = lever - turn
    slip = dot_product(t, way)
    dway = dlever
    dway(:, 9) = dway(:, 9) - [-turn(2), turn(1)]
    if (present(corner)) dway = dway - outer(turned(matmul(x, dphi), pilot(3, 2) - pilot(3, 1)), dxi)
    dslip = matmul(t, dway) + matmul(way, dt)
    depth = foot%d - allowed
    depth_before = committed(at_penetration) - allowed
    if (nint(committed(at_status)) == contact_open .and. depth_before < 0 .and. depth > 0) then
      share = depth/(depth - depth_before)
      dslip = share*dslip - slip*depth_before/(depth - depth_before)**2*dd
      slip = share*slip
    end if

    penalty = penalties(material, modulus, side)
    ! no corner pulls, whatever the law
    if (present(corner) .and. .not. committed(at_augmentation) + penalty(1)*depth > 0) return
    call law%slide(material, penalty, committed(at_augmentation), depth, slip, committed(at_tau), &
                   pressure, tau, law_tangent, status)
    trial(at_pressure) = pressure
    trial(at_tau) = tau
    trial(at_status) = status
    if (status == contact_open) return
    trial(at_augmentation) = committed(at_augmentation)
    trial(at_slip) = committed(at_slip) + slip
    if (status == contact_slip) trial(at_work) = committed(at_work) + tau*(slip - (tau - committed(at_tau))/penalty(2))

    ! traction times length, weight and radius; the part gets it, the pilot its opposite
    q = -(pressure*n + tau*t)*point%length*weight
    moment = lever(1)*q(2) - lever(2)*q(1)
    force(1:3) = force(1:3) - phi*q(1)*point%radius
    force(4:6) = force(4:6) - phi*q(2)*point%radius
    force(7:8) = force(7:8) + q*point%radius
    force(9) = force(9) + moment*point%radius
    if (.not. tangent_wanted) return

    dp = law_tangent(1, 1)*dd + law_tangent(1, 2)*dslip
    dtau = law_tangent(2, 1)*dd + law_tangent(2, 2)*dslip
    do j = 1, ndof
      dq(:, j) = -(dp(j)*n + dtau(j)*t + pressure*dn(:, j) + tau*dt(:, j))*point%length*weight &
                 + q*point%dlength(j)/point%length
    end do
    dmoment = dlever(1, :)*q(2) - dlever(2, :)*q(1) + lever(1)*dq(2, :) - lever(2)*dq(1, :)
    do j = 1, ndof
      dq(:, j) = dq(:, j)*point%radius + q*point%dradius(j)
      dmoment(j) = dmoment(j)*point%radius + moment*point%dradius(j)
      do k = 1, 3
        stiffness(k, j) = stiffness(k, j) - phi(k)*dq(1, j) - dphi(k)*dxi(j)*q(1)*point%radius
        stiffness(k + 3, j) = stiffness(k + 3, j) - phi(k)*dq(2, j) - dphi(k)*dxi(j)*q(2)*point%radius
      end do
      stiffness(7:8, j) = stiffness(7:8, j) + dq(:, j)
      stiffness(9, j) = stiffness(9, j) + dmoment(j)
    end do
  end subroutine contact_at

  !> The place of a corner on the side moves with nodes and pilot, and the point with it: from (V - y).y' = 0,
  !> ((V - y).y'' - y'.y') dxi = -(dV - dy).y' - (V - y).dy'. `spin` is the angle by which the normal turns.
  pure subroutine move_with_corner(dphi, x, du, pilot, corner, point, dxi, spin)
    real(wp), intent(in) :: dphi(3), x(2, 3), du(ndof), pilot(3, 2)
    type(corner_t), intent(in) :: corner
    type(contact_point_t), intent(inout) :: point
    real(wp), intent(out) :: dxi(ndof), spin(ndof)
    real(wp) :: arm(2), way(2), bend(2), dv(2, ndof), dtangent(2, ndof)
    real(wp), parameter :: second(3) = [1.0_wp, -2.0_wp, 1.0_wp]
    integer :: j

    arm = turned(corner%vertex, pilot(3, 2))
    way = pilot(1:2, 2) + arm - point%x
    bend = matmul(x, second) + [dot_product(second, du(1:3)), dot_product(second, du(4:6))]
    dv = 0
    dv(1, 7) = 1
    dv(2, 8) = 1
    dv(:, 9) = [-arm(2), arm(1)]
    dtangent = 0
    dtangent(1, 1:3) = dphi
    dtangent(2, 4:6) = dphi
    dxi = (matmul(point%tangent, dv - point%dx) + matmul(way, dtangent))/(point%length**2 - dot_product(way, bend))
    point%dx = point%dx + outer(point%tangent, dxi)
    point%dlength = point%dlength + dot_product(point%tangent, bend)/point%length*dxi
    ! the radius is 1, and stays so, in plane strain
    if (any(abs(point%dradius) > 0)) point%dradius = point%dradius + point%tangent(1)*dxi
    spin = 0
    spin(9) = 1
    if (.not. corner%own) return
    do j = 1, ndof
      spin(j) = dot_product(point%e_r, dtangent(:, j) + bend*dxi(j))/point%length
    end do
  end subroutine move_with_corner

  pure function outer(a, b) result(c)
    real(wp), intent(in) :: a(2), b(ndof)
    real(wp) :: c(2, ndof)

    c = spread(a, 2, ndof)*spread(b, 1, 2)
  end function outer

  !> Foot of a point: the closest, unless the one that continues the last accepted foot says that the point is inside.
  pure subroutine foot_of(die, point, e_r, reach, committed, foot)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2), e_r(2), reach, committed(:)
    type(foot_t), intent(out) :: foot
    type(foot_t) :: same
    integer :: piece

    call find_foot(die, point, e_r, reach, foot)
    piece = nint(committed(at_piece))
    if (piece == 0) return
    call follow_foot(die, point, e_r, reach, piece, committed(at_xi), same)
    if (same%piece > 0 .and. same%d > 0) foot = same
  end subroutine foot_of

  !> Position, length, inner normal and radius of a point of the side, and their derivatives.
  pure subroutine side_point(phi, dphi, axisym, x, du, point)
    real(wp), intent(in) :: phi(3), dphi(3), x(2, 3), du(ndof)
    logical, intent(in) :: axisym
    type(contact_point_t), intent(out) :: point
    real(wp) :: y(2, 3)

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    point%x = matmul(y, phi)
    point%tangent = matmul(y, dphi)
    point%length = norm2(point%tangent)
    point%e_r = [-point%tangent(2), point%tangent(1)]/point%length
    point%radius = 1
    point%dx = 0
    point%dlength = 0
    point%dradius = 0
    point%dx(1, 1:3) = phi
    point%dx(2, 4:6) = phi
    point%dlength(1:3) = dphi*point%tangent(1)/point%length
    point%dlength(4:6) = dphi*point%tangent(2)/point%length
    if (axisym) then
      point%radius = point%x(1)
      point%dradius(1:3) = phi
    end if
  end subroutine side_point

  !> Normal and tangential penalty: as given, or such that a pressure of one hundredth of the
  !> body's modulus makes the allowed penetration.
  pure function penalties(material, modulus, side) result(penalty)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: modulus, side
    real(wp) :: penalty(2)

    penalty(1) = material%values(2)
    if (.not. penalty(1) > 0) penalty(1) = 0.01_wp*modulus/(material%values(1)*side)
    penalty(2) = material%values(3)
    if (.not. penalty(2) > 0) penalty(2) = tangential_share*penalty(1)
  end function penalties

  !> Chord of a side in the mesh as it began.
  pure function side_length(scene, nodes) result(length)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: nodes(3)
    real(wp) :: length

    length = norm2(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
  end function side_length

  pure function turned(v, angle) result(w)
    real(wp), intent(in) :: v(2), angle
    real(wp) :: w(2)

    w = [cos(angle)*v(1) - sin(angle)*v(2), sin(angle)*v(1) + cos(angle)*v(2)]
  end function turned

  !> Uzawa: the pressure (or pull, of glue) reached becomes the multiplier, p = multiplier + AKP d, so that the same
  !> pressure needs no penetration any more. The side is judged at its points and between them.
  subroutine augment(scene, group, times, committed, trial, changed)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: times
    real(wp), intent(inout) :: committed(:, :, :)
    real(wp), intent(in) :: trial(:, :, :)
    logical, intent(out) :: changed
    real(wp) :: allowed
    integer :: e, k

    changed = .false.
    associate (values => scene%materials(group%material)%values)
      if (times >= nint(values(at_augment)) .or. .not. values(1) > 0) return
      do e = 1, size(trial, 3)
        allowed = values(1)*side_length(scene, group%connectivity(:, e))
        do k = 0, npoint_state, npoint_state
          changed = changed .or. any(abs(trial(k + at_penetration, :, e)) > allowed &
                                     .and. nint(trial(k + at_status, :, e)) /= contact_open)
        end do
        changed = changed .or. any(peaks(trial(:, :, e), group%npoint, worth_augmenting*allowed) > allowed)
      end do
    end associate
    if (.not. changed) return
    do k = 0, npoint_state, npoint_state
      committed(k + at_augmentation, :, :) = trial(k + at_pressure, :, :)
    end do
  end subroutine augment

  !> Depth of the side at its points in contact or beside them: the top of the parabola through three points at equal
  !> distances, when it lies between them; zero elsewhere.
  pure function peaks(state, npoint, least) result(depth)
    real(wp), intent(in) :: state(:, :)
    integer, intent(in) :: npoint
    real(wp), intent(in) :: least   !! depth of a point that is judged [length]
    real(wp) :: depth(size(state, 2))
    real(wp) :: slope, bend
    integer :: p

    depth = 0
    if (npoint > 0) return
    do p = 2, size(state, 2) - 1
      if (nint(state(at_status, p)) == contact_open .or. .not. state(at_penetration, p) > least) cycle
      if (any(nint(state(at_piece, p - 1:p + 1)) == 0)) cycle
      slope = 0.5_wp*(state(at_penetration, p + 1) - state(at_penetration, p - 1))
      bend = state(at_penetration, p + 1) - 2*state(at_penetration, p) + state(at_penetration, p - 1)
      if (abs(slope) < -bend) depth(p) = state(at_penetration, p) - 0.5_wp*slope**2/bend
    end do
  end function peaks

  !> Friction work, penetration found and allowed, number of points in each contact state.
  subroutine measure(scene, group, law, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: x(:, :, :), state(:, :, :), before(:, :, :)
    type(totals_t), intent(out) :: totals
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: side, from, to
    integer :: e, p

    call line_rule(group%npoint, xi, weight)
    do e = 1, size(x, 3)
      side = side_length(scene, group%connectivity(:, e))
      do p = 1, size(xi)
        select case (nint(state(at_status, p, e)))
        case (contact_stick)
          totals%stick = totals%stick + 1
        case (contact_slip)
          totals%slip = totals%slip + 1
        case default
          totals%open = totals%open + 1
        end select
        call add_point(state(:npoint_state, p, e), before(:npoint_state, p, e), xi(p), weight(p))
        call stretch_before(xi, p, from, to)
        call add_point(state(npoint_state + 1:2*npoint_state, p, e), before(npoint_state + 1:2*npoint_state, p, e), &
                       state(at_place, p, e), to - from)
      end do
    end do

  contains

    !> Penetration and friction of a point of side e.
    subroutine add_point(now, old, place, share)
      real(wp), intent(in) :: now(:), old(:), place, share
      real(wp) :: phi(3), dphi(3), area, allowed

      allowed = scene%materials(group%material)%values(1)*side
      if (nint(now(at_status)) /= contact_open) then
        totals%max_penetration = max(totals%max_penetration, now(at_penetration))
        if (allowed > 0) totals%penetration_ratio = max(totals%penetration_ratio, now(at_penetration)/allowed)
      end if
      call line3(place, phi, dphi)
      area = norm2(matmul(x(:, :, e), dphi))*share
      if (scene%plane_state == axisymmetric) area = area*dot_product(phi, x(1, :, e))
      totals%friction_work = totals%friction_work + area*now(at_work)
      totals%least_dissipation = min(totals%least_dissipation, now(at_work) - old(at_work))
    end subroutine add_point

  end subroutine measure

end module elem_cnt2d
