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
  use contact_point, only: area_at, side_length
  use contact_work, only: friction_energy
  use drivers, only: at_body_effusivity, at_corner_place, at_corner_work, at_die_effusivity, at_friction_work
  use elem_api, only: elem_t, first_unknown, instant_t, layout_t, mode_advance, mode_error, of_pilot, report_t, unknown_t
  use elem_heat_sides, only: heat_side_row
  use fields, only: displacement_field, field_t, has_corners_only, on_pilots
  use heat_contact_point, only: facing_t, find_facing, share_out, shares_t
  use heat_contacts, only: flow_from_die, share_by_effusivity
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use pairs, only: list_pieces, pieces_in_reach
  use quadrature, only: line_rule
  use scene, only: group_t, role_heat_contact, scene_t
  use sections, only: thickness_at
  use shape_functions, only: line3
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
    real(wp) :: y(2, 3), phi(3), dphi(3), length, thickness, area, darea(6), section(3), side, energy(2), due
    integer :: e, p, u, nnode, npiece, row_due, row_piece
    integer :: pieces(pieces_in_reach*group%rule%n), along(6)
    logical :: rigid, of_body, corners
    type(facing_t) :: facing
    type(shares_t) :: shares

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
    section = scene%section
    if (kinematics%finite) section = instant%section
    npiece = 0
    call line_rule(group%rule, xi, weight)
    do e = 1, size(x, 3)
      y = x(:, 1:3, e)
      if (u > 0 .and. kinematics%finite) y = y + transpose(reshape(du(along, e), [3, 2]))
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
        length = dot_product(matmul(y, dphi), facing%along)
        thickness = thickness_at(section, matmul(y, phi))
        area = weight(p)*length*thickness
        darea(1:3) = weight(p)*(dphi*facing%along(1)*thickness + length*section(2)*phi)
        darea(4:6) = weight(p)*(dphi*facing%along(2)*thickness + length*section(3)*phi)
        if (facing%found .and. length > 0) call add_exchange()
        if (row_due == 0 .or. .not. instant%content) cycle
        due = committed(row_due, p, e)*weight(p)*area_at(xi(p), section, x(:, 1:3, e))
        if (scene%strategy%coupling /= coupling_once) then
          energy = friction_energy(group%rule, of_body, xi, weight, p, &
                                   drivers([at_friction_work, at_corner_work, at_corner_place], :, p, e), &
                                   spread(section, 2, 2), reshape([x(:, 1:3, e), end_of_step()], [2, 3, 2]))
          due = due + energy(2) - energy(1)
        end if
        trial(row_due, p, e) = 0
        call add_friction()
      end do
    end do

  contains

    !> Nodes of the side at the end of the step, as contact has them.
    pure function end_of_step() result(z)
      real(wp) :: z(2, 3)

      z = x(:, 1:3, e)
      if (u > 0) z = z + transpose(reshape(du(along, e), [3, 2]))
    end function end_of_step

    !> Exchange at the instants of the flow rule: one of the point, or one of each pair of ends.
    subroutine add_exchange()
      real(wp) :: t(6), h(2)
      integer :: k, i, j, n
      type(shares_t) :: pair

      n = shares%nside + shares%ndie
      do k = 1, instant%flow%n
        t(:n) = start(shares%place(:n), e) + instant%flow%share(k)*du(shares%place(:n), e)
        h = (1 - instant%flow%share(k))*facing%conductance(:, 1) + instant%flow%share(k)*facing%conductance(:, 2)
        if (shares%nside == 3) then
          call add_flow(k, shares, 1.0_wp, t(:n), h)
          cycle
        end if
        do i = 1, shares%nside
          do j = 1, shares%ndie
            pair = shares
            pair%side = 0
            pair%die = 0
            pair%side(i) = 1
            pair%die(j) = 1
            call add_flow(k, pair, shares%side(i)*shares%die(j), t(:n), h)
          end do
        end do
      end do
    end subroutine add_exchange

    !> The share `part` of the area exchanges between temperatures that are means by shares.
    subroutine add_flow(k, means, part, t, h)
      integer, intent(in) :: k
      type(shares_t), intent(in) :: means
      real(wp), intent(in) :: part, t(:), h(2)
      real(wp) :: q, slope, slope_die, gives(6), takes(6)
      integer :: n, m, j

      m = means%nside
      n = m + means%ndie
      call flow_from_die(group%heat_contact, h, dot_product(means%side(:m), t(:m)), dot_product(means%die(:n - m), t(m + 1:n)), &
                         q, slope, slope_die)
      gives(:m) = -means%side(:m)
      gives(m + 1:n) = means%die(:n - m)
      takes(:m) = slope*means%side(:m)
      takes(m + 1:n) = slope_die*means%die(:n - m)
      associate (place => means%place(:n), w => instant%flow%weight(k)*part)
        force(place, e) = force(place, e) + gives(:n)*(w*q*area)
        if (.not. instant%tangent) return
        do j = 1, n
          stiffness(place, place(j), e) = stiffness(place, place(j), e) &
                                          + gives(:n)*(w*area*instant%flow%share(k)*takes(j))
        end do
        if (u == 0 .or. .not. kinematics%finite) return
        do j = 1, 6
          stiffness(place, along(j), e) = stiffness(place, along(j), e) + gives(:n)*(w*q*darea(j))
        end do
      end associate
    end subroutine add_flow

    !> Heat of friction to both.
    subroutine add_friction()
      real(wp) :: share, heat

      heat = group%heat_contact%friction*due
      share = group%heat_contact%share
      if (share < 0) share = share_by_effusivity(drivers(at_body_effusivity, 1, p, e), drivers(at_die_effusivity, 1, p, e))
      if (shares%ndie == 0) share = 1
      associate (m => shares%nside, n => shares%nside + shares%ndie)
        force(shares%place(:m), e) = force(shares%place(:m), e) - shares%side(:m)*(share*heat/instant%dt)
        force(shares%place(m + 1:n), e) = force(shares%place(m + 1:n), e) - shares%die(:n - m)*((1 - share)*heat/instant%dt)
      end associate
      report%source = report%source + (heat/instant%dt)**2
      report%heat_released = report%heat_released + heat
    end subroutine add_friction

  end subroutine compute

end module elem_heat_contact
