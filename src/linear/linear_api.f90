!> The family of linear solvers: factors that a member makes of a matrix and solves with, and the row that a member is listed by.
module linear_api
  use errors, only: error_t
  use kinds, only: wp
  use matrix_pattern, only: matrix_pattern_t
  implicit none
  private
  public :: factors_t, solver_row_t

  !> Factors of one matrix at a time. Order of calls: plan, then factorise for every matrix, then substitute for every right-hand
  !> side. `linear_solver` checks the residuals and refines: a member need not.
  type, abstract :: factors_t
    !> Entries of the factors and operations of a factorisation, as planned.
    real(wp) :: entries = 0.0_wp, operations = 0.0_wp
    !> Pivots below 0 of the matrix factorised last: as many as it has eigenvalues below 0 where it is symmetric; else an odd number
    !> where its determinant is below 0, 1 by a member that exchanges rows.
    integer :: negative = 0
  contains
    procedure(plan_i), deferred :: plan
    procedure(factorise_i), deferred :: factorise
    procedure(substitute_i), deferred :: substitute
    procedure(release_i), deferred :: release
    procedure :: invert => invert_nothing
  end type factors_t

  type :: solver_row_t
    character(len=:), allocatable :: name, purpose
    !> Name of the solver that takes over for the rest of a step when the factors of this one are too poor; '': none.
    character(len=:), allocatable :: fallback
    !> Backward error of a solve that is refined.
    real(wp) :: refine_above = 1.0e-14_wp
    !> Fewer operations of a factorisation are left to the fallback.
    real(wp) :: least_operations = 0.0_wp
    !> Its factors are of single precision: the sign of a small pivot is not sure.
    logical :: single = .false.
    !> Its factors find entries of the inverse.
    logical :: inverts = .false.
    procedure(create_i), nopass, pointer :: create => null()
  end type solver_row_t

  abstract interface
    !> Factors of the member's own type, nothing planned.
    subroutine create_i(factors)
      import :: factors_t
      class(factors_t), allocatable, intent(out) :: factors
    end subroutine create_i

    !> Analyse a pattern, once for all matrices that have it.
    subroutine plan_i(self, pattern, position, error)
      import :: error_t, factors_t, matrix_pattern_t
      class(factors_t), intent(inout) :: self
      class(matrix_pattern_t), intent(in) :: pattern
      integer, intent(in) :: position(:)   !! (neq) position of every equation in the order of elimination
      type(error_t), allocatable, intent(out) :: error
    end subroutine plan_i

    !> Factorise the matrix with these nonzeros. Where there are no usable factors, `sound` is false if the member has a fallback;
    !> one without gives an error, exit_no_convergence for a singular matrix.
    subroutine factorise_i(self, values, sound, error)
      import :: error_t, factors_t, wp
      class(factors_t), intent(inout) :: self
      real(wp), intent(in) :: values(:)    !! (nnz) [residual/unknown]
      logical, intent(out) :: sound
      type(error_t), allocatable, intent(out) :: error
    end subroutine factorise_i

    !> x := A^-1 x with the present factors.
    subroutine substitute_i(self, x, error)
      import :: error_t, factors_t, wp
      class(factors_t), intent(inout) :: self
      real(wp), intent(inout) :: x(:)      !! (neq) [residual], then [unknown]
      type(error_t), allocatable, intent(out) :: error
    end subroutine substitute_i

    !> Give back what is held; without effect where nothing is.
    subroutine release_i(self)
      import :: factors_t
      class(factors_t), intent(inout) :: self
    end subroutine release_i
  end interface

contains

  !> Entries of the inverse in the rows and columns of these equations, where the member can find them cheaply: this one cannot.
  subroutine invert_nothing(self, equations, entries, found)
    class(factors_t), intent(inout) :: self
    integer, intent(in) :: equations(:)      !! (n), none twice
    real(wp), intent(out) :: entries(:, :)   !! (n, n) [unknown/residual]
    logical, intent(out) :: found

    entries = 0
    found = .false.
  end subroutine invert_nothing

end module linear_api
