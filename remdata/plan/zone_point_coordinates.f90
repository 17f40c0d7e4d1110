!> Where the points of zones are.
module zone_point_coordinates
  use boundary_curves, only: point_on
  use corrected_contours, only: contour_t
  use kinds, only: wp
  use zones, only: zone_point_t
  implicit none
  private
  public :: coordinates

contains

  !> Of a point on a contour or inside [length].
  pure function coordinates(contours, point) result(x)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(zone_point_t), intent(in) :: point
    real(wp) :: x(2)

    x = point%x
    if (point%boundary > 0) x = point_on(contours(point%boundary)%boundary, point%position)
  end function coordinates

end module zone_point_coordinates
