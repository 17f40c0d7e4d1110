!> Numbering, pattern and analysis of the equations: once per mesh, and again where contact between bodies finds other pairs.
module equation_set_up
  use wall_contact, only: find_wall_sides
  use dof_numbering, only: number_dofs
  use driver_sources, only: find_drivers
  use elem_heat_contact, only: name_of_piece
  use elem_registry, only: list_elems
  use element_dofs, only: number_pairs
  use equations, only: equations_t
  use errors, only: error_t, exit_machine, fail
  use fields, only: displacement_field
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use kinematics_registry, only: list_kinematics
  use law_api, only: has_symmetric_tangent, solid_law
  use law_registry, only: list_laws
  use linear_solver, only: analyse, choose_solver
  use memory_limits, only: require_memory
  use ordering, only: order_equations
  use own_crossings, only: list_free_sides
  use patches, only: map_patches
  use pairs, only: pairs_differ, pairs_t, start_pairs
  use loose_bodies, only: find_loose_bodies
  use scene, only: is_solid, role_load_factor, role_side_load, role_spring, role_volume_load, scene_t
  use solution, only: solution_t
  use solves, only: list_solves, number_equations, quantities_of, set_up_pattern
  use sparsity, only: entries_of
  use state_variables, only: find_variable
  use strategy, only: patch_by_matrix
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: set_up, analyse_pattern, pair_up, refuse_too_large, renew_pairs

  !> Patches of so many elements, where a factorisation takes so many operations or more (some 4500 unknowns): there the billet of
  !> decks/upsetting, whose side folds onto the die, takes half of the seconds; smaller ones gain less, and some lose.
  integer, parameter :: default_patch = 12
  real(wp), parameter :: large_matrix = 5.0e7_wp
  !> Memory that an entry of an element matrix takes at least until the equations are analysed [bytes]: its value, row, column and
  !> place, and its part of the graph that is ordered (34 measured on 1e4 to 5e5 elements).
  real(wp), parameter :: bytes_of_entry = 30.0_wp

