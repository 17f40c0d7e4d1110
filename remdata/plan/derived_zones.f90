!> Zones of a part without ZONE cards or blocks.
module derived_zones
  use boundary_curves, only: arc_length_at, boundary_curve_t, kind_corner, position_at_arc_length, position_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: to_text
  use zones, only: zone_point_t, zone_t
  implicit none
  private
  public :: one_zone

contains

  !> The zone of a part that has one contour and four corners: those that are marked, else the corners of the boundary curve.
  pure subroutine one_zone(boundaries, marked, points, zones, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)         !! (nboundary)
    type(position_t), intent(in) :: marked(:)                   !! (n) on the first boundary curve, in any order; none: its corners
    type(zone_point_t), allocatable, intent(out) :: points(:)   !! (4)
    type(zone_t), allocatable, intent(out) :: zones(:)          !! (1)
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: lengths(:)
    integer :: k, n

    if (size(boundaries) /= 1) then
      call fail(error, exit_input, 'a part with '//to_text(size(boundaries))//' contours cannot be meshed without zones', &
                'give zones, or one contour with four corners')
      return
    end if
    associate (boundary => boundaries(1))
      if (size(marked) > 0) then
        allocate (lengths(size(marked)))
        do k = 1, size(marked)
          lengths(k) = arc_length_at(boundary, marked(k))
        end do
      else
        lengths = pack(boundary%arc_length(:ubound(boundary%arc_length, 1) - 1), boundary%kinds == kind_corner)
      end if
      n = size(lengths)
      if (n /= 4) then
        call fail(error, exit_input, 'a contour with '//to_text(n)//' corners cannot be meshed without zones, expected four', &
                  'mark four corners of the contour, or give zones')
        return
      end if
      allocate (points(4), zones(1))
      do k = 1, 4
        points(k)%boundary = 1
        points(k)%position = position_at_arc_length(boundary, minval(lengths))
        lengths(minloc(lengths, 1)) = huge(1.0_wp)
      end do
      zones(1)%corners = [1, 2, 3, 4]
    end associate
  end subroutine one_zone

end module derived_zones
