!> Work of temperatures on the elastic energy of bodies: expansion, and moduli that depend on the temperature.
!>
!> The elastic energy is a free energy: at a given motion a change of temperature changes it, by -sigma:d(eps_th) and by
!> eps:dC:eps/2, and the work of the forces is not all it comes from. For a step the change is found with the motion held, at its
!> start (from the old temperatures to the new ones) and at its end, and the mean of both counts: exact for constant moduli, where
!> it is -(sigma(n) + sigma(n+1))/2 : eps_th, and of second order in the step otherwise. The laws answer by themselves: in no time
!> nothing flows, and a step without motion changes only what temperatures change. Volumes that expansion makes are found the same
!> way. Source: B.A. Boley, J.H. Weiner, Theory of Thermal Stresses (1960), ch. 1 (free energy of an elastic body).
module thermal_work
  use elem_api, only: instant_t, totals_t
  use element_loop, only: group_geometry
  use equations, only: equations_t
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use law_api, only: asks_for, driver_count, driver_temperature, law_t, solid_law
  use loads, only: multiplier_at
  use point_temperatures, only: find_temperatures, projected_functions, temperature_place
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: book_heat_work, heat_work_t

  !> Of a step, per radian when axisymmetric.
  type :: heat_work_t
    !> Given to the elastic energy; and the sum of the sizes of it at the points [energy].
    real(wp) :: work = 0.0_wp, passed = 0.0_wp
    !> Volume without elastic strain that expansion made [volume].
    real(wp) :: grown = 0.0_wp
  end type heat_work_t

contains

  !> The work of temperatures in the step whose motion the fields have and whose state is not yet committed.
  subroutine book_heat_work(scene, equations, solution, heat)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(heat_work_t), intent(out) :: heat
    type(instant_t) :: instant
    real(wp), allocatable :: given(:, :, :)
    integer :: g, k

    allocate (instant%multipliers(size(scene%multipliers)), instant%multipliers_before(size(scene%multipliers)))
    do k = 1, size(scene%multipliers)
      instant%multipliers_before(k) = multiplier_at(scene%multipliers(k), solution%time - solution%last_step)
      instant%multipliers(k) = multiplier_at(scene%multipliers(k), solution%time)
    end do
    do g = 1, size(scene%groups)
      if (.not. feels_temperature(scene, equations, g)) cycle
      associate (law => equations%laws(scene%materials(scene%groups(g)%material)%law_id))
        call drivers_of_group(scene%groups(g), equations, solution, law, instant, g, given)
      end associate
      if (.not. any(abs(given(driver_temperature, 2, :) - given(driver_temperature, 1, :)) > 0)) cycle
      call change_at_rest(scene, equations, solution, g, given, 1, heat)
      call change_at_rest(scene, equations, solution, g, given, 2, heat)
    end do
  end subroutine book_heat_work

  !> The group is a body whose law depends on a temperature that it has.
  pure function feels_temperature(scene, equations, g) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: g   !! place of the group
    logical :: yes

    yes = .false.
    associate (group => scene%groups(g))
      if (group%material == 0 .or. .not. associated(equations%elems(group%elem_id)%measure)) return
      associate (material => scene%materials(group%material), law => equations%laws(scene%materials(group%material)%law_id))
        yes = law%kind == solid_law .and. (asks_for(law, 'temperature') .or. allocated(material%temperatures)) &
              .and. (group%temperature_multiplier > 0 .or. temperature_place(equations%dofs%groups(g)%layout) > 0)
      end associate
    end associate
  end function feels_temperature

  !> Drivers of all points of a group at both ends of the step.
  subroutine drivers_of_group(group, equations, solution, law, instant, g, given)
    type(group_t), intent(in) :: group
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: g
    real(wp), allocatable, intent(out) :: given(:, :, :)   !! (ndriver, 2, npoint*nelem)
    type(quad8_rule_t) :: rule
    real(wp) :: functions(8, group%rule%n)
    real(wp), dimension(size(equations%dofs%groups(g)%dof, 1)) :: start, du
    integer :: e, p, n, u, f, k

    n = group%rule%n
    call quad8_rule(n, rule)
    functions = projected_functions(rule)
    allocate (given(driver_count(law), 2, n*size(group%connectivity, 2)), source=0.0_wp)
    start = 0
    du = 0
    associate (layout => equations%dofs%groups(g)%layout, nodes => group%connectivity)
      u = temperature_place(layout)
      do e = 1, size(nodes, 2)
        p = (e - 1)*n
        if (u > 0) then
          f = layout%field(u)
          do k = 1, layout%count(u)
            du(layout%first(1, u) + k - 1) = solution%fields(f)%last_increment(1, nodes(k, e))
            start(layout%first(1, u) + k - 1) = solution%fields(f)%value(1, nodes(k, e)) - du(layout%first(1, u) + k - 1)
          end do
        end if
        call find_temperatures(group, instant, layout, functions, du, start, given(driver_temperature, :, p + 1:p + n))
        if (size(given, 1) > 1) given(2:, :, p + 1:p + n) = equations%drivers(g)%value(2:, :, :, e)
      end do
    end associate
  end subroutine drivers_of_group

  !> Half of what the change of temperatures does with the motion held at the start (1) or at the end (2) of the step.
  subroutine change_at_rest(scene, equations, solution, g, given, at, heat)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, at              !! place of the group; end of the step
    real(wp), intent(in) :: given(:, :, :)    !! (ndriver, 2, npoint) [unit of each driver]
    type(heat_work_t), intent(inout) :: heat
    real(wp), allocatable :: x(:, :, :), other(:, :, :), tangent(:, :, :), still(:, :)
    integer, allocatable :: status(:)
    real(wp) :: section(3)
    type(totals_t) :: with, without
    integer :: n

    n = size(given, 3)
    associate (group => scene%groups(g), u => solution%fields(displacement_field), state => solution%groups(g), &
               row => equations%elems(scene%groups(g)%elem_id), material => scene%materials(scene%groups(g)%material), &
               kinematics => equations%kinematics)
      associate (law => equations%laws(material%law_id))
        allocate (other, mold=state%trial)
        allocate (tangent(4, 5, n), status(n))
        still = spread([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp], 2, n)
        section = solution%fields(section_field)%value(:, 1)
        if (at == 1) then
          section = section - solution%fields(section_field)%last_increment(:, 1)
          call kinematics%update(law, material, 0.0_wp, n, size(other, 1), given, still, state%committed, other, tangent, status)
          call group_geometry(scene, group, row, u%value - u%last_increment, x)
          call row%measure(scene, group, law, section, x, other, state%committed, with)
          call row%measure(scene, group, law, section, x, state%committed, state%committed, without)
        else
          call kinematics%update(law, material, 0.0_wp, n, size(other, 1), given(:, [2, 1], :), still, state%trial, other, &
                                 tangent, status)
          call group_geometry(scene, group, row, u%value, x)
          call row%measure(scene, group, law, section, x, state%trial, other, with)
          call row%measure(scene, group, law, section, x, other, other, without)
        end if
      end associate
    end associate
    heat%work = heat%work + 0.5_wp*(with%elastic_energy - without%elastic_energy)
    heat%passed = heat%passed + 0.5_wp*with%passed
    heat%grown = heat%grown + 0.5_wp*(with%unloaded_volume - without%unloaded_volume)
  end subroutine change_at_rest

end module thermal_work
