!> FLUX, CONVE and RADIA: heat that passes the sides of bodies.
!>
!> Heat that comes in per area, q: FLUX an amplitude (by the temperature T of the surface, where a table is given) times a
!> multiplier, in the mean of the step; CONVE h (Ts - T), the coefficient h an amplitude as well, times a multiplier at the
!> instant, Ts the temperature of the surroundings; RADIA
!> h (Ta^4 - (T + Z)^4), h emissivity times Stefan's and Boltzmann's constant, Ta = Ts + Z, Z what makes the temperatures of the
!> deck absolute (module radiation). F_i = -sum_k w_k integral phi_i q dA at the instants k of the flow rule
!> (elem_api), on the side as it is at the end of the step; linearised exactly, along the displacements too. Where temperatures
!> stand on corners all is lumped at the ends of the side, as the capacity is: no temperature leaves those around it.
module elem_heat_sides
  use elem_api, only: elem_t, first_unknown, instant_t, layout_t, mode_advance, no_variables, report_t, that_reads
  use fields, only: displacement_field
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use loads, only: by_convection, by_radiation, exchange_t, value_in_table
  use quadrature, only: line_rule
  use radiation, only: fourth_powers
  use scene, only: group_t, role_side_load, scene_t
  use sections, only: thickness_at
  use shape_functions, only: line3
  use vectors, only: length_of
  implicit none
  private
  public :: elem_flux_row, elem_conve_row, elem_radia_row, flow_in, heat_side_row

  !> The temperature is the first of the element's unknowns.
  integer, parameter :: temperature = 1

