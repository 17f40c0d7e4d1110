!> PL8LS: 8-node quadrilateral in all plane states, updated Lagrangian (annex 1, corrected).
!>
!> Internal force per unit of the section (per radian when axisymmetric), F_i = sum B_i^T sigma t |J| W,
!> with the Cauchy stress in the present configuration and the thickness t of the section (sections).
!> Tangent K = sum G^T M G t|J|W, where G takes the local unknowns to h = d(du)/dx (xx, xy, yx, yy, zz)
!> and M = A + geometric part. The geometric part is annex 1's matrix, d(F) at frozen stress, written once
!> for all unknowns: d(sigma J f^-T) = J (sigma tr h - sigma h^T). Across the plane h_zz = dt/t: in
!> generalised plane strain dt = da1 + x da2 + y da3 + a2 dx + a3 dy, an axisymmetric scene being a = (0, 1, 0);
!> in plane stress h_zz is condensed out of M by the row of sigma_zz = 0. With the option MEAN the
!> points share few values of the change of volume (mean_dilatation).
module elem_pl8ls
  use elem_api, only: block_inverted, block_law_failed, elem_t, instant_t, layout_t, of_displacement, of_section, report_t, &
                      that_reads
  use kinds, only: wp
  use kinematics_api, only: kinematics_t, solid_variables
  use law_api, only: law_done, law_t, solid_law
  use mean_dilatation, only: dilatation_t, mean_option, share_dilatation
  use plastic_heat, only: heated_by_work, ncomponent
  use point_temperatures, only: temperature_field
  use scene, only: group_t, plane_stress, role_body, scene_t
  use solid_block, only: drive_points, follows_temperature, sections_of_step, solid_block_t, start_block, update_points
  use solid_forces, only: element_forces
  use solid_heat_coupling, only: couple_to_temperature
  use solid_kernels, only: motion
  use solid_measure, only: measure_solid
  use solid_terms, only: first_element
  use state_variables, only: state_variable, state_variable_t, transfer_scalar
  implicit none
  private
  public :: elem_pl8ls_row

contains

  function elem_pl8ls_row() result(row)
    type(elem_t) :: row

    row%name = 'PL8LS'
    row%purpose = '8-node quadrilateral, large strain'
    row%nnode = 8
    row%role = role_body
    allocate (row%unknowns, source=[of_displacement(), of_section(), that_reads(temperature_field)])
    row%law_kind = solid_law
    row%effect = 'displacement'
    allocate (row%options(1))
    row%options(mean_option)%s = 'MEAN'
    row%unsymmetric_option = mean_option
    row%variables => variables
    row%compute => compute
    row%measure => measure_solid
  end function elem_pl8ls_row

  !> State of the point of a solid; in plane stress also the stretch across the plane since the start, last.
  pure subroutine variables(law, plane_state, list)
    type(law_t), intent(in) :: law
    integer, intent(in) :: plane_state
    type(state_variable_t), allocatable, intent(out) :: list(:)
    type(state_variable_t), allocatable :: others(:)
    type(state_variable_t) :: stretch

    call solid_variables(law, others)
    if (plane_state /= plane_stress) then
      call move_alloc(others, list)
      return
    end if
    stretch = state_variable('stretch_zz', '-', transfer_scalar)
    stretch%initial = 1
    stretch%first = others(size(others))%first + others(size(others))%ncomp
    allocate (list, source=[others, stretch])
  end subroutine variables

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
    type(report_t), intent(out) :: report
    type(solid_block_t) :: block
    integer :: status(group%rule%n, size(x, 3))
    integer :: e

    call start_block(group, law, layout, first, size(du, 1), size(x, 3), block)
    do e = 1, size(x, 3)
      call move_points(e)
      if (report%status == 0) cycle
      force = 0
      return
    end do
    call drive_points(group, instant, layout, du, start, drivers, block)
    if (instant%tangent .and. heated_by_work(scene, group, layout, instant) > 0) &
      allocate (block%by_work(ncomponent, group%rule%n, size(x, 3)))
    call update_points(scene, group, kinematics, law, instant, committed, block%given, block%f, trial, block%tangent, status, &
                       block%by_work)
    if (scene%plane_state == plane_stress .and. kinematics%finite) block%dv = block%dv*trial(size(trial, 1), :, :)
    do e = 1, size(x, 3)
      if (any(status(:, e) /= law_done) .and. report%status == 0) then
        report%status = block_law_failed
        report%element = first + e - 1
      end if
      associate (n => block%n)
        if (n < size(du, 1)) then
          force(n + 1:, e) = 0
          if (instant%tangent) stiffness(:, :, e) = 0
        end if
        call element_forces(scene, group, kinematics%finite, instant, layout, block, e, x(:, :, e), du(:, e), &
                            committed(1:4, :, e), instant%tangent, trial(1:4, :, e), block%dv(:, e), force(:n, e), &
                            stiffness(:n, :n, e))
      end associate
    end do
    if (instant%tangent .and. report%status == 0 .and. follows_temperature(group, layout)) &
      call couple_to_temperature(scene, group, kinematics, law, instant, layout, block, x, du, start, drivers, committed, trial, &
                                 stiffness)

  contains

    !> Geometry of an element at the end of the step, and the motion of its points.
    subroutine move_points(element)
      integer, intent(in) :: element
      real(wp) :: section(3, 2), strain
      type(dilatation_t) :: own
      logical :: valid

      call sections_of_step(scene, kinematics%finite, instant, layout, du(:, element), section)
      call motion(block%rule, section, kinematics%finite, x(:, :, element), du(:, element), block%nx(:, :, element), &
                  block%ny(:, :, element), block%zx(:, :, element), block%dv(:, element), block%f(:, :, element), strain, valid)
      report%strain = max(report%strain, strain)
      if (valid .and. group%option == mean_option) then
        call first_element(scene, block%rule, group%connectivity(:, first + element - 1), own)
        call share_dilatation(kinematics%finite, own, block%dv(:, element), block%f(:, :, element), valid)
      end if
      if (valid) return
      report%status = block_inverted
      report%element = first + element - 1
    end subroutine move_points

  end subroutine compute

end module elem_pl8ls
