!> Where a sparse matrix has its nonzeros.
module matrix_pattern
  use kinds, only: wp
  implicit none
  private
  public :: add_to_diagonal, matrix_pattern_t

  type :: matrix_pattern_t
    integer :: neq = 0, nnz = 0
    logical :: symmetric = .false.
    !> Row and column of each nonzero, sorted by row; the lower triangle only when symmetric (nnz).
    integer, allocatable :: row(:), column(:)
  end type matrix_pattern_t

contains

  !> Add to the diagonal of a matrix.
  pure subroutine add_to_diagonal(pattern, diagonal, values)
    class(matrix_pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: diagonal(0:)   !! (0:neq), 0 stands for no equation [residual/unknown]
    real(wp), intent(inout) :: values(:)   !! (nnz) [residual/unknown]
    integer :: k

    do k = 1, pattern%nnz
      if (pattern%row(k) == pattern%column(k)) values(k) = values(k) + diagonal(pattern%row(k))
    end do
  end subroutine add_to_diagonal

end module matrix_pattern
