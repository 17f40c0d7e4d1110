!> CNTDF: contact of a 3-node side of a body with a die made of sides of other bodies.
!>
!> Depth, normal, law and state are those of CNT2D: the die is the curve of the other sides where they now are,
!> Y(xi) = sum_k psi_k(xi) Y_k (met_side).
!>
!> The point gets the traction, the nodes of the side with the closest point psi_k of its opposite: what one body gains
!> the other loses, point by point. Each side is coupled with a few pieces only (pairs): a closest point on
!> another piece is reported, and the pairs are renewed before the result is used.
!>
!> An edge of the other body between two points is one more point of contact of the side (edge_contact).
!>
!> A body may face itself (own_contact, own_closest_point).
module elem_cntdf
  use closest_point, only: closest_point_t
  use contact_overlap, only: share_to_contact
  use contact_penalties, only: allowed_penetration
  use contact_point, only: penalties
  use contact_state, only: at_penetration, at_piece, at_status, at_work, at_xi, contact_block, rest, show_on_axis
  use curve_boxes, only: box_distance
  use curve_search, only: closest_facing_point
  use dies, only: die_t
  use edge_contact, only: press_edges
  use edge_release, only: edge_release_t, slide_past_edge, slide_past_end
  use elem_api, only: elem_t, goes_on, instant_t, layout_t, of_displacement, of_section, report_t, section_motion
  use elem_cnt2d, only: elem_cnt2d_row
  use kept_side, only: handed_over_t, keep_closest_point
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: contact_open, law_t
  use met_side, only: hand_over, press_met, pressed_point_t, share_state
  use opposed_pieces, only: list_opposed_pieces
  use own_closest_point, only: find_own_closest_point
  use own_contact, only: faces_itself, pieces_to_meet
  use pairs, only: list_pieces, pieces_in_reach
  use quadrature, only: line_rule
  use rigid_contact, only: side_t
  use scene, only: axisymmetric, generalised_plane_strain, group_t, scene_t
  use shape_functions, only: line3
  use side_points, only: most_unknowns, no_surface, side_length, side_point, thinning
  implicit none
  private
  public :: elem_cntdf_row

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
    type(closest_point_t) :: closest, nearest
    type(handed_over_t) :: handed
    type(side_t) :: own
    type(pressed_point_t) :: pressed
    real(wp), allocatable :: xi(:), weight(:), there(:)
    integer :: e, p, nnode, npiece, nblock, nopposed, pieces(pieces_in_reach*group%rule%n)
    integer, allocatable :: opposed(:)
    logical, allocatable :: may(:, :)
    logical :: axisym

    axisym = scene%plane_state == axisymmetric
    nnode = size(x, 2)
    nblock = contact_block(.true., size(trial, 1))
    if (faces_itself(scene, group)) then
      allocate (may(size(scene%dies(group%die)%nodes, 2), size(x, 3)), opposed(size(scene%dies(group%die)%nodes, 2)))
      call pieces_to_meet(scene, group, first, may)
    end if
    pressed%n = merge(most_unknowns, most_unknowns - 3, scene%plane_state == generalised_plane_strain)
    own%dt = instant%dt
    own%tangent = instant%tangent
    own%kept = instant%kept .and. goes_on(instant, group%die)
    own%penalty_share = instant%penalty_share
    call line_rule(group%rule, xi, weight)
    associate (die => instant%dies(group%die), middle => instant%pairs(group%pairs)%piece(:, first:first + size(x, 3) - 1))
      do e = 1, size(x, 3)
        call begin_side()
        if (box_distance(die, box_of(own%x, own%du(1:6))) > own%length) cycle
        call list_pieces(die, middle(:, e), npiece, pieces)
        if (allocated(may)) then
          call list_opposed_pieces(die, own%x + transpose(reshape(own%du(1:6), [3, 2])), own%length, may(:, e), nopposed, opposed)
        end if
        do p = 1, size(xi)
          call press_point(die, middle(p, e))
        end do
        if (.not. allocated(may)) call press_edges_met(die)
        if (axisym) call show_on_axis(xi, x(1, 1:3, e) + du(1:3, e), own%length, trial(:, :, e))
      end do
    end associate
    if (.not. goes_on(instant, group%die)) then
      report%jump = 0
      report%lost = 0
    end if

  contains

    !> A side that nothing presses on: where it is, its section, and where its unknowns stand; its points are at rest, with the
    !> friction work that they had, per area of now.
    subroutine begin_side()
      force(:, e) = 0
      if (instant%tangent) stiffness(:, :, e) = 0
      trial(:, :, e) = committed(:, :, e)
      call rest(trial(:nblock, :, e))
      call rest(trial(nblock + 1:2*nblock, :, e))
      pressed%place(1:6) = [1, 2, 3, nnode + 1, nnode + 2, nnode + 3]
      pressed%place(13:15) = [2*nnode + 1, 2*nnode + 2, 2*nnode + 3]
      own%x = x(:, 1:3, e)
      own%du(1:6) = du(pressed%place(1:6), e)
      own%thickening = section_motion(layout, du(:, e))
      own%section = scene%section
      if (scene%finite) own%section = instant%section + own%thickening
      own%length = side_length(scene, group%connectivity(:, first + e - 1))
      own%penalty = penalties(scene%materials(group%material), group, own%length, instant%lasting_share)
      associate (at_edge => committed(2*nblock + 1, :, e))
        trial(at_work, :, e) = committed(at_work, :, e)*thinning(xi, xi, own%section, own%thickening, own%x, own%du(1:6))
        trial(nblock + at_work, :, e) = committed(nblock + at_work, :, e) &
                                        *thinning(at_edge, at_edge, own%section, own%thickening, own%x, own%du(1:6))
      end associate
    end subroutine begin_side

    !> The point meets the die, or is handed over from a side of it to the next.
    subroutine press_point(die, middle)
      type(die_t), intent(in) :: die
      integer, intent(in) :: middle   !! piece of the die that the point is paired with
      real(wp) :: dphi(3)

      call line3(xi(p), pressed%phi, dphi)
      call side_point(pressed%phi, dphi, own%section, own%x, own%du(1:6), most_unknowns, pressed%point)
      pressed%weight = weight(p)
      call find_closest_point(die, middle)
      ! a point on the axis has no surface: nothing acts there, and no contact is evaluated
      if (closest%piece == 0 .or. axisym .and. pressed%point%x(1) <= no_surface*own%length) return
      trial(at_penetration, p, e) = merge(pressed%release%depth, closest%d, pressed%release%limited)
      trial([at_piece, at_xi], p, e) = [real(nearest%piece, wp), nearest%xi]
      ! past an edge its pressure is gone
      if (.not. pressed%release%share > 0) return
      if (handed%share > 0) there = trial(:nblock, p, e)
      call press(closest, (1 - handed%share)*pressed%release%share, trial(:nblock, p, e))
      if (handed%share > 0) call press_next()
      if (nint(committed(at_status, p, e)) /= contact_open) then
        report%jump = max(report%jump, abs(trial(at_penetration, p, e) - committed(at_penetration, p, e))/own%length)
        report%bearing = report%bearing + 1
        if (nint(trial(at_status, p, e)) == contact_open) report%lost = report%lost + 1
      end if
      report%event = min(report%event, share_to_contact(committed(:nblock, p, e), trial(:nblock, p, e), own%length))
    end subroutine press_point

    !> The closest point, on no piece where there is none; the nearest one, to which the point may be handed over, and what an edge
    !> that it slides past leaves of it.
    subroutine find_closest_point(die, middle)
      type(die_t), intent(in) :: die
      integer, intent(in) :: middle   !! piece of the die that the point is paired with
      integer :: kept_piece

      closest = closest_point_t()
      if (allocated(may)) then
        call find_own_closest_point(scene, group, first + e - 1, die, opposed(:nopposed), may(:, e), pressed%point, pressed%phi, &
                                    own%length, committed(:, p, e), nearest)
      else
        call closest_facing_point(die, pressed%point%x, pressed%point%e_r, own%length, nearest)
      end if
      ! a stale pair of a body's own side may be the far face of a wall
      if (allocated(may) .and. nearest%piece == 0) return
      call keep_closest_point(die, pressed%point, own%length, committed(:nblock, p, e), middle, nearest, closest, handed)
      kept_piece = closest%piece
      pressed%release = edge_release_t()
      if (.not. allocated(may)) then
        call slide_past_edge(scene%mesh%coordinates, die, pressed%point%x, own%length, &
                             allowed_penetration(scene%materials(group%material))*own%length, committed(:nblock, p, e), nearest, &
                             closest, pressed%release)
      end if
      if (.not. pressed%release%share < 1) call slide_past_end(die, closest, pressed%release)
      if (pressed%release%share < 1 .or. closest%piece /= kept_piece .or. nearest%piece == kept_piece) handed = handed_over_t()
    end subroutine find_closest_point

    !> What the next side bears of a point that is handed over to it.
    subroutine press_next()
      real(wp) :: way(most_unknowns)
      integer :: along(most_unknowns)

      way = handed%slope*pressed%dxi
      along = pressed%place
      if (own%tangent) call hand_over(pressed, along, -way/(1 - handed%share), stiffness(:, :, e))
      there(at_penetration) = nearest%d
      call press(nearest, handed%share, there)
      if (own%tangent) call hand_over(pressed, along, way/handed%share, stiffness(:, :, e))
      call share_state(handed%share, there, trial(:nblock, p, e))
    end subroutine press_next

    !> The edges of the die that the side meets between its points.
    subroutine press_edges_met(die)
      type(die_t), intent(in) :: die

      call press_edges(die, law, scene%materials(group%material), drivers(:, :, :, e), axisym, own, xi, pieces(:npiece), &
                       x(:, :, e), du(:, e), committed(:, :, e), trial(:, :, e), force(:, e), stiffness(:, :, e), report)
    end subroutine press_edges_met

    subroutine press(met, share, state)
      type(closest_point_t), intent(in) :: met
      real(wp), intent(in) :: share
      real(wp), intent(inout) :: state(:)   !! (nstate) [unit of each component]

      call press_met(law, scene%materials(group%material), drivers(:, :, p, e), own, x(:, :, e), du(:, e), pieces(:npiece), met, &
                     share, pressed, committed(:nblock, p, e), state, force(:, e), stiffness(:, :, e), report%unpaired)
    end subroutine press
  end subroutine compute

  !> Smallest box around the nodes of a side (xmin, ymin, xmax, ymax).
  pure function box_of(x, du) result(box)
    real(wp), intent(in) :: x(2, 3), du(6)
    real(wp) :: box(4)

    box = [minval(x(1, :) + du(1:3)), minval(x(2, :) + du(4:6)), maxval(x(1, :) + du(1:3)), maxval(x(2, :) + du(4:6))]
  end function box_of

end module elem_cntdf
