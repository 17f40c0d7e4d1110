!> Members of the transfer family.
submodule(transfer_registry) transfer_members
  use transfer_inverse_distance, only: transfer_inverse_distance_row
  use transfer_moving_squares, only: transfer_moving_squares_row
  use transfer_patches, only: transfer_patches_row
  implicit none
contains

  module procedure list_transfers
    allocate (rows(3))
    rows(1) = transfer_inverse_distance_row()
    rows(2) = transfer_moving_squares_row()
    rows(3) = transfer_patches_row()
  end procedure list_transfers

end submodule transfer_members
