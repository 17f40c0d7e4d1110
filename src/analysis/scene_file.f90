!> A scene as JSON, for programs that draw it before any run: `lagamine DECK --check --out DIR` writes DIR/NAME.scene.json. Nodes,
!> dies, multipliers and other numbers of places count from 1; coordinates and amplitudes are in the units of the deck.
module scene_file
  use dies, only: die_t, is_deformable
  use errors, only: error_t
  use json_writer, only: json_t
  use kinds, only: wp
  use remesher_options, only: has_contours
  use scene, only: plane_state_names, role_contact, role_die_heat, role_heat_contact, role_load_factor, role_second, &
                   role_side_load, role_spring, role_volume_load, scene_t
  use zone_marks, only: mark_crossing, mark_inside
  implicit none
  private
  public :: write_scene

  character(len=11), parameter :: role_names(role_load_factor) = ['body       ', 'formulation', 'contact    ', 'side load  ', &
                                                             'volume load', 'spring     ', &
                                                             'contact    ', 'die heat   ', 'load factor']
  character(len=8), parameter :: mark_names(mark_inside) = ['CORNER  ', 'MATTER  ', 'CROSSING', 'AT      ']

contains

  !> Write the scene; a failure is one of the machine.
  subroutine write_scene(path, scene, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(json_t) :: json
    integer :: k

    call json%begin_object()
    call json%add('format', 'lagamine scene')
    call json%add('version', 1)
    call json%add('title', scene%title)
    call json%add('plane_state', trim(plane_state_names(scene%plane_state)))
    call json%add('end_time', scene%strategy%end_time)
    call json%begin_array('coordinates')
    do k = 1, size(scene%mesh%coordinates, 2)
      call json%item(scene%mesh%coordinates(:, k))
    end do
    call json%end_array()
    call json%begin_array('side_sets')
    do k = 1, size(scene%mesh%sides)
      call json%begin_object()
      call json%add('name', scene%mesh%sides(k)%name)
      call add_lists('nodes', scene%mesh%sides(k)%nodes, json)
      call json%end_object()
    end do
    call json%end_array()
    call add_groups(scene, json)
    call add_dies(scene, json)
    call add_loads(scene, json)
    call add_strategy(scene, json)
    call add_zones(scene, json)
    call json%end_object()
    call json%write_file(path, error)
  end subroutine write_scene

  !> Lengths of steps, and the times beside those of multipliers that they hit.
  subroutine add_strategy(scene, json)
    type(scene_t), intent(in) :: scene
    type(json_t), intent(inout) :: json

    call json%begin_object('strategy')
    call json%add('first_step', scene%strategy%first_step)
    call json%add('least_step', scene%strategy%least_step)
    call json%add('largest_step', scene%strategy%largest_step)
    if (allocated(scene%strategy%save_times)) call json%add('save_times', scene%strategy%save_times)
    if (allocated(scene%remesh%times)) call json%add('remesh_times', scene%remesh%times)
    call json%end_object()
  end subroutine add_strategy

  !> Groups with their elements; of loads also how large they get.
  subroutine add_groups(scene, json)
    type(scene_t), intent(in) :: scene
    type(json_t), intent(inout) :: json
    integer :: g

    call json%begin_array('groups')
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        call json%begin_object()
        call json%add('name', group%name)
        call json%add('role', trim(role_names(group%role)))
        call json%add('elem', group%elem)
        if (group%material > 0) call json%add('law', scene%materials(group%material)%name)
        select case (group%role)
        case (role_contact, role_spring, role_heat_contact, role_die_heat)
          call json%add('die', group%die)
        case (role_side_load, role_volume_load)
          call json%add('amplitude', group%amplitude)
          call json%add('multiplier', group%multiplier)
          call json%add('direction', group%direction)
        case default
        end select
        if (group%host > 0) call json%add('host', group%host)
        if (group%role == role_spring) call json%add('component', group%component)
        if (group%role /= role_second .and. group%role /= role_volume_load) call add_lists('nodes', group%connectivity, json)
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_groups

  !> Dies where they stand at the start: pieces of three points each, in turn x and y.
  subroutine add_dies(scene, json)
    type(scene_t), intent(in) :: scene
    type(json_t), intent(inout) :: json
    type(die_t) :: die
    integer :: d, k

    call json%begin_array('dies')
    do d = 1, size(scene%dies)
      die = scene%dies(d)
      call json%begin_object()
      call json%add('name', die%name)
      call json%add('deformable', is_deformable(die))
      call json%add('pilot', die%pilot)
      call json%begin_array('pieces')
      do k = 1, size(die%pieces, 3)
        call json%item(reshape(die%pieces(:, :, k) + spread(die%pilot(1:2), 2, 3), [6]))
      end do
      call json%end_array()
      call json%end_object()
    end do
    call json%end_array()
  end subroutine add_dies

  !> Multipliers, imposed values, motions of dies, forces on pilots and nodes.
  subroutine add_loads(scene, json)
    type(scene_t), intent(in) :: scene
    type(json_t), intent(inout) :: json
    integer :: k

    call json%begin_array('multipliers')
    do k = 1, size(scene%multipliers)
      call json%begin_object()
      call json%add('name', scene%multipliers(k)%name)
      call json%add('time', scene%multipliers(k)%time)
      call json%add('value', scene%multipliers(k)%value)
      call json%end_object()
    end do
    call json%end_array()
    call json%begin_array('fixations')
    do k = 1, size(scene%fixations)
      associate (fixation => scene%fixations(k))
        call json%begin_object()
        call json%add('place', fixation%label)
        call json%add('field', fixation%field)
        call add_driven(fixation%component, fixation%amplitude, fixation%multiplier, json)
        call json%add('nodes', fixation%nodes)
        call json%end_object()
      end associate
    end do
    call json%end_array()
    call json%begin_array('die_motions')
    do k = 1, size(scene%die_motions)
      associate (motion => scene%die_motions(k))
        call json%begin_object()
        call json%add('die', motion%die)
        call add_driven(motion%component, motion%amplitude, motion%multiplier, json)
        call json%end_object()
      end associate
    end do
    call json%end_array()
    call json%begin_array('die_forces')
    do k = 1, size(scene%die_forces)
      associate (force => scene%die_forces(k))
        call json%begin_object()
        call json%add('die', force%die)
        call add_driven(force%component, force%amplitude, force%multiplier, json)
        call json%end_object()
      end associate
    end do
    call json%end_array()
    call json%begin_array('forces')
    do k = 1, size(scene%forces)
      associate (force => scene%forces(k))
        call json%begin_object()
        call json%add('node', force%node)
        call json%add('field', force%field)
        call add_driven(force%component, force%amplitude, force%multiplier, json)
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_loads

  !> What is driven by an amplitude times a multiplier (0: none).
  subroutine add_driven(component, amplitude, multiplier, json)
    integer, intent(in) :: component, multiplier
    real(wp), intent(in) :: amplitude   !! of the unit of what is driven
    type(json_t), intent(inout) :: json

    call json%add('component', component)
    call json%add('amplitude', amplitude)
    call json%add('multiplier', multiplier)
  end subroutine add_driven

  !> Contours of bodies without a mesh, zones and their points.
  subroutine add_zones(scene, json)
    type(scene_t), intent(in) :: scene
    type(json_t), intent(inout) :: json
    integer :: k, i

    call json%begin_array('contours')
    if (has_contours(scene%remesher)) then
      do k = 1, size(scene%remesher%contours)
        associate (contour => scene%remesher%contours(k))
          call json%begin_object()
          call json%add('group', contour%group)
          call json%add('rows', contour%row)
          call json%add('loops', contour%loop)
          call json%begin_array('pieces')
          do i = 1, size(contour%pieces, 3)
            call json%item(reshape(contour%pieces(:, :, i), [6]))
          end do
          call json%end_array()
          call json%end_object()
        end associate
      end do
    end if
    call json%end_array()
    call json%begin_array('zone_points')
    if (allocated(scene%remesher%marks)) then
      do k = 1, size(scene%remesher%marks)
        associate (mark => scene%remesher%marks(k))
          call json%begin_object()
          call json%add('name', trim(mark%name))
          call json%add('form', trim(mark_names(mark%form)))
          call json%add('x', mark%x)
          if (mark%form == mark_crossing) call json%add('axis', mark%axis)
          if (mark%form == mark_crossing) call json%add('pick', mark%pick)
          call json%end_object()
        end associate
      end do
    end if
    call json%end_array()
    call json%begin_array('zones')
    if (allocated(scene%remesher%zones)) then
      do k = 1, size(scene%remesher%zones)
        call json%begin_object()
        call json%add('name', trim(scene%remesher%zones(k)%name))
        call json%add('points', scene%remesher%zones(k)%marks)
        call json%end_object()
      end do
    end if
    call json%end_array()
  end subroutine add_zones

  !> Columns of whole numbers as an array of arrays.
  subroutine add_lists(name, lists, json)
    character(len=*), intent(in) :: name
    integer, intent(in) :: lists(:, :)   !! (n, m): m arrays of n nodes each
    type(json_t), intent(inout) :: json
    integer :: k

    call json%begin_array(name)
    do k = 1, size(lists, 2)
      call json%item(lists(:, k))
    end do
    call json%end_array()
  end subroutine add_lists

end module scene_file
