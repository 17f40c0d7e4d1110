!> Whether an equilibrium that Newton's method has found may be taken: no side has gone through a die, the strain of the step is
!> within its bound, the corrections have not lost their way, and it is stable.
module equilibrium_check
  use elem_api, only: mode_advance, report_t
  use equations, only: equations_t
  use fields, only: displacement_field
  use jumped_bodies, only: has_jumped
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use stability, only: ways_to_leave
  use step_outcome, only: outcome_t
  use step_strategy, only: is_shortest
  use text, only: to_text
  implicit none
  private
  public :: check_equilibrium

  !> The first motion is taken where no more corrections than this share of the most iterations went too far; a motion out of dies
  !> where no more were made.
  real(wp), parameter :: sure_way = 0.25_wp

contains

  !> Judge the equilibrium of an outcome that has converged; it has not where a reason is found.
  subroutine check_equilibrium(scene, equations, solution, dt, external, report, in_part, past_limit, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt             !! length of the step [time]
    real(wp), intent(in) :: external(:)    !! (ndof) forces at its end [residual]
    type(report_t), intent(in) :: report   !! of the last evaluation
    logical, intent(in) :: in_part         !! a part of the residual is left
    logical, intent(in) :: past_limit      !! its last matrix was shifted (pseudo_transient)
    type(outcome_t), intent(inout) :: outcome

    if (report%passed < 1) then
      outcome%reason = 'a side goes through a die'
      if (dt > scene%strategy%least_step) then
        outcome%event = report%passed
        outcome%event_reason = 'a die would go through a side'
      end if
    else if (outcome%strain > scene%strategy%strain_bound .and. .not. (in_part .and. equations%mode == mode_advance)) then
      ! who leaves a part of the residual judges the strain of his parts
      outcome%reason = 'strain increment '//to_text(outcome%strain, 3)//' above '//to_text(scene%strategy%strain_bound, 3)
    else if (is_lost_way(scene, equations, solution, dt, external, in_part, outcome)) then
      outcome%reason = to_text(outcome%iterations)//' iterations, '//trim(merge('in which a part jumped free of its dies', &
                            'in the first step                      ', solution%last_step > 0))//': they may have lost their way'
    else if (outcome%iterations > 0) then
      call ways_to_leave(scene, equations, solution, past_limit, outcome%unstable, outcome%error)
      if (outcome%unstable > 0 .and. .not. (equations%downhill .or. equations%takes_unstable)) &
        outcome%reason = 'the equilibrium found is not stable'
    end if
    outcome%converged = .not. (allocated(outcome%reason) .or. allocated(outcome%error))
  end subroutine check_equilibrium

  !> The first motion was found by many corrections that went too far: none before it says where the way leads, and of a slender
  !> part past its load of buckling there are several equilibria, all stable; such corrections may end in any (those that find
  !> contact are taken whole, or searched closely). A later one was found by many corrections at the end of which a part has
  !> jumped out of its dies.
  function is_lost_way(scene, equations, solution, dt, external, in_part, outcome) result(is)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt, external(:)
    logical, intent(in) :: in_part
    type(outcome_t), intent(in) :: outcome
    logical :: is

    is = equations%mode == mode_advance .and. equations%solves(equations%now)%own(displacement_field) .and. &
         .not. (in_part .or. equations%downhill .or. is_shortest(scene, dt))
    if (.not. is) return
    if (solution%last_step > 0) then
      is = outcome%iterations > sure_way*scene%strategy%max_iterations
      if (is) is = has_jumped(scene, equations, solution, dt, external)
    else
      associate (too_far => outcome%history%line_search < 1 .and. .not. outcome%history%closely)
        is = count(too_far) > sure_way*scene%strategy%max_iterations
      end associate
    end if
  end function is_lost_way

end module equilibrium_check
