!> State of the body behind a side: flow stress, effusivity, temperature, at the accepted state.
module state_behind_sides
  use drivers, only: at_die_piece, drivers_t
  use fields, only: find_field
  use kinds, only: wp
  use kinematics_api, only: first_history
  use law_api, only: driver_count, driver_temperature, heat_law, law_t
  use loads, only: multiplier_at
  use point_temperatures, only: temperature_field
  use quadrature, only: square_rule
  use scene, only: group_t, host_of, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: flow_behind, effusivity_of_die, effusivity, given_temperature, mean_temperature, nearest_points

contains

  !> Flow stress of the body behind a side, 0 where its law does not flow.
  pure function flow_behind(scene, laws, solution, own, drivers, e) result(flow)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: own, drivers(:)   !! of the contact, and of all groups (ngroup)
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
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: own, drivers(:)   !! of the group, and of all groups (ngroup)
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
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup)
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
          if (size(given, 1) > 1 .and. size(drivers(g)%value, 1) >= size(given, 1)) &
            given(2:, 1) = drivers(g)%value(2:size(given, 1), 1, near(1), element)
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

end module state_behind_sides
