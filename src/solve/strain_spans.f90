!> By how much the strain of temperature and phases differs across an element of steel that flows, at most so far.
!>
!> Where it differs by much of what a point goes through in the run, a front of temperature or of transformation is thinner than
!> the element: what flows plastically and by transformation while it passes is that of a few points, and does not even out later
!> (shape_error). Strains are those that nothing hinders (phase_mechanics), between the points of an element, carried on to its
!> corners.
module strain_spans
  use equations, only: equations_t
  use fields, only: find_field
  use kinds, only: wp
  use kinematics_api, only: first_history
  use phase_mechanics, only: strain_of_phases
  use phase_point, only: first_phases, flows, place_time, place_zero
  use point_temperatures, only: nodal_temperatures, projected_functions, temperature_field
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: scene_t
  use solution, only: solution_t
  use state_behind_sides, only: given_temperature
  use steels, only: austenite, phase_count
  implicit none
  private
  public :: follow_spans, strain_of_range

  !> Half the width of an element over how far its outer points are from its middle: 2 x 2 and 3 x 3 points.
  real(wp), parameter :: to_corners(2) = [sqrt(3.0_wp), sqrt(5.0_wp/3)]

contains

  !> Take the accepted state into account.
  subroutine follow_spans(scene, equations, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations   !! drivers are those of the state
    type(solution_t), intent(inout) :: solution
    real(wp) :: temperature(9), strain(9)
    integer :: g, e

    do g = 1, size(scene%groups)
      if (size(solution%groups(g)%span) == 0) cycle
      associate (n => scene%groups(g)%rule%n, material => scene%materials(scene%groups(g)%material), record => solution%shape)
        if (.not. flows(material)) cycle
        do e = 1, size(solution%groups(g)%span)
          call temperatures_of(scene, solution, g, e, temperature(:n))
          call strains_of(equations, solution, g, e, temperature(:n) + material%values(place_zero), strain(:n))
          solution%groups(g)%span(e) = max(solution%groups(g)%span(e), &
                                           (maxval(strain(:n)) - minval(strain(:n)))*to_corners(merge(1, 2, n == 4)))
          if (.not. record%followed) then
            record%coldest = temperature(1)
            record%hottest = temperature(1)
            record%followed = .true.
          end if
          record%coldest = min(record%coldest, minval(temperature(:n)))
          record%hottest = max(record%hottest, maxval(temperature(:n)))
        end do
      end associate
    end do

  contains

    !> Strains of the points of an element, those of austenite at its first one being 0.
    subroutine strains_of(equations, solution, g, e, celsius, strain)
      type(equations_t), intent(in) :: equations
      type(solution_t), intent(in) :: solution
      integer, intent(in) :: g, e
      real(wp), intent(in) :: celsius(:)   !! (npoint) [degC]
      real(wp), intent(out) :: strain(:)   !! (npoint) [-]
      real(wp) :: z(phase_count), none(phase_count)
      integer :: p

      none = 0
      none(austenite) = 1
      associate (material => scene%materials(scene%groups(g)%material))
        do p = 1, size(celsius)
          if (material%values(place_time) > 0) then
            associate (first => first_history + first_phases - 1)
              z = solution%groups(g)%committed(first:first + phase_count - 1, p, e)
            end associate
          else
            z = equations%drivers(g)%value(2:1 + phase_count, 1, p, e)
          end if
          strain(p) = strain_of_phases(material%steel, none, z, celsius(1), celsius(p))
        end do
      end associate
    end subroutine strains_of

  end subroutine follow_spans

  !> What austenite shrinks between the hottest and the coldest temperature so far.
  pure function strain_of_range(scene, solution, g) result(strain)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g   !! group
    real(wp) :: strain         !! [-]
    real(wp) :: z(phase_count)

    z = 0
    z(austenite) = 1
    associate (material => scene%materials(scene%groups(g)%material))
      strain = strain_of_phases(material%steel, z, z, solution%shape%coldest + material%values(place_zero), &
                                solution%shape%hottest + material%values(place_zero))
    end associate
  end function strain_of_range

  !> Temperatures at the points of an element, as its law has them.
  pure subroutine temperatures_of(scene, solution, g, e, temperature)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, e
    real(wp), intent(out) :: temperature(:)   !! (npoint) [temperature]
    type(quad8_rule_t) :: rule
    integer :: f

    associate (body => scene%groups(g))
      temperature = 0
      f = find_field(solution%fields, temperature_field)
      if (f > 0) then
        call quad8_rule(body%rule%n, rule)
        associate (nodal => nodal_temperatures(solution%fields(f)%value(1, body%connectivity(:8, e))))
          temperature = matmul(nodal, projected_functions(rule))
        end associate
      end if
      if (body%temperature_multiplier > 0) temperature = given_temperature(scene, body, solution%time)
    end associate
  end subroutine temperatures_of

end module strain_spans
