!> Runs whose damped steps (damping) find no equilibrium: loads drive the part on, or the end comes first.
module lost_equilibrium
  use errors, only: error_t, exit_no_convergence, fail
  use run_record, only: at_end
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: refuse_lost_equilibrium

contains

  !> An error where viscous forces took more than the elastic energy that a die let go, or hold the part at the end; of a run
  !> that is resumed there too.
  subroutine refuse_lost_equilibrium(scene, solution, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: place

    place = 'no equilibrium: step '//to_text(solution%step)//', time '//to_text(solution%time)//': '
    if (solution%work%damping > solution%damping_bound) then
      call fail(error, exit_no_convergence, place//'since a die let it go, the part has moved by more than its elastic ' &
                //'energy can do: loads drive it on, and nothing holds it', &
                'steps since the note of damping in the listing are no result; hold the part by supports (FIXED) or by ' &
                //'another die, or load it less')
    else if (solution%damping > 0 .and. at_end(scene, solution)) then
      call fail(error, exit_no_convergence, place//'the run ends while viscous forces hold the part, which a die let go', &
                'let the die rest for a while at the end, until the part has come to rest')
    end if
  end subroutine refuse_lost_equilibrium

end module lost_equilibrium
