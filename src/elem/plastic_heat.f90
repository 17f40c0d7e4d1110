!> Heat that the plastic work of a body releases (QUINNEY), or phases that form under its stress (METAMEC), along the motion and the
!> temperature of the body.
!>
!> PL8TM releases it as -phi_i SHARE (w - w_n)/dt dv_n and knows the work w at the points, not how that depends on the motion.
!> PL8LS does: where all fields are solved for together it adds -phi_i SHARE dw/dt dv_n to the rows of the temperature, with dw
!> along h = d(du)/dx(n+1) and the temperature at the points. Latent heat r by the mean and von Mises' stress is released as
!> -phi_i r/dt dv0: there dr = sum dr/dm dm/d sigma d sigma (driver_slopes). The same phases conduct, w_k grad phi_i LAMBDA grad T_k
!> dv: there dLAMBDA in the same way. Left out are the volume ratio in dv0 of bodies that have had a new mesh, the sharing of the
!> change of volume by the option MEAN, and the section's own motion in generalised plane strain.
module plastic_heat
  use elem_api, only: instant_t, layout_t, mode_advance
  use fields, only: displacement_field
  use heat_points, only: functions_of, functions_t, heat_points_t, place_element
  use heat_sources, only: share_of_work, work_heated
  use kinds, only: wp
  use point_temperatures, only: nodal_temperatures, projected_functions, temperature_place
  use quad8_geometry, only: derivatives, quad8_rule_t
  use scene, only: group_t, role_second, scene_t
  use sections, only: thickness_at
  use state_variables, only: find_variable
  use stress_measures, only: von_mises
  implicit none
  private
  public :: add_rows_of_heat, heated_by_work, latent_slopes, ncomponent, shares_of_work, volumes_at, weights_of_flow, &
            weights_of_release

  !> Components of h: xx, xy, yx, yy, zz.
  integer, parameter :: ncomponent = 5

