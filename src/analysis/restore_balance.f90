!> Equilibrium on a new mesh, at fixed time and fixed dies.
!>
!> State that was carried over does not balance exactly. Newton's method removes the residual; where it does not manage at
!> once, in parts: a share of the first residual is left as a force from outside, and taken away half by half. What this takes, and
!> what it changes, is published and judged (chapter 12 of the thesis).
!>
!> In no time nothing flows: the laws answer elastically. If they flowed, whatever is corrected could only unload where
!> everything flows, and the dies would lose force (2 to 15 % in an upsetting on a mesh that has folded). What this leaves outside
!> the yield surface the first step of the march returns, while the dies move on.
module restore_balance
  use accept_step, only: accept_balance
  use bookkeeping, only: pressed_on
  use elem_api, only: report_t, totals_t
  use equations, only: equations_t, evaluate, external_forces
  use kinds, only: wp
  use newton, only: outcome_t, solve_step
  use errors, only: error_t, exit_no_convergence, fail
  use scene, only: scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use system, only: wall_seconds
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: balance_t, restore_equilibrium, refuse_remesh, force_change

  !> What the restart tells of the remesh.
  type :: balance_t
    logical :: restored = .false.
    !> The remesh is refused, by the fault of this stage.
    logical :: refused = .false.
    character(len=:), allocatable :: stage
    !> First residual over the forces at work, iterations in all, parts it took.
    real(wp) :: first_residual = 0.0_wp
    integer :: iterations = 0, parts = 0
    !> Largest motion of a node over the size of the mesh.
    real(wp) :: motion = 0.0_wp
    !> Volume, elastic energy and plastic work before and after.
    type(totals_t) :: before, after
    !> Force on each pilot before (as the old mesh had it) and after (3, ndie).
    real(wp), allocatable :: pilot_before(:, :), pilot_after(:, :)
    !> What presses on each die made of sides, sizes added up (ndie).
    real(wp), allocatable :: pressed(:)
    character(len=:), allocatable :: reason
    !> Seconds on the wall.
    real(wp) :: wall = 0.0_wp
  end type balance_t

  !> Parts smaller than this are not tried.
  real(wp), parameter :: smallest_part = 1.0_wp/64
  !> A first residual above this share of the forces comes of contact that does not fit: stress alone does not carry that.
  real(wp), parameter :: large_residual = 0.5_wp

contains

  !> Restore equilibrium. When it is not `restored`, the solution stands where the last part left it.
  subroutine restore_equilibrium(scene, equations, solution, balance, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    type(balance_t), intent(inout) :: balance   !! `before` is known
    type(outcome_t), intent(out) :: outcome
    real(wp), dimension(equations%dofs%ndof) :: external, rest
    real(wp) :: left, part, started
    type(report_t) :: report
    integer :: k

    started = wall_seconds()
    allocate (balance%pilot_before, source=solution%pilot_applied)
    rest = 0
    call external_forces(scene, equations%dofs, solution%time, external)
    call evaluate(scene, equations, solution, 0.0_wp, rest, .false., report)
    call keep_pressures(scene, solution)
    call evaluate(scene, equations, solution, 0.0_wp, rest, .false., report)
    rest = external - equations%force
    where (equations%dofs%equation == 0) rest = 0
    left = 1
    part = 1
    do while (left > 0)
      call solve_step(scene, equations, solution, 0.0_wp, outcome, (left - part)*rest)
      if (allocated(outcome%error)) return
      if (balance%parts == 0 .and. balance%iterations == 0 .and. size(outcome%history) > 0) &
        balance%first_residual = outcome%history(1)%force_norm
      balance%iterations = balance%iterations + outcome%iterations
      if (outcome%converged) then
        call accept_balance(scene, equations, outcome, solution, balance%after, outcome%error)
        if (allocated(outcome%error)) return
        balance%parts = balance%parts + 1
        left = left - part
        part = min(2*part, left)
      else
        part = 0.5_wp*part
        if (part < smallest_part) exit
      end if
    end do
    balance%restored = .not. left > 0
    if (allocated(outcome%reason)) balance%reason = outcome%reason
    balance%motion = maxval(abs(solution%displacement))/equations%size
    allocate (balance%pilot_after, source=solution%pilot_applied)
    allocate (balance%pressed(size(scene%dies)))
    do k = 1, size(balance%pressed)
      balance%pressed(k) = pressed_on(scene, equations, k)
    end do
    if (balance%restored) solution%unbalanced = .false.
    balance%wall = wall_seconds() - started
  end subroutine restore_equilibrium

  !> The penalty of contact goes with the length of sides: at the depth that was kept, sides of another length bear another
  !> pressure. The multiplier takes the difference, so that every closed point begins with the pressure that was carried.
  subroutine keep_pressures(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer :: g, pressure, multiplier, status

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        pressure = group%variables(find_variable(group%variables, 'pressure'))%first
        multiplier = group%variables(find_variable(group%variables, 'augmentation'))%first
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        where (nint(state%committed(status, :, :)) > 0)
          state%committed(multiplier, :, :) = state%committed(multiplier, :, :) + state%committed(pressure, :, :) &
                                              - state%trial(pressure, :, :)
        end where
      end associate
    end do
  end subroutine keep_pressures

  !> Change of the force of a die over the largest force on any, or what presses on one: the worst.
  pure function force_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change
    real(wp) :: largest
    integer :: k

    change = 0
    largest = maxval([0.0_wp, balance%pressed])
    do k = 1, size(balance%pilot_before, 2)
      largest = max(largest, length_of(balance%pilot_before(1:2, k)))
      change = max(change, length_of(balance%pilot_after(1:2, k) - balance%pilot_before(1:2, k)))
    end do
    if (largest > 0) change = change/largest
  end function force_change

  !> Chapter 12: slow convergence at the start tells that a remesh went wrong. Over a limit it is refused, with the stage to blame.
  subroutine refuse_remesh(scene, solution, balance, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(balance_t), intent(inout) :: balance
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: what

    what = ''
    if (.not. balance%restored) then
      what = 'equilibrium is not restored'
      if (allocated(balance%reason)) what = what//' ('//balance%reason//')'
      balance%stage = trim(merge('contact ', 'transfer', size(scene%dies) > 0 .and. balance%first_residual > large_residual))
    else if (balance%iterations > scene%remesher%most_iterations) then
      what = to_text(balance%iterations)//' iterations to equilibrium, at most '//to_text(scene%remesher%most_iterations)
      balance%stage = 'transfer'
    else if (force_change(balance) > scene%remesher%force_change) then
      what = 'the force of a die changes by '//to_text(100*force_change(balance), 3)//' %, at most ' &
             //to_text(100*scene%remesher%force_change, 3)//' %'
      balance%stage = 'contact'
    end if
    balance%refused = len(what) > 0
    if (balance%refused) call fail(error, exit_no_convergence, 'mesh '//to_text(scene%generation)//' refused at step ' &
                                   //to_text(solution%step)//': '//what//'; stage to blame: '//balance%stage, &
                                   'remesh again from the checkpoint of the old mesh with another transfer or finer elements')
  end subroutine refuse_remesh

end module restore_balance
