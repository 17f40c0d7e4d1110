!> Corrections past a limit point: by a matrix that is shifted until they lead downhill.
!>
!> A correction c of the motion leads uphill where c K c is negative: past a limit point, as where a strip slides off the node that
!> it was bent around, the matrix has a negative eigenvalue, and Newton's method goes to where equilibrium was unstable. Forces
!> drive the body the other way, to an equilibrium further on. So viscous forces are added to the matrix, not to the residual:
!>
!>     (K + s V) c = r
!>
!> with the volume V around each node: the pseudo-transient way to a steady state (C.T. Kelley, D.E. Keyes, SIAM J. Numer. Anal.
!> 35 (1998) 508-523). s begins so that the work on the correction is as much above zero as it was below (more, where other
!> directions still lead uphill: J.J. More, D.C. Sorensen, Math. Programming 16 (1979) 1-20, for directions of negative curvature).
!> It falls with the residual, and rises where that does or a correction goes too far. What is found at the end is an equilibrium:
!> none of it is viscous. Where contact makes c K c negative, that of the bodies alone being positive, or the matrix is not
!> symmetric, as where points stick and slip, there may be no limit. A whole correction is taken then if the residual falls by half
!> on it. By a symmetric matrix of bodies it would fall so too, towards a branch that they do not come to: a heated column bulges
!> against its own bend. Under loads that grow there is no equilibrium to be looked for: a limit point is a limit load
!> (goes_past_limits).
module pseudo_transient
  use contact_changes, only: contact_states_t, recall_contact, remember_contact
  use convergence, only: forces_of_others, free_force, slope_along
  use corrections, only: solve_correction
  use dofs, only: dofs_t, is_driven
  use elem_api, only: block_done, report_t
  use equations, only: equations_t
  use errors, only: error_t
  use evaluation, only: add_diagonal, evaluate
  use kinds, only: wp
  use linear_solver, only: negative_pivots
  use line_search, only: real_fall
  use loads, only: multiplier_at
  use pairs, only: pairs_differ, pairs_t
  use scene, only: role_contact, role_side_load, role_volume_load, scene_t
  use sections, only: section_forced
  use solution, only: solution_t
  use stability, only: has_friction, work_of_bodies
  use volumes_of_unknowns, only: volumes_of_motion
  implicit none
  private
  public :: ease_shift, goes_past_limits, shift_t, solve_shifted, turn_downhill

  !> State of the iterations of a step.
  type :: shift_t
    !> s now, 0 where the matrix is as it is, and the largest so far [force/length^4, per radian when axisymmetric].
    real(wp) :: value = 0.0_wp, largest = 0.0_wp
    !> Volume around every unknown of the motion, where a shift has been needed (ndof) [volume].
    real(wp), allocatable :: volume(:)
    !> The last correction leads uphill, and does so by the symmetric matrix of bodies alone; the shifted matrix that it was found
    !> by (nnz) [residual/unknown].
    logical :: uphill = .false., of_bodies = .false.
    real(wp), allocatable :: matrix(:)
  end type shift_t

  !> A shift that is not enough becomes this many times larger, so often at most.
  real(wp), parameter :: larger = 4.0_wp
  integer, parameter :: most_shifts = 8
  !> It rises where the residual does, or where less than a share of the correction is taken; where more than another is, it falls
  !> with the residual, to `least_fall` at least, and ends where that falls to `fall`.
  real(wp), parameter :: rise = 4.0_wp, least_taken = 0.2_wp, most_taken = 0.5_wp, least_fall = 0.5_wp, fall = 0.1_wp
  !> Below this share of the largest one there is none.
  real(wp), parameter :: least_share = 1.0e-3_wp

