!> Direct solution of the linear system by sequential MUMPS: analysis once per mesh, numerical
!> factorisation per matrix, residual of every solve checked and refined.
module linear_solver
  use errors, only: error_t, exit_machine, exit_no_convergence, fail
  use kinds, only: wp
  use sparsity, only: pattern_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: linear_solver_t, analyse, factorise, solve_linear, release

  include 'dmumps_struc.h'

  !> Backward error of a solve that is refined; and what is accepted at last.
  real(wp), parameter, public :: refine_above = 1.0e-14_wp
  real(wp), parameter, public :: linear_tolerance = 1.0e-10_wp
  integer, parameter :: max_refinements = 3
  !> Forces |A| |x| this many times the right-hand side are round-off of a singular matrix.
  real(wp), parameter :: singular_growth = 1.0e13_wp
  !> Threshold of partial pivoting, where it is used.
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

  type :: linear_solver_t
    private
    type(dmumps_struc) :: mumps
    logical :: started = .false.
    !> Entries of the factors and operations of a factorisation, estimated by the analysis.
    real(wp), public :: estimated_entries = 0.0_wp, estimated_flops = 0.0_wp
    !> Backward error of the last solve.
    real(wp), public :: residual = 0.0_wp
  contains
    final :: release
  end type linear_solver_t

contains

  !> Give MUMPS the pattern and the order of elimination.
  subroutine analyse(solver, pattern, position, error)
    type(linear_solver_t), intent(inout) :: solver
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)
    type(error_t), allocatable, intent(out) :: error

    call release(solver)
    solver%mumps%comm = 0
    solver%mumps%par = 1
    solver%mumps%sym = merge(2, 0, pattern%symmetric)
    solver%mumps%job = job_start
    call dmumps(solver%mumps)
    if (solver%mumps%infog(1) < 0) then
      call fail(error, exit_machine, 'MUMPS: start failed (INFOG(1) = '//to_text(solver%mumps%infog(1))//')')
      return
    end if
    solver%started = .true.
    associate (id => solver%mumps)
      id%icntl(1:3) = -1      ! no output
      id%icntl(4) = 0
      id%icntl(8) = 0         ! no scaling: unknowns are displacements throughout
      id%cntl(1) = 0          ! no pivoting, until a residual asks for it
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
      call dmumps(solver%mumps)
      if (id%infog(1) < 0) call fail(error, exit_machine, &
                                     'MUMPS: analysis failed (INFOG(1) = '//to_text(id%infog(1))//', ' &
                                     //to_text(id%infog(2))//')')
      ! a negative count is in millions
      solver%estimated_entries = merge(real(id%infog(20), wp), -1.0e6_wp*id%infog(20), id%infog(20) >= 0)
      solver%estimated_flops = id%rinfog(1)
    end associate
  end subroutine analyse

  !> Factorise the matrix with these nonzeros. A singular matrix answers exit_no_convergence: the step is cut.
  subroutine factorise(solver, values, error)
    type(linear_solver_t), intent(inout) :: solver
    real(wp), intent(in) :: values(:)
    type(error_t), allocatable, intent(out) :: error
    integer :: attempt

    associate (id => solver%mumps)
      do attempt = 1, 2
        id%a = values
        id%job = job_factorise
        call dmumps(solver%mumps)
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
  end subroutine factorise

  !> Solve for one right-hand side with the present factors, refining while the residual asks for it.
  !> Factors made without pivoting that prove too poor are made again with it, once and for all.
  subroutine solve_linear(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)
    real(wp), intent(out) :: x(:)
    type(error_t), allocatable, intent(out) :: error

    call refine(solver, pattern, rhs, x, error)
    if (allocated(error)) return
    if (.not. solver%residual <= linear_tolerance .and. .not. solver%mumps%cntl(1) > 0) then
      solver%mumps%cntl(1) = pivot_threshold
      call factorise(solver, solver%mumps%a, error)
      if (.not. allocated(error)) call refine(solver, pattern, rhs, x, error)
    end if
    if (allocated(error)) return
    if (.not. solver%residual <= linear_tolerance) then
      call fail(error, exit_no_convergence, 'linear residual '//to_text(solver%residual, 3)//' above ' &
                //to_text(linear_tolerance, 3))
    end if
  end subroutine solve_linear

  !> Solve, then correct by the residual while that is worth it.
  subroutine refine(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)
    real(wp), intent(out) :: x(:)
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: residual(size(rhs)), scale
    integer :: k

    x = 0
    scale = 0
    residual = rhs
    do k = 0, max_refinements
      solver%mumps%rhs = residual
      solver%mumps%job = job_solve
      call dmumps(solver%mumps)
      if (solver%mumps%infog(1) < 0) then
        call fail(error, exit_machine, 'MUMPS: solution failed (INFOG(1) = '//to_text(solver%mumps%infog(1))//')')
        return
      end if
      x = x + solver%mumps%rhs
      call linear_residual(pattern, solver%mumps%a, rhs, x, residual, scale)
      solver%residual = 0
      if (scale > 0) solver%residual = length_of(residual)/scale
      if (.not. solver%residual > refine_above) exit
    end do
    if (scale > singular_growth*length_of(rhs)) then
      call fail(error, exit_no_convergence, 'the matrix is singular to working precision: is every body held?')
    end if
  end subroutine refine

  !> residual = rhs - A x, and the size of what was summed, |rhs| + |A| |x|: their ratio is the backward error
  !> (W. Oettli, W. Prager, Numer. Math. 6 (1964) 405-409), which a stiff constraint does not spoil.
  pure subroutine linear_residual(pattern, a, rhs, x, residual, scale)
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: a(:), rhs(:), x(:)
    real(wp), intent(out) :: residual(:), scale
    real(wp) :: magnitude(size(rhs))
    integer :: k, i, j

    residual = rhs
    magnitude = abs(rhs)
    do k = 1, pattern%nnz
      i = pattern%row(k)
      j = pattern%column(k)
      residual(i) = residual(i) - a(k)*x(j)
      magnitude(i) = magnitude(i) + abs(a(k)*x(j))
      if (.not. pattern%symmetric .or. i == j) cycle
      residual(j) = residual(j) - a(k)*x(i)
      magnitude(j) = magnitude(j) + abs(a(k)*x(i))
    end do
    scale = length_of(magnitude)
  end subroutine linear_residual

  !> Give back what MUMPS holds.
  subroutine release(solver)
    type(linear_solver_t), intent(inout) :: solver

    if (.not. solver%started) return
    associate (id => solver%mumps)
      deallocate (id%irn, id%jcn, id%a, id%perm_in, id%rhs)
      nullify (id%irn, id%jcn, id%a, id%perm_in, id%rhs)
      id%job = job_end
    end associate
    call dmumps(solver%mumps)
    solver%started = .false.
  end subroutine release

end module linear_solver
