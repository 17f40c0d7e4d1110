!> Asserts that need no table of types and ranks: conditions, single reals, texts.
module funit_basic
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
  use, intrinsic :: iso_fortran_env, only: real64
  use funit_report, only: SourceLocation, integer_to_text, real_to_text, report_failure, same_shape, shape_to_text
  implicit none
  private
  public :: assertEqual, assertTrue, assertFalse, assertFail, fail, assertIsNaN, assertIsFinite

  !> Texts are equal as `==` has it: blanks at the end do not count, blanks before do.
  interface assertEqual
    module procedure :: equal_text
    module procedure :: equal_text_list
    module procedure :: equal_text_lists
  end interface assertEqual

  interface assertTrue
    module procedure :: true_scalar
    module procedure :: true_list
  end interface assertTrue

  interface assertFalse
    module procedure :: false_scalar
    module procedure :: false_list
  end interface assertFalse

  !> A test that should not have come here; both names are pFUnit's.
  interface fail
    module procedure :: assertFail
  end interface fail

contains

  subroutine assertFail(message, location)
    character(len=*), intent(in) :: message
    type(SourceLocation), intent(in), optional :: location

    call report_failure('assertFail', '', message, location)
  end subroutine assertFail

  subroutine true_scalar(condition, message, location)
    logical, intent(in) :: condition
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. condition) call report_failure('assertTrue', 'expected T, actual F', message, location)
  end subroutine true_scalar

  subroutine true_list(condition, message, location)
    logical, intent(in) :: condition(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (all(condition)) return
    call report_failure('assertTrue', 'expected all T, actual F at '// &
                        shape_to_text(pack_index(.not. condition)), message, location)
  end subroutine true_list

  subroutine false_scalar(condition, message, location)
    logical, intent(in) :: condition
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (condition) call report_failure('assertFalse', 'expected F, actual T', message, location)
  end subroutine false_scalar

  subroutine false_list(condition, message, location)
    logical, intent(in) :: condition(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. any(condition)) return
    call report_failure('assertFalse', 'expected all F, actual T at '// &
                        shape_to_text(pack_index(condition)), message, location)
  end subroutine false_list

  subroutine assertIsNaN(x, message, location)
    real(real64), intent(in) :: x
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. ieee_is_nan(x)) call report_failure('assertIsNaN', 'expected NaN, actual '//real_to_text(x), message, location)
  end subroutine assertIsNaN

  subroutine assertIsFinite(x, message, location)
    real(real64), intent(in) :: x
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (.not. ieee_is_finite(x)) call report_failure('assertIsFinite', 'expected a finite number, actual '// &
                                                     real_to_text(x), message, location)
  end subroutine assertIsFinite

  subroutine equal_text(expected, actual, message, location)
    character(len=*), intent(in) :: expected, actual
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    if (expected /= actual) call report_failure('assertEqual', "expected '"//trim(expected)//"', actual '"// &
                                                trim(actual)//"'", message, location)
  end subroutine equal_text

  subroutine equal_text_list(expected, actual, message, location)
    character(len=*), intent(in) :: expected, actual(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    call equal_text_lists(spread(expected, 1, size(actual)), actual, message, location)
  end subroutine equal_text_list

  subroutine equal_text_lists(expected, actual, message, location)
    character(len=*), intent(in) :: expected(:), actual(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    integer :: i

    if (.not. same_shape('assertEqual', shape(expected), shape(actual), message, location)) return
    do i = 1, size(actual)
      if (expected(i) == actual(i)) cycle
      call report_failure('assertEqual', 'at ('//integer_to_text(i)//"): expected '"//trim(expected(i))//"', actual '"// &
                          trim(actual(i))//"'", message, location)
      return
    end do
  end subroutine equal_text_lists

  !> Where the condition holds.
  pure function pack_index(condition) result(at)
    logical, intent(in) :: condition(:)
    integer, allocatable :: at(:)
    integer :: i

    at = pack([(i, i=1, size(condition))], condition)
  end function pack_index

end module funit_basic
