!> Work of temperatures on the elastic energy of bodies: expansion, and moduli that depend on the temperature.
!>
!> The elastic energy is a free energy: a change of temperature changes it at a given motion, by -sigma:d(eps_th) and by
!> e:dC:e/2, and the work of the forces is not all it comes from. In a step from e0 to e1, with s0 = C0 e0 and s1 = C1 e1,
!>   s1:e1/2 - s0:e0/2 = (s0 + s1)/2 : (e1 - e0 + eps_th) + [s1:(e0 - eps_th) - s0:(e1 + eps_th)]/2
!> is an identity: the first term is the work of the stresses by the trapezoidal rule, the second that of the temperatures; it
!> is e0:(C1 - C0):e1/2 - (s0 + s1)/2 : eps_th. Volumes enter as they carry the stresses. The laws tell eps_th by themselves: in
!> no time nothing flows, and a step without motion changes only what temperatures change (for work kept by a backstress the
!> mean of that at the start and at the end counts).
!> Source: B.A. Boley, J.H. Weiner, Theory of Thermal Stresses (1960), ch. 1 (free energy of an elastic body).
module thermal_work
  use drivers, only: own_states_at_end
  use elem_api, only: group_temperature, instant_t, totals_t
  use element_loop, only: group_geometry
  use equations, only: equations_t
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use law_api, only: asks_for, driver_count, driver_temperature, law_t, solid_law
  use loads, only: multiplier_at
  use point_temperatures, only: point_temperatures_of, projected_functions, temperature_place
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
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
      if (.not. any(abs(given(:, 2, :) - given(:, 1, :)) > 0)) cycle
      call add_work(scene, equations, solution, g, given, heat)
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
        if (u > 0 .and. group%temperature_multiplier == 0) then
          f = layout%field(u)
          do k = 1, layout%count(u)
            du(layout%first(1, u) + k - 1) = solution%fields(f)%last_increment(1, nodes(k, e))
            start(layout%first(1, u) + k - 1) = solution%fields(f)%value(1, nodes(k, e)) - du(layout%first(1, u) + k - 1)
          end do
          call point_temperatures_of(layout, functions, du, start, given(driver_temperature, :, p + 1:p + n))
        else
          given(driver_temperature, :, p + 1:p + n) = spread(group_temperature(group, instant), 2, n)
        end if
        if (size(given, 1) == 1) cycle
        given(2:, :, p + 1:p + n) = equations%drivers(g)%value(2:, :2, :, e)
        call own_states_at_end(equations%drivers(g), solution%groups(g), g, e, given(:, 2, p + 1:p + n))
      end do
    end associate
  end subroutine drivers_of_group

  !> Work of the temperatures on one group.
  subroutine add_work(scene, equations, solution, g, given, heat)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g                  !! place of the group
    real(wp), intent(in) :: given(:, :, :)    !! (ndriver, 2, npoint) [unit of each driver]
    type(heat_work_t), intent(inout) :: heat
    real(wp), dimension(size(solution%groups(g)%trial, 1), size(solution%groups(g)%trial, 2), size(solution%groups(g)%trial, 3)) &
      :: first, last, back
    real(wp) :: expansion(4, size(first, 2), size(first, 3)), tangent(4, 5, size(given, 3)), still(5, size(given, 3))
    real(wp) :: kept(size(first, 2), size(first, 3)), section(3)
    real(wp), allocatable :: x_first(:, :, :), x_last(:, :, :)
    integer :: status(size(given, 3)), at_kept
    type(totals_t) :: at_end, at_start, with, without

    still = spread([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp], 2, size(given, 3))
    section = solution%fields(section_field)%value(:, 1)
    associate (group => scene%groups(g), u => solution%fields(displacement_field), state => solution%groups(g), &
               row => equations%elems(scene%groups(g)%elem_id), material => scene%materials(scene%groups(g)%material), &
               kinematics => equations%kinematics, strain => [5, 6, 7, 8])
      associate (law => equations%laws(material%law_id))
        call kinematics%update(law, material, 0.0_wp, size(given, 3), size(first, 1), given, still, state%committed, first, &
                               tangent, status)
        call kinematics%update(law, material, 0.0_wp, size(given, 3), size(first, 1), given(:, [2, 1], :), still, state%trial, &
                               back, tangent, status)
        expansion = state%committed(strain, :, :) - first(strain, :, :)
        kept = 0
        at_kept = find_variable(group%variables, 'stored_work')
        if (at_kept > 0) then
          at_kept = group%variables(at_kept)%first
          kept = 0.5_wp*(first(at_kept, :, :) - state%committed(at_kept, :, :) + state%trial(at_kept, :, :) - back(at_kept, :, :))
        end if
        call group_geometry(scene, group, row, u%value - u%last_increment, x_first)
        call group_geometry(scene, group, row, u%value, x_last)
        first = state%committed
        first(strain, :, :) = state%trial(strain, :, :) + expansion
        last = state%trial
        last(strain, :, :) = state%committed(strain, :, :) - expansion
        if (at_kept > 0) first(at_kept, :, :) = 0
        if (at_kept > 0) last(at_kept, :, :) = 0
        call row%measure(scene, group, law, section, solution%penalty_share, x_last, last, first, at_end)
        call row%measure(scene, group, law, section - solution%fields(section_field)%last_increment(:, 1), &
                         solution%penalty_share, x_first, first, first, &
                         at_start)
        ! without stress: work kept by a backstress, and volumes
        last = state%trial
        last(:4, :, :) = 0
        if (at_kept > 0) last(at_kept, :, :) = kept
        call row%measure(scene, group, law, section, solution%penalty_share, x_last, last, last, with)
        last(strain, :, :) = last(strain, :, :) + expansion
        call row%measure(scene, group, law, section, solution%penalty_share, x_last, last, last, without)
      end associate
    end associate
    heat%work = heat%work + at_end%elastic_energy - at_start%elastic_energy + with%elastic_energy
    heat%passed = heat%passed + at_end%passed
    heat%grown = heat%grown + with%unloaded_volume - without%unloaded_volume
  end subroutine add_work

end module thermal_work
