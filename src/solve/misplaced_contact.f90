!> Error of temperatures that comes of where contact stands: of the heat that passes by points that bear, or are open by so much,
!> only because the places of nodes err (path_record).
!>
!> Where a side lies on a die with gaps that are no more than what its places err, those errors decide which of its points bear and
!> which do not, and by that how much heat passes, however exact temperatures are in time. So contact is made once more at the end
!> of the step, from places with their error and from places with the error the other way. With F(e) the flows out of the nodes by
!> contact there, a better run has (F(-e) - F(e))/2 more heat per time. The errors are taken as a whole, for points open and close
!> by them; both ways, as points are few and the mean of what they do is wanted. It is an error of the temperatures at the end of
!> the step, carried on with the others (heat_error). No length of a step follows from it, for places err by all steps so far.
!>
!> What the errors make of forces is balanced first, each way (contact_beside): a point that comes to bear does so by what resists
!> it, and places keep within the gaps that dies leave. Where a body rests between dies that press it no more, where it lies does
!> not count, and a point that closes bears nothing yet; nor does it in steps whose matrix is not at hand, where pressures stay
!> those of the step. Where forces move a die errors of gaps are not known, and nothing is added.
module misplaced_contact
  use contact_conductance, only: conductance_count, conductance_of_solution, hand_over
  use contact_lag, only: add_rates
  use contact_beside, only: balance, contact_from, find_resting
  use dies, only: is_deformable
  use drivers, only: at_pressure, at_status
  use equations, only: equations_t, take_turn
  use fields, only: displacement_field, find_field
  use heat_error, only: flows
  use heat_in_system, only: acting_t, ask_for_all, ask_for_heat
  use heat_stages, only: evaluation_t, in_two_stages, keep_evaluation, return_to
  use kinds, only: wp
  use law_api, only: contact_open
  use path_states, only: of_unknowns, on_nodes
  use resting_bodies, only: remove_rigid_motion
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  use step_outcome, only: outcome_t
  use timers, only: ledger_t
  implicit none
  private
  public :: add_misplaced, leaves_places_out

  !> A change of conductances, or of shares of radiation, that is no more than this share of them is left out.
  real(wp), parameter :: negligible = 3.0e-4_wp

