!> Number of elements on each side of a zone.
!>
!> Opposite sides of a zone have the same number, hence all sides of a class, from zone to zone. A side along contours or interfaces
!> gets what it needs, the integral of 1/h, in each part between its breaks, as the geometry and contact require. The need inside a
!> zone is measured along its two sides and seven lines between them: the mean of their mean and of their largest, so that a peak on
!> one line alone counts half. The class takes the largest number of its sides and zones, rounded up.
module zone_divisions
  use boundary_curves, only: boundary_curve_t, position_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use directed_sizes, only: size_along
  use side_curves, only: curve_point, curve_t, has_course
  use size_field, only: directed_size_at, size_field_t
  use text, only: to_text
  use vectors, only: length_of
  use zones, only: zone_layout_t
  implicit none
  private
  public :: division_t, division_settings_t, choose_divisions, is_forward, rounded_up

  type :: division_settings_t
    !> All requested sizes are divided by this factor.
    real(wp) :: refine = 1.0_wp
    integer :: most_elements = 1000000
  end type division_settings_t

  type :: division_t
    integer, allocatable :: count(:)   !! elements along each side (nside)
    integer :: nelem = 0
    !> Ratio of the sizes to the requested ones: below 1 refined, above 1 to respect the limit on the number of elements.
    real(wp) :: factor = 1.0_wp
  end type division_t

  !> Steps along a line between two sides, and lines.
  integer, parameter :: steps = 32, lines = 7
  !> Share of an element that is dropped in rounding up.
  real(wp), parameter :: spared = 0.1_wp
  !> Upper bound of the elements along a part of a side.
  real(wp), parameter :: most_along = 1.0e6_wp
  !> Bisections of the factor on sizes, enough to determine the numbers of elements.
  integer, parameter :: halvings = 40

