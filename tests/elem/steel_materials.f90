! The same steels as the tests of the laws.
include '../law/steel_materials.f90'
