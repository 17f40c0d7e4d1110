!> Contact made beside that of a step: from places that are others by errors, and what balances it.
!>
!> Errors of places come to be while a point is open or slides, and are carried on without contact (path_stress). Where they would
!> press points into a die, or take some off it, the part gives way: with F(e) the forces of contact at places with an error e,
!> F0 those of the step and K its matrix, with the stiffness L of contact as it stands in the step, a motion s a along
!>   K a = -(F(e) - F0)
!> is in balance where F(e + s a) - F0 = s (F(e) - F0 + L a) along a: for contact that stays as it is at s = 1, where points come
!> to bear, for which K knows no stiffness, far below that, as where only the drag of a body resists.
module contact_beside
  use corrections, only: solve_correction
  use dofs, only: move_fields
  use elem_api, only: block_done, instant_t, report_t
  use element_loop, only: add_prescribed, gather_forces, run_elements
  use equations, only: equations_t
  use fields, only: displacement_field
  use kinds, only: wp
  use loose_bodies, only: mark_acted_on
  use path_states, only: of_unknowns, on_nodes
  use resting_bodies, only: light
  use scene, only: scene_t
  use solution, only: solution_t
  use step_instants, only: make_instant
  use step_outcome, only: outcome_t
  use timers, only: ledger_t
  implicit none
  private
  public :: balance, contact_from, find_resting

  !> What is left of the forces along the motion, over what they were, that is little enough; most attempts, each of which takes the
  !> bounds of the share together by this much at least.
  real(wp), parameter :: little = 0.2_wp, least_cut = 0.1_wp
  integer, parameter :: most_attempts = 8, most_rounds = 3

