!> The list of transfer methods. Only its submodule uses the members.
module transfer_registry
  use transfer_api, only: transfer_t
  implicit none
  private
  public :: list_transfers

  interface
    !> All methods, in a fixed order: a method's index is its number + 1.
    module subroutine list_transfers(rows)
      type(transfer_t), allocatable, intent(out) :: rows(:)   !! (nmethod)
    end subroutine list_transfers
  end interface
end module transfer_registry
