!> Equilibrium on a new mesh, at fixed time and fixed dies.
!>
!> State that was carried over does not balance exactly. Newton's method removes the residual; where it fails to
!> do so at once, in parts: a share of the first residual is left as an external force, and halved again and again. The iterations
!> this takes, and what it changes, are reported and judged (chapter 12 of the thesis).
!>
!> In zero time nothing flows: the laws respond elastically. If they flowed, whatever is corrected could only unload where
!> everything flows, and the dies would lose force (2 to 15 % in an upsetting on a mesh that has folded). What this leaves outside
!> the yield surface the first step of the march returns, while the dies move on.
module restore_balance
  use accept_step, only: accept_balance
  use bookkeeping, only: pressed_on
  use contact_penalties, only: allowed_penetration
  use dies, only: is_deformable
  use elem_api, only: block_done, mode_advance, mode_restore, report_t, totals_t
  use energy_books, only: external_on_unknowns
  use energy_round_off, only: energy_of_round_off
  use equations, only: equations_t, take_turn
  use evaluation, only: evaluate
  use external_loads, only: external_forces
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use own_contact, only: met_by_itself
  use path_record, only: settle_path
  use quadrature, only: is_control_point, rule_along
  use residual_distance, only: relative_distance, work_of_correction
  use residual_parts, only: first_parts, next_part, residual_parts_t
  use residual_place, only: least_shape, place_residual, residual_place_t
  use scene, only: scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use step_equilibrium, only: solve_step
  use step_outcome, only: outcome_t
  use system, only: wall_seconds
  use vectors, only: length_of
  implicit none
  private
  public :: balance_t, depth_change, forces_on_dies, keep_balance, restore_equilibrium

  !> What the restart reports about the remesh.
  type :: balance_t
    logical :: restored = .false.
    !> The remesh is refused; this stage is responsible.
    logical :: refused = .false.
    character(len=:), allocatable :: stage
    !> It is taken up although the force of a die changes: other new meshes agree on the force.
    logical :: agreed = .false.
    !> The first residual: by the energy of its linear correction, and where it acts.
    real(wp) :: first_residual = 0.0_wp
    type(residual_place_t) :: place
    !> Least scaled Jacobian of an element of the mesh.
    real(wp) :: shape = 1.0_wp
    !> Iterations before pressures were augmented: the difficulty of finding equilibrium; iterations in all, and parts it took.
    integer :: iterations = 0, iterations_in_all = 0, parts = 0
    !> Largest force on a die in the run so far [force].
    real(wp) :: largest_force = 0.0_wp
    !> Error of the stress on the old mesh.
    real(wp) :: old_error = 0.0_wp
    !> Share of the load that the nodes in contact have left open there (bearing_nodes).
    real(wp) :: open_share = 0.0_wp
    !> Largest motion of a node over the size of the mesh.
    real(wp) :: motion = 0.0_wp
    !> Volume, elastic energy and plastic work before and after.
    type(totals_t) :: before, after
    !> Energy below which stresses are round-off: a body without stress is none the worse for it.
    real(wp) :: round_off = 0.0_wp
    !> Force on each pilot before (as the old mesh had it), by the pressures that were carried, and after (3, ndie); none on
    !> a die that is its own body's (forces_on_dies).
    real(wp), allocatable :: pilot_before(:, :), pilot_carried(:, :), pilot_after(:, :)
    !> What presses on each die made of sides, sizes added up (ndie).
    real(wp), allocatable :: pressed(:)
    !> Change of the depth in a die, in the mean of its pressures, over the penetration allowed and a thousandth of the side.
    real(wp) :: depth_change = 0.0_wp
    !> Why Newton's method failed; not allocated where it did not.
    character(len=:), allocatable :: reason
    !> Seconds on the wall.
    real(wp) :: wall = 0.0_wp
  end type balance_t

  !> Parts smaller than this are not tried.
  real(wp), parameter :: smallest_part = 1.0_wp/64
  !> Share of its length by which a side may miss a curved contour: a parabola misses an arc that turns by t by (t/2)**3/192 of its
  !> length (fourth term of the series), so this is an arc of 66 degrees.
  real(wp), parameter :: missed_by_parabola = 1.0e-3_wp
  !> A point counts as no further off than this many times what is allowed: one at a sharp corner of a die, from which the new
  !> contour leads elsewhere, says nothing of the rest (found: three points with a sixth of the force, off by 3 to 14). So a
  !> third of the force must lie off for a mesh to be refused by it; pressures that are lost change the force of the die (FORCE).
  real(wp), parameter :: most_off = 3.0_wp
  !> Dies count as if they bore this share of what the largest one does, at least (found: a front of a flash that comes to a plane
  !> with one node, and a four-thousandth of the force).
  real(wp), parameter :: small_die = 0.05_wp

