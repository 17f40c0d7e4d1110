!> What is known of the error that comes of the path within steps: of a step, and of all steps since the start (path_error).
module path_record
  use kinds, only: wp
  use scene, only: scene_t
  implicit none
  private
  public :: path_record_t, path_step_t, stress_unknown
  public :: mean_square, motion_error, note_attempt, note_path_step, settle_path, start_path, &
            stress_before, stress_error, stress_scale, whole_stress_error

  !> An error of the stress that is not known.
  real(wp), parameter :: stress_unknown = -1.0_wp

  type :: path_step_t
    !> Its errors were estimated, or are taken from those of steps before and after it; one is above what the deck allows.
    logical :: estimated = .false., interpolated = .false., above = .false.
    !> Its motion, and the error of that, in the root mean square over the nodes [length].
    real(wp) :: motion = 0.0_wp, motion_error = 0.0_wp
    !> The latter, as the displacement of nodes (2, nnode) [length].
    real(wp), allocatable :: error(:, :)
    !> Root of the elastic energy, its error by this step, and how much is left at the end of the step of an error at its start.
    real(wp) :: stress = 0.0_wp, stress_error = 0.0_wp, left = 1.0_wp
    !> It ends at a corner of a multiplier, or with the run. Then the error of the stress at its end that has come since the corner
    !> before, with what it owes to that of the motion; and how much is left of such an error at its start [energy^0.5].
    logical :: ends_course = .false.
    real(wp) :: stress_whole = 0.0_wp, whole_left = 1.0_wp
    !> Its errors, of motion and of stress, as they are bounded; it must be shortened by them.
    real(wp) :: sizes(2) = 0.0_wp
    logical :: too_long = .false.
    !> It is above what the deck allows, and a shorter step was no better; largest factor for the step that follows.
    logical :: no_better = .false.
    real(wp) :: growth = huge(1.0_wp)
    !> How many times as long the step could be, for errors that are no larger than by default.
    real(wp) :: spare = huge(1.0_wp)
    !> Share of its motion that is not in proportion to that of the step before.
    real(wp) :: bend = 0.0_wp
  end type path_step_t

  type :: path_record_t
    !> Sum over the steps of their motion, in the mean square, and what has come of their errors in it [length].
    real(wp) :: moved = 0.0_wp, moved_error = 0.0_wp
    !> Sum of the errors on the present mesh (2, nnode); of no nodes where none is estimated [length].
    real(wp), allocatable :: error(:, :)
    !> Root of the elastic energy: its recent mean, its error now, and the largest that was of that over the scale.
    real(wp) :: stress_recent = 0.0_wp, stress_error = 0.0_wp, stress_worst = 0.0_wp
    !> The last root itself, and the error of the stress then with what it owes to that of the motion (0: not estimated); what is
    !> left now of that at the last corner of a multiplier (one that was not known is taken to be the stress), and steps since then.
    real(wp) :: stress = 0.0_wp, stress_whole = 0.0_wp, whole_before = 0.0_wp
    integer :: course = 0
    !> Steps with an estimate, attempts shortened by it, and steps above what is allowed.
    integer :: estimated = 0, shortened = 0, above = 0
    !> Steps still to come whose lengths are not bounded by their errors, and how many after the next that is shortened in vain.
    integer :: unbounded = 0, patience = 1
    !> Steps still to come that may do without an estimate, as long as they are no longer than this [time], and bend no more than
    !> this share of their motion.
    integer :: quiet = 0
    real(wp) :: quiet_length = 0.0_wp, quiet_bend = 0.0_wp
    !> Of the steps without one since the last estimate: sums of length, length squared, and length times motion.
    real(wp) :: pending_time = 0.0_wp, pending_square = 0.0_wp, pending_motion = 0.0_wp
    !> Of the last estimate: error of the motion over length times motion [1/time], of the stress over length squared.
    real(wp) :: motion_rate = 0.0_wp, stress_rate = 0.0_wp
    !> The last attempt at the present step that was shortened: its length, and its errors of motion and of stress.
    real(wp) :: tried_length = 0.0_wp, tried_sizes(2) = 0.0_wp
  end type path_record_t

  !> Most steps that are left alone after one whose error a shorter step did not lower: once, twice as many each time that it
  !> happens again, and half as many after each step that is bounded.
  integer, parameter :: most_left_alone = 32

  !> Where a step could be so many times as long the next ones do without an estimate: one for each time this factor, and no more
  !> than so many.
  real(wp), parameter :: ample = 2.0_wp
  integer, parameter :: most_quiet = 4
  !> A motion that bends so many times as much as that of the last estimate, and more than this share, is estimated anew.
  real(wp), parameter :: bends_more = 2.0_wp, least_bend = 0.01_wp

  !> Steps on a new mesh that do without an estimate: what they change beside the motion of the dies, by the return to the yield
  !> surface and contact found anew, does not fall with their length.
  integer, parameter :: settling_steps = 2

  !> Share of their recent mean below which stresses are small: those that pass through zero, not those that creep has relaxed by
  !> any power of the time down to -1.
  real(wp), parameter :: least_share = 0.75_wp
  !> The recent mean of s is k/t^k times the integral of s t^(k-1) dt with this k: that of about the last third of the time.
  real(wp), parameter :: recent = 4.0_wp

