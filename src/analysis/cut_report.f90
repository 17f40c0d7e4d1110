!> What came of the cuts of an operation, for the listing and the summary.
module cut_report
  use cuts, only: is_trim
  use history, only: circumference
  use json_writer, only: json_t
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: add_text, string_t, to_text
  use web_thickness, only: measure_web, web_t
  implicit none
  private
  public :: add_cuts, lines_of_cuts, warn_of_webs

contains

  !> A line for each cut made; `on_mesh`: for those made with that mesh alone.
  function lines_of_cuts(scene, solution, on_mesh) result(lines)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in), optional :: on_mesh   !! generation
    type(string_t), allocatable :: lines(:)
    type(string_t) :: line
    integer :: k

    allocate (lines(0))
    do k = 1, size(solution%cuts)
      associate (cut => scene%remesher%cuts(k), made => solution%cuts(k))
        if (made%generation == 0) cycle
        if (present(on_mesh)) then
          if (made%generation /= on_mesh) cycle
        end if
        line%s = '  '//scene%groups(cut%group)%name
        if (is_trim(cut)) then
          line%s = line%s//' trimmed'
        else
          line%s = line%s//' pierced'
        end if
        line%s = line%s//' at time '//to_text(made%time)//': volume removed '//to_text(circumference(scene)*made%volume, 6)
        if (.not. is_trim(cut)) line%s = line%s//', web '//to_text(made%thickness, 4)//', force on ' &
                                         //scene%dies(cut%die)%name//' '//to_text(circumference(scene)*made%force, 5)
        lines = [lines, line]
      end associate
    end do
    if (.not. present(on_mesh) .or. size(lines) == 0) return
    line%s = '  of the limits for a new mesh those of the shape of its elements hold alone'
    lines = [lines, line]
  end function lines_of_cuts

  !> A line for each web that has not parted, added to the warnings of a run at its end.
  subroutine warn_of_webs(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    type(web_t), allocatable :: ways(:)
    character(len=:), allocatable :: words
    real(wp) :: web
    integer :: k

    do k = 1, size(solution%cuts)
      associate (cut => scene%remesher%cuts(k))
        if (is_trim(cut) .or. solution%cuts(k)%generation > 0) cycle
        call measure_web(scene, solution, cut, ways)
        web = minval([huge(web), ways%thickness])
        words = scene%groups(cut%group)%name//' has not parted under '//scene%dies(cut%die)%name
        if (web <= cut%thickness) then
          words = words//', though the web is '//to_text(web, 4)//' at the end: it became thin in the last step, go on for one more'
        else if (web < huge(web)) then
          words = words//': the web is '//to_text(web, 4)//' at the end, it parts at '//to_text(cut%thickness, 4)
        else
          words = words//': there is no web between it and a free side'
        end if
        call add_text(warnings, words)
      end associate
    end do
  end subroutine warn_of_webs

  !> `cuts` in the summary, where the scene has any.
  subroutine add_cuts(json, scene, solution)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: k

    if (size(solution%cuts) == 0) return
    call json%begin_array('cuts')
    do k = 1, size(solution%cuts)
      associate (cut => scene%remesher%cuts(k), made => solution%cuts(k))
        call json%begin_object()
        if (is_trim(cut)) then
          call json%add('card', 'TRIM')
        else
          call json%add('card', 'PIERC')
          call json%add('die', scene%dies(cut%die)%name)
        end if
        call json%add('body', scene%groups(cut%group)%name)
        call json%add('made', made%generation > 0)
        if (made%generation > 0) then
          call json%add('generation', made%generation)
          call json%add('time', made%time)
          call json%add('volume_removed', circumference(scene)*made%volume)
          if (.not. is_trim(cut)) call json%add('web', made%thickness)
          if (.not. is_trim(cut)) call json%add('force', circumference(scene)*made%force)
        end if
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_cuts

end module cut_report
