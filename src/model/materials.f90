!> A material: a law with its numbers. What the numbers mean is declared by the law (src/law).
module materials
  use kinds, only: wp
  use steels, only: steel_t
  implicit none
  private
  public :: material_t, values_at, bracket_temperature, integral_over_temperature, has_number

  type :: material_t
    character(len=:), allocatable :: name
    !> Name of the LAW it is made of, and its position in the list of laws.
    character(len=:), allocatable :: law
    integer :: law_id = 0
    !> Values of the law's parameters, in the order the law declares them; at the first temperature where several are given.
    real(wp), allocatable :: values(:)
    !> Table of a curve, abscissa ascending (2, n), at the first temperature; empty when the law's form has none.
    real(wp), allocatable :: curve(:, :)
    !> Temperatures at which the card is given, ascending; none for numbers that hold at any temperature.
    real(wp), allocatable :: temperatures(:)
    !> All values (nvalue, ntemperature) and curves (2, npoint, ntemperature); allocated with `temperatures`.
    real(wp), allocatable :: values_by_temperature(:, :), curves(:, :, :)
    !> Data of its phases, of laws that have some.
    type(steel_t), allocatable :: steel
    !> Where the deck defines it, for messages.
    character(len=:), allocatable :: where_defined
  end type material_t

contains

  !> Values at a temperature: linear between those of the card, constant outside.
  pure subroutine values_at(material, temperature, values)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    real(wp), intent(out) :: values(:)   !! (nvalue) [unit of each value]
    integer :: k
    real(wp) :: share

    if (.not. allocated(material%temperatures)) then
      values = material%values
      return
    end if
    call bracket_temperature(material, temperature, k, share)
    values = (1 - share)*material%values_by_temperature(:, k) &
             + share*material%values_by_temperature(:, min(k + 1, size(material%temperatures)))
  end subroutine values_at

  !> Place k of the temperature of the card below, and the share of the next one.
  pure subroutine bracket_temperature(material, temperature, k, share)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    integer, intent(out) :: k
    real(wp), intent(out) :: share
    integer :: n

    n = size(material%temperatures)
    share = 0
    k = 1
    if (temperature <= material%temperatures(1)) return
    k = n
    if (temperature >= material%temperatures(n)) return
    do k = 1, n - 2
      if (temperature < material%temperatures(k + 1)) exit
    end do
    share = (temperature - material%temperatures(k))/(material%temperatures(k + 1) - material%temperatures(k))
  end subroutine bracket_temperature

  !> Integral of one value from a temperature to another: exact for what `values_at` gives.
  pure function integral_over_temperature(material, place, from, to) result(integral)
    type(material_t), intent(in) :: material
    integer, intent(in) :: place   !! of the value
    real(wp), intent(in) :: from, to
    real(wp) :: integral
    real(wp) :: low, high, a, b
    integer :: k, n

    if (.not. allocated(material%temperatures)) then
      integral = material%values(place)*(to - from)
      return
    end if
    low = min(from, to)
    high = max(from, to)
    n = size(material%temperatures)
    associate (t => material%temperatures, v => material%values_by_temperature(place, :))
      integral = max(0.0_wp, min(high, t(1)) - low)*v(1) + max(0.0_wp, high - max(low, t(n)))*v(n)
      do k = 1, n - 1
        a = max(low, t(k))
        b = min(high, t(k + 1))
        if (b > a) integral = integral &
                              + (b - a)*(v(k) + (v(k + 1) - v(k))*((0.5_wp*(a + b) - t(k))/(t(k + 1) - t(k))))
      end do
    end associate
    if (to < from) integral = -integral
  end function integral_over_temperature

  !> A value is not zero, at some temperature.
  pure function has_number(material, place) result(yes)
    type(material_t), intent(in) :: material
    integer, intent(in) :: place
    logical :: yes

    yes = .false.
    if (place > size(material%values)) return   ! a card with mistakes
    yes = abs(material%values(place)) > 0
    if (.not. yes .and. allocated(material%temperatures)) yes = any(abs(material%values_by_temperature(place, :)) > 0)
  end function has_number

end module materials
