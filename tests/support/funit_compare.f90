!> Compare lists of numbers, of reals and of logicals: the one place where it is decided what passes.
!> A relation holds for every element or the assert fails; NaN satisfies no relation.
module funit_compare
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use, intrinsic :: iso_fortran_env, only: int64, real64
  use funit_report, only: SourceLocation, integer_to_text, real_to_text, report_failure, same_shape, shape_to_text
  implicit none
  private
  public :: compare_reals, compare_integers, compare_logicals
  public :: is_equal, is_not_equal, is_less, is_less_or_equal, is_greater, is_greater_or_equal, is_relatively_equal

  integer, parameter :: is_equal = 1, is_not_equal = 2, is_less = 3, is_less_or_equal = 4
  integer, parameter :: is_greater = 5, is_greater_or_equal = 6, is_relatively_equal = 7

  !> Names of the asserts, by relation.
  character(len=*), parameter :: assert_names(7) = [character(len=24) :: 'assertEqual', 'assertNotEqual', &
                                                    'assertLessThan', 'assertLessThanOrEqual', 'assertGreaterThan', &
                                                    'assertGreaterThanOrEqual', 'assertRelativelyEqual']
  !> How the actual value should stand to the other, by relation; `<` and `>` read from the first to the second.
  character(len=*), parameter :: symbols(7) = [character(len=2) :: '==', '/=', '<', '<=', '>', '>=', '==']

