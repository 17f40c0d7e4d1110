!> Drivers by name: what in the scene has a name that a law asks for, and what nothing has.
module driver_lookup
  use drivers, only: driver_source_t, flow_name, from_field, from_flow, from_itself, from_nothing, from_state, from_stress, &
                     is_scalar
  use fields, only: find_field
  use law_api, only: driver_count, driver_t, law_t, solid_law
  use materials, only: has_number
  use scene, only: host_of, role_contact, scene_t
  use state_variables, only: find_variable
  use stress_measures, only: measure_names, nmeasure
  implicit none
  private
  public :: driver_of_others, is_asked_for, is_stressed, missing_driver, source_of

contains

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

  !> The first driver of a law for solids that is a state of another formulation whose law is driven by the stress or a state of
  !> this one, '' where there is none.
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
        if (.not. is_driven_by(scene, laws, source%group(host_of(scene, g)), g)) cycle
        name = law%drivers(k)%name
        return
      end do
    end associate
  end function driver_of_others

  !> The law of a group is driven by the stress or a state of a body.
  pure function is_driven_by(scene, laws, g, body) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g      !! number of the group
    integer, intent(in) :: body   !! that of the body
    logical :: yes
    type(driver_source_t) :: source
    integer :: k

    yes = is_stressed(scene, laws, g)
    associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
      do k = 1, driver_count(law) - 1
        if (.not. is_asked_for(scene, g, law%drivers(k))) cycle
        source = source_of(scene, g, law%drivers(k)%name)
        if (source%kind == from_state) yes = yes .or. source%group(body) == body
      end do
    end associate
  end function is_driven_by

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

end module driver_lookup
