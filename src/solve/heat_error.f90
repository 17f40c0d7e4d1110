!> Error in time of the balance of heat: of a step, and at its end of all steps so far.
!>
!> What a step errs in the heat of the nodes (heat_stages) is divided by the matrix of the step, M, as M.E. Hosea and
!> L.F. Shampine do (Appl. Numer. Math. 20 (1996) 21-37), so that stiff parts, which the step damps, do not count.
!>
!> Errors of earlier steps go on as temperatures do: they are conducted, and die away where those do. With d the error of the heat
!> of the nodes (heat that phases release counts as heat), e that of the temperatures, K the matrix of the flows, and dt r what the
!> step errs itself, a step of implicit Euler makes of d0
!>   M e1 = d0/dt + r,   d1 = d0 + dt r - dt K e1;
!> one of TR-BDF2 (D and W as there) first makes the same of its first stage, M s = 2 d0/(D dt), dm = d0 - D dt K s, and then
!>   M e1 = ((1 - W/D) d0 + W/D dm)/(D dt) + r.
!> The flows K e are those of the elements, by their difference along a small part of e. So latent heat and numbers by temperature
!> are as in the step; dies with a heat capacity of their own have errors as nodes do. (Global errors by the linearised equation
!> with the local ones as its sources: R.D. Skeel, Thirteen ways to estimate global error, Numer. Math. 48 (1986) 1-20.)
!>
!> A torch leaves in each step the heat that it has meanwhile (torch_steps). The difference of two formulas knows other heats of it;
!> so steps may be shortened by how its power changes, but no such heat is carried on.
!>
!> Where points have kinetics, phases err too, dz, and with them latent heat and conductivity: what has come too late is made up
!> for. There d0 is what the content takes up less from a start with the errors of temperatures and phases to the same
!> temperatures at the end (kinetics_error), less dt times what flows more by the phases that are left of these errors; dz1 is
!> what the points make of all errors (of e1 by the derivatives that their kinetics bring along), and what the step errs in phases
!> itself.
module heat_error
  use corrections, only: solve_correction
  use elem_api, only: report_t
  use equations, only: equations_t, stage_t
  use evaluation, only: evaluate, measure_error
  use external_loads, only: external_forces
  use fields, only: find_field
  use heat_error_start, only: content_of
  use kinds, only: wp
  use kinetics_error, only: add_by_temperature, content_beside, knows_phases, path_piece_t
  use path_record, only: state_error_t
  use scene, only: scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: diagonal, estimate_error, flows, flows_of, leave, take, weight

  !> D and W of TR-BDF2.
  real(wp), parameter :: diagonal = 1 - 1/sqrt(2.0_wp), weight = sqrt(2.0_wp)/4
  !> Share of an error along which flows are taken as linear.
  real(wp), parameter :: small = 2.0_wp**(-10)

