!> What is known of the error that comes of the path within steps: of a step, and of all steps since the start (path_error).
module path_record
  use kinds, only: wp
  use scene, only: scene_t
  implicit none
  private
  public :: path_record_t, path_step_t, state_error_t
  public :: bound_scale, error_weight, largest_linear, mean_square, motion_error, note_attempt, note_path_step, settle_path, &
            start_path, stress_before, stress_error, stress_scale, whole_stress_error

  !> Errors of the state of a group's points, of no elements where it does not flow.
  type :: state_error_t
    real(wp), allocatable :: value(:, :, :)   !! (component, point, element) [unit of each component]
  end type state_error_t

  type :: path_step_t
    !> Its errors were estimated, or are taken from those of steps before and after it; one is above what the deck allows.
    logical :: estimated = .false., interpolated = .false., above = .false.
    !> Its motion, and the error of that, in the root mean square over the nodes [length].
    real(wp) :: motion = 0.0_wp, motion_error = 0.0_wp
    !> What it dissipates, in the mean of the points of bodies that flow [energy/length^3].
    real(wp) :: flowed = 0.0_wp
    !> At its end: errors of the places of nodes and of the states (path_stress), and the norm of that of the stress; not known
    !> where they could not be carried on.
    real(wp), allocatable :: error(:, :)   !! (2, nnode) [length]
    type(state_error_t), allocatable :: states(:)   !! (ngroup)
    real(wp) :: stress_whole = 0.0_wp   !! [energy^0.5]
    logical :: known = .false.
    !> Temperatures err in it.
    logical :: warm = .false.
    !> Points of contact change in it.
    logical :: jumps = .false.
    !> Root of the elastic energy, its error by this step, and how much is left at the end of the step of an error at its start.
    real(wp) :: stress = 0.0_wp, stress_error = 0.0_wp, left = 1.0_wp
    !> The same root at the stress that makes bodies flow.
    real(wp) :: flow = 0.0_wp
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
    !> Error of the places that has come on the present mesh (2, nnode); of no nodes where none is estimated [length].
    real(wp), allocatable :: error(:, :)
    !> Root of the elastic energy: its recent mean, its error now, and the largest that was of that over the scale.
    real(wp) :: stress_recent = 0.0_wp, stress_error = 0.0_wp, stress_worst = 0.0_wp
    !> The last root itself, and the error of the stress then with what it owes to that of the motion; what is left in it of the one
    !> with which the meshes and operations before ended; and how much of an error that could not be carried on, as a share of it.
    real(wp) :: stress = 0.0_wp, stress_whole = 0.0_wp, whole_before = 0.0_wp, unknown = 0.0_wp
    !> An error could not be carried on while temperatures erred: what they make of the stress since is not known.
    logical :: lost = .false.
    !> Root of the elastic energy at the stress that made bodies flow then.
    real(wp) :: flow = 0.0_wp
    !> Steps with an estimate, attempts shortened by it, and steps above what is allowed.
    integer :: estimated = 0, shortened = 0, above = 0
    !> Steps still to come whose lengths are not bounded by their errors, and how many after the next that is shortened in vain.
    integer :: unbounded = 0, patience = 1
    !> Steps still to come that may do without an estimate, as long as they are no longer than this [time], flow no more than this
    !> [energy/length^3], and bend no more than this share of their motion.
    integer :: quiet = 0
    real(wp) :: quiet_length = 0.0_wp, quiet_flow = 0.0_wp, quiet_bend = 0.0_wp
    !> Of the steps without one since the last estimate: sums of length, length squared, and length times motion.
    real(wp) :: pending_time = 0.0_wp, pending_square = 0.0_wp, pending_motion = 0.0_wp
    !> Of the last estimate: error of the motion over length times motion [1/time], of the stress over length squared.
    real(wp) :: motion_rate = 0.0_wp, stress_rate = 0.0_wp
    !> The first of these in the last step in which no point of contact changed; below 0 before there is one [1/time].
    real(wp) :: smooth_rate = -1.0_wp
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
  !> One that bends by more than the third share has an estimate in any case: in the step before it another motion was judged.
  real(wp), parameter :: bends_more = 2.0_wp, least_bend = 0.01_wp, most_bend = 0.25_wp

  !> Steps on a new mesh that do without an estimate: what they change beside the motion of the dies, by the return to the yield
  !> surface and contact found anew, does not fall with their length.
  integer, parameter :: settling_steps = 2

  !> An error of which less than this share is left is forgotten.
  real(wp), parameter :: forgotten = 0.01_wp

  !> Share of their recent mean below which stresses are small: those that pass through zero, not those that creep has relaxed by
  !> any power of the time down to -1.
  real(wp), parameter :: least_share = 0.75_wp
  !> Stresses below this share of those that make bodies flow are nearly none: steps are bounded as if they were so large.
  real(wp), parameter :: nearly_none = 0.01_wp
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
    record%quiet_flow = huge(record%quiet_flow)
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
    real(wp) :: before

    record%tried_length = 0
    record%lost = record%lost .or. (step%warm .and. .not. step%known)
    if (step%interpolated) then
      record%quiet = record%quiet - 1
      record%pending_time = record%pending_time + dt
      record%pending_square = record%pending_square + dt**2
      record%pending_motion = record%pending_motion + step%motion*dt
      record%moved = record%moved + step%motion
      if (.not. step%known) record%unknown = 1
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
    if (.not. step%estimated) then
      if (size(record%error) > 0) record%unknown = 1
      return
    end if
    record%estimated = record%estimated + 1
    record%moved = record%moved + step%motion
    ! what came on earlier meshes stays beside the sum of this one
    before = record%moved_error - mean_square(record%error)
    record%error = step%error
    record%moved_error = max(before + mean_square(record%error), 0.0_wp)
    record%stress_error = stress_before(step, dt, record) + step%stress_error
    record%stress = step%stress
    record%flow = step%flow
    record%whole_before = record%whole_before*step%left**(1 + record%pending_time/dt)
    record%unknown = merge(record%unknown*step%left**(1 + record%pending_time/dt), 1.0_wp, step%known)
    if (record%unknown < forgotten) record%unknown = 0
    if (step%known) record%stress_whole = hypot(record%whole_before, step%stress_whole)
    call remember(step%stress, dt, time, record%stress_recent)
    record%stress_worst = max(record%stress_worst, stress_error(record))
    if (step%above) record%above = record%above + 1
    record%motion_rate = 0
    if (step%motion > 0) record%motion_rate = step%motion_error/(step%motion*dt)
    if (.not. step%jumps) record%smooth_rate = record%motion_rate
    record%stress_rate = step%stress_error/dt**2
    record%pending_time = 0
    record%pending_square = 0
    record%pending_motion = 0
    record%quiet_length = min(step%spare/ample, most_quiet + 1.0_wp)*dt
    ! an elastic step says nothing of those in which flow begins
    record%quiet_flow = min(step%spare/ample, most_quiet + 1.0_wp)*step%flowed
    record%quiet_bend = min(max(bends_more*step%bend, least_bend), most_bend)
    if (.not. step%above) record%quiet = int(max(min(step%spare/ample - 1, real(most_quiet, wp)), 0.0_wp))
  end subroutine note_path_step

  !> The error of the motion of a step and of those without an estimate before it, over its own: each of those is taken to err in
  !> the mean of the estimates before and after it.
  pure function error_weight(step, dt, record) result(weight)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt   !! its length [time]
    type(path_record_t), intent(in) :: record
    real(wp) :: weight
    real(wp) :: least

    weight = 1
    if (.not. step%motion_error > 0) return
    ! a step much shorter than those without an estimate says no more of each than what it errs itself
    least = step%motion*dt
    if (record%pending_time > 0) least = max(least, record%pending_motion*record%pending_square/record%pending_time**2)
    weight = 1 + record%pending_motion*0.5_wp*(1/least + record%motion_rate/step%motion_error)
  end function error_weight

  !> Go on with the recent mean.
  pure subroutine remember(stress, dt, time, mean)
    real(wp), intent(in) :: stress      !! root of the elastic energy of the step [energy^0.5]
    real(wp), intent(in) :: dt, time    !! of the step, and its end [time]
    real(wp), intent(inout) :: mean     !! [energy^0.5]

    mean = mean + (stress - mean)*(1 - (max(time - dt, 0.0_wp)/time)**recent)
  end subroutine remember

  !> What is left at the end of a step of the errors of the stress before it. Steps since the last estimate are taken to err
  !> in the mean of that and this one, as the squares of their lengths, but by no more than this one where it is shorter.
  pure function stress_before(step, dt, record, most) result(error)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt   !! its length [time]
    type(path_record_t), intent(in) :: record
    real(wp), intent(in), optional :: most   !! of the error at the last estimate that counts [energy^0.5]
    real(wp) :: error   !! [energy^0.5]
    real(wp) :: first, length

    first = record%stress_error
    if (present(most)) first = sign(min(abs(first), most), first)

    length = dt
    if (record%pending_time > 0) length = max(dt, record%pending_square/record%pending_time)
    error = step%left*(step%left**(record%pending_time/dt)*first &
                       + 0.5_wp*(record%stress_rate + step%stress_error/length**2)*record%pending_square)
  end function stress_before

  !> Error of the motion since the start over the motion.
  pure function motion_error(record) result(share)
    type(path_record_t), intent(in) :: record
    real(wp) :: share

    share = 0
    if (record%moved > 0) share = record%moved_error/record%moved
  end function motion_error

  !> Error of the stress now over the scale of its bound.
  pure function stress_error(record) result(share)
    type(path_record_t), intent(in) :: record
    real(wp) :: share
    real(wp) :: scale

    scale = bound_scale(record, record%stress, record%flow)
    share = 0
    if (scale > 0) share = abs(record%stress_error)/scale
  end function stress_error

  !> The same with directions, pressures and what it owes to the error of the motion, where that is known: errors that are as large
  !> as the stress are not carried on by its derivatives.
  pure subroutine whole_stress_error(record, share, known)
    type(path_record_t), intent(in) :: record
    real(wp), intent(out) :: share
    logical, intent(out) :: known
    real(wp) :: scale

    scale = stress_scale(record, record%stress)
    known = record%unknown < forgotten .and. .not. record%lost .and. record%stress_whole <= largest_linear(scale, record%flow)
    share = stress_error(record)
    if (known .and. scale > 0) share = record%stress_whole/scale
  end subroutine whole_stress_error

  !> What bounds of the error of the stress are over: the scale of what is told, or in a part that is free of stress, as one that
  !> cools evenly, a share of what makes it flow: over the round-off in it no step would be short enough.
  pure function bound_scale(record, stress, flow) result(scale)
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: stress, flow   !! root of the elastic energy now, and at flow [energy^0.5]
    real(wp) :: scale

    scale = max(stress_scale(record, stress), nearly_none*flow)
  end function bound_scale

  !> Largest error of the stress that is carried on by derivatives: as large as the stress, or as what makes bodies flow.
  pure function largest_linear(scale, flow) result(largest)
    real(wp), intent(in) :: scale, flow   !! of the stress, and at flow [energy^0.5]
    real(wp) :: largest

    largest = max(scale, flow)
  end function largest_linear

  !> What an error of the stress is compared with: the stress now, or a share of its recent mean where that is more, as when a load
  !> passes through zero.
  pure function stress_scale(record, stress) result(scale)
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: stress   !! root of the elastic energy now
    real(wp) :: scale

    scale = max(stress, least_share*record%stress_recent)
  end function stress_scale

end module path_record
