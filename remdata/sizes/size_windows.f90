!> Windows of REMSH where they are now, and the sizes they ask for.
!>
!> A point is in a window when the place it comes from is in the box that the deck gives: itself, the place turned and moved back
!> with a die, or where its matter was at the start.
module size_windows
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use mesh_windows, only: mesh_window_t
  use vectors, only: length_of
  implicit none
  private
  public :: size_limits_t, size_window_t, place_window, limits_around, limits_within, size_by_windows, is_in_any

  type :: size_limits_t
    real(wp) :: smallest = 0.0_wp              !! [length]
    real(wp) :: largest = sqrt(huge(1.0_wp))   !! [length]
    !> Smallest where a die bends, and at its sharp corners, if that is smaller [length].
    real(wp) :: at_bends = sqrt(huge(1.0_wp)), at_corners = sqrt(huge(1.0_wp))
    !> Largest ratio of an element to its neighbour.
    real(wp) :: gradation = 1.5_wp
  end type size_limits_t

  type :: size_window_t
    private
    type(mesh_window_t) :: box
    !> Of the die it goes with: where its pilot stood and stands, and the cosine and sine of its turn since [length].
    real(wp) :: before(2) = 0.0_wp, now(2) = 0.0_wp, turn(2) = [1.0_wp, 0.0_wp]
  end type size_window_t

contains

  !> A window that goes with a die is where that has carried it.
  pure function place_window(box, start, now) result(window)
    type(mesh_window_t), intent(in) :: box
    real(wp), intent(in) :: start(3), now(3)   !! (3) x, y, angle of the pilot; of no account without a die [length and radian]
    type(size_window_t) :: window

    window%box = box
    if (box%die == 0) return
    window%before = start(:2)
    window%now = now(:2)
    window%turn = [cos(now(3) - start(3)), sin(now(3) - start(3))]
  end function place_window

  !> Limits that are nowhere narrower than those of any place.
  pure function limits_around(limits, windows) result(wide)
    type(size_limits_t), intent(in) :: limits
    type(size_window_t), intent(in) :: windows(:)   !! (nwindow)
    type(size_limits_t) :: wide
    integer :: k

    wide = limits
    do k = 1, size(windows)
      wide%smallest = min(wide%smallest, windows(k)%box%smallest)
      wide%at_bends = min(wide%at_bends, windows(k)%box%smallest)
      wide%at_corners = min(wide%at_corners, windows(k)%box%smallest)
      wide%largest = max(wide%largest, windows(k)%box%largest)
    end do
  end function limits_around

  !> Limits at a point: those of the window it is in, of the finer one where several overlap. Beside a window that is finer than
  !> the rest of the mesh they reach down to its smallest size, grown with the distance, so that sizes do not jump at its border.
  pure function limits_within(limits, windows, x, origin) result(own)
    type(size_limits_t), intent(in) :: limits
    type(size_window_t), intent(in) :: windows(:)   !! (nwindow)
    real(wp), intent(in) :: x(2), origin(2)         !! (2) the point, and where its matter was at the start [length]
    type(size_limits_t) :: own
    logical :: inside
    integer :: k

    own = limits
    inside = .false.
    do k = 1, size(windows)
      if (distance_to(windows(k), x, origin) > 0) cycle
      if (inside .and. own%largest <= windows(k)%box%largest) cycle
      own%smallest = windows(k)%box%smallest
      own%at_bends = windows(k)%box%smallest
      own%at_corners = windows(k)%box%smallest
      own%largest = windows(k)%box%largest
      inside = .true.
    end do
    if (inside) return
    do k = 1, size(windows)
      own%smallest = min(own%smallest, windows(k)%box%smallest + slope_of(limits%gradation)*distance_to(windows(k), x, origin))
    end do
  end function limits_within

  !> A point is in one of the windows.
  pure function is_in_any(windows, x, origin) result(yes)
    type(size_window_t), intent(in) :: windows(:)   !! (nwindow)
    real(wp), intent(in) :: x(2), origin(2)         !! (2) as in `limits_within` [length]
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(windows)
      yes = yes .or. .not. distance_to(windows(k), x, origin) > 0
    end do
  end function is_in_any

  !> The largest size beside windows: from that in them it grows with the distance [length].
  pure function size_by_windows(limits, windows, x, origin) result(h)
    type(size_limits_t), intent(in) :: limits
    type(size_window_t), intent(in) :: windows(:)   !! (nwindow)
    real(wp), intent(in) :: x(2), origin(2)         !! (2) as in `limits_within` [length]
    real(wp) :: h
    integer :: k

    h = huge(h)
    do k = 1, size(windows)
      h = min(h, windows(k)%box%largest + slope_of(limits%gradation)*distance_to(windows(k), x, origin))
    end do
  end function size_by_windows

  !> From a window's box, 0 inside [length].
  pure function distance_to(window, x, origin) result(distance)
    type(size_window_t), intent(in) :: window
    real(wp), intent(in) :: x(2), origin(2)         !! (2) as in `limits_within` [length]
    real(wp) :: distance
    real(wp) :: place(2), arm(2)

    place = x
    if (window%box%by_matter) then
      place = origin
    else if (window%box%die > 0) then
      arm = x - window%now
      place = window%before + [window%turn(1)*arm(1) + window%turn(2)*arm(2), window%turn(1)*arm(2) - window%turn(2)*arm(1)]
    end if
    distance = length_of(max(window%box%low - place, place - window%box%high, 0.0_wp))
  end function distance_to

end module size_windows