contains

  !> No step has been made on the mesh.
  pure subroutine start_path(scene, record)
    type(scene_t), intent(in) :: scene
    type(path_record_t), intent(inout) :: record

    allocate (record%error(2, merge(size(scene%mesh%coordinates, 2), 0, scene%follows_path)), source=0.0_wp)
  end subroutine start_path

  !> The first steps on a new mesh are to come.
  pure subroutine settle_path(record)
    type(path_record_t), intent(inout) :: record

    record%quiet = settling_steps
    record%quiet_length = huge(record%quiet_length)
    record%quiet_bend = huge(record%quiet_bend)
  end subroutine settle_path

  !> Root of the mean square over the nodes.
  pure function mean_square(displacement) result(root)
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) [length]
    real(wp) :: root

    root = sqrt(sum(displacement**2)/max(size(displacement, 2), 1))
  end function mean_square

  !> Remember an attempt that must be shortened.
  pure subroutine note_attempt(step, dt, record)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt   !! [time]
    type(path_record_t), intent(inout) :: record

    if (.not. step%too_long) return
    record%shortened = record%shortened + 1
    record%tried_length = dt
    record%tried_sizes = step%sizes
  end subroutine note_attempt

  !> Add an accepted step.
  pure subroutine note_path_step(step, dt, time, record)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt     !! its length [time]
    real(wp), intent(in) :: time   !! its end [time]
    type(path_record_t), intent(inout) :: record
    real(wp) :: before, share, rate, least

    record%tried_length = 0
    record%stress_whole = 0
    record%course = record%course + 1
    if (step%interpolated) then
      record%quiet = record%quiet - 1
      record%pending_time = record%pending_time + dt
      record%pending_square = record%pending_square + dt**2
      record%pending_motion = record%pending_motion + step%motion*dt
      record%moved = record%moved + step%motion
      call remember(record%stress, dt, time, record%stress_recent)
      return
    end if
    if (record%unbounded > 0) then
      record%unbounded = record%unbounded - 1
    else if (step%no_better) then
      record%unbounded = record%patience
      record%patience = min(2*record%patience, most_left_alone)
    else
      record%patience = max(record%patience/2, 1)
    end if
    record%quiet = 0
    if (.not. step%estimated) return
    record%estimated = record%estimated + 1
    record%moved = record%moved + step%motion
    ! what came on earlier meshes stays beside the sum of this one
    before = record%moved_error - mean_square(record%error)
    share = 1
    rate = 0
    if (step%motion > 0) rate = step%motion_error/(step%motion*dt)
    ! a step much shorter than those without an estimate says no more of each than what it errs itself
    least = step%motion*dt
    if (record%pending_time > 0) least = max(least, record%pending_motion*record%pending_square/record%pending_time**2)
    if (rate > 0) share = 1 + record%pending_motion*0.5_wp*(1/least + record%motion_rate/(rate*step%motion*dt))
    record%error = record%error + share*step%error
    record%moved_error = max(before + mean_square(record%error), 0.0_wp)
    record%stress_error = stress_before(step, dt, record) + step%stress_error
    record%stress = step%stress
    record%whole_before = record%whole_before*step%whole_left**(1 + record%pending_time/dt)
    if (step%ends_course) call end_course(step, record)
    call remember(step%stress, dt, time, record%stress_recent)
    record%stress_worst = max(record%stress_worst, stress_error(record))
    if (step%above) record%above = record%above + 1
    record%motion_rate = rate
    record%stress_rate = step%stress_error/dt**2
    record%pending_time = 0
    record%pending_square = 0
    record%pending_motion = 0
    record%quiet_length = min(step%spare/ample, most_quiet + 1.0_wp)*dt
    record%quiet_bend = max(bends_more*step%bend, least_bend)
    if (.not. step%above) record%quiet = int(max(min(step%spare/ample - 1, real(most_quiet, wp)), 0.0_wp))
  end subroutine note_path_step

  !> At a corner of a multiplier, or at the end: what has come since the corner before is added to what is left from there, in
  !> squares, for both have what the error of the places makes of it.
  pure subroutine end_course(step, record)
    type(path_step_t), intent(in) :: step
    type(path_record_t), intent(inout) :: record

    record%course = 0
    record%whole_before = hypot(record%whole_before, merge(step%stress_whole, step%stress, step%stress_whole >= 0))
    if (record%whole_before < step%stress) record%stress_whole = record%whole_before
  end subroutine end_course

  !> Go on with the recent mean.
  pure subroutine remember(stress, dt, time, mean)
    real(wp), intent(in) :: stress      !! root of the elastic energy of the step [energy^0.5]
    real(wp), intent(in) :: dt, time    !! of the step, and its end [time]
    real(wp), intent(inout) :: mean     !! [energy^0.5]

    mean = mean + (stress - mean)*(1 - (max(time - dt, 0.0_wp)/time)**recent)
  end subroutine remember

  !> What is left at the end of a step of the errors of the stress before it. Steps since the last estimate are taken to err
  !> in the mean of that and this one, as the squares of their lengths, but by no more than this one where it is shorter.
  pure function stress_before(step, dt, record) result(error)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt   !! its length [time]
    type(path_record_t), intent(in) :: record
    real(wp) :: error   !! [energy^0.5]

    real(wp) :: length

    length = dt
    if (record%pending_time > 0) length = max(dt, record%pending_square/record%pending_time)
    error = step%left*(step%left**(record%pending_time/dt)*record%stress_error &
                       + 0.5_wp*(record%stress_rate + step%stress_error/length**2)*record%pending_square)
  end function stress_before

  !> Error of the motion since the start over the motion.
  pure function motion_error(record) result(share)
    type(path_record_t), intent(in) :: record
    real(wp) :: share

    share = 0
    if (record%moved > 0) share = record%moved_error/record%moved
  end function motion_error

  !> Error of the stress now over its scale.
  pure function stress_error(record) result(share)
    type(path_record_t), intent(in) :: record
    real(wp) :: share
    real(wp) :: scale

    scale = stress_scale(record, record%stress)
    share = 0
    if (scale > 0) share = abs(record%stress_error)/scale
  end function stress_error

  !> The same with what it owes to the error of the motion, where that is known; the one that creep leaves is a part of it.
  pure function whole_stress_error(record) result(share)
    type(path_record_t), intent(in) :: record
    real(wp) :: share
    real(wp) :: scale

    scale = stress_scale(record, record%stress)
    share = stress_error(record)
    if (scale > 0) share = max(share, record%stress_whole/scale)
  end function whole_stress_error

  !> What an error of the stress is compared with: the stress now, or a share of its recent mean where that is more, as when a load
  !> passes through zero.
  pure function stress_scale(record, stress) result(scale)
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: stress   !! root of the elastic energy now
    real(wp) :: scale

    scale = max(stress, least_share*record%stress_recent)
  end function stress_scale

end module path_record
