!> Small dense systems by Gaussian elimination with partial pivoting, in blocks of columns (G.H. Golub, C.F. Van Loan, Matrix
!> Computations, 4th ed., Johns Hopkins 2013, sec. 3.4): most of the work is in matrix products.
module dense_solve
  use blas, only: dgemm
  use kinds, only: wp
  implicit none
  private
  public :: factorise_dense, solve_dense

  !> Columns of a block.
  integer, parameter :: block = 16

contains

  !> a := its factors, L below the diagonal and U; row k was exchanged with row pivot(k). `regular` is false where a pivot is zero
  !> or NaN.
  subroutine factorise_dense(n, a, pivot, regular)
    integer, intent(in) :: n
    real(wp), intent(inout) :: a(n, n)   !! [of any unit]
    integer, intent(out) :: pivot(n)
    logical, intent(out) :: regular
    integer :: k, w, j, i

    regular = .true.
    do k = 1, n, block
      w = min(block, n - k + 1)
      call eliminate_columns(n, k, w, a, pivot, regular)
      if (.not. regular) return
      if (k + w > n) exit
      do j = k + w, n
        do i = k, k + w - 2
          a(i + 1:k + w - 1, j) = a(i + 1:k + w - 1, j) - a(i + 1:k + w - 1, i)*a(i, j)
        end do
      end do
      call dgemm('N', 'N', n - k - w + 1, n - k - w + 1, w, -1.0_wp, a(k + w, k), n, a(k, k + w), n, 1.0_wp, a(k + w, k + w), n)
    end do
  end subroutine factorise_dense

  !> Columns k ... k + w - 1, with the rows of the whole matrix exchanged.
  pure subroutine eliminate_columns(n, k, w, a, pivot, regular)
    integer, intent(in) :: n, k, w
    real(wp), intent(inout) :: a(n, n)
    integer, intent(inout) :: pivot(n)
    logical, intent(inout) :: regular
    real(wp) :: row(n)
    integer :: i, j, p

    do j = k, k + w - 1
      p = j - 1 + maxloc(abs(a(j:n, j)), 1)
      if (.not. (abs(a(p, j)) > 0 .and. abs(a(p, j)) <= huge(a))) then
        regular = .false.
        return
      end if
      pivot(j) = p
      if (p /= j) then
        row = a(j, :)
        a(j, :) = a(p, :)
        a(p, :) = row
      end if
      a(j + 1:n, j) = a(j + 1:n, j)/a(j, j)
      do i = j + 1, k + w - 1
        a(j + 1:n, i) = a(j + 1:n, i) - a(j + 1:n, j)*a(j, i)
      end do
    end do
  end subroutine eliminate_columns

  !> x := A^-1 x by the factors of A.
  pure subroutine solve_dense(n, a, pivot, x)
    integer, intent(in) :: n
    real(wp), intent(in) :: a(n, n)      !! factors [of any unit]
    integer, intent(in) :: pivot(n)
    real(wp), intent(inout) :: x(n)      !! right-hand side, then solution [of any unit]
    real(wp) :: held
    integer :: j

    do j = 1, n
      held = x(pivot(j))
      x(pivot(j)) = x(j)
      x(j) = held
    end do
    do j = 1, n - 1
      x(j + 1:) = x(j + 1:) - a(j + 1:, j)*x(j)
    end do
    do j = n, 1, -1
      x(j) = x(j)/a(j, j)
      x(:j - 1) = x(:j - 1) - a(:j - 1, j)*x(j)
    end do
  end subroutine solve_dense

end module dense_solve
