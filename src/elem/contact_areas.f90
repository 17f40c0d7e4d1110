!> Areas that the points of contact of a side stand for.
!>
!> The weights of an integration rule; with a control point (control_point_contact) the integrals of the Bernstein polynomials by
!> Simpson's rule: (a_1 + a_m)/3, 2 a_m/3, (a_2 + a_m)/3 with the areas a per unit of xi at the nodes.
module contact_areas
  use kinds, only: wp
  use quadrature, only: rule_control, rule_t
  use side_points, only: area_at
  implicit none
  private
  public :: area_of_point, areas_with_control

contains

  !> Area of a point of a side.
  pure function area_of_point(rule, xi, weight, p, section, x) result(area)
    type(rule_t), intent(in) :: rule
    real(wp), intent(in) :: xi(:), weight(:)   !! (npoint) of the rule [-]
    integer, intent(in) :: p                   !! the point
    real(wp), intent(in) :: section(3)         !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)            !! nodes [length]
    real(wp) :: area                           !! per radian when axisymmetric
    real(wp) :: all_three(3)

    if (rule%family == rule_control) then
      all_three = areas_with_control(section, x)
      area = all_three(p)
    else
      area = weight(p)*area_at(xi(p), section, x)
    end if
  end function area_of_point

  !> Areas of the ends of a side and of its control point.
  pure function areas_with_control(section, x) result(area)
    real(wp), intent(in) :: section(3)   !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3)      !! nodes [length]
    real(wp) :: area(3)                  !! per radian when axisymmetric
    real(wp) :: middle

    middle = area_at(0.0_wp, section, x)
    area = [area_at(-1.0_wp, section, x) + middle, 2*middle, area_at(1.0_wp, section, x) + middle]/3
  end function areas_with_control

end module contact_areas
