!> `history.csv`: one row per accepted step. Forces and energies are those of the full circumference
!> when the scene is axisymmetric.
module history
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use csv_writer, only: csv_t
  use dies, only: is_deformable
  use elem_api, only: totals_t
  use errors, only: error_t
  use fields, only: displacement_field, find_field, pilot_field, section_field
  use heat_books, only: has_heat, heat_imbalance
  use heat_flows, only: heat_flow_names
  use history_columns, only: columns_of_die_heat, columns_of_steps
  use kinds, only: pi, wp
  use path_record, only: motion_error, stress_error
  use placed_walls, only: reaction_beside
  use point_volumes, only: volumes_of_points
  use probes, only: probe_maximum, probe_mean, probe_minimum, probe_node, probe_point, probe_reaction, probe_t
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: axisymmetric, generalised_plane_strain, scene_t
  use solution, only: present_coordinates, solution_t
  use step_outcome, only: outcome_t
  use stress_measures, only: stress_measure
  use text, only: add_text, string_t
  implicit none
  private
  public :: open_history, write_row, circumference, add_columns

contains

  !> Factor from per radian to the full circumference.
  pure function circumference(scene) result(factor)
    type(scene_t), intent(in) :: scene
    real(wp) :: factor

    factor = merge(2*pi, 1.0_wp, scene%plane_state == axisymmetric)
  end function circumference

  !> Begin the table, or take it up again after the step of a checkpoint. With operations it has the columns of all of them.
  subroutine open_history(scene, solution, path, resume, all_columns, table, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: path
    logical, intent(in) :: resume
    type(string_t), allocatable, intent(in) :: all_columns(:)   !! (n) of a deck with operations
    type(csv_t), intent(inout) :: table
    type(error_t), allocatable, intent(out) :: error
    type(string_t), allocatable :: columns(:), own(:)
    integer :: k

    call name_columns(scene, columns)
    if (allocated(all_columns)) then
      call move_alloc(columns, own)
      allocate (columns, source=all_columns)
    end if
    if (resume) then
      call table%resume(path, columns, solution%step, error)
    else
      call table%create(path, columns, error)
    end if
    if (allocated(own)) call table%take_columns([(place_among(columns, own(k)%s), k=1, size(own))])
  end subroutine open_history

  !> Columns of a scene that the list does not have yet are added to it.
  subroutine add_columns(scene, columns)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: columns(:)   !! (n)
    type(string_t), allocatable :: own(:)
    integer :: k

    call name_columns(scene, own)
    if (.not. allocated(columns)) allocate (columns(0))
    do k = 1, size(own)
      if (place_among(columns, own(k)%s) == 0) columns = [columns, own(k:k)]
    end do
  end subroutine add_columns

  !> Place of a name in a list, 0 where it is not.
  pure function place_among(names, name) result(k)
    type(string_t), intent(in) :: names(:)   !! (n)
    character(len=*), intent(in) :: name
    integer :: k

    do k = size(names), 1, -1
      if (names(k)%s == name) return
    end do
  end function place_among

  subroutine name_columns(scene, columns)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: columns(:)
    type(string_t), allocatable :: flows(:)
    integer :: k

    allocate (flows, source=heat_flow_names(scene))
    call columns_of_steps(scene, has_heat(scene), .false., columns)
    do k = 1, size(flows)
      call add_text(columns, 'heat_through_'//flows(k)%s//' [power]')
    end do
    do k = 1, size(scene%die_heats)
      call columns_of_die_heat(scene%dies(scene%die_heats(k)%die)%name, columns)
    end do
    do k = 1, size(scene%probes)
      call add_text(columns, scene%probes(k)%name//' ['//scene%probes(k)%unit//']')
    end do
  end subroutine name_columns

  !> The row of the step just accepted. A die's force is what the part does to it.
  subroutine write_row(scene, solution, outcome, totals, table, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    type(totals_t), intent(in) :: totals
    type(csv_t), intent(inout) :: table
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: factor
    integer :: k

    factor = circumference(scene)
    call table%put(solution%time)
    call table%put([solution%step])
    if (scene%operation > 0) call table%put([scene%operation])
    call table%put(solution%last_step)
    call table%put([outcome%iterations, solution%cutbacks])
    call table%put(outcome%strain)
    ! what flow dissipates is added up: a body that cools afterwards, or is cut, does not take it back
    call table%put(factor*[solution%external_work, totals%elastic_energy, solution%work%flow, totals%friction_work])
    call table%put([totals%volume/solution%initial_volume - 1, totals%max_penetration])
    call table%put([totals%stick, totals%slip])
    if (scene%load_factor%multiplier > 0) &
      call table%put(solution%fields(find_field(solution%fields, 'load_factor'))%value(1, 1))
    do k = 1, size(scene%dies)
      if (scene%dies(k)%unasked) cycle
      call table%put(-factor*solution%fields(pilot_field)%applied(:, k))
      if (.not. is_deformable(scene%dies(k))) call table%put(solution%fields(pilot_field)%value(:, k) - scene%dies(k)%pilot)
    end do
    if (scene%plane_state == generalised_plane_strain) then
      call table%put((solution%fields(section_field)%value(:, 1) - scene%section)/scene%section(1))
      call table%put(solution%fields(section_field)%applied(:, 1))
    end if
    if (scene%follows_path) call table%put([motion_error(solution%path), stress_error(solution%path)])
    if (scene%remesh%estimate) call table%put([solution%estimate%stress, solution%estimate%strain])
    if (has_heat(scene)) then
      call table%put(factor*[solution%heat_stored, solution%heat_in, solution%heat_released])
      call table%put(heat_imbalance(solution))
    end if
    if (has_heat(scene)) call table%put(factor*solution%heat_flows)
    do k = 1, size(scene%die_heats)
      call table%put(temperature_and_flow(scene, solution, k)*[1.0_wp, factor])
    end do
    do k = 1, size(scene%probes)
      call table%put(probe_value(scene, solution, scene%probes(k)))
    end do
    call table%end_row()
    call table%status(error)
  end subroutine write_row

  !> Temperature of a rigid die, and the heat flow into it in the step: what it takes up, or what leaves it again where its
  !> temperature is given.
  pure function temperature_and_flow(scene, solution, k) result(values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: k   !! place among the temperatures of dies
    real(wp) :: values(2)      !! [temperature], [power, per radian when axisymmetric]

    associate (heat => scene%die_heats(k), field => solution%fields(find_field(solution%fields, 'die_temperature')))
      values = [field%value(1, heat%die), -field%reaction(1, heat%die)]
      if (heat%capacity > 0) values(2) = heat%capacity*field%last_increment(1, heat%die)/solution%last_step
    end associate
  end function temperature_and_flow

  !> What a probe reads at the accepted instant.
  pure function probe_value(scene, solution, probe) result(value)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(probe_t), intent(in) :: probe
    real(wp) :: value

    value = 0
    if (probe%is_gone) then
      value = ieee_value(value, ieee_quiet_nan)
      return
    end if
    select case (probe%kind)
    case (probe_node)
      associate (node => probe%nodes(1), c => 2 - mod(probe%quantity, 2), u => solution%fields(displacement_field)%value)
        if (probe%field > 0) then
          value = solution%fields(probe%field)%value(1, node)
        else if (probe%quantity <= 2) then
          value = u(c, node) + scene%mesh%coordinates(c, node) + probe%offset(c)
        else
          value = u(c, node) + (scene%mesh%coordinates(c, node) - scene%mesh%origin(c, node))
        end if
      end associate
    case (probe_reaction)
      associate (reaction => solution%fields(displacement_field)%reaction(probe%quantity, :))
        value = sum(reaction(probe%nodes))
        if (allocated(scene%walls)) value = value + reaction_beside(scene, present_coordinates(scene, solution), probe%quantity, &
                                                                    probe%nodes, reaction)
      end associate
    case (probe_point)
      value = state_of(solution, probe, probe%point, probe%element)
    case (probe_maximum, probe_minimum)
      value = extreme_of(scene, solution, probe)
    case (probe_mean)
      value = mean_of(scene, solution, probe)
    end select
    value = value*probe%factor
  end function probe_value

  !> Component of the state at a point, or a measure of the stress there.
  pure function state_of(solution, probe, point, element) result(value)
    type(solution_t), intent(in) :: solution
    type(probe_t), intent(in) :: probe
    integer, intent(in) :: point, element
    real(wp) :: value

    associate (state => solution%groups(probe%group)%committed(:, point, element), c => probe%component)
      if (probe%measure > 0) then
        value = stress_measure(probe%measure, state(c:c + 3))
      else
        value = state(c)
      end if
    end associate
  end function state_of

  !> The largest or smallest of that over a group, or of a field over its nodes.
  pure function extreme_of(scene, solution, probe) result(value)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(probe_t), intent(in) :: probe
    real(wp) :: value
    integer :: p, e

    if (probe%field > 0) then
      associate (values => solution%fields(probe%field)%value(1, pack(scene%groups(probe%group)%connectivity, .true.)))
        value = merge(maxval(values), minval(values), probe%kind == probe_maximum)
      end associate
      return
    end if
    associate (state => solution%groups(probe%group)%committed)
      value = merge(-huge(value), huge(value), probe%kind == probe_maximum)
      do e = 1, size(state, 3)
        do p = 1, size(state, 2)
          if (probe%kind == probe_maximum) then
            value = max(value, state_of(solution, probe, p, e))
          else
            value = min(value, state_of(solution, probe, p, e))
          end if
        end do
      end do
    end associate
  end function extreme_of

  !> The mean of that over the volume of bodies, as they stand (as they stood at the start where kinematics are SMALL).
  pure function mean_of(scene, solution, probe) result(value)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(probe_t), intent(in) :: probe
    real(wp) :: value
    type(probe_t) :: one
    real(wp) :: volume
    integer :: k

    value = 0
    volume = 0
    one = probe
    call add_integral(scene, solution, one, value, volume)
    do k = 1, size(probe%more_groups)
      one%group = probe%more_groups(k)
      one%component = probe%more_components(k)
      call add_integral(scene, solution, one, value, volume)
    end do
    value = value/volume
  end function mean_of

  !> Integral of a component over the volume of one body, and that volume.
  pure subroutine add_integral(scene, solution, probe, integral, volume)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(probe_t), intent(in) :: probe
    real(wp), intent(inout) :: integral, volume
    type(quad8_rule_t) :: rule
    real(wp), allocatable :: dv(:)
    real(wp) :: here
    integer :: p, e

    associate (group => scene%groups(probe%group))
      call quad8_rule(group%rule%n, rule)
      do e = 1, size(group%connectivity, 2)
        dv = volumes_of_points(scene, solution, rule, group%connectivity(:, e))
        do p = 1, rule%npoint
          volume = volume + dv(p)
          if (probe%field > 0) then
            here = dot_product(rule%phi(:, p), solution%fields(probe%field)%value(1, group%connectivity(:, e)))
          else
            here = state_of(solution, probe, p, e)
          end if
          integral = integral + dv(p)*here
        end do
      end do
    end associate
  end subroutine add_integral

end module history
