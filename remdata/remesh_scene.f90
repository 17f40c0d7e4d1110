!> The remesher's algorithm: from the checkpoint of an old mesh to that of a new one.
!>
!> contour -> sizes -> zones -> mesh, or a mesh without zones -> state -> checkpoint (annex 2; chapter 12). Bodies without a mesh
!> get their first one in the same way, from the contours of their cards and without state. A failure ends in an error that names
!> its stage; the old checkpoint is never modified.
module remesh_scene
  use arcs_on_die, only: placed_piece
  use axis_nodes, only: put_on_axis
  use better_mesh, only: free_mesh_is_better
  use block_mesh, only: polygon_area
  use body_seams, only: find_seams, seams_t
  use boundary_curves, only: boundary_curve_t
  use contact_carry, only: carry_contacts
  use contact_ends, only: contact_end_t
  use contact_misfits, only: needs_of_misfits
  use contour_cuts, only: cut_is_due, make_cuts
  use contour_volume, only: volume_inside
  use cuts, only: stage_of_cuts
  use contour_needs, only: geometry_settings_t, needs_of_boundary, needs_of_die
  use dies, only: is_deformable
  use errors, only: error_t, exit_input, fail
  use exchange, only: open_checkpoint, read_bare_scene, read_contact_ends, read_deck_of_checkpoint, read_state, write_checkpoint
  use fields, only: displacement_field, on_nodes, pilot_field
  use first_contours, only: contours_of_cards
  use gmsh_call, only: find_gmsh
  use kept_members, only: member_memory_t
  use kinds, only: pi, wp
  use material_interfaces, only: interface_t, interfaces_of
  use material_volumes, only: compare_materials, materials_kept_t
  use member_reader, only: member_reader_t
  use mesh_prediction, only: predict
  use mesh_without_zones, only: make_mesh_without_zones
  use fold_closing, only: close_folds
  use new_mesh_check, only: check_new_mesh, check_shape, mesh_check_t
  use new_scene, only: set_up_new_scene
  use pair_fit, only: fit_pairs, update_closest_points
  use outline_mesh, only: mesher_t
  use part_contour, only: build_contours, contour_options_t, contour_t
  use remesh_facts, only: begin_task, end_task, remesh_facts_t
  use remesh_options, only: remesh_options_t
  use remesher_options, only: as_it_comes, by_free, by_gmsh, elements_allowed, has_zones, remesher_options_t
  use scene, only: axisymmetric, is_solid, lacks_mesh, scene_t
  use size_field, only: need_t, old_mesh_t, requested_size, set_up_sizes, size_field_t, size_limits_t
  use solution, only: present_coordinates, solution_t, start_solution
  use state_pieces, only: change_volume_ratios, mesh_of, solid_pieces, state_pieces_t, store_states, take_values
  use text, only: to_text
  use transfer_api, only: transfer_options_t
  use transfer_mesh, only: build_mesh_trees, transfer_mesh_t
  use transfer_nodes, only: carry_at_nodes
  use transfer_report, only: transfer_report_t
  use transfer_states, only: carry_states
  use visit_solution, only: visit_solution_members
  use zone_mesh, only: mesh_settings_t, mesh_zones, new_mesh_t
  use zone_plan, only: plan_zones
  use zones, only: plan_t
  implicit none
  private
  public :: remesh_checkpoint

  !> Errors of strain fall with the size to this power (8-node elements).
  real(wp), parameter :: strain_order = 2.0_wp
  !> Free sides from a corner to contact that are shorter than this share of the smallest element are dropped.
  real(wp), parameter :: least_free = 0.2_wp
  !> A mesh that was strained by less than this in the mean of its elements, as by unloading or where one node is touched so far
  !> has shown no errors of what comes: its elements are not made larger.
  real(wp), parameter :: strained = 1.0e-3_wp
  !> Loops of a free contour that crosses itself are cut off up to the length of so many of the smallest elements: as deep as one.
  real(wp), parameter :: longest_lap = 2.0_wp
  !> Attempts at a mesh of good shape: smoothing, then finer.
  integer, parameter :: attempts = 3

