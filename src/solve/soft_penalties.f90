!> Softer penalties where contact bears little, stiffer ones where it bears much.
!>
!> A penalty that follows from an allowed penetration makes that depth under a hundredth of Young's modulus, as forming dies have
!> it. A sheet bent over rollers presses with a ten-thousandth of that: its penalties are far stiffer than the allowed depth asks
!> for, and a node that closes or slides by a round-off of the depth changes the forces by more than the sheet bears. Newton's
!> method then finds no set of points in contact, whatever the length of the step. Penalties need be no larger than what holds
!> the depth (D.P. Bertsekas, Constrained Optimization and Lagrange Multiplier Methods, Academic Press 1982, ch. 2; P. Wriggers,
!> Computational Contact Mechanics, 2nd ed., Springer 2006). So where a step fails while contact changes, penalties are lowered to
!> a share with which the pressures of now make a tenth of the allowed depth. They are raised, before a step is accepted, where the
!> depth is more than a third of the allowed, or more than a small part of the way that the part has made: at its first touch
!> little depth is much of the force.
!>
!> An elastic body bears more than that hundredth: rubber that is shut in, many times its modulus. Before a step is accepted in
!> which it is deeper than three times what is allowed, its penalties are raised to what makes that once, up to a pressure of a
!> hundred times the modulus (contact_stiffness): of the depth that multipliers (AUGMENT) have left. Were it left to them alone each
!> augmentation would move the body by many times what is allowed. A penalty that the deck states is not touched.
module soft_penalties
  use contact_penalties, only: penalties_of_card, penalties_t
  use contact_point, only: usual_bearing
  use contact_state, only: at_augmentation, at_penetration, at_pressure, at_status, contact_block
  use dofs, only: dofs_t
  use fields, only: displacement_field
  use iteration_history, only: iteration_t
  use kinds, only: wp
  use law_api, only: contact_open
  use scene, only: role_contact, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: press_too_softly, raise_penalties, soften_penalties

  !> Depth over the allowed that a share is chosen for, and the one above which it is raised.
  real(wp), parameter :: aim = 0.1_wp, limit = 0.3_wp
  !> The same for shares that are more than the whole: on unlike meshes pressures are the less even the stiffer contact is.
  real(wp), parameter :: aim_above = 1.0_wp, limit_above = 3.0_wp
  !> Depth over the largest displacement of the bodies that is aimed at, and above which the share is raised.
  real(wp), parameter :: aim_of_way = 5.0e-4_wp, limit_of_way = 1.0e-3_wp
  !> The least share; the penalties of a share are lowered where they become so much less.
  real(wp), parameter :: least_share = 1.0e-4_wp, worth = 0.3_wp
  !> Contact goes on changing where it did so in one of so many last iterations.
  integer, parameter :: last_iterations = 5

