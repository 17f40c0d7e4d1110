!> GOLDAK: heat of a welding torch in the volume of bodies (weld_sources).
!>
!> F_i = -sum_k w_k m_k sum phi_i q(x_k, t_k) dv at the instants k of the flow rule (elem_api), on the elements where they stand
!> then, by the motion of the step so far; with nine points each. q is the shape of the source there and m_k what makes the sum over
!> all elements of its bodies the stated power at every instant, whatever the mesh and wherever the ellipsoid ends. It depends on no
!> temperature; its derivative along the motion is left out: it only moves heat about within the ellipsoid, by the share that the
!> thermal expansion in a step is of its axes, and Newton's iteration converges by that factor where both are solved together.
module elem_weld_source
  use elem_api, only: block_inverted, block_without_source, elem_t, instant_t, layout_t, mode_advance, no_variables, report_t, &
                      that_reads
  use heat_points, only: functions_of, functions_t
  use kinds, only: pi, wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: axisymmetric, group_t, role_volume_load, scene_t
  use sections, only: thickness_at
  use weld_sources, only: plane_integral, reaches, shape_at
  implicit none
  private
  public :: elem_goldak_row, source_factors, source_share

  !> Points of an element; and the least share of the ellipse for which the power can be placed.
  integer, parameter :: npoint = 9
  real(wp), parameter :: least_share = 0.01_wp
  !> Factor of a source that has no place.
  real(wp), parameter :: no_place = -1.0_wp

contains

  function elem_goldak_row() result(row)
    type(elem_t) :: row

    row%name = 'GOLDAK'
    row%purpose = 'heat of a welding torch'
    row%nnode = 8
    row%role = role_volume_load
    allocate (row%unknowns, source=[that_reads('temperature')])
    row%unknowns(1)%acts = .true.
    row%effect = 'heat'
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function elem_goldak_row

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
    real(wp) :: shape(npoint), area(npoint), volume(npoint), here(2, 8)
    integer :: e, k, n
    logical :: valid

    force = 0
    if (instant%tangent) stiffness = 0
    if (instant%mode /= mode_advance) return
    n = layout%count(1)
    call quad8_rule(npoint, rule)
    call functions_of(n == 4, rule, own)
    do k = 1, instant%flow%n
      associate (factor => instant%flow%source_factors(group%source, k), time => instant%flow%times(k))
        if (factor < 0) then
          report%status = block_without_source
          report%element = first
          return
        end if
        if (.not. factor > 0) cycle
        do e = 1, size(x, 3)
          here = instant%flow%places(:, group%connectivity(:, first + e - 1), k)
          if (.not. reaches(scene%sources(group%source), time, here)) cycle
          call sample(scene, group%source, rule, instant%flow%sections(:, k), time, here, shape, area, volume, valid)
          if (.not. valid) then
            report%status = block_inverted
            report%element = first + e - 1
            return
          end if
          force(:n, e) = force(:n, e) - instant%flow%weight(k)*factor*matmul(own%phi(:n, :npoint), shape*volume)
        end do
      end associate
    end do
  end subroutine compute

  !> What makes the power of a source that of the elements, for each source at one time; negative where it has no place.
  pure subroutine source_factors(scene, section, coordinates, time, power, factors)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: section(3)          !! at this time (sections)
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) at this time [length]
    real(wp), intent(in) :: time                !! [time]
    real(wp), intent(in) :: power(:)            !! (nsource) of each then [power]
    real(wp), intent(out) :: factors(:)         !! (nsource) heat per volume at the centre [power/volume]
    real(wp) :: own, area, volume
    integer :: k

    do k = 1, size(scene%sources)
      factors(k) = 0
      ! per radian where the scene is axisymmetric, as volumes are
      own = power(k)
      if (scene%plane_state == axisymmetric) own = own/(2*pi)
      if (.not. own > 0) cycle
      call integrate(scene, k, section, coordinates, time, area, volume)
      factors(k) = no_place
      if (volume > 0 .and. area > least_share*plane_integral(scene%sources(k))) factors(k) = own/volume
    end do
  end subroutine source_factors

  !> Share of half the ellipse of a source that lies in its bodies, on the mesh as it is read. In an axisymmetric scene the bodies
  !> go on beyond the axis as their mirror images: a torch on the axis is all within.
  pure function source_share(scene, source, time) result(share)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: source      !! place in the scene's list
    real(wp), intent(in) :: time       !! [time]
    real(wp) :: share
    real(wp) :: area, volume, beyond

    call integrate(scene, source, scene%section, scene%mesh%coordinates, time, area, volume)
    beyond = 0
    if (scene%plane_state == axisymmetric) call integrate(scene, source, scene%section, scene%mesh%coordinates, time, beyond, &
                                                          volume, mirrored=.true.)
    share = (area + beyond)/plane_integral(scene%sources(source))
  end function source_share

  !> Integrals of the shape of a source over the elements of its bodies.
  pure subroutine integrate(scene, source, section, coordinates, time, area, volume, mirrored)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: source
    real(wp), intent(in) :: section(3), coordinates(:, :), time
    real(wp), intent(out) :: area, volume   !! [length^2], [length^3, per radian when axisymmetric]
    logical, intent(in), optional :: mirrored   !! the elements stand on the other side of x = 0
    !> Nodes in the order that turns a mirrored element the right way round.
    integer, parameter :: turned(8) = [2, 1, 4, 3, 5, 8, 7, 6]
    type(quad8_rule_t) :: rule
    real(wp) :: x(2, 8), shape(npoint), dx(npoint), dv(npoint)
    integer :: g, e
    logical :: valid, beyond

    beyond = .false.
    if (present(mirrored)) beyond = mirrored
    area = 0
    volume = 0
    call quad8_rule(npoint, rule)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%source /= source) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        x = coordinates(:, scene%groups(g)%connectivity(:, e))
        if (beyond) then
          x = x(:, turned)
          x(1, :) = -x(1, :)
        end if
        if (.not. reaches(scene%sources(source), time, x)) cycle
        call sample(scene, source, rule, section, time, x, shape, dx, dv, valid)
        if (.not. valid) cycle
        area = area + dot_product(shape, dx)
        volume = volume + dot_product(shape, dv)
      end do
    end do
  end subroutine integrate

  !> Shape of a source at the points of an element, and their areas and volumes.
  pure subroutine sample(scene, source, rule, section, time, x, shape, area, volume, valid)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: source
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: section(3), time, x(2, 8)
    real(wp), intent(out) :: shape(npoint), area(npoint), volume(npoint)
    logical, intent(out) :: valid
    real(wp) :: nx(8), ny(8), detj, point(2)
    integer :: p

    valid = .true.
    do p = 1, npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      point = matmul(x, rule%phi(:, p))
      valid = valid .and. detj > 0
      area(p) = detj*rule%weight(p)
      volume(p) = area(p)*thickness_at(section, point)
      shape(p) = shape_at(scene%sources(source), time, point)
    end do
  end subroutine sample

end module elem_weld_source
