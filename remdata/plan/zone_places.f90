!> Where the points of zones are.
module zone_places
  use contour_chain, only: point_on
  use kinds, only: wp
  use part_contour, only: contour_t
  use zones, only: zone_point_t
  implicit none
  private
  public :: coordinates

contains

  !> Of a point on a contour or inside [length].
  pure function coordinates(contours, point) result(x)
    type(contour_t), intent(in) :: contours(:)
    type(zone_point_t), intent(in) :: point
    real(wp) :: x(2)

    x = point%x
    if (point%chain > 0) x = point_on(contours(point%chain)%chain, point%place)
  end function coordinates

end module zone_places
