!> Members of the family of linear solvers.
submodule(linear_registry) linear_members
  use linear_front, only: linear_front_row
  use linear_mumps, only: linear_mumps_row
  implicit none
contains

  module procedure list_solvers
    allocate (rows(2))
    rows(1) = linear_front_row()
    rows(2) = linear_mumps_row()
  end procedure list_solvers

end submodule linear_members
