!> Heat of work that was done after the last temperatures were found: friction and plastic work of a step with SOLVE ONCE becomes
!> heat in the next one. Until then friction keeps it at its points (`friction_due`), plastic work as the difference of what was
!> done and what has become heat (`work_heated`), and what an operation has left to the next one is kept in its bodies (`heat_due`).
module pending_heat
  use drivers, only: drivers_t
  use elem_heat_contact, only: name_of_due
  use fields, only: find_field, section_field
  use heat_sources, only: share_of_work, work_heated, work_name
  use kinds, only: wp
  use law_api, only: driver_count, driver_temperature, find_parameter, heat_law, law_t
  use point_temperatures, only: temperature_field
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use quadrature, only: line_rule
  use scene, only: plane_stress, role_heat_contact, scene_t
  use sections, only: thickness_at
  use side_points, only: area_at
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable, name_of_heat_due, name_of_ratio
  implicit none
  private
  public :: first_of, heat_of_friction, heat_of_work, pending, pending_temperature, volumes_at_start

contains

  !> All of it in a scene at an accepted instant.
  function pending(scene, laws, drivers, solution) result(heat)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)          !! (nlaw)
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup) of the instant
    type(solution_t), intent(in) :: solution
    real(wp) :: heat                            !! per radian when axisymmetric [energy]
    integer :: g, e, row

    heat = 0
    do g = 1, size(scene%groups)
      heat = heat + sum(heat_of_friction(scene, solution, g)) + sum(heat_of_work(scene, laws, drivers, solution, g))
      row = first_of(scene, g, name_of_heat_due)
      if (row == 0) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        heat = heat + dot_product(volumes_at_start(scene, solution, g, e), solution%groups(g)%committed(row, :, e))
      end do
    end do
  end function pending

  !> What the plastic work among it would warm the bodies by, in the mean square of the volume at the start: by so much temperatures
  !> are behind.
  function pending_temperature(scene, laws, drivers, solution) result(mean)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)          !! (nlaw)
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup) of the instant
    type(solution_t), intent(in) :: solution
    real(wp) :: mean   !! [temperature]
    type(quad8_rule_t) :: rule
    real(wp) :: square, whole
    integer :: g, e, f

    mean = 0
    f = find_field(solution%fields, temperature_field)
    if (f == 0) return
    square = 0
    whole = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      associate (group => scene%groups(g), material => scene%materials(scene%groups(g)%material), &
                 law => laws(scene%materials(scene%groups(g)%material)%law_id))
        if (law%kind /= heat_law) cycle
        call quad8_rule(group%rule%n, rule)
        block
          real(wp) :: heat(group%rule%n, size(group%connectivity, 2)), given(driver_count(law), group%rule%n)
          real(wp), dimension(group%rule%n) :: volume, taken, capacity

          heat = heat_of_work(scene, laws, drivers, solution, g)
          do e = 1, size(heat, 2)
            volume = volumes_at_start(scene, solution, g, e)
            whole = whole + sum(volume)
            if (.not. any(heat(:, e) > 0)) cycle
            given = 0
            if (size(drivers(g)%value, 1) >= size(given, 1)) given = drivers(g)%value(:size(given, 1), 1, :, e)
            given(driver_temperature, :) = matmul(solution%fields(f)%value(1, group%connectivity(:, e)), rule%phi(:, :rule%npoint))
            call law%store(material, given, given, taken, capacity)
            square = square + sum((heat(:, e)/(capacity*volume))**2*volume)
          end do
        end block
      end associate
    end do
    if (whole > 0) mean = sqrt(square/whole)
  end function pending_temperature

  !> Of friction at the points of a group; nothing where it is no heat through contact with FRIC.
  pure function heat_of_friction(scene, solution, g) result(heat)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g                  !! place of the group
    real(wp), allocatable :: heat(:, :)       !! (npoint, nside) per radian when axisymmetric [energy]
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), section(3)
    integer :: e, p, row

    associate (group => scene%groups(g))
      allocate (heat(group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
      row = first_of(scene, g, name_of_due)
      if (group%role /= role_heat_contact .or. row == 0) return
      call line_rule(group%rule, xi, weight)
      x = present_coordinates(scene, solution)
      section = scene%section
      if (scene%finite) section = solution%fields(section_field)%value(:, 1)
      do e = 1, size(heat, 2)
        do p = 1, size(heat, 1)
          heat(p, e) = group%heat_contact%friction*solution%groups(g)%committed(row, p, e) &
                       *weight(p)*area_at(xi(p), section, x(:, group%connectivity(1:3, e)))
        end do
      end do
    end associate
  end function heat_of_friction

  !> Of plastic work at the points of a group; nothing where its law has no QUINNEY.
  function heat_of_work(scene, laws, drivers, solution, g) result(heat)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)          !! (nlaw)
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup) of the instant
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g                    !! place of the group
    real(wp), allocatable :: heat(:, :)         !! (npoint, nelem) per radian when axisymmetric [energy]
    type(quad8_rule_t) :: rule
    real(wp) :: volume(scene%groups(g)%rule%n), temperature
    integer :: e, p, heated, done, n, place

    associate (group => scene%groups(g))
      allocate (heat(group%rule%n, size(group%connectivity, 2)), source=0.0_wp)
      heated = first_of(scene, g, work_heated)
      if (heated == 0 .or. group%host == 0) return
      done = first_of(scene, group%host, work_name)
      if (done == 0) return
      associate (material => scene%materials(group%material), law => laws(scene%materials(group%material)%law_id))
        n = driver_count(law)
        place = find_parameter(law, 'QUINNEY')
        call quad8_rule(group%rule%n, rule)
        do e = 1, size(heat, 2)
          volume = volumes_of_work(scene, solution, g, e)
          if (size(drivers(g)%value, 1) > n .and. .not. (scene%finite .and. scene%plane_state == plane_stress)) &
            volume = volume*drivers(g)%value(n + 1, 1, :, e)
          do p = 1, size(heat, 1)
            temperature = dot_product(rule%phi(:, p), solution%fields(find_field(solution%fields, temperature_field)) &
                                      %value(1, group%connectivity(:, e)))
            heat(p, e) = volume(p)*share_of_work(material, place, temperature) &
                         *(solution%groups(group%host)%committed(done, p, e) - solution%groups(g)%committed(heated, p, e))
          end do
        end do
      end associate
    end associate
  end function heat_of_work

  !> Volumes that plastic work is per (elem_pl8tm), but for elastic strain.
  pure function volumes_of_work(scene, solution, g, e) result(volume)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, e                    !! place of the group, element
    real(wp) :: volume(scene%groups(g)%rule%n)     !! [volume]
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))

    if (scene%finite .and. scene%plane_state == plane_stress) then
      volume = volumes_at_start(scene, solution, g, e)
    else if (scene%finite) then
      x = present_coordinates(scene, solution)
      volume = volumes_at(scene, g, x(:, scene%groups(g)%connectivity(:, e)), solution%fields(section_field)%value(:, 1))
    else
      volume = volumes_at(scene, g, scene%mesh%coordinates(:, scene%groups(g)%connectivity(:, e)), scene%section)
    end if
  end function volumes_of_work

  !> Volumes of the points of an element at the start of the scene: heat contents are per these.
  pure function volumes_at_start(scene, solution, g, e) result(volume)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, e                    !! place of the group, element
    real(wp) :: volume(scene%groups(g)%rule%n)     !! [volume]
    integer :: row

    volume = volumes_at(scene, g, scene%mesh%coordinates(:, scene%groups(g)%connectivity(:, e)), scene%section)
    row = first_of(scene, g, name_of_ratio)
    if (row > 0) volume = volume/solution%groups(g)%committed(row, :, e)
  end function volumes_at_start

  pure function volumes_at(scene, g, x, section) result(volume)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                       !! place of the group
    real(wp), intent(in) :: x(2, 8), section(3)    !! nodes of an element [length]; thickness at the origin [length], its slopes [-]
    real(wp) :: volume(scene%groups(g)%rule%n)     !! [volume]
    type(quad8_rule_t) :: rule
    real(wp) :: nx(8), ny(8), detj
    integer :: p

    call quad8_rule(scene%groups(g)%rule%n, rule)
    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      volume(p) = detj*rule%weight(p)*thickness_at(section, matmul(x, rule%phi(:, p)))
    end do
  end function volumes_at

  !> First component of a variable of a group, 0 where it has none of the name.
  pure function first_of(scene, g, name) result(row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! place of the group
    character(len=*), intent(in) :: name
    integer :: row

    row = find_variable(scene%groups(g)%variables, name)
    if (row > 0) row = scene%groups(g)%variables(row)%first
  end function first_of

end module pending_heat
