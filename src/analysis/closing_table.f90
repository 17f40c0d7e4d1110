!> The table a run ends with: the errors that are estimated of it and what half of each would cost (closing_facts), in the listing,
!> on the screen and in summary.json.
module closing_table
  use accuracy_plan, only: accuracy_lines, add_accuracy
  use closing_facts, only: closing_t, largest_stress
  use cost_file, only: remesher_task
  use json_writer, only: json_t
  use kinds, only: wp
  use phases_in_space, only: phase_errors_t, words_of_phases
  use shape_record, only: has_errors, is_shown, shape_errors_t
  use coarse_shape, only: words_of_shape
  use text, only: percent, string_t, to_text
  implicit none
  private
  public :: add_closing, closing_lines

contains

  !> The table in the listing and on the screen.
  subroutine closing_lines(closing, lines)
    type(closing_t), intent(in) :: closing
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    type(string_t), allocatable :: more(:)
    character(len=:), allocatable :: words
    logical :: without_heat

    allocate (lines(0))
    call put('  accuracy (estimates)                                    half of it costs')
    if (closing%space) then
      words = 'stress '//percent(closing%stress)
      if (closing%stress_hidden) words = hidden_stress()
      if (closing%stress_carried > 0) words = words//' (of it '//percent(closing%stress_carried)//' of earlier meshes)'
      if (closing%carried_unknown) words = words//' (what earlier meshes left: not followed, ESTIM)'
      if (closing%strain_known) words = words//', strain '//percent(closing%strain)
      call row('in space', words, times(closing%space_cost)//' the time: twice the elements')
      if (closing%meshes > 1) call row('', on_all_meshes(), to_text(sum(closing%seconds), 3)//' s of processor in all, ' &
        //to_text(closing%seconds(remesher_task), 3)//' s of the remesher')
    end if
    if (closing%space_steps > 0) then
      call row('in space', 'heat: '//to_text(closing%space_now, 3)//' [temperature] at the end, at most ' &
               //to_text(closing%space_largest, 3)//' (mean square '//to_text(closing%space_mean_largest, 3)//')', &
               times(closing%space_cost)//' the time: twice the elements')
      if (closing%phases%followed) call row('', 'phases by these temperatures, at the end: '//words_of_phases(closing%phases), '')
    else if (closing%warm) then
      call row('in space', 'heat: not estimated (temperatures of 8 nodes)', '')
    end if
    if (has_errors(closing%shape)) call row('in space', words_of_shape(closing%shape), &
                                      times(closing%space_cost)//' the time: twice the elements')
    without_heat = closing%warm .and. closing%heat_steps == 0
    if (closing%flows .and. .not. closing%path) call row('in time', 'path within steps: not estimated (NORMS)', '')
    if (closing%path) &
      call row('in time', 'path: motion '//percent(closing%motion)//', stress' &
               //trim(merge('          ', ' at least ', closing%whole_known))//' '//percent(closing%path_stress) &
               //trim(merge('                 ', ' (at this motion)', closing%whole_known)) &
               //trim(merge(' (without that of temperatures)', '                               ', without_heat)), &
               times(closing%path_cost)//' the time: half the steps'' length')
    if (closing%warm .and. closing%heat_steps == 0) call row('in time', 'heat: not estimated (THETA)', '')
    if (closing%heat_steps > 0) &
      call row('in time', 'heat: '//to_text(closing%heat_now, 3)//' [temperature] at the end, at most ' &
               //to_text(closing%heat_largest, 3)//places()//stress_of_heat()//work_not_heat(), &
               times(closing%heat_cost)//' the time: shorter steps')
    if (closing%contact) then
      words = 'depth '//to_text(closing%depth, 3)
      if (closing%depth_share > 0) words = words//', '//to_text(closing%depth_share, 3)//' of the allowed'
      call row('at contact', words, '')
    end if
    if (allocated(closing%accuracy)) then
      call accuracy_lines(closing%accuracy, more)
      lines = [lines, more]
    end if
    if (size(lines) == 1) deallocate (lines)
    if (.not. allocated(lines)) allocate (lines(0))

  contains

    !> What temperatures err makes an elastic stress err.
    function stress_of_heat() result(words)
      character(len=:), allocatable :: words

      words = ''
      if (closing%heat_stress > 0) words = '; stress '//percent(closing%heat_stress)
      if (closing%heat_stress > largest_stress) words = '; '//hidden_stress()
    end function stress_of_heat

    !> Where contact stands is not followed.
    function places() result(words)
      character(len=:), allocatable :: words

      words = ''
      if (closing%places_left_out) words = ' (without that of where contact stands: dies, or the section, are free)'
    end function places

    !> Temperatures are behind by the work of the last step.
    function work_not_heat() result(words)
      character(len=:), allocatable :: words

      words = ''
      if (closing%heat_due > 0) words = '; '//to_text(closing%heat_due, 3)//' behind the work (SOLVE)'
    end function work_not_heat

    !> The largest errors of the run.
    function on_all_meshes() result(words)
      character(len=:), allocatable :: words

      words = to_text(closing%meshes)//' meshes'
      if (closing%errors_of_all) words = 'at most '//percent(closing%stress_worst)//', '//percent(closing%strain_worst) &
                                         //' on '//words
    end function on_all_meshes

    subroutine put(line)
      character(len=*), intent(in) :: line

      lines = [lines, string_t(line)]
    end subroutine put

    subroutine row(where, what, cost)
      character(len=*), intent(in) :: where, what, cost
      character(len=12) :: first
      character(len=44) :: second

      first = where
      second = what
      if (len(what) >= len(second)) then
        call put(trim('    '//first//what//'  '//cost))
      else
        call put(trim('    '//first//second//cost))
      end if
    end subroutine row

  end subroutine closing_lines

  !> In place of an error that says no more than that it is as large as the stress.
  pure function hidden_stress() result(words)
    character(len=:), allocatable :: words

    words = 'stress hidden by its error: no estimate above '//percent(largest_stress)
  end function hidden_stress

  pure function times(cost) result(words)
    real(wp), intent(in) :: cost
    character(len=:), allocatable :: words

    words = to_text(cost, 2)//' times'
  end function times

  !> The same in summary.json.
  subroutine add_closing(json, closing)
    type(json_t), intent(inout) :: json
    type(closing_t), intent(in) :: closing

    call json%begin_object('accuracy')
    if (closing%meshes > 1) then
      call json%begin_object('cycle')
      call json%add('meshes', closing%meshes)
      call json%add('processor_s', sum(closing%seconds))
      call json%add('remesher_s', closing%seconds(remesher_task))
      call json%end_object()
    end if
    if (closing%space) then
      call json%begin_object('space')
      call json%add('stress_pct', 100*closing%stress)
      if (closing%stress_hidden) call json%add('stress_known', .false.)
      if (closing%stress_carried > 0) call json%add('stress_carried_pct', 100*closing%stress_carried)
      if (closing%carried_unknown) call json%add('stress_carried_known', .false.)
      if (closing%strain_known) call json%add('strain_pct', 100*closing%strain)
      if (closing%meshes > 1) then
        if (closing%errors_of_all) call json%add('stress_worst_pct', 100*closing%stress_worst)
        if (closing%errors_of_all) call json%add('strain_worst_pct', 100*closing%strain_worst)
      end if
      call json%add('half_costs', closing%space_cost)
      call json%end_object()
    end if
    if (closing%path) then
      call json%begin_object('path')
      call json%add('motion_pct', 100*closing%motion)
      call json%add('stress_pct', 100*closing%path_stress)
      call json%add('stress_at_motion_pct', 100*closing%stress_at_motion)
      if (.not. closing%whole_known) call json%add('stress_known', .false.)
      if (closing%warm .and. closing%heat_steps == 0) call json%add('stress_without_heat', .true.)
      call json%add('half_costs', closing%path_cost)
      call json%end_object()
    end if
    if (closing%heat_steps > 0) then
      call json%begin_object('heat')
      call json%add('end', closing%heat_now)
      call json%add('largest', closing%heat_largest)
      call json%add('sum', closing%heat)
      if (closing%heat_stress > 0) call json%add('stress_pct', 100*closing%heat_stress)
      if (closing%heat_stress > largest_stress) call json%add('stress_known', .false.)
      if (closing%places_left_out) call json%add('contact_places_known', .false.)
      if (closing%heat_due > 0) call json%add('work_not_heat', closing%heat_due)
      call json%add('half_costs', closing%heat_cost)
      call json%end_object()
    end if
    if (closing%space_steps > 0) then
      call json%begin_object('heat_space')
      call json%add('end', closing%space_now)
      call json%add('largest', closing%space_largest)
      call json%add('mean_end', closing%space_mean)
      call json%add('mean_largest', closing%space_mean_largest)
      if (closing%phases%followed) call add_phases(json, closing%phases)
      call json%add('half_costs', closing%space_cost)
      call json%end_object()
    end if
    if (has_errors(closing%shape)) call add_shape(json, closing%shape, closing%space_cost)
    if (closing%contact) then
      call json%begin_object('contact')
      call json%add('depth', closing%depth)
      if (closing%depth_share > 0) call json%add('over_allowed', closing%depth_share)
      call json%end_object()
    end if
    if (allocated(closing%accuracy)) call add_accuracy(json, closing%accuracy)
    call json%end_object()
  end subroutine add_closing

  !> Errors of the shape in space.
  subroutine add_shape(json, shape, half_costs)
    type(json_t), intent(inout) :: json
    type(shape_errors_t), intent(in) :: shape
    real(wp), intent(in) :: half_costs   !! over the time of this run

    call json%begin_object('shape')
    call json%add('share_in_element', shape%share)
    if (.not. is_shown(shape)) call json%add('known', .false.)
    call json%add('displacement', shape%displacement)
    call json%add('of_displacement', shape%of_displacement)
    call json%add('growth', shape%growth)
    call json%add('of_growth', shape%of_growth)
    call json%add('curvature', shape%curvature)
    call json%add('of_curvature', shape%of_curvature)
    call json%add('half_costs', half_costs)
    call json%end_object()
  end subroutine add_shape

  !> Errors of phases in space.
  subroutine add_phases(json, phases)
    type(json_t), intent(inout) :: json
    type(phase_errors_t), intent(in) :: phases

    call json%add('phase', trim(phases%phase))
    if (phases%since_mesh) call json%add('since_mesh', .true.)
    call json%add('fraction', phases%largest)
    call json%add('fraction_mean', phases%mean)
    if (.not. phases%hard) return
    call json%add('hardness', phases%hardness)
    call json%add('hardness_mean', phases%hardness_mean)
  end subroutine add_phases

end module closing_table
