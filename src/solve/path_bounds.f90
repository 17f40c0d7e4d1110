!> Length of steps by the errors that come of the path within them (path_error).
!>
!> The error of the motion is bounded for each step, over its motion: in sum it is no more of the whole way then. The error of the
!> stress is bounded as what has come of all steps so far, for creep forgets what was before and elastic unloading keeps it. Where
!> that is used up a step may add its share of the time to it, or of the stress that it changes, so that the run goes on.
!>
!> Where a step could be many times as long, a few steps after it do without an estimate, unless one is longer, flows more or bends
!> more.
!>
!> Where a part hangs on single points of contact that change, errors do not come of the path, and do not fall with the step: a
!> step that was shortened in vain is accepted, counted as above the bound, and the steps after it are left alone for a while.
module path_bounds
  use equations, only: equations_t
  use heat_stress, only: find_stress_of_heat
  use kinds, only: eps, wp
  use path_error, only: at_corner, bend_of, estimate_path
  use path_record, only: bound_scale, mean_square, path_record_t, path_step_t, stress_before
  use path_states, only: has_path, has_stress, on_nodes
  use path_stress, only: carry_errors_in_quiet
  use scene, only: scene_t
  use shape_error, only: find_shape_error
  use solution, only: solution_t
  use state_variables, only: find_variable
  use step_outcome, only: outcome_t
  use strategy, only: strategy_t
  use text, only: to_text
  implicit none
  private
  public :: bound_stress, judge_path

  !> Steps aim at this share of what is allowed, so that few are made in vain.
  real(wp), parameter :: aim = 0.7_wp
  !> A step is shortened to no less than this share at once, and to no more, so that its error is seen to fall; to this one where
  !> the two halves cannot be made.
  real(wp), parameter :: least_factor = 0.2_wp, most_factor = 0.7_wp, without_halves = 0.5_wp

  !> Steps without an estimate grow to no more than this many times the length up to which they may do without.
  real(wp), parameter :: growth_in_quiet = 2.0_wp

  !> Errors of a path fall with at least this power of the step's length (with the first, or the second).
  real(wp), parameter :: least_order = 0.5_wp
  integer, parameter :: of_motion = 1, of_stress = 2

