!> Error in time of the heat that kinetics release in a step of TR-BDF2.
!>
!> The phases of a point go on as if its temperature were linear in time over the whole step (phase_step). When the step has been
!> found, what forms is made once more along two pieces, by way of the temperature after its first stage, at the share s of the
!> step: the first piece is that stage itself, the second begins with its phases. Along a temperature that is quadratic in time each
!> piece errs with the third power of its length, as the trapezoidal rule does, so that the error of the step is the difference over
!> 1 - s^3 - (1 - s)^3 (as in step doubling: E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 1993,
!> II.4). Heat that is released too late or too early counts as an error of the heat content. Beside the error of implicit Euler
!> this one is of higher order.
!>
!> Errors of phases are carried on from step to step with those of the temperatures (heat_error): the points make the step once more
!> from phases and temperatures with a small share of theirs. So a phase that is behind catches up, as its kinetics say.
module kinetics_error
  use drivers, only: drivers_of_half, drivers_t
  use elem_api, only: block_done, instant_t, report_t
  use element_loop, only: gather_forces, run_elements
  use equations, only: equations_t
  use heat_points, only: functions_of, functions_t
  use kinds, only: wp
  use law_api, only: heat_law
  use path_record, only: state_error_t
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: scene_t
  use solution, only: group_state_t, solution_t
  use step_instants, only: make_instant
  implicit none
  private
  public :: add_by_temperature, content_beside, content_error_of_path, gather_heat, has_heat_law, keep_piece, knows_phases, &
            path_piece_t, take_up

  !> A piece of a step.
  type :: path_piece_t
    !> Heat taken up less what was released, by element forces; not allocated where no kinetics release heat [energy].
    real(wp), allocatable :: heat(:)
    !> States at its end, of groups with kinetics (ngroup).
    type(group_state_t), allocatable :: groups(:)
  end type path_piece_t

