!> Elimination of the pivots of one dense front, in blocks of pivots and without pivoting: for A = [P R; Q C] the inverse of P, the
!> rows U = P^-1 R and the border C - Q U; Q stays as it is.
!>
!> A block LU factorisation (J.W. Demmel, N.J. Higham, R.S. Schreiber, Numer. Linear Algebra Appl. 2 (1995) 173-190): all work is
!> in matrix products, also that of a solve; triangular solves of few rows reach a fifth of the speed of products. Blocks are
!> so small that their inverses cost no accuracy (backward errors of 1e-16 in tests/solve).
!>
!> Columns are cut into strips of fixed width, and a thread does whole strips: results do not depend on the number of threads.
module dense_lu
  use blas, only: dgemm
  use kinds, only: wp
  implicit none
  private
  public :: eliminate, eliminate_shared

  !> Most pivots of a block; of one that is inverted pivot by pivot; width of the strips threads share.
  integer, parameter, public :: block = 32
  integer, parameter :: narrow = 8, strip = 64

contains

  !> One thread. `regular` becomes false when a pivot is zero or NaN.
  subroutine eliminate(p, n, pivot, row, border, regular)
    integer, intent(in) :: p, n                     !! pivots, order
    real(wp), intent(inout) :: pivot(n, p)          !! pivot columns [residual/unknown]; inverses of their blocks and U there
    real(wp), intent(inout) :: row(p, n - p)        !! rest of the pivot rows [residual/unknown]; U there
    real(wp), intent(out) :: border(n - p, n - p)   !! what elimination adds to the border [residual/unknown]
    logical, intent(inout) :: regular
    integer :: k, w

    do k = 1, p, block
      w = min(block, p - k + 1)
      call invert(w, pivot(k, k), n, regular)
      if (.not. regular) return
      if (k + w <= p) call reduce_block(w, p - k - w + 1, n - k + 1, pivot(k, k), n, pivot(k, k + w), n)
    end do
    if (n > p) call reduce_strip(p, n, pivot, n - p, row, border)
  end subroutine eliminate

  !> The same by all threads of the team, called by one of them.
  subroutine eliminate_shared(p, n, pivot, row, border, regular)
    integer, intent(in) :: p, n
    real(wp), intent(inout) :: pivot(n, p)          !! pivot columns [residual/unknown]
    real(wp), intent(inout) :: row(p, n - p)        !! rest of the pivot rows [residual/unknown]
    real(wp), intent(out) :: border(n - p, n - p)   !! [residual/unknown]
    logical, intent(inout) :: regular
    integer :: k, w, j

    do k = 1, p, block
      w = min(block, p - k + 1)
      call invert(w, pivot(k, k), n, regular)
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
    real(wp), intent(in) :: pivot(n, p)
    real(wp), intent(inout) :: row(p, ncol)
    real(wp), intent(out) :: border(n - p, ncol)
    integer :: k

    do k = 1, p, block
      call reduce_block(min(block, p - k + 1), ncol, p - k + 1, pivot(k, k), n, row(k, 1), p)
    end do
    call dgemm('N', 'N', n - p, ncol, p, -1.0_wp, pivot(p + 1, 1), n, row, p, 0.0_wp, border, n - p)
  end subroutine reduce_strip

  !> Columns `b` of m rows by one block of w pivots: its rows U, and those below them less Q U.
  subroutine reduce_block(w, ncol, m, pivot, ldp, b, ldb)
    integer, intent(in) :: w, ncol, m, ldp, ldb
    real(wp), intent(in) :: pivot(ldp, *)   !! inverse of the block, Q below it
    real(wp), intent(inout) :: b(ldb, *)
    real(wp) :: before(block, strip)
    integer :: j, v

    do j = 1, ncol, strip
      v = min(strip, ncol - j + 1)
      before(:w, :v) = b(:w, j:j + v - 1)
      call dgemm('N', 'N', w, v, w, 1.0_wp, pivot, ldp, before, block, 0.0_wp, b(1, j), ldb)
    end do
    if (m > w) call dgemm('N', 'N', m - w, ncol, w, -1.0_wp, pivot(w + 1, 1), ldp, b, ldb, 1.0_wp, b(w + 1, 1), ldb)
  end subroutine reduce_block

  !> a := a^-1, halved again and again: for a = [A B; C D] with X = A^-1 B, Y = C A^-1 and S = (D - C X)^-1
  !> it is [A^-1 + X S Y, -X S; -S Y, S].
  recursive subroutine invert(n, a, lda, regular)
    integer, intent(in) :: n, lda
    real(wp), intent(inout) :: a(lda, *)
    logical, intent(inout) :: regular
    real(wp) :: x(block, block), y(block, block)
    integer :: h, r

    if (n <= narrow) then
      call invert_narrow(n, a, lda, regular)
      return
    end if
    h = (n + 1)/2
    r = n - h
    call invert(h, a, lda, regular)
    if (.not. regular) return
    call dgemm('N', 'N', h, r, h, 1.0_wp, a, lda, a(1, h + 1), lda, 0.0_wp, x, block)
    call dgemm('N', 'N', r, h, h, 1.0_wp, a(h + 1, 1), lda, a, lda, 0.0_wp, y, block)
    call dgemm('N', 'N', r, r, h, -1.0_wp, a(h + 1, 1), lda, x, block, 1.0_wp, a(h + 1, h + 1), lda)
    call invert(r, a(h + 1, h + 1), lda, regular)
    if (.not. regular) return
    call dgemm('N', 'N', h, r, r, -1.0_wp, x, block, a(h + 1, h + 1), lda, 0.0_wp, a(1, h + 1), lda)
    call dgemm('N', 'N', r, h, r, -1.0_wp, a(h + 1, h + 1), lda, y, block, 0.0_wp, a(h + 1, 1), lda)
    call dgemm('N', 'N', h, h, r, -1.0_wp, a(1, h + 1), lda, y, block, 1.0_wp, a, lda)
  end subroutine invert

  !> The same by Gauss-Jordan elimination, in an array whose extents are known when it is compiled.
  pure subroutine invert_narrow(n, a, lda, regular)
    integer, intent(in) :: n, lda
    real(wp), intent(inout) :: a(lda, n)
    logical, intent(inout) :: regular
    real(wp) :: b(narrow, narrow), column(narrow), inverse, above
    integer :: j, k

    b = 0
    b(:n, :n) = a(:n, :)
    do k = 1, n
      if (.not. (abs(b(k, k)) > 0 .and. abs(b(k, k)) <= huge(1.0_wp))) then
        regular = .false.
        return
      end if
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
