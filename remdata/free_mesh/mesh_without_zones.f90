!> The mesh of a scene without zones, or whose derived zones failed: by the free mesher or Gmsh, in several attempts, checked as
!> every new mesh.
module mesh_without_zones
  use body_outlines, only: find_outlines, outline_t
  use body_seams, only: marks_along_paths, seams_t
  use boundary_curves, only: boundary_curve_t
  use corrected_contours, only: contour_t
  use errors, only: error_t
  use kinds, only: wp
  use new_mesh_check, only: check_new_mesh, mesh_check_t
  use outline_mesh, only: mesh_outlines, mesher_t
  use remesher_options, only: elements_allowed
  use scene, only: scene_t
  use size_field, only: elements_needed, of_squares, size_field_t
  use zone_mesh, only: mesh_settings_t, new_mesh_t
  use zones, only: plan_t
  implicit none
  private
  public :: make_mesh_without_zones

  !> Other sizes give another mesh, when one is of bad shape, has triangles or the mesher fails: factors of refinement; elements
  !> of twice the size that are split are quadrilaterals in any case. The last ones are for corners of a material that run out to
  !> layers thinner than the sizes: how many elements are across them, and where rows of elements end, changes with the size. A row
  !> of one element across ends at such a corner well or with an element that has two sides on a straight line.
  real(wp), parameter :: finer_by(14) = [1.0_wp, 1.05_wp, 1.0_wp, 1.12_wp, 1.12_wp, 1.25_wp, 2.0_wp, 1.4_wp, 0.85_wp, 1.6_wp, &
                                         0.95_wp, 1.16_wp, 0.9_wp, 1.08_wp]
  logical, parameter :: split(14) = [.false., .false., .true., .false., .true., .true., .true., .false., .false., .false., &
                                     .true., .false., .false., .true.]
  !> Where the number of elements is limited other sizes are larger ones, by these factors at most.
  real(wp), parameter :: coarser_by = 1.25_wp
  !> Sizes for a limited number of elements are larger by this than by the number that the sizes need.
  real(wp), parameter :: reserve = 1.02_wp
  !> Elements are untangled below this sine: their corners are not constrained by a grid.
  real(wp), parameter :: least_sine = 0.6_wp
  !> Below this scaled Jacobian a mesh of elements that are longer than wide is compared with one of squares (`better_mesh`).
  real(wp), parameter :: good_shape = 0.6_wp

contains

  !> In `plan` each zone is a body in one piece, or the part of a body that is a group.
  subroutine make_mesh_without_zones(scene, material, contours, seams, sizes, finer, mesher, plan, mesh, check, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)           !! of each group of the scene, as for the sizes (ngroup)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(seams_t), intent(in) :: seams           !! between its bodies
    type(size_field_t), intent(in) :: sizes
    real(wp), intent(in) :: finer   !! requested sizes are divided by this factor
    type(mesher_t), intent(inout) :: mesher
    type(plan_t), intent(out) :: plan
    type(new_mesh_t), intent(out) :: mesh
    type(mesh_check_t), intent(out) :: check
    type(error_t), allocatable, intent(out) :: error
    type(outline_t), allocatable :: outlines(:)
    type(boundary_curve_t) :: boundaries(size(contours))
    type(new_mesh_t) :: squares
    type(mesh_check_t) :: check_of_squares
    type(error_t), allocatable :: no_squares
    integer :: most_elements, c

    call find_outlines(scene, material, contours, outlines, error, seams)
    if (allocated(error)) return
    do c = 1, size(contours)
      boundaries(c) = contours(c)%boundary
    end do
    most_elements = elements_allowed(scene%remesher, finer)
    if (sizes%is_directed .and. .not. mesher%is_gmsh) then
      call try_sizes(contours, boundaries, outlines, seams, sizes, finer, most_elements, 1, mesher, mesh, check, error)
      if (allocated(error)) then
        deallocate (error)
        call try_sizes(contours, boundaries, outlines, seams, of_squares(sizes), finer, most_elements, size(finer_by), &
                       mesher, mesh, check, error)
      else if (check%scaled_jacobian < good_shape) then
        call try_sizes(contours, boundaries, outlines, seams, of_squares(sizes), finer, most_elements, 1, mesher, squares, &
                       check_of_squares, no_squares)
        if (.not. allocated(no_squares) .and. check_of_squares%scaled_jacobian > check%scaled_jacobian) then
          mesh = squares
          check = check_of_squares
        end if
      end if
    else
      call try_sizes(contours, boundaries, outlines, seams, of_squares(sizes), finer, most_elements, size(finer_by), mesher, mesh, &
                     check, error)
    end if
    if (allocated(error)) return
    allocate (plan%points(0), plan%group(size(outlines)))
    allocate (plan%sets(4, size(outlines)), source=0)
    allocate (plan%zones, source=mesh%layout%zones)
    plan%group = outlines%group
    plan%on_seam = marks_along_paths(scene%mesh%sides, contours, seams)
  end subroutine make_mesh_without_zones

  !> So many attempts at most with the same sizes.
  subroutine try_sizes(contours, boundaries, outlines, seams, sizes, finer, most_elements, attempts, mesher, mesh, check, error)
    type(contour_t), intent(in) :: contours(:)             !! (ncontour)
    type(boundary_curve_t), intent(in) :: boundaries(:)    !! (ncontour)
    type(outline_t), intent(in) :: outlines(:)             !! (nbody)
    type(seams_t), intent(in) :: seams
    type(size_field_t), intent(in) :: sizes
    real(wp), intent(in) :: finer
    integer, intent(in) :: most_elements, attempts
    type(mesher_t), intent(inout) :: mesher
    type(new_mesh_t), intent(out) :: mesh
    type(mesh_check_t), intent(out) :: check
    type(error_t), allocatable, intent(out) :: error
    type(mesh_settings_t) :: settings
    real(wp) :: limited
    integer :: attempt

    settings%least_sine = least_sine
    settings%division%most_elements = min(settings%division%most_elements, most_elements)
    limited = reserve*sqrt(elements_needed(sizes)/settings%division%most_elements)
    do attempt = 1, attempts
      if (allocated(error)) deallocate (error)
      settings%division%refine = finer*finer_by(attempt)
      if (limited*settings%division%refine > 1) settings%division%refine = 1/(limited*min(finer_by(attempt), coarser_by))
      call mesh_outlines(boundaries, outlines, sizes, settings, split(attempt), mesher, mesh, error, seams)
      if (.not. allocated(error)) call check_new_mesh(contours, mesh, check, error)
      if (.not. allocated(error) .or. .not. mesher%gmsh%available .or. mesher%gmsh%late) exit
    end do
  end subroutine try_sizes

end module mesh_without_zones
