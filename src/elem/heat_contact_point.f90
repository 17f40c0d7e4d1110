!> What a point of a side faces for heat through contact, and the unknowns that it exchanges between (elem_heat_contact).
module heat_contact_point
  use closest_point, only: closest_point_t
  use curve_search, only: closest_facing_point
  use drivers, only: as_without_contact, at_die_piece, at_die_xi, at_gap, at_handed, at_pressure, at_status, &
                     heat_contact_drivers, not_handed
  use elem_api, only: instant_t, layout_t
  use heat_contacts, only: conductance_of
  use kinds, only: wp
  use law_api, only: contact_open
  use parabolas, only: tangent_on
  use plane_vectors, only: turned
  use scene, only: group_t, scene_t
  use shape_functions, only: line3
  use side_points, only: contact_point_t, most_unknowns, side_point
  use vectors, only: length_of
  implicit none
  private
  public :: conductance_by_contact, facing_t, find_facing, share_out, shares_t, touching_still

  !> The temperature is the first of the element's unknowns, that of a rigid die the second.
  integer, parameter :: temperature = 1, of_die = 2
  !> A point is closed at a gap below this share of its side, round-off of coordinates; the die is searched for within `searched`,
  !> as deep in the part as that too, where no wider reach is given. In a scene of heat alone no contact says what touches: there
  !> two curves that are drawn as one but cut into other parabolas may differ by `drawn` of a side (arcs of 20 degrees by 1e-4).
  real(wp), parameter :: touching = 1.0e-9_wp, searched = 0.05_wp, drawn = 1.0e-3_wp

  !> What a point faces.
  type :: facing_t
    logical :: found = .false.
    integer :: piece = 0
    real(wp) :: xi = 0.0_wp
    !> Conductances at the start and at the end of the step (conductance_of in heat_contacts).
    real(wp) :: conductance(2, 2) = 0.0_wp
    !> Contact knows of the point at both ends of the step: closed there, its pressures [stress], and its gaps, of closed points
    !> below 0 [length].
    logical :: followed = .false., closed(2) = .false.
    real(wp) :: pressure(2) = 0.0_wp, gap(2) = 0.0_wp
    !> Unit tangent of the die, in the sense in which the side is walked.
    real(wp) :: along(2) = 0.0_wp
  end type facing_t

  !> Unknowns that a point acts on: local places, and its shares of the side and of the die there.
  type :: shares_t
    integer :: nside = 0, ndie = 0, place(6) = 0
    real(wp) :: side(3) = 0.0_wp, die(3) = 0.0_wp
  end type shares_t

