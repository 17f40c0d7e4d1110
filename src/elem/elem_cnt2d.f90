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
  use contact_point, only: act, at_augmentation, at_penetration, at_piece, at_pressure, at_status, at_tau, at_work, at_xi, &
                           contact_point_t, dissipated, meeting_t, most_unknowns, no_surface, penalties, share_to_contact, &
                           show_on_axis, side_length, side_point, thinning, touching
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

  !> Place of the largest number of augmentations among a contact law's values (contact_penalties).
  integer, parameter :: at_augment = 4
  !> Local unknowns: x of the side's nodes, y of them, pilot x, y, angle, section; the last three are
  !> there in generalised plane strain only.
  integer, parameter :: ndof = 12

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
      trial(at_work, :, e) = committed(at_work, :, e)*thinning(xi, section, section_motion(scene, du(:, e)), x(:, :, e), &
                                                                motion(1:6))
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
    type(meeting_t) :: meeting
    type(foot_t) :: foot
    real(wp) :: phi(3), dphi(3), n(2), t(2), lever(2), way(2), turn(2), q(2), moment
    real(wp), dimension(2, ndof) :: relative, dt, dway, dlever
    real(wp) :: dmoment(ndof), dq(2, most_unknowns)
    integer :: j, k

    call line3(xi, phi, dphi)
    call side_point(phi, dphi, section, x, du(1:6), ndof, point)
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
    dlever = point%dx(:, :ndof)
    dlever(1, 7) = dlever(1, 7) - 1
    dlever(2, 8) = dlever(2, 8) - 1
    relative = dlever
    relative(:, 9) = relative(:, 9) - [-lever(2), lever(1)]
    meeting%d = foot%d
    meeting%normal = n
    meeting%dd = 0
    meeting%dd(:ndof) = matmul(n, relative)
    meeting%turn = 0
    meeting%turn(:ndof) = foot%turn*matmul(t, relative)
    meeting%turn(9) = meeting%turn(9) + 1
    do j = 1, ndof
      dt(:, j) = -meeting%turn(j)*n
    end do

    ! way relative to the die, in its axes, turned back into the present ones
    turn = turned(matmul(x, phi) - pilot(1:2, 1), pilot(3, 2) - pilot(3, 1))
    way = lever - turn
    dway = dlever
    dway(:, 9) = dway(:, 9) - [-turn(2), turn(1)]
    meeting%slip = dot_product(t, way)
    meeting%dslip = 0
    meeting%dslip(:ndof) = matmul(t, dway) + matmul(way, dt)

    call act(law, material, penalties(material, modulus, side), point, meeting, weight, tangent_wanted, committed, trial, q, dq)
    if (nint(trial(at_status)) == contact_open) return
    moment = lever(1)*q(2) - lever(2)*q(1)
    force(1:3) = force(1:3) - phi*q(1)
    force(4:6) = force(4:6) - phi*q(2)
    force(7:8) = force(7:8) + q
    force(9) = force(9) + moment
    if (.not. tangent_wanted) return

    dmoment = dlever(1, :)*q(2) - dlever(2, :)*q(1) + lever(1)*dq(2, :ndof) - lever(2)*dq(1, :ndof)
    do j = 1, ndof
      do k = 1, 3
        stiffness(k, j) = stiffness(k, j) - phi(k)*dq(1, j)
        stiffness(k + 3, j) = stiffness(k + 3, j) - phi(k)*dq(2, j)
      end do
      stiffness(7:8, j) = stiffness(7:8, j) + dq(:, j)
      stiffness(9, j) = stiffness(9, j) + dmoment(j)
    end do
  end subroutine contact_at

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
