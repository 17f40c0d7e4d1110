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
!> both bodies, those of the accepted state, where heat of friction is shared by them. Conductances that are handed over
!> (exchange_in_turns, contact_heat_tangent) take the place of those by the pressures and gaps that contact has reached.
!>
!> Behind the drivers of a law for heat that plastic work drives is one of the element: the volume that the work is per, free of
!> elastic strain, over the volume of the point, at the start of the step. In plane stress of large strain, where work is per volume
!> at the start of the scene, it is the stretch of the thickness then, also where no plastic work becomes heat.
!>
!> Where each driver comes from is found once (`driver_sources`); its values are taken in every evaluation (`driver_values`).
module drivers
  use fields, only: field_t, on_nodes
  use kinds, only: wp
  use solution, only: group_state_t
  implicit none
  private
  public :: stress_driver_count, hand_over_stress, hand_over_conductance
  public :: from_nothing, from_field, from_state, from_flow, from_itself, &
            from_effusivity, from_stress, from_unloading, from_stretch, flow_name, at_status, at_pressure, at_gap, at_die_piece, &
            at_die_xi, at_friction_work, at_corner_work, at_corner_place, at_body_effusivity, at_die_effusivity, at_handed, &
            as_without_contact, heat_contact_drivers, not_handed, of_contact, &
            driver_source_t, drivers_t, with_slopes, drives_heat, planes_of_heat, drivers_of_half, own_states_at_end, is_scalar

  !> Where a driver comes from. A state variable of the formulation itself is that at the start of the step.
  integer, parameter :: from_nothing = 0, from_field = 1, from_state = 2, from_flow = 3, from_itself = 4, from_effusivity = 5, &
                        from_stress = 6, from_unloading = 7, from_stretch = 8
  !> Planes of drivers where stress drives heat: values at both ends of the step, one of slopes that is not used, heat, and
  !> conductivity at the instants of the flow rule, two at most.
  integer, parameter :: planes_of_heat = 6
  !> Name of the flow stress of the body behind a side.
  character(len=*), parameter :: flow_name = 'flow_stress'

  !> What drives heat through contact: state variables of the contact, effusivities, and conductances that are handed over (two
  !> numbers, heat_contacts).
  integer, parameter :: at_status = 2, at_pressure = 3, at_gap = 4, at_die_piece = 5, at_die_xi = 6, at_friction_work = 7, &
                        at_corner_work = 8, at_corner_place = 9, at_body_effusivity = 10, at_die_effusivity = 11, &
                        at_handed = 12, heat_contact_drivers = 13
  !> Nothing is handed over, or contact knows nothing of the point; and what heat had where contact knew nothing of it.
  real(wp), parameter :: not_handed = -1.0_wp, as_without_contact = -2.0_wp
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
    !> its body. With a third plane where states that follow an unknown temperature drive it, and with a fourth to sixth where its
    !> stress drives heat that is solved for together with it (driver_slopes).
    real(wp), allocatable :: value(:, :, :, :)
    type(driver_source_t), allocatable :: source(:)
    !> They change within a step.
    logical :: vary = .false.
    !> Measures of the stress at the end of the step that are handed over from one turn of the solves to the next (ndriver, npoint,
    !> nelem); not allocated where drivers follow the stress as it is tried.
    real(wp), allocatable :: handed(:, :, :)
    !> They are of heat through a contact that moves; conductances are handed over to it.
    logical :: is_of_heat_contact = .false., hands_conductance = .false.
    !> Of contact: group and element of the body behind each side, and its side 1 to 4 (nelem).
    integer, allocatable :: body(:), element(:), side(:)
    !> Of heat through contact with a deformable die: the same behind each of its pieces (npiece).
    integer, allocatable :: die_body(:), die_element(:), die_side(:)
  end type drivers_t

contains

  !> The drivers have a third plane: they are states that others find in the same iteration.
  pure function with_slopes(drivers) result(yes)
    type(drivers_t), intent(in) :: drivers
    logical :: yes

    yes = size(drivers%value, 2) == 3
  end function with_slopes

  !> The drivers have planes of heat, and of conductivity at each instant of the flow rule, by the measures of the stress, in their
  !> order (stress_measures).
  pure function drives_heat(drivers) result(yes)
    type(drivers_t), intent(in) :: drivers
    logical :: yes

    yes = size(drivers%value, 2) == planes_of_heat
  end function drives_heat

  !> Drivers of the first or the second part of a step, halves if nothing else is said: what changes goes straight, and states of
  !> the formulation itself are those in between, which the first part has left as the trial state. They hold as they are: nothing
  !> advances them.
  pure subroutine drivers_of_half(whole, groups, second, half, share)
    type(drivers_t), intent(in) :: whole(:)                  !! (ngroup) of the step
    type(group_state_t), intent(in) :: groups(:)             !! (ngroup) states
    logical, intent(in) :: second
    type(drivers_t), allocatable, intent(out) :: half(:)     !! (ngroup)
    real(wp), intent(in), optional :: share                  !! of the step, where its first part ends
    real(wp) :: at
    integer :: g, k

    at = 0.5_wp
    if (present(share)) at = share
    allocate (half, source=whole)
    do g = 1, size(half)
      half(g)%vary = .false.
      if (.not. allocated(half(g)%value)) cycle
      associate (value => half(g)%value)
        value(:, merge(1, 2, second), :, :) = (1 - at)*value(:, 1, :, :) + at*value(:, 2, :, :)
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

  !> Conductances that heat through contact has at the end of the step, or not_handed.
  pure subroutine hand_over_conductance(values, drivers)
    real(wp), intent(in) :: values(:, :, :)       !! (2, npoint, nelem), as conductance_of gives them (heat_contacts); or of no size
    type(drivers_t), intent(inout) :: drivers     !! of the group

    drivers%hands_conductance = size(values) > 0
    drivers%value(at_handed:heat_contact_drivers, 2, :, :) = not_handed
    if (size(values) > 0) drivers%value(at_handed:heat_contact_drivers, 2, :, :) = values
  end subroutine hand_over_conductance

end module drivers