contains

  !> All elements of `expected` against those of `actual`, both in storage order; `expected` may be one scalar.
  subroutine compare_reals(relation, expected, actual, shape_expected, shape_actual, tolerance, message, location)
    integer, intent(in) :: relation
    real(real64), intent(in) :: expected(:), actual(:)
    !> Shapes the two had in the test; no element for a scalar.
    integer, intent(in) :: shape_expected(:), shape_actual(:)
    !> Absolute; for `is_relatively_equal` a fraction of the expected value.
    real(real64), intent(in), optional :: tolerance
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    character(len=:), allocatable :: name, reason
    real(real64) :: e, first_e, first_a, slack
    integer :: i, bad, first

    name = trim(assert_names(relation))
    if (.not. same_shape(name, shape_expected, shape_actual, message, location)) return
    slack = 0
    if (present(tolerance)) slack = tolerance
    bad = 0
    first = 0
    first_e = 0
    first_a = 0
    do i = 1, size(actual)
      e = expected(merge(1, i, size(shape_expected) == 0))
      if (holds(relation, e, actual(i), slack)) cycle
      bad = bad + 1
      if (bad > 1) cycle
      first = i
      first_e = e
      first_a = actual(i)
    end do
    if (bad == 0) return
    reason = describe(relation, real_to_text(first_e), real_to_text(first_a), first, bad, shape_actual)
    if (present(tolerance)) reason = reason//', tolerance '//real_to_text(tolerance)
    if (relation == is_relatively_equal .and. .not. ieee_is_nan(first_e)) then
      if (.not. abs(first_e) > 0) reason = reason//' (zero has no relative difference)'
    end if
    call report_failure(name, reason, message, location)
  end subroutine compare_reals

  !> As `compare_reals`, exactly.
  subroutine compare_integers(relation, expected, actual, shape_expected, shape_actual, message, location)
    integer, intent(in) :: relation
    integer(int64), intent(in) :: expected(:), actual(:)
    integer, intent(in) :: shape_expected(:), shape_actual(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    character(len=:), allocatable :: name
    integer(int64) :: e, first_e, first_a
    integer :: i, bad, first

    name = trim(assert_names(relation))
    if (.not. same_shape(name, shape_expected, shape_actual, message, location)) return
    bad = 0
    first = 0
    first_e = 0
    first_a = 0
    do i = 1, size(actual)
      e = expected(merge(1, i, size(shape_expected) == 0))
      if (integer_holds(relation, e, actual(i))) cycle
      bad = bad + 1
      if (bad > 1) cycle
      first = i
      first_e = e
      first_a = actual(i)
    end do
    if (bad > 0) call report_failure(name, describe(relation, long_to_text(first_e), long_to_text(first_a), first, bad, &
                                                    shape_actual), message, location)
  end subroutine compare_integers

  !> Equal or not equal only; a logical counts as 0 or 1 and is shown as F or T.
  subroutine compare_logicals(relation, expected, actual, shape_expected, shape_actual, message, location)
    integer, intent(in) :: relation
    logical, intent(in) :: expected(:), actual(:)
    integer, intent(in) :: shape_expected(:), shape_actual(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    character(len=:), allocatable :: name
    integer :: i, bad, first
    logical :: e, first_e

    name = trim(assert_names(relation))
    if (.not. same_shape(name, shape_expected, shape_actual, message, location)) return
    bad = 0
    first = 0
    first_e = .false.
    do i = 1, size(actual)
      e = expected(merge(1, i, size(shape_expected) == 0))
      if ((e .eqv. actual(i)) .eqv. (relation == is_equal)) cycle
      bad = bad + 1
      if (bad > 1) cycle
      first = i
      first_e = e
    end do
    if (bad > 0) call report_failure(name, describe(relation, merge('T', 'F', first_e), merge('T', 'F', actual(first)), &
                                                    first, bad, shape_actual), message, location)
  end subroutine compare_logicals

  !> The rule for reals. Equality is looked at first, since infinity minus infinity is no number.
  elemental logical function holds(relation, e, a, tolerance)
    integer, intent(in) :: relation
    real(real64), intent(in) :: e, a, tolerance

    holds = .false.
    if (ieee_is_nan(e) .or. ieee_is_nan(a) .or. ieee_is_nan(tolerance)) return
    select case (relation)
    case (is_equal)
      holds = (e >= a .and. e <= a)
      if (.not. holds) holds = abs(a - e) <= tolerance
    case (is_not_equal)
      holds = .not. (e >= a .and. e <= a)
      if (holds) holds = abs(a - e) > tolerance
    case (is_less)
      holds = e < a + tolerance
    case (is_less_or_equal)
      holds = e <= a + tolerance
    case (is_greater)
      holds = e > a - tolerance
    case (is_greater_or_equal)
      holds = e >= a - tolerance
    case (is_relatively_equal)
      holds = abs(e) > 0
      if (holds) holds = abs(a - e) <= tolerance*abs(e)
    end select
  end function holds

  !> The rule for integers.
  elemental logical function integer_holds(relation, e, a) result(holds)
    integer, intent(in) :: relation
    integer(int64), intent(in) :: e, a

    holds = .false.
    select case (relation)
    case (is_equal)
      holds = e == a
    case (is_not_equal)
      holds = e /= a
    case (is_less)
      holds = e < a
    case (is_less_or_equal)
      holds = e <= a
    case (is_greater)
      holds = e > a
    case (is_greater_or_equal)
      holds = e >= a
    end select
  end function integer_holds

  !> `at (2,1), first of 3: expected 1, actual 2`, or `3 is not < 2` for an order.
  pure function describe(relation, e, a, first, bad, extents) result(s)
    integer, intent(in) :: relation
    character(len=*), intent(in) :: e, a
    !> Position of the first failure in storage order, and how many there are.
    integer, intent(in) :: first, bad
    integer, intent(in) :: extents(:)
    character(len=:), allocatable :: s

    s = ''
    if (size(extents) > 0) s = 'at '//shape_to_text(position(first, extents))//', '//integer_to_text(bad)//' of '// &
                               integer_to_text(product(extents))//' elements wrong: '
    select case (relation)
    case (is_equal, is_relatively_equal)
      s = s//'expected '//e//', actual '//a
    case (is_not_equal)
      s = s//'expected anything but '//e//', actual '//a
    case default
      s = s//e//' is not '//trim(symbols(relation))//' '//a
    end select
  end function describe

  !> Index of an element from its position in storage order.
  pure function position(number, extents) result(at)
    integer, intent(in) :: number, extents(:)
    integer :: at(size(extents)), rest, d

    rest = number - 1
    do d = 1, size(extents)
      at(d) = modulo(rest, extents(d)) + 1
      rest = rest/extents(d)
    end do
  end function position

  pure function long_to_text(value) result(s)
    integer(int64), intent(in) :: value
    character(len=:), allocatable :: s
    character(len=20) :: buffer

    write (buffer, '(i0)') value
    s = trim(buffer)
  end function long_to_text

end module funit_compare
