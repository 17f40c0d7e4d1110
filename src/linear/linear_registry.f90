!> The list of linear solvers. Only its submodule uses the members.
module linear_registry
  use linear_api, only: solver_row_t
  implicit none
  private
  public :: list_solvers

  interface
    !> All linear solvers, in a fixed order; the first is the default.
    module subroutine list_solvers(rows)
      type(solver_row_t), allocatable, intent(out) :: rows(:) !! (nsolver)
    end subroutine list_solvers
  end interface
end module linear_registry
