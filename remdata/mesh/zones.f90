!> Quadrilateral zones of a part, the points at their corners and the sides they share: their data, and where they are.
module zones
  use boundary_curves, only: boundary_curve_t, position_t
  use kinds, only: wp
  use offset_parabolas, only: exact_point
  use zone_marks, only: name_length
  implicit none
  private
  public :: zone_point_t, zone_t, plan_t, zone_side_t, zone_layout_t, coordinates_of, on_boundary
  public :: as_found, follows_contour, runs_straight, runs_curved, follows_interface

  !> Form of a zone side: along the contour where one zone has it and straight where two have it, or as specified.
  integer, parameter :: as_found = 0, follows_contour = 1, runs_straight = 2, runs_curved = 3, follows_interface = 4

  !> A corner of zones: a position on a boundary curve, or coordinates inside the part.
  type :: zone_point_t
    integer :: boundary = 0   !! 0: inside
    type(position_t) :: position
    real(wp) :: x(2) = 0.0_wp   !! [length], read inside only
    !> Unless it is fixed by the user, a point inside may be moved by smoothing, and one on a contour to a corner close by.
    logical :: stays = .false.
    !> It is at a corner of the contour, not at a position or material point given by the user.
    logical :: by_shape = .false.
    !> As cards name it.
    character(len=name_length) :: name = ''
  end type zone_point_t

  type :: zone_t
    !> Zone points in sequence around the zone, in either direction. Side k is between corner k and the next.
    integer :: corners(4) = 0
    !> Zones of one material may move the side between them when lines are smoothed.
    integer :: material = 1
    integer :: form(4) = as_found
    !> Middle points of curved sides, which are parabolas [length].
    real(wp) :: middle(2, 4) = 0.0_wp
    !> Paths of sides along interfaces.
    integer :: path(4) = 0
    !> As cards name it.
    character(len=name_length) :: name = ''
  end type zone_t

  !> Zones of a scene on its contours.
  type :: plan_t
    type(zone_point_t), allocatable :: points(:)
    type(zone_t), allocatable :: zones(:)
    !> Group of the scene for each zone's elements, and its four sets of sides (0: none).
    integer, allocatable :: group(:), sets(:, :)
    !> Open curves that sides between materials follow, from one corner to the next, in either direction.
    type(boundary_curve_t), allocatable :: paths(:)
    !> Sets of sides along paths of a mesh without zones: 1 with their part on the left, -1 on the right, 0 elsewhere (npath, nset).
    integer, allocatable :: on_seam(:, :)
  end type plan_t

  type :: zone_side_t
    !> Corners, in the direction of the first zone.
    integer :: points(2) = 0
    integer :: form = as_found
    integer :: boundary = 0   !! that it follows, else 0
    integer :: path = 0       !! along an interface, else 0
    real(wp) :: middle(2) = 0.0_wp
    !> Zones on its left and on its right, 0 where there is none, and the number of the side in either.
    integer :: zones(2) = 0, local(2) = 0
    !> Smoothing may move it.
    logical :: moves = .false.
  end type zone_side_t

  !> Zones, counter-clockwise, and all their sides.
  type :: zone_layout_t
    type(zone_point_t), allocatable :: points(:)
    type(zone_t), allocatable :: zones(:)
    type(zone_side_t), allocatable :: sides(:)
    integer, allocatable :: zone_sides(:, :)   !! (4, nzone)
    logical, allocatable :: point_moves(:)     !! (npoint)
    type(boundary_curve_t), allocatable :: paths(:)
  end type zone_layout_t

contains

  !> Coordinates of a zone point [length].
  pure function coordinates_of(boundaries, point) result(x)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_point_t), intent(in) :: point
    real(wp) :: x(2)

    x = point%x
    if (point%boundary > 0) x = on_boundary(boundaries(point%boundary), point%position)
  end function coordinates_of

  !> Point of a boundary curve (`exact_point` of its arc).
  pure function on_boundary(boundary, position) result(x)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: position
    real(wp) :: x(2)

    x = exact_point(boundary%arcs(position%arc), position%xi)
  end function on_boundary

end module zones
