!> MUMPS: sequential MUMPS with partial pivoting, for any regular matrix.
!>
!> P.R. Amestoy, I.S. Duff, J. Koster, J.-Y. L'Excellent, SIAM J. Matrix Anal. Appl. 23 (2001) 15-41.
module linear_mumps
  use blas, only: keep_blas_to_one_thread
  use errors, only: error_t, exit_machine, exit_no_convergence, fail
  use kinds, only: wp
  use linear_api, only: factors_t, solver_row_t
  use matrix_pattern, only: matrix_pattern_t
  use text, only: to_text
  implicit none
  private
  public :: linear_mumps_row

  include 'dmumps_struc.h'

  !> Threshold of partial pivoting.
  real(wp), parameter :: pivot_threshold = 0.01_wp

  !> MUMPS' own numbers.
  integer, parameter :: job_start = -1, job_end = -2, job_analyse = 1, job_factorise = 2, job_solve = 3
  integer, parameter :: info_workspace = -9, info_workspace_integer = -8, info_singular = -10, info_memory = -13
  !> Places of the estimates of an analysis in INFOG and RINFOG.
  integer, parameter :: info_entries = 3, info_operations = 1
  !> Places of the number of pivots below 0 of a symmetric matrix in INFOG, and of the mantissa of the determinant in RINFOG.
  integer, parameter :: info_negative = 12, info_determinant = 12

  interface
    subroutine dmumps(id)
      import :: dmumps_struc
      type(dmumps_struc), intent(inout) :: id
    end subroutine dmumps
  end interface

  type, extends(factors_t) :: mumps_t
    private
    type(dmumps_struc) :: id
    logical :: started = .false.
  contains
    procedure :: plan => plan_mumps
    procedure :: factorise => factorise_mumps
    procedure :: substitute => substitute_mumps
    procedure :: release => release_mumps
    final :: end_mumps
  end type mumps_t

contains

  function linear_mumps_row() result(row)
    type(solver_row_t) :: row

    row%name = 'MUMPS'
    row%purpose = 'MUMPS, always with partial pivoting'
    row%fallback = ''
    row%create => create_mumps
  end function linear_mumps_row

  subroutine create_mumps(factors)
    class(factors_t), allocatable, intent(out) :: factors

    allocate (mumps_t :: factors)
  end subroutine create_mumps

  !> Give MUMPS the pattern and the order of elimination.
  subroutine plan_mumps(self, pattern, position, error)
    class(mumps_t), intent(inout) :: self
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)
    type(error_t), allocatable, intent(out) :: error

    call release_mumps(self)
    call keep_blas_to_one_thread()
    self%id%comm = 0
    self%id%par = 1
    self%id%sym = merge(2, 0, pattern%symmetric)
    self%id%job = job_start
    call dmumps(self%id)
    if (self%id%infog(1) < 0) then
      call fail(error, exit_machine, 'MUMPS: start failed (INFOG(1) = '//to_text(self%id%infog(1))//')')
      return
    end if
    self%started = .true.
    associate (id => self%id)
      id%icntl(1:3) = -1      ! no output
      id%icntl(4) = 0
      id%icntl(8) = 0         ! no scaling: unknowns are displacements throughout
      id%cntl(1) = pivot_threshold
      id%icntl(6) = 0         ! no column permutation: the pattern is symmetric and diagonals are large
      id%icntl(7) = 1         ! order given
      id%icntl(14) = 30       ! extra workspace, percent
      id%icntl(33) = merge(0, 1, pattern%symmetric)   ! determinant
      id%n = pattern%neq
      id%nz = pattern%nnz
      allocate (id%irn(pattern%nnz), id%jcn(pattern%nnz), id%a(pattern%nnz), id%perm_in(pattern%neq), id%rhs(pattern%neq))
      id%irn = pattern%row
      id%jcn = pattern%column
      id%perm_in = position
      id%job = job_analyse
      call dmumps(self%id)
      if (id%infog(1) < 0) call fail(error, exit_machine, &
                                     'MUMPS: analysis failed (INFOG(1) = '//to_text(id%infog(1))//', ' &
                                     //to_text(id%infog(2))//')')
      self%entries = in_full(id%infog(info_entries))
      self%operations = id%rinfog(info_operations)
    end associate
  end subroutine plan_mumps

  !> MUMPS gives large numbers as millions with a minus.
  pure function in_full(n) result(x)
    integer, intent(in) :: n
    real(wp) :: x

    x = real(n, wp)
    if (n < 0) x = -1.0e6_wp*n
  end function in_full

  !> Factorise the matrix with these nonzeros. A singular matrix gives exit_no_convergence: the step is cut back.
  subroutine factorise_mumps(self, values, sound, error)
    class(mumps_t), intent(inout) :: self
    real(wp), intent(in) :: values(:)
    logical, intent(out) :: sound
    type(error_t), allocatable, intent(out) :: error
    integer :: attempt

    associate (id => self%id)
      do attempt = 1, 2
        id%a = values
        id%job = job_factorise
        call dmumps(self%id)
        if (id%infog(1) /= info_workspace .and. id%infog(1) /= info_workspace_integer) exit
        id%icntl(14) = 4*id%icntl(14)
      end do
      sound = id%infog(1) >= 0
      if (sound) self%negative = merge(id%infog(info_negative), merge(1, 0, id%rinfog(info_determinant) < 0), id%sym > 0)
      if (sound) return
      select case (id%infog(1))
      case (info_singular)
        call fail(error, exit_no_convergence, 'the matrix is singular')
      case (info_memory, info_workspace, info_workspace_integer)
        call fail(error, exit_machine, 'not enough memory for the factors of the matrix ('//to_text(id%infog(16))// &
                  ' MB estimated)', 'use a coarser mesh or a machine with more memory')
      case default
        call fail(error, exit_machine, 'MUMPS: factorisation failed (INFOG(1) = '//to_text(id%infog(1))//', ' &
                  //to_text(id%infog(2))//')')
      end select
    end associate
  end subroutine factorise_mumps

  !> x := A^-1 x.
  subroutine substitute_mumps(self, x, error)
    class(mumps_t), intent(inout) :: self
    real(wp), intent(inout) :: x(:)
    type(error_t), allocatable, intent(out) :: error

    self%id%rhs = x
    self%id%job = job_solve
    call dmumps(self%id)
    x = self%id%rhs
    if (self%id%infog(1) < 0) then
      call fail(error, exit_machine, 'MUMPS: solution failed (INFOG(1) = '//to_text(self%id%infog(1))//')')
    end if
  end subroutine substitute_mumps

  !> Give back what MUMPS holds.
  subroutine release_mumps(self)
    class(mumps_t), intent(inout) :: self

    if (.not. self%started) return
    associate (id => self%id)
      deallocate (id%irn, id%jcn, id%a, id%perm_in, id%rhs)
      nullify (id%irn, id%jcn, id%a, id%perm_in, id%rhs)
      id%job = job_end
    end associate
    call dmumps(self%id)
    self%started = .false.
  end subroutine release_mumps

  subroutine end_mumps(self)
    type(mumps_t), intent(inout) :: self

    call release_mumps(self)
  end subroutine end_mumps

end module linear_mumps
