!> Direct solution of the linear system by the solver chosen: analysis once per mesh, factorisation per matrix (factors of a matrix
!> that comes again, to the last bit, are kept), residual of every solve checked and refined. A matrix for which the factors prove
!> too poor, and those after it in the step, get the fallback of the solver, where it has one, and its fallback after that.
module linear_solver
  use errors, only: error_t, exit_bug, exit_no_convergence, fail
  use kinds, only: i8, wp
  use linear_api, only: factors_t, solver_row_t
  use linear_registry, only: list_solvers
  use linear_residuals, only: linear_residual, start_rows
  use matrix_pattern, only: matrix_pattern_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: linear_solver_t, choose_solver, analyse, factorise, has_factors, solve_linear, solve_unrefined, invert_at, &
            negative_pivots, release, return_to_chosen, use_working_precision

  !> Backward error of a solve that is accepted at last.
  real(wp), parameter, public :: linear_tolerance = 1.0e-10_wp
  !> Solves are refined so often at most, and while each refinement leaves no more than this share of the backward error.
  integer, parameter :: max_refinements = 6
  real(wp), parameter :: worth_refining = 0.25_wp
  !> Forces |A| |x| this many times the right-hand side are round-off of a singular matrix.
  real(wp), parameter :: singular_growth = 1.0e13_wp

  !> A solver and its factors, once they were needed.
  type :: solver_stage_t
    type(solver_row_t) :: row
    class(factors_t), allocatable :: factors
  end type solver_stage_t

  type :: linear_solver_t
    private
    !> The solver in use for matrices of this pattern, as long as it is good enough: the one chosen before they are known.
    type(solver_row_t), public :: row
    !> The solver chosen, its fallback, the fallback of that, ...
    type(solver_stage_t), allocatable :: stages(:)
    !> Stages of `row`, of the matrices to come in this step, and of the factors at hand.
    integer :: first = 1, now = 1, made_by = 0
    !> Order of elimination asked for; where every row of the matrix begins; its nonzeros.
    integer, allocatable :: position(:), row_start(:)
    real(wp), allocatable :: values(:)
    !> The factors at hand are sound.
    logical :: sound = .false.
    !> Matrices factorised so far, and those that were the one before, whose factors were taken again.
    integer, public :: factorised = 0, reused = 0
    !> Entries of the factors and operations of a factorisation.
    real(wp), public :: estimated_entries = 0.0_wp, estimated_flops = 0.0_wp
    !> Backward error of the last solve.
    real(wp), public :: residual = 0.0_wp
  end type linear_solver_t

