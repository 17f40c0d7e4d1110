!> BFORC and CENTR: forces on the volume of a body as it is now.
!>
!> Forces F_i = -integral phi_i b dv, b being a force per volume along x or y (BFORC), or for a body that turns with the
!> angular velocity w, density w^2 times the distance from the axis (CENTR): along x about the axis y of an axisymmetric
!> scene, along x and y about the origin of a plane one. Linearised exactly: d(b dv) = (db + b tr h) dv, h of the solid
!> elements (unsymmetric matrix where b has a direction of its own). In plane stress the thickness is that of the start.
module elem_body_forces
  use elem_api, only: elem_t, instant_t, layout_t, no_variables, of_displacement, of_section, report_t, section_motion
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: axisymmetric, generalised_plane_strain, group_t, role_volume_load, scene_t
  use sections, only: thickness_at
  implicit none
  private
  public :: elem_bforc_row, elem_centr_row

contains

  function elem_bforc_row() result(row)
    type(elem_t) :: row

    row = common_row()
    row%name = 'BFORC'
    row%purpose = 'force on the volume of a body'
    row%compute => compute_force
  end function elem_bforc_row

  function elem_centr_row() result(row)
    type(elem_t) :: row

    row = common_row()
    row%name = 'CENTR'
    row%purpose = 'centrifugal force on the volume of a body'
    row%squares_multiplier = .true.
    row%compute => compute_centrifugal
  end function elem_centr_row

  function common_row() result(row)
    type(elem_t) :: row

    row%nnode = 8
    row%role = role_volume_load
    allocate (row%unknowns, source=[of_displacement(), of_section()])
    row%symmetric = .false.
    row%effect = 'body force'
    allocate (row%options(0))
    row%variables => no_variables
  end function common_row

  !> Amplitude times multiplier, along the group's direction.
  subroutine compute_force(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
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
    real(wp) :: b(2)
    integer :: e

    b = 0
    b(group%direction) = group%amplitude*instant%multipliers(group%multiplier)
    do e = 1, size(x, 3)
      call load_element(scene, kinematics%finite, instant, layout, group%rule%n, b, [0.0_wp, 0.0_wp], x(:, :, e), du(:, e), &
                        force(:, e), stiffness(:, :, e))
    end do
  end subroutine compute_force

  !> Amplitude (density times the square of an angular velocity) times the square of the multiplier, times the distance.
  subroutine compute_centrifugal(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
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
    type(report_t), intent(out) :: report
    real(wp) :: growth(2)
    integer :: e

    growth = group%amplitude*instant%multipliers(group%multiplier)**2
    if (scene%plane_state == axisymmetric) growth(2) = 0
    do e = 1, size(x, 3)
      call load_element(scene, kinematics%finite, instant, layout, group%rule%n, [0.0_wp, 0.0_wp], growth, x(:, :, e), &
                        du(:, e), force(:, e), stiffness(:, :, e))
    end do
  end subroutine compute_centrifugal

  !> Forces and matrix for b = b0 + growth x at present places x.
  pure subroutine load_element(scene, finite, instant, layout, npoint, b0, growth, x, du, force, stiffness)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: finite
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: npoint
    real(wp), intent(in) :: b0(2), growth(2)         !! [force/volume], [force/volume/length]
    real(wp), intent(in) :: x(2, 8), du(:)
    real(wp), intent(out) :: force(:)
    real(wp), intent(inout) :: stiffness(:, :)
    type(quad8_rule_t) :: rule
    real(wp) :: y(2, 8), section(3), here(2), nx(8), ny(8), detj, thickness, b(2), push(16), swelling(size(force))
    integer :: p, j

    force = 0
    if (instant%tangent) stiffness = 0
    y = x
    section = scene%section
    if (finite) then
      y = y + transpose(reshape(du(1:16), [8, 2]))
      section = instant%section + section_motion(layout, du)
    end if
    call quad8_rule(npoint, rule)
    do p = 1, npoint
      call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
      associate (phi => rule%phi(:, p))
        here = matmul(y, phi)
        thickness = thickness_at(section, here)
        b = b0 + growth*here
        push = [phi, phi]*(detj*rule%weight(p)*thickness)
        force(1:8) = force(1:8) - b(1)*push(1:8)
        force(9:16) = force(9:16) - b(2)*push(9:16)
        if (.not. (instant%tangent .and. finite)) cycle
        ! tr h along the local unknowns
        swelling(1:8) = nx + section(2)*phi/thickness
        swelling(9:16) = ny + section(3)*phi/thickness
        if (scene%plane_state == generalised_plane_strain) swelling(17:19) = [1.0_wp, here]/thickness
        do j = 1, size(force)
          stiffness(1:8, j) = stiffness(1:8, j) - b(1)*swelling(j)*push(1:8)
          stiffness(9:16, j) = stiffness(9:16, j) - b(2)*swelling(j)*push(9:16)
        end do
        do j = 1, 8
          stiffness(1:8, j) = stiffness(1:8, j) - growth(1)*phi(j)*push(1:8)
          stiffness(9:16, j + 8) = stiffness(9:16, j + 8) - growth(2)*phi(j)*push(9:16)
        end do
      end associate
    end do
  end subroutine load_element

end module elem_body_forces
