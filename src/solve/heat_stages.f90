!> A step of the balance of heat in time, with its error: implicit Euler, or TR-BDF2.
!>
!> With H the heat content, less what was released, and G the flows out of the nodes less the loads (H' + G = 0), TR-BDF2 as a
!> Runge-Kutta method (R.E. Bank et al., IEEE Trans. Electron Devices 32 (1985) 1992-2007; M.E. Hosea, L.F. Shampine, Appl. Numer.
!> Math. 20 (1996) 21-37) has stages at the start, after 2 D dt, and at the end, D = 1 - 1/sqrt(2), W = sqrt(2)/4:
!>   (H1 - Hn)/(D dt) + G0 + G1 = 0,   (H2 - Hn)/(D dt) + (W/D)(G0 + G1) + G2 = 0.
!> It is of second order and L-stable, and both stages have the same matrix. The difference to its embedded formula of third order
!> is its error, sum of E_k G_k dt, to which comes that of the heat that kinetics release along the temperatures of the step
!> (kinetics_error); of implicit Euler it is the difference to the trapezoidal rule, (G1 - G0) dt/2 (heat_error).
!> A first step is of implicit Euler: what was started with need not agree with what is imposed, which would cost TR-BDF2 an order.
module heat_stages
  use contact_conductance, only: conductance_count
  use equations, only: equations_t, remedy_euler, remedy_monotone, remedy_none, stage_t
  use external_loads, only: external_forces
  use fields, only: find_field
  use heat_bounds, only: find_excess, has_bounds, has_rough_bounds, on_corners_alone
  use heat_error, only: diagonal, estimate_error, flows, weight
  use kinds, only: wp
  use kinetics_error, only: content_error_of_path, keep_piece, path_piece_t
  use scene, only: role_heat_contact, scene_t
  use solution, only: solution_t
  use step_equilibrium, only: solve_step
  use step_outcome, only: outcome_t
  use strategy, only: scheme_tr_bdf2
  use text, only: to_text
  use torch_error, only: add_torches, in_sum
  use torch_steps, only: torch_step
  implicit none
  private
  public :: add_middle, evaluation_t, in_two_stages, is_heat_alone, judge, keep_evaluation, return_to, solve_heat

  !> The weights of the stages, the shares of the step at which they end, and the weights of the error.
  real(wp), parameter :: weights(0:2) = [weight, weight, diagonal]
  real(wp), parameter :: instants(0:2) = [0.0_wp, 2*diagonal, 1.0_wp]
  real(wp), parameter :: error_weights(0:2) = weights - [(1 - weight)/3, (3*weight + 1)/3, diagonal/3]
  !> A step is made so much shorter than its error asks for, and at least and at most this factor after one that is too long.
  real(wp), parameter :: safety = 0.9_wp, least_factor = 0.1_wp

  !> Temperatures of bodies that release heat themselves, latent or by work, may leave those around them by this share of the range.
  real(wp), parameter :: own_heat = 0.05_wp

  !> What an evaluation leaves behind that the books are made of.
  type :: evaluation_t
    real(wp), allocatable :: force(:), magnitude(:), element_force(:)
    real(wp) :: heat_stored = 0.0_wp, heat_released = 0.0_wp, source = 0.0_wp
  end type evaluation_t

contains

  !> The present solve has temperatures and no other quantity.
  pure function is_heat_alone(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes
    integer :: f, k

    f = find_field(scene%fields, 'temperature')
    yes = .false.
    if (f == 0) return
    associate (own => equations%solves(equations%now)%own)
      yes = scene%fields(f)%declared .and. own(f)
      do k = 1, size(own)
        if (own(k) .and. scene%fields(k)%declared) yes = yes .and. scene%fields(k)%quantity == 'temperature'
      end do
    end associate
  end function is_heat_alone

  !> Find the temperatures at the end of a step of length dt. Its error, where it is estimated, decides whether the step must be
  !> shortened, and how long the next may be.
  subroutine solve_heat(scene, equations, solution, dt, outcome, given, go_on)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: given(:)   !! (ndof) motion of other solves' unknowns; of all with go_on [unknown]
    logical, intent(in), optional :: go_on       !! from `given` for the own unknowns too
    logical :: bounded, two_stages

    bounded = has_bounds(scene, equations)
    two_stages = scene%strategy%scheme == scheme_tr_bdf2 .and. solution%last_step > 0
    if (two_stages) then
      if (allocated(scene%sources)) then
        allocate (equations%torches)
        call torch_step(scene, solution%time, dt, instants, weights, equations%torches)
      end if
      call solve_two_stages(scene, equations, solution, dt, outcome, given)
      if (allocated(equations%torches)) deallocate (equations%torches)
    else
      call solve_one_stage(scene, equations, solution, dt, outcome, given, go_on)
    end if
    if (.not. outcome%converged) return
    if (bounded) then
      call find_excess(scene, equations, solution, dt, outcome%du, outcome%heat)
      call keep_to_bounds(scene, equations, solution, dt, two_stages, outcome, given, go_on)
      if (.not. outcome%converged) return
    else if (has_rough_bounds(scene)) then
      call find_excess(scene, equations, solution, dt, outcome%du, outcome%heat)
      if (outcome%heat%excess < own_heat*(outcome%heat%high - outcome%heat%low)) outcome%heat%excess = 0
    end if
    call judge(scene, solution, dt, outcome)
  end subroutine solve_heat

  !> Make a step that has left its bounds again, where temperatures stand on corners: by implicit Euler, which keeps to them on
  !> rectangles; then without flows against the fall of the temperature, which keeps to them on any mesh.
  subroutine keep_to_bounds(scene, equations, solution, dt, two_stages, outcome, given, go_on)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    logical, intent(in) :: two_stages
    type(outcome_t), intent(inout) :: outcome
    real(wp), intent(in), optional :: given(:)
    logical, intent(in), optional :: go_on
    type(outcome_t) :: again
    integer :: remedy

    if (.not. on_corners_alone(scene)) return
    do remedy = remedy_euler, remedy_monotone
      if (.not. outcome%heat%excess > 0) exit
      if (remedy == remedy_euler .and. .not. two_stages .and. scene%strategy%theta >= 1) cycle
      equations%remedy = remedy
      call solve_one_stage(scene, equations, solution, dt, again, given, go_on)
      again%heat%fell_back = .true.
      call add_iterations(outcome, again)
      outcome = again
      if (.not. outcome%converged) exit
      call find_excess(scene, equations, solution, dt, outcome%du, outcome%heat)
    end do
    equations%remedy = remedy_none
  end subroutine keep_to_bounds

  !> A step of the theta scheme; with its error where it is implicit Euler. Where no step depends on the error, factors of the last
  !> iteration do for it.
  subroutine solve_one_stage(scene, equations, solution, dt, outcome, given, go_on)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: given(:)
    logical, intent(in), optional :: go_on
    real(wp), dimension(equations%dofs%ndof) :: rest, before, after, rates, erred, mean
    type(evaluation_t) :: kept
    type(path_piece_t) :: whole

    if (.not. (scene%strategy%scheme == scheme_tr_bdf2 .or. scene%strategy%theta >= 1)) then
      call solve_step(scene, equations, solution, dt, outcome, given=given, go_on=go_on)
      return
    end if
    rest = 0
    call flows(scene, equations, solution, 0.0_wp, rest, before, mean_over=dt)
    erred = 0
    mean = 0
    call add_torches(scene, equations, [-0.5_wp, 0.5_wp], erred, mean)
    call solve_step(scene, equations, solution, dt, outcome, given=given, go_on=go_on)
    if (.not. outcome%converged) return
    call keep_evaluation(equations, kept)
    call flows(scene, equations, solution, dt, outcome%du, after, mean_over=dt)
    call add_torches(scene, equations, [0.5_wp, 0.5_wp], erred, mean)
    call keep_piece(scene, equations, solution, dt, kept%element_force, whole)
    rates = 0.5_wp*(after - before)
    call add_middle(scene, equations, solution, dt, outcome%du, before + after, rates, erred, mean)
    call estimate_error(scene, equations, solution, dt, rates, in_sum(erred, mean), after, .false., whole, outcome, &
                        at_hand=.not. scene%strategy%time_tolerance > 0 .and. outcome%iterations > 0)
    call return_to(kept, equations)
  end subroutine solve_one_stage

  !> Where conductances of contact follow the motion, which takes them through their tables however little temperatures change, the
  !> mean of the flows is that of Simpson's rule, (G0 + 4 G1/2 + G1)/6 in place of (G0 + G1)/2.
  subroutine add_middle(scene, equations, solution, dt, du, both, rates, erred, mean)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt                       !! [time]
    real(wp), intent(in) :: du(:)                    !! (ndof) motion of the step [unknown]
    real(wp), intent(in) :: both(:)                  !! (ndof) flows at the start and at the end, added [power]
    real(wp), intent(inout) :: rates(:)              !! (ndof) error of the flows [power]
    real(wp), intent(inout) :: erred(:), mean(:)     !! (ndof) the same of torches, and their mean (torch_error) [power]
    real(wp), dimension(size(du)) :: middle, of_torches, unused

    if (conductance_count(equations%drivers) == 0) return
    call flows(scene, equations, solution, 0.5_wp*dt, 0.5_wp*du, middle, reach=0.5_wp, mean_over=dt)
    rates = rates + (both - 2*middle)/3
    of_torches = 0
    unused = 0
    call add_torches(scene, equations, [1.0_wp, 0.0_wp], of_torches, unused)
    erred = erred + 2*(mean - of_torches)/3
    mean = (mean + 2*of_torches)/3
  end subroutine add_middle

  !> A step of TR-BDF2. Forces and element forces are left as the means over the step, for the books.
  subroutine solve_two_stages(scene, equations, solution, dt, outcome, given)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    type(outcome_t), intent(out) :: outcome
    real(wp), intent(in), optional :: given(:)
    real(wp), dimension(equations%dofs%ndof, 0:2) :: g
    real(wp), dimension(equations%dofs%ndof) :: start, external, left, heat, erred, mean
    real(wp) :: passed(size(equations%buffers%force)), element_force(size(equations%buffers%force))
    type(evaluation_t) :: kept
    type(path_piece_t) :: piece, whole
    type(outcome_t) :: first

    start = 0
    call flows(scene, equations, solution, 0.0_wp, start, g(:, 0))
    if (present(given)) start = 2*diagonal*given
    passed = 0
    erred = 0
    mean = 0
    call add_passed(scene, equations, weights(0), passed)
    call add_torches(scene, equations, [error_weights(0), weights(0)], erred, mean)

    equations%stage = stage_t(share=0.5_wp, reach=2*diagonal)
    call solve_step(scene, equations, solution, 2*diagonal*dt, first, left=g(:, 0), given=start)
    equations%stage = stage_t()
    if (.not. first%converged) then
      outcome = first
      return
    end if
    element_force = equations%buffers%force
    call flows(scene, equations, solution, 2*diagonal*dt, first%du, g(:, 1), reach=2*diagonal)
    call keep_piece(scene, equations, solution, diagonal*dt, element_force, piece)
    call add_passed(scene, equations, weights(1), passed)
    call add_torches(scene, equations, [error_weights(1), weights(1)], erred, mean)

    ! the temperatures go on as they went in the first stage
    start = first%du/(2*diagonal)
    if (present(given)) start = merge(start, given, equations%solves(equations%now)%is_own)
    left = (weight/diagonal)*(g(:, 0) + g(:, 1))
    equations%stage = stage_t(share=diagonal)
    call solve_step(scene, equations, solution, dt, outcome, left=left, given=start, go_on=.true.)
    equations%stage = stage_t()
    call add_iterations(first, outcome)
    if (.not. outcome%converged) return

    call keep_evaluation(equations, kept)
    call flows(scene, equations, solution, dt, outcome%du, g(:, 2))
    call add_torches(scene, equations, [error_weights(2), weights(2)], erred, mean)
    call keep_piece(scene, equations, solution, diagonal*dt, kept%element_force, whole)
    call content_error_of_path(scene, equations, solution, dt, 2*diagonal, piece, whole, first%du, outcome%du, heat, &
                               outcome%heat%phases)
    call add_passed(scene, equations, weights(2), passed)
    call take_passed(scene, equations, passed, kept%element_force)
    call external_forces(scene, equations%dofs, solution%time + dt, external)
    kept%force = merge(external + diagonal*(kept%force + left - external), kept%force, equations%solves(equations%now)%is_own)
    call estimate_error(scene, equations, solution, dt, (matmul(g, error_weights) + heat/dt)/diagonal, &
                        in_sum(erred, mean)/diagonal, g(:, 2), .true., whole, outcome)
    outcome%heat%mean = weight*first%du + diagonal*outcome%du
    call return_to(kept, equations)
  end subroutine solve_two_stages

  !> Add the element forces of what brings heat in, of the present solve.
  pure subroutine add_passed(scene, equations, share, passed)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: share
    real(wp), intent(inout) :: passed(:)   !! [power]
    integer :: k, m, n

    do k = 1, size(equations%dofs%groups)
      if (.not. (equations%solves(equations%now)%active(k) .and. passes(scene%groups(k)%role, equations%is_load(k)))) cycle
      m = equations%solves(1)%pattern%force_start(k)
      n = size(equations%dofs%groups(k)%dof)
      passed(m + 1:m + n) = passed(m + 1:m + n) + share*equations%buffers%force(m + 1:m + n)
    end do
  end subroutine add_passed

  !> Heat comes in by the group: a load, or heat through a contact.
  elemental function passes(role, is_load) result(yes)
    integer, intent(in) :: role
    logical, intent(in) :: is_load
    logical :: yes

    yes = is_load .or. role == role_heat_contact
  end function passes

  !> Put them where the element forces are.
  pure subroutine take_passed(scene, equations, passed, force)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: passed(:)
    real(wp), intent(inout) :: force(:)
    integer :: k, m, n

    do k = 1, size(equations%dofs%groups)
      if (.not. (equations%solves(equations%now)%active(k) .and. passes(scene%groups(k)%role, equations%is_load(k)))) cycle
      m = equations%solves(1)%pattern%force_start(k)
      n = size(equations%dofs%groups(k)%dof)
      force(m + 1:m + n) = passed(m + 1:m + n)
    end do
  end subroutine take_passed

  !> By the error the step is accepted or must be shortened, and the next may be so much longer.
  subroutine judge(scene, solution, dt, outcome)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(inout) :: outcome
    real(wp) :: factor, order
    logical :: two_stages

    if (.not. (outcome%heat%estimated .and. scene%strategy%time_tolerance > 0)) return
    two_stages = in_two_stages(scene, solution, outcome)
    order = merge(2.0_wp, 1.0_wp, two_stages)
    factor = huge(factor)
    if (outcome%heat%error > 0) factor = safety*(scene%strategy%time_tolerance/outcome%heat%error)**(1/(order + 1))
    if (outcome%heat%error <= scene%strategy%time_tolerance) then
      ! the error of a first step by implicit Euler says nothing about TR-BDF2
      if (two_stages .or. scene%strategy%scheme /= scheme_tr_bdf2) outcome%heat%growth = factor
    else if (dt > scene%strategy%least_step) then
      outcome%converged = .false.
      outcome%event = max(factor, least_factor)
      outcome%event_reason = 'error in time '//to_text(outcome%heat%error, 3)//' above ' &
                             //to_text(scene%strategy%time_tolerance, 3)
      outcome%heat%too_long = .true.
    else
      outcome%heat%above = .true.
      outcome%heat%growth = 1
    end if
  end subroutine judge

  !> The step was one of TR-BDF2.
  pure function in_two_stages(scene, solution, outcome) result(yes)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution   !! at its start
    type(outcome_t), intent(in) :: outcome
    logical :: yes

    yes = scene%strategy%scheme == scheme_tr_bdf2 .and. solution%last_step > 0 .and. .not. outcome%heat%fell_back
  end function in_two_stages

  !> Iterations of an earlier stage, or of an attempt that was dropped, count too.
  subroutine add_iterations(earlier, outcome)
    type(outcome_t), intent(in) :: earlier
    type(outcome_t), intent(inout) :: outcome

    outcome%history = [earlier%history, outcome%history]
    outcome%iterations = outcome%iterations + earlier%iterations
    outcome%first_iterations = max(outcome%first_iterations, earlier%first_iterations)
    outcome%linear_residual = max(outcome%linear_residual, earlier%linear_residual)
  end subroutine add_iterations

  !> Forces and sums of the evaluation before, to be returned to after others.
  subroutine keep_evaluation(equations, kept)
    type(equations_t), intent(in) :: equations
    type(evaluation_t), intent(out) :: kept

    kept = evaluation_t(equations%force, equations%magnitude, equations%buffers%force, equations%heat_stored, &
                        equations%heat_released, equations%source)
  end subroutine keep_evaluation

  !> They are those of the evaluation that was kept.
  subroutine return_to(kept, equations)
    type(evaluation_t), intent(in) :: kept
    type(equations_t), intent(inout) :: equations

    equations%force = kept%force
    equations%magnitude = kept%magnitude
    equations%buffers%force = kept%element_force
    equations%heat_stored = kept%heat_stored
    equations%heat_released = kept%heat_released
    equations%source = kept%source
  end subroutine return_to

end module heat_stages
