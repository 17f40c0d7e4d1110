!> Heat content and conductivity of the phases of a steel by temperature, and of their mixture.
!>
!> A phase has its heat content H, linear between temperatures and beyond with its first or last slope, or its capacity RHOC, of
!> which the integral is taken exactly. Mixtures are linear in the fractions.
module heat_of_phases
  use dual_numbers, only: dual_t
  use kinds, only: wp
  use phases_there, only: phases_that_form
  use steels, only: phase_count, phase_names, prop_content, prop_lambda, prop_rhoc, steel_t
  use temperature_curves, only: curve_at, curve_integral, curve_table, dual_curve_at, is_given, temperature_curve_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: capacity_bends, heat_taken, mixture_conductivity, phase_conductivities, lacking_heat_data

contains

  !> Heat that a phase takes up between two temperatures, and its capacity at the second.
  pure subroutine heat_taken(steel, phase, from, to, taken, capacity)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: from, to    !! [degC]
    real(wp), intent(out) :: taken      !! [MJ/m3]
    real(wp), intent(out) :: capacity   !! [MJ/m3/K]
    real(wp) :: content(2), slope

    associate (h => steel%properties(prop_content, phase), c => steel%properties(prop_rhoc, phase))
      if (is_given(h)) then
        call content_at(h, from, content(1), slope)
        call content_at(h, to, content(2), capacity)
        taken = content(2) - content(1)
      else
        taken = curve_integral(c, from, to)
        capacity = curve_at(c, to)
      end if
    end associate
  end subroutine heat_taken

  !> Temperatures of the table by which a phase has its heat capacity; none where it is a number or a polynomial.
  pure function capacity_bends(steel, phase) result(temperatures)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), allocatable :: temperatures(:)   !! (nbend) [degC]

    associate (h => steel%properties(prop_content, phase), c => steel%properties(prop_rhoc, phase))
      if (is_given(h) .and. h%form == curve_table) then
        temperatures = h%t
      else if (is_given(c) .and. c%form == curve_table) then
        temperatures = c%t
      else
        allocate (temperatures(0))
      end if
    end associate
  end function capacity_bends

  !> Value and slope of a heat content; a table goes on with the slope of its ends.
  pure subroutine content_at(h, temperature, content, slope)
    type(temperature_curve_t), intent(in) :: h
    real(wp), intent(in) :: temperature
    real(wp), intent(out) :: content, slope
    type(dual_t) :: both
    integer :: k

    if (h%form == curve_table) then
      do k = 1, size(h%t) - 2
        if (temperature < h%t(k + 1)) exit
      end do
      slope = (h%v(k + 1) - h%v(k))/(h%t(k + 1) - h%t(k))
      content = h%v(k) + slope*(temperature - h%t(k))
    else
      both = dual_curve_at(h, dual_t(temperature, 1.0_wp))
      content = both%value
      slope = both%slope
    end if
  end subroutine content_at

  !> Conductivity of a mixture, and its derivative by the temperature.
  pure subroutine mixture_conductivity(steel, fractions, temperature, conductivity, slope)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: fractions(:)   !! (phase_count) [-]
    real(wp), intent(in) :: temperature    !! [degC]
    real(wp), intent(out) :: conductivity  !! [W/m/K]
    real(wp), intent(out) :: slope         !! [W/m/K2]
    type(dual_t) :: one
    integer :: i

    conductivity = 0
    slope = 0
    do i = 1, phase_count
      if (.not. fractions(i) > 0) cycle
      one = dual_curve_at(steel%properties(prop_lambda, i), dual_t(temperature, 1.0_wp))
      conductivity = conductivity + fractions(i)*one%value
      slope = slope + fractions(i)*one%slope
    end do
  end subroutine mixture_conductivity

  !> Conductivities of the phases, 0 of those that have none: what a mixture has per fraction.
  pure function phase_conductivities(steel, temperature) result(conductivity)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: temperature           !! [degC]
    real(wp) :: conductivity(phase_count)         !! [W/m/K]
    integer :: i

    conductivity = 0
    do i = 1, phase_count
      if (is_given(steel%properties(prop_lambda, i))) conductivity(i) = curve_at(steel%properties(prop_lambda, i), temperature)
    end do
  end function phase_conductivities

  !> What the phases that may form lack for conduction of heat, a line each; with `given` those that are there in spite of not
  !> forming.
  pure subroutine lacking_heat_data(steel, problems, given)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem)
    logical, intent(in), optional :: given(:)                 !! (phase_count)
    logical :: there(phase_count)
    integer :: i

    allocate (problems(0))
    there = phases_that_form(steel)
    if (present(given)) there = given .and. .not. there
    do i = 1, phase_count
      if (.not. there(i)) cycle
      if (.not. is_given(steel%properties(prop_lambda, i))) &
        call add_text(problems, 'the steel '''//steel%name//''' has no LAMBDA of '//trim(phase_names(i)))
      if (is_given(steel%properties(prop_rhoc, i)) .eqv. is_given(steel%properties(prop_content, i))) &
        call add_text(problems, 'the steel '''//steel%name//''' must have either RHOC or H of '//trim(phase_names(i)))
    end do
  end subroutine lacking_heat_data

end module heat_of_phases
