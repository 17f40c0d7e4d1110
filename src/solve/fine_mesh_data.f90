!> The mesh twice as fine of bodies that conduct heat (fine_mesh), as data.
module fine_mesh_data
  use kinds, only: wp
  implicit none
  private
  public :: fine_mesh_t

  type :: fine_mesh_t
    !> Elements of the mesh that are cut in four; nodes of the mesh and centres of the elements of all bodies.
    integer :: nelement = 0, nnode = 0
    !> Nodes of an element: corners, middles of sides, centre (9, nelement); its group and its place there (nelement).
    integer, allocatable :: nodes(:, :), group(:), element(:)
    !> Ends of the side whose middle a node of the mesh is, 0 for others (2, nnode of the mesh).
    integer, allocatable :: ends(:, :)
    !> Middles of sides of one element alone (noutside), and the areas of their first end, middle and second end (3, noutside)
    !> [area].
    integer, allocatable :: outside(:)
    !> Place of a node of the mesh among these, 0 for others (nnode of the mesh).
    integer, allocatable :: side(:)
    real(wp), allocatable :: area(:, :)
    !> Volume of a node in an element (9, nelement) [volume]; matrices of the quarters at a conductivity of 1 (4, 4, 4, nelement)
    !> [volume/length^2].
    real(wp), allocatable :: volume(:, :), conduction(:, :, :, :)
    !> Least heat capacity of the materials of groups that hold latent heat, 0 for others (ngroup) [energy/length^3/temperature].
    real(wp), allocatable :: least(:)
    !> Group of a node that holds latent heat, 0 for others (nnode).
    integer, allocatable :: latent(:)
  end type fine_mesh_t

end module fine_mesh_data
