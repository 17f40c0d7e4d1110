!> PRES2D: pressure on a 3-node side that follows the surface.
!>
!> Walking 1 -> 2 -> 3 the part is on the left; a positive pressure pushes into the part along its
!> inner normal: F_i = integral phi_i p (-y', x') r dxi, linearised exactly (unsymmetric matrix).
module elem_pres2d
  use elem_api, only: elem_t, instant_t, report_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use quadrature, only: line_rule
  use scene, only: axisymmetric, group_t, scene_t
  use shape_functions, only: line3
  use state_variables, only: state_variable_t
  implicit none
  private
  public :: elem_pres2d_row

contains

  function elem_pres2d_row() result(row)
    type(elem_t) :: row

    row%name = 'PRES2D'
    row%purpose = 'pressure that follows a side'
    row%nnode = 3
    row%symmetric = .false.
    row%effect = 'pressure'
    row%variables => variables
    row%compute => compute
  end function elem_pres2d_row

  pure subroutine variables(law, list)
    type(law_t), intent(in) :: law
    type(state_variable_t), allocatable, intent(out) :: list(:)

    allocate (list(0))
  end subroutine variables

  subroutine compute(scene, group, kinematics, law, instant, first, x, du, committed, trial, force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report  !! a load never fails
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: pressure, y(2, 3), phi(3), dphi(3), tangent(2), radius
    integer :: e, p, j
    logical :: axisym

    axisym = scene%plane_state == axisymmetric
    call line_rule(group%npoint, xi, weight)
    pressure = group%amplitude*instant%multipliers(group%multiplier)
    do e = 1, size(x, 3)
      force(:, e) = 0
      if (instant%tangent) stiffness(:, :, e) = 0
      y = x(:, :, e)
      if (kinematics%finite) y = y + transpose(reshape(du(1:6, e), [3, 2]))
      do p = 1, size(xi)
        call line3(xi(p), phi, dphi)
        tangent = matmul(y, dphi)
        radius = 1
        if (axisym) radius = dot_product(y(1, :), phi)
        associate (pw => pressure*weight(p))
          force(1:3, e) = force(1:3, e) + phi*pw*tangent(2)*radius
          force(4:6, e) = force(4:6, e) - phi*pw*tangent(1)*radius
          if (.not. (instant%tangent .and. kinematics%finite)) cycle
          do j = 1, 3
            stiffness(1:3, j + 3, e) = stiffness(1:3, j + 3, e) + phi*pw*dphi(j)*radius
            stiffness(4:6, j, e) = stiffness(4:6, j, e) - phi*pw*dphi(j)*radius
            if (.not. axisym) cycle
            stiffness(1:3, j, e) = stiffness(1:3, j, e) + phi*pw*tangent(2)*phi(j)
            stiffness(4:6, j, e) = stiffness(4:6, j, e) - phi*pw*tangent(1)*phi(j)
          end do
        end associate
      end do
    end do
  end subroutine compute

end module elem_pres2d
