!> Double ellipsoid of a welding torch, as the plane of the scene sees it.
!>
!> J. Goldak, A. Chakravarti, M. Bibby, Metall. Trans. B 15 (1984) 299-305: the heat released per volume falls off as
!> exp(-3 (s/c)^2 - 3 (w/a)^2 - 3 (d/b)^2), with s along the travel, c the front semi-axis ahead of the centre and the rear one
!> behind it, w across and d into the body, down to 5 % at the surface of the ellipsoid. The shares of power in front and behind are
!> those that keep it continuous, 2 c_f/(c_f + c_r) and 2 c_r/(c_f + c_r). The torch either
!> - crosses the plane with the speed v at the time t0: the plane lies s = -v (t - t0) ahead of the centre and sees w and d. Of the
!>   power P the length g(s) = 2 sqrt(3/pi)/(c_f + c_r) exp(-3 (s/c)^2) is released per length, 1/v of it in all; or
!> - stays in the plane and sees s and d: a source as long as the section is thick, or in an axisymmetric scene a whole ring, that
!>   has all of the power.
module weld_sources
  use kinds, only: pi, wp
  use loads, only: multiplier_t, multiplier_at
  use multiplier_means, only: mean_of_multiplier
  use text, only: to_text
  implicit none
  private
  public :: weld_source_t
  public :: felt_ahead, has_front, mean_power, name_of_torch, plane_integral, power_in_plane, reaches, share_within, shape_at, &
            times_to_hit

  !> Beyond this exponent the source is less than round-off of its centre, and nothing is released.
  real(wp), parameter :: largest_exponent = 45.0_wp
  !> A torch that crosses the plane is felt from so many semi-axes before it to as many behind it.
  real(wp), parameter :: felt_ahead = 1.5_wp

  type :: weld_source_t
    !> Where the deck has its card, for messages.
    character(len=:), allocatable :: where_defined
    !> Power times multiplier (0 for none) times efficiency.
    real(wp) :: power = 0.0_wp, efficiency = 1.0_wp
    integer :: multiplier = 0
    !> Semi-axes [length]; the width is 0 for a torch in the plane.
    real(wp) :: front = 0.0_wp, rear = 0.0_wp, width = 0.0_wp, depth = 0.0_wp
    !> Unit vector into the body.
    real(wp) :: into(2) = 0.0_wp
    !> The torch crosses the plane, with this speed, its centre at this time.
    logical :: crosses = .false.
    real(wp) :: speed = 0.0_wp, crossing_time = 0.0_wp
    !> Time, x and y of the centre (3, nrow), linear between, constant outside.
    real(wp), allocatable :: path(:, :)
  end type weld_source_t