contains

  !> Conductances of a point by what its contact has reached, not_handed where that knows nothing of a die.
  pure function conductance_by_contact(group, drivers, side) result(h)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: drivers(:)   !! at one end of the step
    real(wp), intent(in) :: side         !! length of the side [length]
    real(wp) :: h(2)

    h = not_handed
    if (nint(drivers(at_die_piece)) > 0) &
      h = conductance_of(group%heat_contact, is_closed(drivers, side), drivers(at_pressure), -drivers(at_gap))
  end function conductance_by_contact

  !> The contact of a point bears, or it lies on the die.
  pure function is_closed(drivers, side) result(closed)
    real(wp), intent(in) :: drivers(:)   !! at one end of the step
    real(wp), intent(in) :: side         !! length of the side [length]
    logical :: closed

    closed = nint(drivers(at_status)) /= contact_open .or. -drivers(at_gap) <= touching*side
  end function is_closed

  !> What a point faces: by its contact, or by a search where that knows nothing.
  subroutine find_facing(scene, group, instant, drivers, phi, dphi, section, side, x, y, facing)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(instant_t), intent(in) :: instant
    real(wp), intent(in) :: drivers(:, :), phi(3), dphi(3), section(3)
    real(wp), intent(in) :: side                 !! length of the side [length]
    real(wp), intent(in) :: x(2, 3), y(2, 3)     !! nodes at the start and at the end of the step [length]
    type(facing_t), intent(out) :: facing
    type(contact_point_t) :: point
    type(closest_point_t) :: closest
    real(wp), parameter :: still(6) = 0.0_wp
    real(wp) :: gap
    logical :: closed
    integer :: k

    if (size(drivers, 1) > 0) then
      facing%piece = nint(drivers(at_die_piece, 2))
      facing%xi = drivers(at_die_xi, 2)
      do k = 1, 2
        facing%conductance(:, k) = conductance_by_contact(group, drivers(:, k), side)
        facing%closed(k) = is_closed(drivers(:, k), side)
      end do
      facing%pressure = drivers(at_pressure, :)
      facing%gap = -drivers(at_gap, :)
      ! the first step, or a die that has come near
      facing%followed = all(facing%conductance(1, :) >= 0)
      if (facing%conductance(1, 1) < 0 .and. facing%piece > 0) then
        if (allocated(scene%dies(group%die)%nodes)) then
          facing%conductance(:, 1) = facing%conductance(:, 2)
        else
          call search_at_start(scene, group, instant, phi, dphi, section, side, x, closest)
          facing%followed = closest%piece > 0
          facing%gap(1) = merge(-closest%d, huge(side), facing%followed)
          facing%closed(1) = facing%gap(1) <= touching*side
          facing%pressure(1) = 0
          facing%conductance(:, 1) = conductance_of(group%heat_contact, facing%closed(1), 0.0_wp, facing%gap(1))
        end if
      end if
      if (.not. drivers(at_handed, 2) < 0) then
        facing%conductance(:, 2) = drivers(at_handed:heat_contact_drivers, 2)
      else if (.not. drivers(at_handed, 2) > as_without_contact .and. facing%piece > 0) then
        ! the point was searched: on a rigid die at the start, on sides at the end of the step
        facing%conductance(:, 2) = facing%conductance(:, 1)
        if (allocated(scene%dies(group%die)%nodes)) &
          facing%conductance(:, 2) = conductance_of(group%heat_contact, facing%gap(2) <= touching*side, 0.0_wp, facing%gap(2))
      end if
      closed = facing%closed(2)
      gap = facing%gap(2)
    end if
    if (facing%piece == 0) then
      if (allocated(scene%dies(group%die)%nodes)) then
        call side_point(phi, dphi, section, y, still, most_unknowns, point)
        call closest_facing_point(instant%dies(group%die), point%x, point%e_r, reach_of(group, side), closest)
      else
        call search_at_start(scene, group, instant, phi, dphi, section, side, x, closest)
      end if
      facing%piece = closest%piece
      facing%xi = closest%xi
      if (facing%piece == 0) return
      gap = -closest%d
      closed = gap <= merge(touching, touching_still(group), size(drivers, 1) > 0)*side
      facing%conductance = spread(conductance_of(group%heat_contact, closed, 0.0_wp, gap), 2, 2)
      facing%followed = .false.
    end if
    facing%found = closed .or. gap <= group%heat_contact%reach .or. any(facing%conductance > 0)
    if (allocated(scene%dies(group%die)%nodes)) then
      facing%along = tangent_on(instant%dies(group%die)%pieces(:, :, facing%piece), facing%xi)
    else
      facing%along = turned(tangent_on(scene%dies(group%die)%pieces(:, :, facing%piece), facing%xi), instant%pilots(3, group%die))
    end if
    facing%along = facing%along/length_of(facing%along)
  end subroutine find_facing

  !> The closest point of a rigid die where both stand at the start of the step (one that is made of sides is known at its end
  !> alone).
  subroutine search_at_start(scene, group, instant, phi, dphi, section, side, x, closest)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(instant_t), intent(in) :: instant
    real(wp), intent(in) :: phi(3), dphi(3), section(3)
    real(wp), intent(in) :: side      !! length of the side [length]
    real(wp), intent(in) :: x(2, 3)   !! its nodes at the start of the step [length]
    type(closest_point_t), intent(out) :: closest
    type(contact_point_t) :: point
    real(wp), parameter :: still(6) = 0.0_wp

    associate (pilot => instant%pilots(:, group%die))
      call side_point(phi, dphi, section, x, still, most_unknowns, point)
      call closest_facing_point(scene%dies(group%die), turned(point%x - pilot(1:2), -pilot(3)), turned(point%e_r, -pilot(3)), &
                                reach_of(group, side), closest)
    end associate
  end subroutine search_at_start

  !> How far a die is searched for [length].
  pure function reach_of(group, side) result(reach)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: side   !! length of the side [length]
    real(wp) :: reach

    reach = max(group%heat_contact%reach, searched*side)
  end function reach_of

  !> Share of a side at which a point is closed in a scene of heat alone; rows GAP say themselves what a small gap does.
  elemental function touching_still(group) result(share)
    type(group_t), intent(in) :: group
    real(wp) :: share

    share = drawn
    if (allocated(group%heat_contact%by_gap)) share = touching
  end function touching_still

  !> Unknowns of the side and of the die at a point; none of a deformable die whose piece is no pair of the side.
  pure subroutine share_out(layout, n, rigid, xi, phi, facing, pieces, shares)
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: n   !! temperatures on a side: of its nodes, or of its ends
    logical, intent(in) :: rigid
    real(wp), intent(in) :: xi, phi(3)
    type(facing_t), intent(in) :: facing
    integer, intent(in) :: pieces(:)
    type(shares_t), intent(out) :: shares
    real(wp) :: dpsi(3)
    integer :: k, at

    shares%nside = n
    shares%place(:n) = layout%first(1, temperature) + [(k - 1, k=1, n)]
    shares%side(:n) = values_on_side(n, xi, phi)
    if (rigid) then
      shares%ndie = 1
      shares%place(n + 1) = layout%first(1, of_die)
      shares%die(1) = 1
      return
    end if
    if (facing%piece == 0) return
    at = findloc(pieces, facing%piece, 1)
    if (at == 0) return
    shares%ndie = n
    shares%place(n + 1:2*n) = layout%first(1, temperature) + n*at + [(k - 1, k=1, n)]
    call line3(facing%xi, shares%die, dpsi)
    shares%die(:n) = values_on_side(n, facing%xi, shares%die)
  end subroutine share_out

  !> Functions of the temperature on a side: of its nodes, or of its ends.
  pure function values_on_side(n, xi, phi) result(values)
    integer, intent(in) :: n
    real(wp), intent(in) :: xi, phi(3)
    real(wp) :: values(n)

    if (n == 3) values = phi(:n)
    if (n == 2) values = 0.5_wp*[1 - xi, 1 + xi]
  end function values_on_side

end module heat_contact_point
