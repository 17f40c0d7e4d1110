!> Method 2: integration points -> nodes by recovery on patches -> new points by shape functions.
!>
!> Source: O.C. Zienkiewicz, J.Z. Zhu, Int. J. Numer. Methods Eng. 33 (1992) 1331-1364. A polynomial is fitted to the points of the
!> elements around a node, by plain least squares; here a mid-side node has a patch of its own, the elements around both
!> ends of its side. Patches stay within a material: a node between two of them has a value in each. Where a patch does not
!> determine the polynomial, or only by extrapolation (at a boundary), the elements around it are added.
module transfer_patches
  use errors, only: error_t
  use kinds, only: wp
  use local_fit, only: fit_polynomial, max_terms, most_amplified, terms_of
  use patch_nodes, only: around_node, number_nodes, patch_nodes_t, widen
  use transfer_api, only: transfer_options_t, transfer_t
  use transfer_map, only: append_rows, start_rows, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  use transfer_nodes, only: shape_weights
  implicit none
  private
  public :: transfer_patches_row

  !> Rings of elements a patch may have.
  integer, parameter :: rings = 3
  !> Most elements and points of a patch: three rings in a grid of 2 x 2 points are 36 and 144.
  integer, parameter :: most_elements = 64, most_points = 576
  !> Nodes whose rows are appended to the map at once.
  integer, parameter :: block = 512

contains

  function transfer_patches_row() result(row)
    type(transfer_t) :: row

    row%name = 'PATCHES'
    row%purpose = 'recovery at the nodes from patches of elements, then shape functions'
    row%number = 2
    row%exact_degree = 1
    row%weights => weights
  end function transfer_patches_row

  subroutine weights(mesh, options, points, material, map, error)
    type(transfer_mesh_t), intent(in) :: mesh
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(in) :: points(:, :)
    integer, intent(in) :: material(:)
    type(transfer_map_t), intent(out) :: map
    type(error_t), allocatable, intent(out) :: error
    type(patch_nodes_t) :: nodes
    integer, allocatable :: source(:, :)
    real(wp), allocatable :: weight(:, :)
    integer, allocatable :: degree(:)
    integer :: used(block), first, k, n, p

    call number_nodes(mesh, nodes)
    call shape_weights(mesh, nodes%entries, points, material, options%outside, map, error)
    if (allocated(error)) return
    n = size(nodes%node)
    allocate (map%nodal)
    call start_rows(n, map%nodal)
    allocate (source(most_points, block), weight(most_points, block))
    allocate (degree(n))
    do first = 0, n - 1, block
      !$omp parallel do schedule(static)
      do k = 1, min(block, n - first)
        call recover(mesh, nodes, first + k, options%degree, source(:, k), weight(:, k), used(k), degree(first + k))
      end do
      !$omp end parallel do
      call append_rows(first, source, weight, used(:min(block, n - first)), map%nodal)
    end do
    do p = 1, size(material)
      map%degree(p) = minval(degree(map%source(map%first(p):map%first(p + 1) - 1)))
    end do
  end subroutine weights

  !> Weights of the value at one node: the first coefficient of the polynomial about it. More rings, then a lower degree.
  pure subroutine recover(mesh, nodes, node, highest, source, weight, used, degree)
    type(transfer_mesh_t), intent(in) :: mesh
    type(patch_nodes_t), intent(in) :: nodes
    integer, intent(in) :: node, highest
    integer, intent(out) :: source(:)
    real(wp), intent(out) :: weight(:)
    integer, intent(out) :: used, degree
    integer :: elements(most_elements), n, ring, before
    logical :: determined

    do degree = highest, 0, -1
      call around_node(nodes, node, elements, n)
      do ring = 1, rings
        call points_of(mesh, elements(:n), source, used)
        call fit_at(mesh%points, source(:used), mesh%nodes(:, nodes%node(node)), degree, weight(:used), determined)
        if (determined) return
        before = n
        call widen(nodes, elements, n)
        if (n == before) exit
      end do
    end do
    degree = 0
  end subroutine recover

  !> Points of some elements, as many as there is room for.
  pure subroutine points_of(mesh, elements, source, used)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: elements(:)
    integer, intent(out) :: source(:), used
    integer :: k, p

    source = 0
    used = 0
    do k = 1, size(elements)
      do p = mesh%first_point(elements(k)), mesh%first_point(elements(k) + 1) - 1
        if (used == size(source)) return
        used = used + 1
        source(used) = p
      end do
    end do
  end subroutine points_of

  !> Weights of the value at a point of the polynomial fitted to some integration points.
  pure subroutine fit_at(points, source, centre, degree, weight, determined)
    real(wp), intent(in) :: points(:, :), centre(2)
    integer, intent(in) :: source(:), degree
    real(wp), intent(out) :: weight(:)
    logical, intent(out) :: determined
    real(wp) :: local(2, size(source)), ones(size(source)), fit(max_terms, size(source)), reach

    local = points(:, source) - spread(centre, 2, size(source))
    reach = sqrt(maxval(sum(local**2, 1)))
    ones = 1
    call fit_polynomial(local/reach, ones, terms_of(degree), fit, determined)
    weight = fit(1, :)
    if (degree > 0) determined = determined .and. sum(abs(weight)) <= most_amplified
  end subroutine fit_at

end module transfer_patches