contains

  !> After the path within a step has been judged: errors of its temperatures with those of its contact. Forces, element forces and
  !> states stay those of the step. Nothing where one of both errors is not estimated, or no heat passes by contact that moves.
  subroutine add_misplaced(scene, equations, solution, dt, at_hand, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution   !! its trial state is that of the step
    real(wp), intent(in) :: dt       !! [time]
    logical, intent(in) :: at_hand   !! factors of a matrix of the motion of this step are
    type(outcome_t), intent(inout) :: outcome
    type(evaluation_t) :: kept
    type(acting_t) :: asked
    type(group_state_t), allocatable :: states(:)
    real(wp), allocatable :: errors(:), now(:), with(:), against(:)
    type(solution_t) :: other
    real(wp), dimension(equations%dofs%ndof) :: rates, force, with_errors, against_errors
    integer :: solve, timer, g
    logical :: done, balanced, resting(0:size(equations%loose)), keeps(size(scene%groups))

    if (.not. (outcome%converged .and. outcome%heat%estimated .and. scene%follows_path)) return
    if (conductance_count(equations%drivers) == 0) return
    if (leaves_places_out(scene, equations)) return
    allocate (errors(equations%dofs%ndof))
    if (allocated(outcome%path%error)) then
      errors = of_unknowns(equations, outcome%path%error)
    else
      errors = of_unknowns(equations, solution%path%error)
    end if
    if (.not. any(abs(errors) > 0)) return
    call equations%timers%add('contact heat error', timer)
    call equations%timers%start(timer)
    solve = equations%now
    call keep_evaluation(equations, kept)
    allocate (states, source=solution%groups)
    call take_turn(equations, displacement_field)
    other = solution
    call contact_from(scene, equations, solution, dt, outcome%du, 0*errors, other, done, force)
    call find_resting(scene, equations, solution, dt, other, resting)
    if (any(resting)) call remove_rigid_motion(scene, equations, solution, errors, resting)
    keeps = keeps_pressures(scene, equations, resting)
    with_errors = errors
    against_errors = -errors
    allocate (now(conductance_count(equations%drivers)))
    allocate (with, against, mold=now)
    call conductance_of_solution(scene, solution, equations%drivers, now)
    balanced = done .and. at_hand
    call conductance_from(scene, equations, solution, dt, force, balanced, keeps, outcome, with_errors, other, with, done)
    if (done) call conductance_from(scene, equations, solution, dt, force, balanced, keeps, outcome, against_errors, other, &
                                    against, done)
    if (done) then
      if (balanced) outcome%path%error = on_nodes(equations, 0.5_wp*(with_errors - against_errors))
      if (differ(with(1::2), against(1::2)) .or. differ(with(2::2), against(2::2))) then
        call take_turn(equations, find_field(scene%fields, 'temperature'))
        call ask_for_heat(scene, equations, asked)
        call flows_between(scene, equations, solution, dt, outcome, with, against, rates)
        call hand_over(now, equations%drivers)
        call add_rates(scene, equations, solution, dt, rates, outcome)
        call hand_over(now(:0), equations%drivers)
        call ask_for_all(asked, equations)
      end if
    end if
    if (allocated(outcome%error)) outcome%converged = .false.
    do g = 1, size(states)
      if (allocated(states(g)%trial)) call move_alloc(states(g)%trial, solution%groups(g)%trial)
    end do
    call return_to(kept, equations)
    equations%now = solve
    call equations%timers%stop(timer)
  end subroutine add_misplaced

  !> Contacts by which heat passes from or to a body that rests (ngroup): where it lies does not count.
  pure function keeps_pressures(scene, equations, resting) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: resting(0:)   !! (0:nnode) by the number of the body
    logical :: yes(size(scene%groups))
    integer :: g

    yes = .false.
    if (.not. any(resting)) return
    do g = 1, size(yes)
      if (.not. equations%drivers(g)%is_of_heat_contact) cycle
      associate (group => scene%groups(g))
        if (size(group%connectivity) > 0) yes(g) = resting(equations%loose(group%connectivity(1, 1)))
        if (group%die == 0) cycle
        if (is_deformable(scene%dies(group%die))) yes(g) = yes(g) .or. resting(equations%loose(scene%dies(group%die)%nodes(1, 1)))
      end associate
    end do
  end function keeps_pressures

  !> Values of all points are others, by more than a share of them; below 0 they stand for none.
  pure function differ(with, against) result(yes)
    real(wp), intent(in) :: with(:), against(:)   !! (npoint) conductances, or shares of radiation
    logical :: yes

    yes = sum(abs(with - against)) > negligible*sum(max(with, 0.0_wp) + max(against, 0.0_wp))
  end function differ

  !> Heat passes by contact that moves, and errors of its places are not known.
  pure function leaves_places_out(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes

    yes = .false.
    if (scene%follows_path .and. conductance_count(equations%drivers) > 0) yes = free_beside_nodes(scene, equations)
  end function leaves_places_out

  !> Forces move dies, or a section is free: errors of their places are not carried, so that those of gaps are not known.
  pure function free_beside_nodes(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes
    integer :: f, k, c

    yes = .false.
    do f = 1, size(scene%fields)
      if (f == displacement_field .or. scene%fields(f)%quantity /= 'motion') cycle
      associate (number => equations%dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (number(c, k) > 0) yes = yes .or. is_free(equations, number(c, k))
          end do
        end do
      end associate
    end do
  end function free_beside_nodes

  !> An unknown is solved for.
  pure function is_free(equations, unknown) result(yes)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: unknown   !! among those of all fields
    logical :: yes
    integer :: s

    yes = .false.
    do s = 1, size(equations%solves)
      yes = yes .or. equations%solves(s)%equation(unknown) > 0
    end do
  end function is_free

  !> Conductances of contact from other places, by the pressures there or, where these cannot be balanced, those of the step.
  subroutine conductance_from(scene, equations, solution, dt, force, balanced, keeps, outcome, apart, other, values, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                !! [time]
    real(wp), intent(in) :: force(:)          !! (ndof) of contact in the step [residual]
    logical, intent(in) :: balanced           !! errors are balanced, by factors at hand
    logical, intent(in) :: keeps(:)           !! (ngroup) pressures stay those of the step
    type(outcome_t), intent(inout) :: outcome
    real(wp), intent(inout) :: apart(:)       !! (ndof) errors of places [unknown]
    type(solution_t), intent(inout) :: other  !! a copy of the solution
    real(wp), intent(out) :: values(:)        !! (conductance_count) [power/area/temperature], [-]
    logical, intent(out) :: done
    integer :: g

    if (balanced) then
      call balance(scene, equations, solution, dt, force, outcome, apart, other, done)
    else
      call contact_from(scene, equations, solution, dt, outcome%du, apart, other, done)
    end if
    if (.not. done) return
    do g = 1, size(scene%groups)
      if ((balanced .and. .not. keeps(g)) .or. .not. equations%drivers(g)%is_of_heat_contact) cycle
      associate (host => scene%groups(g)%host, source => equations%drivers(g)%source)
        associate (status => source(at_status)%row(host), pressure => source(at_pressure)%row(host), &
                   now => solution%groups(host)%trial)
          other%groups(host)%trial(pressure, :, :) = merge(0.0_wp, now(pressure, :, :), nint(now(status, :, :)) == contact_open)
        end associate
      end associate
    end do
    call conductance_of_solution(scene, other, equations%drivers, values)
  end subroutine conductance_from

  !> Half of what flows out of the nodes more by conductances `against` than by those `with` the errors.
  subroutine flows_between(scene, equations, solution, dt, outcome, with, against, rates)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt                       !! [time]
    type(outcome_t), intent(in) :: outcome
    real(wp), intent(in) :: with(:), against(:)      !! (conductance_count) [power/area/temperature], [-]
    real(wp), intent(out) :: rates(:)                !! (ndof) [power]
    real(wp) :: by_error(size(rates)), length
    logical :: active(size(scene%groups))

    length = merge(0.0_wp, dt, in_two_stages(scene, solution, outcome))
    active = equations%solves(equations%now)%active
    ! what others pass is the same
    equations%solves(equations%now)%active = active .and. equations%drivers%is_of_heat_contact
    call hand_over(with, equations%drivers)
    call flows(scene, equations, solution, dt, outcome%du, by_error, mean_over=length)
    call hand_over(against, equations%drivers)
    call flows(scene, equations, solution, dt, outcome%du, rates, mean_over=length)
    rates = 0.5_wp*(rates - by_error)
    equations%solves(equations%now)%active = active
  end subroutine flows_between

end module misplaced_contact
