!> Factors by the multifrontal factorisation of this program.
module front_factors
  use errors, only: error_t
  use front_inverse, only: inverse_entries
  use kinds, only: wp
  use linear_api, only: factors_t
  use matrix_pattern, only: matrix_pattern_t
  use multifrontal, only: decompose, multifrontal_t, plan, substitute
  implicit none
  private
  public :: create_front

  type, extends(factors_t) :: front_t
    type(multifrontal_t) :: fronts
  contains
    procedure :: plan => plan_front
    procedure :: factorise => factorise_front
    procedure :: substitute => substitute_front
    procedure :: release => release_front
    procedure :: invert => invert_front
  end type front_t

contains

  subroutine create_front(factors)
    class(factors_t), allocatable, intent(out) :: factors

    allocate (front_t :: factors)
  end subroutine create_front

  subroutine plan_front(self, pattern, position, error)
    class(front_t), intent(inout) :: self
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)
    type(error_t), allocatable, intent(out) :: error

    call plan(self%fronts, pattern, position, error)
    self%entries = real(self%fronts%layout%factor_length, wp)
    self%operations = self%fronts%layout%flops
  end subroutine plan_front

  subroutine factorise_front(self, values, sound, error)
    class(front_t), intent(inout) :: self
    real(wp), intent(in) :: values(:)
    logical, intent(out) :: sound
    type(error_t), allocatable, intent(out) :: error

    call decompose(self%fronts, values, sound)
    self%negative = self%fronts%negative
  end subroutine factorise_front

  subroutine substitute_front(self, x, error)
    class(front_t), intent(inout) :: self
    real(wp), intent(inout) :: x(:)
    type(error_t), allocatable, intent(out) :: error

    call substitute(self%fronts, x)
  end subroutine substitute_front

  subroutine invert_front(self, equations, entries, found)
    class(front_t), intent(inout) :: self
    integer, intent(in) :: equations(:)
    real(wp), intent(out) :: entries(:, :)
    logical, intent(out) :: found

    call inverse_entries(self%fronts%layout, self%fronts%factors, equations, entries)
    found = .true.
  end subroutine invert_front

  subroutine release_front(self)
    class(front_t), intent(inout) :: self

    self%fronts = multifrontal_t()
  end subroutine release_front

end module front_factors
