!> The list of transfer methods. Only its submodule knows the members.
module transfer_registry
  use transfer_api, only: transfer_t
  implicit none
  private
  public :: list_transfers

  interface
    !> All methods, in a fixed order: a method's place is its number + 1.
    module subroutine list_transfers(rows)
      type(transfer_t), allocatable, intent(out) :: rows(:)
    end subroutine list_transfers
  end interface
end module transfer_registry
