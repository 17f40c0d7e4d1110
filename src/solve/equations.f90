!> The discrete equations of a scene: unknowns, pattern, element loop, linear solver.
module equations
  use contact_flow, only: bodies_t, find_bodies
  use contact_point, only: at_piece
  use dies, only: is_deformable, place_on_nodes
  use dofs, only: dofs_t, number_dofs, number_pairs
  use elem_api, only: block_done, elem_t, instant_t, report_t
  use elem_registry, only: list_elems
  use element_loop, only: element_buffers_t, gather_forces, gather_matrix, run_elements
  use errors, only: error_t
  use kinds, only: eps, wp
  use kinematics_api, only: kinematics_t
  use kinematics_registry, only: list_kinematics
  use law_api, only: law_t, solid_law
  use law_registry, only: list_laws
  use linear_solver, only: analyse, factorise, linear_solver_t, solve_linear
  use loads, only: multiplier_at
  use ordering, only: order_equations
  use pairs, only: pairs_differ, pairs_t, start_pairs
  use scene, only: scene_t
  use sections, only: section_forced
  use solution, only: solution_t
  use sparsity, only: build_pattern, pattern_t
  use threads, only: fit_to_load, team_t
  use timers, only: ledger_t
  use vectors, only: length_of
  implicit none
  private
  public :: equations_t, set_up, evaluate, solve_correction, external_forces

  type :: equations_t
    type(elem_t), allocatable :: elems(:)
    type(law_t), allocatable :: laws(:)
    type(kinematics_t) :: kinematics
    type(dofs_t) :: dofs
    type(pattern_t) :: pattern
    type(element_buffers_t) :: buffers
    type(linear_solver_t) :: solver
    type(ledger_t) :: timers
    type(team_t) :: team
    !> Internal force (element forces summed) at the last evaluation, and the sum of their sizes (ndof).
    real(wp), allocatable :: force(:), magnitude(:)
    real(wp), allocatable :: values(:)
    !> Nodes of the solid elements, and the pairs that unknowns and pattern are of.
    integer, allocatable :: solids(:, :)
    type(pairs_t), allocatable :: pairs(:)
    !> Nodes coupled by the pairs: a side and a piece, two nodes twice to make eight.
    integer, allocatable :: links(:, :)
    !> The solver knows the pattern.
    logical :: analysed = .false.
    !> Groups that are loads: their forces come from outside.
    logical, allocatable :: is_load(:)
    !> Bodies behind the sides of contacts.
    type(bodies_t), allocatable :: bodies(:)
    !> Diagonal of the box around the mesh [length].
    real(wp) :: size = 0.0_wp
  end type equations_t

  !> Motions below this share of the mesh's size are round-off of coordinates: some eps.
  real(wp), parameter :: round_off_motion = 16*eps

