!> Where the drivers of the points of each group come from: fields, states of other formulations, stress, the body behind.
module driver_sources
  use bodies_behind, only: find_bodies_behind
  use driver_lookup, only: is_asked_for, is_stressed, source_of
  use drivers, only: at_body_effusivity, at_corner_place, at_die_effusivity, at_handed, at_status, driver_source_t, drivers_t, &
                     from_effusivity, from_field, from_nothing, from_state, from_stress, from_stretch, from_unloading, &
                     heat_contact_drivers, not_handed, of_contact, planes_of_heat
  use heat_sources, only: work_name
  use kinds, only: wp
  use law_api, only: driver_count, driver_temperature, heat_law, law_t
  use point_temperatures, only: temperature_field
  use scene, only: host_of, is_solid, plane_stress, role_contact, role_heat_contact, role_volume_load, scene_t
  use state_variables, only: find_variable
  use strategy, only: coupling_monolithic
  use stress_measures, only: nmeasure
  implicit none
  private
  public :: find_drivers

contains

  !> Where the drivers of all groups come from. A name that nothing in the scene has is an error of the deck (missing_driver).
  subroutine find_drivers(scene, laws, drivers)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                        !! (nlaw)
    type(drivers_t), allocatable, intent(out) :: drivers(:)   !! (ngroup)
    integer :: g, k, n, m, law

    allocate (drivers(size(scene%groups)))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        n = 0
        m = 0
        law = 0
        if (group%role == role_heat_contact) then
          call drive_heat_contact(scene, g, drivers(g))
          cycle
        end if
        if (group%material > 0) then
          law = scene%materials(group%material)%law_id
          n = driver_count(laws(law))
          if (n == 1 .and. group%role /= role_contact) n = 0
          m = n
          if (is_heated_by_work(scene, g, laws(law))) m = n + 1
          if (laws(law)%kind == heat_law .and. stretching_group(scene, g) > 0) m = n + 1
        else if (group%role == role_volume_load .and. group%brings_heat .and. stretching_group(scene, g) > 0) then
          m = 1
        end if
        allocate (drivers(g)%value(m, 2, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
        allocate (drivers(g)%source(m))
        if (m > n) then
          if (stretching_group(scene, g) > 0) then
            drivers(g)%source(m) = source_of_stretch(scene, g)
          else
            drivers(g)%source(m) = source_of_unloading(scene, source_of(scene, g, work_name))
          end if
          drivers(g)%value(m, :, :, :) = 1
        end if
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
          allocate (drivers(g)%value(n, planes_of_heat, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
        end if
        drivers(g)%vary = any(drivers(g)%source%kind == from_field .or. drivers(g)%source%kind == from_state &
                               .or. drivers(g)%source%kind == from_stress)
        if (allocated(drivers(g)%body)) &
          drivers(g)%vary = drivers(g)%vary .or. any(scene%groups(drivers(g)%body)%temperature_multiplier > 0)
      end associate
    end do
  end subroutine find_drivers

  !> Plastic work becomes heat in a group.
  pure function is_heated_by_work(scene, g, law) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    type(law_t), intent(in) :: law
    logical :: yes
    integer :: k

    yes = .false.
    if (law%kind /= heat_law) return
    do k = 1, driver_count(law) - 1
      if (law%drivers(k)%name == work_name) yes = is_asked_for(scene, g, law%drivers(k))
    end do
  end function is_heated_by_work

  !> The formulation on the elements of a group whose points stretch across the plane in large strain, 0 for none.
  pure function stretching_group(scene, g) result(group)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    integer :: group
    integer :: k

    group = 0
    if (.not. (scene%finite .and. scene%plane_state == plane_stress)) return
    do k = 1, size(scene%groups)
      if (host_of(scene, k) == host_of(scene, g) .and. find_variable(scene%groups(k)%variables, 'stretch_zz') > 0) group = k
    end do
  end function stretching_group

  !> The stretch across the plane of the body that a group is a formulation on.
  pure function source_of_stretch(scene, g) result(source)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    type(driver_source_t) :: source

    source%kind = from_stretch
    allocate (source%group(size(scene%groups)), source%row(size(scene%groups)), source=0)
    associate (k => stretching_group(scene, g), body => host_of(scene, g))
      source%group(body) = k
      source%row(body) = scene%groups(k)%variables(find_variable(scene%groups(k)%variables, 'stretch_zz'))%first
    end associate
  end function source_of_stretch

  !> Elastic strain where plastic work is.
  pure function source_of_unloading(scene, work) result(source)
    type(scene_t), intent(in) :: scene
    type(driver_source_t), intent(in) :: work   !! of plastic work
    type(driver_source_t) :: source
    integer :: body, v

    source = work
    source%kind = from_nothing
    if (work%kind /= from_state) return
    do body = 1, size(work%group)
      if (work%group(body) == 0) cycle
      associate (variables => scene%groups(work%group(body))%variables)
        v = find_variable(variables, 'elastic_strain')
        if (v == 0) cycle
        source%kind = from_unloading
        source%row(body) = variables(v)%first
      end associate
    end do
  end function source_of_unloading

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
      n = merge(heat_contact_drivers, 0, group%host > 0)
      allocate (drivers%value(n, 2, group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
      allocate (drivers%source(n))
      drivers%vary = n > 0
      drivers%is_of_heat_contact = n > 0
      if (n == 0) return
      drivers%value(at_handed:, :, :, :) = not_handed
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

end module driver_sources
