!> Checks of a run that do not hold, in words: what is wrong, by how much, and what to do.
module failed_checks
  use energy_balance, only: damped_share, damping_advice, energy_imbalance, imbalance_advice
  use path_advice, only: motion_advice, stress_advice
  use path_record, only: motion_error, stress_error
  use penetration_advice, only: advice_at_points, advice_between_points
  use run_warnings, only: add_warning, warning_t
  use scene, only: operation_of, scene_t
  use solution, only: solution_t
  use spring_check, only: has_body_springs, spring_advice, spring_share
  use text, only: percent, to_text
  implicit none
  private
  public :: list_failed_checks

contains

  !> One warning for each.
  subroutine list_failed_checks(scene, solution, list)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(warning_t), allocatable, intent(out) :: list(:)   !! (nwarning)

    allocate (list(0))
    call add('energy_imbalance', 'energy imbalance '//percent(energy_imbalance(solution)), imbalance_advice(solution))
    call add('damped_share', 'damping '//percent(damped_share(solution))//' of the energy that passed', damping_advice(solution))
    if (scene%follows_path) then
      call add('path_error_motion', 'error of the motion by the path within steps '//percent(motion_error(solution%path)), &
               motion_advice(solution%path))
      call add('path_error_stress', 'error of the stress by the path within steps '//percent(stress_error(solution%path)), &
               stress_advice(solution%path))
    end if
    if (has_body_springs(scene)) &
      call add('spring_share', 'weak springs carry '//percent(spring_share(scene, solution))//' of the largest force', &
               spring_advice(scene, solution))
    if (size(scene%dies) == 0) return
    call add('max_penetration_over_allowed', 'points of contact are deeper in a die than allowed, ' &
             //to_text(solution%worst_penetration_ratio, 3)//' times', advice_at_points(scene, solution))
    call add('max_penetration_sampled_over_allowed', 'sides between points of contact are deeper in a die than allowed, ' &
             //to_text(solution%worst_sample_ratio, 3)//' times', advice_between_points(scene, solution))

  contains

    subroutine add(check, what, advice)
      character(len=*), intent(in) :: check, what, advice   !! no advice: the check holds

      if (len(advice) > 0) call add_warning(list, operation_of(scene), what//': '//advice, check)
    end subroutine add

  end subroutine list_failed_checks

end module failed_checks
