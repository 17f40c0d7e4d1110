!> How many elements each side gets.
!>
!> Sides opposite in a zone have one number, hence all sides of a class, from zone to zone. A side along contours or interfaces gets
!> what it needs, the integral of 1/h, in each part between its breaks: there the geometry has its say, and contact. The need inside
!> a zone is measured along its two sides and seven lines between them: the mean of their mean and of their largest, so that a
!> peak that touches one line alone counts half. The class takes the largest number of its sides and zones, rounded up.
module zone_divisions
  use contour_chain, only: chain_t, place_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use side_curves, only: curve_point, curve_t, has_course
  use size_field, only: size_at, size_field_t
  use text, only: to_text
  use vectors, only: length_of
  use zones, only: layout_t
  implicit none
  private
  public :: division_t, division_wish_t, choose_divisions, is_forward, rounded_up
  public :: by_mean, by_largest

  !> Need of a zone: mean of mean and largest of its lines, or the largest.
  integer, parameter :: by_mean = 1, by_largest = 2

  type :: division_wish_t
    integer :: rule = by_mean
    !> All wanted sizes are divided by this.
    real(wp) :: refine = 1.0_wp
    integer :: most_elements = 1000000
  end type division_wish_t

  type :: division_t
    integer, allocatable :: count(:)   !! elements along each side (nside)
    integer :: nelem = 0
    !> Sizes are so many times the wanted ones: refined below 1, above 1 to keep within the number of elements.
    real(wp) :: factor = 1.0_wp
  end type division_t

  !> Steps along a line between two sides, and lines.
  integer, parameter :: steps = 32, lines = 7
  !> Share of an element that is given away in rounding up.
  real(wp), parameter :: spared = 0.1_wp
  !> Elements along a part of a side, that no mesh will have.
  real(wp), parameter :: most_along = 1.0e6_wp
  !> Halvings of the factor on sizes: closer than any whole number of elements can show.
  integer, parameter :: halvings = 40

contains

  pure subroutine choose_divisions(chains, layout, field, curves, wish, division, error)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(in) :: curves(:)              !! of the sides, their density measured
    type(division_wish_t), intent(in) :: wish
    type(division_t), intent(out) :: division
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: need(size(curves)), low, high, factor
    integer :: group(size(curves)), fewest, halving

    call find_classes(layout, group)
    call find_needs(chains, layout, field, curves, wish%rule, group, need)
    fewest = elements(layout, numbers(curves, group, need, most_along**2))
    if (fewest > wish%most_elements) then
      call fail(error, exit_input, 'the zones take '//to_text(fewest)//' elements at least, more than the ' &
                //to_text(wish%most_elements)//' allowed', 'allow more elements, or give fewer zones')
      return
    end if
    low = 1/wish%refine
    factor = low
    if (elements(layout, numbers(curves, group, need, low)) > wish%most_elements) then
      high = 2*low
      do while (elements(layout, numbers(curves, group, need, high)) > wish%most_elements)
        low = high
        high = 2*high
      end do
      do halving = 1, halvings
        factor = 0.5_wp*(low + high)
        if (elements(layout, numbers(curves, group, need, factor)) > wish%most_elements) then
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

  !> Whether a side of a zone runs as the zone walks it.
  pure function is_forward(layout, zone, k) result(forward)
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: zone, k
    logical :: forward

    forward = layout%sides(layout%zone_sides(k, zone))%zones(1) == zone
  end function is_forward

  !> Classes of opposite sides, each by its lowest side.
  pure subroutine find_classes(layout, group)
    type(layout_t), intent(in) :: layout
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

  !> Need of each class inside its zones; it stands at the class's lowest side.
  pure subroutine find_needs(chains, layout, field, curves, rule, group, need)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: rule, group(:)
    real(wp), intent(out) :: need(:)
    real(wp) :: line(lines + 2, 2), one
    integer :: z, k, s

    need = 0
    do z = 1, size(layout%zones)
      call measure_inside(chains, layout, field, curves, z, line)
      do k = 1, 2
        do s = 1, 2
          line(lines + s, k) = sum(curves(layout%zone_sides(k + 2*(s - 1), z))%needs)
        end do
        one = maxval(line(:, k))
        if (rule == by_mean) one = 0.5_wp*(one + sum(line(:, k))/size(line, 1))
        s = group(layout%zone_sides(k, z))
        need(s) = max(need(s), one)
      end do
    end do
  end subroutine find_needs

  !> Integral of 1/h along lines between sides 1 and 3 (first column), and between 4 and 2 (second).
  pure subroutine measure_inside(chains, layout, field, curves, zone, line)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: zone
    real(wp), intent(out) :: line(:, :)
    real(wp) :: c(2, 0:steps, 4), x(2), last(2), h, last_h, s, t
    type(place_t) :: place
    integer :: i, j, k, side

    ! the four sides as Coons' patch has them: 1 and 3 from left to right, 4 and 2 upwards
    do k = 1, 4
      side = layout%zone_sides(k, zone)
      do i = 0, steps
        j = i
        if (is_forward(layout, zone, k) .neqv. k <= 2) j = steps - i
        call curve_point(chains, curves(side), curves(side)%length*j/steps, c(:, i, k), place)
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
          h = size_at(field, layout%zones(zone)%material, x)
          if (i > 0) line(j, k) = line(j, k) + 0.5_wp*length_of(x - last)*(1/h + 1/last_h)
          last = x
          last_h = h
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

  !> Number of each side when sizes are so many times the wanted ones.
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

  !> At least one; a number that no mesh can have stays one that can be counted.
  pure elemental function rounded_up(need) result(n)
    real(wp), intent(in) :: need
    integer :: n

    n = max(1, ceiling(min(need, most_along) - spared))
  end function rounded_up

  !> Elements of all zones, at most the largest number there is.
  pure function elements(layout, number) result(total)
    type(layout_t), intent(in) :: layout
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
