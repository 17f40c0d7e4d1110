!> What a run ends with, whatever has happened: warnings, what it has cost and reached, summary and listing.
module run_ending
  use absolute_cold, only: warn_of_absolute_cold, warn_of_vapour
  use accuracy_plan, only: accuracy_lines, accuracy_warning, judge_run
  use accuracy_rules, only: fineness_t
  use accuracy_samples, only: add_cost, read_sample
  use blas, only: blas_build, blas_core_name
  use closing_facts, only: close_cycle, close_run
  use coarse_heat, only: warn_of_coarse_heat
  use coarse_shape, only: warn_of_coarse_shape
  use confinement, only: warn_of_confinement
  use cost_file, only: cost_t
  use crossed_bodies, only: warn_of_crossed_bodies
  use cut_report, only: warn_of_webs
  use errors, only: error_t, exit_done, exit_no_convergence
  use failed_checks, only: list_failed_checks
  use fields, only: find_field
  use floating_bodies, only: warn_of_floating_bodies, warn_of_idle_dies
  use folded_bodies, only: warn_of_folds
  use folding_bodies, only: law_of_folds
  use heated_steels, only: warn_of_missing_austenite
  use held_steels, only: warn_of_held_steels
  use kinds, only: wp
  use listing, only: close_listing, end_progress, list_lines, list_note
  use narrow_loads, only: narrow_words
  use passed_planes, only: warn_of_passed_planes
  use pilot_differences, only: sample_t
  use run_facts, only: run_facts_t
  use run_options, only: run_options_t
  use run_record, only: run_t
  use run_warnings, only: add_warning, join_warnings, warning_t
  use run_version, only: blas_words, version_text
  use scene, only: operation_of, scene_t
  use strategy, only: coupling_monolithic, scheme_tr_bdf2
  use solution, only: solution_t
  use standard_streams, only: print_line, print_lines
  use summary, only: write_summary
  use summary_table, only: summary_lines
  use system, only: join_path
  use text, only: add_text, string_t, to_text
  use thinned_sheets, only: warn_of_thinned_sheets
  use unsettled_contact, only: warn_of_unsettled_contact
  use worn_mesh, only: warn_of_worn_mesh
  implicit none
  private
  public :: end_run, suspend_run

