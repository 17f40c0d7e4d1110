!> Residual of a solution of a linear system, and its backward error.
module linear_residuals
  use kinds, only: wp
  use matrix_pattern, only: matrix_pattern_t
  use vectors, only: length_of
  implicit none
  private
  public :: linear_residual, start_rows

  !> Fewer nonzeros are faster on one thread.
  integer, parameter :: worth_threads = 50000

contains

  !> residual = rhs - A x, and the size of what was summed, |rhs| + |A| |x|: their ratio is the backward error
  !> (W. Oettli, W. Prager, Numer. Math. 6 (1964) 405-409), which a stiff constraint does not spoil.
  subroutine linear_residual(pattern, row_start, a, rhs, x, residual, scale)
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: row_start(:)   !! (neq + 1) nonzeros of row i: row_start(i) ... row_start(i+1)-1
    real(wp), intent(in) :: a(:)          !! (nnz) [residual/unknown]
    real(wp), intent(in) :: rhs(:)        !! (neq) [residual]
    real(wp), intent(in) :: x(:)          !! (neq) [unknown]
    real(wp), intent(out) :: residual(:)  !! (neq) [residual]
    real(wp), intent(out) :: scale        !! [residual]
    real(wp) :: magnitude(size(rhs)), left, large, product
    integer :: k, i, j

    !$omp parallel do private(k, left, large, product) schedule(static) if (pattern%nnz > worth_threads)
    do i = 1, pattern%neq
      left = rhs(i)
      large = abs(rhs(i))
      do k = row_start(i), row_start(i + 1) - 1
        product = a(k)*x(pattern%column(k))
        left = left - product
        large = large + abs(product)
      end do
      residual(i) = left
      magnitude(i) = large
    end do
    !$omp end parallel do
    if (pattern%symmetric) then
      ! the upper triangle, of which the lower one is the mirror
      do k = 1, pattern%nnz
        i = pattern%row(k)
        j = pattern%column(k)
        if (i == j) cycle
        residual(j) = residual(j) - a(k)*x(i)
        magnitude(j) = magnitude(j) + abs(a(k)*x(i))
      end do
    end if
    scale = length_of(magnitude)
  end subroutine linear_residual

  !> Nonzeros are sorted by row: where every row begins (neq + 1).
  pure subroutine start_rows(pattern, row_start)
    class(matrix_pattern_t), intent(in) :: pattern
    integer, allocatable, intent(out) :: row_start(:)   !! (neq + 1)
    integer :: k

    allocate (row_start(pattern%neq + 1), source=0)
    do k = 1, pattern%nnz
      row_start(pattern%row(k) + 1) = row_start(pattern%row(k) + 1) + 1
    end do
    row_start(1) = 1
    do k = 1, pattern%neq
      row_start(k + 1) = row_start(k + 1) + row_start(k)
    end do
  end subroutine start_rows

end module linear_residuals
