!> Contact of a side with a rigid die between its points (CNT2D ... ALONG).
!>
!> A side is a parabola. Where the die bends within it, or it folds onto a flat one, it is deeper in the die between its points than
!> at them, and no pressure at the points mends that. So the depth d is looked at all along the side, and what is deeper than d0
!> presses too, per length of the side by
!>
!>     p(xi) = AKB (d(xi) - d0),   AKB = stiffer AKP,   d0 = max(share a, depths at the side's points and corners in contact)
!>
!> with the penetration a that is allowed: where a side lies on its die all along, its points alone carry, and beside a corner of
!> the die the corner. A bend touches a side on a short way that moves along it as the part slides. The integral over that way, by
!> the midpoint rule, changes without jumps where a pressure at fixed points would go from one to the next; it grows with
!> (d - d0)**1.5, as the force of two bodies that touch with unlike curvatures does (K.L. Johnson, Contact Mechanics, Cambridge
!> 1985, chapter 4), and d stays within twice the allowed for forces of the order of the yield stress times the side.
!>
!> On the side at the axis steep dies are left to the force on its node (axis_contact): pushed along the flank of a cone it would
!> go ahead of the die's point.
!>
!> Friction there begins anew with every step, since what touches is another place of the side: a place that slides has the friction
!> of its law; one that sticks has that of the slip of the step, whose elastic part is dissipated. Pressures, energies and work
!> of friction between points are in the state of the points, as what makes the same force and the same work on their areas.
module contact_between
  use closest_point, only: closest_point_t
  use contact_areas, only: area_of_point
  use contact_penalties, only: allowed_penetration
  use contact_scan, only: closest_to_side_point
  use contact_state, only: at_between, at_energy, at_penetration, at_pressure, at_status, at_tau, at_work, contact_block
  use corner_contact, only: end_on_axis
  use dies, only: die_t
  use elem_api, only: report_t
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use quadrature, only: rule_t
  use rigid_contact, only: motion_of_depth, ndof, nodes_in_axes, place_point, press, side_t
  use side_points, only: area_at, contact_point_t, no_surface, touching
  use start_depths, only: find_depth_at_start
  implicit none
  private
  public :: press_between

  !> Places on a side that are looked at: their distance is a thirtieth of the side; the way on which a bend with a radius of the
  !> side's length touches it, when it is deeper than d0 by a, is a twelfth: sqrt(8 a r) with a of a thousandth.
  integer, parameter :: nplace = 33
  !> Of the allowed penetration, without pressure.
  real(wp), parameter :: share = 0.9_wp
  !> Penalty over that of the points, which takes a pressure of a hundredth of the modulus to make a (contact_point).
  real(wp), parameter :: stiffer = 20.0_wp
  !> On the side at the axis, dies whose normal is nearer to the radius than 45 degrees are left out.
  real(wp), parameter :: steep = sqrt(0.5_wp)

contains

  !> Forces and matrix of what is deeper than allowed on a side, whose points and corners are known; pressures and work of friction
  !> are added to those of its points.
  pure subroutine press_between(die, law, material, drivers, axisym, side, rule, xi, weight, committed, trial, force, stiffness, &
                                report)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :, :)   !! (ndriver, 2, npoint) of the law [unit of each driver]
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    type(rule_t), intent(in) :: rule
    real(wp), intent(in) :: xi(:), weight(:)           !! (npoint) of the rule [-]
    real(wp), intent(in) :: committed(:, :)            !! (nstate, npoint) with those of corners [unit of each component]
    real(wp), intent(inout) :: trial(:, :)             !! (nstate, npoint) with those of corners [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(report_t), intent(inout) :: report
    type(side_t) :: between
    type(contact_point_t) :: point
    type(closest_point_t) :: closest
    real(wp), dimension(contact_block(.true., size(trial, 1))) :: before, now
    real(wp) :: nodes(2, 3), free, dfree(ndof), place, hats(size(xi)), drive(size(drivers, 1), 2), taken
    logical :: touched, at_axis
    integer :: k, p

    free = share*allowed_penetration(material)*side%length
    if (.not. free > 0) return
    touched = any(nint(committed([at_status, size(now) + at_status], :)) /= contact_open) .or. any(committed(at_between, :) > 0)
    at_axis = .false.
    if (axisym) at_axis = end_on_axis(side) > 0
    between = side
    between%kept = .false.
    between%penalty = stiffer*side%penalty
    nodes = nodes_in_axes(side)
    dfree = 0
    do p = 1, merge(size(xi), 0, at_axis)
      call closest_to_side_point(die, nodes, xi(p), side%length, closest)
      if (closest%piece > 0 .and. abs(closest%normal(1)) > steep) return
    end do
    do p = 1, size(xi)
      if (nint(trial(at_status, p)) /= contact_open) call keep_free(die, nodes, side, xi(p), free, dfree)
      if (nint(trial(size(now) + at_status, p)) /= contact_open) &
        call keep_free(die, nodes, side, trial(size(trial, 1), p), free, dfree)
    end do
    do k = 1, nplace
      place = -1 + (2*k - 1)/real(nplace, wp)
      call closest_to_side_point(die, nodes, place, side%length, closest)
      if (closest%piece == 0 .or. .not. closest%d - free > touching*side%length) cycle
      call place_point(between, place, point)
      if (axisym .and. point%x(1) <= no_surface*side%length) cycle
      hats = hats_at(xi, place)
      do p = 1, size(drive, 1)
        drive(p, :) = matmul(drivers(p, :, :), hats)
      end do
      before = 0
      before(at_penetration) = find_depth_at_start(die, side, place)
      report%between = .true.
      report%jump = max(report%jump, abs(closest%d - max(free, before(at_penetration)))/side%length)
      ! what was in contact at another place slides all the way
      if (touched) before(at_penetration) = free
      now = 0
      call press(law, material, drive, between, place, point, closest, free, 2.0_wp/nplace, before, now, force, stiffness, &
                 dallowed=dfree)
      if (nint(now(at_status)) == contact_open) cycle
      taken = now(at_work) + 0.5_wp*now(at_tau)**2/between%penalty(2)
      call share_out(side, rule, xi, weight, place, now(at_pressure), 0.5_wp*now(at_pressure)*(closest%d - free), taken, trial)
    end do
  end subroutine press_between

  !> What is no deeper than a place in contact needs no pressure.
  pure subroutine keep_free(die, nodes, side, place, free, dfree)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: nodes(2, 3)         !! of the side, in the pilot's axes [length]
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place               !! [-]
    real(wp), intent(inout) :: free             !! [length]
    real(wp), intent(inout) :: dfree(ndof)      !! [length/unknown]
    type(contact_point_t) :: point
    type(closest_point_t) :: closest

    call closest_to_side_point(die, nodes, place, side%length, closest)
    if (closest%piece == 0 .or. .not. closest%d > free) return
    free = closest%d
    call place_point(side, place, point)
    dfree = motion_of_depth(side, point, closest)
  end subroutine keep_free

  !> Pressure, energy of the penalty and work of friction of a place to the points beside it: to those in contact,
  !> where the side has any.
  pure subroutine share_out(side, rule, xi, weight, place, pressure, energy, work, state)
    type(side_t), intent(in) :: side
    type(rule_t), intent(in) :: rule
    real(wp), intent(in) :: xi(:), weight(:)   !! (npoint) of the rule [-]
    real(wp), intent(in) :: place              !! [-]
    real(wp), intent(in) :: pressure           !! [stress]
    real(wp), intent(in) :: energy, work       !! per area [stress*length]
    real(wp), intent(inout) :: state(:, :)     !! (nstate, npoint) [unit of each component]
    real(wp) :: y(2, 3), area(size(xi)), shares(size(xi)), part
    logical :: closed(size(xi))
    integer :: p

    y(1, :) = side%x(1, :) + side%du(1:3)
    y(2, :) = side%x(2, :) + side%du(4:6)
    do p = 1, size(xi)
      area(p) = area_of_point(rule, xi, weight, p, side%section, y)
    end do
    closed = nint(state(at_status, :)) /= contact_open .and. area > 0
    shares = merge(hats_at(xi, place), 0.0_wp, closed)
    if (.not. sum(shares) > 0) shares = merge(1.0_wp, 0.0_wp, closed)
    if (.not. sum(shares) > 0) shares = merge(hats_at(xi, place), 0.0_wp, area > 0)
    if (.not. sum(shares) > 0) return
    shares = shares/sum(shares)*2/nplace*area_at(place, side%section, y)
    do p = 1, size(xi)
      if (.not. shares(p) > 0) cycle
      part = shares(p)/area(p)
      state([at_pressure, at_between], p) = state([at_pressure, at_between], p) + pressure*part
      state(at_energy, p) = state(at_energy, p) + energy*part
      state(at_work, p) = state(at_work, p) + work*part
    end do
  end subroutine share_out

  !> Shares of the points beside a place, linear between two of them; beyond the first and the last it is theirs.
  pure function hats_at(xi, place) result(hats)
    real(wp), intent(in) :: xi(:)   !! (npoint) ascending [-]
    real(wp), intent(in) :: place   !! [-]
    real(wp) :: hats(size(xi))
    integer :: p

    hats = 0
    p = count(xi <= place)
    if (p == 0 .or. p == size(xi)) then
      hats(max(p, 1)) = 1
      return
    end if
    hats(p + 1) = (place - xi(p))/(xi(p + 1) - xi(p))
    hats(p) = 1 - hats(p + 1)
  end function hats_at

end module contact_between
