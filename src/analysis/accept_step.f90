!> Acceptance of a step: the trial state becomes the state, and every check is made.
module accept_step
  use absolute_cold, only: refuse_absolute_cold
  use bookkeeping, only: book_reactions, book_deformable_dies, measure_scene, book_spurious_mode, pressed_on, sample_contacts
  use confinement, only: note_confinement
  use damping, only: ease_damping, work_of_damping
  use dies, only: is_deformable
  use dofs, only: move_fields
  use driver_values, only: start_drivers
  use elem_api, only: totals_t
  use energy_books, only: book_stored, book_work
  use equations, only: equations_t
  use errors, only: error_t, exit_bug, fail
  use fields, only: field_t, fill_middle_nodes, has_corners_only, pilot_field
  use friction_heat, only: keep_friction_work
  use heat_books, only: book_heat
  use heat_flows, only: book_heat_flows
  use heat_record, only: note_heat_step
  use kinds, only: wp
  use path_record, only: note_path_step
  use phase_books, only: book_fractions
  use resting_bodies, only: work_of_drag
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use space_error, only: follow_space_error
  use spring_check, only: has_body_springs
  use strain_spans, only: follow_spans
  use step_outcome, only: outcome_t
  use text, only: to_text
  use vectors, only: length_of
  use work_books, only: work_t
  implicit none
  private
  public :: accept, accept_balance, dissipation_slack

  !> Dissipated work may fall by this share of the largest work density: round-off of a sum.
  real(wp), parameter :: dissipation_slack = 1.0e-12_wp

