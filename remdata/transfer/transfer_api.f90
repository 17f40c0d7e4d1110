!> The transfer family: methods that carry values at the integration points of a mesh to the points of another one.
module transfer_api
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: to_text
  use transfer_map, only: transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: transfer_t, transfer_options_t, transfer_weights_i, check_materials
  public :: limit_none, limit_material, limit_sources

  !> Limits of a value: none, the range of its material in the old mesh, or that of the old points it is computed from.
  integer, parameter :: limit_none = 0, limit_material = 1, limit_sources = 2

  type :: transfer_options_t
    !> Number of the method. Of 100 transfers there and back moving squares of degree 2 lose least (tests/bench/transfer_study.py).
    integer :: method = 1
    !> N of 1/R^N, and number of points.
    real(wp) :: exponent = 2.0_wp
    integer :: nearest = 8
    !> Points of moving least squares: with less than 12 errors grow from transfer to transfer, with more peaks are flattened
    !> (tests/bench/README.md); degree (0, 1, 2) of it and of the patches.
    integer :: neighbours = 16
    integer :: degree = 2
    !> How far an element is extrapolated beyond the contour, in halves of an element.
    real(wp) :: outside = 0.5_wp
    !> Range that scalars of the history are kept in.
    integer :: limit = limit_material
    !> Correct scalars and fractions so that their means over the volume of a material stay.
    logical :: conserve = .true.
    !> Materials a part of which was cut off between the meshes (nmaterial), none where not allocated: means of the whole are none
    !> of what is left, however little is gone.
    logical, allocatable :: cut(:)
  contains
    procedure, public :: was_cut
  end type transfer_options_t

  !> One method. Its index in the list is its number + 1.
  type :: transfer_t
    character(len=:), allocatable :: name, purpose
    !> Number on the card.
    integer :: number = 0
    !> Degree of the fields that are transferred exactly: 0 constant, 1 linear, 2 quadratic.
    integer :: exact_degree = 0
    procedure(transfer_weights_i), nopass, pointer :: weights => null()
  end type transfer_t

  abstract interface
    !> Weights for new points, each computed from old points of its material only.
    subroutine transfer_weights_i(mesh, options, points, material, map, error)
      import :: error_t, transfer_map_t, transfer_mesh_t, transfer_options_t, wp
      type(transfer_mesh_t), intent(in) :: mesh   !! the old one, with its trees
      type(transfer_options_t), intent(in) :: options
      real(wp), intent(in) :: points(:, :)   !! (2, n) of the new mesh [length]
      integer, intent(in) :: material(:)     !! (n)
      type(transfer_map_t), intent(out) :: map
      type(error_t), allocatable, intent(out) :: error
    end subroutine transfer_weights_i
  end interface

contains

  !> A part of the material was cut off between the meshes.
  pure function was_cut(options, material) result(yes)
    class(transfer_options_t), intent(in) :: options
    integer, intent(in) :: material
    logical :: yes

    yes = .false.
    if (allocated(options%cut)) yes = options%cut(material)
  end function was_cut

  !> Every material of the new points must have points in the old mesh.
  pure subroutine check_materials(mesh, material, error)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material(:)   !! (npoint) of the new points
    type(error_t), allocatable, intent(out) :: error
    integer :: p

    do p = 1, size(material)
      if (material(p) >= 1 .and. material(p) <= mesh%nmaterial) then
        if (mesh%point_trees(material(p))%n > 0) cycle
      end if
      call fail(error, exit_input, 'state transfer: material '//to_text(material(p)) &
                //' is in the new mesh, but no element of the old mesh is made of it')
      return
    end do
  end subroutine check_materials

end module transfer_api
