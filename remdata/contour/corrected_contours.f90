!> The corrected contour of a loop of the old mesh, and what is reported of all contours.
module corrected_contours
  use boundary_curves, only: boundary_curve_t
  use boundary_sides, only: loop_t
  use contour_contacts, only: contact_t
  use contour_laps, only: lap_t
  use folded_sides, only: fold_t
  use kinds, only: pi, wp
  use point_contacts, only: point_contact_t
  use side_tags, only: side_tags_t
  implicit none
  private
  public :: contour_options_t, contour_t, contact_limit_t, contour_report_t, some_contours

  type :: contour_options_t
    !> A corner is where the tangent turns by more than this [radian].
    real(wp) :: corner_turn = 20*pi/180
    !> Contact over less than this share of a side is contact at a point.
    real(wp) :: least_contact = 0.05_wp
    !> Gaps between two intervals no wider than this share of a side are closed: no mesh resolves them.
    real(wp) :: narrow_gap = 0.01_wp
    !> Gaps no wider than this share of a side, and no longer than some sides, are small gaps: their ends are not resolved by the
    !> mesh.
    real(wp) :: small_gap_width = 0.1_wp, small_gap_length = 2.0_wp
    !> Free sides that lead from a corner to contact are dropped when they are shorter [length].
    real(wp) :: least_free = 0.0_wp
    !> Loops up to this length, in which a free contour crosses itself, are cut off [length].
    real(wp) :: longest_lap = 0.0_wp
  end type contour_options_t

  !> Beginning or end of contact.
  type :: contact_limit_t
    integer :: kind = 0   !! `kind_entry` or `kind_exit`
    real(wp) :: point(2) = 0.0_wp   !! [length]
    !> Depth in the die: zero where the part leaves it, but not at a corner of the part [length].
    real(wp) :: depth = 0.0_wp
  end type contact_limit_t

  !> One loop of the old mesh, corrected.
  type :: contour_t
    type(loop_t) :: loop
    type(side_tags_t) :: tags
    type(boundary_curve_t) :: boundary
    !> Contact intervals that were replaced (`arc_t%interval` is their number).
    type(contact_t), allocatable :: contacts(:)
    !> Where contact is at a point.
    type(point_contact_t), allocatable :: points(:)
    !> Area, or volume per radian, inside the old loop and the boundary curve; negative around holes.
    real(wp) :: volume_before = 0.0_wp, volume_after = 0.0_wp
    !> Outward displacement of the free sides [length], and whether it restores the volume.
    real(wp) :: shift = 0.0_wp
    logical :: restored = .true.
    !> Largest distance from an old node of the loop to the boundary curve [length].
    real(wp) :: largest_move = 0.0_wp
    !> Small laps that were cut off.
    type(fold_t), allocatable :: laps(:)
  end type contour_t

  !> Results of the correction for all contours.
  type :: contour_report_t
    type(contact_limit_t), allocatable :: limits(:)
    type(lap_t), allocatable :: laps(:)
    !> Sides of a body that lie on other sides of it, and small laps that were cut off.
    type(fold_t), allocatable :: folds(:)
    !> Moves of the nodes of such sides (2, nnode), where there are any [length].
    real(wp), allocatable :: opened(:, :)
    !> Largest shift and move of all contours; largest relative change of volume of one [length, length, -].
    real(wp) :: largest_shift = 0.0_wp, largest_move = 0.0_wp, volume_error = 0.0_wp
    !> Largest distance from the contours to a kept end of contact as the solver found it, as a share of the contour.
    real(wp) :: off_ends = 0.0_wp
    !> Points of contact with nothing in contact beside them (2, n) [length].
    real(wp), allocatable :: points(:, :)
    !> Small gaps between contact intervals, whose ends are not among the limits.
    integer :: small_gaps = 0
    !> Contact intervals dropped because they run backwards along their die.
    integer :: backward_intervals = 0
  end type contour_report_t

contains

  !> Those of the contours that are chosen. (Types with allocatable components are copied one by one.)
  pure function some_contours(contours, chosen) result(some)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: chosen(:)             !! (ncontour)
    type(contour_t), allocatable :: some(:)
    integer :: c, k

    allocate (some(count(chosen)))
    k = 0
    do c = 1, size(contours)
      if (.not. chosen(c)) cycle
      k = k + 1
      some(k) = contours(c)
    end do
  end function some_contours

end module corrected_contours
