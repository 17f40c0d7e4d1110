!> Interfaces of the dense kernels that are used, and of the switch of OpenBLAS's own threads.
module blas
  use, intrinsic :: iso_c_binding, only: c_int
  use kinds, only: wp
  implicit none
  private
  public :: dgemm, dgemv, dtrsm, dtrsv, keep_blas_to_one_thread

  interface
    !> C := alpha op(A) op(B) + beta C.
    subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
      import :: wp
      character, intent(in) :: transa, transb
      integer, intent(in) :: m, n, k, lda, ldb, ldc
      real(wp), intent(in) :: alpha, beta, a(lda, *), b(ldb, *)
      real(wp), intent(inout) :: c(ldc, *)
    end subroutine dgemm

    !> y := alpha op(A) x + beta y.
    subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: m, n, lda, incx, incy
      real(wp), intent(in) :: alpha, beta, a(lda, *), x(*)
      real(wp), intent(inout) :: y(*)
    end subroutine dgemv

    !> B := alpha op(A)^-1 B, or from the right, A triangular.
    subroutine dtrsm(side, uplo, transa, diag, m, n, alpha, a, lda, b, ldb)
      import :: wp
      character, intent(in) :: side, uplo, transa, diag
      integer, intent(in) :: m, n, lda, ldb
      real(wp), intent(in) :: alpha, a(lda, *)
      real(wp), intent(inout) :: b(ldb, *)
    end subroutine dtrsm

    !> x := op(A)^-1 x, A triangular.
    subroutine dtrsv(uplo, trans, diag, n, a, lda, x, incx)
      import :: wp
      character, intent(in) :: uplo, trans, diag
      integer, intent(in) :: n, lda, incx
      real(wp), intent(in) :: a(lda, *)
      real(wp), intent(inout) :: x(*)
    end subroutine dtrsv

    subroutine openblas_set_num_threads(n) bind(c, name='openblas_set_num_threads')
      import :: c_int
      integer(c_int), value :: n
    end subroutine openblas_set_num_threads
  end interface

contains

  !> OpenBLAS's own threads would share matrices out by their number, so that bits depend on it, and wait at work beside ours.
  subroutine keep_blas_to_one_thread()
    call openblas_set_num_threads(1_c_int)
  end subroutine keep_blas_to_one_thread

end module blas
