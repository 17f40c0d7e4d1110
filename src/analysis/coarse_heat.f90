!> A mesh too coarse for its temperatures, or for the phases that they make: said at the end of a run.
module coarse_heat
  use kinds, only: wp
  use phases_in_space, only: errors_of_phases, phase_errors_t, words_of_phases
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: warn_of_coarse_heat

  !> Errors up to this share of the range of temperatures of a run, and fractions of phases up to this, are not warned of.
  real(wp), parameter :: expected_share = 0.05_wp
  !> A range of temperatures below this share of them is round-off.
  real(wp), parameter :: resolution = 1.0e-9_wp
  character(len=*), parameter :: remedy = '; use smaller elements where heat comes in or goes out (half as large: a quarter of ' &
                                          //'the error)'

contains

  !> A line, added to the warnings of a run at its end, where temperatures err in space by more than a share of their range: in the
  !> mean square of the volume at any time, or anywhere at the end; or where a phase errs by more than a share in the mean square.
  !> Of temperatures on 8 nodes no error is known, but where they leave those around them.
  subroutine warn_of_coarse_heat(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    type(phase_errors_t) :: phases
    character(len=:), allocatable :: with
    real(wp) :: range

    associate (heat => solution%heat)
      range = heat%hottest - heat%coldest
      if (heat%space_steps == 0) then
        if (heat%excess > expected_share*range) call add_text(warnings, 'temperatures on 8 nodes are beyond those that can be ' &
          //'there in '//to_text(heat%outside)//' steps, by up to '//to_text(heat%excess, 3)//' of a range of ' &
          //to_text(range, 4)//': the mesh is coarse for heat that comes in or goes out suddenly; use smaller elements there, or ' &
          //'BILINEAR, with which temperatures stay within those around them')
        return
      end if
      if (.not. range > resolution*max(abs(heat%hottest), abs(heat%coldest))) return
      call errors_of_phases(scene, solution, phases)
      with = ', and phases and stresses with them'
      if (phases%followed) with = ', and stresses with them; phases by these temperatures, at the end: '//words_of_phases(phases)
      if (max(heat%space_mean_largest, heat%space_now) > expected_share*range) then
        call add_text(warnings, 'the mesh is coarse for its temperatures: in space they err by ' &
                      //to_text(heat%space_mean_largest, 3)//' in the mean square of the volume at time ' &
                      //to_text(heat%space_time, 4)//', by '//to_text(min(heat%space_largest, range), 3)//' at most and by ' &
                      //to_text(min(heat%space_now, range), 3)//' at the end, of a range of '//to_text(range, 4)//with//remedy)
      else if (phases%mean > expected_share) then
        call add_text(warnings, 'the mesh is coarse for its phases: by the errors of temperatures in space they err at the end, ' &
                      //words_of_phases(phases)//remedy)
      end if
    end associate
  end subroutine warn_of_coarse_heat

end module coarse_heat
