!> The mesh of a scene for which there are no zones, or none that fit: Gmsh's, in a few attempts, checked as every new mesh is.
module mesh_without_zones
  use body_outlines, only: find_outlines, outline_t
  use contour_chain, only: chain_t
  use errors, only: error_t
  use gmsh_call, only: gmsh_t
  use kinds, only: wp
  use new_mesh_check, only: check_new_mesh, mesh_check_t
  use outline_mesh, only: mesh_outlines
  use part_contour, only: contour_t
  use scene, only: scene_t
  use size_field, only: size_field_t
  use zone_mesh, only: mesh_wish_t, new_mesh_t
  use zones, only: plan_t
  implicit none
  private
  public :: mesh_freely

  !> Other sizes give another mesh, when one is of bad shape, has triangles or Gmsh fails on it: so many times finer; and elements
  !> twice as large, split, are quadrilaterals in any case.
  real(wp), parameter :: finer_by(7) = [1.0_wp, 1.05_wp, 1.0_wp, 1.12_wp, 1.12_wp, 1.25_wp, 2.0_wp]
  logical, parameter :: split(7) = [.false., .false., .true., .false., .true., .true., .true.]
  !> Elements are mended below this: nothing but their corners holds lines that follow no grid.
  real(wp), parameter :: least_sine = 0.6_wp

contains

  !> `plan` tells what is made of each zone, which here is a body in one piece.
  subroutine mesh_freely(scene, material, contours, sizes, finer, gmsh, plan, mesh, check, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)             !! of each group of the scene, as sizes are asked for it (ngroup)
    type(contour_t), intent(in) :: contours(:)
    type(size_field_t), intent(in) :: sizes
    real(wp), intent(in) :: finer                  !! wanted sizes are divided by this
    type(gmsh_t), intent(inout) :: gmsh
    type(plan_t), intent(out) :: plan
    type(new_mesh_t), intent(out) :: mesh
    type(mesh_check_t), intent(out) :: check
    type(error_t), allocatable, intent(out) :: error
    type(outline_t), allocatable :: outlines(:)
    type(mesh_wish_t) :: wish
    type(chain_t) :: chains(size(contours))
    integer :: attempt, c

    call find_outlines(scene, material, contours, outlines, error)
    if (allocated(error)) return
    do c = 1, size(contours)
      chains(c) = contours(c)%chain
    end do
    wish%least_sine = least_sine
    if (scene%remesher%most_elements > 0) wish%division%most_elements = scene%remesher%most_elements
    do attempt = 1, size(finer_by)
      if (allocated(error)) deallocate (error)
      wish%division%refine = finer*finer_by(attempt)
      call mesh_outlines(chains, outlines, sizes, wish, split(attempt), gmsh, mesh, error)
      if (.not. allocated(error)) call check_new_mesh(contours, mesh, check, error)
      if (.not. allocated(error) .or. .not. gmsh%is_there .or. gmsh%late) exit
    end do
    if (allocated(error)) return
    allocate (plan%points(0), plan%group(size(outlines)))
    allocate (plan%sets(4, size(outlines)), source=0)
    allocate (plan%zones, source=mesh%layout%zones)
    plan%group = outlines%group
  end subroutine mesh_freely

end module mesh_without_zones
