!> Where Newton's method starts: the motion of the last step, in proportion.
!>
!> It goes straight on, while points that slide on a die follow its bends: after a slip s on a fillet of radius r they are
!> s^2/2r off it, open or far too deep. Where that changes a penetration much, or loses many points of a light contact, as that of a
!> sheet under its holder, the first correction is found with the points that were in contact kept there, their law linearised at
!> the depth they had (`kept` of instant_t): it brings them back to the die, and the body behind them with them, while slip and flow
!> go on as they were. Where no support and no die is driven there is no motion that goes on: only the onset of it is kept, and the
!> matrix there (with the contacts of now) spreads the rest.
!>
!> A side that is held between its points (contact_between) meets a bend of a die at another place in every step, and where it
!> slides by a tenth of its length it goes off its straight path by more than the depth allowed. There the start follows the bend of
!> the path of the last two steps (path_bend), where that changes penetrations less than going straight on.
!>
!> On a new mesh the last motion is none of its own: the first step starts at the motion of its onset (onset_motion), but where it
!> shows that contact begins, to which the step is shortened first, and where temperatures are solved for too, which have their own
!> last change.
!>
!> Where a die, or the support of a body that nothing touches, turns back the step starts, for the bodies that it moves
!> (turning_back), a little way back along that motion: the matrix there is that of unloading.
!>
!> The first iteration takes contacts as they are: a die that withdraws would pull the part along, by more than it can bear. Where
!> most points that touched such a die no longer do after it, the step starts again so, with the die where it goes: contact is then
!> open, and the part springs back from its own forces.
!>
!> A body that nothing holds starts at rest (resting_bodies), as does a free die that nothing acts on (resting_dies); one that a
!> force pushes over a gap starts in touch with what it meets (seating). What prescribed unknowns still miss is left for the first
!> iteration to spread.
module predictor
  use acceptance, only: is_first_step
  use dofs, only: is_driven
  use elem_api, only: block_done, report_t
  use equations, only: equations_t, solves_heat
  use errors, only: error_t
  use evaluation, only: evaluate, is_apart
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use known_motion, only: find_known_motion, find_missing_motion, known_motion_t, proportion
  use onset_motion, only: extend_onset
  use path_bend, only: bend_of_path
  use resting_bodies, only: leave_at_rest
  use resting_dies, only: leave_dies_at_rest
  use scene, only: scene_t
  use seating, only: seat_dies
  use solution, only: solution_t
  implicit none
  private
  public :: predict, lagging_dies, leaving_dies, work_of_dies

  !> Change of penetration, as a share of the side, below which contact goes on as before.
  real(wp), parameter :: smooth_contact = 2.0e-3_wp
  !> So does contact that no more than this share of its points lose. A light one, as that of a sheet under its holder, is lost by
  !> much less; as dies withdraw it is lost in any case.
  real(wp), parameter :: few_lost = 0.2_wp
  !> Share of the last motion that shows which points load; backwards, which unload.
  real(wp), parameter :: onset = 0.02_wp