contains

  subroutine remesh_checkpoint(options, facts, error)
    type(remesh_options_t), intent(in) :: options
    type(remesh_facts_t), intent(out) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(scene_t) :: old, new
    type(solution_t) :: before, after
    type(contact_end_t), allocatable :: ends(:)
    type(contour_t), allocatable :: contours(:)
    type(interface_t), allocatable :: interfaces(:)
    type(seams_t) :: seams
    type(plan_t) :: plan
    type(size_field_t) :: sizes
    type(new_mesh_t) :: mesh
    character(len=:), allocatable :: deck_path, deck_text
    real(wp), allocatable :: moved(:, :)
    type(remesher_options_t) :: as_the_deck_says
    logical :: first, is_cut

    facts%mesher = 'zones'
    call begin_task(facts, 'checkpoint', 'read')
    call read_all(options%checkpoint, deck_path, deck_text, old, before, ends, error)
    if (allocated(error)) return
    first = lacks_mesh(old)
    as_the_deck_says = old%remesher
    call apply_options(options, old%remesher)
    call reset_to_start(old, before, moved)
    facts%step = before%step
    facts%time = before%time
    facts%generation = old%generation + 1

    call begin_task(facts, 'contour', 'contour')
    if (first) then
      call contours_of_cards(old, contours, facts%contour, error)
    else
      call build_contours(old, before, ends, contour_options_t(least_free=least_free*max(old%remesher%smallest, 0.0_wp), &
                                                               longest_lap=longest_lap*max(old%remesher%smallest, 0.0_wp)), &
                          contours, facts%contour, error)
    end if
    if (allocated(error)) return
    call interfaces_of(old, before, contours, interfaces)
    call cut_bodies(old, before, size(interfaces) > 0, contours, facts, is_cut, error)
    if (allocated(error)) return
    call find_seams(old, before, contours, seams)
    call begin_task(facts, 'mesh', 'sizes')
    call requested_sizes(old, before, contours, first, options%same_sizes, sizes)
    if (all(old%remesher%mesher /= [by_free, by_gmsh]) .and. .not. is_cut) then
      call begin_task(facts, 'mesh', 'zones')
      call plan_zones(old, present_coordinates(old, before), before%fields(pilot_field)%value, materials_of(old, before), &
                      contours, interfaces, plan, error)
      call begin_task(facts, 'mesh', 'mesh')
      if (.not. allocated(error)) call make_mesh(old, before, contours, plan, sizes, options%finer, mesh, facts, error)
    end if
    if (is_cut .or. needs_free_mesh(old%remesher, error)) then
      call make_free_mesh(old, before, contours, seams, sizes, options, plan, mesh, facts, error)
    else if (.not. allocated(error) .and. may_be_free(old%remesher)) then
      call take_better_mesh(old, before, contours, seams, sizes, options%finer, plan, mesh, facts)
    end if
    if (allocated(error)) return
    if (old%plane_state == axisymmetric) call put_on_axis(mesh%coordinates)
    call set_up_new_scene(old, contours, plan, mesh, new, error)
    if (allocated(error)) return
    call fit_pairs(contours, mesh, new, facts%fit)
    if (allocated(facts%contour%opened)) call close_folds(contours, facts%contour%opened, mesh, new)
    if (facts%fit > 0 .or. allocated(facts%contour%opened)) call check_shape(mesh, facts%mesh, error)
    if (allocated(error)) return
    call start_solution(new, after)
    if (first) then
      new%mesh%origin = new%mesh%coordinates
    else
      call carry_state(old, before, moved, contours, mesh, new, after, facts, error)
      if (allocated(error)) return
      if (is_cut) call note_cuts(old, contours, facts, after)
    end if
    call begin_task(facts, 'checkpoint', 'write')
    new%remesher = as_the_deck_says
    call write_checkpoint(options%out, deck_path, deck_text, new, after, [contact_end_t ::], error)
    call end_task(facts)
    facts%old_elements = count_elements(old)
    facts%new_elements = count_elements(new)
  end subroutine remesh_checkpoint

  !> Make the cuts that are due. The facts have what came of all cuts of the scene.
  subroutine cut_bodies(old, before, materials_share, contours, facts, is_cut, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    logical, intent(in) :: materials_share   !! sides
    type(contour_t), allocatable, intent(inout) :: contours(:)   !! (ncontour)
    type(remesh_facts_t), intent(inout) :: facts
    logical, intent(out) :: is_cut
    type(error_t), allocatable, intent(out) :: error
    integer :: k

    is_cut = any([(cut_is_due(old, before, k), k=1, size(before%cuts))])
    if (.not. is_cut) return
    call begin_task(facts, stage_of_cuts, 'cut')
    if (materials_share) then
      call fail(error, exit_input, 'a body that is cut shares sides with another one', 'cut a body that stands alone')
      return
    end if
    call make_cuts(old, before, contours, facts%cuts, error)
  end subroutine cut_bodies

  !> What was cut off is no drift of the volume.
  subroutine note_cuts(old, contours, facts, after)
    type(scene_t), intent(in) :: old
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(remesh_facts_t), intent(inout) :: facts
    type(solution_t), intent(inout) :: after
    real(wp) :: left, share
    integer :: c

    left = 0
    do c = 1, size(contours)
      left = left + volume_inside(contours(c)%boundary, old%plane_state == axisymmetric)
    end do
    facts%removed = sum(facts%cuts%volume, mask=facts%cuts%generation == facts%generation)
    share = left/(left + facts%removed)
    after%initial_volume = share*after%initial_volume
    after%work%grown = share*after%work%grown
    after%cuts = facts%cuts
    if (old%plane_state == axisymmetric) facts%removed = 2*pi*facts%removed
  end subroutine note_cuts

  !> Read the whole checkpoint; it is opened, and its hash compared, once.
  subroutine read_all(path, deck_path, deck_text, scene, solution, ends, error)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: deck_path, deck_text
    type(scene_t), intent(out) :: scene
    type(solution_t), intent(out) :: solution
    type(contact_end_t), allocatable, intent(out) :: ends(:)
    type(error_t), allocatable, intent(out) :: error
    type(member_reader_t) :: reader
    type(error_t), allocatable :: ignored

    call open_checkpoint(path, reader, error)
    if (allocated(error)) return
    call read_deck_of_checkpoint(reader, deck_path, deck_text, error)
    if (.not. allocated(error)) call read_bare_scene(reader, scene, error)
    if (.not. allocated(error)) call start_solution(scene, solution)
    if (.not. allocated(error)) call read_state(reader, scene, solution, error)
    if (.not. allocated(error)) call read_contact_ends(reader, scene, ends, error)
    call reader%file%close(ignored)
  end subroutine read_all

  !> With small strains the geometry is that of the start: bodies are meshed in their initial position, and their displacements
  !> `moved` are transferred as other nodal fields. Bodies in contact with dies are meshed in their present position.
  pure subroutine reset_to_start(scene, solution, moved)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable, intent(out) :: moved(:, :)   !! (2, nnode) [length]

    associate (displacement => solution%fields(displacement_field)%value)
      allocate (moved(2, size(scene%mesh%coordinates, 2)), source=0.0_wp)
      if (scene%finite .or. any(scene%groups%die > 0) .or. .not. scene%fields(displacement_field)%declared) return
      moved = displacement
      displacement = 0
    end associate
  end subroutine reset_to_start

  !> Transfer everything from the old mesh: progress, state of the solids, contact.
  subroutine carry_state(old, before, moved, contours, mesh, new, after, facts, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    real(wp), intent(in) :: moved(:, :)
    type(contour_t), intent(in) :: contours(:)
    type(new_mesh_t), intent(in) :: mesh
    type(scene_t), intent(inout) :: new
    type(solution_t), intent(inout) :: after
    type(remesh_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error

    call begin_task(facts, 'transfer', 'transfer')
    call carry_progress(before, after)
    call carry_solids(old, before, moved, new, after, facts%transfer, error)
    if (allocated(error)) return
    call begin_task(facts, 'contact', 'contact')
    call carry_contacts(old, before, contours, mesh, new, after, facts%contacts)
    call update_closest_points(new, after)
  end subroutine carry_state

  !> Command line options that replace those of the deck, for this mesh.
  subroutine apply_options(options, remesher)
    type(remesh_options_t), intent(in) :: options
    type(remesher_options_t), intent(inout) :: remesher

    if (options%transfer >= 0) remesher%transfer = options%transfer
    if (options%mesher >= 0) remesher%mesher = options%mesher
  end subroutine apply_options

  pure function count_elements(scene) result(n)
    type(scene_t), intent(in) :: scene
    integer :: n
    integer :: g

    n = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) n = n + size(scene%groups(g)%connectivity, 2)
    end do
  end function count_elements

  !> Numbers of materials used by the transfer, for each group of the scene.
  pure function materials_of(scene, solution) result(material)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: material(size(scene%groups))
    type(state_pieces_t) :: pieces
    integer :: k

    material = 0
    call solid_pieces(scene, pieces, solution)
    do k = 1, size(pieces%groups)
      material(pieces%groups(k)%scene_group) = pieces%groups(k)%material
    end do
  end function materials_of

  !> Sizes by the error of the strains, by the curvature of the contour and of nearby dies, and by contact intervals.
  subroutine requested_sizes(scene, solution, contours, first, same, sizes)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: first   !! there is no mesh yet: largest elements except where the geometry requires smaller ones
    logical, intent(in) :: same    !! those of the old elements, whatever the error and the geometry ask for
    type(size_field_t), intent(out) :: sizes
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: mesh
    type(old_mesh_t) :: old
    type(size_limits_t) :: limits
    type(geometry_settings_t) :: settings
    type(need_t), allocatable :: needs(:), bends(:), more(:)
    real(wp) :: error, now
    logical :: shown
    integer :: e, c, d, k

    if (scene%remesher%smallest > 0) limits%smallest = scene%remesher%smallest
    if (scene%remesher%largest > 0) limits%largest = scene%remesher%largest
    settings%across = scene%remesher%across_contact
    settings%turn = scene%remesher%turn
    allocate (needs(0), bends(0))
    do d = 1, size(scene%dies)
      if (is_deformable(scene%dies(d))) cycle
      call needs_of_die([(placed_piece(scene%dies(d), solution%fields(pilot_field)%value(:, d), k), &
                          k=1, size(scene%dies(d)%pieces, 3))], &
                        scene%dies(d)%closed, settings, limits, more)
      bends = [bends, more]
    end do
    do c = 1, size(contours)
      call needs_of_boundary(contours(c)%boundary, settings, limits, more, bends)
      needs = [needs, more]
    end do
    if (first) then
      call set_up_sizes(limits, needs, sizes)
      return
    end if
    call needs_of_misfits(scene, solution, more)
    more%size = max(more%size, limits%smallest)
    needs = [needs, more]
    call solid_pieces(scene, pieces, solution)
    pieces%axisymmetric = .false.
    call mesh_of(pieces, mesh)
    old%nodes = mesh%nodes
    old%connectivity = mesh%connectivity
    old%material = mesh%material
    allocate (old%requested(size(mesh%material)))
    do e = 1, size(old%requested)
      old%requested(e) = sqrt(polygon_area(old%nodes(:, old%connectivity(1:4, e))))
    end do
    if (same) then
      call set_up_sizes(size_limits_t(), [need_t ::], sizes, old)
      return
    end if
    if (scene%remesh%estimate) then
      shown = sum(solution%estimate%strain_sums(2, :)) > strained*size(old%requested)
      do e = 1, size(old%requested)
        error = solution%estimate%strain_of(e)
        now = old%requested(e)
        old%requested(e) = requested_size(now, error, scene%remesher%strain_error, strain_order)
        if (.not. shown) old%requested(e) = min(old%requested(e), now)
      end do
    end if
    call set_up_sizes(limits, needs, sizes, old)
  end subroutine requested_sizes

  !> Mesh the zones; a mesh of bad shape is smoothed with more passes, then refined.
  subroutine make_mesh(scene, before, contours, plan, sizes, finer, mesh, facts, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    type(size_field_t), intent(in) :: sizes
    real(wp), intent(in) :: finer
    type(new_mesh_t), intent(out) :: mesh
    type(remesh_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(mesh_settings_t) :: settings
    type(boundary_curve_t) :: boundaries(size(contours))
    integer :: attempt, c

    do c = 1, size(contours)
      boundaries(c) = contours(c)%boundary
    end do
    settings%division%refine = finer
    settings%division%most_elements = min(settings%division%most_elements, elements_allowed(scene%remesher, finer))
    do attempt = 1, attempts
      if (allocated(error)) deallocate (error)
      if (attempt == 2) settings%passes = 4*settings%passes
      if (attempt == 3) settings%division%refine = 1.5_wp*settings%division%refine
      call mesh_zones(boundaries, plan%points, plan%zones, sizes, settings, mesh, error, plan%paths)
      if (allocated(error)) return
      facts%coarser = mesh%division%factor
      facts%expected = predict(mesh, sizes, strain_order)
      call check_new_mesh(contours, mesh, facts%mesh, error)
      if (.not. allocated(error)) call compare_materials(scene, before, plan, mesh, facts%materials, error)
      if (.not. allocated(error)) return
    end do
  end subroutine make_mesh

  !> Is a mesh without zones needed: because it is requested, or because zones that the user did not give failed?
  pure function needs_free_mesh(remesher, error) result(yes)
    type(remesher_options_t), intent(in) :: remesher
    type(error_t), allocatable, intent(in) :: error   !! of the mesh by zones
    logical :: yes

    yes = any(remesher%mesher == [by_free, by_gmsh]) .or. (allocated(error) .and. may_be_free(remesher))
  end function needs_free_mesh

  !> May a mesh without zones take the place of one by zones?
  pure function may_be_free(remesher) result(yes)
    type(remesher_options_t), intent(in) :: remesher
    logical :: yes

    yes = remesher%mesher == as_it_comes .and. .not. has_zones(remesher)
  end function may_be_free

  !> The mesh by derived zones is compared with that of the free mesher, and the better one taken.
  subroutine take_better_mesh(old, before, contours, seams, sizes, finer, plan, mesh, facts)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(seams_t), intent(in) :: seams           !! between its bodies
    type(size_field_t), intent(in) :: sizes
    real(wp), intent(in) :: finer                !! requested sizes are divided by this factor
    type(plan_t), intent(inout) :: plan
    type(new_mesh_t), intent(inout) :: mesh
    type(remesh_facts_t), intent(inout) :: facts
    type(plan_t) :: free_plan
    type(materials_kept_t) :: kept
    type(new_mesh_t) :: free
    type(mesh_check_t) :: check
    type(mesher_t) :: mesher
    type(error_t), allocatable :: error

    call begin_task(facts, 'mesh', 'free')
    call make_mesh_without_zones(old, materials_of(old, before), contours, seams, sizes, finer, mesher, free_plan, free, check, &
                                 error)
    if (.not. allocated(error)) call compare_materials(old, before, free_plan, free, kept, error)
    if (allocated(error)) return
    if (.not. free_mesh_is_better(facts%mesh, facts%expected, check, predict(free, sizes, strain_order))) return
    plan = free_plan
    mesh = free
    facts%materials = kept
    facts%mesher = 'free'
    facts%mesh = check
    call note_free_mesh(mesh, sizes, facts)
  end subroutine take_better_mesh

  !> A mesh without zones: by the free mesher, or by Gmsh where it is requested or the free mesher failed. Where both fail, the
  !> error of the free mesher is the one to report.
  subroutine make_free_mesh(old, before, contours, seams, sizes, options, plan, mesh, facts, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)
    type(seams_t), intent(in) :: seams
    type(size_field_t), intent(in) :: sizes
    type(remesh_options_t), intent(in) :: options
    type(plan_t), intent(out) :: plan
    type(new_mesh_t), intent(out) :: mesh
    type(remesh_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: first_error
    type(mesher_t) :: mesher

    if (old%remesher%mesher /= by_gmsh) then
      facts%mesher = 'free'
      call begin_task(facts, 'mesh', 'free')
      call make_mesh_without_zones(old, materials_of(old, before), contours, seams, sizes, options%finer, mesher, plan, mesh, &
                                   facts%mesh, error)
      if (.not. allocated(error)) call compare_materials(old, before, plan, mesh, facts%materials, error)
      call note_free_mesh(mesh, sizes, facts)
      if (.not. allocated(error) .or. old%remesher%mesher == by_free) return
      if (error%code == exit_input) return
      call move_alloc(error, first_error)
    end if
    facts%mesher = 'gmsh'
    call begin_task(facts, 'mesh', 'gmsh')
    mesher%is_gmsh = .true.
    call find_gmsh(options%out, options%limit, mesher%gmsh)
    call make_mesh_without_zones(old, materials_of(old, before), contours, seams, sizes, options%finer, mesher, plan, mesh, &
                                 facts%mesh, error)
    if (.not. allocated(error)) call compare_materials(old, before, plan, mesh, facts%materials, error)
    call note_free_mesh(mesh, sizes, facts)
    if (allocated(error) .and. allocated(first_error)) then
      facts%mesher = 'free'
      call move_alloc(first_error, error)
    end if
  end subroutine make_free_mesh

  !> How far sizes are above the requested ones, and the errors to expect.
  subroutine note_free_mesh(mesh, sizes, facts)
    type(new_mesh_t), intent(in) :: mesh
    type(size_field_t), intent(in) :: sizes
    type(remesh_facts_t), intent(inout) :: facts

    if (.not. allocated(mesh%zone)) return
    facts%coarser = mesh%division%factor
    ! a mesh that was refused may have no nodes
    if (allocated(mesh%coordinates)) facts%expected = predict(mesh, sizes, strain_order)
  end subroutine note_free_mesh

  !> Time, dies, work: what does not depend on the mesh (visit_solution says of each member how it is carried).
  subroutine carry_progress(before, after)
    type(solution_t), intent(in) :: before
    type(solution_t), intent(inout) :: after
    type(member_memory_t) :: memory
    type(solution_t), allocatable :: shown   ! a visitor may change what it visits

    allocate (shown, source=before)
    call visit_solution_members(memory, shown)
    memory%gives = .true.
    call visit_solution_members(memory, after)
    after%estimate%last_stop = before%step
    after%estimate%previous_stress = before%estimate%stress
    after%unbalanced = .true.
  end subroutine carry_progress

  !> State of the solids and nodal fields: initial position of the material points, displacement of the last step, and displacement
  !> since the start where the mesh is not updated.
  subroutine carry_solids(old, before, moved, new, after, report, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    real(wp), intent(in) :: moved(:, :)
    type(scene_t), intent(inout) :: new
    type(solution_t), intent(inout) :: after
    type(transfer_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(state_pieces_t) :: from, to, start
    type(transfer_options_t) :: options
    type(transfer_mesh_t) :: mesh, target, rest
    integer, allocatable :: material(:)
    integer :: k

    options%method = old%remesher%transfer
    options%exponent = old%remesher%exponent
    options%neighbours = old%remesher%neighbours
    call solid_pieces(old, from, before)
    call solid_pieces(new, to)
    do k = 1, size(to%groups)
      call take_values(after, to%groups(k))
    end do
    call mesh_of(from, mesh)
    call solid_pieces(old, start)
    call mesh_of(start, rest)
    call change_volume_ratios(rest%volumes, mesh%volumes, from)
    call build_mesh_trees(mesh)
    call mesh_of(to, target)
    call carry_states(mesh, target, from, to, options, report, error)
    if (allocated(error)) return
    call store_states(to, after)

    allocate (material(size(new%mesh%coordinates, 2)), source=0)
    do k = 1, size(target%material)
      material(target%connectivity(:, k)) = target%material(k)
    end do
    call carry_nodes(mesh, old, before, moved, material, options%outside, new, after, error)
  end subroutine carry_solids

  !> What belongs to nodes, by the shape functions of the old mesh: origin of the material, and of every field on nodes the change
  !> of the last step and the value; of the displacement the value is what was `moved`.
  subroutine carry_nodes(mesh, old, before, moved, material, outside, new, after, error)
    type(transfer_mesh_t), intent(in) :: mesh
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    real(wp), intent(in) :: moved(:, :)      !! (2, nnode) [length]
    integer, intent(in) :: material(:)       !! of the new nodes (nnode)
    real(wp), intent(in) :: outside
    type(scene_t), intent(inout) :: new
    type(solution_t), intent(inout) :: after
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: from(:, :), to(:, :)
    real(wp) :: farthest
    integer :: f, n, pass

    n = 2
    do f = 1, size(before%fields)
      if (is_carried(f)) n = n + 2*before%fields(f)%ncomp
    end do
    allocate (from(n, size(moved, 2)), to(n, size(material)))
    from(1:2, :) = old%mesh%origin
    do pass = 1, 2
      n = 2
      do f = 1, size(before%fields)
        if (.not. is_carried(f)) cycle
        associate (m => before%fields(f)%ncomp)
          if (pass == 1) then
            from(n + 1:n + m, :) = before%fields(f)%last_increment
            from(n + m + 1:n + 2*m, :) = before%fields(f)%value
            if (f == displacement_field) from(n + m + 1:n + 2*m, :) = moved
          else
            after%fields(f)%last_increment = to(n + 1:n + m, :)
            after%fields(f)%value = to(n + m + 1:n + 2*m, :)
          end if
          n = n + 2*m
        end associate
      end do
      if (pass == 2) exit
      call carry_at_nodes(mesh, from, new%mesh%coordinates, material, outside, to, farthest, error)
      if (allocated(error)) return
    end do
    new%mesh%origin = to(1:2, :)

  contains

    pure function is_carried(k) result(yes)
      integer, intent(in) :: k
      logical :: yes

      yes = before%fields(k)%place == on_nodes .and. before%fields(k)%declared
    end function is_carried

  end subroutine carry_nodes

end module remesh_scene
