!> Zones for a part of which none were given.
module derived_zones
  use contour_chain, only: arc_at, chain_t, kind_corner, place_at_arc, place_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: to_text
  use zones, only: zone_point_t, zone_t
  implicit none
  private
  public :: one_zone

contains

  !> The zone of a part that has one contour and four corners: those that are marked, else the corners of the chain.
  pure subroutine one_zone(chains, marked, points, zones, error)
    type(chain_t), intent(in) :: chains(:)
    type(place_t), intent(in) :: marked(:)                      !! on the first chain, in any order; none: its corners
    type(zone_point_t), allocatable, intent(out) :: points(:)   !! (4)
    type(zone_t), allocatable, intent(out) :: zones(:)          !! (1)
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: arcs(:)
    integer :: k, n

    if (size(chains) /= 1) then
      call fail(error, exit_input, 'a part with '//to_text(size(chains))//' contours cannot be meshed without zones', &
                'give zones, or one contour with four corners')
      return
    end if
    associate (chain => chains(1))
      if (size(marked) > 0) then
        allocate (arcs(size(marked)))
        do k = 1, size(marked)
          arcs(k) = arc_at(chain, marked(k))
        end do
      else
        arcs = pack(chain%arc(:ubound(chain%arc, 1) - 1), chain%kinds == kind_corner)
      end if
      n = size(arcs)
      if (n /= 4) then
        call fail(error, exit_input, 'a contour with '//to_text(n)//' corners cannot be meshed without zones, expected four', &
                  'mark four corners of the contour, or give zones')
        return
      end if
      allocate (points(4), zones(1))
      do k = 1, 4
        points(k)%chain = 1
        points(k)%place = place_at_arc(chain, minval(arcs))
        arcs(minloc(arcs, 1)) = huge(1.0_wp)
      end do
      zones(1)%corners = [1, 2, 3, 4]
    end associate
  end subroutine one_zone

end module derived_zones
