! The same materials as the tests of the laws.
include '../law/law_cases.f90'
