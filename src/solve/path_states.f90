!> States of the bodies whose laws flow, made beside those of a step that has converged: by another motion, from another start.
module path_states
  use wall_contact, only: press_on_walls
  use dofs, only: move_fields
  use drivers, only: drivers_t
  use elem_api, only: block_done, instant_t, report_t, totals_t
  use element_loop, only: gather_forces, group_geometry, run_elements
  use equations, only: equations_t
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use kinematics_api, only: first_history
  use law_api, only: driver_count, driver_temperature, law_t, solid_law
  use scene, only: role_body, role_second, scene_t
  use solution, only: group_state_t, solution_t
  use state_behind_sides, only: mean_temperature
  use step_instants, only: make_instant
  use timers, only: ledger_t
  implicit none
  private
  public :: advance_beside, begin_beside, flow_energy, has_path, has_stress, of_unknowns, on_nodes, root_energy, unbalanced_forces

contains

  !> Groups of bodies whose laws flow (ngroup).
  pure function has_path(scene, laws) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical :: yes(size(scene%groups))
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0 .or. all(scene%groups(g)%role /= [role_body, role_second])) cycle
      associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
        yes(g) = law%kind == solid_law .and. associated(law%flow_stress)
      end associate
    end do
  end function has_path

  !> Groups of bodies with a stress, whether they flow or not (ngroup).
  pure function has_stress(scene, laws) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical :: yes(size(scene%groups))
    integer :: g

    do g = 1, size(yes)
      yes(g) = scene%groups(g)%material > 0 .and. any(scene%groups(g)%role == [role_body, role_second])
      if (yes(g)) yes(g) = laws(scene%materials(scene%groups(g)%material)%law_id)%kind == solid_law
    end do
  end function has_stress

  !> The start of the step. Nothing of contact is computed.
  subroutine begin_beside(solution, other)
    type(solution_t), intent(in) :: solution
    type(solution_t), intent(out) :: other

    other = solution
    deallocate (other%pairs)
    allocate (other%pairs(0))
  end subroutine begin_beside

  !> Trial states after a motion, the geometry and the time. `done` is false where a law or an element cannot go on.
  subroutine advance_beside(scene, equations, active, drivers, motion, length, other, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations   !! element forces become those of the other state
    logical, intent(in) :: active(:)                !! (ngroup) groups that are advanced
    type(drivers_t), intent(inout) :: drivers(:)    !! (ngroup)
    real(wp), intent(in) :: motion(:)               !! (ndof) [unknown]
    real(wp), intent(in) :: length                  !! [time]
    type(solution_t), intent(inout) :: other
    logical, intent(out) :: done
    type(instant_t) :: instant
    type(report_t) :: report
    type(ledger_t) :: within
    real(wp) :: none(0, 0)

    call make_instant(scene, equations, other, length, motion, .false., instant)
    call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, &
                      equations%solves(equations%now)%pattern, instant, motion, none, other, drivers, equations%buffers, &
                      within, report)
    done = report%status == block_done
    call move_fields(equations%dofs, motion, other%fields)
    other%time = other%time + length
  end subroutine advance_beside

  !> Forces of the step less those that the stresses of the other state make in its end, on the unknowns of mechanics.
  subroutine unbalanced_forces(scene, equations, solution, du, residual)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations   !! element forces are those of the other state
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)                   !! (ndof) motion of the step [unknown]
    real(wp), intent(out) :: residual(:)            !! (ndof) [residual]
    type(report_t) :: unused
    real(wp), dimension(size(du)) :: force, magnitude
    integer :: f, k, c

    residual = 0
    force = equations%force
    associate (solve => equations%solves(equations%now))
      call press_on_walls(scene, equations%dofs, solve%pattern, solve%active, solution%fields(displacement_field)%value, du, &
                          .false., .false., equations%wall, equations%buffers%force, equations%buffers%matrix, unused)
      call gather_forces(solve%pattern, equations%buffers, solve%is_own, force, magnitude)
    end associate
    do f = 1, size(solution%fields)
      if (solution%fields(f)%quantity /= 'motion') cycle
      associate (number => equations%dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (number(c, k) > 0) residual(number(c, k)) = equations%force(number(c, k)) - force(number(c, k))
          end do
        end do
      end associate
    end do
  end subroutine unbalanced_forces

  !> Root of the elastic energy of the bodies that flow.
  function root_energy(scene, equations, active, place, groups, committed) result(root)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: active(:)                !! (ngroup) groups that are counted
    type(solution_t), intent(in) :: place           !! with the geometry
    type(group_state_t), intent(in) :: groups(:)    !! with the states
    logical, intent(in), optional :: committed      !! of the committed states, not the trial ones
    real(wp) :: root
    type(totals_t) :: totals
    real(wp), allocatable :: x(:, :, :)
    integer :: g

    root = 0
    do g = 1, size(active)
      if (.not. active(g)) cycle
      associate (group => scene%groups(g), row => equations%elems(scene%groups(g)%elem_id), &
                 law => equations%laws(scene%materials(scene%groups(g)%material)%law_id), &
                 section => place%fields(section_field)%value(:, 1))
        call group_geometry(scene, group, row, place%fields(displacement_field)%value, x)
        if (present(committed)) then
          call row%measure(scene, group, law, section, place%penalty_share, x, groups(g)%committed, groups(g)%committed, totals)
        else
          call row%measure(scene, group, law, section, place%penalty_share, x, groups(g)%trial, groups(g)%trial, totals)
        end if
      end associate
      root = root + totals%elastic_energy
    end do
    root = sqrt(max(root, 0.0_wp))
  end function root_energy

  !> Root of the elastic energy of bodies that flow at the stress that makes them flow, at the start of the step; a point of each
  !> element stands for it. Bodies that creep at any stress have that of their present rate.
  function flow_energy(scene, equations, active, solution) result(root)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: active(:)          !! (ngroup) bodies that flow
    type(solution_t), intent(in) :: solution
    real(wp) :: root   !! [energy^0.5]
    type(totals_t) :: totals
    real(wp), allocatable :: x(:, :, :), given(:)
    real(wp) :: young, poisson, density
    integer :: g, e

    root = 0
    do g = 1, size(active)
      if (.not. active(g)) cycle
      associate (group => scene%groups(g), row => equations%elems(scene%groups(g)%elem_id), &
                 material => scene%materials(scene%groups(g)%material), drivers => equations%drivers(g)%value, &
                 law => equations%laws(scene%materials(scene%groups(g)%material)%law_id), state => solution%groups(g)%committed)
        if (.not. associated(law%elastic)) cycle
        call group_geometry(scene, group, row, solution%fields(displacement_field)%value, x)
        call row%measure(scene, group, law, solution%fields(section_field)%value(:, 1), solution%penalty_share, x, state, state, &
                         totals)
        allocate (given(driver_count(law)), source=0.0_wp)
        density = 0
        do e = 1, size(state, 3)
          if (size(drivers, 1) > 0) given = drivers(:, 1, 1, e)
          given(driver_temperature) = mean_temperature(scene, solution, group, e)
          call law%elastic(material, given(driver_temperature), young, poisson)
          density = density + law%flow_stress(material, given, state(first_history:, 1, e))**2/(2*young)
        end do
        deallocate (given)
        root = root + density/size(state, 3)*totals%volume
      end associate
    end do
    root = sqrt(root)
  end function flow_energy

  !> Displacements of nodes as a motion of the unknowns.
  pure function of_unknowns(equations, displacement) result(motion)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) [length]
    real(wp) :: motion(equations%dofs%ndof)
    integer :: k, c

    motion = 0
    associate (number => equations%dofs%fields(displacement_field)%number)
      do k = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, k) > 0) motion(number(c, k)) = displacement(c, k)
        end do
      end do
    end associate
  end function of_unknowns

  !> The part of a motion of unknowns that is of the displacements of nodes.
  pure function on_nodes(equations, motion) result(displacement)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: motion(:)   !! (ndof) [unknown]
    real(wp), allocatable :: displacement(:, :)
    integer :: k, c

    associate (number => equations%dofs%fields(displacement_field)%number)
      allocate (displacement(size(number, 1), size(number, 2)), source=0.0_wp)
      do k = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, k) > 0) displacement(c, k) = motion(number(c, k))
        end do
      end do
    end associate
  end function on_nodes

end module path_states
