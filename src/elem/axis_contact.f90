!> The node of a side on the axis as a point of contact of its own.
!>
!> At r = 0 an integration point has no area, and the consistent force of a uniform pressure on the node there is zero: with
!> whatever rule, no pressure on areas holds that node, and the point of a steep die on the axis would go through it. What holds it
!> is a nodal force: the pressure of its depth on the disc that reaches to the middle of the side, A = (L/2)**2/2 per radian, L the
!> chord. By symmetry it acts along the axis: the depth is taken along it, d = d_n/|n.e_y|, and there is no slip.
!>
!> It acts on what is deeper than half the allowed penetration and than the next point of the side by a tenth. So a side that lies
!> on its die is not pressed twice: its pressures stay those of the integration points, and a uniform one uniform.
!> Source of nodal constraints beside integrated ones: P. Wriggers, Computational Contact Mechanics, 2nd ed., Springer 2006,
!> sec. 6.3.
!>
!> Its state is that of the corner in the interval at the node (corner_contact). One of both acts, the node where it is deeper and
!> presses: their areas are the same part of the side. Where the corner hands its load over to the node, the larger load acts: the
!> point of a die on the axis has no share in the side, and at depths below 0, where a multiplier holds it, it is the deeper one.
!> Its place is exactly -1 or 1.
module axis_contact
  use closest_point, only: closest_point_t
  use contact_overlap, only: share_to_contact
  use contact_penalties, only: allowed_penetration
  use contact_state, only: at_augmentation, at_penetration, at_piece, at_pressure, at_status, at_xi, contact_block, rest
  use corner_contact, only: end_on_axis, press_corner
  use corner_weights, only: area_of_disc
  use dies, only: die_t
  use elem_api, only: report_t
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use plane_vectors, only: turned
  use rigid_contact, only: closest_or_followed, is_kept, ndof, place_point, press, side_t
  use sections, only: thickness_at
  use side_points, only: area_at, contact_point_t, no_surface
  implicit none
  private
  public :: press_axis, area_at_corner, depth_of_bearing

  !> It acts on what is deeper than this share of the allowed penetration, and than the next point times this factor.
  real(wp), parameter :: own_share = 0.5_wp, deeper = 1.1_wp
  !> A die whose normal has less than this along the axis is a wall beside it.
  real(wp), parameter :: steepest = 0.05_wp

