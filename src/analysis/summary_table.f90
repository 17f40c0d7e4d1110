!> The table that a run ends with, in the listing and on the screen.
module summary_table
  use closing_table, only: closing_lines
  use cut_report, only: lines_of_cuts
  use elem_api, only: totals_t
  use energy_books, only: damped_share, damping_advice, energy_imbalance, imbalance_advice
  use equations, only: equations_t
  use heat_books, only: has_heat, heat_imbalance
  use heat_record, only: heat_record_t
  use history, only: circumference
  use kinds, only: wp
  use path_advice, only: motion_advice, stress_advice
  use path_record, only: motion_error, stress_error
  use pending_heat, only: pending
  use penetration_advice, only: advice_at_points, advice_between_points, sides_that_span, states_penetration
  use run_facts, only: run_facts_t, unloaded_drift
  use scene, only: scene_t, solid_elements
  use solution, only: solution_t
  use spring_check, only: has_body_springs, spring_advice, spring_force, spring_share
  use strategy, only: coupling_once
  use system, only: cpu_seconds, peak_memory_mb
  use text, only: string_t, to_text
  implicit none
  private
  public :: summary_lines

contains

  !> The short table at the end of a run.
  subroutine summary_lines(facts, scene, equations, solution, totals, lines)
    type(run_facts_t), intent(in) :: facts
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    type(string_t), allocatable :: table(:), cut_lines(:)
    integer :: t

    allocate (lines(0))
    call put('')
    call put(facts%status//': '//facts%stop_reason)
    call put('  time '//to_text(solution%time)//' of '//to_text(scene%strategy%end_time)//', '//to_text(solution%step) &
             //' steps, '//to_text(solution%iterations)//' iterations, '//to_text(solution%cutbacks)//' cutbacks')
    call put('  volume drift '//to_text(100*(totals%volume/solution%initial_volume - 1), 3)//' % (without elastic strain ' &
             //to_text(100*unloaded_drift(solution, totals), 3)//' %), energy imbalance ' &
             //to_text(100*energy_imbalance(solution), 3)//' %, worst linear residual ' &
             //to_text(solution%worst_linear_residual, 2))
    call warn('energy imbalance '//to_text(100*energy_imbalance(solution), 3)//' %', imbalance_advice(solution))
    if (solution%work%damping > 0) &
      call put('  damping of steps that had no equilibrium near took '//to_text(100*damped_share(solution), 3) &
               //' % of the energy that passed')
    call warn('damping '//to_text(100*damped_share(solution), 3)//' % of the energy that passed', damping_advice(solution))
    cut_lines = lines_of_cuts(scene, solution)
    do t = 1, size(cut_lines)
      call put(cut_lines(t)%s)
    end do
    if (has_heat(scene)) &
      call put('  heat taken up '//to_text(circumference(scene)*solution%heat_stored, 4)//', come in ' &
               //to_text(circumference(scene)*solution%heat_in, 4)//', released ' &
               //to_text(circumference(scene)*solution%heat_released, 4)//'; imbalance ' &
               //to_text(100*heat_imbalance(solution), 2)//' % of what passed')
    call put_due()
    if (has_heat(scene)) call put_heat(solution%heat)
    if (scene%follows_path) then
      call put('  errors of the path within steps: motion '//to_text(100*motion_error(solution%path), 3)//' % in sum, stress ' &
               //to_text(100*stress_error(solution%path), 3)//' % at the end, ' &
               //to_text(100*solution%path%stress_worst, 3)//' % at worst; '//to_text(solution%path%shortened) &
               //' attempts shortened for them, '//to_text(solution%path%above)//' steps above the bounds')
      call warn('error of the motion by the path within steps '//to_text(100*motion_error(solution%path), 3)//' %', &
                motion_advice(solution%path))
      call warn('error of the stress by the path within steps ' &
                //to_text(100*stress_error(solution%path), 3)//' %', stress_advice(solution%path))
    end if
    if (has_body_springs(scene)) then
      call put('  weak springs of bodies: force '//to_text(circumference(scene)*spring_force(scene, solution), 3) &
               //' at the end, '//to_text(100*spring_share(scene, solution), 3)//' % of the largest force')
      call warn('weak springs carry '//to_text(100*spring_share(scene, solution), 3)//' % of the largest force', &
                spring_advice(scene, solution))
    end if
    do t = 1, size(facts%warnings)
      call put('  WARNING: '//facts%warnings(t)%s)
    end do
    if (size(scene%dies) == 0) then
      call put('  no contact')
    else
      call put('  largest penetration at points of contact '//depth(solution%worst_penetration, solution%worst_penetration_ratio) &
               //'; between them too '//depth(solution%worst_sample, solution%worst_sample_ratio))
      call warn('points of contact are deeper in a die than allowed', advice_at_points(scene, solution))
      call warn('sides between points of contact are deeper in a die than allowed', advice_between_points(scene, solution))
      if (len(sides_that_span(scene, solution)) > 0) call put('  '//sides_that_span(scene, solution))
    end if
    call put('  '//to_text(sum(equations%solves%neq))//' equations, '//to_text(solid_elements(scene))//' elements, ' &
             //to_text(facts%threads)//' threads, '//to_text(facts%wall, 4)//' s on the wall, ' &
             //to_text(cpu_seconds(), 4)//' s of processor, '//to_text(peak_memory_mb(), 4)//' MB')
    call closing_lines(facts%closing, table)
    lines = [lines, table]
    call put('  seconds by effect and task:')
    do t = 1, equations%timers%size()
      call put('    '//equations%timers%name(t)//'  '//to_text(equations%timers%seconds(t), 4)//' s in ' &
               //to_text(equations%timers%calls(t))//' calls')
    end do
    call put('')

  contains

    !> What no step has released yet.
    subroutine put_due()
      real(wp) :: heat

      if (.not. (has_heat(scene) .and. allocated(equations%laws)) .or. scene%strategy%coupling /= coupling_once) return
      heat = pending(scene, equations%laws, equations%drivers, solution)
      if (abs(heat) > 0) call put('  heat of friction and plastic work of the last step, which the next one would release: ' &
                                  //to_text(circumference(scene)*heat, 4))
    end subroutine put_due

    !> What accuracy in time was had, and temperatures that cannot be there.
    subroutine put_heat(heat)
      type(heat_record_t), intent(in) :: heat

      if (heat%estimated > 0) &
        call put('  estimated error in time: largest of a step '//to_text(heat%error_worst, 3)//', sum of all ' &
                 //to_text(heat%error_sum, 3)//', at the end '//to_text(heat%error_now, 3)//', at most ' &
                 //to_text(heat%error_largest, 3)//'; '//to_text(heat%shortened)//' attempts shortened for it, ' &
                 //to_text(heat%above)//' steps of the least length above what is allowed')
      if (heat%outside + heat%fallbacks > 0) &
        call put('  temperatures beyond those around them in '//to_text(heat%outside)//' steps, by up to ' &
                 //to_text(heat%excess, 3)//'; '//to_text(heat%fallbacks)//' steps made again to keep to them')
    end subroutine put_heat

    subroutine put(line)
      character(len=*), intent(in) :: line

      lines = [lines, string_t(line)]
    end subroutine put

    subroutine warn(what, advice)
      character(len=*), intent(in) :: what, advice

      if (len(advice) > 0) call put('  WARNING: '//what//': '//advice)
    end subroutine warn

    !> A depth, and its share of what is allowed where a law states that.
    function depth(length, ratio) result(words)
      real(wp), intent(in) :: length, ratio
      character(len=:), allocatable :: words

      words = to_text(length, 3)
      if (states_penetration(scene)) words = words//', '//to_text(ratio, 3)//' of the allowed'
    end function depth

  end subroutine summary_lines

end module summary_table
