!> CNT2D: contact of a 3-node side of the part with a die (annex 3).
!>
!> Walking 1 -> 2 -> 3 the part is on the left. At an integration point d is the penetration below
!> the closest point of the die (curve_search), n the die's inner normal and t its tangent there, in
!> the sense of the walk. The traction on the part is -p n - tau t, per length of the side. The
!> annex measures d and p along the part's own normal e_R; on a side that lies on the die they are
!> the same, on one that is about to fold the die's normal is the one that is continuous.
!>
!> The slip of a step is the displacement of the part's point relative to the die (rigid_contact). When contact
!> begins inside the step only the share d/(d - d_start) of it counts.
!>
!> A corner of the die between two integration points is one more point of contact of the side
!> (corner_contact); so is the node of a side on the axis (axis_contact). What is deeper than allowed between points
!> presses too (contact_between).
!>
!> The work of friction is kept per present area: it decreases where the side stretches.
!>
!> Forces are integrated consistently over the side. The reaction acts on the pilot: force, and
!> moment about it. Everything is linearised exactly, the curvature of the die included.
module elem_cnt2d
  use axis_contact, only: press_axis
  use closest_point, only: closest_point_t
  use contact_areas, only: areas_with_control
  use contact_between, only: press_between
  use contact_measure, only: augment, measure
  use contact_overlap, only: share_to_contact
  use contact_point, only: penalties
  use contact_scan, only: is_near
  use contact_state, only: at_augmentation, at_penetration, at_piece, at_status, at_work, at_xi, contact_block, &
                           point_variables, rest, show_on_axis
  use corner_contact, only: corner_beside, end_on_axis, press_corners
  use corner_release, only: motion_past_corner, passes_corner, release_t, slide_past_corner
  use die_sweep, only: share_to_pass
  use dies, only: die_t
  use elem_api, only: elem_t, goes_on, instant_t, layout_t, of_displacement, of_pilot, of_section, report_t, section_motion
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: contact_law, contact_open, law_t
  use materials, only: material_t
  use passing_corners, only: taken_by_corners
  use plane_vectors, only: turned
  use quadrature, only: line_rule, rule_along, rule_control
  use side_contact, only: press_side
  use rigid_contact, only: closest_or_followed, ndof, nodes_in_axes, place_point, press, side_t
  use scene, only: axisymmetric, group_t, role_contact, scene_t
  use side_points, only: contact_point_t, no_surface, side_length, thinning, touching
  use state_variables, only: state_variable, state_variable_t, transfer_recompute
  use start_depths, only: state_at_start
  implicit none
  private
  public :: elem_cnt2d_row