contains

  !> Points of these groups have kinetics that release heat (ngroup).
  pure function has_kinetics(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(size(scene%groups))
    integer :: g

    yes = equations%solves(equations%now)%active .and. has_heat_law(scene, equations)
    do g = 1, size(yes)
      if (yes(g)) yes(g) = allocated(scene%materials(scene%groups(g)%material)%steel)
    end do
  end function has_kinetics

  !> Keep what a stage has found, from its element forces and those of the flows at its end, which were evaluated last.
  subroutine keep_piece(scene, equations, solution, length, element_force, piece)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: length             !! by which the stage divides changes of the heat content [time]
    real(wp), intent(in) :: element_force(:)   !! [power]
    type(path_piece_t), intent(out) :: piece
    logical :: active(size(scene%groups))
    integer :: g

    active = has_kinetics(scene, equations)
    if (.not. any(active)) return
    piece%heat = length*(element_force - equations%buffers%force)
    allocate (piece%groups(size(active)))
    do g = 1, size(active)
      if (active(g)) piece%groups(g) = solution%groups(g)
    end do
  end subroutine keep_piece

  !> What is missing in the heat contents and in the states of points at the end of a step. Element forces and states are kept.
  subroutine content_error_of_path(scene, equations, solution, dt, share, first, whole, middle, du, heat, phases)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt                !! [time]
    real(wp), intent(in) :: share             !! of the step, where the path is bent
    type(path_piece_t), intent(in) :: first        !! the step to there
    type(path_piece_t), intent(in) :: whole        !! all of it
    real(wp), intent(in) :: middle(:)         !! (ndof) motion to there [unknown]
    real(wp), intent(in) :: du(:)             !! (ndof) motion of the step [unknown]
    real(wp), intent(out) :: heat(:)          !! (ndof) [energy]
    type(state_error_t), allocatable, intent(out) :: phases(:)   !! (ngroup); not allocated where no kinetics release heat
    type(drivers_t), allocatable :: drivers(:)
    type(instant_t) :: instant
    real(wp) :: taken(size(equations%buffers%force)), bend
    logical :: active(size(scene%groups)), done
    integer :: g

    heat = 0
    if (.not. allocated(whole%heat)) return
    active = has_kinetics(scene, equations)
    do g = 1, size(active)
      if (active(g)) solution%groups(g)%committed = first%groups(g)%trial
    end do
    call drivers_of_half(equations%drivers, solution%groups, .true., drivers, share)
    call make_instant(scene, equations, solution, (1 - share)*dt, du - middle, .false., instant)
    instant%flow%n = 0
    instant%values = instant%values + middle
    call take_up(scene, equations, solution, active, instant, du - middle, taken, done, drivers)
    if (done) then
      bend = 1 - share**3 - (1 - share)**3
      call gather_heat(equations, active, whole%heat - first%heat - instant%dt*taken, heat)
      heat = heat/bend
      allocate (phases(size(active)))
      do g = 1, size(active)
        if (active(g)) phases(g)%value = (solution%groups(g)%trial - whole%groups(g)%trial)/bend
      end do
    end if
    do g = 1, size(active)
      if (active(g)) solution%groups(g) = whole%groups(g)
    end do
  end subroutine content_error_of_path

  !> The phases of a step are known, so that errors of them can be carried on.
  pure function knows_phases(piece) result(yes)
    type(path_piece_t), intent(in) :: piece   !! all of the step
    logical :: yes

    yes = allocated(piece%heat)
  end function knows_phases

  !> What the heat content takes up more in a step, and what phases have more at its end, for errors at its start and none of the
  !> temperatures at its end; and how phases there follow these temperatures, by the derivatives that the kinetics bring along.
  !> `touched` are the unknowns of points with kinetics. Element forces and states are kept.
  subroutine content_beside(scene, equations, solution, dt, du, before, share, whole, heat, phases, by_end, touched, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution    !! errors of the phases at the start of the step are in its groups
    real(wp), intent(in) :: dt                     !! [time]
    real(wp), intent(in) :: du(:)                  !! (ndof) motion of the step [unknown]
    real(wp), intent(in) :: before(:)              !! (ndof) errors of the temperatures at its start [temperature]
    real(wp), intent(in) :: share                  !! of the errors, so small that all is linear
    type(path_piece_t), intent(in) :: whole        !! all of the step
    real(wp), intent(out) :: heat(:)               !! (ndof) [energy]
    type(state_error_t), intent(out) :: phases(:)  !! (ngroup) at the end
    type(state_error_t), intent(out) :: by_end(:)  !! (ngroup) derivative by the temperature of the point at the end
    logical, intent(out) :: touched(:)             !! (ndof)
    logical, intent(out) :: done                   !! false where the step cannot be made from there
    type(group_state_t) :: kept(size(scene%groups))
    type(instant_t) :: instant
    real(wp) :: taken(size(equations%buffers%force))
    logical :: holds(size(scene%groups)), active(size(scene%groups))
    integer :: g, e, n

    heat = 0
    touched = .false.
    holds = has_kinetics(scene, equations)
    active = equations%solves(equations%now)%active .and. has_heat_law(scene, equations)
    call make_instant(scene, equations, solution, dt, du, .false., instant)
    instant%values = instant%values + share*before
    instant%flow%n = 0
    do g = 1, size(holds)
      if (.not. active(g)) cycle
      if (.not. holds(g)) then
        kept(g)%trial = solution%groups(g)%trial
        cycle
      end if
      call move_alloc(solution%groups(g)%committed, kept(g)%committed)
      call move_alloc(solution%groups(g)%trial, kept(g)%trial)
      n = size(kept(g)%committed, 1)
      ! with as many rows again the element states the derivatives
      allocate (solution%groups(g)%trial(2*n, size(kept(g)%committed, 2), size(kept(g)%committed, 3)), source=0.0_wp)
      solution%groups(g)%committed = kept(g)%committed + share*solution%groups(g)%error
      associate (dof => equations%dofs%groups(g)%dof)
        do e = 1, size(dof, 2)
          touched(dof(:, e)) = .true.
        end do
      end associate
    end do
    call take_up(scene, equations, solution, active, instant, du - share*before, taken, done)
    if (done) call gather_heat(equations, active, (instant%dt*taken - whole%heat)/share, heat)
    do g = 1, size(holds)
      if (.not. active(g)) cycle
      if (holds(g)) then
        if (done) then
          n = size(kept(g)%committed, 1)
          phases(g)%value = (solution%groups(g)%trial(:n, :, :) - whole%groups(g)%trial)/share
          by_end(g)%value = solution%groups(g)%trial(n + 1:, :, :)
        end if
        call move_alloc(kept(g)%committed, solution%groups(g)%committed)
      end if
      call move_alloc(kept(g)%trial, solution%groups(g)%trial)
    end do
  end subroutine content_beside

  !> What groups take up at an instant: element forces of all groups. Drivers do not vary, but stay as they are, or are others. What
  !> the buffers hold is kept.
  subroutine take_up(scene, equations, solution, active, instant, du, taken, done, drivers)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution   !! its trial states are those of the instant then
    logical, intent(in) :: active(:)              !! (ngroup)
    type(instant_t), intent(in) :: instant
    real(wp), intent(in) :: du(:)                 !! (ndof) motion to there [unknown]
    real(wp), intent(out) :: taken(:)             !! (nforce) [power]
    logical, intent(out) :: done                  !! false where the step cannot be made so
    type(drivers_t), intent(inout), optional :: drivers(:)   !! (ngroup)
    type(report_t) :: report
    real(wp) :: element_force(size(taken)), none(0, 0)
    logical :: vary(size(active))

    associate (solve => equations%solves(equations%now), buffers => equations%buffers)
      element_force = buffers%force
      if (present(drivers)) then
        call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, solve%pattern, &
                          instant, du, none, solution, drivers, buffers, equations%timers, report)
      else
        vary = equations%drivers%vary
        equations%drivers%vary = .false.
        call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, solve%pattern, &
                          instant, du, none, solution, equations%drivers, buffers, equations%timers, report)
        equations%drivers%vary = vary
      end if
      taken = buffers%force
      buffers%force = element_force
    end associate
    done = report%status == block_done
  end subroutine take_up

  !> Heat of the elements of groups at the nodes. What the buffers hold is kept.
  subroutine gather_heat(equations, active, of_elements, heat)
    type(equations_t), intent(inout) :: equations
    logical, intent(in) :: active(:)          !! (ngroup)
    real(wp), intent(in) :: of_elements(:)    !! (nforce) [energy]
    real(wp), intent(out) :: heat(:)          !! (ndof) [energy]
    real(wp) :: element_force(size(of_elements)), magnitude(size(heat))

    associate (solve => equations%solves(equations%now), buffers => equations%buffers)
      element_force = buffers%force
      buffers%force = merge(of_elements, 0.0_wp, of_groups(equations, active))
      call gather_forces(solve%pattern, buffers, solve%is_own, heat, magnitude)
      buffers%force = element_force
    end associate
  end subroutine gather_heat

  !> Add to errors of phases at the end of a step what errors of the temperatures there make of them. Hardness follows the
  !> fractions: it has no derivative of its own.
  subroutine add_by_temperature(scene, equations, by_end, temperatures, phases)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(state_error_t), intent(in) :: by_end(:)      !! (ngroup) derivatives by the temperature of the point
    real(wp), intent(in) :: temperatures(:)           !! (ndof) [temperature]
    type(state_error_t), intent(inout) :: phases(:)   !! (ngroup)
    type(quad8_rule_t) :: rule
    type(functions_t) :: own
    real(wp) :: at_points(9)
    integer :: g, e, p, n

    do g = 1, size(by_end)
      if (.not. allocated(by_end(g)%value)) cycle
      associate (dofs => equations%dofs%groups(g), npoint => scene%groups(g)%rule%n)
        n = dofs%layout%count(1)   ! the temperature is the first of its unknowns
        call quad8_rule(npoint, rule)
        call functions_of(n == 4, rule, own)
        do e = 1, size(dofs%dof, 2)
          at_points(:npoint) = matmul(temperatures(dofs%dof(:n, e)), own%phi(:n, :npoint))
          do p = 1, npoint
            phases(g)%value(:, p, e) = phases(g)%value(:, p, e) + by_end(g)%value(:, p, e)*at_points(p)
          end do
        end do
      end associate
    end do
  end subroutine add_by_temperature

  !> Groups that conduct heat (ngroup).
  pure function has_heat_law(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(size(scene%groups))
    integer :: g

    yes = .false.
    do g = 1, size(yes)
      if (scene%groups(g)%material > 0) yes(g) = equations%laws(scene%materials(scene%groups(g)%material)%law_id)%kind == heat_law
    end do
  end function has_heat_law

  !> Element forces that are of these groups.
  pure function of_groups(equations, active) result(yes)
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: active(:)   !! (ngroup)
    logical :: yes(size(equations%buffers%force))
    integer :: g, m

    yes = .false.
    do g = 1, size(active)
      if (.not. active(g)) cycle
      m = equations%solves(1)%pattern%force_start(g)
      yes(m + 1:m + size(equations%dofs%groups(g)%dof)) = .true.
    end do
  end function of_groups

end module kinetics_error
