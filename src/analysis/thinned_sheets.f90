!> Sheets of plane stress that have thinned to little: the stretch across the plane is a state of every point, and where a sheet
!> necks it falls without a sign in the plane, for as long as the ends are pulled. No law here has damage: metal has torn before
!> a tenth is left, which is a strain of 2.3 across the plane.
module thinned_sheets
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: warn_of_thinned_sheets

  !> What is left of the thickness of a sheet that is told.
  real(wp), parameter :: little = 0.1_wp

contains

  !> A line for every body of which less than a tenth of the thickness is left somewhere, added to the warnings of a run.
  subroutine warn_of_thinned_sheets(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    real(wp) :: place(2)
    integer :: g, row, element(2)

    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      row = find_variable(scene%groups(g)%variables, 'stretch_zz')
      if (row == 0) cycle
      associate (stretch => solution%groups(g)%committed(scene%groups(g)%variables(row)%first, :, :))
        if (.not. any(stretch < little)) cycle
        element = minloc(stretch)
        associate (middles => scene%groups(g)%connectivity(5:8, element(2)))
          place = sum(scene%mesh%coordinates(:, middles) + solution%fields(displacement_field)%value(:, middles), 2)/4
        end associate
        call add_text(warnings, scene%groups(g)%name//' has thinned to '//to_text(100*minval(stretch), 2) &
                      //' % of its thickness at x = '//to_text(place(1), 4)//', y = '//to_text(place(2), 4) &
                      //': a sheet of metal has torn by then, which no law here shows; look for the step in which it necks')
      end associate
    end do
  end subroutine warn_of_thinned_sheets

end module thinned_sheets
