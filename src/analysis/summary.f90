!> `summary.json` for scripts, and the table a run ends with.
module summary
  use closing_table, only: add_closing, closing_lines, closing_t
  use effects, only: effect_t
  use elem_api, only: totals_t
  use cut_report, only: add_cuts, lines_of_cuts
  use energy_books, only: energy_imbalance, imbalance_advice, missing_energy, spring_energy
  use equations, only: equations_t
  use errors, only: error_t
  use fields, only: displacement_field
  use hash, only: sha256
  use heat_books, only: has_heat, heat_imbalance
  use heat_record, only: heat_record_t
  use history, only: circumference
  use json_writer, only: json_t
  use kinds, only: i8, wp
  use law_api, only: find_parameter
  use path_advice, only: motion_advice, stress_advice
  use path_record, only: motion_error, stress_error
  use phase_books, only: fraction_slack, has_fractions
  use penetration_advice, only: advice_at_points, advice_between_points, sides_that_span, states_penetration
  use restart_report, only: add_restart
  use restore_balance, only: balance_t
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use spring_check, only: has_body_springs, spring_advice, spring_force, spring_share
  use steel_diagrams, only: add_diagrams
  use system, only: cpu_seconds, peak_memory_mb
  use text, only: string_t, to_text
  implicit none
  private
  public :: run_facts_t, write_summary, summary_lines

  !> Facts of the run.
  type :: run_facts_t
    character(len=:), allocatable :: version, deck, deck_text, status, stop_reason, blas
    !> Parameters set on the command line, NAME=VALUE.
    type(string_t), allocatable :: overrides(:)
    !> What is seldom meant of the deck (physics_check).
    type(string_t), allocatable :: warnings(:)
    integer :: exit_code = 0, threads = 1
    real(wp) :: wall = 0.0_wp
    !> Errors that are estimated, and what half of them costs.
    type(closing_t) :: closing
  end type run_facts_t

