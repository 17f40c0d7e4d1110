!> Small meshes for the tests of estimates.
module mesh_cases
  use block_mesh, only: block_t, mesh_block, side_parabola
  use kinds, only: wp
  implicit none
  private
  public :: distorted_block

contains

  !> A block of nx x ny elements with no straight angle, one curved side, graded.
  subroutine distorted_block(nx, ny, coordinates, connectivity)
    integer, intent(in) :: nx, ny
    real(wp), allocatable, intent(out) :: coordinates(:, :)
    integer, allocatable, intent(out) :: connectivity(:, :)
    type(block_t) :: block
    integer, allocatable :: side_nodes(:, :)
    integer :: first(5)

    block%corners = reshape([0.1_wp, 0.0_wp, 3.4_wp, 0.4_wp, 3.0_wp, 2.9_wp, -0.2_wp, 2.2_wp], [2, 4])
    block%divisions = [nx, ny]
    block%ratios = [1.6_wp, 0.7_wp]
    block%form(2) = side_parabola
    block%point(:, 2) = [3.6_wp, 1.5_wp]
    call mesh_block(block, coordinates, connectivity, first, side_nodes)
  end subroutine distorted_block

end module mesh_cases
