!> HEATS: heat released in the volume of a body; FACES: heat that passes the faces of a sheet in plane stress.
!>
!> q per present volume, an amplitude (by the temperature, where a table is given) times a multiplier:
!> F_i = -sum_k w_k sum phi_i q(T_k) dv at the instants k of the flow rule (elem_api). Linearised exactly, along the displacements
!> too. Where temperatures stand on corners the source is lumped there, as the capacity is. In plane stress of finite strains dv
!> has the thickness at the start of the step, as in PL8TM.
!> The faces of a sheet have q per present area, as sides do (elem_heat_sides), and dv over the thickness for each of them: the
!> temperature is one across the sheet, as of a fin.
!> Source: H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, sec. 4.2 (thin rods that lose heat from their surface).
module elem_heat_source
  use elem_api, only: block_inverted, elem_t, first_unknown, instant_t, layout_t, mode_advance, no_variables, report_t, that_reads
  use elem_heat_sides, only: flow_in
  use fields, only: displacement_field
  use heat_points, only: functions_of, functions_t, heat_points_t, place_element
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: group_t, role_volume_load, scene_t
  implicit none
  private
  public :: elem_heats_row, elem_faces_row

  !> The temperature is the first of the element's unknowns.
  integer, parameter :: temperature = 1

contains

  function elem_heats_row() result(row)
    type(elem_t) :: row

    row = common_row('HEATS', 'heat released in the volume of a body')
  end function elem_heats_row

  function elem_faces_row() result(row)
    type(elem_t) :: row

    row = common_row('FACES', 'heat through the faces of a sheet')
  end function elem_faces_row

  function common_row(name, purpose) result(row)
    character(len=*), intent(in) :: name, purpose
    type(elem_t) :: row

    row%name = name
    row%purpose = purpose
    row%nnode = 8
    row%role = role_volume_load
    allocate (row%unknowns, source=[that_reads('temperature'), that_reads('displacement')])
    row%unknowns(temperature)%acts = .true.
    row%effect = 'heat'
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function common_row

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
    type(quad8_rule_t) :: rule
    type(functions_t) :: own
    type(heat_points_t) :: place
    real(wp) :: motion(16), t(8)
    integer :: e, k, p, n, u, moves

    force = 0
    if (instant%tangent) stiffness = 0
    if (instant%mode /= mode_advance) return
    n = layout%count(temperature)
    call quad8_rule(group%rule%n, rule)
    call functions_of(n == 4, rule, own)
    u = first_unknown(layout, displacement_field)
    moves = merge(16, 0, u > 0)
    do e = 1, size(x, 3)
      if (u > 0) motion = du(u:u + 15, e)
      call place_element(scene, instant, kinematics%finite, rule, own, &
                         scene%mesh%coordinates(:, group%connectivity(:, first + e - 1)), x(:, :, e), motion(:moves), place)
      if (.not. place%valid) then
        report%status = block_inverted
        report%element = first + e - 1
        return
      end if
      if (any(group%exchange%faces)) then
        place%dv(:rule%npoint) = place%dv(:rule%npoint)*count(group%exchange%faces)/scene%section(1)
      else if (size(drivers, 1) > 0) then
        place%dv(:rule%npoint) = place%dv(:rule%npoint)*drivers(1, 1, :, e)
      end if
      do k = 1, instant%flow%n
        t(:n) = start(:n, e) + instant%flow%share(k)*du(:n, e)
        do p = 1, rule%npoint
          call add_point()
        end do
      end do
    end do

  contains

    !> The source at a point; all of it on the corners where temperatures stand there.
    subroutine add_point()
      real(wp) :: share(8)
      integer :: j

      if (n == 8) then
        call add(dot_product(own%phi(:n, p), t(:n)), own%phi(:, p), own%phi(:, p))
        return
      end if
      do j = 1, n
        share = 0
        share(j) = 1
        call add(t(j), own%phi(j, p)*share, share)
      end do
    end subroutine add_point

    !> The source at a temperature: to the nodes by `to`; the temperature depends on theirs by `along`.
    subroutine add(here, to, along)
      real(wp), intent(in) :: here, to(8), along(8)
      real(wp) :: q, slope, weight
      integer :: i

      call flow_in(group%exchange, instant%flow%multipliers(:, k), instant%flow%stated(:, k), here, q, slope)
      weight = instant%flow%weight(k)*place%dv(p)
      force(:n, e) = force(:n, e) - to(:n)*(weight*q)
      if (.not. instant%tangent) return
      do i = 1, n
        stiffness(:n, i, e) = stiffness(:n, i, e) - to(:n)*(weight*instant%flow%share(k)*slope*along(i))
      end do
      if (u == 0 .or. .not. kinematics%finite) return
      do i = 1, 16
        stiffness(:n, u + i - 1, e) = stiffness(:n, u + i - 1, e) - to(:n)*(weight*q*place%swelling(i, p))
      end do
    end subroutine add

  end subroutine compute

end module elem_heat_source
