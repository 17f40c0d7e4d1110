!> The remesher's algorithm: from the checkpoint of an old mesh to that of a new one.
!>
!> contour -> sizes -> zones -> mesh, or a mesh without zones -> state -> checkpoint (annex 2; chapter 12). Bodies without a mesh
!> get their first one in the same way, from the contours of their cards and without state; made again, after a run on it has shown
!> its errors (`sizes_of_run`), it is the mesh of a later generation. A failure ends in an error that names its stage; the old
!> checkpoint is never modified.
module remesh_scene
  use axis_carry, only: carry_axis_nodes
  use body_seams, only: find_seams, seams_t
  use carry_solution, only: carry_progress, carry_solids
  use contact_carry, only: carry_contacts
  use contact_ends, only: contact_end_t
  use contact_rule, only: choose_rules
  use corrected_contours, only: contour_options_t, contour_t
  use errors, only: error_t, exit_input, fail
  use exchange, only: write_checkpoint
  use fields, only: displacement_field, pilot_field
  use first_contours, only: contours_of_cards
  use fold_carry, only: carry_folds
  use fold_closing, only: close_folds
  use free_nodes_out, only: move_free_nodes_out
  use kinds, only: wp
  use material_interfaces, only: interface_t, interfaces_of
  use mesh, only: nearest_node
  use mesh_choice, only: make_free_mesh, make_mesh, materials_of, may_be_free, needs_free_mesh, take_better_mesh
  use new_mesh_check, only: check_shape
  use new_scene, only: set_up_new_scene
  use old_checkpoint, only: read_old_checkpoint
  use pair_fit, only: fit_pairs, update_closest_points
  use part_contour, only: build_contours
  use placed_walls, only: lay_sides, lift_sides, place_walls, placed_wall_t, put_on_walls
  use point_carry, only: carry_points
  use remesh_cuts, only: cut_bodies, cut_now, note_cuts
  use remesh_facts, only: begin_task, end_task, remesh_facts_t
  use remesh_options, only: remesh_options_t
  use remesher_options, only: by_free, by_gmsh, remesher_options_t, smallest_anywhere
  use scene, only: lacks_mesh, scene_t, solid_elements
  use size_field, only: old_mesh_t, size_field_t
  use sizes_of_run, only: learn_sizes
  use sizes_of_scene, only: requested_sizes
  use solution, only: present_coordinates, solution_t, start_solution
  use zone_mesh, only: new_mesh_t
  use zone_plan, only: plan_zones
  use zones, only: plan_t
  implicit none
  private
  public :: remesh_checkpoint

  !> Free sides from a corner to contact that are shorter than this share of the smallest element are dropped.
  real(wp), parameter :: least_free = 0.2_wp
  !> Loops of a free contour that crosses itself are cut off up to the length of so many of the smallest elements: as deep as one.
  real(wp), parameter :: longest_lap = 2.0_wp