contains

  !> Number the unknowns, build and order the pattern, analyse it: once per mesh, and again for new pairs.
  subroutine set_up(scene, equations, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(error_t), allocatable, intent(out) :: error
    type(kinematics_t), allocatable :: rows(:)
    integer :: g, s, timer

    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    call list_elems(equations%elems)
    call list_laws(equations%laws)
    call list_kinematics(rows)
    equations%kinematics = rows(scene%kinematics_id)
    call number_dofs(scene, equations%elems, equations%dofs)
    call refuse_too_large(entries_of(equations%dofs), error)
    if (allocated(error)) return
    call find_wall_sides(scene, equations%laws, equations%dofs, scene%mesh%coordinates, equations%wall)
    call list_free_sides(scene, equations%free_sides)
    call find_loose_bodies(scene, equations%dofs, equations%loose)
    allocate (equations%assembly(size(equations%loose)), source=0)
    allocate (equations%slides(3, size(scene%dies)), source=.false.)
    allocate (equations%seated(size(scene%dies)), source=0.0_wp)
    allocate (equations%way_to_part(2, size(scene%dies)), source=0.0_wp)
    allocate (equations%drag(equations%dofs%ndof), source=0.0_wp)
    call list_solves(scene%fields, scene%strategy%coupling, equations%solves)
    do s = 1, size(equations%solves)
      call choose_solver(equations%solves(s)%solver, scene%strategy%linear_solver)
      call number_equations(equations%dofs, equations%solves(s))
      call set_up_pattern(equations%dofs, is_symmetric(scene, equations, s), equations%solves(s))
    end do
    allocate (equations%force(equations%dofs%ndof), equations%magnitude(equations%dofs%ndof), source=0.0_wp)
    allocate (equations%weight(size(equations%dofs%quantities)), source=1.0_wp)
    call start_pairs(scene, equations%pairs)
    associate (pattern => equations%solves(1)%pattern)
      ! on a new mesh the books ask for the forces of loads before all of them are computed
      allocate (equations%buffers%force(pattern%force_length), source=0.0_wp)
      allocate (equations%buffers%matrix(pattern%matrix_length))
    end associate
    equations%nnode = size(scene%mesh%coordinates, 2)
    equations%size = length_of(maxval(scene%mesh%coordinates, 2) - minval(scene%mesh%coordinates, 2))

    call find_drivers(scene, equations%laws, equations%drivers)
    allocate (equations%is_load(size(scene%groups)))
    do g = 1, size(scene%groups)
      equations%is_load(g) = any(scene%groups(g)%role == [role_side_load, role_volume_load, role_spring, role_load_factor])
    end do

    allocate (equations%solids(8, 0), equations%links(8, 0))
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      equations%solids = reshape([equations%solids, scene%groups(g)%connectivity], &
                                 [8, size(equations%solids, 2) + size(scene%groups(g)%connectivity, 2)])
    end do
    call equations%timers%stop(timer)
    do s = 1, size(equations%solves)
      equations%now = s
      call analyse_pattern(equations, error)
      if (allocated(error)) return
    end do
    equations%now = 1
    equations%patch_size = chosen_patch_size(scene, equations)
    if (equations%patch_size > 0) call map_patches(scene, equations%dofs, equations%patches)
  end subroutine set_up

  !> A mesh whose element matrices have more entries than can be counted, or than there is memory for.
  subroutine refuse_too_large(entries, error)
    real(wp), intent(in) :: entries   !! of all element matrices
    type(error_t), allocatable, intent(out) :: error

    if (entries > huge(1)) then
      call fail(error, exit_machine, 'the mesh is too large: its element matrices have '//to_text(entries, 3) &
                //' entries, at most '//to_text(real(huge(1), wp), 3)//' can be counted', 'use a coarser mesh')
    else
      call require_memory(bytes_of_entry*entries, 'the element matrices and their order', error, address_space=0.0_wp)
    end if
  end subroutine refuse_too_large

  !> Elements at most in a patch: as the deck says, otherwise by the matrix of the motion.
  pure function chosen_patch_size(scene, equations) result(chosen)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer :: chosen
    integer :: s

    chosen = scene%strategy%patch
    if (chosen /= patch_by_matrix) return
    chosen = 0
    do s = 1, size(equations%solves)
      if (equations%solves(s)%own(displacement_field) .and. equations%solves(s)%solver%estimated_flops >= large_matrix) &
        chosen = default_patch
    end do
  end function chosen_patch_size

  !> Order the equations of the present solve and let its solver analyse the pattern.
  subroutine analyse_pattern(equations, error)
    type(equations_t), intent(inout) :: equations
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: position(:)
    integer :: timer

    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    associate (solve => equations%solves(equations%now))
      if (solve%neq > 0) call order_equations(reshape([equations%solids, equations%links], &
                                                      [8, size(equations%solids, 2) + size(equations%links, 2)]), &
                                              equations%nnode, equations%dofs, solve%equation, position, error)
      if (.not. allocated(error) .and. solve%neq > 0) call analyse(solve%solver, solve%pattern, position, error)
      solve%analysed = .true.
    end associate
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
      if (scene%groups(g)%pairs > 0 .and. scene%groups(g)%host == 0) n = n + size(equations%dofs%groups(g)%nodes)/3
    end do
    allocate (links(8, n))
    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. scene%groups(g)%host > 0) cycle
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

  !> Unknowns and pattern for other pairs; the solver analyses them before the next factorisation.
  subroutine pair_up(scene, pairs, equations)
    type(scene_t), intent(in) :: scene
    type(pairs_t), intent(in) :: pairs(:)   !! (npair)
    type(equations_t), intent(inout) :: equations
    integer :: s, timer

    if (.not. pairs_differ(scene, pairs, equations%pairs)) return
    call equations%timers%add('analysis', timer)
    call equations%timers%start(timer)
    equations%pairs = pairs
    call number_pairs(scene, equations%elems, pairs, equations%dofs)
    do s = 1, size(equations%solves)
      call set_up_pattern(equations%dofs, is_symmetric(scene, equations, s), equations%solves(s))
    end do
    associate (pattern => equations%solves(1)%pattern)
      if (size(equations%buffers%force) /= pattern%force_length) deallocate (equations%buffers%force)
      if (size(equations%buffers%matrix) /= pattern%matrix_length) deallocate (equations%buffers%matrix)
      if (.not. allocated(equations%buffers%force)) allocate (equations%buffers%force(pattern%force_length), source=0.0_wp)
      if (.not. allocated(equations%buffers%matrix)) allocate (equations%buffers%matrix(pattern%matrix_length), source=0.0_wp)
    end associate
    call list_links(scene, equations)
    call equations%timers%stop(timer)
  end subroutine pair_up

  !> Pairs around the closest points just found; points without one keep theirs.
  pure subroutine renew_pairs(scene, active, solution)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: active(:)   !! (ngroup) groups that were just computed
    type(solution_t), intent(inout) :: solution
    integer :: g, at

    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. .not. active(g)) cycle
      at = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, name_of_piece))%first
      associate (middle => solution%pairs(scene%groups(g)%pairs)%piece, found => nint(solution%groups(g)%trial(at, :, :)))
        where (found > 0) middle = found
      end associate
    end do
  end subroutine renew_pairs

  !> All that acts in a solve is symmetric.
  pure function is_symmetric(scene, equations, s) result(symmetric)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: s   !! number of the solve
    logical :: symmetric
    integer :: g

    ! the coupling of two quantities is not symmetric
    symmetric = quantities_of(equations%dofs, equations%solves(s)) < 2
    do g = 1, size(scene%groups)
      associate (row => equations%elems(scene%groups(g)%elem_id), m => scene%groups(g)%material)
        if (.not. equations%solves(s)%active(g)) cycle
        ! radiation depends on two temperatures, on each in its way
        symmetric = symmetric .and. .not. scene%groups(g)%heat_contact%radiation > 0
        symmetric = symmetric .and. (row%symmetric .or. .not. (row%follows .or. scene%finite))
        symmetric = symmetric .and. .not. (scene%finite .and. scene%groups(g)%option == row%unsymmetric_option)
        if (m == 0) cycle
        associate (law => equations%laws(scene%materials(m)%law_id))
          symmetric = symmetric .and. has_symmetric_tangent(law, scene%materials(m))
        end associate
        if (row%law_kind == solid_law) symmetric = symmetric .and. equations%kinematics%symmetric
      end associate
    end do
  end function is_symmetric

end module equation_set_up
