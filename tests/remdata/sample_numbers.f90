! The same numbers as the tests of the laws.
include '../law/sample_numbers.f90'
