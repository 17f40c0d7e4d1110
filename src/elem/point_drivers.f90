!> External drivers of the laws at points, by the names that each law declares (law_api).
!>
!> A point of a body is driven by its temperature, by nodal fields of one component, and by state variables of other formulations
!> on the same body. A point of contact is driven by the temperature of its side, by such fields there, and by the state of the
!> body behind: the mean over the two integration points of the element nearest to the side. The `flow_stress` of that body is the
!> one of the accepted state, and holds for the step that follows; all others are known at both ends of the step.
!>
!> The temperature of a body is found by the element itself, which has derivatives along it.
!>
!> Heat through contact has no law: its points are driven by what their contact keeps (names below), and by the effusivities of
!> both bodies, those of the accepted state, where heat of friction is shared by them.
module point_drivers
  use fields, only: field_t, find_field, has_corners_only, on_nodes
  use kinds, only: wp
  use kinematics_api, only: first_history
  use law_api, only: driver_count, driver_t, driver_temperature, heat_law, law_t, solid_law
  use loads, only: multiplier_at
  use materials, only: has_number
  use point_temperatures, only: nodal_temperatures, temperature_field
  use quadrature, only: line_rule, square_rule
  use scene, only: group_t, host_of, is_solid, role_contact, role_heat_contact, scene_t
  use shape_functions, only: line3, quad8
  use solution, only: group_state_t, solution_t
  use state_variables, only: find_variable
  use strategy, only: coupling_monolithic
  use stress_measures, only: measure_names, nmeasure, stress_measure
  implicit none
  private
  public :: at_status, at_pressure, at_gap, at_die_piece, at_die_xi, at_friction_work, at_corner_work, at_corner_place, &
            at_body_effusivity, at_die_effusivity
  public :: drivers_t, find_drivers, missing_driver, driver_of_others, start_drivers, advance_drivers, drivers_of_half, &
            own_states_at_end, stress_driver_count, stress_of_solution, hand_over_stress, nodal_values, is_scalar, &
            field_at_points, with_slopes, drives_heat, from_state, from_stress

  !> Where a driver comes from. A state variable of the formulation itself is that at the start of the step.
  integer, parameter :: from_nothing = 0, from_field = 1, from_state = 2, from_flow = 3, from_itself = 4, from_effusivity = 5, &
                        from_stress = 6
  !> Name of the flow stress of the body behind a side.
  character(len=*), parameter :: flow_name = 'flow_stress'

  !> What drives heat through contact: state variables of the contact, and effusivities.
  integer, parameter :: at_status = 2, at_pressure = 3, at_gap = 4, at_die_piece = 5, at_die_xi = 6, at_friction_work = 7, &
                        at_corner_work = 8, at_corner_place = 9, at_body_effusivity = 10, at_die_effusivity = 11
  character(len=20), parameter :: of_contact(at_status:at_corner_place) = &
                                  ['contact_status      ', 'pressure            ', 'penetration         ', 'die_piece           ', &
                                   'die_xi              ', 'friction_work       ', 'corner_friction_work', 'corner_place        ']

  type :: driver_source_t
    integer :: kind = from_nothing
    !> Field of the scene; or group and row of its state, for contact by the groups of bodies (ngroup).
    integer :: field = 0
    !> Measure of the stress there (stress_measures).
    integer :: measure = 0
    integer, allocatable :: group(:), row(:)
  end type driver_source_t

  !> Drivers of the points of a group.
  type :: drivers_t
    !> At the start and at the end of the step (ndriver, 2, npoint, nelem); no rows where the law has none but the temperature of
    !> its body. With a third plane where states that follow an unknown temperature drive it, and with a fourth where its stress
    !> drives heat that is solved for together with it (driver_slopes).
    real(wp), allocatable :: value(:, :, :, :)
    type(driver_source_t), allocatable :: source(:)
    !> They change within a step.
    logical :: vary = .false.
    !> Measures of the stress at the end of the step that are handed over from one turn of the solves to the next (ndriver, npoint,
    !> nelem); not allocated where drivers follow the stress as it is tried.
    real(wp), allocatable :: handed(:, :, :)
    !> Of contact: group and element of the body behind each side, and its side 1 to 4 (nelem).
    integer, allocatable :: body(:), element(:), side(:)
    !> Of heat through contact with a deformable die: the same behind each of its pieces (npiece).
    integer, allocatable :: die_body(:), die_element(:), die_side(:)
  end type drivers_t

