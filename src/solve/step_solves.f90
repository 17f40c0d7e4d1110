!> One step of all fields: each solve in its turn.
!>
!> Where fields of several quantities are solved for one after the other, a solve takes the motion of the others' unknowns as their
!> own solve has found it in this step, or as predicted from the last step. Once in turns is first order in the step; in turns until
!> nothing changes any more is the result of the monolithic solve. What drives heat is handed over by exchange_in_turns.
module step_solves
  use contact_lag, only: add_lag, lag_t, lags, measure_lag
  use damping, only: prepare_damping
  use equations, only: equations_t
  use exchange_in_turns, only: advance_exchange, begin_exchange, end_exchange, turns_t
  use fields, only: displacement_field
  use first_step_parts, only: solve_motion
  use heat_in_system, only: estimate_heat_in_system
  use heat_stages, only: is_heat_alone, solve_heat
  use kinds, only: wp
  use known_motion, only: proportion
  use misplaced_contact, only: add_misplaced
  use own_crossings, only: find_own_crossing, own_crossing_t
  use path_bounds, only: judge_path
  use scene, only: scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use strategy, only: coupling_converged, coupling_once
  use text, only: to_text
  implicit none
  private
  public :: solve_fields

  !> More turns than this do not converge: the step is too long.
  integer, parameter :: most_turns = 50
  !> Once in turns is not enough where more than this share of the heat through contact is another by the contact that it leads to;
  !> turns then go on until no more than the second share is, and end in any case after so many.
  real(wp), parameter :: large_lag = 0.1_wp, little_lag = 0.02_wp
  integer, parameter :: most_turns_of_contact = 30

