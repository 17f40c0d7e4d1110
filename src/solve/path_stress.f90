!> Error of the stress at the end of a run that comes of the path within its steps, with what it owes to the error of the motion.
!>
!> Steps are judged by the root of the elastic energy at the motion of the run (path_error): that is what creep errs in. Where a
!> body flows plastically this root hardly errs, for the yield stress states it, but the directions of the stress do, and the
!> pressures that balance them. So with the last step of a run the difference to a better stress is estimated, in the norm of the
!> elastic energy:
!> - d, what the step adds: what two halves of it make of the stress, doubled as in path_error, and the motion that balances that;
!> - what follows from a start at the places to which the errors of the motion in all steps before add up (path_record);
!> - M e, what a step makes of an error e of the stress at its start: the laws answer the start with the error, and a motion
!>   balances what they answer. Steps that are equally long err alike, so e = d + M d + M M d + ..., a term for each step before;
!>   with the last one in the proportion of its length. (The error of a scheme is the sum of its local ones, each carried on by the
!>   scheme: E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 1993, II.3.)
!>
!> All of it is made with a thousandth of the errors, so that it is linear, and one solution with the matrix of the step balances
!> it. Whole errors of the motion are larger than strains of yield: points load and unload by them, and what the solution then
!> left out of balance grew from step to step (.7 was said where .02 was true).
!>
!> Where points of contact open, close, stick or slip the other way in the step velocities jump, as at the corner of a multiplier:
!> then d is not known, and left out. Hardening that differs is not in it; in an upset billet it is a twentieth.
module path_stress
  use contact_changes, only: contact_differs
  use corrections, only: solve_correction
  use dofs, only: move_fields
  use drivers, only: drivers_t
  use equations, only: equations_t
  use fields, only: displacement_field
  use kinds, only: wp
  use kinematics_api, only: first_history
  use path_record, only: stress_unknown
  use path_states, only: advance_beside, begin_beside, root_energy, unbalanced_forces
  use scene, only: plane_stress, scene_t
  use solution, only: group_state_t, solution_t
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: difference_of, stress_with_motion

  !> Steps whose errors are carried on at most: what is left of older ones is a few percent where a body flows.
  integer, parameter :: most_steps = 8
  !> The share of the errors by which they are carried on.
  real(wp), parameter :: small = 1.0e-3_wp
  !> An error that a step makes larger than this is none of the body: pressures that follow it and necks make a little of it.
  real(wp), parameter :: largest_growth = 1.25_wp
  !> A motion that should balance forces and makes so large a share of them the other way is none that the matrix can tell.
  real(wp), parameter :: too_far = 0.5_wp
  !> An error below this share of the stress is not judged by either: where a step errs in round-off alone, as in an elastic hold,
  !> the next term may well be larger, and is as nothing still.
  real(wp), parameter :: negligible = 1.0e-4_wp