contains

  subroutine write_summary(path, facts, scene, equations, solution, totals, balance, error)
    character(len=*), intent(in) :: path
    type(run_facts_t), intent(in) :: facts
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    type(balance_t), allocatable, intent(in) :: balance   !! of a restart on a new mesh
    type(error_t), allocatable, intent(out) :: error
    type(json_t) :: json
    integer :: k

    call json%begin_object()
    call json%add('program', 'lagamine')
    call json%add('version', facts%version)
    call json%add('deck', facts%deck)
    call json%add('title', scene%title)
    if (scene%operation > 0) then
      call json%add('operation', scene%operation_name)
      call json%add('operation_number', scene%operation)
      call json%add('operations', scene%operations)
    end if
    call json%begin_object('parameters')
    do k = 1, size(facts%overrides)
      associate (word => facts%overrides(k)%s)
        call json%add(word(:index(word, '=') - 1), word(index(word, '=') + 1:))
      end associate
    end do
    call json%end_object()
    call json%add('deck_sha256', sha256(facts%deck_text))
    call json%add('status', facts%status)
    call json%add('exit_code', facts%exit_code)
    call json%add('stop_reason', facts%stop_reason)
    call json%add('time', solution%time)
    call json%add('end_time', scene%strategy%end_time)
    call json%add('steps', solution%step)
    call json%add('iterations', solution%iterations)
    call json%add('cutbacks', solution%cutbacks)
    call json%add('remeshings', scene%generation - max(scene%operation, 1))
    call add_cuts(json, scene, solution)
    call json%add('initial_volume', circumference(scene)*solution%initial_volume)
    call json%add('wall_s', facts%wall)
    call json%add('cpu_s', cpu_seconds())
    call json%add('peak_rss_mb', peak_memory_mb())
    call json%add('threads', facts%threads)
    call json%add('blas', facts%blas)
    call json%add('dofs', sum(equations%solves%neq))
    call json%add('elements', solid_elements(scene))
    call json%add('linear_solver', equations%solves(1)%solver%row%name)
    call json%add('symmetric', all(equations%solves%pattern%symmetric))
    call json%add('factorisations', sum(equations%solves%solver%factorised))
    call json%add('factorisations_spared', sum(equations%solves%solver%reused))
    call json%begin_array('warnings')
    do k = 1, size(facts%warnings)
      call json%begin_object()
      call json%add('text', facts%warnings(k)%s)
      call json%end_object()
    end do
    call json%end_array()
    call add_steels(json, scene, equations)
    call add_effects(json, scene, equations)
    call add_seconds(json, equations)
    call add_closing(json, facts%closing)
    if (scene%remesh%estimate) call add_estimate(json, scene, solution)
    if (allocated(balance)) call add_restart(json, scene, solution, balance)
    call json%begin_object('checks')
    call json%add('volume_drift', totals%volume/solution%initial_volume - 1)
    call json%add('volume_drift_unloaded', unloaded_drift(solution, totals))
    call json%add('max_penetration', solution%worst_penetration)
    call json%add('max_penetration_over_allowed', solution%worst_penetration_ratio)
    call json%add('max_penetration_sampled', solution%worst_sample)
    call json%add('max_penetration_sampled_over_allowed', solution%worst_sample_ratio)
    call json%add('worst_linear_residual', solution%worst_linear_residual)
    call json%add('least_dissipation', solution%least_dissipation)
    if (has_motion(scene)) call json%add('energy_imbalance', energy_imbalance(solution))
    if (has_heat(scene)) call json%add('heat_imbalance', heat_imbalance(solution))
    if (has_heat(scene)) call add_heat(json, solution%heat)
    if (scene%follows_path) call add_path(json, solution)
    if (has_body_springs(scene)) then
      call json%add('spring_force', circumference(scene)*spring_force(scene, solution))
      call json%add('spring_share', spring_share(scene, solution))
    end if
    call json%add('spurious_mode', solution%worst_spurious)
    if (has_fractions(scene)) then
      call json%add('phase_fractions', solution%worst_fraction)
      call json%add('phase_fractions_allowed', fraction_slack)
    end if
    call json%end_object()
    call add_advice(json, scene, solution)
    call json%begin_object('energy')
    call add_work(json, scene, solution)
    if (has_heat(scene)) then
      call json%add('heat_stored', circumference(scene)*solution%heat_stored)
      call json%add('heat_in', circumference(scene)*solution%heat_in)
      call json%add('heat_released', circumference(scene)*solution%heat_released)
    end if
    call json%end_object()
    call json%end_object()
    call json%write_file(path, error)
  end subroutine write_summary

  !> Where the work came from and where it went. Of the full circumference when the scene is axisymmetric.
  subroutine add_work(json, scene, solution)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution

    associate (work => solution%work, factor => circumference(scene))
      call json%add('external_work', factor*solution%external_work)
      call json%add('work_of_supports', factor*work%supports)
      call json%add('work_of_dies', factor*work%dies)
      call json%add('work_of_loads', factor*work%loads)
      call json%add('work_of_section', factor*work%section)
      call json%add('work_of_heat', factor*work%heat)
      call json%add('elastic', factor*work%elastic)
      call json%add('plastic', factor*work%flow)
      call json%add('friction', factor*solution%friction_work)
      call json%add('contact', factor*work%contact)
      call json%add('springs', factor*spring_energy(scene, solution))
      call json%add('overlap', factor*work%overlap)
      call json%add('remeshing', factor*work%remeshing)
      call json%add('missing', factor*missing_energy(solution))
      call json%add('passed', factor*work%passed)
    end associate
  end subroutine add_work

  !> Steels with phases, and what makes temperatures and times of the deck degC and seconds.
  subroutine add_steels(json, scene, equations)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer :: m, zero, time

    if (.not. any([(allocated(scene%materials(m)%steel), m=1, size(scene%materials))])) return
    call json%begin_array('steels')
    do m = 1, size(scene%materials)
      associate (material => scene%materials(m))
        if (.not. allocated(material%steel)) cycle
        zero = find_parameter(equations%laws(material%law_id), 'ZERO')
        time = find_parameter(equations%laws(material%law_id), 'TIME')
        if (zero == 0 .or. time == 0) cycle
        if (.not. material%values(time) > 0) cycle   ! the phases are those of another law
        call json%begin_object()
        call json%add('name', material%steel%name)
        call json%add('law', material%name)
        call json%add('added_for_degC', material%values(zero))
        call json%add('seconds', material%values(time))
        call add_diagrams(json, material%steel)
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_steels

  !> Balance of heat in time, and temperatures that cannot be there.
  subroutine add_heat(json, heat)
    type(json_t), intent(inout) :: json
    type(heat_record_t), intent(in) :: heat

    if (heat%estimated > 0) then
      call json%add('error_in_time_worst', heat%error_worst)
      call json%add('error_in_time_sum', heat%error_sum)
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
    call add('path_error_motion', motion_advice(solution%path))
    call add('path_error_stress', stress_advice(solution%path))
    if (has_body_springs(scene)) call add('spring_share', spring_advice(scene, solution))
    call add('max_penetration_over_allowed', advice_at_points(scene, solution))
    call add('max_penetration_sampled_over_allowed', advice_between_points(scene, solution))
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
        call json%add('limit', trigger%limit)
        if (trigger%group > 0) then
          call json%add('group', scene%groups(trigger%group)%name)
          call json%add('element', trigger%element)
        end if
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_estimate

  !> Calls and seconds of each effect: an effect's time is that of its elements.
  subroutine add_effects(json, scene, equations)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer(i8) :: calls
    real(wp) :: seconds
    integer :: k

    call json%begin_object('effects')
    do k = 1, size(scene%effects)
      call booked(equations, scene%effects(k), calls, seconds)
      call json%begin_object(scene%effects(k)%name)
      call json%add('on', scene%effects(k)%on)
      call json%add('why', scene%effects(k)%why)
      call json%add('adds', scene%effects(k)%adds)
      if (len(scene%effects(k)%within) > 0) call json%add('within', scene%effects(k)%within)
      call json%add('calls', calls)
      call json%add('wall_s', seconds)
      call json%end_object()
    end do
    call json%end_object()
  end subroutine add_effects

  !> Calls and seconds in the ledger under the effect's name. An effect within another's loop is called
  !> whenever that is, and its seconds are among the other's.
  subroutine booked(equations, effect, calls, seconds)
    type(equations_t), intent(in) :: equations
    type(effect_t), intent(in) :: effect
    integer(i8), intent(out) :: calls
    real(wp), intent(out) :: seconds
    integer :: t

    calls = 0
    seconds = 0
    if (.not. effect%on) return
    do t = 1, equations%timers%size()
      if (equations%timers%name(t) == effect%within) calls = equations%timers%calls(t)
      if (equations%timers%name(t) /= effect%name) cycle
      calls = equations%timers%calls(t)
      seconds = equations%timers%seconds(t)
    end do
  end subroutine booked

  !> Where the rest of the time went.
  subroutine add_seconds(json, equations)
    type(json_t), intent(inout) :: json
    type(equations_t), intent(in) :: equations
    integer :: t

    call json%begin_object('seconds')
    do t = 1, equations%timers%size()
      call json%add(equations%timers%name(t), equations%timers%seconds(t))
    end do
    call json%end_object()
  end subroutine add_seconds

  pure function has_motion(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes

    yes = scene%fields(displacement_field)%declared
  end function has_motion

  !> Change of volume without elastic strain and thermal expansion, over the first one.
  pure function unloaded_drift(solution, totals) result(share)
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    real(wp) :: share

    share = (totals%unloaded_volume - solution%work%grown)/solution%initial_volume - 1
  end function unloaded_drift

  pure function solid_elements(scene) result(n)
    type(scene_t), intent(in) :: scene
    integer :: n
    integer :: g

    n = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) n = n + size(scene%groups(g)%connectivity, 2)
    end do
  end function solid_elements

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
    cut_lines = lines_of_cuts(scene, solution)
    do t = 1, size(cut_lines)
      call put(cut_lines(t)%s)
    end do
    if (has_heat(scene)) &
      call put('  heat taken up '//to_text(circumference(scene)*solution%heat_stored, 4)//', come in ' &
               //to_text(circumference(scene)*solution%heat_in, 4)//', released ' &
               //to_text(circumference(scene)*solution%heat_released, 4)//'; imbalance ' &
               //to_text(100*heat_imbalance(solution), 2)//' % of what passed')
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

    !> What accuracy in time was had, and temperatures that cannot be there.
    subroutine put_heat(heat)
      type(heat_record_t), intent(in) :: heat

      if (heat%estimated > 0) &
        call put('  estimated error in time: largest of a step '//to_text(heat%error_worst, 3)//', sum of all ' &
                 //to_text(heat%error_sum, 3)//'; '//to_text(heat%shortened)//' attempts shortened for it, ' &
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

end module summary
