!> The discrete equations of a scene: unknowns, pattern, element loop, linear solver.
module equations
  use axis_wall, only: axis_wall_t, find_axis_wall, press_on_axis
  use dies, only: is_deformable, place_on_nodes
  use dofs, only: dofs_t, number_dofs, number_pairs
  use elem_api, only: block_done, elem_t, first_unknown, flow_rule_t, instant_t, mode_advance, mode_error, report_t
  use elem_heat_contact, only: name_of_piece
  use elem_registry, only: list_elems
  use elem_weld_source, only: source_factors
  use element_loop, only: element_buffers_t, gather_forces, gather_matrix, run_elements
  use errors, only: error_t, exit_no_convergence
  use fields, only: displacement_field, field_t, find_field, mechanical_fields, on_nodes, pilot_field, section_field
  use kinds, only: eps, wp
  use kinematics_api, only: kinematics_t
  use kinematics_registry, only: list_kinematics
  use law_api, only: has_symmetric_tangent, law_t, solid_law
  use law_registry, only: list_laws
  use linear_solver, only: analyse, choose_solver, factorise, solve_linear
  use loads, only: multiplier_at
  use ordering, only: order_equations
  use own_crossings, only: free_sides_t, list_free_sides
  use pairs, only: pairs_differ, pairs_t, start_pairs
  use point_drivers, only: drivers_t, find_drivers, is_scalar, nodal_values
  use resting_bodies, only: find_loose_bodies, hold_loose, hold_resting, motion_of_loose
  use scene, only: is_solid, role_body, role_load_factor, role_second, role_side_load, role_spring, role_volume_load, scene_t
  use sections, only: section_forced
  use solution, only: present_coordinates, solution_t
  use solves, only: list_solves, number_equations, quantities_of, set_up_pattern, solve_t
  use state_variables, only: find_variable
  use strategy, only: strategy_t
  use threads, only: fit_to_load, team_t
  use timers, only: ledger_t
  use vectors, only: length_of
  implicit none
  private
  public :: remedy_none, remedy_euler, remedy_monotone
  public :: equations_t, stage_t, set_up, evaluate, make_instant, measure_error, solve_correction, external_forces, take_turn

  !> How a step is made again that has left its bounds (heat_stages): by implicit Euler, and with flows that keep to them (PL8TM).
  integer, parameter :: remedy_none = 0, remedy_euler = 1, remedy_monotone = 2

  !> A stage of a step that is made in several.
  type :: stage_t
    !> Length by which changes of the heat content are divided, over that of the stage; and share of the step after which the
    !> stage ends.
    real(wp) :: share = 1.0_wp, reach = 1.0_wp
    !> Heat taken up and released counts; otherwise flows alone.
    logical :: content = .true.
  end type stage_t

  type :: equations_t
    type(elem_t), allocatable :: elems(:)
    type(law_t), allocatable :: laws(:)
    type(kinematics_t) :: kinematics
    type(dofs_t) :: dofs
    !> The solves in the order of a step, and the present one.
    type(solve_t), allocatable :: solves(:)
    integer :: now = 1
    !> Mode of the elements (elem_api).
    integer :: mode = mode_advance
    type(stage_t) :: stage
    integer :: remedy = remedy_none
    type(element_buffers_t) :: buffers
    !> Sides that must not cross the axis, and what holds them.
    type(axis_wall_t) :: wall
    !> Sides of bodies that may pass through one another.
    type(free_sides_t) :: free_sides
    !> Bodies of nodes that supports do not hold, of no size where there is none (resting_bodies).
    integer, allocatable :: loose(:)
    !> Unknowns at rest in the present step (ndof); of no size where no body is loose.
    logical, allocatable :: resting(:)
    type(ledger_t) :: timers
    type(team_t) :: team
    !> Internal force (element forces summed) at the last evaluation, and the sum of their sizes (ndof).
    real(wp), allocatable :: force(:), magnitude(:)
    !> Norm of the sources within elements at the last evaluation (elem_api) [power].
    real(wp) :: source = 0.0_wp
    !> Heat taken up by all elements in the step, and released in them, at the last evaluation of their solve [energy].
    real(wp) :: heat_stored = 0.0_wp, heat_released = 0.0_wp
    !> Weights of the quantities in norms over several of them (convergence).
    real(wp), allocatable :: weight(:)
    !> Nodes of the solid elements, and the pairs that unknowns and pattern are of.
    integer, allocatable :: solids(:, :)
    type(pairs_t), allocatable :: pairs(:)
    !> Nodes coupled by the pairs: a side and a piece, two nodes twice to make eight.
    integer, allocatable :: links(:, :)
    !> Nodes of the mesh.
    integer :: nnode = 0
    !> Groups that are loads: their forces come from outside.
    logical, allocatable :: is_load(:)
    !> Drivers of the laws at the points of the groups.
    type(drivers_t), allocatable :: drivers(:)
    !> Diagonal of the box around the mesh [length].
    real(wp) :: size = 0.0_wp
  end type equations_t

  !> Motions below this share of the mesh's size are round-off of coordinates: some eps.
  real(wp), parameter :: round_off_motion = 16*eps
  !> A body that nothing holds may be carried off where a correction is above this share of the size of the scene.
  real(wp), parameter :: carried_off = 0.1_wp

