!> PL8TM: conduction of heat in the 8-node quadrilateral, in all plane states.
!>
!> Temperature on eight nodes with the consistent capacity, or with the option BILINEAR on the corners with the capacity lumped
!> there (no undershoot near a thermal shock; a linear temperature is exact where sides are straight). Balance at the end of the
!> step, implicit Euler:
!> F_i = sum phi_i RHOC (T - T_n)/dt dv0 + sum grad phi_i LAMBDA grad T dv + sum phi_i SOURCE (e - e_n)/dt dv0,
!> heat flow per unit of the section (per radian when axisymmetric). The content of heat goes with the mass: dv0 is the volume at
!> the start of the mesh; e is the volume strain, ln(dv) where kinematics are finite, of the motion that PL8LS gives the body.
!> Linearised exactly, along the displacements too.
!> Source: K.J. Bathe, Finite Element Procedures, sec. 7.2; R.W. Lewis et al., The Finite Element Method in Heat Transfer Analysis.
module elem_pl8tm
  use elem_api, only: block_inverted, elem_t, first_unknown, instant_t, layout_t, mode_restore, report_t, that_reads, &
                      totals_t, unknown_t
  use fields, only: displacement_field, field_t, transfer_nodal
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: conduction_t, heat_law, law_t
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use quadrature, only: square_rule
  use scene, only: group_t, role_body, scene_t
  use sections, only: thickness_at
  use shape_functions, only: quad4, quad8_corner
  use state_variables, only: state_variable_t
  implicit none
  private
  public :: elem_pl8tm_row

  !> Place of the option BILINEAR; the temperature is the first field of the element's unknowns.
  integer, parameter :: bilinear = 1, temperature = 1

  !> Functions of the temperature at the points: values (8, npoint) and parent derivatives (2, 8, npoint), as many as there are.
  type :: functions_t
    integer :: n = 0
    real(wp) :: phi(8, 9) = 0.0_wp, dphi(2, 8, 9) = 0.0_wp
  end type functions_t

