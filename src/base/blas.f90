!> Interfaces of the dense kernels that are used, in both precisions, of LAPACK's solution of dense systems, of the switch of
!> OpenBLAS's own threads, and of what it reports about itself.
module blas
  use, intrinsic :: iso_c_binding, only: c_int, c_ptr
  use kinds, only: sp, wp
  use system, only: text_of_c
  implicit none
  private
  public :: blas_buffer
  public :: dgemm, dgemv, dgetrf, dgetrs, sgemm, sgemv, keep_blas_to_one_thread, blas_core_name, blas_build

  !> Address space that OpenBLAS asks for, for ever if it is refused, in each thread that calls it first [bytes] (its BUFFER_SIZE,
  !> at most; little of it is used).
  real(wp), parameter :: blas_buffer = 132*2.0_wp**20

  interface
    !> C := alpha op(A) op(B) + beta C.
    subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
      import :: wp
      character, intent(in) :: transa, transb
      integer, intent(in) :: m, n, k, lda, ldb, ldc
      real(wp), intent(in) :: alpha, beta
      real(wp), intent(in) :: a(lda, *)      !! (lda, :) [of any unit]
      real(wp), intent(in) :: b(ldb, *)      !! (ldb, :) [of any unit]
      real(wp), intent(inout) :: c(ldc, *)   !! (ldc, :) [of any unit]
    end subroutine dgemm

    subroutine sgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
      import :: sp
      character, intent(in) :: transa, transb
      integer, intent(in) :: m, n, k, lda, ldb, ldc
      real(sp), intent(in) :: alpha, beta
      real(sp), intent(in) :: a(lda, *)      !! (lda, :) [of any unit]
      real(sp), intent(in) :: b(ldb, *)      !! (ldb, :) [of any unit]
      real(sp), intent(inout) :: c(ldc, *)   !! (ldc, :) [of any unit]
    end subroutine sgemm

    !> y := alpha op(A) x + beta y.
    subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: m, n, lda, incx, incy
      real(wp), intent(in) :: alpha, beta
      real(wp), intent(in) :: a(lda, *)   !! (lda, :) [of any unit]
      real(wp), intent(in) :: x(*)        !! (:) [of any unit]
      real(wp), intent(inout) :: y(*)     !! (:) [of any unit]
    end subroutine dgemv

    subroutine sgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
      import :: sp
      character, intent(in) :: trans
      integer, intent(in) :: m, n, lda, incx, incy
      real(sp), intent(in) :: alpha, beta
      real(sp), intent(in) :: a(lda, *)   !! (lda, :) [of any unit]
      real(sp), intent(in) :: x(*)        !! (:) [of any unit]
      real(sp), intent(inout) :: y(*)     !! (:) [of any unit]
    end subroutine sgemv

    !> A := its factors L and U with partial pivoting; `info` is 0 where no pivot is zero.
    subroutine dgetrf(m, n, a, lda, ipiv, info)
      import :: wp
      integer, intent(in) :: m, n, lda
      real(wp), intent(inout) :: a(lda, *)   !! (lda, :) [of any unit]
      integer, intent(out) :: ipiv(*)        !! (:) rows that were exchanged
      integer, intent(out) :: info
    end subroutine dgetrf

    !> B := op(A)^-1 B by the factors of A.
    subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
      import :: wp
      character, intent(in) :: trans
      integer, intent(in) :: n, nrhs, lda, ldb
      real(wp), intent(in) :: a(lda, *)      !! (lda, :) [of any unit]
      integer, intent(in) :: ipiv(*)         !! (:)
      real(wp), intent(inout) :: b(ldb, *)   !! (ldb, :) [of any unit]
      integer, intent(out) :: info
    end subroutine dgetrs

    subroutine openblas_set_num_threads(n) bind(c, name='openblas_set_num_threads')
      import :: c_int
      integer(c_int), value :: n
    end subroutine openblas_set_num_threads

    function openblas_get_corename() bind(c, name='openblas_get_corename') result(address)
      import :: c_ptr
      type(c_ptr) :: address
    end function openblas_get_corename

    function openblas_get_config() bind(c, name='openblas_get_config') result(address)
      import :: c_ptr
      type(c_ptr) :: address
    end function openblas_get_config
  end interface

contains

  !> OpenBLAS's own threads would share matrices out by their number, so that bits depend on it, and wait at work beside ours.
  subroutine keep_blas_to_one_thread()
    call openblas_set_num_threads(1_c_int)
  end subroutine keep_blas_to_one_thread

  !> The processor whose kernels are in use, in OpenBLAS's words: Haswell, SkylakeX, ...
  function blas_core_name() result(core)
    character(len=:), allocatable :: core

    core = text_of_c(openblas_get_corename())
  end function blas_core_name

  !> Name, version and options of the build: OpenBLAS 0.3.21 DYNAMIC_ARCH ...
  function blas_build() result(build)
    character(len=:), allocatable :: build

    build = text_of_c(openblas_get_config())
  end function blas_build

end module blas
