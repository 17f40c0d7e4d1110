!> Matrices of a grid of nodes with two unknowns each, coupled to the eight neighbours, and an order by nested dissection.
module grid_matrix
  use kinds, only: wp
  use sample_numbers, only: sample_t
  use sparsity, only: pattern_t
  implicit none
  private
  public :: grid_pattern, grid_values, dissect

contains

  !> Pattern of nx x ny nodes; unknowns 2k-1 and 2k belong to node k = i + (j-1) nx.
  subroutine grid_pattern(nx, ny, symmetric, pattern)
    integer, intent(in) :: nx, ny
    logical, intent(in) :: symmetric
    type(pattern_t), intent(out) :: pattern
    integer :: r, c, i, j, ii, jj, k

    pattern%neq = 2*nx*ny
    pattern%symmetric = symmetric
    allocate (pattern%row(18*pattern%neq), pattern%column(18*pattern%neq))
    do r = 1, pattern%neq
      i = mod((r - 1)/2, nx) + 1
      j = (r - 1)/(2*nx) + 1
      do jj = max(j - 1, 1), min(j + 1, ny)
        do ii = max(i - 1, 1), min(i + 1, nx)
          do k = 1, 2
            c = 2*(ii - 1 + (jj - 1)*nx) + k
            if (symmetric .and. c > r) cycle
            pattern%nnz = pattern%nnz + 1
            pattern%row(pattern%nnz) = r
            pattern%column(pattern%nnz) = c
          end do
        end do
      end do
    end do
    pattern%row = pattern%row(:pattern%nnz)
    pattern%column = pattern%column(:pattern%nnz)
  end subroutine grid_pattern

  !> Nonzeros between -1 and 1, diagonals that need no pivoting.
  subroutine grid_values(pattern, sample, values)
    type(pattern_t), intent(in) :: pattern
    type(sample_t), intent(inout) :: sample
    real(wp), allocatable, intent(out) :: values(:)

    allocate (values(pattern%nnz))
    call sample%fill(-1.0_wp, 1.0_wp, values)
    where (pattern%row == pattern%column) values = values + 20
  end subroutine grid_values

  !> Place of every unknown: both halves of the grid first, then the line between them.
  recursive subroutine dissect(nx, i1, i2, j1, j2, position, last)
    integer, intent(in) :: nx, i1, i2, j1, j2
    integer, intent(inout) :: position(:), last
    integer :: i, j, k

    if (i1 > i2 .or. j1 > j2) return
    if (max(i2 - i1, j2 - j1) < 2) then
      call take(i1, i2, j1, j2)
    else if (i2 - i1 >= j2 - j1) then
      k = (i1 + i2)/2
      call dissect(nx, i1, k - 1, j1, j2, position, last)
      call dissect(nx, k + 1, i2, j1, j2, position, last)
      call take(k, k, j1, j2)
    else
      k = (j1 + j2)/2
      call dissect(nx, i1, i2, j1, k - 1, position, last)
      call dissect(nx, i1, i2, k + 1, j2, position, last)
      call take(i1, i2, k, k)
    end if

  contains

    subroutine take(ia, ib, ja, jb)
      integer, intent(in) :: ia, ib, ja, jb
      integer :: d

      do j = ja, jb
        do i = ia, ib
          do d = 1, 2
            last = last + 1
            position(2*(i - 1 + (j - 1)*nx) + d) = last
          end do
        end do
      end do
    end subroutine take

  end subroutine dissect

end module grid_matrix
