!> Steels that are heated above Ac1 and have no kinetics of austenite (AUSTEN): what is there stays, as in no steel.
module heated_steels
  use austenite_kinetics, only: equilibrium_austenite
  use dual_numbers, only: dual_t
  use fields, only: find_field
  use kinds, only: wp
  use law_api, only: find_parameter, law_t
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use steels, only: unknown_temperature
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: note_missing_austenite, warn_of_missing_austenite

  !> Less than this share is reported by nobody: a diagram and Ac1 are no better known.
  real(wp), parameter :: expected_share = 0.05_wp
  integer, parameter :: ncorner = 4

contains

  !> The largest share of an element that should be austenite in equilibrium on heating, and is not, kept over the run. Elements
  !> count by the coldest of their corners.
  pure subroutine note_missing_austenite(scene, laws, solution)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(inout) :: solution
    type(dual_t) :: share
    real(wp) :: zero
    integer :: g, e, f, v

    f = find_field(scene%fields, 'temperature')
    if (f == 0) return
    if (.not. scene%fields(f)%declared) return
    do g = 1, size(scene%groups)
      if (.not. lacks_austenite(scene%groups(g), scene)) cycle
      associate (group => scene%groups(g), material => scene%materials(scene%groups(g)%material), &
                 temperature => solution%fields(f)%value(1, :))
        v = group%variables(find_variable(group%variables, 'austenite'))%first
        zero = material%values(find_parameter(laws(material%law_id), 'ZERO'))
        if (.not. maxval(temperature) + zero > material%steel%ac1) cycle
        do e = 1, size(group%connectivity, 2)
          share = equilibrium_austenite(material%steel, dual_t(minval(temperature(group%connectivity(:ncorner, e))) + zero))
          associate (there => solution%groups(g)%committed(v, :, e))
            solution%missing_austenite = max(solution%missing_austenite, share%value - sum(there)/size(there))
          end associate
        end do
      end associate
    end do
  end subroutine note_missing_austenite

  !> A group with phases, of a steel in which no austenite forms on heating.
  pure function lacks_austenite(group, scene) result(yes)
    type(group_t), intent(in) :: group
    type(scene_t), intent(in) :: scene
    logical :: yes

    yes = group%material > 0
    if (yes) yes = allocated(scene%materials(group%material)%steel)
    if (yes) yes = find_variable(group%variables, 'austenite') > 0
    if (.not. yes) return
    associate (steel => scene%materials(group%material)%steel)
      yes = .not. steel%tau1 > 0 .and. min(steel%ac1, steel%ac3) > unknown_temperature
    end associate
  end function lacks_austenite

  !> A line for all of them, added to the warnings of a run at its end.
  subroutine warn_of_missing_austenite(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    integer :: g

    if (.not. solution%missing_austenite > expected_share) return
    do g = 1, size(scene%groups)
      if (.not. lacks_austenite(scene%groups(g), scene)) cycle
      associate (steel => scene%materials(scene%groups(g)%material)%steel)
        call add_text(warnings, scene%groups(g)%name//': it was heated above Ac1 of the steel '//steel%name//' (' &
                      //to_text(steel%ac1, 4)//' degC), which has no kinetics of austenite (AUSTEN): ' &
                      //to_text(100*solution%missing_austenite, 3)//' % that should have become austenite stayed what it was')
      end associate
      return
    end do
  end subroutine warn_of_missing_austenite

end module heated_steels
