!> Direct solution of the linear system: analysis once per mesh, factorisation per matrix, residual of every solve checked
!> and refined. Factors are made without pivoting, by all threads; a matrix for which these prove too poor, and those
!> after it in the step, get MUMPS with pivoting.
module linear_solver
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  use multifrontal, only: decompose, multifrontal_t, plan, substitute
  use mumps_solver, only: mumps_analyse, mumps_factorise, mumps_release, mumps_solve, mumps_t
  use sparsity, only: pattern_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: linear_solver_t, analyse, factorise, solve_linear, release, try_without_pivoting

  !> Backward error of a solve that is refined; and what is accepted at last.
  real(wp), parameter, public :: refine_above = 1.0e-14_wp
  real(wp), parameter, public :: linear_tolerance = 1.0e-10_wp
  integer, parameter :: max_refinements = 3
  !> Forces |A| |x| this many times the right-hand side are round-off of a singular matrix.
  real(wp), parameter :: singular_growth = 1.0e13_wp
  !> Fewer nonzeros are not worth waking threads for.
  integer, parameter :: worth_threads = 50000

  type :: linear_solver_t
    private
    type(multifrontal_t) :: fronts
    type(mumps_t) :: mumps
    !> Order of elimination asked for; where every row of the matrix begins; its nonzeros.
    integer, allocatable :: position(:), row_start(:)
    real(wp), allocatable :: values(:)
    !> The factors at hand are sound; the solver has turned to pivoting.
    logical :: regular = .false., pivoting = .false.
    !> Entries of the factors and operations of a factorisation.
    real(wp), public :: estimated_entries = 0.0_wp, estimated_flops = 0.0_wp
    !> Backward error of the last solve.
    real(wp), public :: residual = 0.0_wp
  end type linear_solver_t

contains

  !> Plan the factorisation for a pattern and an order of elimination.
  subroutine analyse(solver, pattern, position, error)
    type(linear_solver_t), intent(inout) :: solver
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)
    type(error_t), allocatable, intent(out) :: error

    call release(solver)
    solver%position = position
    allocate (solver%values(pattern%nnz))
    call start_rows(pattern, solver%row_start)
    call plan(solver%fronts, pattern, position, error)
    solver%estimated_entries = real(solver%fronts%layout%factor_length, wp)
    solver%estimated_flops = solver%fronts%layout%flops
  end subroutine analyse

  !> Nonzeros are sorted by row: where every row begins (neq + 1).
  pure subroutine start_rows(pattern, row_start)
    type(pattern_t), intent(in) :: pattern
    integer, allocatable, intent(out) :: row_start(:)
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

  !> At the start of a step: what earlier steps needed does not count, or a run taken up again would go another way.
  pure subroutine try_without_pivoting(solver)
    type(linear_solver_t), intent(inout) :: solver

    solver%pivoting = .false.
  end subroutine try_without_pivoting

  !> Factorise the matrix with these nonzeros. A singular matrix answers exit_no_convergence: the step is cut.
  subroutine factorise(solver, values, error)
    type(linear_solver_t), intent(inout) :: solver
    real(wp), intent(in) :: values(:)
    type(error_t), allocatable, intent(out) :: error

    solver%values = values
    if (solver%pivoting) then
      call mumps_factorise(solver%mumps, solver%values, error)
    else
      call decompose(solver%fronts, solver%values, solver%regular)
    end if
  end subroutine factorise

  !> Solve for one right-hand side with the present factors, refining while the residual asks for it.
  !> Factors made without pivoting that prove too poor are made again with it, for the rest of the step.
  subroutine solve_linear(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)
    real(wp), intent(out) :: x(:)
    type(error_t), allocatable, intent(out) :: error

    x = 0
    if (solver%regular .or. solver%pivoting) call refine(solver, pattern, rhs, x, error)
    if (allocated(error)) return
    if (.not. solver%pivoting .and. .not. (solver%regular .and. solver%residual <= linear_tolerance)) then
      solver%pivoting = .true.
      if (.not. solver%mumps%started) call mumps_analyse(solver%mumps, pattern, solver%position, error)
      if (.not. allocated(error)) call mumps_factorise(solver%mumps, solver%values, error)
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
    real(wp) :: residual(size(rhs)), correction(size(rhs)), scale
    integer :: k

    x = 0
    scale = 0
    residual = rhs
    do k = 0, max_refinements
      correction = residual
      if (solver%pivoting) then
        call mumps_solve(solver%mumps, correction, error)
        if (allocated(error)) return
      else
        call substitute(solver%fronts, correction)
      end if
      x = x + correction
      call linear_residual(pattern, solver%row_start, solver%values, rhs, x, residual, scale)
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
  subroutine linear_residual(pattern, row_start, a, rhs, x, residual, scale)
    type(pattern_t), intent(in) :: pattern
    integer, intent(in) :: row_start(:)   !! nonzeros of row i: row_start(i) ... row_start(i+1)-1
    real(wp), intent(in) :: a(:), rhs(:), x(:)
    real(wp), intent(out) :: residual(:), scale
    real(wp) :: magnitude(size(rhs))
    integer :: k, i, j

    !$omp parallel do private(k) schedule(static) if (pattern%nnz > worth_threads)
    do i = 1, pattern%neq
      residual(i) = rhs(i)
      magnitude(i) = abs(rhs(i))
      do k = row_start(i), row_start(i + 1) - 1
        residual(i) = residual(i) - a(k)*x(pattern%column(k))
        magnitude(i) = magnitude(i) + abs(a(k)*x(pattern%column(k)))
      end do
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

  !> Give back what is held.
  subroutine release(solver)
    type(linear_solver_t), intent(inout) :: solver

    call mumps_release(solver%mumps)
    if (allocated(solver%position)) deallocate (solver%position, solver%row_start, solver%values)
    solver%fronts = multifrontal_t()
    solver%regular = .false.
    solver%pivoting = .false.
  end subroutine release

end module linear_solver
