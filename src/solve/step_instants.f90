!> What elements are told of the instant at which they are evaluated: time, multipliers, dies, values of the fields, and the
!> instants at which heat flows.
module step_instants
  use dies, only: is_deformable, place_edges, place_on_nodes
  use dofs, only: dofs_t
  use driver_values, only: nodal_values
  use drivers, only: is_scalar
  use elem_api, only: flow_rule_t, instant_t
  use elem_weld_source, only: source_factors
  use equations, only: equations_t, remedy_monotone, remedy_none
  use fields, only: displacement_field, field_t, find_field, mechanical_fields, pilot_field, section_field
  use kinds, only: wp
  use loads, only: multiplier_at
  use multiplier_means, only: mean_of_multiplier
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  use strategy, only: strategy_t
  use torch_steps, only: torch_powers, torch_step, torch_step_t
  implicit none
  private
  public :: make_instant, note_correction, driving_values

contains

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
    real(wp) :: length
    integer :: k, c

    instant%time = solution%time + dt
    instant%dt = equations%stage%share*dt
    instant%share = equations%stage%share
    instant%content = equations%stage%content
    instant%reach = equations%stage%reach
    instant%tangent = tangent
    instant%mode = equations%mode
    instant%lasting_share = solution%penalty_share
    instant%penalty_share = equations%penalty_share
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
    length = equations%stage%mean_over
    ! the weights of the stages of a step make the mean themselves
    if (equations%stage%content .and. equations%stage%share >= 1) length = dt
    do c = 1, instant%flow%n
      do k = 1, size(scene%multipliers)
        instant%flow%multipliers(k, c) = multiplier_at(scene%multipliers(k), solution%time + instant%flow%share(c)*dt)
      end do
    end do
    instant%flow%stated = instant%flow%multipliers
    if (length > 0) then
      do k = 1, size(scene%multipliers)
        instant%flow%stated(k, :) = mean_of_multiplier(scene%multipliers(k), solution%time, solution%time + length)
      end do
    end if
    if (any(scene%groups%source > 0)) call set_sources(scene, equations, solution, dt, du, instant)
    if (size(solution%fields) > size(mechanical_fields())) call list_values(equations%dofs, solution%fields, instant%values)
    if (size(solution%pairs) == 0) return
    coordinates = moved_places(scene, equations%dofs, solution, du)
    allocate (instant%dies, source=scene%dies)
    do k = 1, size(instant%dies)
      if (.not. is_deformable(instant%dies(k))) cycle
      call place_on_nodes(coordinates, instant%dies(k))
      call place_edges(scene%mesh%coordinates, instant%dies(k))
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

  !> Factors of the sources of torches at the instants at which heat flows, on the places of the bodies then.
  subroutine set_sources(scene, equations, solution, dt, du, instant)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt       !! [time]
    real(wp), intent(in) :: du(:)    !! (ndof) motion of the step [unknown]
    type(instant_t), intent(inout) :: instant
    real(wp) :: power(size(scene%sources))
    type(torch_step_t) :: step
    integer :: k

    associate (flow => instant%flow)
      flow%times = solution%time + flow%share(:flow%n)*dt
      allocate (flow%source_factors(size(scene%sources), flow%n))
      allocate (flow%places(2, size(scene%mesh%coordinates, 2), flow%n), flow%sections(3, flow%n))
      do k = 1, flow%n
        flow%places(:, :, k) = scene%mesh%coordinates
        flow%sections(:, k) = scene%section
        if (scene%finite) then
          flow%places(:, :, k) = moved_places(scene, equations%dofs, solution, flow%share(k)*du)
          flow%sections(:, k) = moved_section(equations%dofs, instant%section, flow%share(k)*du)
        end if
        if (allocated(equations%torches)) then
          power = torch_powers(scene, flow%times(k), equations%torches)
        else if (instant%content .and. dt > 0) then
          call torch_step(scene, solution%time, dt, flow%share(:flow%n), flow%weight(:flow%n), step)
          power = torch_powers(scene, flow%times(k), step)
        else
          power = torch_powers(scene, flow%times(k))
        end if
        call source_factors(scene, flow%sections(:, k), flow%places(:, :, k), flow%times(k), power, flow%source_factors(:, k))
      end do
    end associate
  end subroutine set_sources

  !> Where the nodes are after a motion since the start of the step (2, nnode) [length].
  function moved_places(scene, dofs, solution, du) result(coordinates)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    real(wp) :: coordinates(2, size(scene%mesh%coordinates, 2))
    integer :: k, c

    coordinates = present_coordinates(scene, solution)
    associate (number => dofs%fields(displacement_field)%number)
      do k = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, k) > 0) coordinates(c, k) = coordinates(c, k) + du(number(c, k))
        end do
      end do
    end associate
  end function moved_places

  !> The section after a motion since the start of the step.
  pure function moved_section(dofs, start, du) result(section)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: start(3)   !! at the start of the step (sections)
    real(wp), intent(in) :: du(:)      !! (ndof) [unknown]
    real(wp) :: section(3)
    integer :: c

    section = start
    associate (number => dofs%fields(section_field)%number)
      if (size(number, 2) == 0) return
      do c = 1, size(number, 1)
        if (number(c, 1) > 0) section(c) = section(c) + du(number(c, 1))
      end do
    end associate
  end function moved_section

  !> The displacements and the motion of the section from which a correction began, where geometry follows the displacements.
  pure subroutine note_correction(scene, dofs, motion, instant)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: motion(:)   !! (ndof) [unknown]
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

  !> Trial values of the fields that drive points at the end of the step (nnode, nfield); none where no point is driven by any.
  subroutine driving_values(scene, equations, solution, du, now)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)   !! change in the step (ndof) [unknown]
    real(wp), allocatable, intent(out) :: now(:, :)   !! (nnode, nfield) [unit of each field]
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

end module step_instants