contains

  !> Take the solver at this position of the list.
  subroutine choose_solver(solver, place)
    type(linear_solver_t), intent(inout) :: solver
    integer, intent(in) :: place
    type(solver_row_t), allocatable :: rows(:)
    integer :: k, n, at

    call release(solver)
    call list_solvers(rows)
    solver%row = rows(place)
    if (allocated(solver%stages)) deallocate (solver%stages)
    allocate (solver%stages(size(rows)))
    at = place
    do n = 1, size(rows)
      solver%stages(n)%row = rows(at)
      if (rows(at)%fallback == '') exit
      do k = 1, size(rows)
        if (rows(k)%name == solver%stages(n)%row%fallback) at = k
      end do
    end do
    solver%stages = solver%stages(:n)
  end subroutine choose_solver

  !> Plan the factorisation for a pattern and an order of elimination, by the first of the stages that is for so many operations.
  subroutine analyse(solver, pattern, position, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)   !! (neq)
    type(error_t), allocatable, intent(out) :: error

    call release(solver)
    solver%position = position
    allocate (solver%values(pattern%nnz))
    call start_rows(pattern, solver%row_start)
    do
      call plan_stage(solver, solver%first, pattern, error)
      if (allocated(error)) return
      associate (stage => solver%stages(solver%first))
        solver%row = stage%row
        solver%estimated_entries = stage%factors%entries
        solver%estimated_flops = stage%factors%operations
        if (stage%factors%operations >= stage%row%least_operations) exit
        call drop(stage%factors)
      end associate
      solver%first = solver%first + 1
    end do
    solver%now = solver%first
  end subroutine analyse

  subroutine plan_stage(solver, k, pattern, error)
    type(linear_solver_t), intent(inout) :: solver
    integer, intent(in) :: k
    class(matrix_pattern_t), intent(in) :: pattern
    type(error_t), allocatable, intent(out) :: error

    associate (stage => solver%stages(k))
      call stage%row%create(stage%factors)
      call stage%factors%plan(pattern, solver%position, error)
    end associate
  end subroutine plan_stage

  !> At the start of a step: the fallback of earlier steps does not count, or a resumed run would give other results.
  pure subroutine return_to_chosen(solver)
    type(linear_solver_t), intent(inout) :: solver

    solver%now = solver%first
  end subroutine return_to_chosen

  !> Factorise the matrix with these nonzeros, unless it is the one that sound factors are at hand of. A singular matrix gives
  !> exit_no_convergence: the step is cut back.
  subroutine factorise(solver, values, error)
    type(linear_solver_t), intent(inout) :: solver
    real(wp), intent(in) :: values(:)    !! (nnz) [residual/unknown]
    type(error_t), allocatable, intent(out) :: error

    if (solver%sound .and. solver%made_by == solver%now) then
      if (same_bits(values, solver%values)) then
        solver%reused = solver%reused + 1
        return
      end if
    end if
    solver%values = values
    call factorise_now(solver, error)
  end subroutine factorise

  !> The matrix at hand by the present stage.
  subroutine factorise_now(solver, error)
    type(linear_solver_t), intent(inout) :: solver
    type(error_t), allocatable, intent(out) :: error

    solver%factorised = solver%factorised + 1
    solver%made_by = solver%now
    call solver%stages(solver%now)%factors%factorise(solver%values, solver%sound, error)
    if (allocated(error)) solver%sound = .false.
  end subroutine factorise_now

  !> Equal to the last bit; two zeros of different sign are not.
  pure function same_bits(a, b) result(same)
    real(wp), intent(in) :: a(:), b(:)
    logical :: same
    integer :: k

    same = .false.
    do k = 1, size(a)
      if (transfer(a(k), 0_i8) /= transfer(b(k), 0_i8)) return
    end do
    same = .true.
  end function same_bits

  !> A matrix of the present pattern was factorised.
  pure function has_factors(solver) result(has)
    type(linear_solver_t), intent(in) :: solver
    logical :: has

    has = solver%made_by > 0
  end function has_factors

  !> Solve for one right-hand side with the present factors, refining while the residual is too large.
  !> Factors that prove too poor are made again by the fallback, for the rest of the step. It is a mistake of the program to ask for
  !> a solution before the first matrix of an analysis.
  subroutine solve_linear(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)       !! (neq) [residual]
    real(wp), intent(out) :: x(:)        !! (neq) [unknown]
    type(error_t), allocatable, intent(out) :: error

    x = 0
    if (solver%made_by == 0) then
      call fail(error, exit_bug, 'linear solver: a solution before the first matrix')
      return
    end if
    if (solver%sound) call refine(solver, pattern, rhs, x, error)
    if (allocated(error)) return
    do while (solver%now < size(solver%stages) .and. .not. (solver%sound .and. solver%residual <= linear_tolerance))
      solver%now = solver%now + 1
      if (.not. allocated(solver%stages(solver%now)%factors)) call plan_stage(solver, solver%now, pattern, error)
      if (.not. allocated(error)) call factorise_now(solver, error)
      if (solver%sound .and. .not. allocated(error)) call refine(solver, pattern, rhs, x, error)
      if (allocated(error)) return
    end do
    if (.not. solver%sound) then
      call fail(error, exit_no_convergence, 'the matrix has no factors: its factorisation failed')
    else if (.not. solver%residual <= linear_tolerance) then
      call fail(error, exit_no_convergence, 'linear residual '//to_text(solver%residual, 3)//' above ' &
                //to_text(linear_tolerance, 3))
    end if
  end subroutine solve_linear

  !> Solve with the factors at hand, not refined: what is added to a solution that is. `found` is false without sound factors.
  subroutine solve_unrefined(solver, x, found, error)
    type(linear_solver_t), intent(inout) :: solver
    real(wp), intent(inout) :: x(:)      !! (neq) [residual], then [unknown]
    logical, intent(out) :: found
    type(error_t), allocatable, intent(out) :: error

    found = solver%sound
    if (found) call solver%stages(solver%made_by)%factors%substitute(x, error)
  end subroutine solve_unrefined

  !> Entries of the inverse of the matrix at hand, in the rows and columns of these equations. `found` is false without sound
  !> factors, and where the solver cannot find them.
  subroutine invert_at(solver, equations, entries, found)
    type(linear_solver_t), intent(inout) :: solver
    integer, intent(in) :: equations(:)      !! (n), none twice
    real(wp), intent(out) :: entries(:, :)   !! (n, n) [unknown/residual]
    logical, intent(out) :: found

    found = .false.
    entries = 0
    if (solver%sound) call solver%stages(solver%made_by)%factors%invert(equations, entries, found)
  end subroutine invert_at

  !> Matrices are factorised in working precision for the rest of the step.
  subroutine use_working_precision(solver, pattern, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    type(error_t), allocatable, intent(out) :: error

    do while (solver%stages(solver%now)%row%single .and. solver%now < size(solver%stages))
      solver%now = solver%now + 1
      if (.not. allocated(solver%stages(solver%now)%factors)) call plan_stage(solver, solver%now, pattern, error)
      if (allocated(error)) return
    end do
  end subroutine use_working_precision

  !> Pivots below 0 of the matrix at hand, 0 without sound factors: as many as eigenvalues below 0 where it is symmetric, an odd
  !> number where its determinant is below 0. Near 0 in size they are sure in working precision alone.
  pure function negative_pivots(solver) result(n)
    type(linear_solver_t), intent(in) :: solver
    integer :: n

    n = 0
    if (solver%sound) n = solver%stages(solver%made_by)%factors%negative
  end function negative_pivots

  !> Solve, then correct by the residual while that is worth it.
  subroutine refine(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)       !! (neq) [residual]
    real(wp), intent(out) :: x(:)        !! (neq) [unknown]
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: residual(size(rhs)), correction(size(rhs)), scale, before
    integer :: k

    x = 0
    scale = 0
    residual = rhs
    solver%residual = huge(before)
    do k = 0, max_refinements
      before = solver%residual
      correction = residual
      call solver%stages(solver%now)%factors%substitute(correction, error)
      if (allocated(error)) return
      x = x + correction
      call linear_residual(pattern, solver%row_start, solver%values, rhs, x, residual, scale)
      solver%residual = 0
      if (scale > 0) solver%residual = length_of(residual)/scale
      if (.not. solver%residual > solver%stages(solver%now)%row%refine_above) exit
      if (solver%residual > worth_refining*before) exit
    end do
    if (scale > singular_growth*length_of(rhs)) then
      call fail(error, exit_no_convergence, 'the matrix is singular to working precision: is every body held?')
    end if
  end subroutine refine

  !> Give back what is held; the choice of the solver stays.
  subroutine release(solver)
    type(linear_solver_t), intent(inout) :: solver

    integer :: k

    if (allocated(solver%stages)) then
      do k = 1, size(solver%stages)
        call drop(solver%stages(k)%factors)
      end do
    end if
    if (allocated(solver%position)) deallocate (solver%position, solver%row_start, solver%values)
    solver%sound = .false.
    solver%first = 1
    solver%now = 1
    solver%made_by = 0
  end subroutine release

  subroutine drop(factors)
    class(factors_t), allocatable, intent(inout) :: factors

    if (.not. allocated(factors)) return
    call factors%release()
    deallocate (factors)
  end subroutine drop

end module linear_solver
