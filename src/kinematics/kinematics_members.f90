!> Members of the kinematics family.
submodule(kinematics_registry) kinematics_members
  use kinematics_jaumann, only: kinematics_jaumann_row
  use kinematics_log, only: kinematics_log_row
  use kinematics_small, only: kinematics_small_row
  implicit none
contains

  module procedure list_kinematics
    allocate (rows(3))
    rows(1) = kinematics_log_row()
    rows(2) = kinematics_small_row()
    rows(3) = kinematics_jaumann_row()
  end procedure list_kinematics

end submodule kinematics_members