contains

  !> Read a checkpoint, make the new mesh, carry the state to it and write the new checkpoint.
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
    type(old_mesh_t), allocatable :: learned
    type(contour_options_t) :: as_it_bends
    type(new_mesh_t) :: mesh
    character(len=:), allocatable :: deck_path, deck_text
    real(wp), allocatable :: moved(:, :)
    real(wp) :: smallest
    type(remesher_options_t) :: as_the_deck_says
    logical :: first, is_cut

    facts%mesher = 'zones'
    call begin_task(facts, 'checkpoint', 'read')
    call read_old_checkpoint(options%checkpoint, deck_path, deck_text, old, before, ends, error)
    if (allocated(error)) return
    first = lacks_mesh(old)
    as_the_deck_says = old%remesher
    call apply_options(options, old%remesher)
    call reset_to_start(old, before, moved)
    facts%step = before%step
    facts%time = before%time
    facts%generation = old%generation + 1
    smallest = max(smallest_anywhere(old%remesher), 0.0_wp)
    as_it_bends = contour_options_t(least_free=least_free*smallest, longest_lap=longest_lap*smallest)
    if (allocated(options%sizes_of)) then
      call begin_task(facts, 'mesh', 'sizes')
      if (first) then
        call learn_sizes(options%sizes_of, deck_text, as_it_bends, learned, facts%generation, error)
      else
        call fail(error, exit_input, '--sizes-of: '//options%checkpoint//' has a mesh: only a first one is made again')
      end if
      if (allocated(error)) return
    end if

    call begin_task(facts, 'contour', 'contour')
    if (first) then
      call contours_of_cards(old, contours, facts%contour, error)
    else
      call build_contours(old, before, ends, as_it_bends, contours, facts%contour, error)
    end if
    if (allocated(error)) return
    call interfaces_of(old, before, contours, interfaces)
    call cut_bodies(old, before, contours, facts, is_cut, error)
    if (allocated(error)) return
    call find_seams(old, before, contours, seams)
    call begin_task(facts, 'mesh', 'sizes')
    call requested_sizes(old, before, contours, first, options%same_sizes, sizes, learned)
    call mesh_bodies(old, before, contours, interfaces, seams, sizes, options, is_cut, plan, mesh, facts, error)
    if (allocated(error)) return
    call lay_scene_on_mesh(old, before%fields(pilot_field)%value, contours, plan, mesh, new, facts, error)
    if (allocated(error)) return
    call carry_walls(old, before, new)
    call start_solution(new, after)
    if (first) then
      new%mesh%origin = new%mesh%coordinates
    else
      call carry_state(old, before, moved, contours, mesh, new, after, facts, error)
      if (allocated(error)) return
      if (is_cut) call note_cuts(old, before, contours, new, facts, after)
    end if
    call begin_task(facts, 'checkpoint', 'write')
    new%remesher = as_the_deck_says
    call write_checkpoint(options%out, deck_path, deck_text, new, after, [contact_end_t ::], error)
    call end_task(facts)
    facts%old_elements = solid_elements(old)
    facts%new_elements = solid_elements(new)
  end subroutine remesh_checkpoint

  !> Mesh the corrected contours: in zones, where the deck or the contours have some, otherwise, or where that is better, without.
  subroutine mesh_bodies(old, before, contours, interfaces, seams, sizes, options, is_cut, plan, mesh, facts, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)       !! (ncontour)
    type(interface_t), intent(in) :: interfaces(:)   !! (ninterface)
    type(seams_t), intent(in) :: seams
    type(size_field_t), intent(in) :: sizes
    type(remesh_options_t), intent(in) :: options
    logical, intent(in) :: is_cut
    type(plan_t), intent(out) :: plan
    type(new_mesh_t), intent(out) :: mesh
    type(remesh_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error

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
    call keep_walls(old, before, plan, mesh)
  end subroutine mesh_bodies

  !> Nodes of the new mesh behind walls go to the walls, and sides do not dip behind them.
  pure subroutine keep_walls(old, before, plan, mesh)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(plan_t), intent(in) :: plan
    type(new_mesh_t), intent(inout) :: mesh
    type(placed_wall_t), allocatable :: walls(:)
    logical, allocatable :: acts_on(:, :)
    integer, allocatable :: sides(:, :)
    integer :: w, e

    call place_walls(old, present_coordinates(old, before), walls)
    allocate (acts_on(size(mesh%coordinates, 2), size(walls)), source=.false.)
    do w = 1, size(walls)
      do e = 1, size(mesh%connectivity, 2)
        if (walls(w)%of_group(plan%group(mesh%zone(e)))) acts_on(mesh%connectivity(:, e), w) = .true.
      end do
    end do
    call put_on_walls(walls, mesh%coordinates, acts_on)
    sides = reshape([(mesh%sides(e)%nodes, e=1, size(mesh%sides))], [3, size(mesh%sides)])
    call lay_sides(walls, sides, acts_on, mesh%coordinates)
    call lift_sides(walls, sides, acts_on, mesh%coordinates)
  end subroutine keep_walls

  !> Walls on the new mesh: a node on each.
  pure subroutine carry_walls(old, before, new)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(scene_t), intent(inout) :: new
    real(wp) :: x(2, size(old%mesh%coordinates, 2)), distance
    integer :: k

    if (.not. allocated(old%walls)) return
    x = present_coordinates(old, before)
    do k = 1, size(old%walls)
      call nearest_node(new%mesh%coordinates, x(:, old%walls(k)%node), new%walls(k)%node, distance)
    end do
  end subroutine carry_walls

  !> The scene on the new mesh: sides of bodies in contact are fitted to each other, folds closed, free nodes moved out of dies.
  subroutine lay_scene_on_mesh(old, pilots, contours, plan, mesh, new, facts, error)
    type(scene_t), intent(in) :: old
    real(wp), intent(in) :: pilots(:, :)         !! (3, ndie) where they are now [length and radian]
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(plan_t), intent(in) :: plan
    type(new_mesh_t), intent(inout) :: mesh
    type(scene_t), intent(out) :: new
    type(remesh_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: moved

    call set_up_new_scene(old, contours, plan, mesh, new, error)
    if (allocated(error)) return
    new%generation = facts%generation
    call fit_pairs(contours, mesh, new, facts%fit)
    if (allocated(facts%contour%opened)) call close_folds(contours, facts%contour%opened, mesh, new)
    ! by the lengths that the sides have in the checkpoint, where it is read
    call choose_rules(new)
    moved = 0
    if (.not. lacks_mesh(old)) call move_free_nodes_out(contours, pilots, mesh, new, moved)
    if (facts%fit > 0 .or. moved > 0 .or. allocated(facts%contour%opened)) call check_shape(mesh, facts%mesh, error)
  end subroutine lay_scene_on_mesh

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
    call carry_progress(old, before, after)
    ! of the error of the stress no more than its size is followed on the new mesh
    after%path%whole_before = before%path%stress_whole
    call carry_solids(old, before, moved, cut_now(old, facts), new, after, facts%transfer, error)
    if (allocated(error)) return
    call begin_task(facts, 'contact', 'contact')
    call carry_contacts(old, before, contours, mesh, new, after, facts%contacts)
    call carry_points(old, before, contours, new, after, facts%contacts)
    call carry_axis_nodes(old, before, new, after, facts%contacts)
    call update_closest_points(new, after)
    call carry_folds(old, before, contours, mesh, new, after)
  end subroutine carry_state

  !> Command line options that replace those of the deck, for this mesh.
  subroutine apply_options(options, remesher)
    type(remesh_options_t), intent(in) :: options
    type(remesher_options_t), intent(inout) :: remesher

    if (options%transfer >= 0) remesher%transfer = options%transfer
    if (options%mesher >= 0) remesher%mesher = options%mesher
  end subroutine apply_options

end module remesh_scene
