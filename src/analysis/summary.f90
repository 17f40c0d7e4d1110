!> `summary.json` for scripts.
module summary
  use closing_table, only: add_closing
  use cut_report, only: add_cuts
  use elem_api, only: totals_t
  use energy_balance, only: missing_energy
  use energy_books, only: spring_energy
  use equations, only: equations_t
  use errors, only: error_t
  use hash, only: sha256
  use heat_books, only: has_heat
  use history, only: circumference
  use json_writer, only: json_t
  use law_api, only: find_parameter
  use pending_heat, only: pending
  use restart_report, only: add_restart
  use restore_balance, only: balance_t
  use run_facts, only: run_facts_t
  use scene, only: scene_t, solid_elements
  use solution, only: solution_t
  use steel_diagrams, only: add_diagrams
  use summary_checks, only: add_advice, add_checks, add_estimate
  use summary_effects, only: add_effects, add_seconds
  use system, only: cpu_seconds, peak_memory_mb
  use wall_reactions, only: add_wall_reactions
  implicit none
  private
  public :: write_summary

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
    call json%add('patch_elements', equations%patch_size)
    call json%add('symmetric', all(equations%solves%pattern%symmetric))
    call json%add('factorisations', sum(equations%solves%solver%factorised))
    call json%add('factorisations_spared', sum(equations%solves%solver%reused))
    call add_warnings(json, facts)
    call add_wall_reactions(json, scene, solution)
    call add_steels(json, scene, equations)
    call add_effects(json, scene, equations)
    call add_seconds(json, equations)
    call add_closing(json, facts%closing)
    if (scene%remesh%estimate) call add_estimate(json, scene, solution)
    if (allocated(balance)) call add_restart(json, scene, solution, balance)
    call add_checks(json, scene, solution, totals)
    call add_advice(json, scene, solution)
    call json%begin_object('energy')
    call add_work(json, scene, solution)
    if (has_heat(scene)) then
      call json%add('heat_stored', circumference(scene)*solution%heat_stored)
      call json%add('heat_in', circumference(scene)*solution%heat_in)
      call json%add('heat_released', circumference(scene)*solution%heat_released)
      if (allocated(equations%laws)) &
        call json%add('heat_due', circumference(scene)*pending(scene, equations%laws, equations%drivers, solution))
    end if
    call json%end_object()
    call json%end_object()
    call json%write_file(path, error)
  end subroutine write_summary

  !> What speaks against the result: what the listing tells as WARNING.
  subroutine add_warnings(json, facts)
    type(json_t), intent(inout) :: json
    type(run_facts_t), intent(in) :: facts
    integer :: k

    call json%add('warning_count', size(facts%told))
    call json%begin_array('warnings')
    do k = 1, size(facts%told)
      associate (warning => facts%told(k))
        call json%begin_object()
        call json%add('text', warning%text)
        if (len(warning%operation) > 0) call json%add('operation', warning%operation)
        if (len(warning%check) > 0) call json%add('check', warning%check)
        call json%end_object()
      end associate
    end do
    call json%end_array()
  end subroutine add_warnings

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
      call json%add('damping', factor*work%damping)
      call json%add('drag', factor*work%drag)
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

end module summary
