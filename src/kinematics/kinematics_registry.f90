!> The list of kinematics. Only its submodule uses the members.
module kinematics_registry
  use kinematics_api, only: kinematics_t
  implicit none
  private
  public :: list_kinematics

  interface
    !> All kinematics, in a fixed order: a member's position is its `kinematics_id`.
    module subroutine list_kinematics(rows)
      type(kinematics_t), allocatable, intent(out) :: rows(:)   !! (nrow)
    end subroutine list_kinematics
  end interface
end module kinematics_registry
