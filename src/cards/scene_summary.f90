!> Summary of a scene: printed by `--check` and at the start of a run.
module scene_summary
  use dies, only: is_deformable
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use kinds, only: pi, wp
  use linear_api, only: solver_row_t
  use linear_registry, only: list_solvers
  use loads, only: by_flux, by_radiation, field_history_t
  use quadrature, only: rule_along, rule_control, rule_equidistant, rule_t
  use remesher_windows, only: window_text
  use remeshing, only: criterion_names, has_limit, is_upper, ncriteria, never
  use scene, only: axisymmetric, generalised_plane_strain, group_t, lacks_mesh, plane_state_names, scene_t
  use sections, only: section_drive_t, section_forced, section_moved, section_names
  use text, only: padded, string_t, to_text
  use weld_sources, only: weld_source_t
  implicit none
  private
  public :: scene_lines

  character(len=*), parameter :: directions(3) = ['x', 'y', 'a']

contains

  subroutine scene_lines(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    type(elem_t), allocatable :: elems(:)
    type(solver_row_t), allocatable :: solvers(:)
    integer :: k

    call list_elems(elems)
    call list_solvers(solvers)
    allocate (lines(0))
    if (scene%operation > 0) call put('operation  '//to_text(scene%operation)//' of '//to_text(scene%operations)//': ' &
                                      //scene%operation_name)
    call put('scene      '//scene%title)
    call put('           '//trim(plane_state_names(scene%plane_state))//thickness()//', kinematics '//scene%kinematics &
             //', until time '//to_text(scene%strategy%end_time))
    call put('nodes      '//to_text(size(scene%mesh%labels)))
    associate (solver => solvers(scene%strategy%linear_solver))
      call put('solver     '//padded(solver%name, 24)//solver%purpose)
    end associate
    if (lacks_mesh(scene)) call put('mesh       none yet: the remesher makes it of contours and zones')
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        call put('group      '//padded(group%name, 24)//padded(to_text(size(group%connectivity, 2))//' '//group%elem, 14) &
                 //to_text(group%rule%n)//rule_of(group%rule) &
                 //option_of(group)//driven_by(k))
      end associate
    end do
    do k = 1, size(scene%materials)
      call put('law        '//padded(scene%materials(k)%name, 24)//scene%materials(k)%law)
    end do
    do k = 1, size(scene%dies)
      call put('die        '//padded(scene%dies(k)%name, 24)//to_text(size(scene%dies(k)%pieces, 3)) &
               //trim(merge(' piece,  ', ' pieces, ', size(scene%dies(k)%pieces, 3) == 1))//' '//motion_of(k)//temperature_of(k))
    end do
    do k = 1, merge(3, 0, scene%plane_state == generalised_plane_strain)
      call put('section    '//padded(trim(section_names(k)), 24)//drive_text(scene%section_drives(k)))
    end do
    do k = 1, size(scene%fixations)
      call put('load       '//padded(scene%fixations(k)%label, 24)//to_text(size(scene%fixations(k)%nodes))//' nodes')
    end do
    do k = 1, size(scene%forces)
      call put('load       '//padded('FORCE node '//to_text(scene%mesh%labels(scene%forces(k)%node))//' ' &
                                     //directions(scene%forces(k)%component), 24) &
               //to_text(scene%forces(k)%amplitude)//' x '//scene%multipliers(scene%forces(k)%multiplier)%name)
    end do
    do k = 1, size(scene%probes)
      call put('probe      '//padded(scene%probes(k)%name, 24)//'['//scene%probes(k)%unit//']')
    end do
    if (scene%accuracy%asked > 0) call put('accuracy   '//to_text(100*scene%accuracy%asked, 3)//' % asked (lagamine --forecast ' &
                                           //'says what that takes)')
    if (scene%remesh%on) call put_remesh()
    do k = 1, size(scene%effects)
      associate (effect => scene%effects(k))
        if (effect%on) then
          call put('effect     '//padded(effect%name, 16)//'on   '//effect%why//'; adds '//effect%adds)
        else
          call put('effect     '//padded(effect%name, 16)//'off  '//effect%why)
        end if
      end associate
    end do

  contains

    subroutine put(s)
      character(len=*), intent(in) :: s
      type(string_t) :: line

      line%s = s
      lines = [lines, line]
    end subroutine put

    !> Limits at which a new mesh is due, and what it will be.
    subroutine put_remesh()
      integer :: k

      if (scene%remesh%stress_error < never) call put_limit('stress_error', 'above '//to_text(scene%remesh%stress_error) &
                                                            //strain_text(scene%remesh%error_strain))
      do k = 1, ncriteria
        if (.not. abs(scene%remesh%shape(k)) < never) cycle
        call put_limit(trim(criterion_names(k)), trim(merge('above', 'below', is_upper(k)))//' '//to_text(scene%remesh%shape(k)) &
                       //share_text(scene%remesh%bad_share))
      end do
      if (scene%remesh%contact < never) &
        call put_limit('contact', 'deeper by '//to_text(scene%remesh%contact)//' times the allowed penetration')
      if (scene%remesh%distress < huge(0)) call put_limit('distress', to_text(scene%remesh%distress)//' cutbacks in a row')
      do k = 1, size(scene%remesh%times)
        call put_limit('time', to_text(scene%remesh%times(k)))
      end do
      do k = 1, size(scene%remesh%strokes)
        associate (stroke => scene%remesh%strokes(k))
          call put_limit('stroke', scene%dies(stroke%die)%name//' '//directions(stroke%component)//' = '//to_text(stroke%value))
        end associate
      end do
      if (.not. has_limit(scene%remesh)) call put_limit('never again', 'after the first mesh: no row of REMSH is a limit')
      associate (wish => scene%remesher)
        call put('new mesh   elements of '//to_text(wish%smallest, 4)//' to '//to_text(wish%largest, 4) &
                 //most_text(wish%most_elements)//', error of the strain '//to_text(100*wish%strain_error)//' %')
        do k = 1, size(wish%windows)
          call put('window     '//window_text(wish%windows(k), name_of_die(wish%windows(k)%die)))
        end do
      end associate
    end subroutine put_remesh

    subroutine put_limit(name, limit)
      character(len=*), intent(in) :: name, limit

      call put('remesh     '//padded(name, 24)//limit)
    end subroutine put_limit

    pure function name_of_die(die) result(name)
      integer, intent(in) :: die   !! 0 for none
      character(len=:), allocatable :: name

      name = ''
      if (die > 0) name = scene%dies(die)%name
    end function name_of_die

    pure function most_text(most) result(s)
      integer, intent(in) :: most
      character(len=:), allocatable :: s

      s = ''
      if (most > 0) s = ', at most '//to_text(most)
    end function most_text

    pure function strain_text(strain) result(s)
      real(wp), intent(in) :: strain
      character(len=:), allocatable :: s

      s = ''
      if (strain > 0) s = ' where an element has been strained by '//to_text(strain)
    end function strain_text

    pure function share_text(share) result(s)
      real(wp), intent(in) :: share
      character(len=:), allocatable :: s

      s = ''
      if (share > 0) s = ' in more than '//to_text(100*share)//' % of the elements'
    end function share_text

    !> The thickness where it has been given another value than 1.
    pure function thickness() result(s)
      character(len=:), allocatable :: s

      s = ''
      if (scene%plane_state == axisymmetric .or. .not. abs(scene%section(1) - 1) > 0) return
      s = ' of thickness '//to_text(scene%section(1))
    end function thickness

    pure function drive_text(drive) result(s)
      type(section_drive_t), intent(in) :: drive
      character(len=:), allocatable :: s

      s = 'held'
      if (drive%kind == section_forced) s = 'free'
      if (drive%multiplier == 0) return
      s = to_text(drive%amplitude)//' x '//scene%multipliers(drive%multiplier)%name
      if (drive%kind == section_moved) s = 'moved by '//s
      if (drive%kind == section_forced) s = 'loaded by '//s
    end function drive_text

    !> Law and temperature of a group of elements, or the multiplier of its load.
    !> The option that the card of a group asks for.
    pure function option_of(group) result(s)
      type(group_t), intent(in) :: group
      character(len=:), allocatable :: s

      s = ''
      if (group%option > 0) s = ', '//elems(group%elem_id)%options(group%option)%s
    end function option_of

    pure function driven_by(g) result(s)
      integer, intent(in) :: g
      character(len=:), allocatable :: s

      s = ''
      if (scene%groups(g)%material > 0) s = ', law '//scene%materials(scene%groups(g)%material)%name
      if (scene%groups(g)%multiplier > 0) s = ', '//to_text(scene%groups(g)%amplitude)//' x ' &
                                              //scene%multipliers(scene%groups(g)%multiplier)%name
      if (scene%groups(g)%elem == 'CENTR') s = s//'^2'
      if (scene%groups(g)%elem == 'LOADF') s = found_by()
      if (scene%groups(g)%is_spring) s = ', '//to_text(scene%groups(g)%stiffness, 3)//' per volume'
      if (any(scene%groups(g)%elem == [character(len=5) :: 'FLUX', 'CONVE', 'RADIA', 'HEATS', 'FACES'])) &
        s = exchange_of(scene%groups(g))
      if (scene%groups(g)%source > 0) s = torch_of(scene%sources(scene%groups(g)%source))
      if (scene%groups(g)%temperature_history > 0) s = s//history_of(scene%histories(scene%groups(g)%temperature_history))
      if (scene%groups(g)%temperature_multiplier > 0) &
        s = s//', temperature '//to_text(scene%groups(g)%temperature_amplitude)//' x ' &
            //scene%multipliers(scene%groups(g)%temperature_multiplier)%name
    end function driven_by

    !> Temperatures of another run.
    pure function history_of(history) result(s)
      type(field_history_t), intent(in) :: history
      character(len=:), allocatable :: s

      s = ', temperature of '//history%source
      if (history%begins > 0) s = s//' from '//to_text(history%begins)//' on'
    end function history_of

    !> What the multiplier that is found makes follow what.
    pure function found_by() result(s)
      character(len=:), allocatable :: s

      associate (factor => scene%load_factor)
        s = ', so that the work of its loads, at a multiplier of 1,'
        if (factor%node > 0) s = ', so that node '//to_text(scene%mesh%labels(factor%node))//' '//directions(factor%component)
        s = s//' follows '//to_text(factor%amplitude)//' x '//scene%multipliers(factor%curve)%name
      end associate
    end function found_by

    !> Heat that passes sides or comes from a volume, in numbers.
    pure function exchange_of(group) result(s)
      type(group_t), intent(in) :: group
      character(len=:), allocatable :: s

      associate (exchange => group%exchange)
        s = ', '//to_text(exchange%amplitude)//times(exchange%multiplier)
        if (allocated(exchange%table)) s = s//' by temperature'
        if (exchange%kind == by_flux) return
        s = s//', surroundings '//to_text(exchange%surroundings)//times(exchange%surroundings_multiplier)
        if (exchange%kind == by_radiation) s = s//', absolute zero '//to_text(-exchange%zero)
      end associate
    end function exchange_of

    !> Heat of a torch, in numbers.
    pure function torch_of(source) result(s)
      type(weld_source_t), intent(in) :: source
      character(len=:), allocatable :: s

      s = ', '//to_text(source%efficiency)//' x '//to_text(source%power)//times(source%multiplier)
      if (source%crosses) s = s//', crosses at '//to_text(source%crossing_time)//' with '//to_text(source%speed)
    end function torch_of

    pure function times(multiplier) result(s)
      integer, intent(in) :: multiplier
      character(len=:), allocatable :: s

      s = ''
      if (multiplier > 0) s = ' x '//scene%multipliers(multiplier)%name
    end function times

    !> Points of an integration rule, with its kind along a side where it is not Gauss's.
    pure function rule_of(rule) result(s)
      type(rule_t), intent(in) :: rule
      character(len=:), allocatable :: s

      s = ''
      if (rule%family == rule_along) s = ' Lobatto'
      if (rule%family == rule_control) s = ' Bezier'
      if (rule%family == rule_equidistant) s = trim(merge(' Lobatto    ', ' equidistant', rule%n == 3))
      s = s//' points'
      if (rule%family == rule_along) s = s//' and between them'
    end function rule_of

    pure function motion_of(die) result(s)
      integer, intent(in) :: die
      character(len=:), allocatable :: s
      integer :: i

      s = ''
      if (is_deformable(scene%dies(die))) then
        s = 'sides of bodies'
        return
      end if
      do i = 1, size(scene%die_motions)
        associate (motion => scene%die_motions(i))
          if (motion%die /= die) cycle
          if (s /= '') s = s//', '
          s = s//directions(motion%component)//' = '//to_text(motion%amplitude)//' x '//scene%multipliers(motion%multiplier)%name
        end associate
      end do
      do i = 1, size(scene%die_forces)
        associate (load => scene%die_forces(i))
          if (load%die /= die) cycle
          if (s /= '') s = s//', '
          s = s//directions(load%component)//' free'
          if (load%multiplier > 0) s = s//' under a force by '//scene%multipliers(load%multiplier)%name
        end associate
      end do
      if (s == '') s = 'at rest'
    end function motion_of

    !> What TDIE gives of a die.
    pure function temperature_of(die) result(s)
      integer, intent(in) :: die
      character(len=:), allocatable :: s
      real(wp) :: around
      integer :: i

      s = ''
      around = merge(2*pi, 1.0_wp, scene%plane_state == axisymmetric)
      do i = 1, size(scene%die_heats)
        associate (heat => scene%die_heats(i))
          if (heat%die /= die) cycle
          s = ', T = '//to_text(heat%temperature)//times(heat%multiplier)
          if (heat%capacity > 0) s = s//' at the start, heat capacity '//to_text(around*heat%capacity, 6)
        end associate
      end do
    end function temperature_of

  end subroutine scene_lines

end module scene_summary