contains

  !> The formulation of heat on a body whose plastic work becomes heat in the solve under way; 0 where there is none.
  pure function heated_by_work(scene, group, layout, instant) result(heated)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group   !! of the body
    type(layout_t), intent(in) :: layout
    type(instant_t), intent(in) :: instant
    integer :: heated                    !! place among the groups
    integer :: g

    heated = 0
    if (instant%mode /= mode_advance .or. .not. instant%content .or. temperature_place(layout) == 0) return
    if (.not. (instant%solved(layout%field(temperature_place(layout))) .and. instant%solved(displacement_field))) return
    if (find_variable(group%variables, 'plastic_work') == 0) return
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_second) cycle
      if (scene%groups(scene%groups(g)%host)%name /= group%name) cycle
      if (find_variable(scene%groups(g)%variables, work_heated) > 0) heated = g
    end do
  end function heated_by_work

  !> The share of the plastic work that becomes heat, at the points of a block of elements.
  pure subroutine shares_of_work(scene, group, instant, layout, rule, start, share)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: start(:, :)    !! (ndof, nelem) values at the start of the step [unknown]
    real(wp), intent(out) :: share(:, :)   !! (npoint, nelem) [-]
    type(functions_t) :: own
    integer :: u, n, e, p, at, g, place

    g = heated_by_work(scene, group, layout, instant)
    place = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, work_heated))%needs
    u = temperature_place(layout)
    n = layout%count(u)
    at = layout%first(1, u) - 1
    call functions_of(n == 4, rule, own)
    do e = 1, size(share, 2)
      do p = 1, rule%npoint
        share(p, e) = share_of_work(scene%materials(scene%groups(g)%material), place, &
                                    dot_product(own%phi(:n, p), start(at + 1:at + n, e)))
      end do
    end do
  end subroutine shares_of_work

  !> Derivatives of latent heat, or of the conductivity, along h and the temperature, by the measures of the stress that drive it.
  pure subroutine latent_slopes(flat, by_measure, stress, tangent, by_temperature, slopes)
    logical, intent(in) :: flat                     !! plane stress: h_zz follows from no stress there
    real(wp), intent(in) :: by_measure(:)           !! (nmeasure or more) d()/d(measure) [unit/stress]
    real(wp), intent(in) :: stress(4)               !! [stress]
    real(wp), intent(in) :: tangent(4, 5)           !! d(stress)/dh [stress]
    real(wp), intent(in) :: by_temperature(4)       !! d(stress)/d(temperature) [stress/temperature]
    real(wp), intent(out) :: slopes(ncomponent + 1) !! [unit], [unit/temperature]
    real(wp) :: heat(4), deviator(4), q, moduli(4, 5)
    integer :: c

    ! d(mean)/d(stress) and d(von Mises)/d(stress), the shear counting twice
    q = von_mises(stress)
    heat = by_measure(2)*[1, 1, 0, 1]/3.0_wp
    deviator = stress - (stress(1) + stress(2) + stress(4))/3*[1, 1, 0, 1]
    if (q > 0) heat = heat + by_measure(1)*1.5_wp/q*deviator*[1, 1, 2, 1]
    moduli = tangent
    if (flat) then
      do c = 1, 4
        moduli(:, c) = tangent(:, c) - tangent(:, 5)*(tangent(4, c)/tangent(4, 5))
      end do
      moduli(:, 5) = 0
    end if
    slopes(:ncomponent) = matmul(heat, moduli)
    slopes(ncomponent + 1) = dot_product(heat, by_temperature)
  end subroutine latent_slopes

  !> Volumes at the points of a block of elements.
  pure function volumes_at(rule, section, x) result(volume)
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: section(3)                    !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(:, :, :)                    !! (2, 8, nelem) nodes [length]
    real(wp) :: volume(rule%npoint, size(x, 3))           !! per radian when axisymmetric
    real(wp) :: unused_x(8), unused_y(8), detj
    integer :: e, p

    do e = 1, size(x, 3)
      do p = 1, rule%npoint
        call derivatives(rule%dphi(:, :, p), x(:, :, e), unused_x, unused_y, detj)
        volume(p, e) = detj*rule%weight(p)*thickness_at(section, matmul(x(:, :, e), rule%phi(:, p)))
      end do
    end do
  end function volumes_at

  !> What a unit of heat released per volume at each point takes from the rows of the temperature.
  function weights_of_release(instant, layout, rule, volume, share) result(weight)
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: volume(:, :)   !! (npoint, nelem) that the heat is per [volume]
    real(wp), intent(in) :: share(:, :)    !! (npoint, nelem) what becomes heat [-]
    real(wp) :: weight(8, rule%npoint, size(volume, 2))   !! of each temperature, the first of 8 [volume/time]
    type(functions_t) :: own
    integer :: n, e, p

    n = layout%count(temperature_place(layout))
    call functions_of(n == 4, rule, own)
    weight = 0
    do e = 1, size(volume, 2)
      do p = 1, rule%npoint
        weight(:n, p, e) = -own%phi(:n, p)*(share(p, e)*volume(p, e)/instant%dt)
      end do
    end do
  end function weights_of_release

  !> What a unit of conductivity at each point brings to the rows of the temperature at one of the instants of the flow rule.
  function weights_of_flow(scene, instant, layout, finite, rule, k, x0, x, du, start) result(weight)
    type(scene_t), intent(in) :: scene
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    logical, intent(in) :: finite
    type(quad8_rule_t), intent(in) :: rule
    integer, intent(in) :: k                               !! instant of the flow rule
    real(wp), intent(in) :: x0(:, :, :), x(:, :, :)        !! (2, 8, nelem) nodes at the start of the mesh, and of the step [length]
    real(wp), intent(in) :: du(:, :), start(:, :)          !! (ndof, nelem) motion of the step, and values at its start [unknown]
    real(wp) :: weight(8, rule%npoint, size(x, 3))         !! of each temperature, the first of 8 [length*temperature]
    type(functions_t) :: own
    type(heat_points_t) :: place
    real(wp) :: t(8)
    integer :: n, at, e, p

    n = layout%count(temperature_place(layout))
    at = layout%first(1, temperature_place(layout)) - 1
    call functions_of(n == 4, rule, own)
    weight = 0
    do e = 1, size(x, 3)
      t(:n) = start(at + 1:at + n, e) + instant%flow%share(k)*du(at + 1:at + n, e)
      call place_element(scene, instant, finite, rule, own, x0(:, :, e), x(:, :, e), du(:16, e), place)
      do p = 1, rule%npoint
        associate (gx => place%gx(:n, p), gy => place%gy(:n, p))
          weight(:n, p, e) = place%dv(p)*(gx*dot_product(gx, t(:n)) + gy*dot_product(gy, t(:n)))
        end associate
      end do
    end do
  end function weights_of_flow

  !> Add the derivatives of what a block of elements brings to the rows of the temperature.
  subroutine add_rows_of_heat(layout, rule, weight, nx, ny, zz, slopes, stiffness)
    type(layout_t), intent(in) :: layout
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: weight(:, :, :)            !! (8, npoint, nelem) by the row of each temperature [volume/time]
    real(wp), intent(in) :: nx(:, :, :), ny(:, :, :)               !! (8, npoint, nelem) gradients [1/length]
    real(wp), intent(in) :: zz(:, :, :)                            !! (nmotion, npoint, nelem) d h_zz/d(motion) [1/unknown]
    real(wp), intent(in) :: slopes(:, :, :)                        !! (6, npoint, nelem) d()/dh, and by temperature
    real(wp), intent(inout) :: stiffness(:, :, :)                  !! (ndof, ndof, nelem)
    real(wp) :: row(size(stiffness, 2)), projected(8, rule%npoint)
    integer :: u, n, e, p, k, at

    u = temperature_place(layout)
    n = layout%count(u)
    at = layout%first(1, u) - 1
    projected = projected_functions(rule)
    do e = 1, size(stiffness, 3)
      do p = 1, rule%npoint
        row = 0
        associate (s => slopes(:, p, e))
          row(:size(zz, 1)) = s(5)*zz(:, p, e)
          row(1:8) = row(1:8) + (s(1)*nx(:, p, e) + s(2)*ny(:, p, e))
          row(9:16) = row(9:16) + (s(3)*nx(:, p, e) + s(4)*ny(:, p, e))
          do k = 1, n
            row(at + k) = s(6)*dot_product(nodal_temperatures(unit_vector(k, n)), projected(:, p))
          end do
        end associate
        do k = 1, n
          stiffness(at + k, :, e) = stiffness(at + k, :, e) + weight(k, p, e)*row
        end do
      end do
    end do
  end subroutine add_rows_of_heat

  pure function unit_vector(k, n) result(v)
    integer, intent(in) :: k, n
    real(wp) :: v(n)

    v = 0
    v(k) = 1
  end function unit_vector

end module plastic_heat
