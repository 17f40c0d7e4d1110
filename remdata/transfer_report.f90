!> What a state transfer tells of itself.
module transfer_report
  use kinds, only: wp
  implicit none
  private
  public :: balance_t, transfer_report_t

  !> One component of a variable in one material, over the volume (per unit thickness or per radian).
  type :: balance_t
    character(len=:), allocatable :: name, unit, transfer
    integer :: material = 0
    !> Integrals in the old mesh, and in the new one as carried, in range, and after the correction [unit volume].
    real(wp) :: before = 0.0_wp, carried = 0.0_wp, limited = 0.0_wp, after = 0.0_wp
    !> Integral of the absolute value in the old mesh, which differences are judged by [unit volume].
    real(wp) :: magnitude = 0.0_wp
    !> Ranges in the old and the new mesh [unit].
    real(wp) :: least_before = 0.0_wp, largest_before = 0.0_wp, least_after = 0.0_wp, largest_after = 0.0_wp
    !> Share of the volume whose values were brought back into range.
    real(wp) :: clipped = 0.0_wp
  end type balance_t

  type :: transfer_report_t
    !> Name of the method.
    character(len=:), allocatable :: method
    !> Volumes of the materials (nmaterial) in the old and in the new mesh, per unit thickness or per radian.
    real(wp), allocatable :: volume_before(:), volume_after(:)
    !> One row a component and material.
    type(balance_t), allocatable :: rows(:)
    !> New points outside the old mesh, and the farthest of them [length]; 0 for methods that do not look.
    integer :: points_outside = 0
    real(wp) :: farthest = 0.0_wp
    !> New points whose polynomial was of a lower degree than asked for.
    integer :: lower_degree = 0
  end type transfer_report_t

end module transfer_report
