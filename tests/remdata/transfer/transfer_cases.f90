!> Meshes of 8-node elements and fields for the tests of the state transfer.
module transfer_cases
  use errors, only: error_t
  use kinds, only: pi, wp
  use state_pieces, only: mesh_of, state_pieces_t
  use transfer_api, only: transfer_options_t
  use transfer_mesh, only: build_mesh_trees, set_up_mesh, transfer_mesh_t
  use transfer_report, only: transfer_report_t
  use transfer_states, only: carry_states
  implicit none
  private
  public :: square_grid, one_material, ring_sector, polynomial, carry_pieces

contains

  !> A unit square in nx x ny elements. Inside, corners are moved by `bend` of an element and sides bulge by half as much; the
  !> boundary stays straight, its nodes at even distances, mid nodes in the middle.
  pure subroutine square_grid(nx, ny, bend, nodes, connectivity)
    integer, intent(in) :: nx, ny
    real(wp), intent(in) :: bend
    real(wp), allocatable, intent(out) :: nodes(:, :)
    integer, allocatable, intent(out) :: connectivity(:, :)
    integer :: number(0:2*nx, 0:2*ny), i, j, n
    real(wp) :: move(2)

    allocate (nodes(2, (nx + 1)*(ny + 1) + nx*(ny + 1) + ny*(nx + 1)), connectivity(8, nx*ny))
    n = 0
    number = 0
    do j = 0, 2*ny
      do i = 0, 2*nx
        if (mod(i, 2) == 1 .and. mod(j, 2) == 1) cycle
        n = n + 1
        number(i, j) = n
        ! neither smooth nor periodic: each node has a move of its own
        move = bend*[cos(12.9898_wp*i + 78.233_wp*j), sin(39.425_wp*i - 57.17_wp*j)]/[nx, ny]
        if (mod(i, 2) == 1 .or. mod(j, 2) == 1) move = 0.5_wp*move
        if (i == 0 .or. i == 2*nx .or. j == 0 .or. j == 2*ny) move = 0
        nodes(:, n) = move
        if (mod(i, 2) == 0 .and. mod(j, 2) == 0) nodes(:, n) = move + [real(i, wp)/(2*nx), real(j, wp)/(2*ny)]
      end do
    end do
    do j = 0, 2*ny
      do i = 0, 2*nx
        if (mod(i + j, 2) == 0) cycle
        associate (a => number(i - mod(i, 2), j - mod(j, 2)), b => number(i + mod(i, 2), j + mod(j, 2)))
          nodes(:, number(i, j)) = nodes(:, number(i, j)) + 0.5_wp*(nodes(:, a) + nodes(:, b))
        end associate
      end do
    end do
    n = 0
    do j = 0, 2*ny - 2, 2
      do i = 0, 2*nx - 2, 2
        n = n + 1
        connectivity(:, n) = [number(i, j), number(i + 2, j), number(i + 2, j + 2), number(i, j + 2), &
                              number(i + 1, j), number(i + 2, j + 1), number(i + 1, j + 2), number(i, j + 1)]
      end do
    end do
  end subroutine square_grid

  !> A quarter of a ring of radii 1 and 2, in nr x nt elements with bulging sides, its nodes on the circles.
  pure subroutine ring_sector(nr, nt, nodes, connectivity)
    integer, intent(in) :: nr, nt
    real(wp), allocatable, intent(out) :: nodes(:, :)
    integer, allocatable, intent(out) :: connectivity(:, :)
    integer :: k

    call square_grid(nr, nt, 0.0_wp, nodes, connectivity)
    do k = 1, size(nodes, 2)
      nodes(:, k) = (1 + nodes(1, k))*[cos(0.5_wp*pi*nodes(2, k)), sin(0.5_wp*pi*nodes(2, k))]
    end do
  end subroutine ring_sector

  !> A mesh of one material with its trees.
  pure subroutine one_material(nodes, connectivity, npoint, mesh)
    real(wp), intent(in) :: nodes(:, :)
    integer, intent(in) :: connectivity(:, :), npoint
    type(transfer_mesh_t), intent(out) :: mesh
    integer :: n

    n = size(connectivity, 2)
    call set_up_mesh(nodes, connectivity, spread(1, 1, n), spread(npoint, 1, n), .false., mesh)
    call build_mesh_trees(mesh)
  end subroutine one_material

  !> 2 + 3 x - 5 y, and with degree 2 also + 4 x^2 - 7 x y + 6 y^2.
  pure function polynomial(degree, points) result(values)
    integer, intent(in) :: degree
    real(wp), intent(in) :: points(:, :)
    real(wp) :: values(size(points, 2))

    values = 2
    if (degree > 0) values = values + 3*points(1, :) - 5*points(2, :)
    if (degree > 1) values = values + 4*points(1, :)**2 - 7*points(1, :)*points(2, :) + 6*points(2, :)**2
  end function polynomial

  !> The states of groups carried to others, by way of the meshes they make.
  subroutine carry_pieces(old, new, options, report, error)
    type(state_pieces_t), intent(in) :: old
    type(state_pieces_t), intent(inout) :: new
    type(transfer_options_t), intent(in) :: options
    type(transfer_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(transfer_mesh_t) :: from, to

    call mesh_of(old, from)
    call mesh_of(new, to)
    call build_mesh_trees(from)
    call carry_states(from, to, old, new, options, report, error)
  end subroutine carry_pieces

end module transfer_cases
