!> Names of the columns of `history.csv`, but for those of heat through boundaries and of probes. What a deck names as a column of
!> its own must be none of them.
module history_columns
  use dies, only: is_deformable
  use scene, only: generalised_plane_strain, scene_t
  use sections, only: section_loads, section_motions
  use text, only: add => add_text, string_t
  implicit none
  private
  public :: columns_of_steps, columns_of_die_heat, own_columns_named

contains

  !> Columns up to those of heat through boundaries, with their units.
  pure subroutine columns_of_steps(scene, heat, every, columns)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: heat                                   !! a body conducts heat
    logical, intent(in) :: every                                  !! those too that this scene does not have
    type(string_t), allocatable, intent(out) :: columns(:)        !! (ncolumn)
    integer :: k

    allocate (columns(0))
    call add(columns, 'time [time]')
    call add(columns, 'step [-]')
    if (every .or. scene%operation > 0) call add(columns, 'operation [-]')
    call add(columns, 'step_length [time]')
    call add(columns, 'iterations [-]')
    call add(columns, 'cutbacks [-]')
    call add(columns, 'strain_increment [-]')
    call add(columns, 'external_work [energy]')
    call add(columns, 'elastic_energy [energy]')
    call add(columns, 'plastic_work [energy]')
    call add(columns, 'friction_work [energy]')
    call add(columns, 'volume_drift [-]')
    call add(columns, 'max_penetration [length]')
    call add(columns, 'points_sticking [-]')
    call add(columns, 'points_slipping [-]')
    if (scene%load_factor%multiplier > 0) call add(columns, scene%multipliers(scene%load_factor%multiplier)%name//' [-]')
    do k = 1, size(scene%dies)
      if (scene%dies(k)%unasked) cycle
      call add(columns, 'force_x_'//scene%dies(k)%name//' [force]')
      call add(columns, 'force_y_'//scene%dies(k)%name//' [force]')
      call add(columns, 'moment_'//scene%dies(k)%name//' [force*length]')
      if (is_deformable(scene%dies(k)) .and. .not. every) cycle
      call add(columns, 'displacement_x_'//scene%dies(k)%name//' [length]')
      call add(columns, 'displacement_y_'//scene%dies(k)%name//' [length]')
      call add(columns, 'rotation_'//scene%dies(k)%name//' [rad]')
    end do
    if (every .or. scene%plane_state == generalised_plane_strain) then
      do k = 1, 3
        call add(columns, trim(section_motions(k))//trim(merge(' [-]       ', ' [1/length]', k == 1)))
      end do
      do k = 1, 3
        call add(columns, trim(section_loads(k))//trim(merge(' [force]       ', ' [force*length]', k == 1)))
      end do
    end if
    if (every .or. scene%follows_path) then
      call add(columns, 'path_error_motion [-]')
      call add(columns, 'path_error_stress [-]')
    end if
    if (every .or. scene%remesh%estimate) then
      call add(columns, 'error_stress [-]')
      call add(columns, 'error_strain [-]')
    end if
    if (every .or. heat) then
      call add(columns, 'heat_stored [energy]')
      call add(columns, 'heat_in [energy]')
      call add(columns, 'heat_released [energy]')
      call add(columns, 'heat_imbalance [-]')
    end if
  end subroutine columns_of_steps

  !> Columns of a rigid die with a temperature.
  pure subroutine columns_of_die_heat(die, columns)
    character(len=*), intent(in) :: die                           !! its name
    type(string_t), allocatable, intent(inout) :: columns(:)      !! (ncolumn) they are added to

    call add(columns, 'temperature_'//die//' [temperature]')
    call add(columns, 'heat_flow_'//die//' [power]')
  end subroutine columns_of_die_heat

  !> How many columns the history has of this name, or would have in a scene with other effects: one of `LOADF` counts itself.
  pure function own_columns_named(scene, name) result(n)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    integer :: n
    type(string_t), allocatable :: columns(:)
    integer :: k

    call columns_of_steps(scene, .true., .true., columns)
    do k = 1, size(scene%dies)
      call columns_of_die_heat(scene%dies(k)%name, columns)
    end do
    n = 0
    do k = 1, size(columns)
      if (columns(k)%s(:index(columns(k)%s, ' ') - 1) == name) n = n + 1
    end do
  end function own_columns_named

end module history_columns
