!> Rigid dies among the results, as a grid of their own: three nodes a piece where the pilots are.
module result_dies
  use dies, only: die_t, is_deformable
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use plane_vectors, only: turned
  use xdmf_grid, only: xdmf_field_t, xdmf_grid_t
  implicit none
  private
  public :: write_die_topology, put_dies

contains

  !> Into the file of the mesh: nodes of the pieces, counted from 0 (end, end, middle), and the number of the die of each, among the
  !> rigid ones in the order of the deck.
  subroutine write_die_topology(file, dies)
    type(hdf5_file_t), intent(inout) :: file
    type(die_t), intent(in) :: dies(:)   !! (ndie)
    integer, allocatable :: nodes(:, :), number(:)
    integer :: d, k, npiece, n

    npiece = pieces_of(dies)
    if (npiece == 0) return
    allocate (nodes(3, npiece), number(npiece))
    npiece = 0
    n = 0
    do d = 1, size(dies)
      if (is_deformable(dies(d))) cycle
      n = n + 1
      do k = 1, size(dies(d)%pieces, 3)
        nodes(:, npiece + 1) = 3*npiece + [0, 2, 1]
        npiece = npiece + 1
        number(npiece) = n
      end do
    end do
    call file%write('mesh/die_topology', nodes)
    call file%write('mesh/die_number', number)
  end subroutine write_die_topology

  !> Into the file of an instant: where the points of the pieces are. `grid` has no nodes where there is no rigid die.
  subroutine put_dies(file, dies, pilots, instant, grid)
    type(hdf5_file_t), intent(inout) :: file
    type(die_t), intent(in) :: dies(:)          !! (ndie)
    real(wp), intent(in) :: pilots(:, :)        !! (3, ndie) x, y, angle [length and radian]
    type(xdmf_grid_t), intent(in) :: instant    !! its time and files
    type(xdmf_grid_t), intent(out) :: grid
    real(wp), allocatable :: x(:, :)
    integer :: d, k, i, n

    grid%nelement = pieces_of(dies)
    if (grid%nelement == 0) return
    allocate (x(2, 3*grid%nelement))
    n = 0
    do d = 1, size(dies)
      if (is_deformable(dies(d))) cycle
      do k = 1, size(dies(d)%pieces, 3)
        do i = 1, 3
          n = n + 1
          x(:, n) = pilots(1:2, d) + turned(dies(d)%pieces(:, i, k), pilots(3, d))
        end do
      end do
    end do
    call file%write('die_coordinates', x)
    call file%write_attribute('die_coordinates', 'unit', 'length')
    grid%label = 'dies'
    grid%time = instant%time
    grid%file = instant%file
    grid%mesh_file = instant%mesh_file
    grid%geometry = 'die_coordinates'
    grid%nnode = n
    grid%topology = 'mesh/die_topology'
    grid%shape = 'Edge_3'
    grid%nodes_per_element = 3
    allocate (grid%fields(1))
    grid%fields(1) = xdmf_field_t('die', 'Cell', 'Scalar', 'mesh/die_number', is_integer=.true., of_mesh=.true.)
  end subroutine put_dies

  !> Pieces of all rigid dies.
  pure function pieces_of(dies) result(n)
    type(die_t), intent(in) :: dies(:)   !! (ndie)
    integer :: n
    integer :: d

    n = 0
    do d = 1, size(dies)
      if (.not. is_deformable(dies(d))) n = n + size(dies(d)%pieces, 3)
    end do
  end function pieces_of

end module result_dies