contains

  function elem_pl8tm_row() result(row)
    type(elem_t) :: row
    type(unknown_t) :: unknown

    row%name = 'PL8TM'
    row%purpose = 'conduction of heat, 8-node quadrilateral'
    row%nnode = 8
    row%role = role_body
    row%law_kind = heat_law
    row%effect = 'heat'
    allocate (row%options(1))
    row%options(bilinear)%s = 'BILINEAR'
    unknown%field = field_t(name='temperature', unit='temperature', dual='heat_flow', dual_unit='power', word='T', &
                            quantity='temperature', transfer=transfer_nodal, imposed_as_value=.true.)
    allocate (row%unknowns, source=[unknown, unknown, that_reads('displacement')])
    row%unknowns(1)%option = 0
    row%unknowns(2)%option = bilinear
    row%unknowns(2)%field%at_corners = .true.
    row%variables => variables
    row%compute => compute
    row%measure => measure
  end function elem_pl8tm_row

  !> The content of heat is a function of the temperature: points keep nothing.
  pure subroutine variables(law, plane_state, list)
    type(law_t), intent(in) :: law
    integer, intent(in) :: plane_state
    type(state_variable_t), allocatable, intent(out) :: list(:)

    allocate (list(0))
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
    type(quad8_rule_t) :: rule
    type(functions_t) :: own
    type(conduction_t) :: numbers
    integer :: e, k, u
    logical :: valid

    force = 0
    if (instant%tangent) stiffness = 0
    if (instant%mode == mode_restore) then
      ! on a new mesh temperatures stay as they were carried
      do k = 1, layout%count(temperature)
        if (instant%tangent) stiffness(k, k, :) = 1
      end do
      return
    end if
    numbers = law%conduct(scene%materials(group%material), 0.0_wp)
    call quad8_rule(group%rule%n, rule)
    call functions_of(group, rule, own)
    u = first_unknown(layout, displacement_field)
    do e = 1, size(x, 3)
      associate (nodes => group%connectivity(:, first + e - 1))
        if (u > 0) then
          call balance(scene, instant, kinematics%finite, rule, own, group%option == bilinear, numbers, &
                       scene%mesh%coordinates(:, nodes), x(:, :, e), du(u:u + 15, e), du(:own%n, e), start(:own%n, e), u, &
                       force(:, e), stiffness(:, :, e), valid)
        else
          call balance(scene, instant, kinematics%finite, rule, own, group%option == bilinear, numbers, &
                       scene%mesh%coordinates(:, nodes), x(:, :, e), spread(0.0_wp, 1, 16), du(:own%n, e), start(:own%n, e), u, &
                       force(:, e), stiffness(:, :, e), valid)
        end if
      end associate
      if (valid) cycle
      report%status = block_inverted
      report%element = first + e - 1
      return
    end do
  end subroutine compute

  !> Functions of the temperature at the points of the rule.
  pure subroutine functions_of(group, rule, own)
    type(group_t), intent(in) :: group
    type(quad8_rule_t), intent(in) :: rule
    type(functions_t), intent(out) :: own
    real(wp), allocatable :: xi(:, :), weight(:)
    integer :: p

    if (group%option /= bilinear) then
      own%n = 8
      own%phi = rule%phi
      own%dphi = rule%dphi
      return
    end if
    own%n = 4
    call square_rule(group%rule%n, xi, weight)
    do p = 1, group%rule%n
      call quad4(xi(1, p), xi(2, p), own%phi(:4, p))
      own%dphi(1, :4, p) = 0.25_wp*quad8_corner(1, :)*(1 + quad8_corner(2, :)*xi(2, p))
      own%dphi(2, :4, p) = 0.25_wp*quad8_corner(2, :)*(1 + quad8_corner(1, :)*xi(1, p))
    end do
  end subroutine functions_of

  !> Heat flows of one element, and their derivatives along its temperatures and displacements.
  pure subroutine balance(scene, instant, finite, rule, own, lumped, numbers, x0, x, motion, dt_nodes, t_nodes, u, force, &
                          stiffness, valid)
    type(scene_t), intent(in) :: scene
    type(instant_t), intent(in) :: instant
    logical, intent(in) :: finite, lumped
    type(quad8_rule_t), intent(in) :: rule
    type(functions_t), intent(in) :: own
    type(conduction_t), intent(in) :: numbers
    real(wp), intent(in) :: x0(2, 8), x(2, 8)               !! nodes at the start of the mesh, and of the step [length]
    real(wp), intent(in) :: motion(16)                      !! of the nodes, x then y [length]
    real(wp), intent(in) :: dt_nodes(:), t_nodes(:)         !! change of the temperatures, and their start (n) [temperature]
    integer, intent(in) :: u                                !! local place of the first displacement, 0 where there is none
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    logical, intent(out) :: valid
    real(wp) :: y(2, 8), nx(8), ny(8), detj, dv, dv0, before, thickness, gx(8), gy(8), jacobian(2, 2), slope(2), capacity, strain
    real(wp) :: section(3), swelling(16)
    integer :: p, i, j, n

    n = own%n
    valid = .true.
    y = x
    if (finite) y = x + transpose(reshape(motion, [8, 2]))
    section = scene%section
    if (finite) section = instant%section
    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), x0, nx, ny, detj)
      dv0 = detj*rule%weight(p)*thickness_at(scene%section, matmul(x0, rule%phi(:, p)))
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      before = detj*thickness_at(section, matmul(x, rule%phi(:, p)))
      call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
      thickness = thickness_at(section, matmul(y, rule%phi(:, p)))
      valid = valid .and. detj > 0 .and. thickness > 0
      if (.not. valid) return
      dv = detj*thickness*rule%weight(p)
      jacobian(:, 1) = matmul(y, rule%dphi(1, :, p))
      jacobian(:, 2) = matmul(y, rule%dphi(2, :, p))
      associate (d => own%dphi(:, :n, p))
        gx(:n) = (jacobian(2, 2)*d(1, :) - jacobian(2, 1)*d(2, :))/detj
        gy(:n) = (jacobian(1, 1)*d(2, :) - jacobian(1, 2)*d(1, :))/detj
      end associate
      slope = numbers%conductivity*[dot_product(gx(:n), t_nodes + dt_nodes), dot_product(gy(:n), t_nodes + dt_nodes)]
      force(:n) = force(:n) + dv*(gx(:n)*slope(1) + gy(:n)*slope(2))
      capacity = numbers%capacity*dv0/instant%dt
      if (lumped) then
        force(:n) = force(:n) + capacity*own%phi(:n, p)*dt_nodes
      else
        force(:n) = force(:n) + capacity*own%phi(:n, p)*dot_product(own%phi(:n, p), dt_nodes)
      end if
      ! volume strain of the step, and its derivative along the displacements
      swelling(1:8) = nx + section(2)*rule%phi(:, p)/thickness
      swelling(9:16) = ny + section(3)*rule%phi(:, p)/thickness
      if (finite) then
        strain = log(detj*thickness/before)
      else
        strain = dot_product(swelling, motion)
      end if
      force(:n) = force(:n) + own%phi(:n, p)*(numbers%source*dv0/instant%dt*strain)
      if (.not. instant%tangent) cycle
      do j = 1, n
        stiffness(:n, j) = stiffness(:n, j) + (dv*numbers%conductivity)*(gx(:n)*gx(j) + gy(:n)*gy(j))
        if (lumped) then
          stiffness(j, j) = stiffness(j, j) + capacity*own%phi(j, p)
        else
          stiffness(:n, j) = stiffness(:n, j) + capacity*own%phi(:n, p)*own%phi(j, p)
        end if
      end do
      if (u == 0) cycle
      do j = 1, 16
        stiffness(:n, u + j - 1) = stiffness(:n, u + j - 1) + own%phi(:n, p)*(numbers%source*dv0/instant%dt*swelling(j))
        if (.not. finite) cycle
        stiffness(:n, u + j - 1) = stiffness(:n, u + j - 1) + dv*swelling(j)*(gx(:n)*slope(1) + gy(:n)*slope(2))
      end do
      if (.not. finite) cycle
      ! gradients turn and stretch with the geometry: d(grad phi) = - grad(du)^T grad phi
      do j = 1, 8
        i = u + j - 1
        associate (along => nx(j)*slope(1) + ny(j)*slope(2), cross => gx(:n)*nx(j) + gy(:n)*ny(j))
          stiffness(:n, i) = stiffness(:n, i) - dv*(gx(:n)*along + cross*slope(1))
          stiffness(:n, i + 8) = stiffness(:n, i + 8) - dv*(gy(:n)*along + cross*slope(2))
        end associate
      end do
    end do
  end subroutine balance

  !> Volume, where no other formulation gives it.
  subroutine measure(scene, group, law, section, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: section(3), x(:, :, :), state(:, :, :), before(:, :, :)
    type(totals_t), intent(out) :: totals
    type(quad8_rule_t) :: rule
    real(wp) :: nx(8), ny(8), detj
    integer :: e, p

    if (group%host > 0) return
    call quad8_rule(group%rule%n, rule)
    do e = 1, size(x, 3)
      do p = 1, group%rule%n
        call derivatives(rule%dphi(:, :, p), x(:, :, e), nx, ny, detj)
        totals%volume = totals%volume + detj*rule%weight(p)*thickness_at(section, matmul(x(:, :, e), rule%phi(:, p)))
      end do
    end do
    totals%unloaded_volume = totals%volume
  end subroutine measure

end module elem_pl8tm
