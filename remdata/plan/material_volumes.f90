!> Check that a new mesh keeps the volume of every material and the interfaces between materials.
module material_volumes
  use boundary_curves, only: boundary_curve_t, boundary_length, closest_position, point_on
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use state_pieces, only: mesh_of, solid_pieces, state_pieces_t
  use text, only: to_text
  use transfer_mesh, only: set_up_mesh, transfer_mesh_t
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  use zone_node_numbers, only: ends_of_side, middles_of_side, node_numbers_t, number_nodes
  use zones, only: plan_t
  implicit none
  private
  public :: material_volume_t, materials_kept_t, compare_materials, off_interfaces

  !> A material by the name of its first body: bodies of one material that share nodes count as one.
  type :: material_volume_t
    character(len=:), allocatable :: name
    !> In the old mesh and in the new one, per unit thickness or per radian [length^2 or length^3].
    real(wp) :: before = 0.0_wp, after = 0.0_wp
  end type material_volume_t

  !> Changes of the materials by a new mesh.
  type :: materials_kept_t
    type(material_volume_t), allocatable :: volumes(:)
    !> Largest distance of a node of an interface from it, divided by the length of its path.
    real(wp) :: off_interface = 0.0_wp
  end type materials_kept_t

  !> Relative change of volume that is allowed for a material.
  real(wp), parameter :: largest_change = 1.0e-3_wp
  !> Tolerance of nodes on the interface, as a share of its length.
  real(wp), parameter :: on_interface = 1.0e-9_wp
  !> Exact for the volume of 8-node elements, around an axis too: degree 5 in each direction.
  integer, parameter :: rule = 9

contains

  !> Volume of each material.
  pure function volumes_of(nodes, connectivity, material, nmaterial, axisymmetric) result(volumes)
    real(wp), intent(in) :: nodes(:, :)         !! (2, nnode) [length]
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    integer, intent(in) :: material(:)          !! (nelem)
    integer, intent(in) :: nmaterial
    logical, intent(in) :: axisymmetric
    real(wp) :: volumes(nmaterial)
    type(transfer_mesh_t) :: mesh
    integer :: m

    call set_up_mesh(nodes, connectivity, material, spread(rule, 1, size(material)), axisymmetric, mesh)
    volumes = [(sum(mesh%volumes, mesh%point_material == m), m=1, nmaterial)]
  end function volumes_of

  !> Largest distance of a node of an interface from it, over its length.
  pure function off_interfaces(mesh) result(worst)
    type(new_mesh_t), intent(in) :: mesh
    real(wp) :: worst
    type(node_numbers_t) :: numbers
    integer, allocatable :: nodes(:)
    integer :: s

    worst = 0
    if (allocated(mesh%seams)) then
      do s = 1, size(mesh%seams)
        call compare(mesh%seams(s)%nodes, mesh%layout%paths(mesh%seams(s)%path))
      end do
      return
    end if
    numbers = number_nodes(mesh%layout, mesh%division)
    do s = 1, size(mesh%layout%sides)
      if (mesh%layout%sides(s)%path == 0) cycle
      nodes = [ends_of_side(mesh%layout, mesh%division, numbers, s), middles_of_side(mesh%division, numbers, s)]
      call compare(nodes, mesh%layout%paths(mesh%layout%sides(s)%path))
    end do

  contains

    pure subroutine compare(along, path)
      integer, intent(in) :: along(:)
      type(boundary_curve_t), intent(in) :: path
      integer :: k

      do k = 1, size(along)
        associate (x => mesh%coordinates(:, along(k)))
          worst = max(worst, length_of(point_on(path, closest_position(path, x)) - x)/boundary_length(path))
        end associate
      end do
    end subroutine compare

  end function off_interfaces

  !> Volumes in both meshes, where materials share sides. A mesh is refused in which a material has lost its interface, or too much
  !> of its volume.
  subroutine compare_materials(scene, solution, plan, mesh, kept, error)
    type(scene_t), intent(in) :: scene   !! old
    type(solution_t), intent(in) :: solution
    type(plan_t), intent(in) :: plan
    type(new_mesh_t), intent(in) :: mesh
    type(materials_kept_t), intent(out) :: kept
    type(error_t), allocatable, intent(out) :: error
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: old
    real(wp), allocatable :: before(:), after(:)
    logical, allocatable :: used(:)
    integer :: k, m

    allocate (kept%volumes(0))
    if (.not. any(mesh%layout%sides%path > 0)) return
    call solid_pieces(scene, pieces, solution)
    call mesh_of(pieces, old)
    before = volumes_of(old%nodes, old%connectivity, old%material, old%nmaterial, pieces%axisymmetric)
    after = volumes_of(mesh%coordinates, mesh%connectivity, plan%zones(mesh%zone)%material, old%nmaterial, pieces%axisymmetric)
    used = before > 0
    deallocate (kept%volumes)
    allocate (kept%volumes(count(used)))
    k = 0
    do m = 1, old%nmaterial
      if (.not. used(m)) cycle
      k = k + 1
      ! the number of a material is that of its first body
      kept%volumes(k)%name = scene%groups(pieces%groups(m)%scene_group)%name
      kept%volumes(k)%before = before(m)
      kept%volumes(k)%after = after(m)
    end do
    kept%off_interface = off_interfaces(mesh)
    call check_volumes(kept, error)
  end subroutine compare_materials

  subroutine check_volumes(kept, error)
    type(materials_kept_t), intent(in) :: kept
    type(error_t), allocatable, intent(out) :: error
    integer :: k

    if (kept%off_interface > on_interface) then
      call fail(error, exit_no_convergence, 'remdata: nodes lie off the interface between materials by '// &
                to_text(kept%off_interface, 3)//' of its length')
      return
    end if
    do k = 1, size(kept%volumes)
      associate (volume => kept%volumes(k))
        if (abs(volume%after - volume%before) <= largest_change*volume%before) cycle
        call fail(error, exit_no_convergence, 'remdata: the new mesh changes the volume of '//volume%name//' by ' &
                  //to_text(100*(volume%after/volume%before - 1), 3)//' %, expected at most ' &
                  //to_text(100*largest_change, 3)//' %', &
                  'allow smaller elements (REMSH SIZE), or remesh earlier')
        return
      end associate
    end do
  end subroutine check_volumes

end module material_volumes