contains

  !> Error of a step, and what it makes of those before it.
  subroutine estimate_error(scene, equations, solution, dt, rates, exact, after, two_stages, whole, outcome, at_hand)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt         !! [time]
    real(wp), intent(in) :: rates(:)   !! (ndof) error of the heat contents over the length that the matrix divides them by [power]
    real(wp), intent(in) :: exact(:)   !! (ndof) what of it is none: the heat of torches, all of which comes in [power]
    real(wp), intent(in) :: after(:)   !! (ndof) flows at the end of the step [power]
    logical, intent(in) :: two_stages  !! the step is one of TR-BDF2
    type(path_piece_t), intent(in) :: whole   !! all of the step, where points have kinetics
    type(outcome_t), intent(inout) :: outcome
    logical, intent(in), optional :: at_hand   !! by the factors of the last iteration
    real(wp) :: temperatures(size(rates)), of_temperature

    call solve_correction(equations, rates, temperatures, outcome%error, at_hand)
    if (.not. allocated(outcome%error)) then
      call measure_error(scene, equations, solution, outcome%du, temperatures, outcome%heat%error, of_temperature)
      outcome%heat%estimated = .true.
      call carry_errors(scene, equations, solution, dt, rates - exact, after, two_stages, whole, outcome)
    end if
    if (allocated(outcome%error)) outcome%converged = .false.
  end subroutine estimate_error

  !> Errors of all steps at the end of this one, by the factors at hand.
  subroutine carry_errors(scene, equations, solution, dt, rates, after, two_stages, whole, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt                  !! [time]
    real(wp), intent(in) :: rates(:), after(:)  !! (ndof) as those of estimate_error [power]
    logical, intent(in) :: two_stages
    type(path_piece_t), intent(in) :: whole
    type(outcome_t), intent(inout) :: outcome
    real(wp), dimension(size(rates)) :: heat, middle, temperatures, before, taken
    type(state_error_t), dimension(size(scene%groups)) :: none, phases, by_end
    real(wp) :: length, mean_over, unused
    logical :: touched(size(rates)), follows

    length = merge(diagonal, 1.0_wp, two_stages)*dt
    mean_over = merge(0.0_wp, dt, two_stages)
    heat = 0
    before = 0
    call take(equations, find_field(scene%fields, 'temperature'), solution%heat%content_error, heat)
    call take(equations, find_field(scene%fields, 'die_temperature'), solution%heat%die_error, heat)
    call take(equations, find_field(scene%fields, 'temperature'), solution%heat%temperature_error, before)
    ! on a new mesh: temperatures alone were carried to it
    if (any(abs(before) > 0) .and. .not. any(abs(solution%heat%content_error) > 0)) then
      call content_of(scene, equations, solution, dt, outcome%du, before, small, taken)
      heat = heat + taken
    end if
    if (knows_phases(whole)) then
      call content_beside(scene, equations, solution, dt, outcome%du, before, small, whole, taken, phases, by_end, touched, follows)
      temperatures = 0
      if (follows .and. any(abs(before) > 0)) &
        heat = merge(-taken - dt*flows_of(scene, equations, solution, dt, outcome%du, after, temperatures, mean_over, phases), &
                     heat, touched)
    end if
    if (two_stages .and. any(abs(heat) > 0)) then
      call solve_correction(equations, 2*heat/length, temperatures, outcome%error, at_hand=.true.)
      if (allocated(outcome%error)) return
      middle = heat - length*flows_of(scene, equations, solution, dt, outcome%du, after, temperatures, mean_over, none)
      heat = heat + (weight/diagonal)*(middle - heat)
    end if
    heat = heat + length*rates
    call solve_correction(equations, heat/length, temperatures, outcome%error, at_hand=.true.)
    if (allocated(outcome%error)) return
    call add_by_temperature(scene, equations, by_end, temperatures, phases)
    heat = heat - length*flows_of(scene, equations, solution, dt, outcome%du, after, temperatures, mean_over, phases)
    call measure_error(scene, equations, solution, outcome%du, temperatures, unused, outcome%heat%error_now)
    where (equations%solves(equations%now)%equation == 0) heat = 0
    outcome%heat%content_error = solution%heat%content_error
    outcome%heat%die_error = solution%heat%die_error
    outcome%heat%temperature_error = solution%heat%temperature_error
    call leave(equations, find_field(scene%fields, 'temperature'), heat, outcome%heat%content_error)
    call leave(equations, find_field(scene%fields, 'die_temperature'), heat, outcome%heat%die_error)
    call leave(equations, find_field(scene%fields, 'temperature'), temperatures, outcome%heat%temperature_error)
    if (.not. allocated(outcome%heat%phases)) then
      outcome%heat%phases = phases
    else
      outcome%heat%phases = sum_of(phases, outcome%heat%phases)
    end if
  end subroutine carry_errors

  !> Errors that have come of those before, and others.
  pure function sum_of(errors, others) result(both)
    type(state_error_t), intent(in) :: errors(:), others(:)   !! (ngroup)
    type(state_error_t) :: both(size(errors))                 !! (ngroup)
    integer :: g

    both = others
    do g = 1, size(errors)
      if (allocated(errors(g)%value) .and. allocated(others(g)%value)) both(g)%value = errors(g)%value + others(g)%value
    end do
  end function sum_of

  !> Errors at the places of a field as those of its unknowns, where these are solved for.
  pure subroutine take(equations, field, at_places, heat)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field            !! in the list of the scene
    real(wp), intent(in) :: at_places(:)    !! (nplace), of none where the field is not declared [energy]
    real(wp), intent(inout) :: heat(:)      !! (ndof) [energy]
    integer :: n, d

    do n = 1, size(at_places)
      d = equations%dofs%fields(field)%number(1, n)
      if (d == 0) cycle
      if (equations%solves(equations%now)%equation(d) > 0) heat(d) = at_places(n)
    end do
  end subroutine take

  !> Errors of the unknowns at the places of their field; none where there is no unknown.
  pure subroutine leave(equations, field, of_unknowns, at_places)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field               !! in the list of the scene
    real(wp), intent(in) :: of_unknowns(:)     !! (ndof) [energy] or [temperature]
    real(wp), intent(inout) :: at_places(:)    !! (nplace), of none where the field is not declared [the same]
    integer :: n, d

    do n = 1, size(at_places)
      d = equations%dofs%fields(field)%number(1, n)
      at_places(n) = 0
      if (d > 0) at_places(n) = of_unknowns(d)
    end do
  end subroutine leave

  !> Flows out of the nodes that come with a small change of the temperatures, and of the phases, at the end of the step.
  function flows_of(scene, equations, solution, dt, du, after, temperatures, mean_over, phases) result(g)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    real(wp), intent(in) :: du(:), after(:), temperatures(:)   !! (ndof) motion, its flows [power], the change [temperature]
    real(wp), intent(in) :: mean_over   !! as of flows [time]
    type(state_error_t), intent(in) :: phases(:)   !! (ngroup)
    real(wp) :: g(size(du))   !! [power]
    type(state_error_t) :: trial(size(phases))
    integer :: k

    do k = 1, size(phases)
      if (.not. allocated(phases(k)%value)) cycle
      trial(k)%value = solution%groups(k)%trial
      solution%groups(k)%trial = trial(k)%value + small*phases(k)%value
    end do
    call flows(scene, equations, solution, dt, du + small*temperatures, g, mean_over=mean_over)
    do k = 1, size(phases)
      if (allocated(trial(k)%value)) solution%groups(k)%trial = trial(k)%value
    end do
    g = (g - after)/small
  end function flows_of

  !> Flows out of the nodes less the loads at an instant of the step, without what is taken up and released.
  subroutine flows(scene, equations, solution, dt, du, g, reach, mean_over)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt      !! to the instant [time]
    real(wp), intent(in) :: du(:)   !! (ndof) motion to there [unknown]
    real(wp), intent(out) :: g(:)   !! (ndof), 0 for the unknowns of other solves [power]
    real(wp), intent(in), optional :: reach   !! share of the step; the end, or the start for dt = 0, where absent
    real(wp), intent(in), optional :: mean_over   !! as that of stage_t [time]
    real(wp) :: external(size(du))
    type(report_t) :: report

    equations%stage = stage_t(content=.false., reach=merge(1.0_wp, 0.0_wp, dt > 0))
    if (present(reach)) equations%stage%reach = reach
    if (present(mean_over)) equations%stage%mean_over = mean_over
    call evaluate(scene, equations, solution, dt, du, .false., report)
    equations%stage = stage_t()
    call external_forces(scene, equations%dofs, solution%time + dt, external)
    g = merge(equations%force - external, 0.0_wp, equations%solves(equations%now)%is_own)
  end subroutine flows

end module heat_error