contains

  function elem_flux_row() result(row)
    type(elem_t) :: row

    row = common_row('FLUX', 'heat flow through a side')
  end function elem_flux_row

  function elem_conve_row() result(row)
    type(elem_t) :: row

    row = common_row('CONVE', 'convection from a side')
  end function elem_conve_row

  function elem_radia_row() result(row)
    type(elem_t) :: row

    row = common_row('RADIA', 'radiation from a side')
  end function elem_radia_row

  function common_row(name, purpose) result(row)
    character(len=*), intent(in) :: name, purpose
    type(elem_t) :: row

    row = heat_side_row(name, purpose, role_side_load)
    row%compute => compute
  end function common_row

  !> What elements of heat on sides of three nodes have in common: they act on the temperature, and read the motion.
  function heat_side_row(name, purpose, role) result(row)
    character(len=*), intent(in) :: name, purpose
    integer, intent(in) :: role
    type(elem_t) :: row

    row%name = name
    row%purpose = purpose
    row%nnode = 3
    row%role = role
    allocate (row%unknowns, source=[that_reads('temperature'), that_reads('displacement')])
    row%unknowns(1)%acts = .true.
    row%effect = 'heat'
    allocate (row%options(0))
    row%variables => no_variables
  end function heat_side_row

  !> Heat flows out of the nodes of all sides of a block, and their derivatives. A side never fails.
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
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: y(2, 3), own(3), area, darea(6), section(3)
    integer :: e, p, k, n, u

    force = 0
    if (instant%tangent) stiffness = 0
    if (instant%mode /= mode_advance) return
    n = layout%count(temperature)
    u = first_unknown(layout, displacement_field)
    section = scene%section
    if (kinematics%finite) section = instant%section
    call line_rule(group%rule, xi, weight)
    do e = 1, size(x, 3)
      y = x(:, :, e)
      if (u > 0 .and. kinematics%finite) y = y + transpose(reshape(du(u:u + 5, e), [3, 2]))
      do p = 1, size(xi)
        call place_point(xi(p), weight(p))
        do k = 1, instant%flow%n
          call add_flow(start(:n, e) + instant%flow%share(k)*du(:n, e))
        end do
      end do
    end do

  contains

    !> The area of a point of the side, its derivatives, and the functions of the temperature there.
    subroutine place_point(xi, weight)
      real(wp), intent(in) :: xi, weight
      real(wp) :: phi(3), dphi(3), tangent(2), length, thickness

      call line3(xi, phi, dphi)
      tangent = matmul(y, dphi)
      length = length_of(tangent)
      thickness = thickness_at(section, matmul(y, phi))
      area = weight*length*thickness
      darea(1:3) = weight*(dphi*tangent(1)/length*thickness + length*section(2)*phi)
      darea(4:6) = weight*(dphi*tangent(2)/length*thickness + length*section(3)*phi)
      own = phi
      if (n == 2) own = [0.5_wp*[1 - xi, 1 + xi], 0.0_wp]
    end subroutine place_point

    !> The heat of a point at one of the instants, where the nodes have these temperatures; all of it at the ends of the side where
    !> temperatures stand there.
    subroutine add_flow(t)
      real(wp), intent(in) :: t(:)   !! (n) [temperature]
      integer :: i

      if (n == 2) then
        do i = 1, 2
          call add(t(i), own(i)*unit_of(i), unit_of(i))
        end do
      else
        call add(dot_product(own, t), own, own)
      end if
    end subroutine add_flow

    !> The heat at a temperature: to the nodes by `share`; the temperature depends on theirs by `along`.
    subroutine add(here, share, along)
      real(wp), intent(in) :: here, share(3), along(3)
      real(wp) :: q, slope, part
      integer :: j

      call flow_in(group%exchange, instant%flow%multipliers(:, k), instant%flow%stated(:, k), here, q, slope)
      part = instant%flow%weight(k)
      force(:n, e) = force(:n, e) - share(:n)*(part*q*area)
      if (.not. instant%tangent) return
      do j = 1, n
        stiffness(:n, j, e) = stiffness(:n, j, e) - share(:n)*(part*instant%flow%share(k)*slope*area*along(j))
      end do
      if (u == 0 .or. .not. kinematics%finite) return
      do j = 1, 6
        stiffness(:n, u + j - 1, e) = stiffness(:n, u + j - 1, e) - share(:n)*(part*q*darea(j))
      end do
    end subroutine add

    pure function unit_of(place) result(vector)
      integer, intent(in) :: place
      real(wp) :: vector(3)

      vector = 0
      vector(place) = 1
    end function unit_of

  end subroutine compute

  !> Heat that comes in per area at a temperature of the surface, and its derivative.
  pure subroutine flow_in(exchange, multipliers, stated, t, q, slope)
    type(exchange_t), intent(in) :: exchange
    real(wp), intent(in) :: multipliers(:)   !! (nmultiplier) at the instant [-]
    real(wp), intent(in) :: stated(:)        !! (nmultiplier) of heat that is stated (elem_api) [-]
    real(wp), intent(in) :: t                !! [temperature]
    real(wp), intent(out) :: q, slope        !! [power/area], [power/area/temperature]
    real(wp) :: h, dh, factor, surroundings, powers, by_t, unused

    h = exchange%amplitude
    dh = 0
    if (allocated(exchange%table)) then
      call value_in_table(exchange%table, t, h, dh)
      h = exchange%amplitude*h
      dh = exchange%amplitude*dh
    end if
    if (exchange%multiplier > 0) then
      factor = multipliers(exchange%multiplier)
      if (exchange%kind /= by_convection .and. exchange%kind /= by_radiation) factor = stated(exchange%multiplier)
      h = h*factor
      dh = dh*factor
    end if
    surroundings = exchange%surroundings
    if (exchange%surroundings_multiplier > 0) surroundings = surroundings*multipliers(exchange%surroundings_multiplier)
    select case (exchange%kind)
    case (by_convection)
      q = h*(surroundings - t)
      slope = dh*(surroundings - t) - h
    case (by_radiation)
      call fourth_powers(surroundings + exchange%zero, t + exchange%zero, powers, unused, by_t)
      q = h*powers
      slope = dh*powers + h*by_t
    case default
      q = h
      slope = dh
    end select
  end subroutine flow_in

end module elem_heat_sides
