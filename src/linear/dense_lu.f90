!> Elimination of the pivots of one dense front, in blocks of pivots and without pivoting: for A = [P R; Q C] the inverse of P, the
!> rows U = P^-1 R and the border C - Q U; Q stays as it is.
!>
!> A block LU factorisation (J.W. Demmel, N.J. Higham, R.S. Schreiber, Numer. Linear Algebra Appl. 2 (1995) 173-190): all work is
!> in matrix products, also that of a solve; triangular solves of few rows reach a fifth of the speed of products. Blocks are
!> so small that their inverses cost no accuracy (backward errors of 1e-16 in tests/solve). They are found pivot by pivot: a
!> symmetric matrix has as many eigenvalues below 0 as there are pivots below 0 (law of inertia: G.H. Golub, C.F. Van Loan, Matrix
!> Computations, 4th ed., 2013, sec. 8.1.5).
!>
!> Columns are cut into strips of fixed width, and a thread does whole strips: results do not depend on the number of threads.
module dense_lu
  use blas, only: gemm => dgemm
  use kinds, only: rk => wp
  implicit none
  private
  public :: eliminate, eliminate_shared

  !> Most pivots of a block; of one that is inverted pivot by pivot; width of the strips threads share.
  integer, parameter, public :: block = 32
  integer, parameter :: narrow = 8, strip = 64