contains

  !> Where the drivers of all groups come from. A name that nothing in the scene has is an error of the deck (missing_driver).
  subroutine find_drivers(scene, laws, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                        !! (nlaw)
    type(drivers_t), allocatable, intent(out) :: drivers(:)   !! (ngroup)
    integer :: g, k, n, law

    allocate (drivers(size(scene%groups)))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        n = 0
        law = 0
        if (group%role == role_heat_contact) then
          call drive_heat_contact(scene, g, drivers(g))
          cycle
        end if
        if (group%material > 0) then
          law = scene%materials(group%material)%law_id
          n = driver_count(laws(law))
          if (n == 1 .and. group%role /= role_contact) n = 0
        end if
        allocate (drivers(g)%value(n, 2, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
        allocate (drivers(g)%source(n))
        if (n == 0) cycle
        if (group%role == role_contact) then
          call find_bodies_behind(scene, group%connectivity(2, :), drivers(g)%body, drivers(g)%element, drivers(g)%side)
          drivers(g)%source(driver_temperature) = source_of(scene, g, temperature_field)
        end if
        do k = 2, n
          if (is_asked_for(scene, g, laws(law)%drivers(k - 1))) &
            drivers(g)%source(k) = source_of(scene, g, laws(law)%drivers(k - 1)%name)
        end do
        if (follows_temperature(scene, laws, g, drivers(g)%source)) then
          deallocate (drivers(g)%value)
          allocate (drivers(g)%value(n, 3, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
        else if (n >= nmeasure .and. stresses_heat(scene, laws, g)) then
          deallocate (drivers(g)%value)
          allocate (drivers(g)%value(n, 4, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
        end if
        drivers(g)%vary = any(drivers(g)%source%kind == from_field .or. drivers(g)%source%kind == from_state &
                               .or. drivers(g)%source%kind == from_stress)
        if (allocated(drivers(g)%body)) &
          drivers(g)%vary = drivers(g)%vary .or. any(scene%groups(drivers(g)%body)%temperature_multiplier > 0)
      end associate
    end do
  end subroutine find_drivers

  !> A body is driven by states of a formulation of heat that is solved together with it.
  pure function follows_temperature(scene, laws, g, sources) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g
    type(driver_source_t), intent(in) :: sources(:)
    logical :: yes
    integer :: k

    yes = .false.
    if (scene%strategy%coupling /= coupling_monolithic .or. .not. is_solid(scene%groups(g))) return
    do k = 1, size(sources)
      if (sources(k)%kind /= from_state) cycle
      associate (other => scene%groups(sources(k)%group(host_of(scene, g))))
        yes = yes .or. associated(laws(scene%materials(other%material)%law_id)%release)
      end associate
    end do
  end function follows_temperature

  !> The drivers have a third plane: they are states that others find in the same iteration.
  pure function with_slopes(drivers) result(yes)
    type(drivers_t), intent(in) :: drivers
    logical :: yes

    yes = size(drivers%value, 2) == 3
  end function with_slopes

  !> The drivers have a fourth plane: heat by the measures of the stress, in their order (stress_measures).
  pure function drives_heat(drivers) result(yes)
    type(drivers_t), intent(in) :: drivers
    logical :: yes

    yes = size(drivers%value, 2) == 4
  end function drives_heat

  !> The stress of a body drives a formulation of heat that is solved together with it.
  pure function stresses_heat(scene, laws, g) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g   !! number of the group
    logical :: yes
    integer :: k

    yes = .false.
    if (scene%strategy%coupling /= coupling_monolithic .or. .not. is_solid(scene%groups(g))) return
    do k = 1, size(scene%groups)
      if (k == g .or. scene%groups(k)%material == 0 .or. host_of(scene, k) /= g) cycle
      associate (law => laws(scene%materials(scene%groups(k)%material)%law_id))
        if (law%kind == heat_law .and. associated(law%release)) yes = yes .or. is_stressed(scene, laws, k)
      end associate
    end do
  end function stresses_heat

  !> What drives the points of heat through a contact; nothing in scenes of heat alone.
  pure subroutine drive_heat_contact(scene, g, drivers)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(drivers_t), intent(inout) :: drivers
    integer :: k, n, v

    associate (group => scene%groups(g))
      n = merge(at_die_effusivity, 0, group%host > 0)
      allocate (drivers%value(n, 2, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
      allocate (drivers%source(n))
      drivers%vary = n > 0
      if (n == 0) return
      do k = at_status, at_corner_place
        v = find_variable(scene%groups(group%host)%variables, trim(of_contact(k)))
        if (v == 0) cycle
        drivers%source(k)%kind = from_state
        allocate (drivers%source(k)%group(size(scene%groups)), drivers%source(k)%row(size(scene%groups)), source=0)
        drivers%source(k)%group(group%host) = group%host
        drivers%source(k)%row(group%host) = scene%groups(group%host)%variables(v)%first
      end do
      if (.not. group%heat_contact%friction > 0 .or. group%heat_contact%share >= 0) return
      call find_bodies_behind(scene, group%connectivity(2, :), drivers%body, drivers%element, drivers%side)
      if (allocated(scene%dies(group%die)%nodes)) &
        call find_bodies_behind(scene, scene%dies(group%die)%nodes(2, :), drivers%die_body, drivers%die_element, drivers%die_side)
      drivers%source([at_body_effusivity, at_die_effusivity])%kind = from_effusivity
    end associate
  end subroutine drive_heat_contact

  !> The first driver that the law of a group needs and nothing in the scene gives, '' where there is none.
  pure function missing_driver(scene, laws, g) result(name)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: g             !! number of the group
    character(len=:), allocatable :: name
    type(driver_source_t) :: source
    integer :: k

    name = ''
    if (scene%groups(g)%material == 0) return
    associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
      do k = 1, driver_count(law) - 1
        if (.not. is_asked_for(scene, g, law%drivers(k))) cycle
        source = source_of(scene, g, law%drivers(k)%name)
        if (source%kind /= from_nothing) cycle
        name = law%drivers(k)%name
        return
      end do
    end associate
  end function missing_driver

  !> The first driver of a law for solids that is a state of another formulation whose law is driven by the stress of this one, ''
  !> where there is none.
  pure function driver_of_others(scene, laws, g) result(name)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: g             !! number of the group
    character(len=:), allocatable :: name
    type(driver_source_t) :: source
    integer :: k

    name = ''
    if (scene%groups(g)%material == 0) return
    associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
      if (law%kind /= solid_law) return
      do k = 1, driver_count(law) - 1
        source = source_of(scene, g, law%drivers(k)%name)
        if (source%kind /= from_state) cycle
        if (.not. is_stressed(scene, laws, source%group(host_of(scene, g)))) cycle
        name = law%drivers(k)%name
        return
      end do
    end associate
  end function driver_of_others

  !> The law of a group is driven by stress.
  pure function is_stressed(scene, laws, g) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g
    logical :: yes
    integer :: k

    yes = .false.
    associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
      do k = 1, driver_count(law) - 1
        if (is_asked_for(scene, g, law%drivers(k))) yes = yes .or. place_of_measure(law%drivers(k)%name) > 0
      end do
    end associate
  end function is_stressed

  !> The material of a group has the number for which its law needs a driver.
  pure function is_asked_for(scene, g, driver) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! place of the group
    type(driver_t), intent(in) :: driver
    logical :: yes

    yes = driver%needs == 0
    if (.not. yes) yes = has_number(scene%materials(scene%groups(g)%material), driver%needs)
  end function is_asked_for

  !> Bodies behind sides, by the nodes in the middle of these: group, element, and its side 1 to 4.
  pure subroutine find_bodies_behind(scene, middles, body, element, side)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: middles(:)                                  !! (nside)
    integer, allocatable, intent(out) :: body(:), element(:), side(:)  !! (nside)
    integer :: owner(3, size(scene%mesh%coordinates, 2)), g, e, k

    owner = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 4
          owner(:, scene%groups(g)%connectivity(4 + k, e)) = [g, e, k]
        end do
      end do
    end do
    body = owner(1, middles)
    element = owner(2, middles)
    side = owner(3, middles)
  end subroutine find_bodies_behind

  !> Source of a name for a group.
  pure function source_of(scene, g, name) result(source)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    character(len=*), intent(in) :: name
    type(driver_source_t) :: source
    integer :: k, v, f

    if (scene%groups(g)%role == role_contact .and. name == flow_name) then
      source%kind = from_flow
      return
    end if
    f = find_field(scene%fields, name)
    if (f > 0) then
      if (is_scalar(scene%fields(f))) then
        source%kind = from_field
        source%field = f
        return
      end if
    end if
    allocate (source%group(size(scene%groups)), source%row(size(scene%groups)), source=0)
    v = find_variable(scene%groups(g)%variables, name)
    if (v > 0 .and. scene%groups(g)%role /= role_contact) then
      source%kind = from_itself
      source%row(g) = scene%groups(g)%variables(v)%first
      return
    end if
    source%measure = place_of_measure(name)
    do k = 1, size(scene%groups)
      if (k == g .or. scene%groups(k)%role == role_contact) cycle
      if (source%measure > 0 .and. scene%groups(g)%role /= role_contact .and. host_of(scene, k) == host_of(scene, g)) then
        v = find_variable(scene%groups(k)%variables, 'stress')
        if (v == 0) cycle
        source%kind = from_stress
        source%group(host_of(scene, k)) = k
        source%row(host_of(scene, k)) = scene%groups(k)%variables(v)%first
        return
      end if
      v = find_variable(scene%groups(k)%variables, name)
      if (v == 0) cycle
      if (scene%groups(k)%variables(v)%ncomp > 1) cycle
      if (scene%groups(g)%role /= role_contact .and. host_of(scene, k) /= host_of(scene, g)) cycle
      source%kind = from_state
      source%group(host_of(scene, k)) = k
      source%row(host_of(scene, k)) = scene%groups(k)%variables(v)%first
    end do
  end function source_of

  !> Place of a name among the measures of a stress, 0 where it is none.
  pure function place_of_measure(name) result(place)
    character(len=*), intent(in) :: name
    integer :: place

    do place = nmeasure, 1, -1
      if (trim(measure_names(place)) == name) return
    end do
  end function place_of_measure

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

  !> Drivers of the first or the second half of a step: what changes goes straight, and states of the formulation itself are those
  !> in the middle, which the first half has left as the trial state. They hold as they are: nothing advances them.
  pure subroutine drivers_of_half(whole, groups, second, half)
    type(drivers_t), intent(in) :: whole(:)                  !! (ngroup) of the step
    type(group_state_t), intent(in) :: groups(:)             !! (ngroup) states
    logical, intent(in) :: second
    type(drivers_t), allocatable, intent(out) :: half(:)     !! (ngroup)
    integer :: g, k

    allocate (half, source=whole)
    do g = 1, size(half)
      half(g)%vary = .false.
      if (.not. allocated(half(g)%value)) cycle
      associate (value => half(g)%value)
        value(:, merge(1, 2, second), :, :) = 0.5_wp*(value(:, 1, :, :) + value(:, 2, :, :))
        do k = 1, size(half(g)%source)
          if (half(g)%source(k)%kind /= from_itself) cycle
          value(k, :, :, :) = whole(g)%value(k, :, :, :)
          if (second) value(k, 1, :, :) = groups(g)%trial(half(g)%source(k)%row(g), :, :)
        end do
      end associate
    end do
  end subroutine drivers_of_half

  !> Drivers that are states of the formulation itself, as the step has left them.
  pure subroutine own_states_at_end(own, state, g, e, values)
    type(drivers_t), intent(in) :: own
    type(group_state_t), intent(in) :: state
    integer, intent(in) :: g, e                !! numbers of the group and of the element
    real(wp), intent(inout) :: values(:, :)    !! (ndriver, npoint) [unit of each driver]
    integer :: k

    do k = 1, size(own%source)
      if (own%source(k)%kind == from_itself) values(k, :) = state%trial(own%source(k)%row(g), :, e)
    end do
  end subroutine own_states_at_end

  !> A field that can drive points: one component, on nodes.
  elemental function is_scalar(field) result(yes)
    type(field_t), intent(in) :: field
    logical :: yes

    yes = field%declared .and. field%place == on_nodes .and. field%ncomp == 1
  end function is_scalar

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
    real(wp), intent(in) :: now(:)   !! (nnode)
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

  !> Number of measures of stress that drive points, of all groups together.
  pure function stress_driver_count(drivers) result(n)
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup)
    integer :: n
    integer :: g

    n = 0
    do g = 1, size(drivers)
      if (.not. allocated(drivers(g)%source)) cycle
      n = n + count(drivers(g)%source%kind == from_stress)*size(drivers(g)%value, 3)*size(drivers(g)%value, 4)
    end do
  end function stress_driver_count

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

  !> Such measures drive the points at the end of the step from now on; with none, the stress as it is tried does.
  pure subroutine hand_over_stress(values, drivers)
    real(wp), intent(in) :: values(:)               !! (stress_driver_count), or none [stress]
    type(drivers_t), intent(inout) :: drivers(:)    !! (ngroup)
    integer :: g, k, i, n

    i = 0
    do g = 1, size(drivers)
      if (allocated(drivers(g)%handed)) deallocate (drivers(g)%handed)
      if (size(values) == 0 .or. .not. allocated(drivers(g)%source)) cycle
      if (.not. any(drivers(g)%source%kind == from_stress)) cycle
      associate (own => drivers(g))
        allocate (own%handed(size(own%value, 1), size(own%value, 3), size(own%value, 4)), source=0.0_wp)
        n = size(own%handed, 2)*size(own%handed, 3)
        do k = 1, size(own%source)
          if (own%source(k)%kind /= from_stress) cycle
          own%handed(k, :, :) = reshape(values(i + 1:i + n), [size(own%handed, 2), size(own%handed, 3)])
          i = i + n
        end do
      end associate
    end do
  end subroutine hand_over_stress

  !> Flow stress of the body behind a side, 0 where its law does not flow.
  pure function flow_behind(scene, laws, solution, own, drivers, e) result(flow)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: own, drivers(:)   !! of the contact, and of all groups
    integer, intent(in) :: e
    real(wp) :: flow   !! [stress]
    integer :: near(2), p

    flow = 0
    associate (g => own%body(e), body => scene%groups(own%body(e)))
      associate (law => laws(scene%materials(body%material)%law_id))
        if (.not. associated(law%flow_stress)) return
        near = nearest_points(body%rule%n, own%side(e))
        block
          real(wp) :: given(driver_count(law))

          do p = 1, 2
            if (size(given) > 1) given(2:) = drivers(g)%value(2:, 1, near(p), own%element(e))
            given(driver_temperature) = mean_temperature(scene, solution, body, own%element(e))
            flow = flow + 0.5_wp*law%flow_stress(scene%materials(body%material), given, &
                                                 solution%groups(g)%committed(first_history:, near(p), own%element(e)))
          end do
        end block
      end associate
    end associate
  end function flow_behind

  !> Effusivity of a die at the points of a side: the number of a rigid one, or that of the bodies behind the facing pieces.
  pure function effusivity_of_die(scene, laws, solution, own, drivers, g, e) result(values)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: own, drivers(:)   !! of the group, and of all groups
    integer, intent(in) :: g, e
    real(wp) :: values(scene%groups(g)%rule%n)
    integer :: p, piece

    values = scene%groups(g)%heat_contact%effusivity
    if (.not. allocated(own%die_body)) return
    do p = 1, size(values)
      piece = nint(own%value(at_die_piece, 1, p, e))
      values(p) = 0
      if (piece > 0) values(p) = effusivity(scene, laws, solution, drivers, own%die_body(piece), own%die_element(piece), &
                                            own%die_side(piece))
    end do
  end function effusivity_of_die

  !> sqrt(conductivity times heat capacity) of a body behind a side at the mean temperature of its element, 0 where it has none.
  pure function effusivity(scene, laws, solution, drivers, body, element, side) result(b)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: drivers(:)
    integer, intent(in) :: body, element, side
    real(wp) :: b   !! [power time^(1/2)/area/temperature]
    real(wp) :: conductivity(1), slope(1), taken(1), capacity(1)
    integer :: g, near(2)

    b = 0
    near = nearest_points(scene%groups(body)%rule%n, side)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0 .or. host_of(scene, g) /= body) cycle
      associate (material => scene%materials(scene%groups(g)%material))
        if (laws(material%law_id)%kind /= heat_law) cycle
        block
          real(wp) :: given(driver_count(laws(material%law_id)), 1)

          given = 0
          if (size(given, 1) > 1 .and. size(drivers(g)%value, 1) == size(given, 1)) &
            given(2:, 1) = drivers(g)%value(2:, 1, near(1), element)
          given(driver_temperature, 1) = mean_temperature(scene, solution, scene%groups(body), element)
          call laws(material%law_id)%conduct(material, given, conductivity, slope)
          call laws(material%law_id)%store(material, given, given, taken, capacity)
        end block
        b = sqrt(conductivity(1)*capacity(1))
      end associate
    end do
  end function effusivity

  !> What a TEMPE card gives, or the mean of the field over the corners of the element.
  pure function mean_temperature(scene, solution, body, element) result(temperature)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(group_t), intent(in) :: body
    integer, intent(in) :: element
    real(wp) :: temperature   !! [temperature]
    integer :: f

    temperature = 0
    f = find_field(solution%fields, temperature_field)
    if (f > 0) temperature = 0.25_wp*sum(solution%fields(f)%value(1, body%connectivity(1:4, element)))
    if (body%temperature_multiplier > 0) temperature = given_temperature(scene, body, solution%time)
  end function mean_temperature

  !> What a TEMPE card gives to a body.
  pure function given_temperature(scene, body, time) result(temperature)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: body
    real(wp), intent(in) :: time
    real(wp) :: temperature   !! [temperature]

    temperature = body%temperature_amplitude*multiplier_at(scene%multipliers(body%temperature_multiplier), time)
  end function given_temperature

  !> The two integration points of the square nearest to a side (1: eta = -1, 2: xi = 1, 3: eta = 1, 4: xi = -1), apart from the
  !> middle one of a row of three.
  pure function nearest_points(npoint, side) result(near)
    integer, intent(in) :: npoint, side
    integer :: near(2)
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: depth(npoint), along(npoint)

    call square_rule(npoint, xi, weight)
    depth = merge(-1, 1, side == 1 .or. side == 4)*xi(merge(2, 1, mod(side, 2) == 1), :)
    along = xi(merge(1, 2, mod(side, 2) == 1), :)
    near = [maxloc(depth + 0.1_wp*along, 1), maxloc(depth - 0.1_wp*along, 1)]
  end function nearest_points

end module point_drivers
