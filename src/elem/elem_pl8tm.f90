!> PL8TM: conduction of heat in the 8-node quadrilateral, in all plane states.
!>
!> Temperature on eight nodes with the consistent capacity, or with the option BILINEAR on the corners with the capacity lumped
!> there (no undershoot near a thermal shock; a linear temperature is exact where sides are straight). Balance of a step,
!> F_i = sum phi_i (h(T) - h(T_n))/dt dv0 + sum_k w_k sum grad phi_i LAMBDA grad T_k dv + sum phi_i (SOURCE (e - e_n) - r)/dt dv0
!> - sum phi_i r_w/dt dv_n, with T_k at the instants k of the flow rule (elem_api: the end of the step for implicit Euler), h the
!> heat content, r the heat released by the law and r_w that of plastic work; heat flow per unit of the section (per radian when
!> axisymmetric). The heat content goes with the mass: dv0 is the volume at the start of the scene, that at the start of the mesh
!> over the volume ratio that points then have (1 on the first mesh; kept where new meshes may come). Work is per volume of now
!> without elastic strain, a larger one of a body that has expanded: dv_n is that at the start of the step, so that no work is lost
!> of a step whose motion is found after the temperature. In plane stress of finite strains, where PL8TM does not know the
!> thickness at the end, it is dv0, and heat flows in the thickness at the start of the step. e is the volume strain, ln(dv) where
!> kinematics are finite, of the motion that PL8LS gives the body. Linearised exactly, along the displacements too, but for the
!> plastic work.
!> Source: K.J. Bathe, Finite Element Procedures, sec. 7.2; R.W. Lewis et al., The Finite Element Method in Heat Transfer Analysis.
module elem_pl8tm
  use elem_api, only: block_inverted, elem_t, first_unknown, instant_t, layout_t, mode_error, mode_restore, report_t, &
                      that_reads, totals_t, unknown_t
  use fields, only: displacement_field, field_t, transfer_nodal
  use heat_conduction, only: add_flow
  use heat_content, only: add_content, add_due, add_error, add_released
  use heat_points, only: functions_of, functions_t, heat_points_t, place_element
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: driver_count, heat_law, law_t
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: group_t, plane_stress, role_body, scene_t
  use sections, only: thickness_at
  use state_variables, only: find_variable, name_of_heat_due, name_of_ratio, state_variable_t
  implicit none
  private
  public :: elem_pl8tm_row

  !> Place of the option BILINEAR; the temperature is the first field of the element's unknowns.
  integer, parameter :: bilinear = 1, temperature = 1

