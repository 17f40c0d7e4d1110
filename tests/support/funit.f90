!> What a test file uses: the names of pFUnit that the project's tests need, and no more.
module funit
  use funit_basic, only: assertEqual, assertTrue, assertFalse, assertFail, fail, assertIsNaN, assertIsFinite
  use funit_numbers, only: assertEqual, assertNotEqual, assertRelativelyEqual, assertLessThan, assertLessThanOrEqual, &
                           assertGreaterThan, assertGreaterThanOrEqual
  use funit_report, only: SourceLocation, anyExceptions
  implicit none
  private
  public :: assertEqual, assertNotEqual, assertRelativelyEqual
  public :: assertLessThan, assertLessThanOrEqual, assertGreaterThan, assertGreaterThanOrEqual
  public :: assertTrue, assertFalse, assertFail, fail, assertIsNaN, assertIsFinite
  public :: SourceLocation, anyExceptions
end module funit
