!> Report of a state transfer.
module transfer_report
  use kinds, only: wp
  use text, only: string_t, to_text
  implicit none
  private
  public :: carried_quantity_t, transfer_report_t, report_lines, in_words

  !> One component of a variable in one material, over the volume (per unit thickness or per radian).
  type :: carried_quantity_t
    character(len=:), allocatable :: name, unit, transfer
    integer :: material = 0
    !> Integrals in the old mesh, and in the new one as carried, in range, and after the correction [unit volume].
    real(wp) :: before = 0.0_wp, carried = 0.0_wp, limited = 0.0_wp, after = 0.0_wp
    !> Integral of the absolute value in the old mesh, which differences are judged by [unit volume].
    real(wp) :: magnitude = 0.0_wp
    !> Ranges in the old and the new mesh [unit].
    real(wp) :: least_before = 0.0_wp, largest_before = 0.0_wp, least_after = 0.0_wp, largest_after = 0.0_wp
    !> Share of the volume whose values were limited to their range.
    real(wp) :: clipped = 0.0_wp
  end type carried_quantity_t

  type :: transfer_report_t
    !> Name of the method.
    character(len=:), allocatable :: method
    !> Volumes of the materials (nmaterial) in the old and in the new mesh, per unit thickness or per radian.
    real(wp), allocatable :: volume_before(:), volume_after(:)
    !> One row per component and material.
    type(carried_quantity_t), allocatable :: rows(:)
    !> New points outside the old mesh, and the distance of the farthest [length]; 0 for methods that do not compute it.
    integer :: points_outside = 0
    real(wp) :: farthest = 0.0_wp
    !> New points whose polynomial was of a lower degree than requested.
    integer :: lower_degree = 0
  end type transfer_report_t

contains

  !> The report as text, a line per material and component: integrals before and after, the change over the integral of the
  !> absolute value before and after the correction, ranges, and the share of the volume limited to its range.
  pure subroutine report_lines(report, lines)
    type(transfer_report_t), intent(in) :: report
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    integer :: m, k, n

    allocate (lines(1 + count(report%volume_after > 0) + size(report%rows)))
lines(1)%s = 'transfer by '//report%method//': '//to_text(report%points_outside)//' points outside the old mesh, the farthest by ' &
                 //to_text(report%farthest)//'; polynomial of lower degree at '//to_text(report%lower_degree)//' points'
    n = 1
    do m = 1, size(report%volume_after)
      if (.not. report%volume_after(m) > 0) cycle
      n = n + 1
      lines(n)%s = 'material '//to_text(m)//': volume '//to_text(report%volume_before(m))//' -> ' &
                   //to_text(report%volume_after(m))//' ('//percent(report%volume_after(m) - report%volume_before(m), &
                                                                    report%volume_before(m))//')'
      do k = 1, size(report%rows)
        if (report%rows(k)%material /= m) cycle
        n = n + 1
        lines(n)%s = in_words(report%rows(k))
      end do
    end do
  end subroutine report_lines

  !> One row: integrals before and after, ranges.
  pure function in_words(row) result(words)
    type(carried_quantity_t), intent(in) :: row
    character(len=:), allocatable :: words

    words = '  '//row%name//': integral '//to_text(row%before)//' -> '//to_text(row%after)//' (' &
            //percent(row%carried - row%before, row%magnitude)//' as carried, '//percent(row%after - row%before, row%magnitude) &
            //' left), range '//to_text(row%least_before)//' ... '//to_text(row%largest_before)//' -> ' &
            //to_text(row%least_after)//' ... '//to_text(row%largest_after)
    if (row%clipped > 0) words = words//', '//percent(row%clipped, 1.0_wp)//' of the volume was out of range'
  end function in_words

  pure function percent(part, whole) result(words)
    real(wp), intent(in) :: part, whole
    character(len=:), allocatable :: words

    words = to_text(100*part/max(whole, tiny(1.0_wp)), 3)//' %'
  end function percent

end module transfer_report
