!> Errors of temperatures in time in the states of bodies that flow, and those of the phases that follow them (path_stress).
!>
!> Temperatures have errors of their own (heat_error), found before those of the stress: e0 at the start of a step and e1 at its
!> end. A better run is at temperatures that are so much others. Phases that another formulation on the body holds make the step
!> from theirs at temperatures with a small share of e0 and of e1; so their errors are carried on, as those of the other states are.
!> To them comes what the step errs in phases itself, along temperatures that bend within it, where that is known (kinetics_error).
!> A body that has its kinetics itself needs nothing of this but the temperatures.
module path_heat
  use drivers, only: drivers_t, from_state
  use elem_api, only: block_done, instant_t, report_t
  use element_loop, only: run_elements
  use equations, only: equations_t
  use fields, only: find_field
  use kinds, only: wp
  use law_api, only: heat_law
  use path_record, only: state_error_t
  use path_states, only: begin_beside
  use scene, only: host_of, scene_t
  use solution, only: solution_t
  use step_instants, only: make_instant
  use step_outcome, only: outcome_t
  use timers, only: ledger_t
  implicit none
  private
  public :: follow_heat, warmth_t

  !> What errors of temperatures are in a step.
  type :: warmth_t
    !> They are some.
    logical :: any = .false.
    !> At the start of the step, and how they change in it (ndof) [temperature].
    real(wp), allocatable :: before(:), change(:)
    !> Errors of the phases at its end (ngroup).
    type(state_error_t), allocatable :: phases(:)
    !> Drivers of the step with the share of these errors; they hold as they are.
    type(drivers_t), allocatable :: drivers(:)
  end type warmth_t

contains

  !> Errors of temperatures and phases in a step that has converged. `done` is false where the phases cannot be followed. Element
  !> forces of the phases' groups are lost.
  subroutine follow_heat(scene, equations, solution, active, dt, share, outcome, warmth, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution    !! its trial state is that of the step
    logical, intent(in) :: active(:)            !! (ngroup) bodies that flow
    real(wp), intent(in) :: dt                  !! [time]
    real(wp), intent(in) :: share               !! of the errors, so small that all is linear
    type(outcome_t), intent(in) :: outcome
    type(warmth_t), intent(out) :: warmth
    logical, intent(out) :: done
    integer :: f

    done = .true.
    allocate (warmth%drivers, source=equations%drivers)
    warmth%drivers%vary = .false.
    allocate (warmth%before(size(outcome%du)), warmth%change(size(outcome%du)), source=0.0_wp)
    allocate (warmth%phases(size(active)))
    f = find_field(scene%fields, 'temperature')
    if (f == 0 .or. .not. outcome%heat%estimated) return
    warmth%before = of_unknowns(equations%dofs%fields(f)%number(1, :), solution%heat%temperature_error, size(outcome%du))
    warmth%change = of_unknowns(equations%dofs%fields(f)%number(1, :), outcome%heat%temperature_error, size(outcome%du)) &
                    - warmth%before
    warmth%any = any(abs(warmth%before) > 0) .or. any(abs(warmth%change) > 0)
    if (warmth%any) call follow_phases(scene, equations, solution, active, dt, share, outcome, warmth, done)
  end subroutine follow_heat

  !> Values at nodes as those of the unknowns there.
  pure function of_unknowns(number, at_nodes, ndof) result(values)
    integer, intent(in) :: number(:)        !! (nnode) of the unknown, 0 where there is none
    real(wp), intent(in) :: at_nodes(:)     !! (nnode)
    integer, intent(in) :: ndof
    real(wp) :: values(ndof)
    integer :: n

    values = 0
    do n = 1, size(number)
      if (number(n) > 0) values(number(n)) = at_nodes(n)
    end do
  end function of_unknowns

  !> The phases of bodies that flow, at the other temperatures; and what drives these bodies then.
  subroutine follow_phases(scene, equations, solution, active, dt, share, outcome, warmth, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: active(:)   !! (ngroup) bodies that flow
    real(wp), intent(in) :: dt         !! [time]
    real(wp), intent(in) :: share      !! of the errors
    type(outcome_t), intent(in) :: outcome
    type(warmth_t), intent(inout) :: warmth
    logical, intent(out) :: done
    logical :: holds(size(active))
    type(solution_t) :: other
    type(drivers_t), allocatable :: drivers(:)
    type(instant_t) :: instant
    type(report_t) :: report
    type(ledger_t) :: within
    real(wp) :: none(0, 0)
    integer :: g

    done = .true.
    holds = has_phases(scene, equations, active)
    if (.not. any(holds)) return
    call begin_beside(solution, other)
    do g = 1, size(holds)
      if (holds(g)) other%groups(g)%committed = other%groups(g)%committed + share*solution%groups(g)%error
    end do
    drivers = warmth%drivers
    call make_instant(scene, equations, other, dt, outcome%du, .false., instant)
    instant%values = instant%values + share*warmth%before
    ! what heat flows does not matter
    instant%flow%n = 0
    call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, holds, &
                      equations%solves(equations%now)%pattern, instant, outcome%du + share*warmth%change, none, other, drivers, &
                      equations%buffers, within, report)
    done = report%status == block_done
    if (.not. done) return
    do g = 1, size(holds)
      if (.not. holds(g)) cycle
      warmth%phases(g)%value = (other%groups(g)%trial - solution%groups(g)%trial)/share
      if (.not. allocated(outcome%heat%phases)) cycle
      if (allocated(outcome%heat%phases(g)%value)) warmth%phases(g)%value = warmth%phases(g)%value + outcome%heat%phases(g)%value
    end do
    do g = 1, size(active)
      if (active(g)) call drive(scene, solution, g, share, warmth)
    end do
  end subroutine follow_phases

  !> Groups of heat whose states are phases that drive bodies which flow (ngroup).
  pure function has_phases(scene, equations, active) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: active(:)   !! (ngroup) bodies that flow
    logical :: yes(size(active))
    integer :: g, k, s

    yes = .false.
    do g = 1, size(active)
      if (.not. (active(g) .and. allocated(equations%drivers(g)%source))) cycle
      do k = 1, size(equations%drivers(g)%source)
        associate (source => equations%drivers(g)%source(k))
          if (source%kind /= from_state) cycle
          s = source%group(host_of(scene, g))
          associate (law => equations%laws(scene%materials(scene%groups(s)%material)%law_id))
            yes(s) = law%kind == heat_law .and. law%of_steel
          end associate
        end associate
      end do
    end do
  end function has_phases

  !> The errors of the phases at both ends of the step are among the drivers of a body on the same points.
  pure subroutine drive(scene, solution, g, share, warmth)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g           !! group of the body
    real(wp), intent(in) :: share      !! of the errors
    type(warmth_t), intent(inout) :: warmth
    integer :: k, s

    associate (own => warmth%drivers(g), body => host_of(scene, g))
      if (.not. allocated(own%source)) return
      do k = 1, size(own%source)
        if (own%source(k)%kind /= from_state) cycle
        s = own%source(k)%group(body)
        if (.not. allocated(warmth%phases(s)%value)) cycle
        associate (row => own%source(k)%row(body))
          own%value(k, 1, :, :) = own%value(k, 1, :, :) + share*solution%groups(s)%error(row, :, :)
          own%value(k, 2, :, :) = own%value(k, 2, :, :) + share*warmth%phases(s)%value(row, :, :)
        end associate
      end do
    end associate
  end subroutine drive

end module path_heat