contains

  !> A torch in messages: its number among all, and its card.
  pure function name_of_torch(source, number) result(name)
    type(weld_source_t), intent(in) :: source
    integer, intent(in) :: number
    character(len=:), allocatable :: name

    name = 'GOLDAK '//to_text(number)
    if (allocated(source%where_defined)) name = name//' ('//source%where_defined//')'
  end function name_of_torch

  !> What is released at a point over what is released at the centre.
  pure function shape_at(source, time, point) result(shape)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: time       !! [time]
    real(wp), intent(in) :: point(2)   !! [length]
    real(wp) :: shape
    real(wp) :: from(2), across, axis, exponent

    from = point - centre_at(source, time)
    across = along_at(source, time, from)
    axis = source%width
    if (.not. source%crosses) axis = merge(source%front, source%rear, across > 0)
    exponent = 3*((across/axis)**2 + (dot_product(from, source%into)/source%depth)**2)
    shape = 0
    if (exponent < largest_exponent) shape = exp(-exponent)
  end function shape_at

  !> Integral of the shape over the half plane that the body fills below a straight surface through the centre.
  pure function plane_integral(source) result(area)
    type(weld_source_t), intent(in) :: source
    real(wp) :: area   !! [length^2]

    if (source%crosses) then
      area = pi/6*source%width*source%depth
    else
      area = pi/12*(source%front + source%rear)*source%depth
    end if
  end function plane_integral

  !> Power that the elements of the plane take at a time, in all.
  pure function power_in_plane(source, multipliers, time, thickness) result(power)
    type(weld_source_t), intent(in) :: source
    type(multiplier_t), intent(in) :: multipliers(:)   !! (nmultiplier)
    real(wp), intent(in) :: time                       !! [time]
    real(wp), intent(in) :: thickness                  !! of the section, of no effect unless the torch crosses it [length]
    real(wp) :: power                                  !! [power]
    real(wp) :: ahead, axis, exponent

    power = source%efficiency*source%power
    if (source%multiplier > 0) power = power*multiplier_at(multipliers(source%multiplier), time)
    if (.not. source%crosses) return
    ahead = source%speed*(source%crossing_time - time)
    axis = merge(source%front, source%rear, ahead > 0)
    exponent = 3*(ahead/axis)**2
    if (exponent < largest_exponent) then
      power = power*thickness*2*sqrt(3/pi)/(source%front + source%rear)*exp(-exponent)
    else
      power = 0
    end if
  end function power_in_plane

  !> Mean over a step of the power that the elements of the plane take. A torch that crosses may do so within a single step: the
  !> integral of its Gaussian by the multiplier, which is linear within a step, is the error function's, so that the heat is the
  !> stated one however long the steps are.
  pure function mean_power(source, multipliers, from, to, thickness) result(power)
    type(weld_source_t), intent(in) :: source
    type(multiplier_t), intent(in) :: multipliers(:)   !! (nmultiplier)
    real(wp), intent(in) :: from, to                   !! start and end of the step [time]
    real(wp), intent(in) :: thickness                  !! of the section [length]
    real(wp) :: power                                  !! [power]
    real(wp) :: factors(2), slope, weight, centre

    if (.not. source%crosses) then
      power = source%efficiency*source%power
      if (source%multiplier > 0) power = power*mean_of_multiplier(multipliers(source%multiplier), from, to)
      return
    end if
    factors = 1
    if (source%multiplier > 0) &
      factors = [multiplier_at(multipliers(source%multiplier), from), multiplier_at(multipliers(source%multiplier), to)]
    slope = (factors(2) - factors(1))/(to - from)
    call integrate_crossing(source, from, to, weight, centre)
    power = source%efficiency*source%power*thickness*(factors(1)*weight + slope*(centre - from*weight))/(to - from)
  end function mean_power

  !> Share of the heat of a torch that crosses the plane which it leaves there between two times.
  pure function share_within(source, from, to) result(share)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: from, to   !! [time]
    real(wp) :: share
    real(wp) :: weight, centre

    call integrate_crossing(source, from, to, weight, centre)
    share = weight*source%speed
  end function share_within

  !> Integrals over time of g(t), the heat that a torch which crosses leaves per length of its way, and of t g(t).
  pure subroutine integrate_crossing(source, from, to, weight, centre)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: from, to   !! [time]
    real(wp), intent(out) :: weight, centre   !! [time/length], [time^2/length]
    real(wp) :: axis, low, high, part, moment
    integer :: side

    weight = 0
    centre = 0
    do side = 1, 2
      ! u = sqrt(3) v (t - t0)/c, by the front before the crossing and by the rear after it
      axis = merge(source%front, source%rear, side == 1)/(sqrt(3.0_wp)*source%speed)
      low = (from - source%crossing_time)/axis
      high = (to - source%crossing_time)/axis
      if (side == 1) then
        low = min(low, 0.0_wp)
        high = min(high, 0.0_wp)
      else
        low = max(low, 0.0_wp)
        high = max(high, 0.0_wp)
      end if
      if (.not. high > low) cycle
      ! between places on one side of the crossing, differences of what is small far from it
      if (side == 1) then
        part = 0.5_wp*sqrt(pi)*(erfc(-high) - erfc(-low))
      else
        part = 0.5_wp*sqrt(pi)*(erfc(low) - erfc(high))
      end if
      moment = 0.5_wp*(exp(-low**2) - exp(-high**2))
      weight = weight + axis*part
      centre = centre + axis*(source%crossing_time*part + axis*moment)
    end do
    weight = weight*2*sqrt(3/pi)/(source%front + source%rear)
    ! what is round-off of the whole
    if (weight*source%speed < epsilon(weight)) then
      weight = 0
      centre = 0
    end if
    centre = centre*2*sqrt(3/pi)/(source%front + source%rear)
  end subroutine integrate_crossing

  !> Something may be released within the box around some points.
  pure function reaches(source, time, points) result(yes)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: time           !! [time]
    real(wp), intent(in) :: points(:, :)   !! (2, npoint) [length]
    logical :: yes
    real(wp) :: centre(2), axis

    centre = centre_at(source, time)
    axis = max(source%width, source%depth)
    if (.not. source%crosses) axis = max(source%front, source%rear, source%depth)
    axis = axis*sqrt(largest_exponent/3)
    yes = all(minval(points, 2) < centre + axis .and. maxval(points, 2) > centre - axis)
  end function reaches

  !> Times that steps must not jump over: corners of the path, and where the torch begins to be felt, crosses, and is gone.
  pure function times_to_hit(source) result(times)
    type(weld_source_t), intent(in) :: source
    real(wp), allocatable :: times(:)   !! [time]

    times = source%path(1, :)
    if (source%crosses) times = [times, source%crossing_time + &
                                  [-felt_ahead*source%front, 0.0_wp, felt_ahead*source%rear]/source%speed]
  end function times_to_hit

  !> The path goes along the direction that front and rear stand on; otherwise nothing says which is which.
  pure function has_front(source) result(yes)
    type(weld_source_t), intent(in) :: source
    logical :: yes
    integer :: i

    yes = .false.
    do i = 2, size(source%path, 2)
      yes = yes .or. abs(dot_product(source%path(2:3, i) - source%path(2:3, i - 1), sideways(source))) > 0
    end do
  end function has_front

  !> Centre of the source.
  pure function centre_at(source, time) result(centre)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: time
    real(wp) :: centre(2)
    integer :: i, n

    n = size(source%path, 2)
    associate (path => source%path)
      if (time <= path(1, 1)) then
        centre = path(2:3, 1)
      else if (time >= path(1, n)) then
        centre = path(2:3, n)
      else
        i = piece_at(source, time)
        centre = path(2:3, i - 1) + (path(2:3, i) - path(2:3, i - 1))*((time - path(1, i - 1))/(path(1, i) - path(1, i - 1)))
      end if
    end associate
  end function centre_at

  !> Distance from the centre along the travel, positive ahead; across it, of no sign, where the torch crosses. A torch that stands
  !> keeps the direction it came with, or takes the one it will leave with.
  pure function along_at(source, time, from) result(along)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: time, from(2)
    real(wp) :: along
    real(wp) :: way
    integer :: i, now

    along = dot_product(from, sideways(source))
    if (source%crosses .or. size(source%path, 2) == 1) return
    now = piece_at(source, time)
    do i = now, 2, -1
      way = dot_product(source%path(2:3, i) - source%path(2:3, i - 1), sideways(source))
      if (abs(way) > 0) exit
    end do
    if (i < 2) then
      do i = now + 1, size(source%path, 2)
        way = dot_product(source%path(2:3, i) - source%path(2:3, i - 1), sideways(source))
        if (abs(way) > 0) exit
      end do
      if (i > size(source%path, 2)) return
    end if
    if (way < 0) along = -along
  end function along_at

  !> Piece of a path that a time belongs to, by the row at its end.
  pure function piece_at(source, time) result(i)
    type(weld_source_t), intent(in) :: source
    real(wp), intent(in) :: time
    integer :: i

    do i = 2, size(source%path, 2) - 1
      if (time <= source%path(1, i)) exit
    end do
  end function piece_at

  !> Unit vector along the surface.
  pure function sideways(source) result(vector)
    type(weld_source_t), intent(in) :: source
    real(wp) :: vector(2)

    vector = [-source%into(2), source%into(1)]
  end function sideways

end module weld_sources
