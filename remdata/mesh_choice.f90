!> The new mesh: by zones, by the free mesher, or by Gmsh; where the deck leaves it open, the better one.
module mesh_choice
  use better_mesh, only: free_mesh_is_better
  use body_seams, only: seams_t
  use boundary_curves, only: boundary_curve_t
  use corrected_contours, only: contour_t
  use errors, only: error_t, exit_input
  use fields, only: field_t, on_nodes
  use gmsh_call, only: find_gmsh
  use kinds, only: wp
  use material_volumes, only: compare_materials, materials_kept_t
  use mesh_prediction, only: predict
  use mesh_without_zones, only: make_mesh_without_zones
  use new_mesh_check, only: check_new_mesh, mesh_check_t
  use outline_mesh, only: mesher_t
  use remesh_facts, only: begin_task, remesh_facts_t
  use remesh_options, only: remesh_options_t
  use remesher_options, only: as_it_comes, by_free, by_gmsh, elements_allowed, has_zones, remesher_options_t
  use scene, only: scene_t
  use size_field, only: of_squares, size_field_t
  use sizes_of_scene, only: strain_order
  use solution, only: solution_t
  use state_pieces, only: solid_pieces, state_pieces_t
  use zone_mesh, only: mesh_settings_t, mesh_zones, new_mesh_t
  use zones, only: plan_t
  implicit none
  private
  public :: materials_of, make_mesh, needs_free_mesh, may_be_free, take_better_mesh, make_free_mesh

  !> Attempts at a mesh of good shape: smoothing, then finer.
  integer, parameter :: attempts = 3

contains

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

  !> Mesh the zones, with elements longer than wide where these are asked for, else of squares.
  !> A mesh of bad shape is smoothed with more passes, then refined.
  subroutine make_mesh(scene, before, contours, plan, sizes, finer, mesh, facts, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(plan_t), intent(in) :: plan
    type(size_field_t), intent(in) :: sizes
    real(wp), intent(in) :: finer
    type(new_mesh_t), intent(out) :: mesh
    type(remesh_facts_t), intent(inout) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(mesh_settings_t) :: settings
    type(boundary_curve_t) :: boundaries(size(contours))
    type(size_field_t) :: now
    integer :: attempt, c

    do c = 1, size(contours)
      boundaries(c) = contours(c)%boundary
    end do
    now = sizes
    settings%division%refine = finer
    settings%division%most_elements = min(settings%division%most_elements, elements_allowed(scene%remesher, finer))
    do attempt = merge(0, 1, sizes%is_directed), attempts
      if (allocated(error)) deallocate (error)
      if (attempt == 1) now = of_squares(sizes)
      if (attempt == 2) settings%passes = 4*settings%passes
      if (attempt == 3) settings%division%refine = 1.5_wp*settings%division%refine
      call mesh_zones(boundaries, plan%points, plan%zones, now, settings, mesh, error, plan%paths)
      if (allocated(error)) return
      facts%coarser = mesh%division%factor
      facts%expected = predict(mesh, now, strain_order)
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
    if (.not. free_mesh_is_better(facts%mesh, facts%expected, check, predict(free, sizes, strain_order), &
                                  .not. any(is_other_unknown(old%fields)))) return
    plan = free_plan
    mesh = free
    facts%materials = kept
    facts%mesher = 'free'
    facts%mesh = check
    call note_free_mesh(mesh, sizes, facts)
  end subroutine take_better_mesh

  !> A field that is solved for on nodes beside the motion, as the temperature: of its errors nothing is known here.
  elemental function is_other_unknown(field) result(yes)
    type(field_t), intent(in) :: field
    logical :: yes

    yes = field%declared .and. field%place == on_nodes .and. .not. field%given .and. field%quantity /= 'motion'
  end function is_other_unknown

  !> A mesh without zones: by the free mesher, or by Gmsh where it is requested or the free mesher failed. Where both fail, the
  !> error of the free mesher is the one to report.
  subroutine make_free_mesh(old, before, contours, seams, sizes, options, plan, mesh, facts, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
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

end module mesh_choice