contains

  function elem_pl8tm_row() result(row)
    type(elem_t) :: row

    row%name = 'PL8TM'
    row%purpose = 'conduction of heat, 8-node quadrilateral'
    row%nnode = 8
    row%role = role_body
    row%law_kind = heat_law
    row%effect = 'heat'
    allocate (row%options(1))
    row%options(bilinear)%s = 'BILINEAR'
    allocate (row%unknowns, source=[of_temperature(), of_temperature(), that_reads('displacement')])
    row%unknowns(1)%option = 0
    row%unknowns(2)%option = bilinear
    row%unknowns(2)%field%at_corners = .true.
    row%variables => variables
    row%compute => compute
    row%measure => measure
  end function elem_pl8tm_row

  !> The temperature on the nodes of an element.
  pure function of_temperature() result(unknown)
    type(unknown_t) :: unknown

    unknown%field = field_t(name='temperature', unit='temperature', dual='heat_flow', dual_unit='power', word='T', &
                            quantity='temperature', transfer=transfer_nodal, imposed_as_value=.true.)
  end function of_temperature

  !> The heat content is a function of the temperature: points keep what the law does.
  pure subroutine variables(law, plane_state, list)
    type(law_t), intent(in) :: law
    integer, intent(in) :: plane_state
    type(state_variable_t), allocatable, intent(out) :: list(:)
    integer :: k, next

    allocate (list, source=law%history)
    next = 1
    do k = 1, size(list)
      list(k)%first = next
      next = next + list(k)%ncomp
    end do
  end subroutine variables

  !> Rows of the state variables of the formulation that drive its law, 0 for other drivers.
  pure function own_states(law, group) result(rows)
    type(law_t), intent(in) :: law
    type(group_t), intent(in) :: group
    integer :: rows(driver_count(law))
    integer :: k, v

    rows = 0
    do k = 2, size(rows)
      v = find_variable(group%variables, law%drivers(k - 1)%name)
      if (v > 0) rows(k) = group%variables(v)%first
    end do
  end function own_states

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
    type(heat_points_t) :: place
    real(wp) :: motion(16)
    real(wp) :: mixture(min(size(drivers, 1), driver_count(law)), 2, group%rule%n), by_end(size(committed, 1), group%rule%n)
    real(wp) :: phases_by_end(min(size(drivers, 1), driver_count(law)), group%rule%n)
    integer :: phase(driver_count(law))
    integer :: e, k, u, moves, ratio, due, n, m

    force = 0
    if (instant%content .and. instant%mode /= mode_error) trial(:size(committed, 1), :, :) = committed
    if (instant%tangent) stiffness = 0
    if (instant%mode == mode_restore) then
      ! on a new mesh temperatures stay as they were carried
      do k = 1, layout%count(temperature)
        if (instant%tangent) stiffness(k, k, :) = 1
      end do
      return
    end if
    ! behind the law's own state
    ratio = find_variable(group%variables, name_of_ratio)
    if (ratio > 0) ratio = group%variables(ratio)%first
    due = find_variable(group%variables, name_of_heat_due)
    if (due > 0) due = group%variables(due)%first
    n = size(committed, 1) - count([ratio, due] > 0)
    m = min(size(drivers, 1), driver_count(law))
    phase = own_states(law, group)
    call quad8_rule(group%rule%n, rule)
    call functions_of(group%option == bilinear, rule, own)
    u = first_unknown(layout, displacement_field)
    moves = merge(16, 0, u > 0)
    do e = 1, size(x, 3)
      if (u > 0) motion = du(u:u + 15, e)
      call place_element(scene, instant, kinematics%finite, rule, own, &
                         scene%mesh%coordinates(:, group%connectivity(:, first + e - 1)), x(:, :, e), motion(:moves), place)
      if (.not. place%valid) then
        report%status = block_inverted
        report%element = first + e - 1
        return
      end if
      if (ratio > 0) place%dv0(:rule%npoint) = place%dv0(:rule%npoint)/committed(ratio, :, e)
      if (kinematics%finite .and. scene%plane_state == plane_stress) then
        place%worked = place%dv0
        if (size(drivers, 1) > m) place%dv(:rule%npoint) = place%dv(:rule%npoint)*drivers(m + 1, 1, :, e)
      else if (size(drivers, 1) > m) then
        place%worked(:rule%npoint) = place%worked(:rule%npoint)*drivers(m + 1, 1, :, e)
      end if
      associate (material => scene%materials(group%material))
        if (instant%mode == mode_error) then
          call add_error(law, material, rule%npoint, own, group%option == bilinear, place, drivers(:m, :, :, e), du(:own%n, e), &
                         start(:own%n, e), report)
          cycle
        end if
        if (instant%content) then
          call add_content(instant, law, material, rule%npoint, own, group%option == bilinear, place, drivers(:m, :, :, e), &
                           du(:own%n, e), start(:own%n, e), force(:, e), stiffness(:, :, e), report%heat_stored)
          call add_released(instant, law, material, rule%npoint, own, place, drivers(:m, :, :, e), du(:own%n, e), &
                            start(:own%n, e), u, committed(:n, :, e), trial(:n, :, e), force(:, e), stiffness(:, :, e), &
                            by_end(:n, :), report)
          if (size(trial, 1) > size(committed, 1)) trial(size(committed, 1) + 1:size(committed, 1) + n, :, e) = by_end(:n, :)
          if (due > 0) then
            call add_due(instant, rule%npoint, own, place, committed(due, :, e), force(:, e), report)
            trial(due, :, e) = 0
          end if
        end if
        ! heat is conducted by the phases that there are then
        mixture = drivers(:m, :, :, e)
        phases_by_end = 0
        do k = 1, m
          if (.not. (phase(k) > 0 .and. instant%reach > 0)) cycle
          mixture(k, 2, :) = trial(phase(k), :, e)
          if (instant%content) phases_by_end(k, :) = by_end(phase(k), :)
        end do
        do k = 1, instant%flow%n
          call add_flow(instant, k, law, material, kinematics%finite, rule%npoint, own, place, mixture, phases_by_end, &
                        du(:own%n, e), start(:own%n, e), u, force(:, e), stiffness(:, :, e))
        end do
      end associate
    end do
  end subroutine compute

  !> Volume, where no other formulation gives it.
  subroutine measure(scene, group, law, section, penalty_share, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: section(3), penalty_share, x(:, :, :), state(:, :, :), before(:, :, :)
    type(totals_t), intent(out) :: totals
    type(quad8_rule_t) :: rule
    real(wp) :: nx(8), ny(8), detj, thickness(3)
    integer :: e, p

    if (group%host > 0) return
    thickness = scene%section
    if (scene%finite) thickness = section
    call quad8_rule(group%rule%n, rule)
    do e = 1, size(x, 3)
      do p = 1, group%rule%n
        call derivatives(rule%dphi(:, :, p), x(:, :, e), nx, ny, detj)
        totals%volume = totals%volume + detj*rule%weight(p)*thickness_at(thickness, matmul(x(:, :, e), rule%phi(:, p)))
      end do
    end do
    totals%unloaded_volume = totals%volume
  end subroutine measure

end module elem_pl8tm