contains

  !> One thread. `regular` becomes false when a pivot is zero or NaN; `negative` pivots are counted.
  subroutine eliminate(p, n, pivot, row, border, regular, negative)
    integer, intent(in) :: p, n                     !! pivots, order
    real(rk), intent(inout) :: pivot(n, p)          !! pivot columns [residual/unknown]; inverses of their blocks and U there
    real(rk), intent(inout) :: row(p, n - p)        !! rest of the pivot rows [residual/unknown]; U there
    real(rk), intent(out) :: border(n - p, n - p)   !! what elimination adds to the border [residual/unknown]
    logical, intent(inout) :: regular
    integer, intent(inout) :: negative
    integer :: k, w

    do k = 1, p, block
      w = min(block, p - k + 1)
      call invert(w, pivot(k, k), n, regular, negative)
      if (.not. regular) return
      if (k + w <= p) call reduce_block(w, p - k - w + 1, n - k + 1, pivot(k, k), n, pivot(k, k + w), n)
    end do
    if (n > p) call reduce_strip(p, n, pivot, n - p, row, border)
  end subroutine eliminate

  !> The same by all threads of the team, called by one of them.
  subroutine eliminate_shared(p, n, pivot, row, border, regular, negative)
    integer, intent(in) :: p, n
    real(rk), intent(inout) :: pivot(n, p)          !! pivot columns [residual/unknown]
    real(rk), intent(inout) :: row(p, n - p)        !! rest of the pivot rows [residual/unknown]
    real(rk), intent(out) :: border(n - p, n - p)   !! [residual/unknown]
    logical, intent(inout) :: regular
    integer, intent(inout) :: negative
    integer :: k, w, j

    do k = 1, p, block
      w = min(block, p - k + 1)
      call invert(w, pivot(k, k), n, regular, negative)
      if (.not. regular) return
      do j = k + w, p, strip
        !$omp task default(shared) firstprivate(j, k, w)
        call reduce_block(w, min(strip, p - j + 1), n - k + 1, pivot(k, k), n, pivot(k, j), n)
        !$omp end task
      end do
      !$omp taskwait
    end do
    do j = 1, n - p, strip
      !$omp task default(shared) firstprivate(j)
      call reduce_strip(p, n, pivot, min(strip, n - p - j + 1), row(1, j), border(1, j))
      !$omp end task
    end do
    !$omp taskwait
  end subroutine eliminate_shared

  !> Columns beside the pivots: U by all blocks, and what it adds to the border.
  subroutine reduce_strip(p, n, pivot, ncol, row, border)
    integer, intent(in) :: p, n, ncol
    real(rk), intent(in) :: pivot(n, p)
    real(rk), intent(inout) :: row(p, ncol)
    real(rk), intent(out) :: border(n - p, ncol)
    integer :: k

    do k = 1, p, block
      call reduce_block(min(block, p - k + 1), ncol, p - k + 1, pivot(k, k), n, row(k, 1), p)
    end do
    call gemm('N', 'N', n - p, ncol, p, -1.0_rk, pivot(p + 1, 1), n, row, p, 0.0_rk, border, n - p)
  end subroutine reduce_strip

  !> Columns `b` of m rows by one block of w pivots: its rows U, and those below them less Q U.
  subroutine reduce_block(w, ncol, m, pivot, ldp, b, ldb)
    integer, intent(in) :: w, ncol, m, ldp, ldb
    real(rk), intent(in) :: pivot(ldp, *)   !! inverse of the block, Q below it
    real(rk), intent(inout) :: b(ldb, *)
    real(rk) :: before(block, strip)
    integer :: j, v

    do j = 1, ncol, strip
      v = min(strip, ncol - j + 1)
      before(:w, :v) = b(:w, j:j + v - 1)
      call gemm('N', 'N', w, v, w, 1.0_rk, pivot, ldp, before, block, 0.0_rk, b(1, j), ldb)
    end do
    if (m > w) call gemm('N', 'N', m - w, ncol, w, -1.0_rk, pivot(w + 1, 1), ldp, b, ldb, 1.0_rk, b(w + 1, 1), ldb)
  end subroutine reduce_block

  !> a := a^-1, halved again and again: for a = [A B; C D] with X = A^-1 B, Y = C A^-1 and S = (D - C X)^-1
  !> it is [A^-1 + X S Y, -X S; -S Y, S].
  recursive subroutine invert(n, a, lda, regular, negative)
    integer, intent(in) :: n, lda
    real(rk), intent(inout) :: a(lda, *)
    logical, intent(inout) :: regular
    integer, intent(inout) :: negative
    real(rk) :: x(block, block), y(block, block)
    integer :: h, r

    if (n <= narrow) then
      call invert_narrow(n, a, lda, regular, negative)
      return
    end if
    h = (n + 1)/2
    r = n - h
    call invert(h, a, lda, regular, negative)
    if (.not. regular) return
    call gemm('N', 'N', h, r, h, 1.0_rk, a, lda, a(1, h + 1), lda, 0.0_rk, x, block)
    call gemm('N', 'N', r, h, h, 1.0_rk, a(h + 1, 1), lda, a, lda, 0.0_rk, y, block)
    call gemm('N', 'N', r, r, h, -1.0_rk, a(h + 1, 1), lda, x, block, 1.0_rk, a(h + 1, h + 1), lda)
    call invert(r, a(h + 1, h + 1), lda, regular, negative)
    if (.not. regular) return
    call gemm('N', 'N', h, r, r, -1.0_rk, x, block, a(h + 1, h + 1), lda, 0.0_rk, a(1, h + 1), lda)
    call gemm('N', 'N', r, h, r, -1.0_rk, a(h + 1, h + 1), lda, y, block, 0.0_rk, a(h + 1, 1), lda)
    call gemm('N', 'N', h, h, r, -1.0_rk, a(1, h + 1), lda, y, block, 1.0_rk, a, lda)
  end subroutine invert

  !> The same by Gauss-Jordan elimination, in an array whose extents are known when it is compiled.
  pure subroutine invert_narrow(n, a, lda, regular, negative)
    integer, intent(in) :: n, lda
    real(rk), intent(inout) :: a(lda, n)
    logical, intent(inout) :: regular
    integer, intent(inout) :: negative
    real(rk) :: b(narrow, narrow), column(narrow), inverse, above
    integer :: j, k

    b = 0
    b(:n, :n) = a(:n, :)
    do k = 1, n
      if (.not. (abs(b(k, k)) > 0 .and. abs(b(k, k)) <= huge(1.0_rk))) then
        regular = .false.
        return
      end if
      if (b(k, k) < 0) negative = negative + 1
      inverse = 1/b(k, k)
      column = -inverse*b(:, k)
      column(k) = 0
      do j = 1, n
        above = b(k, j)
        b(:, j) = b(:, j) + column*above
        b(k, j) = inverse*above
      end do
      b(:, k) = column
      b(k, k) = inverse
    end do
    a(:n, :) = b(:n, :n)
  end subroutine invert_narrow

end module dense_lu
