!> Summary of a scene: printed by `--check` and at the start of a run.
module scene_summary
  use die_summary, only: die_text
  use effects, only: effect_t
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use group_summary, only: group_text
  use linear_api, only: solver_row_t
  use linear_registry, only: list_solvers
  use probes, only: is_elsewhere, probe_node, probe_point, probe_t
  use remesh_summary, only: add_remesh_lines
  use scene, only: axisymmetric, generalised_plane_strain, lacks_mesh, plane_state_names, scene_t
  use sections, only: section_drive_t, section_forced, section_moved, section_names
  use summary_words, only: direction_names, times
  use text, only: add_text, padded, string_t, to_text
  use wall_summary, only: add_walls
  implicit none
  private
  public :: scene_lines

contains

  subroutine scene_lines(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)

    allocate (lines(0))
    call add_head(scene, lines)
    call add_parts(scene, lines)
    call add_loads(scene, lines)
    if (scene%accuracy%asked > 0) call add_text(lines, 'accuracy   '//to_text(100*scene%accuracy%asked, 3) &
                                                //' % asked (lagamine --forecast says what that takes)')
    if (scene%remesh%on) call add_remesh_lines(scene, lines)
    call add_effects(scene%effects, lines)
  end subroutine scene_lines

  !> What the scene is, and how it is solved.
  subroutine add_head(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    type(solver_row_t), allocatable :: solvers(:)

    call list_solvers(solvers)
    if (scene%operation > 0) call add_text(lines, 'operation  '//to_text(scene%operation)//' of '//to_text(scene%operations) &
                                           //': '//scene%operation_name)
    call add_text(lines, 'scene      '//scene%title)
    call add_text(lines, '           '//trim(plane_state_names(scene%plane_state))//thickness_of(scene)//', kinematics ' &
                  //scene%kinematics//', until time '//to_text(scene%strategy%end_time))
    call add_text(lines, 'nodes      '//to_text(size(scene%mesh%labels)))
    associate (solver => solvers(scene%strategy%linear_solver))
      call add_text(lines, 'solver     '//padded(solver%name, 24)//solver%purpose)
    end associate
    if (lacks_mesh(scene)) call add_text(lines, 'mesh       none yet: the remesher makes it of contours and zones')
  end subroutine add_head

  !> Groups of elements, materials, dies.
  subroutine add_parts(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    type(elem_t), allocatable :: elems(:)
    integer :: k

    call list_elems(elems)
    do k = 1, size(scene%groups)
      call add_text(lines, 'group      '//group_text(scene, scene%groups(k), elems(scene%groups(k)%elem_id)))
    end do
    do k = 1, size(scene%materials)
      call add_text(lines, 'law        '//padded(scene%materials(k)%name, 24)//scene%materials(k)%law)
    end do
    do k = 1, size(scene%dies)
      call add_text(lines, 'die        '//die_text(scene, k))
    end do
  end subroutine add_parts

  !> What drives the section, supports, walls, forces on nodes; probes.
  subroutine add_loads(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    integer :: k

    do k = 1, merge(3, 0, scene%plane_state == generalised_plane_strain)
      call add_text(lines, 'section    '//padded(trim(section_names(k)), 24)//drive_text(scene, scene%section_drives(k)))
    end do
    do k = 1, size(scene%fixations)
      call add_text(lines, 'load       '//padded(scene%fixations(k)%label, 24)//to_text(size(scene%fixations(k)%nodes))//' nodes')
    end do
    call add_walls(scene, lines)
    call add_forces(scene, lines)
    do k = 1, size(scene%probes)
      call add_text(lines, 'probe      '//padded(scene%probes(k)%name, 24)//'['//scene%probes(k)%unit//']' &
                    //place_words(scene, scene%probes(k)))
    end do
  end subroutine add_loads

  !> A line for each force on a node; for many that follow one another along the same direction, as those of a traction, one with
  !> their sum.
  subroutine add_forces(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    integer, parameter :: many = 8
    integer :: k, last

    last = 0
    do k = 1, size(scene%forces)
      if (k <= last) cycle
      associate (force => scene%forces(k))
        last = k
        do while (last < size(scene%forces))
          if (scene%forces(last + 1)%component /= force%component .or. scene%forces(last + 1)%multiplier /= force%multiplier) exit
          last = last + 1
        end do
        if (last - k + 1 >= many) then
          call add_text(lines, 'load       '//padded('FORCE '//to_text(last - k + 1)//' nodes ' &
                                                     //direction_names(force%component), 24) &
                        //'together '//to_text(sum(scene%forces(k:last)%amplitude))//times(scene, force%multiplier))
        else
          last = k
          call add_text(lines, 'load       '//padded('FORCE node '//to_text(scene%mesh%labels(force%node))//' ' &
                                                     //direction_names(force%component), 24) &
                        //to_text(force%amplitude)//times(scene, force%multiplier))
        end if
      end associate
    end do
  end subroutine add_forces

  !> Where the node or the point of a probe is in the deck's own mesh, and how far that is from the place asked for.
  pure function place_words(scene, probe) result(words)
    type(scene_t), intent(in) :: scene
    type(probe_t), intent(in) :: probe
    character(len=:), allocatable :: words

    words = ''
    if (.not. any(probe%kind == [probe_node, probe_point]) .or. probe%is_gone .or. size(scene%mesh%origin, 2) == 0) return
    words = ' '//trim(merge('node ', 'point', probe%kind == probe_node))//' at '//to_text(probe%place(1), 6)//' ' &
            //to_text(probe%place(2), 6)
    if (is_elsewhere(probe, scene%mesh%origin)) words = words//', '//to_text(probe%apart, 3)//' from the place asked for'
  end function place_words

  !> Effects that are on, with what they add, and those that are off, with the reason.
  subroutine add_effects(effects, lines)
    type(effect_t), intent(in) :: effects(:)   !! (neffect)
    type(string_t), allocatable, intent(inout) :: lines(:)
    integer :: k

    do k = 1, size(effects)
      if (effects(k)%on) then
        call add_text(lines, 'effect     '//padded(effects(k)%name, 16)//'on   '//effects(k)%why//'; adds '//effects(k)%adds)
      else
        call add_text(lines, 'effect     '//padded(effects(k)%name, 16)//'off  '//effects(k)%why)
      end if
    end do
  end subroutine add_effects

  !> The thickness where it has been given another value than 1.
  pure function thickness_of(scene) result(s)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: s

    s = ''
    if (scene%plane_state == axisymmetric .or. .not. abs(scene%section(1) - 1) > 0) return
    s = ' of thickness '//to_text(scene%section(1))
  end function thickness_of

  !> What drives a component of the section.
  pure function drive_text(scene, drive) result(s)
    type(scene_t), intent(in) :: scene
    type(section_drive_t), intent(in) :: drive
    character(len=:), allocatable :: s

    s = 'held'
    if (drive%kind == section_forced) s = 'free'
    if (drive%multiplier == 0) return
    s = to_text(drive%amplitude)//times(scene, drive%multiplier)
    if (drive%kind == section_moved) s = 'moved by '//s
    if (drive%kind == section_forced) s = 'loaded by '//s
  end function drive_text

end module scene_summary