contains

  !> Contact of the end of a side that lies on the axis, or of the corner beside it. States are of all points of the side
  !> (nstate, npoint).
  pure subroutine press_axis(die, law, material, drivers, side, xi, committed, trial, force, stiffness, report)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :, :)   !! (ndriver, 2, npoint) of the law [unit of each driver]
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)                      !! (npoint) [-]
    real(wp), intent(in) :: committed(:, :)            !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: trial(:, :)             !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(report_t), intent(inout) :: report
    type(report_t) :: of_corner, of_node
    real(wp), dimension(size(trial, 1)) :: node
    real(wp) :: f(ndof, 2), matrix(ndof, ndof, 2), share
    integer :: k, p, n
    logical :: met, corner_acts, node_acts

    k = end_on_axis(side)
    if (k == 0) return
    p = merge(1, size(xi), k == 1)
    n = contact_block(.true., size(trial, 1))
    f = 0
    matrix = 0
    node = trial(:, p)
    call press_corner(die, law, material, drivers(:, :, p), .true., side, xi, p, committed, trial(:, p), f(:, 1), &
                      matrix(:, :, 1), of_corner)
    call press_node(die, law, material, drivers(:, :, p), side, xi, k, committed, node, f(:, 2), matrix(:, :, 2), of_node, met)
    corner_acts = nint(trial(n + at_status, p)) /= contact_open
    node_acts = met .and. nint(node(n + at_status)) /= contact_open
    if (corner_acts .and. node_acts) then
      share = trial(2*n + 2, p)
      if (share < 1) then
        node_acts = node(n + at_pressure) >= share*trial(n + at_pressure, p)
      else
        node_acts = node(n + at_penetration) > trial(n + at_penetration, p)
      end if
    end if
    if (met .and. (node_acts .or. .not. corner_acts)) then
      trial(:, p) = node
      force = force + f(:, 2)
      stiffness = stiffness + matrix(:, :, 2)
      report%jump = max(report%jump, of_node%jump)
      report%event = min(report%event, of_node%event)
    end if
    if (node_acts) return
    force = force + f(:, 1)
    stiffness = stiffness + matrix(:, :, 1)
    report%jump = max(report%jump, of_corner%jump)
    report%event = min(report%event, of_corner%event)
  end subroutine press_axis

  !> Contact of the node at one end, with what it does to its state; `met` is false where it faces no die.
  pure subroutine press_node(die, law, material, drivers, side, xi, k, committed, trial, force, stiffness, report, met)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law [unit of each driver]
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)                      !! (npoint) [-]
    integer, intent(in) :: k                           !! end of the side
    real(wp), intent(in) :: committed(:, :)            !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: trial(:)                !! (nstate) of the point at this end [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(report_t), intent(inout) :: report
    logical, intent(out) :: met
    type(contact_point_t) :: point, beside
    type(closest_point_t) :: closest, next
    real(wp), parameter :: ends(2) = [-1.0_wp, 1.0_wp]
    real(wp) :: before(contact_block(.true., size(committed, 1)))
    integer :: p, q, n, at_place

    n = contact_block(.true., size(trial))
    at_place = 2*n + 1
    p = merge(1, size(xi), k == 1)
    q = p
    if (abs(xi(p)) >= 1) q = p + merge(1, -1, k == 1)
    call meet_along_axis(die, side, ends(k), committed(n + 1:2*n, p), point, closest)
    met = closest%piece > 0
    if (.not. met) return
    associate (now => trial(n + 1:2*n))
      before = committed(n + 1:2*n, p)
      ! the state was that of a corner; one of an open corner has nothing to forget but the multiplier found in this step
      if (abs(committed(at_place, p)) < 1 .and. nint(before(at_status)) /= contact_open) call forget(before)
      ! all of its pressure acts
      trial(at_place:) = [ends(k), 1.0_wp]
      call place_point(side, xi(q), beside)
      call closest_or_followed(die, turned(beside%x - side%pilot(1:2, 2), -side%pilot(3, 2)), &
                               turned(beside%e_r, -side%pilot(3, 2)), side%length, committed(:n, q), next)
      call hold(law, material, drivers, side, ends(k), point, closest, beside, next, before, now, force, stiffness)
      if (nint(before(at_status)) /= contact_open) &
        report%jump = max(report%jump, abs(now(at_penetration) - before(at_penetration))/side%length)
      report%event = min(report%event, share_to_contact(before, now, side%length))
    end associate
  end subroutine press_node

  !> No contact; the work of friction stays.
  pure subroutine forget(state)
    real(wp), intent(inout) :: state(:)   !! (nstate) [unit of each component]
    real(wp) :: column(size(state), 1)

    column(:, 1) = state
    call rest(column)
    state = column(:, 1)
  end subroutine forget

  !> How the node meets the die: the closest point with its depth and normal taken along the axis.
  pure subroutine meet_along_axis(die, side, place, committed, point, closest)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place                    !! of the node on the side, -1 or 1
    real(wp), intent(in) :: committed(:)             !! (nstate) [unit of each component]
    type(contact_point_t), intent(out) :: point
    type(closest_point_t), intent(out) :: closest    !! in the pilot's axes
    real(wp) :: normal(2)

    call place_point(side, place, point)
    call closest_or_followed(die, turned(point%x - side%pilot(1:2, 2), -side%pilot(3, 2)), &
                             turned(point%e_r, -side%pilot(3, 2)), side%length, committed, closest)
    if (closest%piece == 0) return
    normal = turned(closest%normal, side%pilot(3, 2))
    if (abs(normal(2)) < steepest) then
      closest%piece = 0
      return
    end if
    ! before contact the gap is the distance
    if (closest%d > 0) closest%d = closest%d/abs(normal(2))
    closest%normal = turned([0.0_wp, sign(1.0_wp, normal(2))], -side%pilot(3, 2))
    closest%turn = 0
  end subroutine meet_along_axis

  !> Force of the node's depth beyond what it may have.
  pure subroutine hold(law, material, drivers, side, place, point, closest, beside, next, committed, trial, force, stiffness)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place
    type(contact_point_t), intent(in) :: point, beside   !! the node and the next point of the side
    type(closest_point_t), intent(in) :: closest, next   !! on the die, in the pilot's axes
    real(wp), intent(in) :: committed(:)
    real(wp), intent(inout) :: trial(:), force(ndof), stiffness(ndof, ndof)
    type(contact_point_t) :: disc_point
    real(wp) :: allowed, before(ndof), dallowed(ndof), n(2), lever(2), pressure, depth
    logical :: by_next

    allowed = depth_of_bearing(material, side%length)
    by_next = .false.
    if (next%piece > 0) by_next = deeper*next%d > allowed
    if (by_next) allowed = deeper*next%d
    depth = closest%d
    if (is_kept(side, committed)) depth = committed(at_penetration)
    if (.not. committed(at_augmentation) + side%penalty(1)*(depth - allowed) > 0) then
      ! its gap is known
      trial([at_penetration, at_piece, at_xi]) = [closest%d, real(closest%piece, wp), closest%xi]
      return
    end if
    disc_point = point
    disc_point%length = side%length
    disc_point%thickness = side%length
    disc_point%dlength = 0
    disc_point%dthickness = 0
    before = force
    call press(law, material, drivers, side, place, disc_point, closest, allowed, area_of_disc(1.0_wp), committed, trial, force, &
               stiffness)
    if (.not. (side%tangent .and. by_next) .or. nint(trial(at_status)) == contact_open) return
    pressure = committed(at_augmentation) + side%penalty(1)*(closest%d - allowed)
    if (.not. abs(pressure) > 0) return
    n = turned(next%normal, side%pilot(3, 2))
    lever = beside%x - side%pilot(1:2, 2)
    dallowed = matmul(n, beside%dx(:, :ndof))
    dallowed(7:8) = dallowed(7:8) - n
    dallowed(9) = dallowed(9) - dot_product(n, [-lever(2), lever(1)])
    ! the pressure is linear in the depth
    stiffness = stiffness - side%penalty(1)*deeper/pressure*spread(force - before, 2, ndof)*spread(dallowed, 1, ndof)
  end subroutine hold

  !> Depth along the axis beyond which the node bears where no other place of its side is as deep.
  pure function depth_of_bearing(material, chord) result(depth)
    type(material_t), intent(in) :: material   !! of the contact
    real(wp), intent(in) :: chord              !! of the side [length]
    real(wp) :: depth                          !! [length]

    depth = own_share*allowed_penetration(material)*chord
  end function depth_of_bearing

  !> Area on which the state of a corner acts: of its share of the side, or the disc of a node on the axis.
  pure function area_at_corner(place, share, section, x, chord) result(area)
    real(wp), intent(in) :: place        !! on the side [-]
    real(wp), intent(in) :: share        !! length of its interval [-]
    real(wp), intent(in) :: section(3)   !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)      !! nodes [length]
    real(wp), intent(in) :: chord        !! of the side in the mesh as it began [length]
    real(wp) :: area                     !! per radian when axisymmetric

    area = share*area_at(place, section, x)
    if (abs(place) < 1) return
    if (thickness_at(section, x(:, merge(1, 3, place < 0))) <= no_surface*chord) area = area_of_disc(chord)
  end function area_at_corner

end module axis_contact