contains

  !> A step has converged: it is accepted, or must be shortened by its errors, and the next may be so much longer.
  subroutine judge_path(scene, equations, solution, dt, at_hand, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt        !! [time]
    logical, intent(in) :: at_hand    !! factors of a matrix of this step are
    type(outcome_t), intent(inout) :: outcome
    logical :: quiet, last, done
    integer :: timer

    if (.not. outcome%converged) return
    last = .not. solution%time + dt < scene%strategy%end_time*(1 - 64*eps)
    if (last) call find_shape_error(scene, equations, solution, dt, at_hand, outcome)
    if (.not. scene%follows_path) then
      if (last) call find_stress_of_heat(scene, equations, solution, dt, at_hand, outcome)
      return
    end if
    call equations%timers%add('path error', timer)
    call equations%timers%start(timer)
    outcome%path%bend = bend_of(equations, solution, dt, outcome%du)
    outcome%path%flowed = flow_of_step(scene, has_path(scene, equations%laws), solution)
    quiet = is_quiet(scene, solution, dt, outcome%path, last)
    if (quiet) then
      call go_on_in_quiet(equations, solution%path, dt, outcome)
      call carry_errors_in_quiet(scene, equations, solution, has_stress(scene, equations%laws), dt, outcome)
    else
      call estimate_path(scene, equations, solution, dt, at_hand, outcome, done)
    end if
    call equations%timers%stop(timer)
    if (quiet .or. .not. outcome%converged) return
    outcome%path%estimated = done
    if (done) call find_spare(scene%strategy, solution%path, outcome%path)
    if (solution%path%unbounded > 0) return
    if (done) then
      call find_sizes(scene%strategy, solution, dt, outcome%path)
      call bound_motion(scene%strategy, solution%path, dt, outcome)
      if (outcome%converged) call bound_stress(scene%strategy, solution, dt, outcome)
    else if (dt > scene%strategy%least_step) then
      call shorten(without_halves, 'the path within the step cannot be followed', outcome)
    end if
  end subroutine judge_path

  !> The step needs no estimate. The last one of the run has one, and those before and after a corner of a multiplier.
  pure function is_quiet(scene, solution, dt, step, last) result(yes)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt              !! [time]
    type(path_step_t), intent(in) :: step   !! its flow and bend are known
    logical, intent(in) :: last             !! step of the run
    logical :: yes

    associate (record => solution%path)
      yes = record%quiet > 0 .and. dt <= record%quiet_length .and. step%flowed <= record%quiet_flow &
            .and. step%bend <= record%quiet_bend .and. .not. (record%tried_length > 0 .or. last)
      ! on a new mesh in any case
      if (yes .and. record%quiet_bend < huge(record%quiet_bend)) &
        yes = .not. (at_corner(scene, solution%time) .or. at_corner(scene, solution%time + dt))
    end associate
  end function is_quiet

  !> What a step dissipates at the points of bodies that flow, in the mean over them: 0 where they are elastic.
  pure function flow_of_step(scene, active, solution) result(flowed)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: active(:)           !! (ngroup) bodies whose laws flow
    type(solution_t), intent(in) :: solution   !! its trial state is that of the step
    real(wp) :: flowed                         !! [energy/length^3]
    integer :: g, k, n

    flowed = 0
    n = 0
    do g = 1, size(active)
      if (.not. active(g)) cycle
      k = find_variable(scene%groups(g)%variables, 'plastic_work')
      if (k == 0) cycle
      k = scene%groups(g)%variables(k)%first
      associate (state => solution%groups(g))
        flowed = flowed + sum(abs(state%trial(k, :, :) - state%committed(k, :, :)))
        n = n + size(state%trial(k, :, :))
      end associate
    end do
    flowed = flowed/max(n, 1)
  end function flow_of_step

  !> A step without an estimate: its motion, and how much longer the next may be.
  subroutine go_on_in_quiet(equations, record, dt, outcome)
    type(equations_t), intent(in) :: equations
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome

    outcome%path%interpolated = .true.
    outcome%path%motion = mean_square(on_nodes(equations, outcome%du))
    if (record%quiet_bend < huge(record%quiet_bend)) &
      outcome%path%growth = max(growth_in_quiet*record%quiet_length/dt, 1.0_wp)
  end subroutine go_on_in_quiet

  !> How many times as long the step could be, for errors no larger than by default, or than the deck allows.
  pure subroutine find_spare(strategy, record, step)
    type(strategy_t), intent(in) :: strategy
    type(path_record_t), intent(in) :: record
    type(path_step_t), intent(inout) :: step
    type(strategy_t) :: default
    real(wp) :: room

    if (step%motion_error > 0) &
      step%spare = aim*tighter(default%path_bound, strategy%path_bound)*step%motion/step%motion_error
    if (.not. abs(step%stress_error) > 0) return
    room = tighter(default%rate_bound, strategy%rate_bound)*bound_scale(record, step%stress, step%flow)
    step%spare = min(step%spare, sqrt(aim*room/abs(step%stress_error)))
  end subroutine find_spare

  !> The smaller bound; 0 is none.
  pure function tighter(default, of_deck) result(bound)
    real(wp), intent(in) :: default, of_deck   !! [-]
    real(wp) :: bound

    bound = default
    if (of_deck > 0) bound = min(default, of_deck)
  end function tighter

  !> Error of the motion over the motion, or over what it is in the mean of the time where that is more; error of the stress over
  !> what the deck allows.
  pure subroutine find_sizes(strategy, solution, dt, step)
    type(strategy_t), intent(in) :: strategy
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(path_step_t), intent(inout) :: step
    real(wp) :: scale, allowed

    scale = step%motion
    if (solution%time > 0) scale = max(scale, solution%path%moved/solution%time*dt)
    if (step%motion_error > 0) step%sizes(of_motion) = step%motion_error/scale
    allowed = strategy%rate_bound*bound_scale(solution%path, step%stress, step%flow)
    if (allowed > 0) step%sizes(of_stress) = abs(step%stress_error)/allowed
  end subroutine find_sizes

  !> The share goes with the length.
  subroutine bound_motion(strategy, record, dt, outcome)
    type(strategy_t), intent(in) :: strategy
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome

    associate (step => outcome%path, allowed => strategy%path_bound)
      if (.not. (allowed > 0 .and. step%motion_error > 0)) return
      call bound(strategy, record, dt, allowed, aim*allowed/step%sizes(of_motion), of_motion, 'motion', outcome)
    end associate
  end subroutine bound_motion

  !> What a step adds goes with the square of its length. An error against that of the steps before has all the room.
  !>
  !> What was above the bound at the start, as where the stress has fallen, is not paid for by this step: shorter steps do not
  !> forget it sooner. An error counts as at the bound then, so that steps add what is forgotten on the way.
  subroutine bound_stress(strategy, solution, dt, outcome)
    type(strategy_t), intent(in) :: strategy
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome
    real(wp) :: allowed, at_start, change, least, before, room, next

    associate (step => outcome%path, record => solution%path)
      allowed = strategy%rate_bound*bound_scale(record, step%stress, step%flow)
      if (.not. (allowed > 0 .and. abs(step%stress_error) > 0)) return
      at_start = strategy%rate_bound*bound_scale(record, record%stress, record%flow)
      before = sign(1.0_wp, step%stress_error)*stress_before(step, dt, record, most=at_start)
      change = abs(step%stress - record%stress)*dt/(record%pending_time + dt)
      least = max(strategy%rate_bound*min(change, step%stress), allowed*dt/(solution%time + dt))
      room = max(allowed - max(before, 0.0_wp), least)
      next = max(allowed - step%left*min(max(before + abs(step%stress_error), 0.0_wp), allowed), least)
      if (abs(step%stress_error) > room) next = room
      call bound(strategy, record, dt, room/allowed, sqrt(aim*next/abs(step%stress_error)), of_stress, 'stress', outcome)
    end associate
  end subroutine bound_stress

  !> An error up to what is allowed bounds the next step; one above it shortens this one, or is counted where that is in vain.
  subroutine bound(strategy, record, dt, allowed, factor, which, name, outcome)
    type(strategy_t), intent(in) :: strategy
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: dt        !! [time]
    real(wp), intent(in) :: allowed   !! [-]
    real(wp), intent(in) :: factor    !! of the length, for the error aimed at
    integer, intent(in) :: which      !! of_motion or of_stress
    character(len=*), intent(in) :: name
    type(outcome_t), intent(inout) :: outcome

    associate (step => outcome%path, error => outcome%path%sizes(which))
      if (error <= allowed) then
        step%growth = min(step%growth, max(factor, least_factor))
      else if (is_in_vain(record, dt, error, which)) then
        step%above = .true.
        step%no_better = .true.
        step%growth = min(step%growth, 1.0_wp)
      else if (dt > strategy%least_step) then
        call shorten(min(max(factor, least_factor), most_factor), 'error of the '//name//' by the path within the step ' &
                     //to_text(error, 3)//' above '//to_text(allowed, 3), outcome)
      else
        step%above = .true.
        step%growth = min(step%growth, 1.0_wp)
      end if
    end associate
  end subroutine bound

  !> The attempt before was longer, and its error hardly larger.
  pure function is_in_vain(record, dt, error, which) result(yes)
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: error   !! of this attempt [-]
    integer, intent(in) :: which    !! of_motion or of_stress
    logical :: yes

    yes = record%tried_length > dt
    if (yes) yes = error > record%tried_sizes(which)*(dt/record%tried_length)**least_order
  end function is_in_vain

  !> The step is made again with this share of its length.
  pure subroutine shorten(factor, reason, outcome)
    real(wp), intent(in) :: factor   !! [-]
    character(len=*), intent(in) :: reason
    type(outcome_t), intent(inout) :: outcome

    outcome%converged = .false.
    outcome%event = factor
    outcome%event_reason = reason
    outcome%path%too_long = .true.
  end subroutine shorten

end module path_bounds
