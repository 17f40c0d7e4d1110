!> Heat at a point of a side that faces a die, to the unknowns of both: what they exchange, and what friction left there
!> (elem_heat_contact has the formulas).
module heat_contact_flows
  use conductance_in_step, only: conductance_within
  use elem_api, only: instant_t, report_t
  use heat_contact_point, only: facing_t, shares_t
  use heat_contacts, only: flow_from_die, heat_contact_t
  use kinds, only: wp
  use sections, only: thickness_at
  implicit none
  private
  public :: area_t, add_exchange, add_friction, project_area

  !> Area of a point, as it is projected on the tangent of the die, and its derivatives.
  type :: area_t
    real(wp) :: size = 0.0_wp   !! per radian when axisymmetric; 0 and less where the side faces away [length^2]
    !> By the displacements of the side: x of its nodes, then y [length].
    real(wp) :: slopes(6) = 0.0_wp
    logical :: faces = .false.
  end type area_t

contains

  pure subroutine project_area(weight, y, phi, dphi, along, section, area)
    real(wp), intent(in) :: weight              !! of the point [-]
    real(wp), intent(in) :: y(2, 3)             !! nodes of the side [length]
    real(wp), intent(in) :: phi(3), dphi(3)     !! functions of the side at the point [-]
    real(wp), intent(in) :: along(2)            !! unit tangent of the die there [-]
    real(wp), intent(in) :: section(3)          !! thickness at the origin [length], and its slopes [-]
    type(area_t), intent(out) :: area
    real(wp) :: length, thickness

    length = dot_product(matmul(y, dphi), along)
    thickness = thickness_at(section, matmul(y, phi))
    area%faces = length > 0
    area%size = weight*length*thickness
    area%slopes(1:3) = weight*(dphi*along(1)*thickness + length*section(2)*phi)
    area%slopes(4:6) = weight*(dphi*along(2)*thickness + length*section(3)*phi)
  end subroutine project_area

  !> Exchange at the instants of the flow rule: one of the point, or one of each pair of ends.
  pure subroutine add_exchange(contact, instant, facing, shares, area, moving, start, du, force, stiffness)
    type(heat_contact_t), intent(in) :: contact
    type(instant_t), intent(in) :: instant
    type(facing_t), intent(in) :: facing
    type(shares_t), intent(in) :: shares
    type(area_t), intent(in) :: area
    integer, intent(in) :: moving(:)                 !! places of the displacements that change the area, 6 or none
    real(wp), intent(in) :: start(:), du(:)          !! (ndof) values at the start of the step, and motion [unknown]
    real(wp), intent(inout) :: force(:)              !! (ndof) [residual]
    real(wp), intent(inout) :: stiffness(:, :)       !! (ndof, ndof) [residual/unknown]
    real(wp) :: t(6), h(2), gone
    integer :: k, i, j, n
    type(shares_t) :: pair

    n = shares%nside + shares%ndie
    do k = 1, instant%flow%n
      t(:n) = start(shares%place(:n)) + instant%flow%share(k)*du(shares%place(:n))
      ! conductances are those at both ends of the whole step, of which a stage is a part
      gone = instant%flow%share(k)*instant%reach
      h = conductance_within(contact, facing, gone)
      if (shares%nside == 3) then
        call add_flow(contact, instant, k, shares, 1.0_wp, t(:n), h, area, moving, force, stiffness)
        cycle
      end if
      do i = 1, shares%nside
        do j = 1, shares%ndie
          pair = shares
          pair%side = 0
          pair%die = 0
          pair%side(i) = 1
          pair%die(j) = 1
          call add_flow(contact, instant, k, pair, shares%side(i)*shares%die(j), t(:n), h, area, moving, force, stiffness)
        end do
      end do
    end do
  end subroutine add_exchange

  !> The share `part` of the area exchanges between temperatures that are means by shares.
  pure subroutine add_flow(contact, instant, k, means, part, t, h, area, moving, force, stiffness)
    type(heat_contact_t), intent(in) :: contact
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: k   !! instant of the flow rule
    type(shares_t), intent(in) :: means
    real(wp), intent(in) :: part, t(:)   !! [-], [temperature]
    real(wp), intent(in) :: h(2)         !! conductances (facing_t)
    type(area_t), intent(in) :: area
    integer, intent(in) :: moving(:)
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    real(wp) :: q, slope, slope_die, gives(6), takes(6)
    integer :: n, m, j

    m = means%nside
    n = m + means%ndie
    call flow_from_die(contact, h, dot_product(means%side(:m), t(:m)), dot_product(means%die(:n - m), t(m + 1:n)), q, slope, &
                       slope_die)
    gives(:m) = -means%side(:m)
    gives(m + 1:n) = means%die(:n - m)
    takes(:m) = slope*means%side(:m)
    takes(m + 1:n) = slope_die*means%die(:n - m)
    associate (place => means%place(:n), w => instant%flow%weight(k)*part)
      force(place) = force(place) + gives(:n)*(w*q*area%size)
      if (.not. instant%tangent) return
      do j = 1, n
        stiffness(place, place(j)) = stiffness(place, place(j)) + gives(:n)*(w*area%size*instant%flow%share(k)*takes(j))
      end do
      do j = 1, size(moving)
        stiffness(place, moving(j)) = stiffness(place, moving(j)) + gives(:n)*(w*q*area%slopes(j))
      end do
    end associate
  end subroutine add_flow

  !> Heat of friction to both.
  pure subroutine add_friction(instant, shares, side_share, heat, force, report)
    type(instant_t), intent(in) :: instant
    type(shares_t), intent(in) :: shares
    real(wp), intent(in) :: side_share   !! of the heat, that the side gets where there is a die to share it with [-]
    real(wp), intent(in) :: heat         !! of the step [energy]
    real(wp), intent(inout) :: force(:)  !! (ndof) [residual]
    type(report_t), intent(inout) :: report
    real(wp) :: share

    share = side_share
    if (shares%ndie == 0) share = 1
    associate (m => shares%nside, n => shares%nside + shares%ndie)
      force(shares%place(:m)) = force(shares%place(:m)) - shares%side(:m)*(share*heat/instant%dt)
      force(shares%place(m + 1:n)) = force(shares%place(m + 1:n)) - shares%die(:n - m)*((1 - share)*heat/instant%dt)
    end associate
    report%source = report%source + (heat/instant%dt)**2
    report%heat_released = report%heat_released + heat
  end subroutine add_friction

end module heat_contact_flows
