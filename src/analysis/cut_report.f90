!> What came of the cuts of an operation, for the listing and the summary.
module cut_report
  use cuts, only: is_trim
  use history, only: circumference
  use json_writer, only: json_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: add_cuts, lines_of_cuts

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
  end function lines_of_cuts

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
