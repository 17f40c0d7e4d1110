!> CNTTM and CNDTM: heat between 3-node sides of a body and the die that they face, a rigid one with one temperature or sides of
!> other bodies.
!>
!> Per area q (heat_contacts) comes into the side and leaves the facing point of the die, the area as it is projected on the tangent
!> of the die there: a side that stands on the die with its end gets no heat along itself; F_i = -sum_k w_k integral phi_i q dA,
!> F_j = +sum_k w_k integral psi_j q dA at the instants k of the flow rule (elem_api), psi = 1 for a rigid die and the functions of
!> the facing side at the closest point for a deformable one: what the die loses the side gains, point by point. Where temperatures
!> stand on corners each pair of ends exchanges for itself, with the product of their shares of the area: the same sum, and no
!> temperature leaves those around it. The work that friction took becomes heat of both (heat_contacts).
!>
!> Pressure, gap and the facing point are those that the contact group of the same sides and points (its host) has reached, at the
!> end of the step where it is solved for in turns or together with the temperature, else at the start. Where it knows none (first
!> step, wide gaps), and in scenes of heat alone, the die is searched as it stands. Linearised exactly at given pressure, gap and
!> facing point: along all temperatures, and along the displacements that change the area; how the rest follows the motion is added
!> near the solution (contact_heat_tangent).
module elem_heat_contact
  use contact_work, only: friction_energy
  use drivers, only: at_body_effusivity, at_corner_place, at_corner_work, at_die_effusivity, at_friction_work
  use elem_api, only: elem_t, first_unknown, instant_t, layout_t, mode_advance, mode_error, of_pilot, report_t, unknown_t
  use elem_heat_sides, only: heat_side_row
  use fields, only: displacement_field, field_t, has_corners_only, on_pilots
  use heat_contact_flows, only: add_exchange, add_friction, area_t, project_area
  use heat_contact_point, only: facing_t, find_facing, share_out, shares_t
  use heat_contacts, only: share_by_effusivity
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use pairs, only: list_pieces, pieces_in_reach
  use quadrature, only: line_rule
  use scene, only: group_t, role_heat_contact, scene_t
  use shape_functions, only: line3
  use side_points, only: area_at, side_length
  use state_variables, only: find_variable
  use strategy, only: coupling_once
  implicit none
  private
  public :: elem_cnttm_row, elem_cndtm_row, name_of_due, name_of_piece

  !> Names of the state of a point, where it is kept: work of friction that has not become heat yet, per area; and the facing piece.
  character(len=*), parameter :: name_of_due = 'friction_due', name_of_piece = 'die_piece'
  !> The temperature is the first of the element's unknowns.
  integer, parameter :: temperature = 1

