!> How the mechanics of solids and a temperature that is solved for with it depend on each other: columns of the forces along the
!> temperatures, and rows of the heat that plastic work, or phases under stress, release along the motion (plastic_heat).
module solid_heat_coupling
  use elem_api, only: instant_t, layout_t, mode_advance
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: driver_temperature, law_t
  use plastic_heat, only: add_rows_of_heat, latent_slopes, ncomponent, shares_of_work, volumes_at, weights_of_flow, &
                          weights_of_release
  use point_temperatures, only: nodal_temperatures, projected_functions, temperature_place
  use scene, only: generalised_plane_strain, group_t, plane_stress, scene_t
  use solid_block, only: sections_of_step, solid_block_t, update_points
  use solid_forces, only: element_forces
  use solid_terms, only: local_gradient
  use state_variables, only: find_variable
  implicit none
  private
  public :: couple_to_temperature

contains

  !> Derivatives along the temperatures, where they are solved for too, and of the heat that the mechanics releases.
  subroutine couple_to_temperature(scene, group, kinematics, law, instant, layout, block, x, du, start, drivers, committed, trial, &
                                   stiffness)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    type(solid_block_t), intent(in) :: block
    real(wp), intent(in) :: x(:, :, :)                        !! (2, 8, nelem) nodes at the start of the step [length]
    real(wp), intent(in) :: du(:, :), start(:, :)             !! (ndof, nelem) motion, and values at the start of the step [unknown]
    real(wp), intent(in) :: drivers(:, :, :, :)               !! (ndriver, :, npoint, nelem) of the interface [unit of each driver]
    real(wp), intent(in), contiguous :: committed(:, :, :)    !! (nstate, npoint, nelem) at the start [unit of each component]
    real(wp), intent(in), contiguous :: trial(:, :, :)        !! (nstate, npoint, nelem) at the end [unit of each component]
    real(wp), intent(inout) :: stiffness(:, :, :)             !! (ndof, ndof, nelem) [force/unknown]
    real(wp) :: warmer(5, group%rule%n, size(x, 3))   ! d(stress, plastic work)/d(temperature)
    integer :: n, nb, nstate

    if (.not. instant%solved(layout%field(temperature_place(layout)))) return
    n = block%n
    nb = size(x, 3)
    nstate = size(committed, 1)
    call add_columns_of_temperature()
    if (allocated(block%by_work)) call add_work()
    if (size(drivers, 2) > 3 .and. instant%mode == mode_advance .and. instant%content) call add_latent()

  contains

    !> d(force)/d(temperature): the forces of d(stress dv)/d(temperature) at the points, by central differences of the whole update
    !> (any law, any kinematics); error eps**(2/3).
    subroutine add_columns_of_temperature()
      real(wp), dimension(5, group%rule%n, nb) :: high, low
      real(wp) :: change, shape(8, layout%count(temperature_place(layout))), unused(n, n)
      real(wp) :: functions(8, group%rule%n)
      integer :: u, e, k, p

      u = temperature_place(layout)
      functions = projected_functions(block%rule)
      change = epsilon(1.0_wp)**(1.0_wp/3)*maxval(abs(block%given(driver_temperature, :, :)))
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
          call element_forces(scene, group, kinematics%finite, instant, layout, block, e, x(:, :, e), du(:, e), &
                              committed(1:4, :, e), .false., low(:4, :, e), block%dv(:, e), &
                              stiffness(:n, layout%first(1, u) + k - 1, e), unused)
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
      if (allocated(block%by_work)) without(place_of_work(), :, :) = 0
      g = block%f
      call update_at(without, change, g, other)
      answers(:4, :, :) = other(1:4, :, :)
      if (scene%plane_state == plane_stress .and. kinematics%finite) &
        answers(:4, :, :) = answers(:4, :, :)*spread(g(5, :, :)/block%f(5, :, :), 1, 4)
      answers(5, :, :) = 0
      if (allocated(block%by_work)) answers(5, :, :) = other(place_of_work(), :, :)
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
      real(wp) :: shifted(size(block%given, 1), 2, group%rule%n*nb), unused(4, 5, group%rule%n, nb)
      integer :: answers(group%rule%n, nb), k

      shifted = block%given
      shifted(driver_temperature, 2, :) = shifted(driver_temperature, 2, :) + change
      if (size(drivers, 2) == 3) then
        ! states that follow the temperature
        do k = 2, size(block%given, 1)
          shifted(k, 2, :) = shifted(k, 2, :) + change*reshape(drivers(k, 3, :, :), [group%rule%n*nb])
        end do
      end if
      call update_points(scene, group, kinematics, law, instant, before, shifted, g, other, unused, answers)
    end subroutine update_at

    !> d(heat)/d(motion) and d(heat)/d(temperature) of the plastic work.
    subroutine add_work()
      real(wp) :: slopes(ncomponent + 1, group%rule%n, nb), share(group%rule%n, nb), volume(group%rule%n, nb)

      slopes(:ncomponent, :, :) = block%by_work
      slopes(ncomponent + 1, :, :) = warmer(5, :, :)
      if (.not. any(abs(slopes) > 0)) return
      call shares_of_work(scene, group, instant, layout, block%rule, start, share)
      volume = volumes_of_mesh()
      if (kinematics%finite .and. scene%plane_state /= plane_stress) volume = volumes_of_work()
      call add_rows(weights_of_release(instant, layout, block%rule, volume, share), slopes)
    end subroutine add_work

    !> Rows of the temperatures of what slopes along h and the temperature release.
    subroutine add_rows(weight, slopes)
      real(wp), intent(in) :: weight(:, :, :)   !! (8, npoint, nelem) of each node
      real(wp), intent(in) :: slopes(:, :, :)   !! (ncomponent + 1, npoint, nelem)

      call add_rows_of_heat(layout, block%rule, weight, block%nx, block%ny, motion_across(), slopes, stiffness)
    end subroutine add_rows

    !> Volumes without elastic strain at the start of the step, which plastic work is per.
    function volumes_of_work() result(volume)
      real(wp) :: volume(group%rule%n, nb)

      volume = volumes_at(block%rule, instant%section, x)*exp(-committed(5, :, :) - committed(6, :, :) - committed(8, :, :))
    end function volumes_of_work

    !> Volumes at the start of the mesh.
    function volumes_of_mesh() result(volume)
      real(wp) :: volume(group%rule%n, nb)

      volume = volumes_at(block%rule, scene%section, nodes_of_mesh())
    end function volumes_of_mesh

    !> Nodes at the start of the mesh.
    function nodes_of_mesh() result(x0)
      real(wp) :: x0(2, 8, nb)
      integer :: i

      do i = 1, nb
        x0(:, :, i) = scene%mesh%coordinates(:, group%connectivity(:, block%first + i - 1))
      end do
    end function nodes_of_mesh

    !> d h_zz/d(motion): of the nodes, and of the section where it moves.
    function motion_across() result(zz)
      real(wp) :: zz(n, group%rule%n, nb)
      real(wp) :: section(3, 2), whole(5, 19)
      integer :: i, k

      zz = 0
      zz(:8, :, :) = block%zx
      if (scene%plane_state /= generalised_plane_strain) return
      do i = 1, nb
        call sections_of_step(scene, kinematics%finite, instant, layout, du(:, i), section)
        do k = 1, group%rule%n
          whole = local_gradient(block%rule, k, section(:, 1), kinematics%finite, x(:, :, i), du(:, i), block%nx(:, k, i), &
                                 block%ny(:, k, i))
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
      call add_rows(weights_of_release(instant, layout, block%rule, volumes_of_mesh(), share), slopes)
      do k = 1, instant%flow%n
        if (.not. any(abs(drivers(:, 4 + k, :, :)) > 0)) cycle
        call slopes_by_stress(4 + k, slopes)
        weight = weights_of_flow(scene, instant, layout, kinematics%finite, block%rule, k, nodes_of_mesh(), x, du, start)
        if (scene%plane_state == plane_stress .and. kinematics%finite) weight = weight*spread(committed(nstate, :, :), 1, 8)
        call add_rows(weight, slopes)
      end do
    end subroutine add_latent

    !> Derivatives along h and the temperature of what the measures of the stress drive, by a plane of the drivers.
    subroutine slopes_by_stress(plane, slopes)
      integer, intent(in) :: plane
      real(wp), intent(out) :: slopes(:, :, :)
      integer :: i, p

      do i = 1, nb
        do p = 1, group%rule%n
          call latent_slopes(scene%plane_state == plane_stress, drivers(:, plane, p, i), trial(1:4, p, i), &
                             block%tangent(:, :, p, i), warmer(:4, p, i), slopes(:, p, i))
        end do
      end do
    end subroutine slopes_by_stress

  end subroutine couple_to_temperature

end module solid_heat_coupling
