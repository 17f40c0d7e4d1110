!> Elements in corners of a part, or of a material in it, that are sharper than any good element: none there is better than the
!> corner itself.
module sharp_corners
  use kinds, only: pi, wp
  use mesh_quality, only: corner_angles, element_shape, shape_places, shape_places_t
  use remeshing, only: ncriteria, scaled_jacobian
  implicit none
  private
  public :: least_scaled_jacobian, share_of_corner

  !> The element in a sharp corner has at least this share of the corner's angle and sine: its sides are parabolas.
  real(wp), parameter :: share_of_corner = 0.9_wp

contains

  !> Least scaled Jacobian of the elements that `counts`, without those that fill a corner with a sine below `limit` as well as it
  !> can be.
  pure function least_scaled_jacobian(x, connectivity, material, limit, counts) result(least)
    real(wp), intent(in) :: x(:, :)              !! nodes (2, nnode) [length]
    integer, intent(in) :: connectivity(:, :)    !! (8, nelem)
    integer, intent(in) :: material(:)           !! (nelem)
    real(wp), intent(in) :: limit                !! [-]
    logical, intent(in) :: counts(:)             !! (nelem)
    real(wp) :: least
    type(shape_places_t) :: places
    real(wp) :: measures(ncriteria), around(size(x, 2)), corner, sine
    integer :: e, m

    least = 1
    places = shape_places()
    do m = minval(material), maxval(material)
      if (.not. any(material == m .and. counts)) cycle
      call angles_around(places, x, connectivity, material == m, around)
      do e = 1, size(material)
        if (material(e) /= m .or. .not. counts(e)) cycle
        measures = element_shape(places, x(:, connectivity(:, e)))
        corner = share_of_corner*minval(around(connectivity(1:4, e)))
        if (corner < pi/2) then
          sine = sin(corner)
          if (sine < limit .and. measures(scaled_jacobian) >= sine) cycle
        end if
        least = min(least, measures(scaled_jacobian))
      end do
    end do
  end function least_scaled_jacobian

  !> Angle that some of the elements have around each of their corners: of a corner on their outline, the angle between its sides.
  pure subroutine angles_around(places, x, connectivity, counts, around)
    type(shape_places_t), intent(in) :: places
    real(wp), intent(in) :: x(:, :)             !! nodes (2, nnode) [length]
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    logical, intent(in) :: counts(:)            !! (nelem)
    real(wp), intent(out) :: around(:)          !! (nnode) [rad]
    integer :: e

    around = 0
    do e = 1, size(counts)
      if (.not. counts(e)) cycle
      associate (corners => connectivity(1:4, e))
        around(corners) = around(corners) + corner_angles(places, x(:, connectivity(:, e)))
      end associate
    end do
  end subroutine angles_around

end module sharp_corners
