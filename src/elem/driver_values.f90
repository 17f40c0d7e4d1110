!> Values of the drivers at the start and at the end of a step.
module driver_values
  use drivers, only: at_body_effusivity, driver_source_t, drivers_t, from_effusivity, from_field, from_flow, from_itself, &
                     from_state, from_stress, from_stretch, from_unloading, is_scalar
  use fields, only: field_t, has_corners_only
  use kinds, only: wp
  use law_api, only: driver_temperature, law_t
  use point_temperatures, only: nodal_temperatures
  use quadrature, only: line_rule, square_rule
  use scene, only: group_t, host_of, role_contact, role_heat_contact, scene_t
  use shape_functions, only: line3, quad8
  use solution, only: solution_t
  use state_behind_sides, only: effusivity, effusivity_of_die, flow_behind, given_temperature, nearest_points
  use stress_measures, only: stress_measure
  implicit none
  private
  public :: stress_of_solution, start_drivers, advance_drivers, nodal_values, field_at_points

contains

  !> All drivers at the accepted state, for the step that begins there.
  subroutine start_drivers(scene, laws, solution, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(inout) :: drivers(:)   !! (ngroup)
    real(wp) :: now(size(scene%mesh%coordinates, 2), size(scene%fields))
    integer :: g, k

    call nodal_values(scene, solution, now)
    do k = 1, 2   ! bodies first: the flow stress behind a side depends on what drives them
      do g = 1, size(drivers)
        if (size(drivers(g)%value, 1) == 0 .or. (scene%groups(g)%role == role_contact .neqv. k == 2)) cycle
        call fill(scene, laws, solution, now, solution%time, g, 1, drivers)
        drivers(g)%value(:, 2, :, :) = drivers(g)%value(:, 1, :, :)
      end do
    end do
  end subroutine start_drivers

  !> Fields and states that drive a group at the end of the step, as they are tried now; at an instant within the step, states are
  !> linear between its ends.
  subroutine advance_drivers(scene, laws, solution, now, time, reach, g, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: now(:, :)   !! (nnode, nfield) trial values of the nodal fields of one component [unit of each field]
    real(wp), intent(in) :: time   !! end of the step, or the instant within [time]
    real(wp), intent(in) :: reach  !! share of the step after which that is
    integer, intent(in) :: g   !! number of the group
    type(drivers_t), intent(inout) :: drivers(:)   !! (ngroup)
    integer :: k

    if (.not. drivers(g)%vary) return
    call fill(scene, laws, solution, now, time, g, 2, drivers)
    ! between one facing point and the next there is none
    if (reach >= 1 .or. scene%groups(g)%role == role_heat_contact) return
    do k = 1, size(drivers(g)%source)
      if (.not. any(drivers(g)%source(k)%kind == [from_state, from_stress])) cycle
      associate (value => drivers(g)%value(k, :, :, :))
        value(2, :, :) = (1 - reach)*value(1, :, :) + reach*value(2, :, :)
      end associate
    end do
  end subroutine advance_drivers

  !> Values of the fields that can drive points at the accepted state, 0 for others.
  pure subroutine nodal_values(scene, solution, now)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(out) :: now(:, :)   !! (nnode, nfield) [unit of each field]
    integer :: f

    now = 0
    do f = 1, size(scene%fields)
      if (is_scalar(scene%fields(f))) now(:, f) = solution%fields(f)%value(1, :)
    end do
  end subroutine nodal_values

  !> Drivers of one group at one end of the step.
  subroutine fill(scene, laws, solution, now, time, g, at, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: now(:, :)   !! nodal values then (nnode, nfield)
    real(wp), intent(in) :: time
    integer, intent(in) :: g, at   !! number of the group; 1: start, 2: end of the step
    type(drivers_t), intent(inout) :: drivers(:)
    integer :: k, e

    associate (own => drivers(g), group => scene%groups(g))
      do k = 1, size(own%source)
        select case (own%source(k)%kind)
        case (from_field)
          do e = 1, size(own%value, 4)
            own%value(k, at, :, e) = field_at_points(scene%fields(own%source(k)%field), now(:, own%source(k)%field), group, e)
          end do
        case (from_state)
          do e = 1, size(own%value, 4)
            own%value(k, at, :, e) = state_at_points(scene, solution, g, own, k, at, e)
          end do
        case (from_stress)
          if (at == 2 .and. allocated(own%handed)) then
            own%value(k, at, :, :) = own%handed(k, :, :)
            cycle
          end if
          do e = 1, size(own%value, 4)
            own%value(k, at, :, e) = stress_at_points(scene, solution, g, own%source(k), at, e)
          end do
        case (from_unloading)
          ! that at the start holds for the whole step
          if (at == 2) cycle
          do e = 1, size(own%value, 4)
            own%value(k, 1, :, e) = unloaded_at_points(scene, solution, g, own%source(k), e)
            own%value(k, 2, :, e) = own%value(k, 1, :, e)
          end do
        case (from_stretch)
          ! so does this
          if (at == 2) cycle
          associate (body => host_of(scene, g))
            own%value(k, 1, :, :) = solution%groups(own%source(k)%group(body))%committed(own%source(k)%row(body), :, :)
          end associate
          own%value(k, 2, :, :) = own%value(k, 1, :, :)
        case (from_itself)
          if (at == 1) own%value(k, at, :, :) = solution%groups(g)%committed(own%source(k)%row(g), :, :)
        case (from_flow)
          if (at == 2) cycle
          do e = 1, size(own%value, 4)
            own%value(k, at, :, e) = flow_behind(scene, laws, solution, own, drivers, e)
          end do
        case (from_effusivity)
          if (at == 2) cycle
          do e = 1, size(own%value, 4)
            if (k == at_body_effusivity) then
              own%value(k, at, :, e) = effusivity(scene, laws, solution, drivers, own%body(e), own%element(e), own%side(e))
            else
              own%value(k, at, :, e) = effusivity_of_die(scene, laws, solution, own, drivers, g, e)
            end if
          end do
        end select
        if (k /= driver_temperature .or. .not. allocated(own%body) .or. group%role == role_heat_contact) cycle
        do e = 1, size(own%value, 4)
          associate (body => scene%groups(own%body(e)))
            if (body%temperature_multiplier > 0) own%value(k, at, :, e) = given_temperature(scene, body, time)
          end associate
        end do
      end do
    end associate
  end subroutine fill

  !> A nodal field at the points of an element or a side.
  pure function field_at_points(field, now, group, e) result(values)
    type(field_t), intent(in) :: field
    real(wp), intent(in) :: now(:)   !! (nnode) [unit of the field]
    type(group_t), intent(in) :: group
    integer, intent(in) :: e   !! element
    real(wp) :: values(group%rule%n)
    real(wp), allocatable :: xi(:), place(:, :), weight(:)
    real(wp) :: nodal(8), phi(8), dphi(2, 8), phi3(3), dphi3(3)
    integer :: p

    associate (nodes => group%connectivity(:, e))
      if (size(nodes) == 3) then
        nodal(:3) = now(nodes)
        if (has_corners_only(field)) nodal(2) = 0.5_wp*(nodal(1) + nodal(3))
        call line_rule(group%rule, xi, weight)
        do p = 1, size(values)
          call line3(xi(p), phi3, dphi3)
          values(p) = dot_product(phi3, nodal(:3))
        end do
      else
        nodal = nodal_temperatures(now(nodes(:merge(4, 8, has_corners_only(field)))))
        call square_rule(group%rule%n, place, weight)
        do p = 1, size(values)
          call quad8(place(1, p), place(2, p), phi, dphi)
          values(p) = dot_product(phi, nodal)
        end do
      end if
    end associate
  end function field_at_points

  !> A state variable of another formulation on the same points, or of the body behind a side.
  pure function state_at_points(scene, solution, g, own, k, at, e) result(values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, k, at, e   !! group, driver, end of the step, element
    type(drivers_t), intent(in) :: own
    real(wp) :: values(scene%groups(g)%rule%n)
    integer :: body, near(2)

    body = host_of(scene, g)
    if (allocated(own%body) .and. scene%groups(g)%role /= role_heat_contact) body = own%body(e)
    values = 0
    if (own%source(k)%group(body) == 0) return   ! the body behind has none
    associate (state => solution%groups(own%source(k)%group(body)), row => own%source(k)%row(body))
      if (.not. allocated(own%body) .or. scene%groups(g)%role == role_heat_contact) then
        values = merge(state%committed(row, :, e), state%trial(row, :, e), at == 1)
      else
        near = nearest_points(scene%groups(body)%rule%n, own%side(e))
        values = 0.5_wp*sum(merge(state%committed(row, near, own%element(e)), state%trial(row, near, own%element(e)), at == 1))
      end if
    end associate
  end function state_at_points

  !> Volume without elastic strain over that of now, of the mechanics on the same points: exp(-tr e) in large strain.
  pure function unloaded_at_points(scene, solution, g, source, e) result(values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, e   !! group, element
    type(driver_source_t), intent(in) :: source
    real(wp) :: values(scene%groups(g)%rule%n)   !! [-]
    integer :: body

    values = 1
    if (.not. scene%finite) return
    body = host_of(scene, g)
    associate (strain => solution%groups(source%group(body))%committed(:, :, e), row => source%row(body))
      values = exp(-strain(row, :) - strain(row + 1, :) - strain(row + 3, :))
    end associate
  end function unloaded_at_points

  !> A measure of the stress of the mechanics on the same points.
  pure function stress_at_points(scene, solution, g, source, at, e) result(values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, at, e   !! group, end of the step, element
    type(driver_source_t), intent(in) :: source
    real(wp) :: values(scene%groups(g)%rule%n)   !! [stress]
    integer :: p, body

    body = host_of(scene, g)
    associate (state => solution%groups(source%group(body)), row => source%row(body))
      do p = 1, size(values)
        if (at == 1) values(p) = stress_measure(source%measure, state%committed(row:row + 3, p, e))
        if (at == 2) values(p) = stress_measure(source%measure, state%trial(row:row + 3, p, e))
      end do
    end associate
  end function stress_at_points

  !> Those measures of the stress as it is tried now, group by group.
  subroutine stress_of_solution(scene, solution, drivers, values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup)
    real(wp), intent(out) :: values(:)          !! (stress_driver_count) [stress]
    integer :: g, k, e, i, npoint

    i = 0
    do g = 1, size(drivers)
      if (.not. allocated(drivers(g)%source)) cycle
      npoint = size(drivers(g)%value, 3)
      do k = 1, size(drivers(g)%source)
        if (drivers(g)%source(k)%kind /= from_stress) cycle
        do e = 1, size(drivers(g)%value, 4)
          values(i + 1:i + npoint) = stress_at_points(scene, solution, g, drivers(g)%source(k), 2, e)
          i = i + npoint
        end do
      end do
    end do
  end subroutine stress_of_solution

end module driver_values
