!> Sequential MUMPS with partial pivoting: for matrices that cannot be factorised without.
!>
!> P.R. Amestoy, I.S. Duff, J. Koster, J.-Y. L'Excellent, SIAM J. Matrix Anal. Appl. 23 (2001) 15-41.
module mumps_solver
  use errors, only: error_t, exit_machine, exit_no_convergence, fail
  use kinds, only: wp
  use sparsity, only: pattern_t
  use text, only: to_text
  implicit none
  private
  public :: mumps_t, mumps_analyse, mumps_factorise, mumps_solve, mumps_release

  include 'dmumps_struc.h'

  !> Threshold of partial pivoting.
  real(wp), parameter :: pivot_threshold = 0.01_wp

  !> MUMPS' own numbers.
  integer, parameter :: job_start = -1, job_end = -2, job_analyse = 1, job_factorise = 2, job_solve = 3
  integer, parameter :: info_workspace = -9, info_workspace_integer = -8, info_singular = -10, info_memory = -13

  interface
    subroutine dmumps(id)
      import :: dmumps_struc
      type(dmumps_struc), intent(inout) :: id
    end subroutine dmumps
  end interface

  type :: mumps_t
    private
    type(dmumps_struc) :: id
    logical, public :: started = .false.
  contains
    final :: mumps_release
  end type mumps_t

contains

  !> Give MUMPS the pattern and the order of elimination.
  subroutine mumps_analyse(solver, pattern, position, error)
    type(mumps_t), intent(inout) :: solver
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)
    type(error_t), allocatable, intent(out) :: error

    call mumps_release(solver)
    solver%id%comm = 0
    solver%id%par = 1
    solver%id%sym = merge(2, 0, pattern%symmetric)
    solver%id%job = job_start
    call dmumps(solver%id)
    if (solver%id%infog(1) < 0) then
      call fail(error, exit_machine, 'MUMPS: start failed (INFOG(1) = '//to_text(solver%id%infog(1))//')')
      return
    end if
    solver%started = .true.
    associate (id => solver%id)
      id%icntl(1:3) = -1      ! no output
      id%icntl(4) = 0
      id%icntl(8) = 0         ! no scaling: unknowns are displacements throughout
      id%cntl(1) = pivot_threshold
      id%icntl(6) = 0         ! no column permutation: the pattern is symmetric and diagonals are large
      id%icntl(7) = 1         ! order given
      id%icntl(14) = 30       ! extra workspace, percent
      id%n = pattern%neq
      id%nz = pattern%nnz
      allocate (id%irn(pattern%nnz), id%jcn(pattern%nnz), id%a(pattern%nnz), id%perm_in(pattern%neq), id%rhs(pattern%neq))
      id%irn = pattern%row
      id%jcn = pattern%column
      id%perm_in = position
      id%job = job_analyse
      call dmumps(solver%id)
      if (id%infog(1) < 0) call fail(error, exit_machine, &
                                     'MUMPS: analysis failed (INFOG(1) = '//to_text(id%infog(1))//', ' &
                                     //to_text(id%infog(2))//')')
    end associate
  end subroutine mumps_analyse

  !> Factorise the matrix with these nonzeros. A singular matrix answers exit_no_convergence: the step is cut.
  subroutine mumps_factorise(solver, values, error)
    type(mumps_t), intent(inout) :: solver
    real(wp), intent(in) :: values(:)
    type(error_t), allocatable, intent(out) :: error
    integer :: attempt

    associate (id => solver%id)
      do attempt = 1, 2
        id%a = values
        id%job = job_factorise
        call dmumps(solver%id)
        if (id%infog(1) /= info_workspace .and. id%infog(1) /= info_workspace_integer) exit
        id%icntl(14) = 4*id%icntl(14)
      end do
      select case (id%infog(1))
      case (0:)
        return
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
  end subroutine mumps_factorise

  !> x := A^-1 x.
  subroutine mumps_solve(solver, x, error)
    type(mumps_t), intent(inout) :: solver
    real(wp), intent(inout) :: x(:)
    type(error_t), allocatable, intent(out) :: error

    solver%id%rhs = x
    solver%id%job = job_solve
    call dmumps(solver%id)
    x = solver%id%rhs
    if (solver%id%infog(1) < 0) then
      call fail(error, exit_machine, 'MUMPS: solution failed (INFOG(1) = '//to_text(solver%id%infog(1))//')')
    end if
  end subroutine mumps_solve

  !> Give back what MUMPS holds.
  subroutine mumps_release(solver)
    type(mumps_t), intent(inout) :: solver

    if (.not. solver%started) return
    associate (id => solver%id)
      deallocate (id%irn, id%jcn, id%a, id%perm_in, id%rhs)
      nullify (id%irn, id%jcn, id%a, id%perm_in, id%rhs)
      id%job = job_end
    end associate
    call dmumps(solver%id)
    solver%started = .false.
  end subroutine mumps_release

end module mumps_solver
