!> What a run of tests knows: where an assert stands, what failed so far.
!> Asserts have no argument to carry the run, so it is held here; nothing but the runner and the asserts may use it.
module funit_report
  use, intrinsic :: iso_fortran_env, only: output_unit
  implicit none
  private
  public :: SourceLocation, anyExceptions
  public :: open_test, failed_asserts, report_failure, same_shape, shape_to_text, integer_to_text, real_to_text

  !> Line of a test file; pFUnit's name, since the translated files spell it.
  type :: SourceLocation
    character(len=255) :: file = '(unknown file)'
    integer :: line = 0
  end type SourceLocation

  !> Name of the test that runs, and how many of its asserts have failed.
  character(len=:), allocatable, save :: running
  integer, save :: failures = 0

contains

  !> A test of this name starts: nothing has failed in it yet.
  subroutine open_test(name)
    character(len=*), intent(in) :: name

    running = name
    failures = 0
  end subroutine open_test

  !> Failed asserts of the test that runs.
  integer function failed_asserts()
    failed_asserts = failures
  end function failed_asserts

  !> Has an assert of the running test failed? A test returns as soon as this is so.
  logical function anyExceptions()
    anyExceptions = failures > 0
  end function anyExceptions

  !> Count a failed assert and say where, which one, and why.
  subroutine report_failure(assert, reason, message, location)
    !> Name of the assert.
    character(len=*), intent(in) :: assert
    !> Expected and actual, in words; may be empty.
    character(len=*), intent(in) :: reason
    !> What the author of the test wants read when it fails.
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
    type(SourceLocation) :: place

    failures = failures + 1
    if (present(location)) place = location
    write (output_unit, '(a,":",i0,": ",a,": ",a," failed")') trim(place%file), place%line, running, assert
    if (present(message)) write (output_unit, '(4x,a)') message
    if (len(reason) > 0) write (output_unit, '(4x,a)') reason
    flush (output_unit)
  end subroutine report_failure

  !> Do the shapes agree? A scalar, which has none, agrees with everything; a difference is a failure.
  logical function same_shape(assert, expected, actual, message, location)
    character(len=*), intent(in) :: assert
    integer, intent(in) :: expected(:), actual(:)
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location

    same_shape = size(expected) == 0
    if (.not. same_shape .and. size(expected) == size(actual)) same_shape = all(expected == actual)
    if (.not. same_shape) call report_failure(assert, 'expected shape '//shape_to_text(expected)// &
                                              ', actual shape '//shape_to_text(actual), message, location)
  end function same_shape

  !> Shape or index as (2,3).
  pure function shape_to_text(numbers) result(s)
    integer, intent(in) :: numbers(:)
    character(len=:), allocatable :: s
    integer :: i

    s = '('
    do i = 1, size(numbers)
      if (i > 1) s = s//','
      s = s//integer_to_text(numbers(i))
    end do
    s = s//')'
  end function shape_to_text

  pure function integer_to_text(value) result(s)
    integer, intent(in) :: value
    character(len=:), allocatable :: s
    character(len=20) :: buffer

    write (buffer, '(i0)') value
    s = trim(buffer)
  end function integer_to_text

  !> Every digit a double has, so that two numbers which differ never print alike.
  pure function real_to_text(value) result(s)
    use, intrinsic :: iso_fortran_env, only: real64
    real(real64), intent(in) :: value
    character(len=:), allocatable :: s
    character(len=32) :: buffer

    write (buffer, '(es32.16e3)') value
    s = trim(adjustl(buffer))
  end function real_to_text

end module funit_report
