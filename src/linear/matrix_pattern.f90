!> Where a sparse matrix has its nonzeros.
module matrix_pattern
  implicit none
  private
  public :: matrix_pattern_t

  type :: matrix_pattern_t
    integer :: neq = 0, nnz = 0
    logical :: symmetric = .false.
    !> Row and column of each nonzero, sorted by row; the lower triangle only when symmetric (nnz).
    integer, allocatable :: row(:), column(:)
  end type matrix_pattern_t
end module matrix_pattern