contains

  !> Root of the elastic energy of the error of the stress; `stress_unknown` where one of the other states cannot be made, or errors
  !> grow.
  subroutine stress_with_motion(scene, equations, solution, active, dt, error, force, halves, outcome, root)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations    !! with factors of a matrix of the step
    type(solution_t), intent(in) :: solution         !! its trial state is that of the step
    logical, intent(in) :: active(:)                 !! (ngroup) bodies that flow
    real(wp), intent(in) :: dt                       !! [time]
    real(wp), intent(in) :: error(:)                 !! (ndof) of the motion of the step [unknown]
    real(wp), intent(in) :: force(:)                 !! (ndof) that it balances [residual]
    type(group_state_t), intent(in) :: halves(:)     !! (ngroup) states by two halves, as trial states
    type(outcome_t), intent(inout) :: outcome
    real(wp), intent(out) :: root                    !! [energy^0.5]
    type(group_state_t) :: local(size(halves)), found(size(halves))
    type(drivers_t), allocatable :: drivers(:)
    type(solution_t) :: other
    real(wp), dimension(size(error)) :: places, own, answer, balanced, residual, after
    real(wp) :: share, now, before, first
    integer :: term, nterm
    logical :: done

    root = stress_unknown
    local = difference_of(scene, active, halves, solution%groups, 2*small)
    own = small*error
    balanced = small*force
    if (contact_differs(scene, solution)) then
      local = difference_of(scene, active, halves, solution%groups, 0.0_wp)
      own = 0
      balanced = 0
    end if
    places = small*of_unknowns(equations, solution%path%error)
    allocate (drivers, source=equations%drivers)
    found = local
    nterm = min(most_steps, solution%path%course + 1)
    now = 0
    first = 0
    do term = 1, nterm
      share = merge(0.0_wp, 1.0_wp, term == 1)
      if (term == nterm) share = share*solution%last_step/dt
      call start()
      call advance_beside(scene, equations, active, drivers, outcome%du, dt, other, done)
      if (.not. done) return
      call unbalanced_forces(scene, equations, solution, outcome%du, residual)
      call solve_correction(equations, residual, answer, outcome%error, at_hand=.true.)
      if (allocated(outcome%error)) return
      call start()
      call advance_beside(scene, equations, active, drivers, outcome%du + own + answer, dt, other, done)
      if (.not. done) return
      ! contact, which is in the matrix alone, takes a part of the forces, and no more than all
      call unbalanced_forces(scene, equations, solution, outcome%du, after)
      found = difference_of(scene, active, other%groups, solution%groups, 1.0_wp)
      call add(local, found)
      before = share*now
      now = root_energy(scene, equations, active, other, found)
      if (term == 1) first = now
      if (.not. now > small*negligible*outcome%path%stress) cycle
      if (dot_product(after + balanced, answer) < -too_far*dot_product(residual, answer)) return
      if (now > largest_growth*before + first) return
    end do
    root = now/small

  contains

    !> The start of the step where errors of the motion put it, with this share of the error of the stress that was found.
    subroutine start()
      integer :: g

      call begin_beside(solution, other)
      call move_fields(equations%dofs, places, other%fields)
      do g = 1, size(active)
        if (active(g)) other%groups(g)%committed(:first_history - 1, :, :) &
          = other%groups(g)%committed(:first_history - 1, :, :) + share*found(g)%trial(:first_history - 1, :, :)
      end do
    end subroutine start

    !> Stress and elastic strain.
    subroutine add(part, whole)
      type(group_state_t), intent(in) :: part(:)       !! (ngroup)
      type(group_state_t), intent(inout) :: whole(:)   !! (ngroup)
      integer :: g

      do g = 1, size(active)
        if (active(g)) whole(g)%trial(:first_history - 1, :, :) = whole(g)%trial(:first_history - 1, :, :) &
                                                                  + part(g)%trial(:first_history - 1, :, :)
      end do
    end subroutine add

  end subroutine stress_with_motion

  !> So many times the stress and elastic strain of other states less those of the step, as trial states that can be measured.
  pure function difference_of(scene, active, others, step, factor) result(difference)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: active(:)                          !! (ngroup) bodies that flow
    type(group_state_t), intent(in) :: others(:), step(:)     !! (ngroup)
    real(wp), intent(in) :: factor
    type(group_state_t) :: difference(size(others))
    integer :: g, last

    do g = 1, size(active)
      if (.not. active(g)) cycle
      allocate (difference(g)%trial, source=others(g)%trial)
      associate (of => difference(g)%trial)
        of(:first_history - 1, :, :) = factor*(of(:first_history - 1, :, :) - step(g)%trial(:first_history - 1, :, :))
        ! in plane stress the last one is the stretch across the plane, by which volumes are measured
        last = size(of, 1)
        if (scene%plane_state == plane_stress .and. scene%finite) last = last - 1
        of(first_history:last, :, :) = 0
      end associate
    end do
  end function difference_of

  !> Displacements of nodes as a motion of the unknowns.
  pure function of_unknowns(equations, displacement) result(motion)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) [length]
    real(wp) :: motion(equations%dofs%ndof)
    integer :: k, c

    motion = 0
    associate (number => equations%dofs%fields(displacement_field)%number)
      do k = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, k) > 0) motion(number(c, k)) = displacement(c, k)
        end do
      end do
    end associate
  end function of_unknowns

end module path_stress
