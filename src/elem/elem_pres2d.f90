!> PRES2D: pressure on a 3-node side that follows the surface.
!>
!> Walking 1 -> 2 -> 3 the part is on the left; a positive pressure pushes into the part along its
!> inner normal: F_i = integral phi_i p (-y', x') t dxi, linearised exactly (unsymmetric matrix). The
!> thickness t of the section is the radius in an axisymmetric scene; in plane stress it is that of the start.
!> Where p is found (LOADF) the derivative by it is a column of the matrix, and its row is the volume that the side sweeps in the
!> step, over p = 1: the integral of f.du along straight ways of the nodes, by Simpson's rule, which is exact for it.
module elem_pres2d
  use elem_api, only: elem_t, instant_t, layout_t, mode_advance, no_variables, of_displacement, of_section, report_t, section_motion
  use elem_load_factor, only: load_factor_place, of_load_factor
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use quadrature, only: line_rule
  use scene, only: generalised_plane_strain, group_t, role_side_load, scene_t
  use sections, only: thickness_at
  use shape_functions, only: line3
  implicit none
  private
  public :: elem_pres2d_row

contains

  function elem_pres2d_row() result(row)
    type(elem_t) :: row

    row%name = 'PRES2D'
    row%purpose = 'pressure that follows a side'
    row%nnode = 3
    row%role = role_side_load
    allocate (row%unknowns, source=[of_displacement(), of_section(), of_load_factor()])
    row%unknowns(3)%optional = .true.
    row%symmetric = .false.
    row%effect = 'pressure'
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function elem_pres2d_row

  subroutine compute(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
                     force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :), start(:, :), drivers(:, :, :, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report  !! a load never fails
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: pressure, y(2, 3), phi(3), dphi(3), normal(2), section(3), pull
    integer :: e, p, j, factor

    factor = load_factor_place(scene, group, layout)
    call line_rule(group%rule, xi, weight)
    pressure = group%amplitude*instant%multipliers(group%multiplier)
    do e = 1, size(x, 3)
      force(:, e) = 0
      if (instant%tangent) stiffness(:, :, e) = 0
      y = x(:, :, e)
      section = scene%section
      if (kinematics%finite) then
        y = y + transpose(reshape(du(1:6, e), [3, 2]))
        section = instant%section + section_motion(layout, du(:, e))
      end if
      do p = 1, size(xi)
        call line3(xi(p), phi, dphi)
        normal = matmul(y, dphi)
        normal = [normal(2), -normal(1)]
        pull = pressure*weight(p)*thickness_at(section, matmul(y, phi))
        force(1:3, e) = force(1:3, e) + phi*pull*normal(1)
        force(4:6, e) = force(4:6, e) + phi*pull*normal(2)
        if (.not. (instant%tangent .and. kinematics%finite)) cycle
        do j = 1, 3
          stiffness(1:3, j + 3, e) = stiffness(1:3, j + 3, e) + phi*pull*dphi(j)
          stiffness(4:6, j, e) = stiffness(4:6, j, e) - phi*pull*dphi(j)
          call add_column(j, section(2)*phi(j))
          call add_column(j + 3, section(3)*phi(j))
        end do
        if (scene%plane_state /= generalised_plane_strain) cycle
        call add_column(7, 1.0_wp)
        call add_column(8, dot_product(y(1, :), phi))
        call add_column(9, dot_product(y(2, :), phi))
      end do
      if (factor > 0) call add_load_factor(unit_force(y, section))
    end do

  contains

    !> The forces of the side at a multiplier of 1.
    pure function unit_force(places, thickness) result(unit)
      real(wp), intent(in) :: places(2, 3), thickness(3)
      real(wp) :: unit(6)
      real(wp) :: n(2), shape(3), slope(3)
      integer :: k

      unit = 0
      do k = 1, size(xi)
        call line3(xi(k), shape, slope)
        n = matmul(places, slope)*group%amplitude*weight(k)*thickness_at(thickness, matmul(places, shape))
        unit = unit + [shape*n(2), -shape*n(1)]
      end do
    end function unit_force

    !> Column and row of the load factor.
    subroutine add_load_factor(now)
      real(wp), intent(in) :: now(6)
      real(wp) :: volume, slopes(9)

      if (instant%tangent) stiffness(1:6, factor, e) = now
      if (scene%load_factor%node > 0 .or. instant%mode /= mode_advance) return
      call sweep(x(:, :, e), y - x(:, :, e), section - instant%section, volume, slopes)
      force(factor, e) = volume
      if (.not. instant%tangent) return
      stiffness(factor, 1:6, e) = slopes(1:6)
      if (kinematics%finite .and. scene%plane_state == generalised_plane_strain) stiffness(factor, 7:9, e) = slopes(7:9)
    end subroutine add_load_factor

    !> The volume that the side sweeps, times the amplitude, and its derivatives by displacements and thickness.
    pure subroutine sweep(places, way, thickening, volume, slopes)
      real(wp), intent(in) :: places(2, 3), way(2, 3)   !! at the start of the step, and from there to its end [length]
      real(wp), intent(in) :: thickening(3)             !! of the section in the step
      real(wp), intent(out) :: volume                   !! [volume]
      real(wp), intent(out) :: slopes(9)
      real(wp) :: share, area, shape(3), slope(3), u(2), n(2), z(2, 3), thickness(3), t
      integer :: i, k

      volume = 0
      slopes = 0
      do i = 0, 2
        share = merge(0.5_wp*i, 0.0_wp, kinematics%finite)
        z = places + share*way
        thickness = instant%section + share*thickening
        do k = 1, size(xi)
          call line3(xi(k), shape, slope)
          u = [dot_product(du(1:3, e), shape), dot_product(du(4:6, e), shape)]
          n = matmul(z, slope)
          area = group%amplitude*weight(k)*merge(4, 1, i == 1)/6
          t = area*thickness_at(thickness, matmul(z, shape))
          area = area*(u(1)*n(2) - u(2)*n(1))
          volume = volume + t*(u(1)*n(2) - u(2)*n(1))
          slopes(1:3) = slopes(1:3) + t*(n(2)*shape - share*u(2)*slope) + share*thickness(2)*area*shape
          slopes(4:6) = slopes(4:6) + t*(-n(1)*shape + share*u(1)*slope) + share*thickness(3)*area*shape
          slopes(7:9) = slopes(7:9) + share*area*[1.0_wp, matmul(z, shape)]
        end do
      end do
    end subroutine sweep

    !> What a change of thickness along a local unknown does to the forces.
    subroutine add_column(column, thickening)
      integer, intent(in) :: column
      real(wp), intent(in) :: thickening

      stiffness(1:3, column, e) = stiffness(1:3, column, e) + phi*pressure*weight(p)*normal(1)*thickening
      stiffness(4:6, column, e) = stiffness(4:6, column, e) + phi*pressure*weight(p)*normal(2)*thickening
    end subroutine add_column

  end subroutine compute

end module elem_pres2d
