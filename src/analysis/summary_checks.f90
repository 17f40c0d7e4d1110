!> Checks of a run in `summary.json`, what to do about those that do not hold, and estimated errors.
module summary_checks
  use accept_step, only: dissipation_slack
  use elem_api, only: totals_t
  use energy_balance, only: damped_share, damping_advice, energy_imbalance, imbalance_advice
  use fields, only: displacement_field
  use heat_books, only: has_heat, heat_imbalance
  use heat_record, only: heat_record_t
  use history, only: circumference
  use json_writer, only: json_t
  use kinds, only: wp
  use path_advice, only: motion_advice, stress_advice
  use path_record, only: motion_error, stress_error
  use penetration_advice, only: advice_at_points, advice_between_points, allowed_between
  use phase_books, only: fraction_slack, has_fractions
  use run_facts, only: unloaded_drift
  use remeshing, only: no_limit
  use scene, only: scene_t
  use solution, only: solution_t
  use spring_check, only: has_body_springs, spring_advice, spring_force, spring_share
  implicit none
  private
  public :: add_advice, add_checks, add_estimate

contains

  !> What should hold, and by how much it does.
  subroutine add_checks(json, scene, solution, totals)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals

    call json%begin_object('checks')
    call json%add('volume_drift', totals%volume/solution%initial_volume - 1)
    call json%add('volume_drift_unloaded', unloaded_drift(solution, totals))
    call json%add('max_penetration', solution%worst_penetration)
    call json%add('max_penetration_over_allowed', solution%worst_penetration_ratio)
    call json%add('max_penetration_sampled', solution%worst_sample)
    call json%add('max_penetration_sampled_over_allowed', solution%worst_sample_ratio)
    call json%add('max_penetration_sampled_bound', allowed_between(scene))
    call json%add('worst_linear_residual', solution%worst_linear_residual)
    call json%add('least_dissipation', solution%least_dissipation)
    call json%add('least_dissipation_allowed', -dissipation_slack*largest_state(solution))
    if (scene%fields(displacement_field)%declared) call json%add('energy_imbalance', energy_imbalance(solution))
    if (solution%work%damping > 0) call json%add('damped_share', damped_share(solution))
    if (has_heat(scene)) call json%add('heat_imbalance', heat_imbalance(solution))
    if (has_heat(scene)) call add_heat(json, solution%heat)
    if (scene%follows_path) call add_path(json, solution)
    if (has_body_springs(scene)) then
      call json%add('spring_force', circumference(scene)*spring_force(scene, solution))
      call json%add('spring_share', spring_share(scene, solution))
    end if
    call json%add('spurious_mode', solution%worst_spurious)
    if (solution%unstable_steps > 0) call json%add('unstable_steps', solution%unstable_steps)
    if (has_fractions(scene)) then
      call json%add('phase_fractions', solution%worst_fraction)
      call json%add('phase_fractions_allowed', fraction_slack)
    end if
    call json%end_object()
  end subroutine add_checks

  !> The largest number of the state of all points, whatever it is: that of work densities is no larger.
  pure function largest_state(solution) result(largest)
    type(solution_t), intent(in) :: solution
    real(wp) :: largest
    integer :: g

    largest = 0
    do g = 1, size(solution%groups)
      if (size(solution%groups(g)%committed) > 0) largest = max(largest, maxval(abs(solution%groups(g)%committed)))
    end do
  end function largest_state

  !> Balance of heat in time, and temperatures that cannot be there.
  subroutine add_heat(json, heat)
    type(json_t), intent(inout) :: json
    type(heat_record_t), intent(in) :: heat

    if (heat%estimated > 0) then
      call json%add('error_in_time_worst', heat%error_worst)
      call json%add('error_in_time_sum', heat%error_sum)
      call json%add('error_in_time_end', heat%error_now)
      call json%add('error_in_time_largest', heat%error_largest)
      call json%add('steps_shortened_by_error', heat%shortened)
      call json%add('least_steps_above_error', heat%above)
    end if
    call json%add('steps_outside_bounds', heat%outside)
    call json%add('excess_of_bounds', heat%excess)
    call json%add('steps_made_again_for_bounds', heat%fallbacks)
  end subroutine add_heat

  !> Errors that come of the path within steps.
  subroutine add_path(json, solution)
    type(json_t), intent(inout) :: json
    type(solution_t), intent(in) :: solution

    call json%add('path_error_motion', motion_error(solution%path))
    call json%add('path_error_stress', stress_error(solution%path))
    call json%add('path_error_stress_worst', solution%path%stress_worst)
    call json%add('steps_shortened_by_path', solution%path%shortened)
    call json%add('steps_above_path', solution%path%above)
  end subroutine add_path

  !> What to do about the checks that do not hold, by their names.
  subroutine add_advice(json, scene, solution)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution

    call json%begin_object('advice')
    call add('energy_imbalance', imbalance_advice(solution))
    call add('damped_share', damping_advice(solution))
    call add('path_error_motion', motion_advice(solution%path))
    call add('path_error_stress', stress_advice(solution%path))
    if (has_body_springs(scene)) call add('spring_share', spring_advice(scene, solution))
    if (size(scene%dies) > 0) then
      call add('max_penetration_over_allowed', advice_at_points(scene, solution))
      call add('max_penetration_sampled_over_allowed', advice_between_points(scene, solution))
    end if
    call json%end_object()

  contains

    subroutine add(check, advice)
      character(len=*), intent(in) :: check, advice

      if (len(advice) > 0) call json%add(check, advice)
    end subroutine add

  end subroutine add_advice

  !> Estimated errors in percent, and why a new mesh is due.
  subroutine add_estimate(json, scene, solution)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: k

    call json%begin_object('error')
    call json%add('stress_pct', 100*solution%estimate%stress)
    call json%add('strain_pct', 100*solution%estimate%strain)
    call json%end_object()
    if (.not. scene%remesh%on) return
    call json%begin_array('remesh')
    do k = 1, size(solution%estimate%triggers)
      associate (trigger => solution%estimate%triggers(k))
        call json%begin_object()
        call json%add('name', trigger%name)
        call json%add('value', trigger%value)
        if (trigger%limit < no_limit) call json%add('limit', trigger%limit)
        if (trigger%group > 0) then
          call json%add('group', scene%groups(trigger%group)%name)
          call json%add('element', trigger%element)
        end if
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_estimate

end module summary_checks
