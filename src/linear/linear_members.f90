!> Members of the family of linear solvers.
submodule(linear_registry) linear_members
  use linear_front, only: linear_front_row
  use linear_mixed, only: linear_mixed_row
  use linear_mumps, only: linear_mumps_row
  implicit none
contains

  module procedure list_solvers
    allocate (rows(3))
    rows(1) = linear_mixed_row()
    rows(2) = linear_front_row()
    rows(3) = linear_mumps_row()
  end procedure list_solvers

end submodule linear_members
