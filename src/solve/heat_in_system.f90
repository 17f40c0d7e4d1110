!> Error in time of the heat of a step whose temperatures are found with the motion in one system (SOLVE MONOLITHIC), by implicit
!> Euler.
!>
!> It is that of temperatures alone (heat_error): the difference to the trapezoidal rule, (G1 - G0) dt/2, divided by the matrix of
!> the step, here that of the whole system with no forces on the motion: temperatures have the error with the motion that follows
!> it. Flows are those of the groups that act on temperatures; pressures of contact, by which heat passes, are taken as they are.
module heat_in_system
  use equations, only: equations_t, solves_heat
  use fields, only: find_field
  use heat_error, only: estimate_error, flows
  use heat_stages, only: add_middle, evaluation_t, judge, keep_evaluation, return_to
  use kinds, only: wp
  use kinetics_error, only: keep_piece, path_piece_t
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  use step_outcome, only: outcome_t
  use strategy, only: scheme_tr_bdf2
  use torch_error, only: add_torches, in_sum
  implicit none
  private
  public :: acting_t, ask_for_all, ask_for_heat, estimate_heat_in_system

  !> What acts in a solve.
  type :: acting_t
    logical, allocatable :: active(:)   !! (ngroup)
    logical, allocatable :: is_own(:)   !! (ndof)
  end type acting_t

contains

  !> Error of a step that has converged, and what it makes of those before it; by the tolerance of the deck the step is accepted or
  !> must be shortened. Nothing where another scheme was taken, or no temperature is solved for. Forces, element forces and states
  !> stay those of the step.
  subroutine estimate_heat_in_system(scene, equations, solution, dt, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome
    type(evaluation_t) :: kept
    type(path_piece_t) :: whole
    type(group_state_t), allocatable :: states(:)
    type(acting_t) :: asked
    real(wp), dimension(equations%dofs%ndof) :: rest, before, after, rates, erred, mean
    integer :: g

    if (.not. (outcome%converged .and. solves_heat(scene, equations))) return
    if (scene%strategy%scheme == scheme_tr_bdf2 .or. scene%strategy%theta < 1) return
    call keep_evaluation(equations, kept)
    states = solution%groups
    call ask_for_heat(scene, equations, asked)
    rest = 0
    erred = 0
    mean = 0
    call flows(scene, equations, solution, 0.0_wp, rest, before, mean_over=dt)
    call add_torches(scene, equations, [-0.5_wp, 0.5_wp], erred, mean)
    call flows(scene, equations, solution, dt, outcome%du, after, mean_over=dt)
    call add_torches(scene, equations, [0.5_wp, 0.5_wp], erred, mean)
    call keep_piece(scene, equations, solution, dt, kept%element_force, whole)
    rates = 0.5_wp*(after - before)
    call add_middle(scene, equations, solution, dt, outcome%du, before + after, rates, erred, mean)
    call estimate_error(scene, equations, solution, dt, rates, in_sum(erred, mean), after, .false., whole, outcome, &
                        at_hand=outcome%iterations > 0)
    call ask_for_all(asked, equations)
    do g = 1, size(states)
      if (allocated(states(g)%trial)) solution%groups(g)%trial = states(g)%trial
    end do
    call return_to(kept, equations)
    if (outcome%converged) call judge(scene, solution, dt, outcome)
  end subroutine estimate_heat_in_system

  !> From now on the present solve evaluates heat alone.
  subroutine ask_for_heat(scene, equations, asked)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(acting_t), intent(out) :: asked   !! what acts in it

    associate (solve => equations%solves(equations%now))
      asked%active = solve%active
      asked%is_own = solve%is_own
      solve%active = solve%active .and. acts_on_heat(scene, equations)
      solve%is_own = of_heat(scene, equations)
    end associate
  end subroutine ask_for_heat

  !> All of it again.
  pure subroutine ask_for_all(asked, equations)
    type(acting_t), intent(in) :: asked
    type(equations_t), intent(inout) :: equations

    equations%solves(equations%now)%active = asked%active
    equations%solves(equations%now)%is_own = asked%is_own
  end subroutine ask_for_all

  !> Fields that heat acts on (nfield).
  pure function is_warm(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes(size(scene%fields))
    integer :: f

    yes = .false.
    f = find_field(scene%fields, 'temperature')
    if (f > 0) yes(f) = .true.
    f = find_field(scene%fields, 'die_temperature')
    if (f > 0) yes(f) = .true.
  end function is_warm

  !> Unknowns of these fields (ndof).
  pure function of_heat(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(equations%dofs%ndof), warm(size(scene%fields))
    integer :: f, k

    warm = is_warm(scene)
    yes = .false.
    do f = 1, size(warm)
      if (.not. warm(f)) cycle
      associate (number => equations%dofs%fields(f)%number)
        do k = 1, size(number, 2)
          if (number(1, k) > 0) yes(number(1, k)) = .true.
        end do
      end associate
    end do
  end function of_heat

  !> Groups whose elements act on one of these fields (ngroup).
  pure function acts_on_heat(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(size(scene%groups)), warm(size(scene%fields))
    integer :: g, k

    warm = is_warm(scene)
    yes = .false.
    do g = 1, size(yes)
      associate (layout => equations%dofs%groups(g)%layout)
        do k = 1, layout%nfield
          if (layout%acts(k)) yes(g) = yes(g) .or. warm(layout%field(k))
        end do
      end associate
    end do
  end function acts_on_heat

end module heat_in_system