contains

  !> Find the fields at the end of a step of length dt, and judge the path to there. `outcome` is that of all solves together; of a
  !> failed step, of the one that failed.
  subroutine solve_fields(scene, equations, solution, dt, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(out) :: outcome
    type(turns_t) :: exchange
    integer :: solved

    solved = corrections_of_motion(equations)
    call prepare_damping(scene, solution, dt, equations)
    call take_turns(scene, equations, solution, dt, most_turns_of_contact, exchange, outcome)
    call end_exchange(equations, exchange)
    if (.not. outcome%converged .and. exchange%n > 0 .and. scene%strategy%coupling == coupling_once) then
      ! turns that would have heat and contact agree lead to none: the first alone
      call take_turns(scene, equations, solution, dt, 1, exchange, outcome)
      call end_exchange(equations, exchange)
    end if
    call judge_contours(scene, equations, solution, outcome)
    call judge_path(scene, equations, solution, dt, corrections_of_motion(equations) > solved, outcome)
    call add_misplaced(scene, equations, solution, dt, corrections_of_motion(equations) > solved, outcome)
  end subroutine solve_fields

  !> A step in which a body has passed through itself is none.
  subroutine judge_contours(scene, equations, solution, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(inout) :: outcome
    type(own_crossing_t) :: crossing
    integer :: timer

    if (.not. outcome%converged .or. size(equations%free_sides%body) == 0) return
    call equations%timers%add('contours', timer)
    call equations%timers%start(timer)
    call find_own_crossing(scene, equations%dofs, solution, outcome%du, equations%free_sides, crossing)
    call equations%timers%stop(timer)
    if (.not. crossing%found) return
    outcome%converged = .false.
    outcome%passes_itself = .true.
    outcome%crossing_group = crossing%group
    outcome%thins_out = crossing%thinned
    outcome%crossing_place = ' at x = '//to_text(crossing%point(1), 5)//', y = '//to_text(crossing%point(2), 5)
    outcome%reason = scene%groups(crossing%group)%name &
                     //trim(merge(' has thinned to nothing', ' passes through itself ', crossing%thinned))//outcome%crossing_place
  end subroutine judge_contours

  !> Matrices factorised, or found so, for the motion since the start.
  pure function corrections_of_motion(equations) result(n)
    type(equations_t), intent(in) :: equations
    integer :: n
    integer :: s

    n = 0
    do s = 1, size(equations%solves)
      associate (solve => equations%solves(s))
        if (solve%own(displacement_field)) n = n + solve%solver%factorised + solve%solver%reused
      end associate
    end do
  end function corrections_of_motion

  !> Each solve in its turn.
  subroutine take_turns(scene, equations, solution, dt, most, exchange, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt     !! [time]
    integer, intent(in) :: most    !! turns, where temperatures are found once, and first
    type(turns_t), intent(out) :: exchange
    type(outcome_t), intent(out) :: outcome
    type(outcome_t) :: own
    real(wp) :: motion(equations%dofs%ndof), change
    logical :: once, ends
    integer :: s, turn

    if (size(equations%solves) == 1) then
      if (is_heat_alone(scene, equations)) then
        call solve_heat(scene, equations, solution, dt, outcome)
        outcome%of_heat = .true.
      else
        call solve_motion(scene, equations, solution, dt, outcome)
        call estimate_heat_in_system(scene, equations, solution, dt, outcome)
      end if
      return
    end if
    ! the trial state of a failed attempt is discarded
    do s = 1, size(solution%groups)
      solution%groups(s)%trial = solution%groups(s)%committed
    end do
    once = scene%strategy%coupling == coupling_once
    if (.not. once .or. lags(equations)) call begin_exchange(scene, solution, equations, exchange, contact_alone=once)
    motion = 0
    if (solution%last_step > 0) call proportion(equations%dofs, solution%fields, dt/solution%last_step, motion)
    do turn = 1, most_turns
      change = 0
      do s = 1, size(equations%solves)
        equations%now = s
        if (is_heat_alone(scene, equations)) then
          call solve_heat(scene, equations, solution, dt, own, given=motion, go_on=turn > 1)
        else
          call solve_motion(scene, equations, solution, dt, own, given=motion, go_on=turn > 1)
        end if
        call add_outcome(equations%solves(s)%name, is_heat_alone(scene, equations), own, outcome)
        if (.not. own%converged) return
        change = max(change, relative_change(equations, motion, own%du))
        motion = merge(own%du, motion, equations%solves(s)%is_own)
      end do
      outcome%du = motion
      if (once) then
        call compare_contact(scene, equations, solution, dt, turn, turn == most, exchange, outcome, ends)
        if (ends) return
      end if
      call advance_exchange(scene, solution, equations, exchange, change)
      if (.not. once .and. change <= scene%strategy%displacement_norm) return
    end do
    outcome%converged = .false.
    outcome%reason = 'the fields do not agree after '//to_text(most_turns)//' turns (they change by '//to_text(change, 3) &
                     //'); SOLVE MONOLITHIC finds them together'
  end subroutine take_turns

  !> Where temperatures are found once, and first: the turn was the last one, unless heat through contact is quite another by the
  !> contact that it leads to. Otherwise what it errs is added to the error of the step, and listed where it is large still.
  subroutine compare_contact(scene, equations, solution, dt, turn, is_last, exchange, outcome, ends)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    integer, intent(in) :: turn
    logical, intent(in) :: is_last
    type(turns_t), intent(in) :: exchange
    type(outcome_t), intent(inout) :: outcome
    logical, intent(out) :: ends
    type(lag_t) :: lag

    ends = .not. lags(equations)
    if (ends) return
    call measure_lag(scene, equations, solution, dt, exchange, outcome, lag)
    ends = lag%share <= merge(large_lag, little_lag, turn == 1)
    if (.not. ends .and. is_last) outcome%contact_lag = lag%share
    ends = ends .or. is_last
    if (.not. ends) return
    call add_lag(scene, equations, solution, dt, lag, outcome)
  end subroutine compare_contact

  !> Change of the motion of the own unknowns over the motion.
  pure function relative_change(equations, before, now) result(change)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: before(:), now(:)   !! (ndof)
    real(wp) :: change
    real(wp) :: whole

    associate (is_own => equations%solves(equations%now)%is_own .and. .not. equations%dofs%is_angle)
      whole = sum(now**2, mask=is_own)
      change = sum((now - before)**2, mask=is_own)
    end associate
    if (whole > 0) change = sqrt(change/whole)
  end function relative_change

  !> Add the result of a solve: iterations one after the other, extremes, why it failed.
  subroutine add_outcome(name, is_heat, own, all)
    character(len=*), intent(in) :: name   !! of the solve
    logical, intent(in) :: is_heat
    type(outcome_t), intent(inout) :: own
    type(outcome_t), intent(inout) :: all

    if (.not. allocated(all%history)) then
      allocate (all%history(0))
      all%converged = .true.
    end if
    if (allocated(own%history)) all%history = [all%history, own%history]
    all%converged = all%converged .and. own%converged
    all%iterations = all%iterations + own%iterations
    all%first_iterations = max(all%first_iterations, own%first_iterations)
    all%patch_difficulty = max(all%patch_difficulty, own%patch_difficulty)
    all%parts = max(all%parts, own%parts)
    all%event = min(all%event, own%event)
    if (allocated(own%event_reason)) all%event_reason = own%event_reason
    if (is_heat) all%heat = own%heat
    all%strain = max(all%strain, own%strain)
    all%linear_residual = max(all%linear_residual, own%linear_residual)
    all%augmentations = max(all%augmentations, own%augmentations)
    all%gave_way = all%gave_way .or. own%gave_way
    if (.not. is_heat) then
      all%unstable = own%unstable
      all%stays_unstable = own%stays_unstable
    end if
    all%left_unstable = all%left_unstable .or. own%left_unstable
    if (own%converged) return
    all%of_heat = is_heat
    all%group = own%group
    all%element = own%element
    if (allocated(own%reason)) all%reason = name//': '//own%reason
    if (allocated(own%residual)) all%residual = own%residual
    if (allocated(own%error)) call move_alloc(own%error, all%error)
  end subroutine add_outcome

end module step_solves
