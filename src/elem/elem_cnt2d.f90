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
!> The work of friction is kept per present area: it thins out where the side stretches.
!>
!> Forces are integrated consistently over the side. The reaction acts on the pilot: force, and
!> moment about it. Everything is linearised exactly, the curvature of the die included.
module elem_cnt2d
  use die_search, only: box_distance, find_foot, follow_foot, foot_t
  use dies, only: die_t
  use elem_api, only: elem_t, instant_t, report_t, section_motion, totals_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: contact_law, contact_open, contact_slip, contact_stick, law_t
  use materials, only: material_t
  use quadrature, only: line_rule
  use scene, only: axisymmetric, group_t, scene_t
  use sections, only: thickness_at
  use shape_functions, only: line3
  use state_variables, only: state_variable, state_variable_t, transfer_contact, transfer_recompute
  use vectors, only: length_of
  implicit none
  private
  public :: elem_cnt2d_row

  !> Places in the state of a point.
  integer, parameter :: at_pressure = 1, at_tau = 2, at_penetration = 3, at_status = 4, at_slip = 5, &
                        at_augmentation = 6, at_work = 7, at_piece = 8, at_xi = 9
  !> Place of the largest number of augmentations among a contact law's values (contact_penalties).
  integer, parameter :: at_augment = 4
  !> Local unknowns: x of the side's nodes, y of them, pilot x, y, angle, section; the last three are
  !> there in generalised plane strain only.
  integer, parameter :: ndof = 12

  !> A radius below this share of the side is the axis.
  real(wp), parameter :: no_surface = 1.0e-9_wp
  !> Depth below this share of the side is round-off of coordinates: the point just touches.
  real(wp), parameter :: touching = 1.0e-12_wp
  !> Tangential penalty over the normal one, where it is not given: an elastic slip of ten times the
  !> penetration, so that sticking and slipping points do not chatter; error of friction at PHI = 0.5
  !> about half a percent of a side, as in common use.
  real(wp), parameter :: tangential_share = 0.1_wp
  !> A point that comes into contact may overlap the die by this share of the side in the predictor of a step.
  real(wp), parameter :: overlap_limit = 0.01_wp
  !> A step that is shortened for it aims at less, so that the next look does not hang on the last bit.
  real(wp), parameter :: overlap_aim = 0.008_wp

  !> A point of the side in the present geometry, with derivatives along the local unknowns.
  type :: contact_point_t
    real(wp) :: x(2), tangent(2), length, e_r(2), thickness
    real(wp) :: dx(2, ndof), dlength(ndof), dthickness(ndof)
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

  pure subroutine variables(law, plane_state, list)
    type(law_t), intent(in) :: law
    integer, intent(in) :: plane_state
    type(state_variable_t), allocatable, intent(out) :: list(:)
    integer :: k

    list = [state_variable('pressure', 'stress', transfer_contact), &
            state_variable('friction', 'stress', transfer_contact), &
            state_variable('penetration', 'length', transfer_recompute), &
            state_variable('contact_status', '-', transfer_recompute), &
            state_variable('slip', 'length', transfer_contact), &
            state_variable('augmentation', 'stress', transfer_contact), &
            state_variable('friction_work', 'stress*length', transfer_contact), &
            state_variable('die_piece', '-', transfer_recompute), &
            state_variable('die_xi', '-', transfer_recompute), law%history]
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
    real(wp) :: side, pilot(3, 2), section(3), motion(ndof), f(ndof), k(ndof, ndof)
    integer :: e, p, n
    logical :: axisym

    n = size(du, 1)
    motion = 0
    axisym = scene%plane_state == axisymmetric
    call line_rule(group%npoint, xi, weight)
    do e = 1, size(x, 3)
      force(:, e) = 0
      if (instant%tangent) stiffness(:, :, e) = 0
      motion(:n) = du(:, e)
      section = scene%section
      if (scene%finite) section = instant%section + section_motion(scene, du(:, e))
      trial(:, :, e) = committed(:, :, e)
      trial([at_pressure, at_tau, at_status, at_penetration, at_piece, at_xi, at_augmentation], :, e) = 0
      trial(at_work, :, e) = committed(at_work, :, e)*thinning(xi, section, section_motion(scene, du(:, e)), x(:, :, e), motion)
      side = side_length(scene, group%connectivity(:, first + e - 1))
      pilot(:, 1) = instant%pilots(:, group%die)
      pilot(:, 2) = pilot(:, 1) + motion(7:9)
      if (far(scene%dies(group%die), x(:, :, e), motion, pilot(:, 2), side)) cycle
      f = 0
      k = 0
      do p = 1, size(xi)
        call contact_at(scene%dies(group%die), law, scene%materials(group%material), axisym, section, group%amplitude, side, &
                        x(:, :, e), motion, pilot, xi(p), weight(p), instant%tangent, committed(:, p, e), trial(:, p, e), f, k)
        if (nint(committed(at_status, p, e)) /= contact_open) then
          report%jump = max(report%jump, abs(trial(at_penetration, p, e) - committed(at_penetration, p, e))/side)
        end if
        report%event = min(report%event, share_to_contact(committed(:, p, e), trial(:, p, e), side))
      end do
      force(:, e) = f(:n)
      if (instant%tangent) stiffness(:, :, e) = k(:n, :n)
      if (axisym) call show_on_axis(xi, x(1, :, e) + du(1:3, e), side, trial(:, :, e))
    end do
  end subroutine compute

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

  !> Share of the step after which a point that was open, its gap known, overlaps the die by `overlap_aim` of the side;
  !> one that overlaps by less than `overlap_limit` is left alone.
  pure function share_to_contact(committed, trial, side) result(share)
    real(wp), intent(in) :: committed(:), trial(:), side
    real(wp) :: share
    real(wp) :: gap

    share = 1
    if (nint(committed(at_status)) /= contact_open .or. nint(trial(at_status)) == contact_open) return
    if (nint(committed(at_piece)) == 0) return
    if (trial(at_penetration) <= overlap_limit*side) return
    gap = max(-committed(at_penetration), 0.0_wp)
    share = (gap + overlap_aim*side)/(gap + trial(at_penetration))
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
  pure subroutine contact_at(die, law, material, axisym, section, modulus, side, x, du, pilot, xi, weight, tangent_wanted, &
                             committed, trial, force, stiffness)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical, intent(in) :: axisym, tangent_wanted
    real(wp), intent(in) :: section(3), modulus, side, x(2, 3), du(ndof), pilot(3, 2), xi, weight
    real(wp), intent(in) :: committed(:)
    real(wp), intent(inout) :: trial(:), force(ndof), stiffness(ndof, ndof)
    type(contact_point_t) :: point
    type(foot_t) :: foot
    real(wp) :: phi(3), dphi(3), n(2), t(2), lever(2), way(2), turn(2), q(2), moment, share, slip
    real(wp), dimension(ndof) :: dd, along, dslip, dp, dtau, dmoment
    real(wp), dimension(2, ndof) :: relative, dn, dt, dway, dlever, dq
    real(wp) :: penalty(2), pressure, tau, stress(2), flow_stress, law_tangent(3, 3)
    integer :: status, j, k

    call line3(xi, phi, dphi)
    call side_point(phi, dphi, section, x, du, point)
    lever = point%x - pilot(1:2, 2)
    call foot_of(die, turned(lever, -pilot(3, 2)), turned(point%e_r, -pilot(3, 2)), side, committed, foot)
    if (foot%piece == 0) return
    ! a point on the axis has no surface: nothing acts there, and nothing is asked of it
    if (axisym .and. point%x(1) <= no_surface*side) return
    if (abs(foot%d) <= touching*side) foot%d = 0
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
    dslip = matmul(t, dway) + matmul(way, dt)
    if (nint(committed(at_status)) == contact_open .and. committed(at_penetration) < 0 .and. foot%d > 0) then
      share = foot%d/(foot%d - committed(at_penetration))
      dslip = share*dslip - slip*committed(at_penetration)/(foot%d - committed(at_penetration))**2*dd
      slip = share*slip
    end if

    penalty = penalties(material, modulus, side)
    flow_stress = 0
    if (size(law%history) > 0) flow_stress = committed(size(committed))
    ! nothing moves across the plane: the second tangential component stays at rest
    call law%slide(material, penalty, committed(at_augmentation), foot%d, [slip, 0.0_wp], [committed(at_tau), 0.0_wp], &
                   flow_stress, pressure, stress, law_tangent, status)
    tau = stress(1)
    trial(at_pressure) = pressure
    trial(at_tau) = tau
    trial(at_status) = status
    if (status == contact_open) return
    trial(at_augmentation) = committed(at_augmentation)
    trial(at_slip) = committed(at_slip) + slip
    trial(at_work) = trial(at_work) + dissipated(committed, trial, penalty(2))

    ! traction times length, weight and thickness (radius); the part gets it, the pilot its opposite
    q = -(pressure*n + tau*t)*point%length*weight
    moment = lever(1)*q(2) - lever(2)*q(1)
    force(1:3) = force(1:3) - phi*q(1)*point%thickness
    force(4:6) = force(4:6) - phi*q(2)*point%thickness
    force(7:8) = force(7:8) + q*point%thickness
    force(9) = force(9) + moment*point%thickness
    if (.not. tangent_wanted) return

    dp = law_tangent(1, 1)*dd + law_tangent(1, 2)*dslip
    dtau = law_tangent(2, 1)*dd + law_tangent(2, 2)*dslip
    do j = 1, ndof
      dq(:, j) = -(dp(j)*n + dtau(j)*t + pressure*dn(:, j) + tau*dt(:, j))*point%length*weight &
                 + q*point%dlength(j)/point%length
    end do
    dmoment = dlever(1, :)*q(2) - dlever(2, :)*q(1) + lever(1)*dq(2, :) - lever(2)*dq(1, :)
    do j = 1, ndof
      dq(:, j) = dq(:, j)*point%thickness + q*point%dthickness(j)
      dmoment(j) = dmoment(j)*point%thickness + moment*point%dthickness(j)
      do k = 1, 3
        stiffness(k, j) = stiffness(k, j) - phi(k)*dq(1, j)
        stiffness(k + 3, j) = stiffness(k + 3, j) - phi(k)*dq(2, j)
      end do
      stiffness(7:8, j) = stiffness(7:8, j) + dq(:, j)
      stiffness(9, j) = stiffness(9, j) + dmoment(j)
    end do
  end subroutine contact_at

  !> Work that friction took in a step, per present area: the way slipped is that not stored in the tangential penalty.
  pure function dissipated(before, after, penalty) result(work)
    real(wp), intent(in) :: before(:), after(:), penalty
    real(wp) :: work

    work = 0
    if (nint(after(at_status)) /= contact_slip) return
    work = after(at_tau)*(after(at_slip) - before(at_slip) - (after(at_tau) - before(at_tau))/penalty)
  end function dissipated

  !> Area before the step over the present one, at the points of a side.
  pure function thinning(xi, section, thickening, x, du) result(share)
    real(wp), intent(in) :: xi(:), section(3), thickening(3), x(2, 3), du(ndof)
    real(wp) :: share(size(xi))
    real(wp) :: y(2, 3), phi(3), dphi(3), thickness
    integer :: p

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    do p = 1, size(xi)
      call line3(xi(p), phi, dphi)
      share(p) = length_of(matmul(x, dphi))/length_of(matmul(y, dphi))
      thickness = thickness_at(section, matmul(y, phi))
      ! on the axis there is no area, before or after
      if (thickness > 0) share(p) = share(p)*thickness_at(section - thickening, matmul(x, phi))/thickness
    end do
  end function thinning

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

  !> Position, length, inner normal and thickness of a point of the side, and their derivatives.
  pure subroutine side_point(phi, dphi, section, x, du, point)
    real(wp), intent(in) :: phi(3), dphi(3), section(3), x(2, 3), du(ndof)
    type(contact_point_t), intent(out) :: point
    real(wp) :: y(2, 3)

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    point%x = matmul(y, phi)
    point%tangent = matmul(y, dphi)
    point%length = length_of(point%tangent)
    point%e_r = [-point%tangent(2), point%tangent(1)]/point%length
    point%thickness = thickness_at(section, point%x)
    point%dx = 0
    point%dlength = 0
    point%dx(1, 1:3) = phi
    point%dx(2, 4:6) = phi
    point%dlength(1:3) = dphi*point%tangent(1)/point%length
    point%dlength(4:6) = dphi*point%tangent(2)/point%length
    point%dthickness(1:3) = section(2)*phi
    point%dthickness(4:6) = section(3)*phi
    point%dthickness(7:9) = 0
    point%dthickness(10:12) = [1.0_wp, point%x]
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

    length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
  end function side_length

  pure function turned(v, angle) result(w)
    real(wp), intent(in) :: v(2), angle
    real(wp) :: w(2)

    w = [cos(angle)*v(1) - sin(angle)*v(2), sin(angle)*v(1) + cos(angle)*v(2)]
  end function turned

  !> Uzawa: the pressure (or pull, of glue) reached becomes the multiplier, p = multiplier + AKP d, so that the same
  !> pressure needs no penetration any more.
  subroutine augment(scene, group, times, committed, trial, changed)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: times
    real(wp), intent(inout) :: committed(:, :, :)
    real(wp), intent(in) :: trial(:, :, :)
    logical, intent(out) :: changed
    integer :: e

    changed = .false.
    associate (values => scene%materials(group%material)%values)
      if (times >= nint(values(at_augment)) .or. .not. values(1) > 0) return
      do e = 1, size(trial, 3)
        changed = changed .or. any(abs(trial(at_penetration, :, e)) > values(1)*side_length(scene, group%connectivity(:, e)) &
                                   .and. nint(trial(at_status, :, e)) /= contact_open)
      end do
    end associate
    if (changed) committed(at_augmentation, :, :) = trial(at_pressure, :, :)
  end subroutine augment

  !> Friction work, penetration found and allowed, number of points in each contact state.
  subroutine measure(scene, group, law, section, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: section(3), x(:, :, :), state(:, :, :), before(:, :, :)
    type(totals_t), intent(out) :: totals
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: phi(3), dphi(3), area, side, penalty(2)
    integer :: e, p

    call line_rule(group%npoint, xi, weight)
    associate (values => scene%materials(group%material)%values)
      do e = 1, size(x, 3)
        side = side_length(scene, group%connectivity(:, e))
        penalty = penalties(scene%materials(group%material), group%amplitude, side)
        do p = 1, size(xi)
          select case (nint(state(at_status, p, e)))
          case (contact_stick)
            totals%stick = totals%stick + 1
          case (contact_slip)
            totals%slip = totals%slip + 1
          case default
            totals%open = totals%open + 1
          end select
          if (nint(state(at_status, p, e)) /= contact_open) then
            totals%max_penetration = max(totals%max_penetration, state(at_penetration, p, e))
            if (values(1) > 0) then
              totals%penetration_ratio = max(totals%penetration_ratio, state(at_penetration, p, e)/(values(1)*side))
            end if
          end if
          call line3(xi(p), phi, dphi)
          area = length_of(matmul(x(:, :, e), dphi))*weight(p)
          area = area*thickness_at(section, matmul(x(:, :, e), phi))
          totals%friction_work = totals%friction_work + area*state(at_work, p, e)
          totals%least_dissipation = min(totals%least_dissipation, dissipated(before(:, p, e), state(:, p, e), penalty(2)))
        end do
      end do
    end associate
  end subroutine measure

end module elem_cnt2d
