!> Polynomials of a steel (POLY) beyond the temperatures they were fitted for: a conductivity, heat capacity, Young's modulus or
!> yield stress that is not above 0 there is none of any metal, and what a run makes of it is no result. Tables and numbers are
!> judged as they are read.
module spent_polynomials
  use errors, only: error_t, exit_no_convergence, fail
  use fields, only: find_field
  use heat_of_phases, only: heat_taken
  use kinds, only: wp
  use law_api, only: find_parameter, law_t
  use point_temperatures, only: temperature_field
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_behind_sides, only: given_temperature
  use state_variables, only: find_variable
  use steels, only: austenite, phase_count, phase_names, prop_content, prop_lambda, prop_rhoc, prop_yield, prop_young, &
                    property_names, property_units, steel_t
  use temperature_curves, only: curve_at, curve_polynomial
  use text, only: to_text
  implicit none
  private
  public :: refuse_spent_polynomials

  !> Properties that are above 0, or (H) grow with the temperature.
  integer, parameter :: positive(5) = [prop_lambda, prop_rhoc, prop_content, prop_young, prop_yield]
  !> A phase with less than this share at a point hardly counts in what its mixture has.
  real(wp), parameter :: least_share = 0.01_wp
  integer, parameter :: ncorner = 4

contains

  !> An error where a phase that is there has such a property at the temperature of a corner of its element.
  subroutine refuse_spent_polynomials(scene, laws, solution, error)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    type(error_t), allocatable, intent(out) :: error
    integer :: g, e, i, k, v
    real(wp) :: zero, hottest, coldest

    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      associate (group => scene%groups(g), material => scene%materials(scene%groups(g)%material))
        if (.not. allocated(material%steel)) cycle
        v = find_variable(group%variables, 'austenite')
        if (v == 0) cycle
        v = group%variables(v)%first
        if (.not. any(material%steel%properties(positive, :)%form == curve_polynomial)) cycle
        zero = material%values(find_parameter(laws(material%law_id), 'ZERO'))
        do e = 1, size(group%connectivity, 2)
          call range_of_element(scene, solution, group, e, coldest, hottest)
          do i = 1, phase_count
            if (.not. maxval(solution%groups(g)%committed(v + i - austenite, :, e)) > least_share) cycle
            do k = 1, size(positive)
              call judge(material%steel, group%name, e, positive(k), i, coldest + zero)
              call judge(material%steel, group%name, e, positive(k), i, hottest + zero)
              if (allocated(error)) return
            end do
          end do
        end do
      end associate
    end do

  contains

    subroutine judge(steel, name, element, property, phase, temperature)
      type(steel_t), intent(in) :: steel
      character(len=*), intent(in) :: name
      integer, intent(in) :: element, property, phase
      real(wp), intent(in) :: temperature   !! [degC]
      character(len=14) :: what, unit
      real(wp) :: value, taken

      if (allocated(error) .or. steel%properties(property, phase)%form /= curve_polynomial) return
      value = curve_at(steel%properties(property, phase), temperature)
      what = property_names(property)
      unit = property_units(property)
      if (property == prop_content) then
        call heat_taken(steel, phase, temperature, temperature, taken, value)
        what = 'the slope of H'
        unit = property_units(prop_rhoc)
      end if
      if (value > 0) return
      call fail(error, exit_no_convergence, 'step '//to_text(solution%step)//', time '//to_text(solution%time)//': ' &
                //trim(what)//' of ' &
                //trim(phase_names(phase))//' of the steel '''//steel%name//''' is '//to_text(value, 3)//' ' &
                //trim(unit)//' at ' &
                //to_text(temperature, 4)//' degC, in element '//to_text(element)//' of '//name, &
                'the POLY of '//trim(property_names(property))//' does not reach to this temperature: give a TABLE, which is ' &
                //'constant beyond its ends, or numbers that hold there')
    end subroutine judge

  end subroutine refuse_spent_polynomials

  !> The lowest and the highest temperature of the corners of an element.
  pure subroutine range_of_element(scene, solution, group, e, coldest, hottest)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(group_t), intent(in) :: group
    integer, intent(in) :: e
    real(wp), intent(out) :: coldest, hottest
    integer :: f

    f = find_field(solution%fields, temperature_field)
    if (group%temperature_multiplier > 0) then
      coldest = given_temperature(scene, group, solution%time)
      hottest = coldest
      return
    end if
    coldest = minval(solution%fields(f)%value(1, group%connectivity(:ncorner, e)))
    hottest = maxval(solution%fields(f)%value(1, group%connectivity(:ncorner, e)))
  end subroutine range_of_element

end module spent_polynomials
