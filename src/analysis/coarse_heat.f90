!> A mesh too coarse for its temperatures: said at the end of a run.
module coarse_heat
  use kinds, only: wp
  use solution, only: solution_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: warn_of_coarse_heat

  !> Errors up to this share of the range of temperatures of a run are not warned of.
  real(wp), parameter :: expected_share = 0.05_wp
  !> A range of temperatures below this share of them is round-off.
  real(wp), parameter :: resolution = 1.0e-9_wp

contains

  !> A line, added to the warnings of a run at its end, where temperatures err in space by more than a share of their range: in the
  !> mean square of the volume at any time, or anywhere at the end.
  subroutine warn_of_coarse_heat(solution, warnings)
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    real(wp) :: range

    associate (heat => solution%heat)
      range = heat%hottest - heat%coldest
      if (heat%space_steps == 0) return
      if (.not. range > resolution*max(abs(heat%hottest), abs(heat%coldest))) return
      if (.not. max(heat%space_mean_largest, heat%space_now) > expected_share*range) return
      call add_text(warnings, 'the mesh is coarse for its temperatures: in space they err by ' &
                    //to_text(heat%space_mean_largest, 3)//' in the mean square of the volume at time ' &
                    //to_text(heat%space_time, 4)//', by '//to_text(min(heat%space_largest, range), 3)//' at most and by ' &
                    //to_text(min(heat%space_now, range), 3)//' at the end, of a range of '//to_text(range, 4) &
                    //', and phases and stresses with them; use smaller elements where heat comes in or goes out (half as ' &
                    //'large: a quarter of the error)')
    end associate
  end subroutine warn_of_coarse_heat

end module coarse_heat
