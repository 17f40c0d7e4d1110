! The same scenes of one element as the tests of elements.
include '../elem/element_cases.f90'