contains

  !> Contact at the end of a step that begins at places which are others by so much, with drivers as they were found last. Element
  !> forces are those of contact then.
  subroutine contact_from(scene, equations, solution, dt, du, apart, other, done, force)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                    !! [time]
    real(wp), intent(in) :: du(:), apart(:)       !! (ndof) motion of the step, and how much others places are [unknown]
    type(solution_t), intent(inout) :: other      !! a copy of the solution, with trial states of these groups of contact
    logical, intent(out) :: done                  !! false where contact cannot be found
    real(wp), intent(out), optional :: force(:)   !! (ndof) of contact alone [residual]
    type(instant_t) :: instant
    type(report_t) :: report
    type(ledger_t) :: within
    real(wp) :: none(0, 0), magnitude(size(du))
    logical, dimension(size(scene%groups)) :: active, vary

    active = hosts_of_heat(scene, equations)
    other%fields = solution%fields
    call move_fields(equations%dofs, apart, other%fields)
    call make_instant(scene, equations, other, dt, du, .false., instant)
    instant%pairs = other%pairs
    equations%buffers%force = 0
    vary = equations%drivers%vary
    equations%drivers%vary = .false.
    call run_elements(scene, equations%elems, equations%kinematics, equations%laws, equations%dofs, active, &
                      equations%solves(equations%now)%pattern, instant, du, none, other, equations%drivers, equations%buffers, &
                      within, report)
    equations%drivers%vary = vary
    done = report%status == block_done
    if (.not. present(force)) return
    force = 0
    associate (solve => equations%solves(equations%now))
      call gather_forces(solve%pattern, equations%buffers, solve%is_own, force, magnitude)
    end associate
  end subroutine contact_from

  !> Contacts by which heat passes (ngroup).
  pure function hosts_of_heat(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes(size(scene%groups))
    integer :: g

    yes = .false.
    do g = 1, size(yes)
      if (equations%drivers(g)%is_of_heat_contact) yes(scene%groups(g)%host) = .true.
    end do
  end function hosts_of_heat

  !> Errors of places with the motion that balances what forces of contact they make, by the factors and matrices of the step.
  subroutine balance(scene, equations, solution, dt, force_of_step, outcome, apart, other, done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                  !! [time]
    real(wp), intent(in) :: force_of_step(:)    !! (ndof) that of contact_from without errors [residual]
    type(outcome_t), intent(inout) :: outcome
    real(wp), intent(inout) :: apart(:)         !! (ndof) [unknown]
    type(solution_t), intent(inout) :: other    !! as that of contact_from, at these places
    logical, intent(out) :: done                !! false where contact cannot be found, or the motion
    real(wp), dimension(size(apart)) :: force, left, change, answer
    real(wp) :: largest, before, share
    integer :: round

    largest = maxval(abs(apart))
    call contact_from(scene, equations, solution, dt, outcome%du, apart, other, done, force)
    left = force - force_of_step
    before = norm2(left)
    do round = 1, most_rounds
      if (.not. (done .and. norm2(left) > little*before)) exit
      call solve_correction(equations, -left, answer, outcome%error, at_hand=.true.)
      done = .not. allocated(outcome%error)
      if (.not. done) return
      answer = of_unknowns(equations, on_nodes(equations, answer))
      if (.not. dot_product(left, answer) < 0) exit
      ! what the body makes of the whole motion: all that is left but what contact, as it stands, makes of it
      change = 0
      call add_prescribed(equations%dofs, hosts_of_heat(scene, equations), equations%solves(equations%now)%pattern, &
                          equations%buffers, answer, change)
      change = -left - change
      call find_share(answer, force, left, change, share)
      if (.not. done) return
      apart = apart + share*answer
    end do
    ! contact takes back no more than errors have brought
    if (.not. (done .and. maxval(abs(apart)) > largest)) return
    apart = largest/maxval(abs(apart))*apart
    call contact_from(scene, equations, solution, dt, outcome%du, apart, other, done)

  contains

    !> The share of a motion along which no force is left.
    subroutine find_share(answer, force, left, change, share)
      real(wp), intent(in) :: answer(:)     !! (ndof) [unknown]
      real(wp), intent(inout) :: force(:)   !! (ndof) of contact before it and after [residual]
      real(wp), intent(inout) :: left(:)    !! (ndof) out of balance before it and after [residual]
      real(wp), intent(in) :: change(:)     !! (ndof) forces of the body by the whole motion [residual]
      real(wp), intent(out) :: share
      real(wp), dimension(size(answer)) :: rest
      real(wp) :: low, high, along, along_low, along_high, gain
      integer :: k

      gain = -dot_product(left, answer)
      rest = left - force
      low = 0
      high = 1
      along_low = -gain
      along_high = 0
      share = 1
      do k = 1, most_attempts
        call contact_from(scene, equations, solution, dt, outcome%du, apart + share*answer, other, done, force)
        if (.not. done) return
        left = rest + force + share*change
        along = dot_product(left, answer)
        if (abs(along) <= little*gain .or. (k == 1 .and. along < 0) .or. k == most_attempts) exit
        if (along > 0) then
          high = share
          along_high = along
        else
          low = share
          along_low = along
        end if
        share = low - along_low*(high - low)/(along_high - along_low)
        share = min(max(share, low + least_cut*(high - low)), high - least_cut*(high - low))
      end do
    end subroutine find_share

  end subroutine balance

  !> Bodies that nothing presses at either end of the step: only their drag resists.
  subroutine find_resting(scene, equations, solution, dt, other, resting)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                 !! [time]
    type(solution_t), intent(inout) :: other   !! a copy of the solution
    logical, intent(out) :: resting(0:)        !! (0:nnode) by the number of the body (find_loose_bodies)
    logical :: pressed(0:size(equations%loose))
    integer :: g, k, c

    resting = .false.
    if (.not. any(equations%drag > 0)) return
    do g = 1, size(other%groups)
      other%groups(g)%committed = solution%groups(g)%trial
    end do
    call mark_acted_on(scene, equations%laws, other, equations%loose, solution%time + dt, light, pressed)
    do g = 1, size(other%groups)
      other%groups(g)%committed = solution%groups(g)%committed
    end do
    associate (number => equations%dofs%fields(displacement_field)%number)
      do k = 1, size(equations%loose)
        associate (body => equations%loose(k))
          if (body == 0 .or. pressed(body)) cycle
          do c = 1, size(number, 1)
            if (number(c, k) > 0) resting(body) = resting(body) .or. equations%drag(number(c, k)) > 0
          end do
        end associate
      end do
    end associate
  end subroutine find_resting

end module contact_beside
