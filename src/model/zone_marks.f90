!> Zones as ZPNT and ZONE cards give them: quadrilaterals between named points, found anew on every contour; and contours of bodies
!> that have no mesh yet.
module zone_marks
  use kinds, only: wp
  implicit none
  private
  public :: zone_mark_t, zone_card_t, contour_card_t, name_length
  public :: mark_corner, mark_matter, mark_crossing, mark_inside

  integer, parameter :: name_length = 32

  !> What a point is: the corner of the contour nearest to a position, the material that was there at the start, where the contour
  !> crosses a line, or a position inside.
  integer, parameter :: mark_corner = 1, mark_matter = 2, mark_crossing = 3, mark_inside = 4

  !> A ZPNT card.
  type :: zone_mark_t
    character(len=name_length) :: name = ''
    integer :: form = 0
    !> The position; of a crossing the value of the line's coordinate twice [length].
    real(wp) :: x(2) = 0.0_wp
    !> Crossing of x = value (1) or y = value (2): the one with the largest (1) or the least (-1) other coordinate.
    integer :: axis = 0, pick = 0
    !> The position is that of material at the start, wherever it is now.
    logical :: by_matter = .false.
    !> The die that the position moves with, 0 for none.
    integer :: die = 0
    !> A point inside that smoothing leaves where it is.
    logical :: stays = .false.
  end type zone_mark_t

  !> A ZONE card.
  type :: zone_card_t
    character(len=name_length) :: name = ''
    !> Group its elements are of, and the ZPNT cards at its corners, either way round.
    integer :: group = 0, marks(4) = 0
  end type zone_card_t

  !> A BODY card: closed contours traversed with the part on their left, the outer one and those of holes.
  type :: contour_card_t
    integer :: group = 0
    !> Parabolas (2, 3, npiece) [length], the row of the card each comes of: the number of its side of the body; and the contour it
    !> is of, 1 is the outer one.
    real(wp), allocatable :: pieces(:, :, :)
    integer, allocatable :: row(:), loop(:)
    !> Sizes of its elements where bodies have their own; 0: those of all bodies [length].
    real(wp) :: smallest = 0.0_wp, largest = 0.0_wp
  end type contour_card_t

end module zone_marks
