!> Heat through contact where temperatures are found before the motion (SOLVE ONCE): what passes by the conductances that they were
!> found with, those of the contact at the start of the step, beside what passes by those of the contact that they lead to.
!>
!> In short steps the difference goes with the step. A part that shrinks as it cools on a die, however, presses on it in one step
!> and not in the next, where heat passes by the pressure before: conductances a step behind make any step unstable in which the
!> heat of the contact takes away its pressure (an explicit rule for a stiff equation; on the coupling J.R. Barber, J. Elast. 8
!> (1978) 409-423). Where the difference is a large share of what passes the fields are found in turns until little of it is left
!> (step_solves).
!>
!> What is left is an error of the step, as that of its time scheme is: with A the flows out of the nodes by the conductances used
!> and B by those reached, the mean of the step would be (A + B)/2 where A was taken, conductances being linear in the step to first
!> order. It is carried on with the errors of the scheme (heat_error), and bounds the step with them (THETA ... TOL).
module contact_lag
  use contact_conductance, only: conductance_count
  use corrections, only: solve_correction
  use elem_api, only: report_t
  use equations, only: equations_t, stage_t
  use evaluation, only: evaluate, measure_error
  use exchange_in_turns, only: hand_over_again, hand_over_reached, turns_t
  use fields, only: find_field
  use heat_error, only: diagonal, flows, flows_of, leave, take
  use heat_stages, only: evaluation_t, in_two_stages, judge, keep_evaluation, return_to
  use kinds, only: wp
  use path_record, only: state_error_t
  use scene, only: role_heat_contact, scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: lag_t, add_lag, add_rates, lags, measure_lag

  type :: lag_t
    !> Sum of what passes more or less at the sides by the conductances reached, over that of what passes.
    real(wp) :: share = 0.0_wp
    !> Flows out of the nodes by the conductances used (ndof), and half of what they are more than by those reached [power].
    real(wp), allocatable :: flows(:), rates(:)
  end type lag_t

