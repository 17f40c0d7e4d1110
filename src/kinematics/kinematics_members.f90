!> Members of the kinematics family.
submodule(kinematics_registry) kinematics_members
  use kinematics_log, only: kinematics_log_row
  use kinematics_small, only: kinematics_small_row
  implicit none
contains

  module procedure list_kinematics
    allocate (rows(2))
    rows(1) = kinematics_log_row()
    rows(2) = kinematics_small_row()
  end procedure list_kinematics

end submodule kinematics_members