contains

  function elem_cnt2d_row() result(row)
    type(elem_t) :: row

    row%name = 'CNT2D'
    row%purpose = 'contact of a side with a die'
    row%nnode = 3
    row%role = role_contact
    allocate (row%unknowns, source=[of_displacement(), of_pilot(), of_section()])
    row%law_kind = contact_law
    row%follows = .true.
    row%symmetric = .false.
    row%effect = 'contact'
    allocate (row%options(0))
    row%variables => variables
    row%compute => compute
    row%measure => measure
    row%augment => augment
  end function elem_cnt2d_row

  !> That of a point with its law's, the same of the corner before it, the corner's position on the side, and its share there.
  pure subroutine variables(law, plane_state, list)
    type(law_t), intent(in) :: law
    integer, intent(in) :: plane_state
    type(state_variable_t), allocatable, intent(out) :: list(:)
    type(state_variable_t), allocatable :: own(:)
    integer :: k, n

    allocate (own, source=point_variables(law))
    n = size(own)
    allocate (list, source=[own, own, state_variable('corner_place', '-', transfer_recompute), &
                            state_variable('corner_share', '-', transfer_recompute)])
    do k = 1, n
      list(n + k)%name = 'corner_'//own(k)%name
      list(n + k)%transfer = transfer_recompute
    end do
    do k = 1, size(list)
      list(k)%first = k
    end do
  end subroutine variables

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
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: f(ndof), k(ndof, ndof)
    type(side_t) :: side
    integer :: e, p, n, own
    logical :: axisym, whole, between

    n = size(du, 1)
    own = contact_block(.true., size(trial, 1))
    axisym = scene%plane_state == axisymmetric
    whole = group%rule%family == rule_control
    between = group%rule%family == rule_along .and. .not. instant%points_alone
    call line_rule(group%rule, xi, weight)
    associate (die => scene%dies(group%die), material => scene%materials(group%material))
      do e = 1, size(x, 3)
        force(:, e) = 0
        if (instant%tangent) stiffness(:, :, e) = 0
        call begin_side(scene, group, instant, layout, first + e - 1, x(:, :, e), du(:, e), side)
        call begin_states(side, xi, whole, committed(:, :, e), trial(:, :, e))
        report%passed = min(report%passed, share_to_pass(die, side))
        if (far(die, side)) cycle
        f = 0
        k = 0
        if (whole) then
          call press_side(die, law, material, drivers(:, :, :, e), side, committed(:own, :, e), trial(:own, :, e), f, k)
        else
          do p = 1, size(xi)
            call contact_at(die, law, material, drivers(:, :, p, e), axisym, side, xi(p), weight(p), &
                            bearing_of(die, side, xi, p, committed(:, :, e)), committed(:own, p, e), trial(:own, p, e), f, k)
          end do
        end if
        do p = 1, size(xi)
          if (nint(committed(at_status, p, e)) /= contact_open) then
            report%jump = max(report%jump, abs(trial(at_penetration, p, e) - committed(at_penetration, p, e))/side%length)
            report%bearing = report%bearing + 1
            if (nint(trial(at_status, p, e)) == contact_open) report%lost = report%lost + 1
          end if
          report%event = min(report%event, share_to_contact(committed(:, p, e), trial(:, p, e), side%length))
        end do
        call press_corners(die, law, material, drivers(:, :, :, e), axisym, side, xi, committed(:, :, e), trial(:, :, e), f, k, &
                           report)
        if (axisym) call press_axis(die, law, material, drivers(:, :, :, e), side, xi, committed(:, :, e), &
                                                      trial(:, :, e), f, k, report)
        if (between) call press_between(die, law, material, drivers(:, :, :, e), axisym, side, group%rule, xi, weight, &
                                        committed(:, :, e), trial(:, :, e), f, k, report)
        force(:, e) = f(:n)
        if (instant%tangent) stiffness(:, :, e) = k(:n, :n)
        if (axisym .and. .not. whole) call show_on_axis(xi, x(1, :, e) + du(1:3, e), side%length, trial(:, :, e))
      end do
    end associate
    if (.not. goes_on(instant, group%die)) then
      report%jump = 0
      report%lost = 0
    end if
  end subroutine compute

  !> The side of an element in the step.
  subroutine begin_side(scene, group, instant, layout, element, x, du, side)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: element
    real(wp), intent(in) :: x(2, 3), du(:)
    type(side_t), intent(out) :: side

    side%x = x
    side%du(:size(du)) = du
    side%thickening = section_motion(layout, du)
    side%section = scene%section
    if (scene%finite) side%section = instant%section + side%thickening
    side%length = side_length(scene, group%connectivity(:, element))
    side%penalty = penalties(scene%materials(group%material), group, side%length, instant%lasting_share)
    side%pilot(:, 1) = instant%pilots(:, group%die)
    side%pilot(:, 2) = side%pilot(:, 1) + du(7:9)
    if (scene%plane_state == axisymmetric) side%axis_end = end_on_axis(side)
    side%dt = instant%dt
    side%tangent = instant%tangent
    side%kept = instant%kept .and. goes_on(instant, group%die)
    side%penalty_share = instant%penalty_share
  end subroutine begin_side

  !> States without contact; the work of friction goes with the area.
  pure subroutine begin_states(side, xi, control, committed, trial)
    type(side_t), intent(in) :: side
    logical, intent(in) :: control
    real(wp), intent(in) :: xi(:), committed(:, :)
    real(wp), intent(inout) :: trial(:, :)
    real(wp) :: before(3), now(3)   ! areas of the points [per radian when axisymmetric]
    integer :: n

    n = contact_block(.true., size(trial, 1))
    trial = committed
    call rest(trial(:n, :))
    call rest(trial(n + 1:2*n, :))
    if (control) then
      before = areas_with_control(side%section - side%thickening, side%x)
      now = areas_with_control(side%section, side%x + reshape(side%du([1, 4, 2, 5, 3, 6]), [2, 3]))
      ! a side on the axis has none
      where (now > 0) trial(at_work, :) = committed(at_work, :)*before/now
    else
      trial(at_work, :) = committed(at_work, :)*thinning(xi, xi, side%section, side%thickening, side%x, side%du(1:6))
    end if
    associate (place => committed(2*n + 1, :), work => committed(n + at_work, :))
      trial(n + at_work, :) = work*thinning(place, place, side%section, side%thickening, side%x, side%du(1:6))
    end associate
  end subroutine begin_states

  !> Share of its area on which a point bears: none of one within a side that was open beside a corner of the die in contact, and
  !> less of a node the more of its pressure a corner has taken.
  pure function bearing_of(die, side, xi, p, committed) result(bearing)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)             !! (npoint) [-]
    integer, intent(in) :: p
    real(wp), intent(in) :: committed(:, :)   !! (nstate, npoint) [unit of each component]
    real(wp) :: bearing

    bearing = 1 - taken_by_corners(die, side, xi, p)
    if (nint(committed(at_status, p)) /= contact_open) return
    if (corner_beside(xi, p, committed)) bearing = 0
  end function bearing_of

  !> Side and die are further apart than the search would reach: the side is skipped.
  pure function far(die, side) result(skipped)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    logical :: skipped

    skipped = .not. is_near(die, nodes_in_axes(side), side%length)
  end function far

  !> Contact at one integration point: state, forces, matrix.
  pure subroutine contact_at(die, law, material, drivers, axisym, side, xi, weight, bearing, committed, trial, force, &
                             stiffness)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi, weight
    real(wp), intent(in) :: bearing   !! share of the area that bears, less where a corner of the die passes [-]
    real(wp), intent(in) :: committed(:)
    real(wp), intent(inout) :: trial(:), force(ndof), stiffness(ndof, ndof)
    type(contact_point_t) :: point
    type(closest_point_t) :: closest
    type(release_t) :: release
    real(wp) :: before(ndof), start(size(committed))
    logical :: passed

    call place_point(side, xi, point)
    call closest_or_followed(die, turned(point%x - side%pilot(1:2, 2), -side%pilot(3, 2)), &
                             turned(point%e_r, -side%pilot(3, 2)), side%length, committed, closest)
    if (.not. (closest%piece > 0 .and. closest%d > 0)) &
      call slide_past_corner(die, turned(point%x - side%pilot(1:2, 2), -side%pilot(3, 2)), &
                             turned(point%e_r, -side%pilot(3, 2)), side%length, committed, closest, release)
    if (closest%piece == 0) return
    ! a point on the axis has no surface: nothing acts there, and no contact is evaluated
    if (axisym .and. point%x(1) <= no_surface*side%length) return
    if (.not. bearing > 0) then
      trial([at_penetration, at_piece, at_xi]) = [closest%d, real(closest%piece, wp), closest%xi]
      return
    end if
    if (abs(closest%d) <= touching*side%length) closest%d = 0
    start = committed
    if (closest%d > 0) start = state_at_start(die, side, xi, committed)
    start(at_augmentation) = bearing*start(at_augmentation)
    before = force
    passed = .false.
    if (side%kept) passed = passes_corner(die, committed, closest)
    call press(law, material, drivers, side, xi, point, closest, 0.0_wp, weight*release%share, start, trial, force, stiffness, &
               released=passed, bearing=bearing)
    if (.not. (side%tangent .and. release%share < 1)) return
    stiffness = stiffness + release%slope/release%share*spread(force - before, 2, ndof) &
                *spread(motion_past_corner(side, point, release), 1, ndof)
  end subroutine contact_at

end module elem_cnt2d