contains

  pure subroutine choose_divisions(boundaries, layout, field, curves, settings, division, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(in) :: curves(:)   !! (nside) of the sides, with their density
    type(division_settings_t), intent(in) :: settings
    type(division_t), intent(out) :: division
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: need(size(curves)), low, high, factor
    integer :: group(size(curves)), fewest, halving

    call find_classes(layout, group)
    call find_needs(boundaries, layout, field, curves, group, need)
    fewest = elements(layout, numbers(curves, group, need, most_along**2))
    if (fewest > settings%most_elements) then
      call fail(error, exit_input, 'the zones take '//to_text(fewest)//' elements at least, more than the ' &
                //to_text(settings%most_elements)//' allowed', 'allow more elements, or give fewer zones')
      return
    end if
    low = 1/settings%refine
    factor = low
    if (elements(layout, numbers(curves, group, need, low)) > settings%most_elements) then
      high = 2*low
      do while (elements(layout, numbers(curves, group, need, high)) > settings%most_elements)
        low = high
        high = 2*high
      end do
      do halving = 1, halvings
        factor = 0.5_wp*(low + high)
        if (elements(layout, numbers(curves, group, need, factor)) > settings%most_elements) then
          low = factor
        else
          high = factor
        end if
      end do
      factor = high
    end if
    allocate (division%count(size(curves)))
    division%count = numbers(curves, group, need, factor)
    division%nelem = elements(layout, division%count)
    division%factor = factor
  end subroutine choose_divisions

  !> Whether a side of a zone has the direction of the zone.
  pure function is_forward(layout, zone, k) result(forward)
    type(zone_layout_t), intent(in) :: layout
    integer, intent(in) :: zone, k
    logical :: forward

    forward = layout%sides(layout%zone_sides(k, zone))%zones(1) == zone
  end function is_forward

  !> Classes of opposite sides, each by its lowest side.
  pure subroutine find_classes(layout, group)
    type(zone_layout_t), intent(in) :: layout
    integer, intent(out) :: group(:)
    integer :: z, k, s, roots(2)

    group = [(s, s=1, size(group))]
    do z = 1, size(layout%zones)
      do k = 1, 2
        roots = [root(layout%zone_sides(k, z)), root(layout%zone_sides(k + 2, z))]
        group(maxval(roots)) = minval(roots)
      end do
    end do
    do s = 1, size(group)
      group(s) = root(s)
    end do

  contains

    pure function root(side) result(top)
      integer, intent(in) :: side
      integer :: top

      top = side
      do while (group(top) /= top)
        top = group(top)
      end do
    end function root

  end subroutine find_classes

  !> Need of each class inside its zones, stored at the class's lowest side.
  pure subroutine find_needs(boundaries, layout, field, curves, group, need)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: group(:)
    real(wp), intent(out) :: need(:)
    real(wp) :: line(lines + 2, 2), one
    integer :: z, k, s

    need = 0
    do z = 1, size(layout%zones)
      call measure_inside(boundaries, layout, field, curves, z, line)
      do k = 1, 2
        do s = 1, 2
          line(lines + s, k) = sum(curves(layout%zone_sides(k + 2*(s - 1), z))%needs)
        end do
        one = 0.5_wp*(maxval(line(:, k)) + sum(line(:, k))/size(line, 1))
        s = group(layout%zone_sides(k, z))
        need(s) = max(need(s), one)
      end do
    end do
  end subroutine find_needs

  !> Integral of 1/h along lines between sides 1 and 3 (first column), and between 4 and 2 (second).
  pure subroutine measure_inside(boundaries, layout, field, curves, zone, line)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: zone
    real(wp), intent(out) :: line(:, :)
    real(wp) :: c(2, 0:steps, 4), x(2), last(2), h, last_h, stretch(2), last_stretch(2), s, t
    type(position_t) :: position
    integer :: i, j, k, side

    ! the four sides as in Coons' patch: 1 and 3 from left to right, 4 and 2 upwards
    do k = 1, 4
      side = layout%zone_sides(k, zone)
      do i = 0, steps
        j = i
        if (is_forward(layout, zone, k) .neqv. k <= 2) j = steps - i
        call curve_point(boundaries, curves(side), curves(side)%length*j/steps, c(:, i, k), position)
      end do
    end do
    line = 0
    do k = 1, 2
      do j = 1, lines
        do i = 0, steps
          s = real(i, wp)/steps
          t = real(j, wp)/(lines + 1)
          if (k == 1) then
            x = coons(i, j*steps/(lines + 1), s, t)
          else
            x = coons(j*steps/(lines + 1), i, t, s)
          end if
          call directed_size_at(field, layout%zones(zone)%material, x, h, stretch)
          if (i > 0) line(j, k) = line(j, k) + 0.5_wp*length_of(x - last)*(1/size_along(h, stretch, x - last) &
                                                                          + 1/size_along(last_h, last_stretch, x - last))
          last = x
          last_h = h
          last_stretch = stretch
        end do
      end do
    end do

  contains

    pure function coons(i, j, s, t) result(point)
      integer, intent(in) :: i, j
      real(wp), intent(in) :: s, t
      real(wp) :: point(2)

      point = (1 - t)*c(:, i, 1) + t*c(:, i, 3) + (1 - s)*c(:, j, 4) + s*c(:, j, 2) &
              - (1 - s)*(1 - t)*c(:, 0, 1) - s*(1 - t)*c(:, steps, 1) - s*t*c(:, steps, 3) - (1 - s)*t*c(:, 0, 3)
    end function coons

  end subroutine measure_inside

  !> Number of elements of each side for a ratio of the sizes to the requested ones.
  pure function numbers(curves, group, need, factor) result(number)
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: group(:)
    real(wp), intent(in) :: need(:), factor
    integer :: number(size(curves))
    integer :: s

    number = rounded_up(need/factor)
    do s = 1, size(curves)
      if (.not. has_course(curves(s))) cycle
      number(group(s)) = max(number(group(s)), sum(rounded_up(curves(s)%needs/factor)))
    end do
    number = number(group)
  end function numbers

  !> At least one, and bounded so that it is an integer.
  pure elemental function rounded_up(need) result(n)
    real(wp), intent(in) :: need
    integer :: n

    n = max(1, ceiling(min(need, most_along) - spared))
  end function rounded_up

  !> Elements of all zones, at most the largest integer.
  pure function elements(layout, number) result(total)
    type(zone_layout_t), intent(in) :: layout
    integer, intent(in) :: number(:)
    integer :: total
    real(wp) :: sum_of_all
    integer :: z

    sum_of_all = 0
    do z = 1, size(layout%zones)
      sum_of_all = sum_of_all + real(number(layout%zone_sides(1, z)), wp)*number(layout%zone_sides(2, z))
    end do
    total = nint(min(sum_of_all, real(huge(1) - 1, wp)))
  end function elements

end module zone_divisions