contains

  !> Number the unknowns, build and order the pattern, analyse it: once per mesh, and again for new pairs.
  subroutine set_up(scene, equations, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(error_t), allocatable, intent(out) :: error
    type(kinematics_t), allocatable :: rows(:)
    integer :: g, timer

    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    call list_elems(equations%elems)
    call list_laws(equations%laws)
    call list_kinematics(rows)
    equations%kinematics = rows(scene%kinematics_id)
    call number_dofs(scene, equations%elems, equations%dofs)
    call build_pattern(equations%dofs, is_symmetric(scene, equations), equations%pattern)
    allocate (equations%force(equations%dofs%ndof), equations%magnitude(equations%dofs%ndof))
    allocate (equations%values(equations%pattern%nnz))
    call start_pairs(scene, equations%pairs)
    allocate (equations%buffers%force(equations%pattern%force_length), equations%buffers%matrix(equations%pattern%matrix_length))
    equations%size = length_of(maxval(scene%mesh%coordinates, 2) - minval(scene%mesh%coordinates, 2))

    call find_bodies(scene, equations%elems, equations%laws, equations%bodies)
    allocate (equations%is_load(size(scene%groups)))
    do g = 1, size(scene%groups)
      equations%is_load(g) = equations%elems(scene%groups(g)%elem_id)%law_kind == 0
    end do

    allocate (equations%solids(8, 0), equations%links(8, 0))
    do g = 1, size(scene%groups)
      if (equations%elems(scene%groups(g)%elem_id)%law_kind /= solid_law) cycle
      equations%solids = reshape([equations%solids, scene%groups(g)%connectivity], &
                                 [8, size(equations%solids, 2) + size(scene%groups(g)%connectivity, 2)])
    end do
    call equations%timers%stop(timer)
    call analyse_pattern(equations, error)
  end subroutine set_up

  !> Order the equations of the present pattern and let the solver analyse it.
  subroutine analyse_pattern(equations, error)
    type(equations_t), intent(inout) :: equations
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: position(:)
    integer :: timer

    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    call order_equations(reshape([equations%solids, equations%links], &
                                 [8, size(equations%solids, 2) + size(equations%links, 2)]), equations%dofs, position, error)
    if (.not. allocated(error) .and. equations%dofs%neq > 0) then
      call analyse(equations%solver, equations%pattern, position, error)
    end if
    equations%analysed = .true.
    call equations%timers%stop(timer)
  end subroutine analyse_pattern

  !> Sides and pieces of the pairs, for the graph that is ordered.
  pure subroutine list_links(scene, equations)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    integer, allocatable :: links(:, :)
    integer :: g, e, k, n

    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs > 0) n = n + size(equations%dofs%groups(g)%nodes)/3
    end do
    allocate (links(8, n))
    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0) cycle
      associate (nodes => equations%dofs%groups(g)%nodes)
        do e = 1, size(nodes, 2)
          do k = 3, size(nodes, 1) - 3, 3
            if (nodes(k + 1, e) == nodes(1, e)) cycle
            n = n + 1
            links(:, n) = nodes([1, 2, 3, k + 1, k + 2, k + 3, 1, k + 1], e)
          end do
        end do
      end associate
    end do
    equations%links = links(:, :n)
  end subroutine list_links

  !> Unknowns and pattern for other pairs; the solver gets to know them before the next factorisation.
  subroutine pair_up(scene, pairs, equations)
    type(scene_t), intent(in) :: scene
    type(pairs_t), intent(in) :: pairs(:)
    type(equations_t), intent(inout) :: equations
    integer :: timer

    if (.not. pairs_differ(pairs, equations%pairs)) return
    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    equations%pairs = pairs
    call number_pairs(scene, pairs, equations%dofs)
    call build_pattern(equations%dofs, is_symmetric(scene, equations), equations%pattern)
    call list_links(scene, equations)
    deallocate (equations%values)
    allocate (equations%values(equations%pattern%nnz))
    equations%analysed = .false.
    call equations%timers%stop(timer)
  end subroutine pair_up

  !> Pairs around the feet just found; points without a foot keep theirs.
  pure subroutine renew_pairs(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0) cycle
      associate (middle => solution%pairs(scene%groups(g)%pairs)%piece, found => nint(solution%groups(g)%trial(at_piece, :, :)))
        where (found > 0) middle = found
      end associate
    end do
  end subroutine renew_pairs

  !> Everything the scene calls for is symmetric.
  pure function is_symmetric(scene, equations) result(symmetric)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: symmetric
    integer :: g

    symmetric = .true.
    do g = 1, size(scene%groups)
      associate (row => equations%elems(scene%groups(g)%elem_id), m => scene%groups(g)%material)
        symmetric = symmetric .and. (row%symmetric .or. .not. (row%follows .or. scene%finite))
        if (m == 0) cycle
        symmetric = symmetric .and. equations%laws(scene%materials(m)%law_id)%symmetric
        if (row%law_kind == solid_law) symmetric = symmetric .and. equations%kinematics%symmetric
      end associate
    end do
  end function is_symmetric

  !> The instant at the end of a step.
  subroutine make_instant(scene, equations, solution, dt, du, tangent, instant)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt, du(:)
    logical, intent(in) :: tangent
    type(instant_t), intent(out) :: instant
    real(wp), allocatable :: coordinates(:, :)
    integer :: k, c

    instant%time = solution%time + dt
    instant%dt = dt
    instant%tangent = tangent
    instant%pilots = solution%pilots
    instant%section = solution%section
    allocate (instant%multipliers(size(scene%multipliers)), instant%multipliers_before(size(scene%multipliers)))
    do k = 1, size(scene%multipliers)
      instant%multipliers_before(k) = multiplier_at(scene%multipliers(k), solution%time)
      instant%multipliers(k) = multiplier_at(scene%multipliers(k), instant%time)
    end do
    if (size(solution%pairs) == 0) return
    coordinates = scene%mesh%coordinates + solution%displacement
    do k = 1, size(coordinates, 2)
      do c = 1, 2
        if (equations%dofs%node(c, k) > 0) coordinates(c, k) = coordinates(c, k) + du(equations%dofs%node(c, k))
      end do
    end do
    allocate (instant%dies, source=scene%dies)
    do k = 1, size(instant%dies)
      if (is_deformable(instant%dies(k))) call place_on_nodes(coordinates, instant%dies(k))
    end do
  end subroutine make_instant

  !> Internal force, and matrices when wanted, at the motion `du` of the step. Points that meet pieces of deformable dies
  !> beyond their pairs get new ones, and all is computed again: no contact is lost, no step cut.
  subroutine evaluate(scene, equations, solution, dt, du, tangent, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt, du(:)
    logical, intent(in) :: tangent
    type(report_t), intent(out) :: report
    type(instant_t) :: instant
    integer :: timer

    call fit_to_load(equations%team)
    call make_instant(scene, equations, solution, dt, du, tangent, instant)
    do
      call pair_up(scene, solution%pairs, equations)
      instant%pairs = solution%pairs
      call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, equations%pattern, &
                        instant, du, solution, equations%buffers, equations%timers, report)
      if (report%status /= block_done) return
      if (.not. report%unpaired) exit
      call renew_pairs(scene, solution)
    end do
    call equations%timers%add('assembly', timer)
    call equations%timers%start(timer)
    call gather_forces(equations%pattern, equations%buffers, equations%force, equations%magnitude)
    if (tangent) then
      call gather_matrix(equations%pattern, equations%buffers, equations%values)
      if (.not. solution%force_floor > 0) call set_floor(scene, equations, solution%force_floor)
    end if
    call equations%timers%stop(timer)
  end subroutine evaluate

  !> Size of round-off in forces: what a motion of round-off makes through the diagonals of the solid elements' matrices.
  pure subroutine set_floor(scene, equations, force_floor)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(out) :: force_floor
    integer :: g, e, i, ndof, m
    real(wp) :: sum

    sum = 0
    do g = 1, size(scene%groups)
      if (equations%elems(scene%groups(g)%elem_id)%law_kind /= solid_law) cycle
      ndof = size(equations%dofs%groups(g)%dof, 1)
      do e = 1, size(equations%dofs%groups(g)%dof, 2)
        m = equations%pattern%matrix_start(g) + (e - 1)*ndof*ndof
        do i = 1, ndof
          sum = sum + equations%buffers%matrix(m + (i - 1)*ndof + i)**2
        end do
      end do
    end do
    force_floor = round_off_motion*equations%size*sqrt(sum)
  end subroutine set_floor

  !> Forces on nodes and pilots, and loads of the section, at a time (ndof).
  pure subroutine external_forces(scene, dofs, time, force)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: time
    real(wp), intent(out) :: force(:)
    integer :: k, d

    force = 0
    do k = 1, size(scene%forces)
      associate (load => scene%forces(k))
        d = dofs%node(load%component, load%node)
        force(d) = force(d) + load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
      end associate
    end do
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        d = dofs%pilot(load%component, load%die)
        if (d == 0 .or. load%multiplier == 0) cycle
        force(d) = load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
      end associate
    end do
    do k = 1, 3
      if (dofs%section(k) == 0) cycle
      associate (drive => scene%section_drives(k))
        if (drive%kind /= section_forced .or. drive%multiplier == 0) cycle
        force(dofs%section(k)) = drive%amplitude*multiplier_at(scene%multipliers(drive%multiplier), time)
      end associate
    end do
  end subroutine external_forces

  !> Correction of the free unknowns for a residual (ndof); prescribed ones are not touched.
  subroutine solve_correction(equations, residual, correction, error)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: residual(:)
    real(wp), intent(out) :: correction(:)
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: rhs(equations%dofs%neq), x(equations%dofs%neq)
    integer :: d, timer

    correction = 0
    if (equations%dofs%neq == 0) return
    if (.not. equations%analysed) call analyse_pattern(equations, error)
    if (allocated(error)) return
    do d = 1, equations%dofs%ndof
      if (equations%dofs%equation(d) > 0) rhs(equations%dofs%equation(d)) = residual(d)
    end do
    call equations%timers%add('factorisation', timer)
    call equations%timers%start(timer)
    call factorise(equations%solver, equations%values, error)
    call equations%timers%stop(timer)
    if (allocated(error)) return
    call equations%timers%add('solution', timer)
    call equations%timers%start(timer)
    call solve_linear(equations%solver, equations%pattern, rhs, x, error)
    call equations%timers%stop(timer)
    do d = 1, equations%dofs%ndof
      if (equations%dofs%equation(d) > 0) correction(d) = x(equations%dofs%equation(d))
    end do
  end subroutine solve_correction

end module equations