contains

  !> A step has failed: lower the penalties where contact bears little and went on changing.
  pure subroutine soften_penalties(scene, history, solution, softer)
    type(scene_t), intent(in) :: scene
    type(iteration_t), intent(in) :: history(:)   !! (niteration) of the step
    type(solution_t), intent(inout) :: solution
    logical, intent(out) :: softer
    real(wp) :: share
    integer :: n

    softer = .false.
    n = size(history)
    if (.not. has_allowed(scene)) return
    if (.not. any(history(max(1, n - last_iterations + 1):)%contact_changed)) return
    share = max(least_share, bearing(scene, solution, .false.)/aim)
    softer = share < worth*solution%penalty_share
    if (softer) solution%penalty_share = share
  end subroutine soften_penalties

  !> The motion of a step is deeper in dies than a share of the penalties should let it be.
  pure logical function press_too_softly(scene, dofs, solution, du)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]

    press_too_softly = .false.
    if (solution%penalty_share < 1) then
      press_too_softly = bearing(scene, solution, .true.) > limit*solution%penalty_share &
                         .or. depth(scene, solution) > limit_of_way*way(dofs, solution, du)
    else if (most_share(scene) > solution%penalty_share) then
      press_too_softly = bearing(scene, solution, .true., above=solution%penalty_share) > limit_above*solution%penalty_share
    end if
  end function press_too_softly

  !> The share that depth and pressures of the trial state ask for.
  pure subroutine raise_penalties(scene, dofs, du, solution)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    type(solution_t), intent(inout) :: solution
    real(wp) :: share, made

    share = solution%penalty_share
    if (.not. share < 1) then
      solution%penalty_share = min(most_share(scene), bearing(scene, solution, .true., above=share)/aim_above)
      return
    end if
    made = way(dofs, solution, du)
    if (made > 0) share = share*max(1.0_wp, depth(scene, solution)/(aim_of_way*made))
    solution%penalty_share = min(1.0_wp, max(share, bearing(scene, solution, .true.)/aim))
  end subroutine raise_penalties

  !> A law of contact has penalties that follow from an allowed penetration.
  pure logical function has_allowed(scene)
    type(scene_t), intent(in) :: scene
    integer :: g

    has_allowed = any([(follows(scene, g), g=1, size(scene%groups))])
  end function has_allowed

  !> A group is one of contact whose penalties follow from an allowed penetration.
  pure logical function follows(scene, g)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(penalties_t) :: given

    follows = scene%groups(g)%role == role_contact
    if (.not. follows) return
    given = penalties_of_card(scene%materials(scene%groups(g)%material))
    follows = .not. given%normal > 0
  end function follows

  !> Largest share that a group may be raised to.
  pure function most_share(scene) result(most)
    type(scene_t), intent(in) :: scene
    real(wp) :: most
    integer :: g

    most = 1
    do g = 1, size(scene%groups)
      if (may_rise(scene, g, 1.0_wp)) most = max(most, scene%groups(g)%most_share)
    end do
  end function most_share

  !> The penalties of a group may be raised above a share of one or more.
  pure logical function may_rise(scene, g, share)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: share

    may_rise = follows(scene, g)
    if (may_rise) may_rise = scene%groups(g)%most_share > share
  end function may_rise

  !> Largest pressure of such contact, or tension of glue, over that which makes the allowed penetration with the whole penalties;
  !> with `above` without what multipliers take of it.
  pure function bearing(scene, solution, trial, above) result(largest)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: trial             !! of the trial state, otherwise of the committed one
    real(wp), intent(in), optional :: above  !! where penalties may be raised above this share alone
    real(wp) :: largest
    integer :: g

    largest = 0
    do g = 1, size(scene%groups)
      if (.not. follows(scene, g)) cycle
      if (present(above)) then
        if (.not. may_rise(scene, g, above)) cycle
      end if
      if (trial) then
        call find_largest(solution%groups(g)%trial)
      else
        call find_largest(solution%groups(g)%committed)
      end if
    end do

  contains

    pure subroutine find_largest(state)
      real(wp), intent(in) :: state(:, :, :)
      real(wp) :: pressure
      logical :: corners

      if (size(state) == 0) return
      corners = find_variable(scene%groups(g)%variables, 'corner_place') > 0
      pressure = of_points(state, 0)
      if (corners) pressure = max(pressure, of_points(state, contact_block(corners, size(state, 1))))
      largest = max(largest, pressure/(usual_bearing*scene%groups(g)%modulus))
    end subroutine find_largest

    !> Largest pressure of points, or of corners beside them.
    pure function of_points(state, n) result(pressure)
      real(wp), intent(in) :: state(:, :, :)
      integer, intent(in) :: n   !! components of the state before those of the points
      real(wp) :: pressure

      if (present(above)) then
        pressure = maxval(abs(state(n + at_pressure, :, :) - state(n + at_augmentation, :, :)), &
                          mask=nint(state(n + at_status, :, :)) /= contact_open)
        pressure = max(pressure, 0.0_wp)
      else
        pressure = maxval(abs(state(n + at_pressure, :, :)))
      end if
    end function of_points

  end function bearing

  !> Largest depth of points in such contact in the trial state, or gap of glue [length].
  pure function depth(scene, solution) result(largest)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: largest
    integer :: g

    largest = 0
    do g = 1, size(scene%groups)
      if (.not. follows(scene, g)) cycle
      associate (state => solution%groups(g)%trial)
        if (size(state) == 0) cycle
        largest = max(largest, maxval(abs(state(at_penetration, :, :)), mask=nint(state(at_status, :, :)) /= contact_open))
      end associate
    end do
  end function depth

  !> Largest displacement of a node at the end of the step [length].
  pure function way(dofs, solution, du) result(largest)
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    real(wp) :: largest
    integer :: k, c

    largest = 0
    associate (u => solution%fields(displacement_field)%value, number => dofs%fields(displacement_field)%number)
      do k = 1, size(number, 2)
        do c = 1, 2
          if (number(c, k) > 0) largest = max(largest, abs(u(c, k) + du(number(c, k))))
        end do
      end do
    end associate
  end function way

end module soft_penalties
