!> The table that a run ends with, in the listing and on the screen.
module summary_table
  use closing_table, only: closing_lines
  use cut_report, only: lines_of_cuts
  use elem_api, only: totals_t
  use energy_balance, only: damped_share, energy_imbalance
  use equations, only: equations_t
  use heat_books, only: has_heat, heat_imbalance
  use history, only: circumference
  use kinds, only: wp
  use path_record, only: motion_error, stress_error
  use pending_heat, only: pending
  use penetration_advice, only: sides_that_span, states_penetration
  use run_facts, only: run_facts_t, unloaded_drift
  use run_warnings, only: with_operation
  use scene, only: operation_of, scene_t, solid_elements
  use solution, only: solution_t
  use spring_check, only: has_body_springs, spring_force, spring_share
  use strategy, only: coupling_once
  use system, only: cpu_seconds, peak_memory_mb
  use text, only: add_text, percent, string_t, to_text
  use wall_reactions, only: list_wall_reactions
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
    type(string_t), allocatable :: table(:)
    integer :: t

    allocate (lines(0))
    call add_text(lines, '')
    call add_text(lines, facts%status//': '//facts%stop_reason)
    call add_text(lines, '  time '//to_text(solution%time)//' of '//to_text(scene%strategy%end_time)//', ' &
                  //to_text(solution%step)//' steps, '//to_text(solution%iterations)//' iterations, ' &
                  //to_text(solution%cutbacks)//' cutbacks')
    call add_balances(solution, totals, lines)
    lines = [lines, lines_of_cuts(scene, solution)]
    if (has_heat(scene)) call add_heat(scene, equations, solution, lines)
    if (scene%follows_path) call add_path(solution, lines)
    if (has_body_springs(scene)) call add_springs(scene, solution, lines)
    call add_contact(scene, solution, lines)
    call with_operation(facts%told, operation_of(scene), table)
    do t = 1, size(table)
      call add_text(lines, '  WARNING: '//table(t)%s)
    end do
    call list_wall_reactions(scene, solution, lines)
    call add_text(lines, '  '//to_text(sum(equations%solves%neq))//' equations, '//to_text(solid_elements(scene))//' elements, ' &
                  //to_text(facts%threads)//' threads, '//to_text(facts%wall, 4)//' s on the wall, ' &
                  //to_text(cpu_seconds(), 4)//' s of processor, '//to_text(peak_memory_mb(), 4)//' MB')
    call closing_lines(facts%closing, table)
    lines = [lines, table]
    call add_text(lines, '  seconds by effect and task:')
    do t = 1, equations%timers%size()
      call add_text(lines, '    '//equations%timers%name(t)//'  '//to_text(equations%timers%seconds(t), 4)//' s in ' &
                    //to_text(equations%timers%calls(t))//' calls')
    end do
    call add_text(lines, '')
  end subroutine summary_lines

  !> Volume, energy, linear equations, and damping.
  subroutine add_balances(solution, totals, lines)
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    type(string_t), allocatable, intent(inout) :: lines(:)

    call add_text(lines, '  volume drift '//percent(totals%volume/solution%initial_volume - 1)//' (without elastic strain ' &
                  //percent(unloaded_drift(solution, totals))//'), energy imbalance '//percent(energy_imbalance(solution)) &
                  //', worst linear residual '//to_text(solution%worst_linear_residual, 2))
    if (solution%work%damping > 0) call add_text(lines, '  damping of steps that had no equilibrium near took ' &
                                                 //percent(damped_share(solution))//' of the energy that passed')
  end subroutine add_balances

  !> Heat that was taken up, what no step has released yet, what accuracy in time was had, and temperatures that cannot be there.
  subroutine add_heat(scene, equations, solution, lines)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: lines(:)
    real(wp) :: due

    call add_text(lines, '  heat taken up '//to_text(circumference(scene)*solution%heat_stored, 4)//', come in ' &
                  //to_text(circumference(scene)*solution%heat_in, 4)//', released ' &
                  //to_text(circumference(scene)*solution%heat_released, 4)//'; imbalance ' &
                  //to_text(100*heat_imbalance(solution), 2)//' % of what passed')
    due = 0
    if (allocated(equations%laws) .and. scene%strategy%coupling == coupling_once) &
      due = pending(scene, equations%laws, equations%drivers, solution)
    if (abs(due) > 0) &
      call add_text(lines, '  heat of friction and plastic work of the last step, which the next one would release: ' &
                    //to_text(circumference(scene)*due, 4))
    associate (heat => solution%heat)
      if (heat%estimated > 0) &
        call add_text(lines, '  estimated error in time: largest of a step '//to_text(heat%error_worst, 3)//', sum of all ' &
                      //to_text(heat%error_sum, 3)//', at the end '//to_text(heat%error_now, 3)//', at most ' &
                      //to_text(heat%error_largest, 3)//'; '//to_text(heat%shortened)//' attempts shortened for it, ' &
                      //to_text(heat%above)//' steps of the least length above what is allowed')
      if (heat%outside + heat%fallbacks > 0) &
        call add_text(lines, '  temperatures beyond those around them in '//to_text(heat%outside)//' steps, by up to ' &
                      //to_text(heat%excess, 3)//'; '//to_text(heat%fallbacks)//' steps made again to keep to them')
    end associate
  end subroutine add_heat

  !> Errors of the path within steps.
  subroutine add_path(solution, lines)
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: lines(:)

    associate (path => solution%path)
      call add_text(lines, '  errors of the path within steps: motion '//percent(motion_error(path))//' in sum, stress ' &
                    //percent(stress_error(path))//' at the end, '//percent(path%stress_worst)//' at worst; ' &
                    //to_text(path%shortened)//' attempts shortened for them, '//to_text(path%above)//' steps above the bounds')
    end associate
  end subroutine add_path

  !> Weak springs of bodies.
  subroutine add_springs(scene, solution, lines)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: lines(:)

    call add_text(lines, '  weak springs of bodies: force '//to_text(circumference(scene)*spring_force(scene, solution), 3) &
                  //' at the end, '//percent(spring_share(scene, solution))//' of the largest force')
  end subroutine add_springs

  !> Penetrations.
  subroutine add_contact(scene, solution, lines)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: lines(:)

    if (size(scene%dies) == 0) then
      call add_text(lines, '  no contact')
      return
    end if
    call add_text(lines, '  largest penetration at points of contact ' &
                  //depth(scene, solution%worst_penetration, solution%worst_penetration_ratio) &
                  //'; between them too '//depth(scene, solution%worst_sample, solution%worst_sample_ratio))
    if (solution%penalty_share > 1) &
      call add_text(lines, '  elastic bodies bear much at contact, and press with '//to_text(solution%penalty_share, 3) &
                    //' times the penalties of PENETR')
    if (len(sides_that_span(scene, solution)) > 0) call add_text(lines, '  '//sides_that_span(scene, solution))
  end subroutine add_contact

  !> A depth, and its share of what is allowed where a law states that.
  function depth(scene, length, ratio) result(words)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: length, ratio
    character(len=:), allocatable :: words

    words = to_text(length, 3)
    if (states_penetration(scene)) words = words//', '//to_text(ratio, 3)//' of the allowed'
  end function depth

end module summary_table