contains

  !> Correction of the free unknowns of the present solve for a residual, by the matrix with the shift of now; whether it leads
  !> uphill.
  subroutine solve_shifted(scene, equations, residual, shift, correction, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: residual(:)      !! (ndof) [residual]
    type(shift_t), intent(inout) :: shift
    real(wp), intent(out) :: correction(:)   !! (ndof) [unknown]
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: work

    associate (solve => equations%solves(equations%now))
      if (shift%value > 0) call add_diagonal(solve%pattern, solve%equation, shift%value*shift%volume, solve%values)
      call solve_correction(equations, residual, correction, error)
      if (allocated(error)) return
      shift%uphill = work_of(equations, correction, residual) < 0 &
                     .or. equations%downhill .and. negative_pivots(solve%solver) > 0
      ! what is evaluated next has another matrix
      if (.not. shift%uphill) return
      shift%matrix = solve%values
      shift%of_bodies = .false.
      if (has_friction(scene, equations)) return
      work = work_of_bodies(scene, equations, correction)
      if (shift%value > 0) work = work + shift%value*sum(shift%volume*correction**2)
      shift%of_bodies = work < 0
    end associate
  end subroutine solve_shifted

  !> After a correction that leads uphill: where no bodies alone make it so and the residual falls by half on it, it is taken, and
  !> the motion moved by it; else it becomes one that leads downhill, by a larger shift.
  subroutine turn_downhill(scene, equations, solution, dt, external, residual, shift, correction, du, taken, report, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt                         !! [time]
    real(wp), intent(in) :: external(:), residual(:)   !! (ndof) [residual]
    type(shift_t), intent(inout) :: shift
    real(wp), intent(inout) :: correction(:)           !! (ndof) [unknown]
    real(wp), intent(inout) :: du(:)                   !! (ndof) motion of the step [unknown]
    logical, intent(out) :: taken
    type(report_t), intent(inout) :: report
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: start(size(du))
    type(contact_states_t) :: before
    type(report_t) :: trial
    type(pairs_t), allocatable :: pairs(:)
    integer :: k

    allocate (pairs, source=solution%pairs)
    taken = .false.
    if (.not. (shift%of_bodies .or. equations%downhill)) then
      start = du
      call remember_contact(scene, solution, before)
      du = start + correction
      call evaluate(scene, equations, solution, dt, du, .true., trial, corrected_from=start)
      taken = trial%status == block_done
      if (taken) taken = free_force(equations, external - equations%force) < real_fall*free_force(equations, residual)
      if (taken) then
        report = trial
        return
      end if
      du = start
      call recall_contact(scene, before, solution)
    end if
    if (.not. allocated(shift%volume)) allocate (shift%volume, source=volumes_of_motion(scene, equations, solution))
    associate (solve => equations%solves(equations%now))
      if (pairs_differ(scene, pairs, solution%pairs)) then
        ! sides of bodies that met others on the way have a matrix of other places
        call evaluate(scene, equations, solution, dt, du, .true., trial)
        call add_diagonal(solve%pattern, solve%equation, shift%value*shift%volume, solve%values)
        shift%matrix = solve%values
      else
        solve%values = shift%matrix
      end if
      do k = 1, most_shifts
        associate (more => max((larger - 1)*shift%value, &
                               2*abs(work_of(equations, correction, residual))/sum(shift%volume*correction**2)))
          call add_diagonal(solve%pattern, solve%equation, more*shift%volume, solve%values)
          shift%value = shift%value + more
        end associate
        call solve_correction(equations, residual, correction, error)
        if (allocated(error)) exit
        if (work_of(equations, correction, residual) < 0) cycle
        if (.not. (equations%downhill .and. negative_pivots(solve%solver) > 0)) exit
      end do
    end associate
    shift%largest = max(shift%largest, shift%value)
  end subroutine turn_downhill

  !> Work that the residual does on a correction found by the matrix at hand, below 0 uphill.
  pure function work_of(equations, correction, residual) result(work)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:)   !! (ndof) [unknown]
    real(wp), intent(in) :: residual(:)     !! (ndof) [residual]
    real(wp) :: work

    work = slope_along(equations, correction, residual - forces_of_others(equations, correction))
  end function work_of

  !> Past a limit point equilibrium is looked for further on: where a die or a support moves, or no load grows. Under loads that
  !> grow, and nothing else that drives the part, the point is a limit load, and the run ends there. Loads that rest are borne at
  !> the start of the step: heat, phases or creep drive the part then, and where they press it on rough dies the matrix, which is
  !> not symmetric, may lead uphill without any limit.
  pure function goes_past_limits(scene, dofs, solution, dt, motion) result(yes)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt           !! [time]
    real(wp), intent(in) :: motion(:)    !! (nprescribed) of the step [unknown]
    logical :: yes
    integer :: g, k

    yes = is_driven(dofs, motion)
    if (yes) return
    yes = .true.
    do k = 1, size(scene%forces)
      yes = yes .and. rests(scene%forces(k)%multiplier)
    end do
    do k = 1, size(scene%die_forces)
      yes = yes .and. rests(scene%die_forces(k)%multiplier)
    end do
    do k = 1, size(scene%section_drives)
      if (scene%section_drives(k)%kind == section_forced) yes = yes .and. rests(scene%section_drives(k)%multiplier)
    end do
    do g = 1, size(scene%groups)
      if (any(scene%groups(g)%role == [role_side_load, role_volume_load])) yes = yes .and. rests(scene%groups(g)%multiplier)
    end do

  contains

    !> A multiplier does not grow in the step; 0 is none, as of exchanges of heat, and one may be found (LOADF).
    pure logical function rests(multiplier)
      integer, intent(in) :: multiplier
      real(wp) :: before

      rests = multiplier == 0 .or. multiplier == scene%load_factor%multiplier
      if (rests) return
      before = 0
      ! what is there at the start of a run acts in its first step
      if (solution%last_step > 0) before = abs(multiplier_at(scene%multipliers(multiplier), solution%time))
      rests = .not. abs(multiplier_at(scene%multipliers(multiplier), solution%time + dt)) > before
    end function rests
  end function goes_past_limits

  !> The shift of the next iteration, after one that took a share of its correction.
  elemental subroutine ease_shift(share, before, now, downhill, shift)
    real(wp), intent(in) :: share         !! [-]
    real(wp), intent(in) :: before, now   !! norm of the residual [-]
    logical, intent(in) :: downhill       !! the search kept to the way downhill, on which the residual may grow
    type(shift_t), intent(inout) :: shift

    if (.not. shift%value > 0) return
    if (now > before .and. .not. downhill .or. share < least_taken) then
      shift%value = rise*shift%value
    else if (share > most_taken) then
      shift%value = min(least_fall*before, now)/before*shift%value
      if (now < fall*before) shift%value = 0
    end if
    if (shift%value < least_share*shift%largest) shift%value = 0
  end subroutine ease_shift

end module pseudo_transient