contains

  !> A scene without motion is in equilibrium on any mesh.
  subroutine keep_balance(scene, solution, balance)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(balance_t), intent(inout) :: balance   !! `before` is known

    solution%unbalanced = .false.
    balance%restored = .true.
    balance%after = balance%before
    balance%shape = least_shape(scene, scene%mesh%coordinates)
    balance%pilot_before = forces_on_dies(scene, solution)
    allocate (balance%pilot_carried, source=balance%pilot_before)
    allocate (balance%pilot_after, source=balance%pilot_before)
    allocate (balance%pressed(size(scene%dies)), source=0.0_wp)
  end subroutine keep_balance

  !> Restore equilibrium. When it is not `restored`, the solution is that of the last part.
  subroutine restore_equilibrium(scene, equations, solution, balance, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    type(balance_t), intent(inout) :: balance   !! `before` is known
    type(outcome_t), intent(out) :: outcome
    real(wp), dimension(equations%dofs%ndof) :: external, rest
    type(residual_parts_t) :: parts
    real(wp) :: started, work
    type(report_t) :: report
    integer :: k

    started = wall_seconds()
    equations%mode = mode_restore
    call take_turn(equations, displacement_field)
    balance%pilot_before = forces_on_dies(scene, solution)
    ! until a part is in equilibrium the state is what was carried
    balance%after = balance%before
    balance%shape = least_shape(scene, scene%mesh%coordinates)
    rest = 0
    call external_forces(scene, equations%dofs, solution%time, external)
    ! what was carried is judged by what the points of contact have; a new side that spans a bend otherwise than the old ones did
    ! (contact_between) is pushed out of the die as equilibrium is restored
    call evaluate(scene, equations, solution, 0.0_wp, rest, .false., report, points_alone=.true.)
    balance%depth_change = depth_change(scene, solution)
    call keep_pressures(scene, solution)
    call evaluate(scene, equations, solution, 0.0_wp, rest, .true., report, points_alone=.true.)
    balance%pilot_carried = forces_on_dies(scene, solution)
    if (report%status == block_done) call book_carried(scene, equations, balance%pilot_carried)
    call find_rest()
    call place_residual(scene, equations%dofs, external, equations%magnitude, rest, balance%place)
    call work_of_correction(scene, equations, rest, work)
    balance%round_off = energy_of_round_off(scene, equations, solution, balance%before%volume)
    if (any(scene%groups%rule%family == rule_along)) then
      rest = 0
      call evaluate(scene, equations, solution, 0.0_wp, rest, .false., report)
      call find_rest()
    end if
    parts = first_parts(1.0_wp, smallest_part)
    do while (parts%goes_on)
      call solve_step(scene, equations, solution, 0.0_wp, outcome, (parts%left - parts%part)*rest)
      if (allocated(outcome%error)) return
      balance%iterations_in_all = balance%iterations_in_all + outcome%iterations
      balance%iterations = balance%iterations + merge(outcome%first_iterations, outcome%iterations, &
                                                      outcome%augmentations > 0 .or. outcome%converged)
      if (outcome%converged) then
        call accept_balance(scene, equations, outcome, solution, balance%after, outcome%error)
        if (allocated(outcome%error)) return
      end if
      call next_part(parts, outcome%converged)
      balance%parts = parts%number
    end do
    balance%restored = .not. parts%left > 0
    balance%largest_force = solution%largest_force
    balance%old_error = solution%estimate%previous_stress
    balance%open_share = solution%estimate%previous_open
    balance%first_residual = relative_distance(work, max(balance%before%elastic_energy, balance%after%elastic_energy, &
                                                         balance%round_off))
    if (allocated(outcome%reason)) balance%reason = outcome%reason
    balance%motion = maxval(abs(solution%fields(displacement_field)%value))/equations%size
    balance%pilot_after = forces_on_dies(scene, solution)
    allocate (balance%pressed(size(scene%dies)))
    do k = 1, size(balance%pressed)
      balance%pressed(k) = pressed_on(scene, equations, k)
    end do
    ! what is left is found by the first step, as it finds what moves with the dies
    solution%unbalanced = .false.
    call settle_path(solution%path)
    equations%mode = mode_advance
    balance%wall = wall_seconds() - started

  contains

    !> What is out of balance at the motion evaluated last.
    subroutine find_rest()
      rest = external - equations%force
      where (equations%solves(equations%now)%equation == 0) rest = 0
    end subroutine find_rest

  end subroutine restore_equilibrium

  !> The penalty of contact goes with the length of sides: at the depth that was kept, sides of another length carry another
  !> pressure. The multiplier takes the difference, so that every point begins with the pressure that was carried, be it closed or
  !> one that lies between closed and open ones of the old mesh. So does a node on the axis, whose state is that of a corner.
  subroutine keep_pressures(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer :: g, pressure, multiplier, status, place

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        pressure = group%variables(find_variable(group%variables, 'pressure'))%first
        multiplier = group%variables(find_variable(group%variables, 'augmentation'))%first
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        where (nint(state%committed(status, :, :)) > 0 .or. state%committed(pressure, :, :) > 0)
          state%committed(multiplier, :, :) = state%committed(multiplier, :, :) + state%committed(pressure, :, :) &
                                              - state%trial(pressure, :, :)
        end where
        place = find_variable(group%variables, 'corner_place')
        if (place == 0 .or. group%pairs > 0) cycle
        place = group%variables(place)%first
        pressure = group%variables(find_variable(group%variables, 'corner_pressure'))%first
        multiplier = group%variables(find_variable(group%variables, 'corner_augmentation'))%first
        where (abs(state%committed(place, :, :)) >= 1 .and. state%committed(pressure, :, :) > 0)
          state%committed(multiplier, :, :) = state%committed(multiplier, :, :) + state%committed(pressure, :, :) &
                                              - state%trial(pressure, :, :)
        end where
      end associate
    end do
  end subroutine keep_pressures

  !> Force and moment on all pilots. What a body does to itself in a fold is no load of a die: toward the ground of the fold, where
  !> its two flanks share a node, they press on each other as much as they like, for the arm of this is nothing. (Found: two flanks
  !> at 10 degrees, six points with 160 times the yield stress, a sum of .12 to .7 of the force of the punch and back within ten
  !> steps; new meshes changed it by .2 of that force, and the force of the punch by .0006.)
  pure function forces_on_dies(scene, solution) result(forces)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), allocatable :: forces(:, :)   !! (3, ndie) [force], [force*length]
    integer :: k

    allocate (forces, source=solution%fields(pilot_field)%applied)
    do k = 1, size(scene%dies)
      if (met_by_itself(scene, k)) forces(:, k) = 0
    end do
  end function forces_on_dies

  !> What the carried state does to the pilots of rigid dies, without their springs, as the old mesh had it; those of deformable
  !> dies stay so.
  pure subroutine book_carried(scene, equations, on_pilots)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(inout) :: on_pilots(:, :)   !! (3, ndie) [force]
    real(wp) :: applied(equations%dofs%ndof)
    integer :: k, c

    applied = external_on_unknowns(equations)
    do k = 1, size(on_pilots, 2)
      if (is_deformable(scene%dies(k))) cycle
      do c = 1, 3
        associate (d => equations%dofs%fields(pilot_field)%number(c, k))
          if (d > 0) on_pilots(c, k) = applied(d)
        end associate
      end do
    end do
  end subroutine book_carried

  !> Depth found on the new contour against the depth that was carried, over what contact allows and what a parabola through three
  !> nodes may miss: the mean over the pressures that a die carries, of the die where it is worst. (A single point may be far off
  !> where contact ends: it carries almost nothing. Nor does a die that bears a small share of what the largest one does.)
  pure function depth_change(scene, solution) result(change)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: change
    real(wp), dimension(size(scene%dies)) :: moment, force
    real(wp) :: weight, side, allowed, off
    integer :: g, e, p, depth, pressure, status

    moment = 0
    force = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g), x => scene%mesh%coordinates)
        if (group%die == 0 .or. group%material == 0) cycle
        depth = group%variables(find_variable(group%variables, 'penetration'))%first
        pressure = group%variables(find_variable(group%variables, 'pressure'))%first
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        do e = 1, size(group%connectivity, 2)
          side = length_of(x(:, group%connectivity(3, e)) - x(:, group%connectivity(1, e)))
          allowed = (allowed_penetration(scene%materials(group%material)) + missed_by_parabola)*side
          do p = 1, size(state%committed, 2)
            if (nint(state%committed(status, p, e)) <= 0) cycle
            ! a control point begins with the pressure carried, wherever its side lies
            if (is_control_point(group%rule, p)) cycle
            weight = abs(state%committed(pressure, p, e))*side
            force(group%die) = force(group%die) + weight
            off = abs(state%trial(depth, p, e) - state%committed(depth, p, e))/allowed
            moment(group%die) = moment(group%die) + weight*min(off, most_off)
          end do
        end do
      end associate
    end do
    change = 0
    if (any(force > 0)) change = maxval(moment/max(force, small_die*maxval(force)))
  end function depth_change

end module restore_balance