contains

  !> Number the unknowns, build and order the pattern, analyse it: once per mesh, and again for new pairs.
  subroutine set_up(scene, equations, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(error_t), allocatable, intent(out) :: error
    type(kinematics_t), allocatable :: rows(:)
    integer :: g, s, timer

    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    call list_elems(equations%elems)
    call list_laws(equations%laws)
    call list_kinematics(rows)
    equations%kinematics = rows(scene%kinematics_id)
    call number_dofs(scene, equations%elems, equations%dofs)
    call find_axis_wall(scene, equations%laws, equations%dofs, equations%wall)
    call list_free_sides(scene, equations%free_sides)
    call find_loose_bodies(scene, equations%dofs, equations%loose)
    allocate (equations%resting(0))
    call list_solves(scene%fields, scene%strategy%coupling, equations%solves)
    do s = 1, size(equations%solves)
      call choose_solver(equations%solves(s)%solver, scene%strategy%linear_solver)
      call number_equations(equations%dofs, equations%solves(s))
      call set_up_pattern(equations%dofs, is_symmetric(scene, equations, s), equations%solves(s))
    end do
    allocate (equations%force(equations%dofs%ndof), equations%magnitude(equations%dofs%ndof), source=0.0_wp)
    allocate (equations%weight(size(equations%dofs%quantities)), source=1.0_wp)
    call start_pairs(scene, equations%pairs)
    associate (pattern => equations%solves(1)%pattern)
      ! on a new mesh the books ask for the forces of loads before all of them are computed
      allocate (equations%buffers%force(pattern%force_length), source=0.0_wp)
      allocate (equations%buffers%matrix(pattern%matrix_length))
    end associate
    equations%nnode = size(scene%mesh%coordinates, 2)
    equations%size = length_of(maxval(scene%mesh%coordinates, 2) - minval(scene%mesh%coordinates, 2))

    call find_drivers(scene, equations%laws, equations%drivers)
    allocate (equations%is_load(size(scene%groups)))
    do g = 1, size(scene%groups)
      equations%is_load(g) = any(scene%groups(g)%role == [role_side_load, role_volume_load, role_spring, role_load_factor])
    end do

    allocate (equations%solids(8, 0), equations%links(8, 0))
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      equations%solids = reshape([equations%solids, scene%groups(g)%connectivity], &
                                 [8, size(equations%solids, 2) + size(scene%groups(g)%connectivity, 2)])
    end do
    call equations%timers%stop(timer)
    do s = 1, size(equations%solves)
      equations%now = s
      call analyse_pattern(equations, error)
      if (allocated(error)) return
    end do
    equations%now = 1
  end subroutine set_up

  !> The solve that a field belongs to is the present one.
  pure subroutine take_turn(equations, field)
    type(equations_t), intent(inout) :: equations
    integer, intent(in) :: field   !! position in the scene's list
    integer :: s

    do s = 1, size(equations%solves)
      if (equations%solves(s)%own(field)) equations%now = s
    end do
  end subroutine take_turn

  !> Order the equations of the present solve and let its solver analyse the pattern.
  subroutine analyse_pattern(equations, error)
    type(equations_t), intent(inout) :: equations
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: position(:)
    integer :: timer

    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    associate (solve => equations%solves(equations%now))
      if (solve%neq > 0) call order_equations(reshape([equations%solids, equations%links], &
                                                      [8, size(equations%solids, 2) + size(equations%links, 2)]), &
                                              equations%nnode, equations%dofs, solve%equation, position, error)
      if (.not. allocated(error) .and. solve%neq > 0) call analyse(solve%solver, solve%pattern, position, error)
      solve%analysed = .true.
    end associate
    call equations%timers%stop(timer)
  end subroutine analyse_pattern

  !> Sides and pieces of the pairs, for the graph that is ordered.
  pure subroutine list_links(scene, equations)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    integer, allocatable :: links(:, :)
    integer :: g, e, k, n

    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs > 0 .and. scene%groups(g)%host == 0) n = n + size(equations%dofs%groups(g)%nodes)/3
    end do
    allocate (links(8, n))
    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. scene%groups(g)%host > 0) cycle
      associate (nodes => equations%dofs%groups(g)%nodes)
        do e = 1, size(nodes, 2)
          do k = 3, size(nodes, 1) - 3, 3
            if (nodes(k + 1, e) == nodes(1, e)) cycle
            n = n + 1
            links(:, n) = nodes([1, 2, 3, k + 1, k + 2, k + 3, 1, k + 1], e)
          end do
        end do
      end associate
    end do
    equations%links = links(:, :n)
  end subroutine list_links

  !> Unknowns and pattern for other pairs; the solver analyses them before the next factorisation.
  subroutine pair_up(scene, pairs, equations)
    type(scene_t), intent(in) :: scene
    type(pairs_t), intent(in) :: pairs(:)
    type(equations_t), intent(inout) :: equations
    integer :: s, timer

    if (.not. pairs_differ(scene, pairs, equations%pairs)) return
    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    equations%pairs = pairs
    call number_pairs(scene, equations%elems, pairs, equations%dofs)
    do s = 1, size(equations%solves)
      call set_up_pattern(equations%dofs, is_symmetric(scene, equations, s), equations%solves(s))
    end do
    associate (pattern => equations%solves(1)%pattern)
      if (size(equations%buffers%force) /= pattern%force_length) deallocate (equations%buffers%force)
      if (size(equations%buffers%matrix) /= pattern%matrix_length) deallocate (equations%buffers%matrix)
      if (.not. allocated(equations%buffers%force)) allocate (equations%buffers%force(pattern%force_length), source=0.0_wp)
      if (.not. allocated(equations%buffers%matrix)) allocate (equations%buffers%matrix(pattern%matrix_length), source=0.0_wp)
    end associate
    call list_links(scene, equations)
    call equations%timers%stop(timer)
  end subroutine pair_up

  !> Pairs around the closest points just found; points without one keep theirs.
  pure subroutine renew_pairs(scene, active, solution)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: active(:)   !! (ngroup) groups that were just computed
    type(solution_t), intent(inout) :: solution
    integer :: g, at

    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. .not. active(g)) cycle
      at = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, name_of_piece))%first
      associate (middle => solution%pairs(scene%groups(g)%pairs)%piece, found => nint(solution%groups(g)%trial(at, :, :)))
        where (found > 0) middle = found
      end associate
    end do
  end subroutine renew_pairs

  !> All that acts in a solve is symmetric.
  pure function is_symmetric(scene, equations, s) result(symmetric)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: s   !! number of the solve
    logical :: symmetric
    integer :: g

    ! the coupling of two quantities is not symmetric
    symmetric = quantities_of(equations%dofs, equations%solves(s)) < 2
    do g = 1, size(scene%groups)
      associate (row => equations%elems(scene%groups(g)%elem_id), m => scene%groups(g)%material)
        if (.not. equations%solves(s)%active(g)) cycle
        ! radiation depends on two temperatures, on each in its way
        symmetric = symmetric .and. .not. scene%groups(g)%heat_contact%radiation > 0
        symmetric = symmetric .and. (row%symmetric .or. .not. (row%follows .or. scene%finite))
        symmetric = symmetric .and. .not. (scene%finite .and. scene%groups(g)%option == row%unsymmetric_option)
        if (m == 0) cycle
        associate (law => equations%laws(scene%materials(m)%law_id))
          symmetric = symmetric .and. has_symmetric_tangent(law, scene%materials(m))
        end associate
        if (row%law_kind == solid_law) symmetric = symmetric .and. equations%kinematics%symmetric
      end associate
    end do
  end function is_symmetric

  !> The instant at the end of a step.
  subroutine make_instant(scene, equations, solution, dt, du, tangent, instant)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt       !! [time]
    real(wp), intent(in) :: du(:)    !! (ndof) motion of the step [unknown]
    logical, intent(in) :: tangent   !! matrices are wanted
    type(instant_t), intent(out) :: instant
    real(wp), allocatable :: coordinates(:, :)
    integer :: k, c

    instant%time = solution%time + dt
    instant%dt = equations%stage%share*dt
    instant%share = equations%stage%share
    instant%content = equations%stage%content
    instant%reach = equations%stage%reach
    instant%tangent = tangent
    instant%mode = equations%mode
    instant%solved = equations%solves(equations%now)%own
    instant%pilots = solution%fields(pilot_field)%value
    instant%section = solution%fields(section_field)%value(:, 1)
    allocate (instant%multipliers(size(scene%multipliers)), instant%multipliers_before(size(scene%multipliers)))
    do k = 1, size(scene%multipliers)
      instant%multipliers_before(k) = multiplier_at(scene%multipliers(k), solution%time)
      instant%multipliers(k) = multiplier_at(scene%multipliers(k), instant%time)
    end do
    if (scene%load_factor%multiplier > 0) call set_load_factor(scene, equations%dofs, solution%fields, du, instant)
    if (equations%remedy == remedy_none) call set_flow_rule(scene%strategy, instant%flow)
    instant%monotone = equations%remedy == remedy_monotone
    allocate (instant%flow%multipliers(size(scene%multipliers), instant%flow%n))
    do c = 1, instant%flow%n
      do k = 1, size(scene%multipliers)
        instant%flow%multipliers(k, c) = multiplier_at(scene%multipliers(k), solution%time + instant%flow%share(c)*dt)
      end do
    end do
    if (any(scene%groups%source > 0)) call set_sources(scene, solution, dt, instant)
    if (size(solution%fields) > size(mechanical_fields())) call list_values(equations%dofs, solution%fields, instant%values)
    if (size(solution%pairs) == 0) return
    coordinates = present_coordinates(scene, solution)
    associate (number => equations%dofs%fields(displacement_field)%number)
      do k = 1, size(coordinates, 2)
        do c = 1, 2
          if (number(c, k) > 0) coordinates(c, k) = coordinates(c, k) + du(number(c, k))
        end do
      end do
    end associate
    allocate (instant%dies, source=scene%dies)
    do k = 1, size(instant%dies)
      if (is_deformable(instant%dies(k))) call place_on_nodes(coordinates, instant%dies(k))
    end do
  end subroutine make_instant

  !> The multiplier that is an unknown.
  pure subroutine set_load_factor(scene, dofs, fields, du, instant)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(field_t), intent(in) :: fields(:)   !! (nfield)
    real(wp), intent(in) :: du(:)            !! (ndof) [unknown]
    type(instant_t), intent(inout) :: instant
    integer :: f

    f = find_field(fields, 'load_factor')
    associate (k => scene%load_factor%multiplier)
      instant%multipliers_before(k) = fields(f)%value(1, 1)
      instant%multipliers(k) = fields(f)%value(1, 1) + du(dofs%fields(f)%number(1, 1))
    end associate
  end subroutine set_load_factor

  !> Factors of the sources of torches at the instants at which heat flows, on the places of the start of the step.
  subroutine set_sources(scene, solution, dt, instant)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(instant_t), intent(inout) :: instant
    real(wp) :: coordinates(2, size(scene%mesh%coordinates, 2)), section(3)
    integer :: k

    coordinates = scene%mesh%coordinates
    section = scene%section
    if (scene%finite) then
      coordinates = present_coordinates(scene, solution)
      section = instant%section
    end if
    instant%flow%times = solution%time + instant%flow%share(:instant%flow%n)*dt
    allocate (instant%flow%source_factors(size(scene%sources), instant%flow%n))
    do k = 1, instant%flow%n
      call source_factors(scene, section, coordinates, instant%flow%times(k), instant%flow%source_factors(:, k))
    end do
  end subroutine set_sources

  !> The displacements and the motion of the section from which a correction began, where geometry follows the displacements.
  pure subroutine note_correction(scene, dofs, motion, instant)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: motion(:)
    type(instant_t), intent(inout) :: instant
    integer :: k, c

    if (.not. scene%finite) return
    associate (number => dofs%fields(displacement_field)%number)
      allocate (instant%corrected_from(2, size(number, 2)), source=0.0_wp)
      do k = 1, size(number, 2)
        do c = 1, 2
          if (number(c, k) > 0) instant%corrected_from(c, k) = motion(number(c, k))
        end do
      end do
    end associate
    associate (number => dofs%fields(section_field)%number)
      do c = 1, size(number, 1)
        if (size(number, 2) == 0) exit
        if (number(c, 1) > 0) instant%section_from(c) = motion(number(c, 1))
      end do
    end associate
  end subroutine note_correction

  !> Instants at which heat flows in a step: the end, a share theta of it, or start and end with a weight each.
  pure subroutine set_flow_rule(strategy, rule)
    type(strategy_t), intent(in) :: strategy
    type(flow_rule_t), intent(out) :: rule

    if (strategy%theta_mean .and. strategy%theta < 1) then
      rule%n = 2
      rule%weight = [1 - strategy%theta, strategy%theta]
      rule%share = [0.0_wp, 1.0_wp]
    else
      rule%share(1) = strategy%theta
    end if
  end subroutine set_flow_rule

  !> Values of all unknowns (ndof).
  pure subroutine list_values(dofs, fields, values)
    type(dofs_t), intent(in) :: dofs
    type(field_t), intent(in) :: fields(:)
    real(wp), allocatable, intent(out) :: values(:)
    integer :: f, k, c

    allocate (values(dofs%ndof), source=0.0_wp)
    do f = 1, size(fields)
      do k = 1, size(fields(f)%value, 2)
        do c = 1, fields(f)%ncomp
          if (dofs%fields(f)%number(c, k) > 0) values(dofs%fields(f)%number(c, k)) = fields(f)%value(c, k)
        end do
      end do
    end do
  end subroutine list_values

  !> Internal force, and matrices when wanted, at the motion `du` of the step. Points that meet pieces of deformable dies
  !> beyond their pairs get new ones, and all is computed again: no contact is lost, no step cut.
  subroutine evaluate(scene, equations, solution, dt, du, tangent, report, predicted, corrected_from)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    logical, intent(in) :: tangent
    type(report_t), intent(out) :: report
    logical, intent(in), optional :: predicted              !! the motion is a prediction
    real(wp), intent(in), optional :: corrected_from(:)     !! (ndof) motion before the correction that led to it [unknown]
    type(instant_t) :: instant
    real(wp), allocatable :: now(:, :)
    integer :: timer

    call fit_to_load(equations%team)
    call make_instant(scene, equations, solution, dt, du, tangent, instant)
    if (present(predicted)) instant%predicted = predicted
    if (present(corrected_from)) call note_correction(scene, equations%dofs, corrected_from, instant)
    call driving_values(scene, equations, solution, du, now)
    do
      call pair_up(scene, solution%pairs, equations)
      instant%pairs = solution%pairs
      call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, &
                        equations%solves(equations%now)%active, equations%solves(equations%now)%pattern, instant, du, now, &
                        solution, equations%drivers, equations%buffers, equations%timers, report)
      if (report%status /= block_done) return
      if (.not. report%unpaired) exit
      call renew_pairs(scene, equations%solves(equations%now)%active, solution)
    end do
    equations%source = sqrt(report%source)
    if (solves_heat(scene, equations)) then
      equations%heat_stored = report%heat_stored
      equations%heat_released = report%heat_released
    end if
    call equations%timers%add('assembly', timer)
    call equations%timers%start(timer)
    associate (solve => equations%solves(equations%now))
      ! round-off is that of the bodies alone
      if (tangent) call set_floors(scene, equations, solution%fields)
      if (solve%own(displacement_field)) &
        call press_on_axis(scene, equations%dofs, solve%pattern, solve%active, solution%fields(displacement_field)%value, du, &
                           tangent, equations%wall, equations%buffers%force, equations%buffers%matrix, report)
      call gather_forces(solve%pattern, equations%buffers, solve%is_own, equations%force, equations%magnitude)
      if (tangent) then
        call gather_matrix(solve%pattern, equations%buffers, solve%values)
        call hold_resting(scene, equations%dofs, solution, equations%loose, solve%pattern, solve%equation, equations%resting, &
                          solve%values)
      end if
    end associate
    call equations%timers%stop(timer)
  end subroutine evaluate

  !> An error of the heat content at the end of a step, in the mean square of the volume of the bodies, over the least heat capacity
  !> of each. It is given by the temperatures that it belongs to.
  subroutine measure_error(scene, equations, solution, du, temperatures, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: du(:)             !! (ndof) motion of the step [unknown]
    real(wp), intent(in) :: temperatures(:)   !! (ndof) the error [unknown]
    real(wp), intent(out) :: error            !! [temperature]
    type(instant_t) :: instant
    type(report_t) :: report
    real(wp), allocatable :: now(:, :)

    call make_instant(scene, equations, solution, 0.0_wp, du, .false., instant)
    instant%mode = mode_error
    instant%values = instant%values + du
    call driving_values(scene, equations, solution, du, now)
    call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, &
                      equations%solves(equations%now)%active, equations%solves(equations%now)%pattern, instant, temperatures, now, &
                      solution, equations%drivers, equations%buffers, equations%timers, report)
    error = 0
    if (report%error_volume > 0) error = sqrt(report%error_square/report%error_volume)
  end subroutine measure_error

  !> The temperature is among the fields of the solve under way.
  pure function solves_heat(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes
    integer :: f

    f = find_field(scene%fields, 'temperature')
    yes = f > 0
    if (yes) yes = equations%solves(equations%now)%own(f)
  end function solves_heat

  !> Trial values of the fields that drive points at the end of the step (nnode, nfield); none where no point is driven by any.
  subroutine driving_values(scene, equations, solution, du, now)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)      !! change of the unknowns in the step (ndof)
    real(wp), allocatable, intent(out) :: now(:, :)
    integer :: f, k

    if (.not. any(equations%drivers%vary)) then
      allocate (now(0, 0))
      return
    end if
    allocate (now(size(scene%mesh%coordinates, 2), size(scene%fields)))
    call nodal_values(scene, solution, now)
    do f = 1, size(scene%fields)
      if (.not. is_scalar(scene%fields(f))) cycle
      associate (number => equations%dofs%fields(f)%number(1, :))
        do k = 1, size(now, 1)
          if (number(k) > 0) now(k, f) = now(k, f) + du(number(k))
        end do
      end associate
    end do
  end subroutine driving_values

  !> Size of round-off in what acts on the own fields: what a change of round-off makes through the diagonals of the matrices of
  !> the bodies, of temperatures those of what passes their sides too. For motions once for a mesh; others have values, and
  !> matrices with the length of the step, that change.
  pure subroutine set_floors(scene, equations, fields)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(field_t), intent(inout) :: fields(:)
    integer :: f

    do f = 1, size(fields)
      if (.not. (fields(f)%declared .and. equations%solves(equations%now)%own(f))) cycle
      if (fields(f)%name == 'load_factor') fields(f)%floor = round_off_motion*equations%size*sqrt(sum_of_rows(scene, equations, f))
      if (fields(f)%place /= on_nodes) cycle
      if (f == displacement_field) then
        if (fields(f)%floor > 0) cycle
        fields(f)%floor = round_off_motion*equations%size*sqrt(sum_of_diagonals(scene, equations, f))
      else
        fields(f)%floor = round_off_motion*maxval(abs(fields(f)%value))*sqrt(sum_of_diagonals(scene, equations, f))
      end if
    end do
  end subroutine set_floors

  !> Squares of the rows of a field that has one unknown in all, along the unknowns of other fields.
  pure function sum_of_rows(scene, equations, field) result(sum)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field
    real(wp) :: sum
    integer :: g, e, i, j, n, m

    sum = 0
    do g = 1, size(scene%groups)
      i = first_unknown(equations%dofs%groups(g)%layout, field)
      if (i == 0) cycle
      n = equations%dofs%groups(g)%layout%ndof
      do e = 1, size(equations%dofs%groups(g)%dof, 2)
        m = equations%solves(1)%pattern%matrix_start(g) + (e - 1)*n*n
        do j = 1, n
          if (j /= i) sum = sum + equations%buffers%matrix(m + (j - 1)*n + i)**2
        end do
      end do
    end do
  end function sum_of_rows

  !> Squares of the diagonals of the matrices of all bodies, and of loads where they are no forces, of the unknowns of one field.
  pure function sum_of_diagonals(scene, equations, field) result(sum)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field
    real(wp) :: sum
    integer :: g, e, u, c, i, ndof, m

    sum = 0
    do g = 1, size(scene%groups)
      if (.not. equations%solves(equations%now)%active(g)) cycle
      if (.not. (any(scene%groups(g)%role == [role_body, role_second]) .or. field /= displacement_field)) cycle
      associate (layout => equations%dofs%groups(g)%layout)
        ndof = layout%ndof
        do e = 1, size(equations%dofs%groups(g)%dof, 2)
          m = equations%solves(1)%pattern%matrix_start(g) + (e - 1)*ndof*ndof
          do u = 1, layout%nfield
            if (layout%field(u) /= field) cycle
            do c = 1, size(equations%dofs%fields(field)%number, 1)
              do i = layout%first(c, u), layout%first(c, u) + layout%count(u) - 1
                sum = sum + equations%buffers%matrix(m + (i - 1)*ndof + i)**2
              end do
            end do
          end do
        end do
      end associate
    end do
  end function sum_of_diagonals

  !> Forces on nodes and pilots, and loads of the section, at a time.
  pure subroutine external_forces(scene, dofs, time, force)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: time
    real(wp), intent(out) :: force(:)   !! (ndof) [residual]
    integer :: k, d

    force = 0
    do k = 1, size(scene%forces)
      associate (load => scene%forces(k))
        ! those over a multiplier that is found are elements (LOADF)
        if (load%multiplier == scene%load_factor%multiplier) cycle
        d = dofs%fields(load%field)%number(load%component, load%node)
        force(d) = force(d) + load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
      end associate
    end do
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        d = dofs%fields(pilot_field)%number(load%component, load%die)
        if (d == 0 .or. load%multiplier == 0) cycle
        force(d) = load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
      end associate
    end do
    do k = 1, 3
      d = dofs%fields(section_field)%number(k, 1)
      if (d == 0) cycle
      associate (drive => scene%section_drives(k))
        if (drive%kind /= section_forced .or. drive%multiplier == 0) cycle
        force(d) = drive%amplitude*multiplier_at(scene%multipliers(drive%multiplier), time)
      end associate
    end do
  end subroutine external_forces

  !> Correction of the free unknowns for a residual; prescribed ones are not touched.
  subroutine solve_correction(equations, residual, correction, error, at_hand)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: residual(:)      !! (ndof) [residual]
    real(wp), intent(out) :: correction(:)   !! (ndof) [unknown]
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: at_hand   !! by the factors of the last matrix of the solve that was solved with
    logical :: factors
    real(wp) :: rhs(equations%solves(equations%now)%neq), x(equations%solves(equations%now)%neq)
    integer :: d, timer

    correction = 0
    if (size(rhs) == 0) return
    if (.not. equations%solves(equations%now)%analysed) call analyse_pattern(equations, error)
    if (allocated(error)) return
    associate (solve => equations%solves(equations%now))
      do d = 1, equations%dofs%ndof
        if (solve%equation(d) > 0) rhs(solve%equation(d)) = residual(d)
      end do
      factors = .false.
      if (present(at_hand)) factors = at_hand
      if (.not. factors) then
        call equations%timers%add('factorisation', timer)
        call equations%timers%start(timer)
        call factorise(solve%solver, solve%values, error)
        call equations%timers%stop(timer)
      end if
      if (allocated(error)) return
      call equations%timers%add('solution', timer)
      call equations%timers%start(timer)
      call solve_linear(solve%solver, solve%pattern, rhs, x, error)
      if (size(equations%loose) > 0 .and. solve%own(displacement_field)) call solve_held(solve, rhs, x, error)
      call equations%timers%stop(timer)
      do d = 1, equations%dofs%ndof
        if (solve%equation(d) > 0) correction(d) = x(solve%equation(d))
      end do
    end associate

  contains

    !> Bodies that nothing holds have been carried off, or cannot be found: by a matrix that holds them.
    subroutine solve_held(solve, rhs, x, error)
      type(solve_t), intent(inout) :: solve
      real(wp), intent(in) :: rhs(:)
      real(wp), intent(inout) :: x(:)
      type(error_t), allocatable, intent(inout) :: error

      if (allocated(error)) then
        if (error%code /= exit_no_convergence) return
        deallocate (error)
      else if (motion_of_loose(equations%dofs, equations%loose, solve%equation, x) <= carried_off*equations%size) then
        return
      end if
      call hold_loose(equations%dofs, equations%loose, solve%pattern, solve%equation, solve%values)
      call factorise(solve%solver, solve%values, error)
      if (.not. allocated(error)) call solve_linear(solve%solver, solve%pattern, rhs, x, error)
    end subroutine solve_held
  end subroutine solve_correction

end module equations
