!> A point of a side in contact: where it is, and the force between it and what it meets, with all derivatives.
!>
!> Local unknowns are those of the side (x of its nodes, y of them), then those of what it meets (the
!> pilot of a rigid die, or the nodes of another body's side), then the section; the last three are
!> there in generalised plane strain only, and always the last. What is met enters by its motion
!> alone: depth, slip, and the turn of the normal.
module contact_point
  use closest_point, only: end_slack
  use contact_penalties, only: penalties_of_card, penalties_t
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip, law_t
  use materials, only: material_t
  use scene, only: group_t, scene_t
  use sections, only: thickness_at
  use shape_functions, only: line3
  use state_variables, only: state_variable, state_variable_t, transfer_contact, transfer_recompute
  use vectors, only: length_of
  implicit none
  private
  public :: contact_point_t, meeting_t, side_point, act, answer, penalties, share_to_contact, show_on_axis, side_length
  public :: area_at, dissipated, is_in_contact, is_released, point_variables, rest, thinning, contact_block
  public :: at_pressure, at_tau, at_penetration, at_status, at_slip, at_augmentation, at_work, at_piece, at_xi, at_between, &
            at_energy, npoint_state
  public :: most_unknowns, no_surface, share_of_way, touching, usual_bearing

  !> Rows in the state of a point; the history of its law follows. The pressure has in it that of the side beside the point, where
  !> it is deeper between points than allowed (contact_between).
  integer, parameter :: at_pressure = 1, at_tau = 2, at_penetration = 3, at_status = 4, at_slip = 5, &
                        at_augmentation = 6, at_work = 7, at_piece = 8, at_xi = 9, at_between = 10, at_energy = 11, &
                        npoint_state = 11
  !> Six of a side, six of what it meets, three of the section.
  integer, parameter :: most_unknowns = 15
  !> Pressure over Young's modulus at which the whole penalties that follow from an allowed penetration make that penetration.
  real(wp), parameter :: usual_bearing = 0.01_wp

  !> A radius below this share of the side is the axis.
  real(wp), parameter :: no_surface = 1.0e-9_wp
  !> Depth below this share of the side is round-off of coordinates: the point just touches.
  real(wp), parameter :: touching = 1.0e-12_wp
  !> A point that comes into contact may overlap the die by this share of the side in the predictor of a step.
  real(wp), parameter :: overlap_limit = 0.01_wp
  !> A step that is shortened for it aims at less, so that the next check does not depend on the last bit.
  real(wp), parameter :: overlap_aim = 0.008_wp

  !> A point of the side in the present geometry, with derivatives along the local unknowns.
  type :: contact_point_t
    real(wp) :: x(2), tangent(2), length, e_r(2), thickness
    real(wp), dimension(most_unknowns) :: dlength, dthickness
    real(wp) :: dx(2, most_unknowns)
  end type contact_point_t

  !> How the point meets the die: depth and slip of the step [length], inner normal of the die, and the
  !> derivatives of all three; the normal n turns by `turn`, dn = turn t with the tangent t.
  type :: meeting_t
    real(wp) :: d, slip, normal(2)
    !> Depth that needs no pressure [length].
    real(wp) :: allowed = 0.0_wp
    !> Share of the area that bears the pressure: friction is that of the pressure there [-].
    real(wp) :: bearing = 1.0_wp
    !> A point in contact at the start of the step follows its law linearised at the depth it had then (instant_t).
    logical :: kept = .false.
    !> Share of the penalties of a point without a pressure at the start of the step (instant_t) [-].
    real(wp) :: penalty_share = 1.0_wp
    real(wp), dimension(most_unknowns) :: dd, dslip, turn
  end type meeting_t

contains

  !> A point that has lost more than half of its pressure beyond the corner at the end of its face (corner_release).
  elemental function is_released(xi) result(yes)
    real(wp), intent(in) :: xi   !! parent coordinate in its state [-]
    logical :: yes

    yes = abs(xi) > 1 + 1.5_wp*end_slack
  end function is_released

  !> State of a point, with the history of its law.
  pure function point_variables(law) result(list)
    type(law_t), intent(in) :: law
    type(state_variable_t), allocatable :: list(:)

    allocate (list, source=[state_variable('pressure', 'stress', transfer_contact), &
                            state_variable('friction', 'stress', transfer_contact), &
                            state_variable('penetration', 'length', transfer_recompute), &
                            state_variable('contact_status', '-', transfer_recompute), &
                            state_variable('slip', 'length', transfer_contact), &
                            state_variable('augmentation', 'stress', transfer_contact), &
                            state_variable('friction_work', 'stress*length', transfer_contact), &
                            state_variable('die_piece', '-', transfer_recompute), &
                            state_variable('die_xi', '-', transfer_recompute), &
                            state_variable('pressure_between', 'stress', transfer_recompute), &
                            state_variable('energy_between', 'stress*length', transfer_recompute), law%history])
  end function point_variables

  !> Points without contact: slip and work of friction so far stay.
  pure subroutine rest(state)
    real(wp), intent(inout) :: state(:, :)   !! (nstate, npoint) [unit of each component]

    state([at_pressure, at_tau, at_status, at_penetration, at_piece, at_xi, at_augmentation, at_between, &
           at_energy], :) = 0
  end subroutine rest

  !> Rows of the state that are of the point itself: with corners the same of a corner and its position on the side follow.
  pure function contact_block(corners, nstate) result(n)
    logical, intent(in) :: corners   !! corners of the die are points of contact of their own
    integer, intent(in) :: nstate    !! rows of the state
    integer :: n

    n = merge((nstate - 1)/2, nstate, corners)
  end function contact_block

  !> A point is in contact, or the corner of the die beside it, or its side next to it (contact_between).
  pure function is_in_contact(state, corners) result(yes)
    real(wp), intent(in) :: state(:)   !! (nstate) with that of the corner, where there is one [unit of each component]
    logical, intent(in) :: corners     !! corners of the die are points of contact of their own
    logical :: yes

    integer :: n

    yes = nint(state(at_status)) /= contact_open .or. state(at_between) > 0
    if (yes .or. .not. corners) return
    n = contact_block(corners, size(state))
    yes = nint(state(n + at_status)) /= contact_open .or. state(n + at_between) > 0
  end function is_in_contact

  !> Position, length, inner normal and thickness of a point of the side, and their derivatives.
  pure subroutine side_point(phi, dphi, section, x, du, nunknown, point)
    real(wp), intent(in) :: phi(3), dphi(3)   !! [-]
    real(wp), intent(in) :: section(3)        !! at the end of the step: thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)           !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(6)             !! their motion, x then y [length]
    integer, intent(in) :: nunknown           !! local unknowns, the section's three among them
    type(contact_point_t), intent(out) :: point
    real(wp) :: y(2, 3)

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    point%x = matmul(y, phi)
    point%tangent = matmul(y, dphi)
    point%length = length_of(point%tangent)
    point%e_r = 0
    point%thickness = thickness_at(section, point%x)
    point%dx = 0
    point%dlength = 0
    point%dthickness = 0
    point%dx(1, 1:3) = phi
    point%dx(2, 4:6) = phi
    point%dthickness(1:3) = section(2)*phi
    point%dthickness(4:6) = section(3)*phi
    point%dthickness(nunknown - 2:nunknown) = [1.0_wp, point%x]
    ! no tangent, no normal: at an end whose middle node is at a quarter of the side
    if (.not. point%length > 0) return
    point%e_r = [-point%tangent(2), point%tangent(1)]/point%length
    point%dlength(1:3) = dphi*point%tangent(1)/point%length
    point%dlength(4:6) = dphi*point%tangent(2)/point%length
  end subroutine side_point

  !> Force on what is met, the opposite of that on the side: traction p n + tau t times length, weight and
  !> thickness. The state of the point goes on from committed to trial.
  pure subroutine act(law, material, dt, drivers, penalty, point, meeting, weight, tangent_wanted, committed, trial, q, dq)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt              !! length of the step [time]
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law at both ends of the step [unit of each driver]
    real(wp), intent(in) :: penalty(2)      !! normal and tangential [stress/length]
    type(contact_point_t), intent(in) :: point
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: weight
    logical, intent(in) :: tangent_wanted
    real(wp), intent(in) :: committed(:)            !! (nstate) [unit of each component]
    real(wp), intent(inout) :: trial(:)             !! (nstate) [unit of each component]
    real(wp), intent(out) :: q(2)                   !! per radian when axisymmetric [force]
    real(wp), intent(out) :: dq(2, most_unknowns)   !! set where the tangent is wanted and there is contact [force/unknown]
    real(wp) :: dslip(most_unknowns), t(2), pressure, tau, law_tangent(2, 2), area, traction(2), dp, dtau
    logical :: open
    integer :: j

    q = 0
    call answer(law, material, dt, drivers, penalty, meeting, committed, trial, pressure, tau, law_tangent, dslip, open)
    if (open) return

    t = [-meeting%normal(2), meeting%normal(1)]
    area = point%length*weight*point%thickness
    traction = -(pressure*meeting%normal + tau*t)
    q = traction*area
    if (.not. tangent_wanted) return
    do j = 1, most_unknowns
      dp = law_tangent(1, 1)*meeting%dd(j) + law_tangent(1, 2)*dslip(j)
      dtau = law_tangent(2, 1)*meeting%dd(j) + law_tangent(2, 2)*dslip(j)
      dq(:, j) = -(dp*meeting%normal + dtau*t + meeting%turn(j)*(pressure*t - tau*meeting%normal))*area &
                 + traction*weight*(point%dlength(j)*point%thickness + point%length*point%dthickness(j))
    end do
  end subroutine act

  !> Pressure and friction of a meeting, and their derivatives by depth and slip; the state of the point goes on from committed to
  !> trial.
  !>
  !> When contact begins inside the step only the share d/(d - d_start) of the way counts as slip, with the depth d that the penalty
  !> needs for the pressure: what a multiplier has taken of it is in there, for it takes nothing of the way. (With the depth that is
  !> left the share would go to 0 as multipliers are carried forward, and all of the slip would count beyond depth 0.)
  pure subroutine answer(law, material, dt, drivers, penalty, meeting, committed, trial, pressure, tau, tangent, dslip, open)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt              !! length of the step [time]
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law at both ends of the step [unit of each driver]
    real(wp), intent(in) :: penalty(2)      !! normal and tangential [stress/length]
    type(meeting_t), intent(in) :: meeting
    real(wp), intent(in) :: committed(:)    !! (nstate) [unit of each component]
    real(wp), intent(inout) :: trial(:)     !! (nstate) [unit of each component]
    real(wp), intent(out) :: pressure, tau   !! [stress]
    real(wp), intent(out) :: tangent(2, 2)   !! of both by depth and slip [stress/length]
    real(wp), intent(out) :: dslip(most_unknowns)   !! derivatives of the slip that counts [length/unknown]
    logical, intent(out) :: open
    real(wp) :: slip, depth, gap, reached, share, stiffness(2), stress(2), law_tangent(3, 3), change
    integer :: status

    stiffness = penalty
    if (.not. committed(at_pressure) > 0) stiffness = meeting%penalty_share*penalty
    slip = meeting%slip
    dslip = meeting%dslip
    depth = meeting%d - meeting%allowed
    gap = meeting%allowed - committed(at_penetration)
    reached = depth
    if (committed(at_augmentation) > 0) reached = depth + committed(at_augmentation)/stiffness(1)
    if (nint(committed(at_status)) == contact_open .and. gap > 0 .and. reached > 0) then
      share = reached/(reached + gap)
      dslip = share*dslip + slip*gap/(reached + gap)**2*meeting%dd
      slip = share*slip
    end if

    ! of the depth since the start of the step, where the law is linearised there
    change = 0
    if (meeting%kept .and. nint(committed(at_status)) /= contact_open) then
      change = depth - (committed(at_penetration) - meeting%allowed)
      depth = committed(at_penetration) - meeting%allowed
    end if
    ! nothing moves across the plane: the second tangential component stays at rest
    associate (bearing => meeting%bearing)
      call law%slide(material, dt, drivers, stiffness/bearing, committed(at_augmentation)/bearing, depth, [slip, 0.0_wp], &
                     [committed(at_tau)/bearing, 0.0_wp], committed(npoint_state + 1:), pressure, stress, &
                     trial(npoint_state + 1:), law_tangent, status)
      pressure = bearing*(pressure + law_tangent(1, 1)*change)
      tau = bearing*(stress(1) + law_tangent(2, 1)*change)
      tangent = bearing*law_tangent(:2, :2)
    end associate
    trial(at_pressure) = pressure
    trial(at_tau) = tau
    trial(at_status) = status
    open = status == contact_open
    if (open) return
    trial(at_augmentation) = committed(at_augmentation)
    trial(at_slip) = committed(at_slip) + slip
    trial(at_work) = trial(at_work) + dissipated(committed, trial, stiffness(2))
  end subroutine answer

  !> Work that friction took in a step, per present area: the part of the slip that the tangential penalty does not store.
  pure function dissipated(before, after, penalty) result(work)
    real(wp), intent(in) :: before(:), after(:)   !! (nstate) [unit of each component]
    real(wp), intent(in) :: penalty               !! tangential [stress/length]
    real(wp) :: work

    work = 0
    if (nint(after(at_status)) /= contact_slip) return
    work = after(at_tau)*(after(at_slip) - before(at_slip) - (after(at_tau) - before(at_tau))/penalty)
  end function dissipated

  !> Area before the step over the present one, at points of a side.
  pure function thinning(from, to, section, thickening, x, du) result(share)
    real(wp), intent(in) :: from(:)         !! (npoint) parent coordinates on the side before the step [-]
    real(wp), intent(in) :: to(:)           !! (npoint) parent coordinates now [-]
    real(wp), intent(in) :: section(3)      !! at the end of the step: thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: thickening(3)   !! its change in the step: thickness [length], slopes [-]
    real(wp), intent(in) :: x(2, 3)         !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(6)           !! their motion, x then y [length]
    real(wp) :: share(size(to))
    real(wp) :: y(2, 3), area
    integer :: p

    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    do p = 1, size(to)
      area = area_at(to(p), section, y)
      ! on the axis there is no area, before or after
      share(p) = 1
      if (area > 0) share(p) = area_at(from(p), section - thickening, x)/area
    end do
  end function thinning

  !> Area of a side per unit of xi at a parent coordinate: length times thickness.
  pure function area_at(xi, section, x) result(area)
    real(wp), intent(in) :: xi           !! [-]
    real(wp), intent(in) :: section(3)   !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)      !! nodes [length]
    real(wp) :: area
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    area = length_of(matmul(x, dphi))*thickness_at(section, matmul(x, phi))
  end function area_at

  !> Normal and tangential penalty of a group of contact: as given, or such that a pressure of one hundredth of the
  !> body's modulus makes the allowed penetration, times a share for light contact, and a share of that.
  pure function penalties(material, group, side, light) result(penalty)
    type(material_t), intent(in) :: material
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: side    !! [length]
    real(wp), intent(in) :: light   !! share of penalties that follow from an allowed penetration (soft_penalties) [-]
    real(wp) :: penalty(2)
    type(penalties_t) :: given

    given = penalties_of_card(material)
    penalty(1) = given%normal
    if (.not. penalty(1) > 0) penalty(1) = light*usual_bearing*group%modulus/(given%allowed*side)
    penalty(2) = given%tangential
    if (.not. penalty(2) > 0) penalty(2) = group%tangential_share*penalty(1)
  end function penalties

  !> Share of the step after which a point that was open, its gap known, overlaps the die by `overlap_aim` of the side;
  !> one that overlaps by less than `overlap_limit` is left alone.
  pure function share_to_contact(committed, trial, side) result(share)
    real(wp), intent(in) :: committed(:), trial(:)   !! (nstate) [unit of each component]
    real(wp), intent(in) :: side                     !! length of the side [length]
    real(wp) :: share

    share = 1
    if (nint(committed(at_status)) /= contact_open .or. nint(trial(at_status)) == contact_open) return
    if (nint(committed(at_piece)) == 0) return
    share = share_of_way(-committed(at_penetration), trial(at_penetration), side)
  end function share_to_contact

  !> Share of the way from a gap at the start to a depth at the end of the step after which the overlap is `overlap_aim` of the
  !> side; the whole way where it ends below `overlap_limit`. Of a point that overlaps as the step begins, and was open (a new mesh
  !> has laid it deeper than the old one, and the multiplier that held it there without pressure ended as it opened), what the step
  !> adds: no shorter one avoids the rest.
  pure function share_of_way(gap, depth, side) result(share)
    real(wp), intent(in) :: gap, depth   !! [length]
    real(wp), intent(in) :: side         !! length of the side [length]
    real(wp) :: share
    real(wp) :: open, overlap

    share = 1
    open = max(gap, 0.0_wp)
    overlap = depth - max(-gap, 0.0_wp)
    if (overlap <= overlap_limit*side) return
    share = (open + overlap_aim*side)/(open + overlap)
  end function share_of_way

  !> Stresses shown at a point on the axis, where none act: on the line through its two neighbours.
  pure subroutine show_on_axis(xi, x, side, trial)
    real(wp), intent(in) :: xi(:)            !! (npoint) [-]
    real(wp), intent(in) :: x(3)             !! radii of the nodes [length]
    real(wp), intent(in) :: side             !! length of the side [length]
    real(wp), intent(inout) :: trial(:, :)   !! (nstate, npoint) [unit of each component]
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

  !> Chord of a side in the mesh as it began.
  pure function side_length(scene, nodes) result(length)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: nodes(3)
    real(wp) :: length

    length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
  end function side_length

end module contact_point