contains

  !> Heat passes through a contact that moves, in turns with the motion.
  pure function lags(equations) result(yes)
    type(equations_t), intent(in) :: equations
    logical :: yes

    yes = size(equations%solves) > 1 .and. conductance_count(equations%drivers) > 0
  end function lags

  !> After a turn of all solves. Forces, element forces, states and what is handed over stay those of the turn.
  subroutine measure_lag(scene, equations, solution, dt, exchange, outcome, lag)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(turns_t), intent(in) :: exchange
    type(outcome_t), intent(in) :: outcome   !! of the turn
    type(lag_t), intent(out) :: lag
    type(evaluation_t) :: kept
    real(wp) :: reached(equations%dofs%ndof), length
    real(wp), allocatable :: passed(:)
    logical :: at_sides(size(equations%buffers%force)), differ
    integer :: now

    now = equations%now
    equations%now = solve_of_heat(scene, equations)
    call keep_evaluation(equations, kept)
    call hand_over_reached(scene, solution, equations, exchange, differ)
    if (differ) then
      at_sides = of_contact(scene, equations)
      length = merge(0.0_wp, dt, in_two_stages(scene, solution, outcome))
      call flows(scene, equations, solution, dt, outcome%du, reached, mean_over=length)
      passed = equations%buffers%force
      call hand_over_again(equations, exchange)
      allocate (lag%flows(equations%dofs%ndof))
      call flows(scene, equations, solution, dt, outcome%du, lag%flows, mean_over=length)
      lag%rates = 0.5_wp*(lag%flows - reached)
      associate (used => equations%buffers%force)
        lag%share = max(sum(abs(used), mask=at_sides), sum(abs(passed), mask=at_sides))
        if (lag%share > 0) lag%share = sum(abs(used - passed), mask=at_sides)/lag%share
      end associate
    end if
    call return_to(kept, equations)
    equations%now = now
  end subroutine measure_lag

  !> The solve that finds temperatures.
  pure function solve_of_heat(scene, equations) result(s)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer :: s
    integer :: f

    f = find_field(scene%fields, 'temperature')
    do s = 1, size(equations%solves) - 1
      if (equations%solves(s)%own(f)) return
    end do
  end function solve_of_heat

  !> Element forces that are heat through contact (those of all elements).
  pure function of_contact(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(size(equations%buffers%force))
    integer :: g, first

    yes = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_heat_contact .or. .not. equations%solves(equations%now)%active(g)) cycle
      first = equations%solves(1)%pattern%force_start(g)
      yes(first + 1:first + size(equations%dofs%groups(g)%dof)) = .true.
    end do
  end function of_contact

  !> To the error of the step, and to what it leaves, comes what its conductances err; by both the step is judged anew. Nothing
  !> where errors in time are not estimated.
  subroutine add_lag(scene, equations, solution, dt, lag, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(lag_t), intent(in) :: lag
    type(outcome_t), intent(inout) :: outcome
    type(evaluation_t) :: kept
    real(wp) :: error
    integer :: now

    if (.not. (outcome%heat%estimated .and. lag%share > 0)) return
    now = equations%now
    equations%now = solve_of_heat(scene, equations)
    call keep_evaluation(equations, kept)
    call add_rates(scene, equations, solution, dt, lag%rates, outcome, lag%flows, error)
    call return_to(kept, equations)
    equations%now = now
    if (.not. outcome%converged) return
    outcome%heat%error = outcome%heat%error + error
    call judge(scene, solution, dt, outcome)
  end subroutine add_lag

  !> Errors of all steps so far with those of flows in this one, by the matrix of the temperatures, which the present solve finds.
  subroutine add_rates(scene, equations, solution, dt, rates, outcome, after, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations   !! forces and element forces become others
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt         !! [time]
    real(wp), intent(in) :: rates(:)   !! (ndof) what flows out of the nodes too much [power]
    type(outcome_t), intent(inout) :: outcome
    real(wp), intent(in), optional :: after(:)   !! (ndof) flows at the end of the step, found here where absent [power]
    real(wp), intent(out), optional :: error     !! as that of heat_step_t [temperature]
    type(state_error_t) :: none(size(scene%groups)), found(size(scene%groups))
    real(wp), dimension(equations%dofs%ndof) :: heat, temperatures, content, all, now
    type(report_t) :: report
    real(wp) :: length, mean_over, of_heat, of_temperature
    logical :: at_hand
    integer :: f, d, g

    f = find_field(scene%fields, 'temperature')
    d = find_field(scene%fields, 'die_temperature')
    associate (two_stages => in_two_stages(scene, solution, outcome))
      length = merge(diagonal, 1.0_wp, two_stages)*dt
      mean_over = merge(0.0_wp, dt, two_stages)
      heat = merge(dt*rates, 0.0_wp, equations%solves(equations%now)%equation > 0)
      at_hand = equations%solves(equations%now)%analysed
      ! other pairs of bodies as the motion was found: the matrix has another pattern, and no factors yet
      if (.not. at_hand) then
        ! the state is that of the turn: by now bodies have the work of this step, which becomes heat in the next one
        do g = 1, size(scene%groups)
          found(g)%value = solution%groups(g)%trial
        end do
        if (two_stages) equations%stage = stage_t(share=diagonal)
        call evaluate(scene, equations, solution, dt, outcome%du, .true., report)
        equations%stage = stage_t()
        do g = 1, size(scene%groups)
          solution%groups(g)%trial = found(g)%value
        end do
      end if
    end associate
    call solve_correction(equations, heat/length, temperatures, outcome%error, at_hand=at_hand)
    if (allocated(outcome%error)) then
      outcome%converged = .false.
      return
    end if
    if (present(after)) then
      now = after
    else
      call flows(scene, equations, solution, dt, outcome%du, now, mean_over=mean_over)
    end if
    heat = heat - length*flows_of(scene, equations, solution, dt, outcome%du, now, temperatures, mean_over, none)
    where (equations%solves(equations%now)%equation == 0) heat = 0
    content = 0
    all = 0
    call take(equations, f, outcome%heat%content_error, content)
    call take(equations, d, outcome%heat%die_error, content)
    call take(equations, f, outcome%heat%temperature_error, all)
    call leave(equations, f, content + heat, outcome%heat%content_error)
    call leave(equations, d, content + heat, outcome%heat%die_error)
    call leave(equations, f, all + temperatures, outcome%heat%temperature_error)
    call measure_error(scene, equations, solution, outcome%du, temperatures, of_heat, of_temperature)
    if (present(error)) error = of_heat
    call measure_error(scene, equations, solution, outcome%du, all + temperatures, of_heat, outcome%heat%error_now)
  end subroutine add_rates

end module contact_lag
