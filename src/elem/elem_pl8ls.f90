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
  use elem_api, only: block_inverted, block_law_failed, elem_t, group_temperature, instant_t, layout_t, mode_advance, &
                      of_displacement, of_section, report_t, section_motion, that_reads
  use kinds, only: wp
  use kinematics_api, only: kinematics_t, solid_variables
  use linear_pressure, only: has_linear_pressure, replace_pressure
  use law_api, only: driver_count, driver_temperature, law_done, law_t, solid_law
  use mean_dilatation, only: dilatation_t, mean_option, share_dilatation
  use plane_stress_points, only: update_plane_stress
  use plastic_heat, only: add_rows_of_heat, heated_by_work, latent_slopes, ncomponent, shares_of_work, &
                          volumes_at, weights_of_flow, weights_of_release
  use point_temperatures, only: nodal_temperatures, point_temperatures_of, projected_functions, temperature_field, temperature_place
  use quad8_geometry, only: quad8_rule_t, quad8_rule
  use scene, only: generalised_plane_strain, group_t, plane_stress, role_body, scene_t
  use solid_kernels, only: internal_force, motion, tangent_matrix
  use solid_measure, only: measure_solid
  use solid_terms, only: add_section, first_element, local_gradient, mean_element
  use state_variables, only: find_variable, state_variable, state_variable_t, transfer_scalar
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
    type(quad8_rule_t) :: rule
    type(dilatation_t) :: own
    real(wp), dimension(8, group%rule%n, size(x, 3)) :: nx, ny, zx
    real(wp) :: dv(group%rule%n, size(x, 3)), f(5, group%rule%n, size(x, 3)), tangent(4, 5, group%rule%n, size(x, 3))
    real(wp) :: given(driver_count(law), 2, group%rule%n*size(x, 3)), section(3, 2)
    real(wp) :: functions(8, group%rule%n), warmer(5, group%rule%n, size(x, 3))   ! d(stress, plastic work)/d(temperature)
    real(wp), allocatable :: by_work(:, :, :)   ! d(plastic work)/dh, where it heats in the solve under way
    integer :: status(group%rule%n, size(x, 3))
    integer :: e, n, nb, nstate

    nb = size(x, 3)
    n = size(du, 1)
    if (temperature_place(layout) > 0) n = layout%first(1, temperature_place(layout)) - 1
    nstate = size(committed, 1)
    call quad8_rule(group%rule%n, rule)
    do e = 1, nb
      call move_points(e)
      if (report%status == 0) cycle
      force = 0
      return
    end do
    call find_drivers()
    if (instant%tangent .and. heated_by_work(scene, group, layout, instant) > 0) then
      allocate (by_work(ncomponent, group%rule%n, nb))
      call update_points(committed, given, f, trial, tangent, status, by_work)
    else
      call update_points(committed, given, f, trial, tangent, status)
    end if
    if (scene%plane_state == plane_stress .and. kinematics%finite) dv = dv*trial(nstate, :, :)
    do e = 1, nb
      if (any(status(:, e) /= law_done) .and. report%status == 0) then
        report%status = block_law_failed
        report%element = first + e - 1
      end if
      if (n < size(du, 1)) then
        force(n + 1:, e) = 0
        if (instant%tangent) stiffness(:, :, e) = 0
      end if
      call forces_of(e, instant%tangent, trial(1:4, :, e), dv(:, e), force(:n, e), stiffness(:n, :n, e))
    end do
    if (instant%tangent .and. report%status == 0 .and. follows_temperature()) call couple_to_temperature()

  contains

    !> Geometry of an element at the end of the step, and the motion of its points.
    subroutine move_points(element)
      integer, intent(in) :: element
      real(wp) :: strain
      logical :: valid

      call sections_of_step(scene, kinematics%finite, instant, layout, du(:, element), section)
      call motion(rule, section, kinematics%finite, x(:, :, element), du(:, element), nx(:, :, element), ny(:, :, element), &
                  zx(:, :, element), dv(:, element), f(:, :, element), strain, valid)
      report%strain = max(report%strain, strain)
      if (valid .and. group%option == mean_option) then
        call first_element(scene, rule, group%connectivity(:, first + element - 1), own)
        call share_dilatation(kinematics%finite, own, dv(:, element), f(:, :, element), valid)
      end if
      if (valid) return
      report%status = block_inverted
      report%element = first + element - 1
    end subroutine move_points

    !> The temperature is an unknown of the scene. A body with a TEMPE card has that temperature also where others have a field.
    pure function follows_temperature() result(follows)
      logical :: follows

      follows = temperature_place(layout) > 0 .and. group%temperature_multiplier == 0
    end function follows_temperature

    !> What drives the points, at both ends of the step: the temperature, and what else the law asks for.
    subroutine find_drivers()
      integer :: i, k, p

      if (follows_temperature()) then
        functions = projected_functions(rule)
        do i = 1, nb
          p = (i - 1)*group%rule%n
          call point_temperatures_of(layout, functions, du(:, i), start(:, i), &
                                     given(driver_temperature, :, p + 1:p + group%rule%n))
        end do
      else
        given(driver_temperature, :, :) = spread(group_temperature(group, instant), 2, group%rule%n*nb)
      end if
      do k = 2, size(given, 1)
        given(k, :, :) = reshape(drivers(k, :2, :, :), [2, group%rule%n*nb])
      end do
    end subroutine find_drivers

    !> State at the end of a step from the state `before`; in plane stress the motion across the plane is found.
    subroutine update_points(before, driven, g, after, moduli, answers, along)
      real(wp), intent(in), contiguous :: before(:, :, :), driven(:, :, :)
      real(wp), intent(inout), contiguous :: g(:, :, :)
      real(wp), intent(inout), contiguous :: after(:, :, :)
      real(wp), intent(out), contiguous :: moduli(:, :, :, :)
      integer, intent(out), contiguous :: answers(:, :)
      real(wp), intent(out), contiguous, optional :: along(:, :, :)   !! d(plastic work)/dh

      if (scene%plane_state == plane_stress) then
        call update_plane_stress(kinematics, law, scene%materials(group%material), instant%dt, group%rule%n*nb, nstate, driven, &
                                 g, before, after, moduli, answers, along)
        after(nstate, :, :) = before(nstate, :, :)*g(5, :, :)
      else
        call kinematics%update(law, scene%materials(group%material), instant%dt, group%rule%n*nb, nstate, driven, &
                               g, before, after, moduli, answers, along)
      end if
    end subroutine update_points

    !> Derivatives along the temperatures, where they are solved for too, and of the heat that the mechanics releases.
    subroutine couple_to_temperature()
      if (.not. instant%solved(layout%field(temperature_place(layout)))) return
      call add_columns_of_temperature()
      if (allocated(by_work)) call add_work()
      if (size(drivers, 2) > 3 .and. instant%mode == mode_advance .and. instant%content) call add_latent()
    end subroutine couple_to_temperature

    !> Forces of the stresses at the points of an element on its mechanical unknowns, and the matrix where it is wanted.
    subroutine forces_of(element, wanted, stress, volume, f_element, k_element)
      integer, intent(in) :: element
      logical, intent(in) :: wanted
      real(wp), intent(in) :: stress(:, :)
      real(wp), intent(in), contiguous :: volume(:)
      real(wp), intent(out) :: f_element(:)
      real(wp), intent(inout) :: k_element(:, :)
      real(wp) :: counted(4, group%rule%n)
      logical :: mean

      mean = group%option == mean_option
      if (mean .or. scene%plane_state == generalised_plane_strain .or. (wanted .and. has_linear_pressure(instant))) &
        call sections_of_step(scene, kinematics%finite, instant, layout, du(:, element), section)
      associate (nodes => group%connectivity(:, first + element - 1), moduli => tangent(:, :, :, element))
        if (mean) call first_element(scene, rule, nodes, own)
        counted = stress
        if (wanted .and. kinematics%finite .and. scene%plane_state /= plane_stress .and. has_linear_pressure(instant)) then
          if (mean) then
            call replace_pressure(instant, rule, nodes, section, x(:, :, element), du(:, element), volume, &
                                  committed(1:4, :, element), moduli, counted, own)
          else
            call replace_pressure(instant, rule, nodes, section, x(:, :, element), du(:, element), volume, &
                                  committed(1:4, :, element), moduli, counted)
          end if
        end if
        if (mean) then
          call mean_element(kinematics%finite, wanted, rule, section, own, x(:, :, element), du(:, element), nx(:, :, element), &
                            ny(:, :, element), volume, stress, counted, moduli, f_element, k_element)
          return
        end if
        call internal_force(nx(:, :, element), ny(:, :, element), zx(:, :, element), volume, stress, f_element(1:16))
        if (wanted) call tangent_matrix(scene%plane_state == plane_stress, kinematics%finite, nx(:, :, element), &
                                        ny(:, :, element), zx(:, :, element), volume, counted, moduli, k_element(1:16, 1:16))
        if (scene%plane_state /= generalised_plane_strain) return
        call add_section(kinematics%finite, wanted, rule, section, x(:, :, element), du(:, element), nx(:, :, element), &
                         ny(:, :, element), volume, stress, counted, moduli, f_element, k_element)
      end associate
    end subroutine forces_of

    !> d(force)/d(temperature): the forces of d(stress dv)/d(temperature) at the points, by central differences of the whole update
    !> (any law, any kinematics); error eps**(2/3).
    subroutine add_columns_of_temperature()
      real(wp), dimension(5, group%rule%n, nb) :: high, low
      real(wp) :: change, shape(8, layout%count(temperature_place(layout))), unused(n, n)
      integer :: u, k, p

      u = temperature_place(layout)
      change = epsilon(1.0_wp)**(1.0_wp/3)*maxval(abs(given(driver_temperature, :, :)))
      ! nothing has a temperature yet: any number serves
      if (.not. change > 0) change = epsilon(1.0_wp)**(1.0_wp/3)
      call answers_at(change, high)
      call answers_at(-change, low)
      warmer = (high - low)/(2*change)
      do k = 1, layout%count(u)
        shape(:, k) = nodal_temperatures(merge(1.0_wp, 0.0_wp, [(p == k, p=1, layout%count(u))]))
      end do
      do e = 1, nb
        do k = 1, layout%count(u)
          low(:4, :, e) = warmer(:4, :, e)*spread(matmul(shape(:, k), functions), 1, 4)
          call forces_of(e, .false., low(:4, :, e), dv(:, e), stiffness(:n, layout%first(1, u) + k - 1, e), unused)
        end do
      end do
    end subroutine add_columns_of_temperature

    !> Stresses at the end of the step, times the volume over that of the trial state, and the plastic work of the step, were all
    !> temperatures higher. Work done before would cost digits.
    subroutine answers_at(change, answers)
      real(wp), intent(in) :: change
      real(wp), intent(out) :: answers(:, :, :)   !! (5, npoint, nelem)
      real(wp) :: without(nstate, group%rule%n, nb), other(nstate, group%rule%n, nb), g(5, group%rule%n, nb)

      without = committed
      if (allocated(by_work)) without(place_of_work(), :, :) = 0
      g = f
      call update_at(without, change, g, other)
      answers(:4, :, :) = other(1:4, :, :)
      if (scene%plane_state == plane_stress .and. kinematics%finite) &
        answers(:4, :, :) = answers(:4, :, :)*spread(g(5, :, :)/f(5, :, :), 1, 4)
      answers(5, :, :) = 0
      if (allocated(by_work)) answers(5, :, :) = other(place_of_work(), :, :)
    end subroutine answers_at

    pure function place_of_work() result(row)
      integer :: row

      row = group%variables(find_variable(group%variables, 'plastic_work'))%first
    end function place_of_work

    !> State at the end of the step from the state `before`, were temperatures higher and the motion g.
    subroutine update_at(before, change, g, other)
      real(wp), intent(in), contiguous :: before(:, :, :)
      real(wp), intent(in) :: change
      real(wp), intent(inout), contiguous :: g(:, :, :)
      real(wp), intent(out), contiguous :: other(:, :, :)
      real(wp) :: shifted(size(given, 1), 2, group%rule%n*nb), unused(4, 5, group%rule%n, nb)
      integer :: answers(group%rule%n, nb), k

      shifted = given
      shifted(driver_temperature, 2, :) = shifted(driver_temperature, 2, :) + change
      if (size(drivers, 2) == 3) then
        ! states that follow the temperature
        do k = 2, size(given, 1)
          shifted(k, 2, :) = shifted(k, 2, :) + change*reshape(drivers(k, 3, :, :), [group%rule%n*nb])
        end do
      end if
      call update_points(before, shifted, g, other, unused, answers)
    end subroutine update_at

    !> d(heat)/d(motion) and d(heat)/d(temperature) of the plastic work.
    subroutine add_work()
      real(wp) :: slopes(ncomponent + 1, group%rule%n, nb), share(group%rule%n, nb)

      slopes(:ncomponent, :, :) = by_work
      slopes(ncomponent + 1, :, :) = warmer(5, :, :)
      if (.not. any(abs(slopes) > 0)) return
      call shares_of_work(scene, group, instant, layout, rule, start, share)
      if (kinematics%finite .and. scene%plane_state /= plane_stress) then
        call add_rows_of_heat(layout, rule, weights_of_release(instant, layout, rule, volumes_of_work(), share), nx, ny, &
                              motion_across(), slopes, stiffness)
      else
        call add_rows_of_heat(layout, rule, weights_of_release(instant, layout, rule, volumes_of_mesh(), share), nx, ny, &
                              motion_across(), slopes, stiffness)
      end if
    end subroutine add_work

    !> Volumes without elastic strain at the start of the step, which plastic work is per.
    function volumes_of_work() result(volume)
      real(wp) :: volume(group%rule%n, nb)

      volume = volumes_at(rule, instant%section, x)*exp(-committed(5, :, :) - committed(6, :, :) - committed(8, :, :))
    end function volumes_of_work

    !> Volumes at the start of the mesh.
    function volumes_of_mesh() result(volume)
      real(wp) :: volume(group%rule%n, nb)

      volume = volumes_at(rule, scene%section, nodes_of_mesh())
    end function volumes_of_mesh

    !> Nodes at the start of the mesh.
    function nodes_of_mesh() result(x0)
      real(wp) :: x0(2, 8, nb)
      integer :: i

      do i = 1, nb
        x0(:, :, i) = scene%mesh%coordinates(:, group%connectivity(:, first + i - 1))
      end do
    end function nodes_of_mesh

    !> d h_zz/d(motion): of the nodes, and of the section where it moves.
    function motion_across() result(zz)
      real(wp) :: zz(n, group%rule%n, nb)
      real(wp) :: whole(5, 19)
      integer :: i, k

      zz = 0
      zz(:8, :, :) = zx
      if (scene%plane_state /= generalised_plane_strain) return
      do i = 1, nb
        call sections_of_step(scene, kinematics%finite, instant, layout, du(:, i), section)
        do k = 1, group%rule%n
          whole = local_gradient(rule, k, section(:, 1), kinematics%finite, x(:, :, i), du(:, i), nx(:, k, i), ny(:, k, i))
          zz(:, k, i) = whole(5, :n)
        end do
      end do
    end function motion_across

    !> The same of latent heat that the stress drives (METAMEC), and of the conductivity of those phases, from the derivatives of
    !> the stress.
    subroutine add_latent()
      real(wp) :: slopes(ncomponent + 1, group%rule%n, nb), share(group%rule%n, nb), weight(8, group%rule%n, nb)
      integer :: k

      share = 1
      call slopes_by_stress(4, slopes)
      call add_rows_of_heat(layout, rule, weights_of_release(instant, layout, rule, volumes_of_mesh(), share), nx, ny, &
                            motion_across(), slopes, stiffness)
      do k = 1, instant%flow%n
        if (.not. any(abs(drivers(:, 4 + k, :, :)) > 0)) cycle
        call slopes_by_stress(4 + k, slopes)
        weight = weights_of_flow(scene, instant, layout, kinematics%finite, rule, k, nodes_of_mesh(), x, du, start)
        if (scene%plane_state == plane_stress .and. kinematics%finite) weight = weight*spread(committed(nstate, :, :), 1, 8)
        call add_rows_of_heat(layout, rule, weight, nx, ny, motion_across(), slopes, stiffness)
      end do
    end subroutine add_latent

    !> Derivatives along h and the temperature of what the measures of the stress drive, by a plane of the drivers.
    subroutine slopes_by_stress(plane, slopes)
      integer, intent(in) :: plane
      real(wp), intent(out) :: slopes(:, :, :)
      integer :: i, p

      do i = 1, nb
        do p = 1, group%rule%n
          call latent_slopes(scene%plane_state == plane_stress, drivers(:, plane, p, i), trial(1:4, p, i), tangent(:, :, p, i), &
                             warmer(:4, p, i), slopes(:, p, i))
        end do
      end do
    end subroutine slopes_by_stress

  end subroutine compute

  !> Section (:, 1) the geometry is at, and its motion (:, 2) in the step.
  pure subroutine sections_of_step(scene, finite, instant, layout, du, section)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: finite
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: du(:)
    real(wp), intent(out) :: section(3, 2)

    section(:, 2) = section_motion(layout, du)
    section(:, 1) = scene%section
    if (finite) section(:, 1) = instant%section + section(:, 2)
  end subroutine sections_of_step

end module elem_pl8ls