contains

  function elem_cnttm_row() result(row)
    type(elem_t) :: row
    type(unknown_t) :: unknown, pilot

    row = common_row('CNTTM', 'heat between a side and a rigid die')
    unknown%field = field_t(name='die_temperature', unit='temperature', dual='die_heat', dual_unit='power', place=on_pilots, &
                            quantity='temperature', transfer='recompute', word='', imposed_as_value=.true.)
    pilot = of_pilot()
    pilot%optional = .true.
    pilot%acts = .false.
    row%unknowns = [row%unknowns(1), unknown, row%unknowns(2), pilot]
  end function elem_cnttm_row

  function elem_cndtm_row() result(row)
    type(elem_t) :: row

    row = common_row('CNDTM', 'heat between a side and sides of another body')
  end function elem_cndtm_row

  function common_row(name, purpose) result(row)
    character(len=*), intent(in) :: name, purpose
    type(elem_t) :: row

    row = heat_side_row(name, purpose, role_heat_contact)
    row%follows = .true.
    row%compute => compute
  end function common_row

  !> Heat flows out of the nodes of sides and dies, and their derivatives. A side never fails.
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
    real(wp) :: ends(2, 3, 2), y(2, 3), phi(3), dphi(3), section(3), side, due
    integer :: e, p, u, nnode, npiece, row_due, row_piece
    integer :: pieces(pieces_in_reach*group%rule%n), along(6), nmoving
    logical :: of_body, rigid, corners
    type(facing_t) :: facing
    type(shares_t) :: shares
    type(area_t) :: area

    force = 0
    if (instant%tangent) stiffness = 0
    if (instant%content .and. instant%mode /= mode_error) trial = committed
    if (instant%mode /= mode_advance) return
    nnode = size(x, 2)
    corners = has_corners_only(scene%fields(layout%field(temperature)))
    of_body = allocated(scene%dies(group%die)%nodes)
    rigid = .not. of_body
    row_due = find_variable(group%variables, name_of_due)
    row_piece = find_variable(group%variables, name_of_piece)
    u = first_unknown(layout, displacement_field)
    along = [u, u + 1, u + 2, u + nnode, u + nnode + 1, u + nnode + 2]
    nmoving = merge(6, 0, u > 0 .and. kinematics%finite)
    section = scene%section
    if (kinematics%finite) section = instant%section
    npiece = 0
    call line_rule(group%rule, xi, weight)
    do e = 1, size(x, 3)
      ends = spread(x(:, 1:3, e), 3, 2)
      if (u > 0) ends(:, :, 2) = ends(:, :, 2) + transpose(reshape(du(along, e), [3, 2]))
      y = ends(:, :, merge(2, 1, kinematics%finite))
      side = side_length(scene, group%connectivity(:, first + e - 1))
      if (.not. rigid) call list_pieces(instant%dies(group%die), instant%pairs(group%pairs)%piece(:, first + e - 1), npiece, pieces)
      do p = 1, size(xi)
        call line3(xi(p), phi, dphi)
        call find_facing(scene, group, instant, drivers(:, :, p, e), phi, dphi, section, side, x(:, 1:3, e), y, facing)
        if (row_piece > 0) trial(row_piece, p, e) = facing%piece
        call share_out(layout, merge(2, 3, corners), rigid, xi(p), phi, facing, pieces(:npiece), shares)
        if (facing%found .and. shares%ndie == 0) then
          report%unpaired = .true.
          cycle
        end if
        call project_area(weight(p), y, phi, dphi, facing%along, section, area)
        if (facing%found .and. area%faces) call add_exchange(group%heat_contact, instant, facing, shares, area, along(:nmoving), &
                                                             start(:, e), du(:, e), force(:, e), stiffness(:, :, e))
        if (row_due == 0 .or. .not. instant%content) cycle
        due = committed(row_due, p, e)*weight(p)*area_at(xi(p), section, x(:, 1:3, e))
        if (scene%strategy%coupling /= coupling_once) call add_work_of_step(group, of_body, xi, weight, p, section, ends, &
                                                                            drivers(:, :, p, e), due)
        trial(row_due, p, e) = 0
        call add_friction(instant, shares, share_of_side(group, drivers(:, 1, p, e)), group%heat_contact%friction*due, &
                          force(:, e), report)
      end do
    end do
  end subroutine compute

  !> Add the work that friction takes in the step under way.
  pure subroutine add_work_of_step(group, of_body, xi, weight, p, section, ends, drivers, due)
    type(group_t), intent(in) :: group
    logical, intent(in) :: of_body                  !! the die is made of sides of a body
    real(wp), intent(in) :: xi(:), weight(:)        !! (npoint) of the side [-]
    integer, intent(in) :: p                        !! the point
    real(wp), intent(in) :: section(3)
    real(wp), intent(in) :: ends(2, 3, 2)           !! nodes of the side at both ends of the step [length]
    real(wp), intent(in) :: drivers(:, :)           !! (ndriver, 2) of the point [unit of each driver]
    real(wp), intent(inout) :: due                  !! [energy]
    real(wp) :: energy(2)

    energy = friction_energy(group%rule, of_body, xi, weight, p, &
                             drivers([at_friction_work, at_corner_work, at_corner_place], :), spread(section, 2, 2), ends)
    due = due + energy(2) - energy(1)
  end subroutine add_work_of_step

  !> Share of the heat of friction that the side gets: as the deck says, or by effusivities.
  pure function share_of_side(group, drivers) result(share)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: drivers(:)   !! (ndriver) at the start of the step
    real(wp) :: share

    share = group%heat_contact%share
    if (share < 0) share = share_by_effusivity(drivers(at_body_effusivity), drivers(at_die_effusivity))
  end function share_of_side

end module elem_heat_contact
