!> Elimination of the pivots of one dense front, without pivoting: A = [P U; . C], P = L\U in its place, U := L^-1 U, C := C - L U.
!>
!> Columns are cut into strips of fixed width, and a thread does whole strips: results do not depend on the number of threads.
module dense_lu
  use blas, only: dgemm, dtrsm
  use kinds, only: wp
  implicit none
  private
  public :: eliminate, eliminate_shared

  !> Widest strip done column by column; width of the strips threads share.
  integer, parameter :: narrow = 8, strip = 64

contains

  !> One thread. `regular` becomes false when a pivot is zero or NaN.
  subroutine eliminate(p, n, pivot, row, border, keep, regular)
    integer, intent(in) :: p, n                       !! pivots, order
    real(wp), intent(inout) :: pivot(n, p)            !! pivot columns [residual/unknown]
    real(wp), intent(inout) :: row(p, n - p)          !! rest of the pivot rows [residual/unknown]
    real(wp), intent(inout) :: border(n - p, n - p)   !! [residual/unknown]
    real(wp), intent(in) :: keep                      !! 1, or 0 where `border` holds nothing yet
    logical, intent(inout) :: regular

    call split_columns(n, p, pivot, n, regular)
    if (n == p .or. .not. regular) return
    call dtrsm('L', 'L', 'N', 'U', p, n - p, 1.0_wp, pivot, n, row, p)
    call dgemm('N', 'N', n - p, n - p, p, -1.0_wp, pivot(p + 1, 1), n, row, p, keep, border, n - p)
  end subroutine eliminate

  !> The same by all threads of the team, called by one of them.
  subroutine eliminate_shared(p, n, pivot, row, border, keep, regular)
    integer, intent(in) :: p, n
    real(wp), intent(inout) :: pivot(n, p)            !! pivot columns [residual/unknown]
    real(wp), intent(inout) :: row(p, n - p)          !! rest of the pivot rows [residual/unknown]
    real(wp), intent(inout) :: border(n - p, n - p)   !! [residual/unknown]
    real(wp), intent(in) :: keep
    logical, intent(inout) :: regular
    integer :: k, w, j, v

    do k = 1, p, strip
      w = min(strip, p - k + 1)
      call split_columns(n - k + 1, w, pivot(k, k), n, regular)
      if (.not. regular) return
      do j = k + w, p, strip
        !$omp task default(shared) firstprivate(j, k, w) private(v)
        v = min(strip, p - j + 1)
        call dtrsm('L', 'L', 'N', 'U', w, v, 1.0_wp, pivot(k, k), n, pivot(k, j), n)
        call dgemm('N', 'N', n - k - w + 1, v, w, -1.0_wp, pivot(k + w, k), n, pivot(k, j), n, 1.0_wp, pivot(k + w, j), n)
        !$omp end task
      end do
      !$omp taskwait
    end do
    do j = 1, n - p, strip
      !$omp task default(shared) firstprivate(j) private(v)
      v = min(strip, n - p - j + 1)
      call dtrsm('L', 'L', 'N', 'U', p, v, 1.0_wp, pivot, n, row(1, j), p)
      call dgemm('N', 'N', n - p, v, p, -1.0_wp, pivot(p + 1, 1), n, row(1, j), p, keep, border(1, j), n - p)
      !$omp end task
    end do
    !$omp taskwait
  end subroutine eliminate_shared

  !> L\U of m x n columns, m >= n, halved again and again.
  recursive subroutine split_columns(m, n, a, lda, regular)
    integer, intent(in) :: m, n, lda
    real(wp), intent(inout) :: a(lda, *)
    logical, intent(inout) :: regular
    integer :: h

    if (n <= narrow) then
      call one_by_one(m, n, a, lda, regular)
      return
    end if
    h = n/2
    call split_columns(m, h, a, lda, regular)
    if (.not. regular) return
    call dtrsm('L', 'L', 'N', 'U', h, n - h, 1.0_wp, a, lda, a(1, h + 1), lda)
    call dgemm('N', 'N', m - h, n - h, h, -1.0_wp, a(h + 1, 1), lda, a(1, h + 1), lda, 1.0_wp, a(h + 1, h + 1), lda)
    call split_columns(m - h, n - h, a(h + 1, h + 1), lda, regular)
  end subroutine split_columns

  pure subroutine one_by_one(m, n, a, lda, regular)
    integer, intent(in) :: m, n, lda
    real(wp), intent(inout) :: a(lda, n)
    logical, intent(inout) :: regular
    integer :: j, k

    do k = 1, n
      if (.not. (abs(a(k, k)) > 0 .and. abs(a(k, k)) <= huge(1.0_wp))) then
        regular = .false.
        return
      end if
      a(k + 1:m, k) = a(k + 1:m, k)*(1/a(k, k))
      do j = k + 1, n
        a(k + 1:m, j) = a(k + 1:m, j) - a(k + 1:m, k)*a(k, j)
      end do
    end do
  end subroutine one_by_one

end module dense_lu