contains

  !> Start `du` and what prescribed unknowns miss of their motion; forces and matrices are evaluated there. With `kept` they
  !> are not those of the motion: contact is as it was.
  subroutine predict(scene, equations, solution, dt, external, given, go_on, du, missing, kept, staying, report, error, left)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    real(wp), intent(in) :: external(:)          !! (ndof) forces at the end of the step [residual]
    real(wp), intent(in), optional :: given(:)   !! (ndof) motion of the unknowns of other solves [unknown]
    logical, intent(in), optional :: go_on       !! start from `given` for the own unknowns too
    real(wp), intent(out) :: du(:), missing(:)   !! (ndof) [unknown]
    logical, intent(out) :: kept
    logical, intent(out) :: staying(:)           !! (ndof) motion of bodies and dies that do not turn back, where others do
    type(report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: left(:)     !! (ndie) dies that leave the part: they start where they go
    type(known_motion_t) :: known
    !> The start is at the onset of the motion of a new mesh.
    logical :: begun
    real(wp) :: bend(size(du))   !! of the path [unknown]

    equations%slides = .false.
    equations%seated = 0
    call find_known_motion(scene, equations, solution, dt, go_on, left, known)
    if (.not. known%goes_on) equations%way_to_part = 0
    staying = known%staying
    kept = .false.
    bend = 0
    call try_from(known%ratio)
    begun = .false.
    if (is_first_on_mesh()) call start_on_new_mesh()
    if (allocated(error)) return
    if (.not. (begun .or. known%goes_on) .and. report%status == block_done .and. report%event >= 1 &
        .and. contact_changes()) then
      kept = is_driven(equations%dofs, known%motion)
      call start_from(merge(known%ratio, onset*known%ratio, kept))
    end if
    if (report%status /= block_done .and. abs(known%ratio) > 0) then
      kept = .false.
      call start_from(0.0_wp)
    end if
    call find_missing_motion(equations, known, du, missing)

  contains

    !> The first step on a new mesh, where mechanics alone is solved for and contact does not begin within the step.
    function is_first_on_mesh() result(is)
      logical :: is

      is = is_first_step(solution%probation) .and. .not. (any(known%back) .or. known%goes_on) .and. known%ratio > 0 &
           .and. report%event >= 1 .and. .not. solves_heat(scene, equations) &
           .and. equations%solves(equations%now)%own(displacement_field)
    end function is_first_on_mesh

    !> Contact does not go on as before, though no driven die withdraws.
    function contact_changes() result(changes)
      logical :: changes
      real(wp) :: driven(size(du))

      changes = report%jump > smooth_contact
      if (changes .or. .not. report%lost > few_lost*report%bearing) return
      driven = 0
      driven(equations%dofs%prescribed%dof) = du(equations%dofs%prescribed%dof)
      changes = .not. any(work_of_dies(equations, driven) < 0)
    end function contact_changes

    !> Start from a share of the last motion. Where contact alone tells that it is not to be begun with, for another evaluation
    !> follows, or the step is cut short where contact begins, nothing else is evaluated.
    subroutine try_from(share)
      real(wp), intent(in) :: share

      if (.not. (present(given) .or. known%goes_on .or. any(known%back) .or. is_first_step(solution%probation)) &
          .and. abs(share) > 0 .and. dt > scene%strategy%least_step .and. is_apart(scene, equations)) then
        if (is_driven(equations%dofs, known%motion)) then
          call start_from(share, alone=.true.)
          if (report%status == block_done .and. report%between) call try_bend(share)
          if (report%status == block_done .and. (report%event < 1 .or. contact_changes())) return
        end if
      end if
      call start_from(share)
    end subroutine try_from

    !> Follow the bend of the path where contact alone tells that penetrations change less than on the straight one.
    subroutine try_bend(share)
      real(wp), intent(in) :: share
      type(report_t) :: straight

      straight = report
      bend = bend_of_path(equations%dofs, solution, dt)
      if (.not. any(abs(bend) > 0)) return
      call start_from(share, alone=.true.)
      if (report%status == block_done .and. report%jump < straight%jump) return
      bend = 0
      report = straight
    end subroutine try_bend

    !> Start at the motion of the onset, with contact kept; where there is none, as on any mesh.
    subroutine start_on_new_mesh()
      if (.not. is_driven(equations%dofs, known%motion)) return
      kept = .true.
      call start_from(onset*known%ratio)
      if (report%status == block_done) then
        call find_missing_motion(equations, known, du, missing)
        call extend_onset(equations, external, missing, du, begun, error)
        if (allocated(error)) return
        if (begun) call evaluate(scene, equations, solution, dt, du, .true., report, predicted=.true., kept=.true.)
        begun = begun .and. report%status == block_done
        ! what the new mesh moves at once, however short the step, is no way to a contact
        if (begun) report%event = 1
      end if
      if (begun) return
      kept = .false.
      call start_from(known%ratio)
    end subroutine start_on_new_mesh

    !> Evaluate at the last motion times a share, with the bend of the path where it is the whole of it; what is given is taken as
    !> it is.
    subroutine start_from(share, alone)
      real(wp), intent(in) :: share
      logical, intent(in), optional :: alone   !! contact alone, without matrices
      logical :: whole
      integer :: k

      call proportion(equations%dofs, solution%fields, share, du)
      if (.not. abs(share - known%ratio) > 0) du = du + bend
      where (known%back) du = -onset*du
      call leave_at_rest(scene, equations, solution, solution%time + dt, du)
      call leave_dies_at_rest(scene, equations%dofs, solution, external, du)
      if (.not. known%goes_on) &
        call seat_dies(scene, equations%dofs, solution, external, equations%size, du, equations%seated, equations%way_to_part)
      if (present(given)) du = merge(given, du, known%fixed)
      do k = 1, size(known%motion)
        associate (p => equations%dofs%prescribed(k))
          if (p%history > 0 .or. known%at_place(p%dof)) du(p%dof) = known%motion(k)
        end associate
      end do
      whole = .not. present(alone)
      call evaluate(scene, equations, solution, dt, du, whole, report, predicted=.true., kept=kept, turning=known%dies, &
                    contact_alone=alone)
    end subroutine start_from

  end subroutine predict

  !> Work of the forces of the prediction on what the dies' pilots miss of the motion of the step: below 0 for those that go away
  !> from the part.
  pure function work_of_dies(equations, missing) result(work)
    type(equations_t), intent(in) :: equations   !! with the forces of the prediction
    real(wp), intent(in) :: missing(:)           !! (ndof) [unknown]
    real(wp) :: work(size(equations%dofs%fields(pilot_field)%number, 2))   !! (ndie) [energy]
    integer :: c, k

    work = 0
    associate (pilot => equations%dofs%fields(pilot_field)%number)
      do k = 1, size(pilot, 2)
        do c = 1, size(pilot, 1)
          if (pilot(c, k) > 0) work(k) = work(k) + equations%force(pilot(c, k))*missing(pilot(c, k))
        end do
      end do
    end associate
  end function work_of_dies

  !> Dies that still miss a part of their motion (ndie).
  pure function lagging_dies(equations, missing) result(lag)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: missing(:)   !! (ndof) [unknown]
    logical :: lag(size(equations%dofs%fields(pilot_field)%number, 2))
    integer :: k

    associate (pilot => equations%dofs%fields(pilot_field)%number)
      do k = 1, size(lag)
        lag(k) = any(abs(missing(pack(pilot(:, k), pilot(:, k) > 0))) > 0)
      end do
    end associate
  end function lagging_dies

  !> Dies that leave the part: those that withdraw and lose more than half of their points in the first iteration, or all of them.
  !> Without a force, as at the start, it is not known which way a die goes, but one that presses does not lose all points.
  elemental function leaving_dies(lags, work, before, now) result(leaving)
    logical, intent(in) :: lags             !! of lagging_dies
    real(wp), intent(in) :: work            !! of work_of_dies [energy]
    integer, intent(in) :: before, now      !! points that touch the die in the prediction, and after the iteration
    logical :: leaving

    leaving = lags .and. (work < 0 .and. 2*now < before .or. .not. abs(work) > 0 .and. now == 0 .and. before > 0)
  end function leaving_dies

end module predictor