contains

  !> End a run, or an operation of one. `error` is why it cannot go on, where it cannot; else what has failed here.
  subroutine end_run(options, scene, solution, nbefore, run, facts, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution   !! keeps the warnings of an operation that others follow
    integer, intent(in) :: nbefore   !! warnings that were reported before the run
    type(run_t), intent(inout) :: run
    type(run_facts_t), intent(inout) :: facts   !! with those warnings and seconds
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: late
    type(string_t), allocatable :: lines(:), again(:)

    call end_progress(run%listing)
    if (allocated(error)) call add_warnings(facts%warnings, error)
    call warn_at_end(scene, solution, run, facts%warnings)
    allocate (again(0))
    call warn_again(scene, solution, run, again)
    facts%version = version_text
    facts%deck = options%deck
    facts%deck_text = run%deck_text
    facts%overrides = options%overrides
    facts%status = merge('done   ', 'stopped', run%exit_code == exit_done)
    facts%status = trim(facts%status)
    facts%stop_reason = run%stop_reason
    facts%exit_code = run%exit_code
    facts%threads = run%equations%team%most
    facts%blas = blas_words(blas_build(), blas_core_name())
    call close_run(scene, run%equations, solution, run%totals%volume, facts%closing)
    ! of an operation without REMSH too, where others have it
    if (run%has_new_meshes .or. (scene%accuracy%asked > 0 .and. allocated(options%fineness))) &
      call close_cost(options, scene, solution, run, facts, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
    call gather_warnings(scene, others_follow(scene, run), again, solution, facts)
    call summary_lines(facts, scene, run%equations, solution, run%totals, lines)
    call list_lines(run%listing, lines)
    call close_listing(run%listing)
    call write_summary(join_path(run%folder, summary_name(scene, run)), facts, scene, run%equations, solution, run%totals, &
                       run%balance, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
    if (.not. allocated(error)) call print_end(options, scene, run%exit_code, facts, nbefore, lines, error)
  end subroutine end_run

  !> A run stops to go on at once with contact that a body needs which has met itself: it is noted, and what it has cost so far.
  subroutine suspend_run(options, scene, solution, run, facts, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(run_facts_t), intent(inout) :: facts   !! with its seconds
    type(error_t), allocatable, intent(out) :: error
    integer :: material

    call end_progress(run%listing)
    call close_run(scene, run%equations, solution, run%totals%volume, facts%closing)
    if (run%has_new_meshes .or. (scene%accuracy%asked > 0 .and. allocated(options%fineness))) &
      call close_cost(options, scene, solution, run, facts, error)
    material = law_of_folds(scene, run%equations%laws, run%folding)
    call list_note(run%listing, 'note: step '//to_text(solution%step + 1)//': '//run%folds//'; from here on its sides press ' &
                   //'on one another, by LAW '//scene%materials(material)%name)
    call close_listing(run%listing)
  end subroutine suspend_run

  !> All that the summary tells. An operation that others follow tells what is its own, and hands it on with what it knows of those
  !> before it: the summary of the run tells it all.
  subroutine gather_warnings(scene, follows, again, solution, facts)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: follows              !! another operation does
    type(string_t), intent(in) :: again(:)      !! (nwarning) that are judged again at the end of the next operation
    type(solution_t), intent(inout) :: solution
    type(run_facts_t), intent(inout) :: facts
    type(warning_t), allocatable :: own(:), checks(:), all(:)
    integer :: k, j

    allocate (own(0))
    do k = 1, size(facts%warnings)
      call add_warning(own, operation_of(scene), facts%warnings(k)%s)
    end do
    do k = 1, size(again)
      call add_warning(own, operation_of(scene), again(k)%s, again=.true.)
    end do
    call list_failed_checks(scene, solution, checks)
    do k = 1, size(checks)
      call add_warning(own, checks(k)%operation, checks(k)%text, checks(k)%check)
    end do
    call join_warnings(solution%warnings, own, all)
    if (.not. follows) then
      call move_alloc(all, facts%told)
      return
    end if
    ! what an earlier operation has said is not said again, where nothing else is found
    allocate (facts%told(0))
    do k = 1, size(own)
      if (any([(own(k)%text == all(j)%text, j=1, size(all))])) &
        call add_warning(facts%told, own(k)%operation, own(k)%text, own(k)%check, own(k)%again)
    end do
    call move_alloc(all, solution%warnings)
  end subroutine gather_warnings

  !> What records of this operation or run, and the state at its end, give cause to say.
  subroutine warn_at_end(scene, solution, run, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(in) :: run
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    character(len=:), allocatable :: words

    call warn_of_confinement(scene, solution, warnings)
    words = narrow_words(scene, solution)
    if (len(words) > 0) call add_text(warnings, words)
    call warn_of_unsettled_contact(scene, solution, warnings)
    if (run%exit_code /= exit_done) return
    call warn_of_webs(scene, solution, warnings)
    call warn_of_floating_bodies(scene, run%equations%laws, run%equations%loose, solution, warnings)
    call warn_of_idle_dies(scene, run%equations, solution, run%totals%volume, warnings)
  end subroutine warn_at_end

  !> What is judged by a state and by records that go on from one operation to the next: each of them says it anew.
  subroutine warn_again(scene, solution, run, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(in) :: run
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)

    call warn_of_passed_planes(scene, solution, warnings)
    if (solution%unstable_steps > 0) call add_text(warnings, 'equilibria are not stable in '//to_text(solution%unstable_steps) &
      //' of '//to_text(solution%step)//' steps, first at time '//to_text(solution%unstable_from, 6)//': a perfect part stays ' &
      //'in them, any other buckles or necks (move nodes by a thousandth of the thickness to see how)')
    if (run%exit_code /= exit_done) return
    call warn_of_coarse_heat(scene, solution, warnings)
    call warn_of_coarse_shape(solution, warnings)
    call warn_of_folds(scene, warnings)
    call warn_of_thinned_sheets(scene, solution, warnings)
    call warn_of_worn_mesh(scene, solution, warnings)
    call warn_of_missing_austenite(scene, solution, warnings)
    call warn_of_held_steels(scene, solution, warnings)
    call warn_of_absolute_cold(scene, solution, warnings)
    call warn_of_vapour(scene, solution, warnings)
    call warn_of_crossed_bodies(scene, run%equations%free_sides, solution, warnings)
  end subroutine warn_again

  !> The summary on standard output; with progress, only what is new in it at the end of a run.
  subroutine print_end(options, scene, exit_code, facts, nbefore, lines, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: exit_code
    type(run_facts_t), intent(in) :: facts
    integer, intent(in) :: nbefore           !! warnings that were reported before the run
    type(string_t), intent(in) :: lines(:)   !! (nline) of the summary
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    type(string_t), allocatable :: reached(:)

    if (.not. (options%quiet .or. options%progress)) then
      if (scene%operation > 0) call print_line('operation '//scene%operation_name, late)
      call print_lines(lines, late)
      ! scripts read first why a run has stopped
      if (allocated(late) .and. exit_code == exit_done) call move_alloc(late, error)
    else if (options%progress .and. exit_code == exit_done) then
      if (allocated(facts%closing%accuracy)) then
        call accuracy_lines(facts%closing%accuracy, reached)
        call print_lines(reached, error)
      end if
      if (.not. allocated(error)) call print_lines(closing_warnings(lines, facts%warnings(:nbefore)), error)
    end if
  end subroutine print_end

  !> Warnings among the lines of the summary that were not printed before the run.
  pure function closing_warnings(lines, before) result(list)
    type(string_t), intent(in) :: lines(:)    !! (nline) of the summary
    type(string_t), intent(in) :: before(:)   !! (nwarning) of the deck
    type(string_t), allocatable :: list(:)
    integer :: k, j

    allocate (list(0))
    do k = 1, size(lines)
      if (index(lines(k)%s, 'WARNING: ') == 0) cycle
      do j = 1, size(before)
        if (index(lines(k)%s, before(j)%s) > 0) exit
      end do
      if (j > size(before)) call add_text(list, trim(adjustl(lines(k)%s)))
    end do
  end function closing_warnings

  !> What was seen of the deck before the run may be why it cannot go on.
  pure subroutine add_warnings(warnings, error)
    type(string_t), intent(in) :: warnings(:)   !! (nwarning) of the deck
    type(error_t), intent(inout) :: error
    character(len=:), allocatable :: words
    integer :: k

    if (error%code /= exit_no_convergence .or. size(warnings) == 0) return
    words = 'WARNING before the run: '//warnings(1)%s
    do k = 2, size(warnings)
      words = words//'; '//warnings(k)%s
    end do
    if (allocated(error%advice)) words = words//'; '//error%advice
    error%advice = words
  end subroutine add_warnings

  !> What a run of a deck with ACCURACY or REMSH has cost, over all its meshes; and what one with ACCURACY that has come to its end
  !> has reached. A warning where that is less than asked.
  subroutine close_cost(options, scene, solution, run, facts, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(in) :: run
    type(run_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(sample_t) :: sample
    type(fineness_t) :: fineness
    type(cost_t) :: cost
    character(len=:), allocatable :: words
    logical :: there

    if (allocated(options%fineness)) fineness = options%fineness
    call add_cost(run%stem, run%deck_text, fineness, scene, run%equations, solution, facts%processor, &
                  merge(facts%closing%stress, -1.0_wp, facts%closing%space), &
                  run%exit_code == exit_done .and. scene%operation >= scene%operations, &
                  run%begins_operation .or. allocated(options%resume), cost, error)
    if (allocated(error)) return
    call close_cycle(scene, cost, join_path(run%folder, 'history.csv'), facts%closing)
    if (.not. (cost%finished .and. allocated(run%plan))) return
    call read_sample(options, run%deck_text, options%fineness, run%plan%columns, sample, there)
    if (.not. there) return
    allocate (facts%closing%accuracy)
    call judge_run(run%plan, sample, facts%closing%accuracy)
    words = accuracy_warning(facts%closing%accuracy, by_euler(scene))
    if (len(words) > 0) call add_text(facts%warnings, words)
  end subroutine close_cost

  !> Temperatures are found by a scheme of first order, and could be by one of second order.
  pure function by_euler(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: f

    f = find_field(scene%fields, 'temperature')
    yes = .false.
    if (f > 0) yes = scene%fields(f)%declared .and. scene%strategy%scheme /= scheme_tr_bdf2 &
                     .and. scene%strategy%coupling /= coupling_monolithic
  end function by_euler

  !> An operation has come to its end, and others follow.
  pure function others_follow(scene, run) result(yes)
    type(scene_t), intent(in) :: scene
    type(run_t), intent(in) :: run
    logical :: yes

    yes = run%exit_code == exit_done .and. scene%operation < scene%operations
  end function others_follow

  !> The summary of an operation that others follow has a name of its own.
  pure function summary_name(scene, run) result(name)
    type(scene_t), intent(in) :: scene
    type(run_t), intent(in) :: run
    character(len=:), allocatable :: name

    name = 'summary.json'
    if (others_follow(scene, run)) name = 'summary.'//scene%operation_name//'.json'
  end function summary_name

end module run_ending
