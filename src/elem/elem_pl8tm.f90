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
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: driver_count, driver_temperature, heat_law, law_t
  use materials, only: material_t
  use quad8_geometry, only: derivatives, determinant, quad8_rule, quad8_rule_t
  use quadrature, only: square_rule
  use scene, only: group_t, plane_stress, role_body, scene_t
  use sections, only: thickness_at
  use shape_functions, only: quad4, quad8_corner
  use state_variables, only: find_variable, name_of_heat_due, name_of_ratio, state_variable_t
  implicit none
  private
  public :: elem_pl8tm_row
  public :: functions_t, heat_points_t, functions_of, place_element

  !> Place of the option BILINEAR; the temperature is the first field of the element's unknowns.
  integer, parameter :: bilinear = 1, temperature = 1

  !> Functions of the temperature at the points: values (8, npoint) and parent derivatives (2, 8, npoint), as many as there are.
  type :: functions_t
    integer :: n = 0
    real(wp) :: phi(8, 9) = 0.0_wp, dphi(2, 8, 9) = 0.0_wp
  end type functions_t

  !> Geometry of an element in a step at its points.
  type :: heat_points_t
    real(wp) :: dv(9), dv0(9)                 !! volumes at the end of the step and at the start of the scene
    real(wp) :: worked(9)                     !! volumes that plastic work is per, at the start of the step
    real(wp) :: gx(8, 9), gy(8, 9)            !! gradients of the functions of the temperature
    real(wp) :: nx(8, 9), ny(8, 9)            !! gradients of the shape functions
    real(wp) :: strain(9), swelling(16, 9)    !! volume strain of the step, and its derivative along the displacements
    logical :: valid = .true.
  end type heat_points_t

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

  !> Functions of the temperature at the points of the rule.
  pure subroutine functions_of(at_corners, rule, own)
    logical, intent(in) :: at_corners
    type(quad8_rule_t), intent(in) :: rule
    type(functions_t), intent(out) :: own
    real(wp), allocatable :: xi(:, :), weight(:)
    integer :: p

    if (.not. at_corners) then
      own%n = 8
      own%phi = rule%phi
      own%dphi = rule%dphi
      return
    end if
    own%n = 4
    call square_rule(rule%npoint, xi, weight)
    do p = 1, rule%npoint
      call quad4(xi(1, p), xi(2, p), own%phi(:4, p))
      own%dphi(1, :4, p) = 0.25_wp*quad8_corner(1, :)*(1 + quad8_corner(2, :)*xi(2, p))
      own%dphi(2, :4, p) = 0.25_wp*quad8_corner(2, :)*(1 + quad8_corner(1, :)*xi(1, p))
    end do
  end subroutine functions_of

  !> Volumes, gradients and volume strain at the points of an element.
  pure subroutine place_element(scene, instant, finite, rule, own, x0, x, motion, place)
    type(scene_t), intent(in) :: scene
    type(instant_t), intent(in) :: instant
    logical, intent(in) :: finite
    type(quad8_rule_t), intent(in) :: rule
    type(functions_t), intent(in) :: own
    real(wp), intent(in) :: x0(2, 8), x(2, 8)   !! nodes at the start of the mesh, and of the step [length]
    real(wp), intent(in) :: motion(:)           !! (16) of the nodes, x then y; (0) where the scene has none [length]
    type(heat_points_t), intent(out) :: place
    real(wp) :: y(2, 8), nx(8), ny(8), detj, before, thickness, jacobian(2, 2), section(3)
    logical :: moves, moved
    integer :: p

    moves = size(motion) > 0
    y = x
    if (finite .and. moves) y = x + transpose(reshape(motion, [8, 2]))
    section = scene%section
    if (finite) section = instant%section
    moved = finite .or. any(abs(x - x0) > 0)
    do p = 1, rule%npoint
      if (moves) then
        call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
      else
        detj = determinant(rule%dphi(:, :, p), y)
      end if
      thickness = thickness_at(section, matmul(y, rule%phi(:, p)))
      place%dv0(p) = detj*rule%weight(p)*thickness
      before = detj*thickness
      if (finite) before = determinant(rule%dphi(:, :, p), x)*thickness_at(section, matmul(x, rule%phi(:, p)))
      if (moved) place%dv0(p) = determinant(rule%dphi(:, :, p), x0)*rule%weight(p) &
                                *thickness_at(scene%section, matmul(x0, rule%phi(:, p)))
      place%worked(p) = before*rule%weight(p)
      place%valid = place%valid .and. detj > 0 .and. thickness > 0
      if (.not. place%valid) return
      place%dv(p) = detj*thickness*rule%weight(p)
      jacobian(:, 1) = matmul(y, rule%dphi(1, :, p))
      jacobian(:, 2) = matmul(y, rule%dphi(2, :, p))
      associate (d => own%dphi(:, :own%n, p))
        place%gx(:own%n, p) = (jacobian(2, 2)*d(1, :) - jacobian(2, 1)*d(2, :))/detj
        place%gy(:own%n, p) = (jacobian(1, 1)*d(2, :) - jacobian(1, 2)*d(1, :))/detj
      end associate
      ! nobody asks for what goes with a motion that is none
      place%strain(p) = 0
      if (.not. moves) cycle
      place%nx(:, p) = nx
      place%ny(:, p) = ny
      place%swelling(1:8, p) = nx + section(2)*rule%phi(:, p)/thickness
      place%swelling(9:16, p) = ny + section(3)*rule%phi(:, p)/thickness
      if (finite) then
        place%strain(p) = log(detj*thickness/before)
      else
        place%strain(p) = dot_product(place%swelling(:, p), motion)
      end if
    end do
  end subroutine place_element

  !> Heat taken up in the step, per time: at the points, or lumped at the corners.
  pure subroutine add_content(instant, law, material, npoint, own, lumped, place, drivers, change, start, force, stiffness, stored)
    type(instant_t), intent(in) :: instant
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    logical, intent(in) :: lumped
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)              !! (ndriver, 2, npoint)
    real(wp), intent(in) :: change(:), start(:)           !! of the temperatures in the step, and they at its start (n)
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    real(wp), intent(inout) :: stored                     !! heat taken up [energy]
    real(wp) :: before(max(1, size(drivers, 1)), 9), now(max(1, size(drivers, 1)), 9), taken(9), capacity(9), volume
    integer :: p, j, n, m

    n = own%n
    m = merge(n, npoint, lumped)
    before = 0
    now = 0
    if (lumped) then
      before(driver_temperature, :n) = start
      now(driver_temperature, :n) = start + change
    else
      if (size(drivers, 1) > 1) then
        before(2:, :npoint) = drivers(2:, 1, :)
        now(2:, :npoint) = drivers(2:, 2, :)
      end if
      before(driver_temperature, :npoint) = matmul(start, own%phi(:n, :npoint))
      now(driver_temperature, :npoint) = matmul(start + change, own%phi(:n, :npoint))
    end if
    call law%store(material, before(:, :m), now(:, :m), taken(:m), capacity(:m))
    taken(:m) = taken(:m)/instant%dt
    capacity(:m) = capacity(:m)/instant%dt
    if (lumped) then
      do j = 1, n
        volume = dot_product(own%phi(j, :npoint), place%dv0(:npoint))
        force(j) = force(j) + volume*taken(j)
        stored = stored + volume*taken(j)*instant%dt
        if (instant%tangent) stiffness(j, j) = stiffness(j, j) + volume*capacity(j)
      end do
    else
      do p = 1, npoint
        force(:n) = force(:n) + own%phi(:n, p)*(taken(p)*place%dv0(p))
        stored = stored + taken(p)*place%dv0(p)*instant%dt
        if (.not. instant%tangent) cycle
        do j = 1, n
          stiffness(:n, j) = stiffness(:n, j) + own%phi(:n, p)*(capacity(p)*place%dv0(p)*own%phi(j, p))
        end do
      end do
    end if
  end subroutine add_content

  !> Square of an error of the heat content over the least heat capacity of the material, so that latent heat counts as heat; and of
  !> the temperatures themselves.
  pure subroutine add_error(law, material, npoint, own, lumped, place, drivers, change, now, report)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    logical, intent(in) :: lumped
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)        !! (ndriver, 2, npoint)
    real(wp), intent(in) :: change(:), now(:)       !! temperatures that the error belongs to, and present ones (n)
    type(report_t), intent(inout) :: report
    real(wp) :: given(max(1, size(drivers, 1)), 9), taken(9), capacity(9), error(9), volume(9), least
    integer :: n, m

    n = own%n
    m = merge(n, npoint, lumped)
    given = 0
    if (lumped) then
      given(driver_temperature, :n) = now
      error(:n) = change
      volume(:n) = matmul(own%phi(:n, :npoint), place%dv0(:npoint))
    else
      if (size(drivers, 1) > 1) given(2:, :npoint) = drivers(2:, 2, :)
      given(driver_temperature, :npoint) = matmul(now, own%phi(:n, :npoint))
      error(:npoint) = matmul(change, own%phi(:n, :npoint))
      volume(:npoint) = place%dv0(:npoint)
    end if
    call law%store(material, given(:, :m), given(:, :m), taken(:m), capacity(:m))
    report%temperature_square = report%temperature_square + sum(volume(:m)*error(:m)**2)
    least = least_capacity(law, material, given(:, 1))
    ! a smooth capacity holds no latent heat
    if (least > 0) error(:m) = error(:m)*capacity(:m)/least
    report%error_square = report%error_square + sum(volume(:m)*error(:m)**2)
    report%error_volume = report%error_volume + sum(volume(:m))
  end subroutine add_error

  !> The least heat capacity at the temperatures where it bends, or from one of them to the next; 0 where it bends nowhere.
  pure function least_capacity(law, material, drivers) result(least)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:)   !! (ndriver) that go with the temperature
    real(wp) :: least                    !! [energy/length^3/temperature]
    real(wp) :: given(size(drivers), 1), taken(1), capacity(1)
    real(wp), allocatable :: temperatures(:)
    integer :: k

    least = 0
    if (associated(law%bends)) then
      call law%bends(material, temperatures)
    else if (allocated(material%temperatures)) then
      allocate (temperatures, source=material%temperatures)
    else
      return
    end if
    given(:, 1) = drivers
    do k = 1, size(temperatures)
      given(driver_temperature, 1) = temperatures(k)
      call law%store(material, given, given, taken, capacity)
      if (capacity(1) > 0 .and. .not. (least > 0 .and. least < capacity(1))) least = capacity(1)
    end do
  end function least_capacity

  !> Heat that a change of volume takes up, less that released at the points, per time.
  pure subroutine add_released(instant, law, material, npoint, own, place, drivers, change, start, u, committed, trial, force, &
                               stiffness, by_end, report)
    type(instant_t), intent(in) :: instant
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)
    real(wp), intent(in) :: change(:), start(:)
    integer, intent(in) :: u                              !! local place of the first displacement, 0 where there is none
    real(wp), intent(in) :: committed(:, :)               !! (nstate, npoint)
    real(wp), intent(inout) :: trial(:, :)
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    real(wp), intent(out) :: by_end(:, :)                 !! (nstate, npoint) d(state)/d(temperature at the end)
    type(report_t), intent(inout) :: report
    real(wp) :: given(max(1, size(drivers, 1)), 2), released, of_work, slope, surplus, per_strain, share, heat(own%n), counted
    integer :: p, j, n

    n = own%n
    heat = 0
    counted = 0
    by_end = 0
    do p = 1, npoint
      share = place%dv0(p)/instant%dt
      per_strain = law%swell(material, dot_product(own%phi(:n, p), start))
      heat = heat + own%phi(:n, p)*(per_strain*share*place%strain(p))
      if (instant%tangent .and. u > 0) then
        do j = 1, 16
          stiffness(:n, u + j - 1) = stiffness(:n, u + j - 1) + own%phi(:n, p)*(per_strain*share*place%swelling(j, p))
        end do
      end if
      if (.not. associated(law%release) .or. size(committed, 1) == 0) cycle
      given = 0
      if (size(drivers, 1) > 0) given = drivers(:, :, p)
      given(driver_temperature, :) = [dot_product(own%phi(:n, p), start), dot_product(own%phi(:n, p), start + change)]
      ! what happens at a point takes the time since the start of the step
      call law%release(material, instant%dt/instant%share, given, committed(:, p), released, of_work, slope, trial(:, p), &
                       surplus, by_end(:, p))
      heat = heat - own%phi(:n, p)*(released*share + of_work*(place%worked(p)/instant%dt))
      counted = counted + surplus*place%dv0(p)
      if (.not. instant%tangent .or. .not. abs(slope) > 0) cycle
      do j = 1, n
        stiffness(:n, j) = stiffness(:n, j) - own%phi(:n, p)*(slope*share*own%phi(j, p))
      end do
    end do
    force(:n) = force(:n) + heat
    report%source = report%source + sum(heat**2)
    report%heat_stored = report%heat_stored - counted
    report%heat_released = report%heat_released - sum(heat)*instant%dt - counted
  end subroutine add_released

  !> Heat that the operation before has left, in this step.
  pure subroutine add_due(instant, npoint, own, place, due, force, report)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: due(:)              !! (npoint) per volume at the start of the scene [energy/length^3]
    real(wp), intent(inout) :: force(:)         !! [power]
    type(report_t), intent(inout) :: report
    real(wp) :: heat(own%n)

    if (.not. any(abs(due) > 0)) return
    heat = matmul(own%phi(:own%n, :npoint), due*place%dv0(:npoint))
    force(:own%n) = force(:own%n) - heat/instant%dt
    report%source = report%source + sum((heat/instant%dt)**2)
    report%heat_released = report%heat_released + sum(heat)
  end subroutine add_due

  !> Heat conducted at one of the instants of the flow rule.
  pure subroutine add_flow(instant, k, law, material, finite, npoint, own, place, drivers, by_end, change, start, u, &
                           force, stiffness)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: k
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical, intent(in) :: finite
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :), change(:), start(:)
    real(wp), intent(in) :: by_end(:, :)   !! (ndriver, npoint) d(drivers at the end)/d(temperature there)
    integer, intent(in) :: u
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    real(wp) :: t(size(start)), given(max(1, size(drivers, 1)), npoint), lambda(npoint), by_temperature(npoint), slope(2), dv
    real(wp) :: by_driver(max(1, size(drivers, 1)), npoint)
    integer :: p, j, i, n

    n = own%n
    associate (share => instant%flow%share(k), weight => instant%flow%weight(k))
      t = start + share*change
      given = 0
      if (size(drivers, 1) > 1) given(2:, :) = (1 - share)*drivers(2:, 1, :) + share*drivers(2:, 2, :)
      given(driver_temperature, :) = matmul(t, own%phi(:n, :npoint))
      if (instant%tangent .and. any(abs(by_end) > 0)) then
        call law%conduct(material, given, lambda, by_temperature, by_driver)
        by_temperature = by_temperature + sum(by_driver*by_end, 1)
      else
        call law%conduct(material, given, lambda, by_temperature)
      end if
      do p = 1, npoint
        dv = weight*place%dv(p)
        associate (gx => place%gx(:n, p), gy => place%gy(:n, p), nx => place%nx(:, p), ny => place%ny(:, p))
          slope = lambda(p)*[dot_product(gx, t), dot_product(gy, t)]
          force(:n) = force(:n) + dv*(gx*slope(1) + gy*slope(2))
          if (.not. instant%tangent) cycle
          do j = 1, n
            stiffness(:n, j) = stiffness(:n, j) + (share*dv*lambda(p))*(gx*gx(j) + gy*gy(j))
            if (abs(by_temperature(p)) > 0) stiffness(:n, j) = stiffness(:n, j) &
                                            + (share*dv*by_temperature(p)/lambda(p)*own%phi(j, p))*(gx*slope(1) + gy*slope(2))
          end do
          if (u == 0 .or. .not. finite) cycle
          do j = 1, 16
            stiffness(:n, u + j - 1) = stiffness(:n, u + j - 1) + dv*place%swelling(j, p)*(gx*slope(1) + gy*slope(2))
          end do
          ! gradients turn and stretch with the geometry: d(grad phi) = - grad(du)^T grad phi
          do j = 1, 8
            i = u + j - 1
            associate (along => nx(j)*slope(1) + ny(j)*slope(2), cross => gx*nx(j) + gy*ny(j))
              stiffness(:n, i) = stiffness(:n, i) - dv*(gx*along + cross*slope(1))
              stiffness(:n, i + 8) = stiffness(:n, i + 8) - dv*(gy*along + cross*slope(2))
            end associate
          end do
        end associate
      end do
      if (instant%monotone) call limit_flow(instant%tangent, share, weight*place%dv(:npoint)*lambda, &
                                            weight*place%dv(:npoint)*by_temperature, own, place, t, force, stiffness)
    end associate
  end subroutine add_flow

  !> Take out what flows between two nodes from the colder to the warmer one, as in elements far from rectangles: positive entries
  !> beside the diagonal of the matrix of conduction. The rest is a matrix of which no temperature leaves those around it, by lumped
  !> capacity and implicit Euler; what one node loses the other still gains. Source: D. Kuzmin, M.J. Shashkov, D. Svyatskiy,
  !> J. Comput. Phys. 228 (2009) 3448-3463.
  pure subroutine limit_flow(tangent, share, conduction, by_temperature, own, place, t, force, stiffness)
    logical, intent(in) :: tangent
    real(wp), intent(in) :: share               !! of the step after which the flow is [-]
    real(wp), intent(in) :: conduction(:)       !! (npoint) conductivity times volume [power*length/temperature]
    real(wp), intent(in) :: by_temperature(:)   !! (npoint) its derivative
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: t(:)                !! (n) temperatures [temperature]
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    real(wp) :: product(size(conduction)), entry, slope
    integer :: i, j, k, m

    m = size(conduction)
    do i = 1, own%n
      do j = i + 1, own%n
        product = place%gx(i, :m)*place%gx(j, :m) + place%gy(i, :m)*place%gy(j, :m)
        entry = dot_product(conduction, product)
        if (.not. entry > 0) cycle
        force([i, j]) = force([i, j]) - entry*[t(j) - t(i), t(i) - t(j)]
        if (.not. tangent) cycle
        stiffness([i, j], i) = stiffness([i, j], i) + share*entry*[1, -1]
        stiffness([i, j], j) = stiffness([i, j], j) + share*entry*[-1, 1]
        do k = 1, own%n
          slope = share*sum(by_temperature*own%phi(k, :m)*product)
          stiffness([i, j], k) = stiffness([i, j], k) - slope*[t(j) - t(i), t(i) - t(j)]
        end do
      end do
    end do
  end subroutine limit_flow

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