contains

  !> Commit the step, add up its work, measure the scene, check it. An error is a bug of the program: exit 6; but
  !> temperatures below absolute zero are one of the deck: exit 3.
  subroutine accept(scene, equations, dt, outcome, solution, totals, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: dt
    type(outcome_t), intent(in) :: outcome
    type(solution_t), intent(inout) :: solution
    type(totals_t), intent(out) :: totals
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: friction_before, given_before, outside_before, elastic_before
    integer :: g

    outside_before = solution%external_work
    elastic_before = solution%work%elastic
    given_before = solution%work%dies + solution%work%supports
    call book_work(equations, outcome%du, solution)
    solution%work%damping = solution%work%damping + work_of_damping(equations, dt, outcome%du)
    solution%work%drag = solution%work%drag + work_of_drag(equations, outcome%du)
    call ease_damping(scene, equations, dt, outcome%du, solution%work%dies + solution%work%supports - given_before, solution)
    call book_reactions(scene, equations, solution%time + dt, solution%fields)
    call book_heat(scene, equations, dt, solution)
    call book_heat_flows(scene, equations, solution)
    call follow_space_error(scene, equations, solution, dt, outcome, error)
    if (allocated(error)) return
    call note_heat_step(outcome%heat, solution%heat)
    if (outcome%shape%known) solution%shape%errors = outcome%shape
    call note_path_step(outcome%path, dt, solution%time + dt, solution%path)
    if (allocated(outcome%heat%phases)) then
      do g = 1, size(solution%groups)
        if (allocated(outcome%heat%phases(g)%value)) solution%groups(g)%error = outcome%heat%phases(g)%value
      end do
    end if
    if (allocated(outcome%path%states)) then
      do g = 1, size(solution%groups)
        if (allocated(outcome%path%states(g)%value)) solution%groups(g)%error = outcome%path%states(g)%value
      end do
    end if
    call move_fields(equations%dofs, outcome%du, solution%fields)
    call fill_middles(scene, solution%fields)
    solution%time = solution%time + dt
    solution%older_step = solution%last_step
    solution%last_step = dt
    solution%step = solution%step + 1
    solution%iterations = solution%iterations + outcome%iterations
    solution%worst_linear_residual = max(solution%worst_linear_residual, outcome%linear_residual)
    solution%stays_unstable = outcome%stays_unstable
    if (outcome%unstable > 0) then
      if (solution%unstable_steps == 0) solution%unstable_from = solution%time
      solution%unstable_steps = solution%unstable_steps + 1
    end if

    call book_deformable_dies(scene, equations, solution, error)
    if (allocated(error)) return
    call measure_scene(scene, equations, solution, totals)
    solution%worst_penetration = max(solution%worst_penetration, totals%max_penetration)
    solution%worst_penetration_ratio = max(solution%worst_penetration_ratio, totals%penetration_ratio)
    solution%least_dissipation = min(solution%least_dissipation, totals%least_dissipation)
    friction_before = solution%friction_work
    solution%friction_work = totals%friction_work
    call book_stored(scene, equations, outcome%du, totals, friction_before, solution)
    call book_spurious_mode(scene, equations, solution)
    call sample_contacts(scene, solution)
    if (scene%remesh%on .or. has_body_springs(scene)) call note_force(scene, equations, solution)
    call keep_friction_work(scene, solution)
    call refuse_absolute_cold(scene, equations%laws, solution, error)
    if (.not. allocated(error)) call check(solution, totals, error)
    if (.not. allocated(error)) call book_fractions(scene, solution, error)
    call commit(scene, equations, solution)
    call follow_spans(scene, equations, solution)
    call note_confinement(scene, equations%laws, solution%work%elastic - elastic_before, solution%external_work - outside_before, &
                          solution)
  end subroutine accept

  !> Changes of forces at a new mesh, and forces of weak springs, are measured by the largest so far: at lift-off those of now are
  !> nothing.
  subroutine note_force(scene, equations, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp) :: force
    integer :: k

    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) then
        force = pressed_on(scene, equations, k)
      else
        force = length_of(solution%fields(pilot_field)%applied(1:2, k))
      end if
      solution%largest_force = max(solution%largest_force, force)
    end do
  end subroutine note_force

  !> Commit an equilibrium restored at fixed time on a new mesh: no work is added, no step counted, and the motion of the step
  !> before stays the one to go on with.
  subroutine accept_balance(scene, equations, outcome, solution, totals, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(outcome_t), intent(in) :: outcome
    type(solution_t), intent(inout) :: solution
    type(totals_t), intent(out) :: totals
    type(error_t), allocatable, intent(out) :: error
    type(field_t) :: before(size(solution%fields))
    type(work_t) :: work
    real(wp) :: external_work
    integer :: f

    external_work = solution%external_work
    work = solution%work
    call book_work(equations, outcome%du, solution)
    solution%external_work = external_work
    solution%work = work
    call book_reactions(scene, equations, solution%time, solution%fields)
    before = solution%fields
    call move_fields(equations%dofs, outcome%du, solution%fields)
    do f = 1, size(before)
      solution%fields(f)%last_increment = before(f)%last_increment
      solution%fields(f)%older_increment = before(f)%older_increment
    end do
    solution%iterations = solution%iterations + outcome%iterations
    call book_deformable_dies(scene, equations, solution, error)
    call measure_scene(scene, equations, solution, totals)
    call commit(scene, equations, solution)
  end subroutine accept_balance

  !> Middle nodes get the values of fields that have none of their own there, and their changes in the step.
  pure subroutine fill_middles(scene, fields)
    type(scene_t), intent(in) :: scene
    type(field_t), intent(inout) :: fields(:)
    integer :: f, g

    do f = 1, size(fields)
      if (.not. (fields(f)%declared .and. has_corners_only(fields(f)))) cycle
      do g = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(g))) cycle
        call fill_middle_nodes(scene%groups(g)%connectivity, fields(f)%value)
        call fill_middle_nodes(scene%groups(g)%connectivity, fields(f)%last_increment)
      end do
    end do
  end subroutine fill_middles

  !> The trial state becomes the state.
  subroutine commit(scene, equations, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    integer :: k

    do k = 1, size(solution%groups)
      solution%groups(k)%committed = solution%groups(k)%trial
    end do
    call start_drivers(scene, equations%laws, solution, equations%drivers)
  end subroutine commit

  !> Invariants of an accepted step.
  subroutine check(solution, totals, error)
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    type(error_t), allocatable, intent(out) :: error
    integer :: g
    real(wp) :: scale

    scale = 0
    do g = 1, size(solution%groups)
      if (size(solution%groups(g)%trial) == 0) cycle
      scale = max(scale, maxval(abs(solution%groups(g)%trial)))
      if (.not. all(abs(solution%groups(g)%trial) <= huge(1.0_wp))) then
        call fail(error, exit_bug, 'step '//to_text(solution%step)//': NaN or infinity in the state of group '//to_text(g))
        return
      end if
    end do
    if (totals%least_dissipation < -dissipation_slack*scale) then
      call fail(error, exit_bug, 'step '//to_text(solution%step)//': dissipated work fell by ' &
                //to_text(-totals%least_dissipation, 3)//' at a point')
    end if
  end subroutine check

end module accept_step
