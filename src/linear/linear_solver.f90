!> Direct solution of the linear system by the solver chosen: analysis once per mesh, factorisation per matrix (factors of a matrix
!> that comes again, to the last bit, are kept), residual of every solve checked and refined. A matrix for which the factors prove
!> too poor, and those after it in the step, get the fallback of the solver, where it has one.
module linear_solver
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: i8, wp
  use linear_api, only: factors_t, solver_row_t
  use linear_registry, only: list_solvers
  use matrix_pattern, only: matrix_pattern_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: linear_solver_t, choose_solver, analyse, factorise, solve_linear, release, return_to_chosen

  !> Backward error of a solve that is refined; and what is accepted at last.
  real(wp), parameter, public :: refine_above = 1.0e-14_wp
  real(wp), parameter, public :: linear_tolerance = 1.0e-10_wp
  integer, parameter :: max_refinements = 3
  !> Forces |A| |x| this many times the right-hand side are round-off of a singular matrix.
  real(wp), parameter :: singular_growth = 1.0e13_wp
  !> Fewer nonzeros are faster on one thread.
  integer, parameter :: worth_threads = 50000

  type :: linear_solver_t
    private
    !> The solver chosen.
    type(solver_row_t), public :: row
    !> Its factors, and those of its fallback once that was needed.
    class(factors_t), allocatable :: own, fallback
    !> Order of elimination asked for; where every row of the matrix begins; its nonzeros.
    integer, allocatable :: position(:), row_start(:)
    real(wp), allocatable :: values(:)
    !> The factors at hand are sound; they are to be made by the fallback; the fallback has made them.
    logical :: sound = .false., fallen_back = .false., by_fallback = .false.
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

    call release(solver)
    call list_solvers(rows)
    solver%row = rows(place)
  end subroutine choose_solver

  !> Plan the factorisation for a pattern and an order of elimination.
  subroutine analyse(solver, pattern, position, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)   !! (neq)
    type(error_t), allocatable, intent(out) :: error

    call release(solver)
    solver%position = position
    allocate (solver%values(pattern%nnz))
    call start_rows(pattern, solver%row_start)
    call solver%row%create(solver%own)
    call solver%own%plan(pattern, position, error)
    solver%estimated_entries = solver%own%entries
    solver%estimated_flops = solver%own%operations
  end subroutine analyse

  !> Nonzeros are sorted by row: where every row begins (neq + 1).
  pure subroutine start_rows(pattern, row_start)
    class(matrix_pattern_t), intent(in) :: pattern
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

  !> At the start of a step: the fallback of earlier steps does not count, or a resumed run would give other results.
  pure subroutine return_to_chosen(solver)
    type(linear_solver_t), intent(inout) :: solver

    solver%fallen_back = .false.
  end subroutine return_to_chosen

  !> Factorise the matrix with these nonzeros, unless it is the one that sound factors are at hand of. A singular matrix gives
  !> exit_no_convergence: the step is cut back.
  subroutine factorise(solver, values, error)
    type(linear_solver_t), intent(inout) :: solver
    real(wp), intent(in) :: values(:)    !! (nnz) [residual/unknown]
    type(error_t), allocatable, intent(out) :: error

    if (solver%sound .and. (solver%by_fallback .eqv. solver%fallen_back)) then
      if (same_bits(values, solver%values)) then
        solver%reused = solver%reused + 1
        return
      end if
    end if
    solver%values = values
    solver%factorised = solver%factorised + 1
    solver%by_fallback = solver%fallen_back
    if (solver%fallen_back) then
      call solver%fallback%factorise(solver%values, solver%sound, error)
    else
      call solver%own%factorise(solver%values, solver%sound, error)
    end if
    if (allocated(error)) solver%sound = .false.
  end subroutine factorise

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

  !> Solve for one right-hand side with the present factors, refining while the residual is too large.
  !> Factors that prove too poor are made again by the fallback, for the rest of the step.
  subroutine solve_linear(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)       !! (neq) [residual]
    real(wp), intent(out) :: x(:)        !! (neq) [unknown]
    type(error_t), allocatable, intent(out) :: error

    x = 0
    if (solver%sound) call refine(solver, pattern, rhs, x, error)
    if (allocated(error)) return
    if (can_fall_back(solver) .and. .not. (solver%sound .and. solver%residual <= linear_tolerance)) then
      call fall_back(solver, pattern, error)
      if (.not. allocated(error)) call refine(solver, pattern, rhs, x, error)
    end if
    if (allocated(error)) return
    if (.not. solver%sound) then
      call fail(error, exit_no_convergence, 'the matrix has no factors: its factorisation failed')
    else if (.not. solver%residual <= linear_tolerance) then
      call fail(error, exit_no_convergence, 'linear residual '//to_text(solver%residual, 3)//' above ' &
                //to_text(linear_tolerance, 3))
    end if
  end subroutine solve_linear

  pure function can_fall_back(solver) result(yes)
    type(linear_solver_t), intent(in) :: solver
    logical :: yes

    yes = solver%row%fallback /= '' .and. .not. solver%fallen_back
  end function can_fall_back

  !> Factorise the present matrix by the fallback, which is planned when it is needed first.
  subroutine fall_back(solver, pattern, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    type(error_t), allocatable, intent(out) :: error
    type(solver_row_t), allocatable :: rows(:)
    integer :: k

    solver%fallen_back = .true.
    if (.not. allocated(solver%fallback)) then
      call list_solvers(rows)
      do k = 1, size(rows)
        if (rows(k)%name == solver%row%fallback) call rows(k)%create(solver%fallback)
      end do
      call solver%fallback%plan(pattern, solver%position, error)
      if (allocated(error)) return
    end if
    solver%factorised = solver%factorised + 1
    solver%by_fallback = .true.
    call solver%fallback%factorise(solver%values, solver%sound, error)
  end subroutine fall_back

  !> Solve, then correct by the residual while that is worth it.
  subroutine refine(solver, pattern, rhs, x, error)
    type(linear_solver_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: rhs(:)       !! (neq) [residual]
    real(wp), intent(out) :: x(:)        !! (neq) [unknown]
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: residual(size(rhs)), correction(size(rhs)), scale
    integer :: k

    x = 0
    scale = 0
    residual = rhs
    do k = 0, max_refinements
      correction = residual
      if (solver%fallen_back) then
        call solver%fallback%substitute(correction, error)
      else
        call solver%own%substitute(correction, error)
      end if
      if (allocated(error)) return
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
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: row_start(:)   !! nonzeros of row i: row_start(i) ... row_start(i+1)-1
    real(wp), intent(in) :: a(:), rhs(:), x(:)
    real(wp), intent(out) :: residual(:), scale
    real(wp) :: magnitude(size(rhs)), left, large, product
    integer :: k, i, j

    !$omp parallel do private(k, left, large, product) schedule(static) if (pattern%nnz > worth_threads)
    do i = 1, pattern%neq
      left = rhs(i)
      large = abs(rhs(i))
      do k = row_start(i), row_start(i + 1) - 1
        product = a(k)*x(pattern%column(k))
        left = left - product
        large = large + abs(product)
      end do
      residual(i) = left
      magnitude(i) = large
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

  !> Give back what is held; the choice of the solver stays.
  subroutine release(solver)
    type(linear_solver_t), intent(inout) :: solver

    call drop(solver%own)
    call drop(solver%fallback)
    if (allocated(solver%position)) deallocate (solver%position, solver%row_start, solver%values)
    solver%sound = .false.
    solver%fallen_back = .false.
    solver%by_fallback = .false.
  end subroutine release

  subroutine drop(factors)
    class(factors_t), allocatable, intent(inout) :: factors

    if (.not. allocated(factors)) return
    call factors%release()
    deallocate (factors)
  end subroutine drop

end module linear_solver
