!> What is known of the error that comes of the path within steps: of a step, and of all steps since the start (path_error).
module path_record
  use kinds, only: wp
  use scene, only: scene_t
  implicit none
  private
  public :: path_record_t, path_step_t
  public :: mean_square, motion_error, note_attempt, note_path_step, start_path, stress_error, stress_scale

  type :: path_step_t
    !> Its errors were estimated; one is above what the deck allows.
    logical :: estimated = .false., above = .false.
    !> Its motion, and the error of that, in the root mean square over the nodes [length].
    real(wp) :: motion = 0.0_wp, motion_error = 0.0_wp
    !> The latter, as the displacement of nodes (2, nnode) [length].
    real(wp), allocatable :: error(:, :)
    !> Root of the elastic energy, its error by this step, and how much is left at the end of the step of an error at its start.
    real(wp) :: stress = 0.0_wp, stress_error = 0.0_wp, left = 1.0_wp
    !> It must be shortened by an error (of motion or of stress, `which`) of this size; largest factor for the step that follows.
    logical :: too_long = .false.
    integer :: which = 0
    real(wp) :: size = 0.0_wp
    !> It is above what the deck allows, and a shorter step was no better.
    logical :: no_better = .false.
    real(wp) :: growth = huge(1.0_wp)
  end type path_step_t

  type :: path_record_t
    !> Sum over the steps of their motion, in the mean square, and what has come of their errors in it [length].
    real(wp) :: moved = 0.0_wp, moved_error = 0.0_wp
    !> Sum of the errors on the present mesh (2, nnode); of no nodes where none is estimated [length].
    real(wp), allocatable :: error(:, :)
    !> Root of the elastic energy: its integral over the time, its error now, and the largest that was of that over the scale.
    real(wp) :: stress_integral = 0.0_wp, stress_error = 0.0_wp, stress_worst = 0.0_wp
    !> The last root itself.
    real(wp) :: stress = 0.0_wp
    !> Steps with an estimate, attempts shortened by it, and steps of the least length above what is allowed.
    integer :: estimated = 0, shortened = 0, above = 0
    !> Steps still to come whose lengths are not bounded by their errors.
    integer :: unbounded = 0
    !> The last attempt at the present step that was shortened: its length, the error, and of what.
    real(wp) :: tried_length = 0.0_wp, tried_size = 0.0_wp
    integer :: tried_which = 0
  end type path_record_t

  !> Steps that are left alone after one whose error a shorter step did not lower.
  integer, parameter :: left_alone = 20

  !> Share of the mean stress below which stresses are small.
  real(wp), parameter :: least_share = 0.1_wp

contains

  !> No step has been made on the mesh.
  pure subroutine start_path(scene, record)
    type(scene_t), intent(in) :: scene
    type(path_record_t), intent(inout) :: record

    allocate (record%error(2, merge(size(scene%mesh%coordinates, 2), 0, scene%follows_path)), source=0.0_wp)
  end subroutine start_path

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
    record%tried_size = step%size
    record%tried_which = step%which
  end subroutine note_attempt

  !> Add an accepted step.
  pure subroutine note_path_step(step, dt, time, record)
    type(path_step_t), intent(in) :: step
    real(wp), intent(in) :: dt     !! its length [time]
    real(wp), intent(in) :: time   !! its end [time]
    type(path_record_t), intent(inout) :: record
    real(wp) :: before

    record%unbounded = max(record%unbounded - 1, 0)
    if (step%no_better) record%unbounded = left_alone
    record%tried_length = 0
    if (.not. step%estimated) return
    record%estimated = record%estimated + 1
    record%moved = record%moved + step%motion
    ! what came on earlier meshes stays beside the sum of this one
    before = record%moved_error - mean_square(record%error)
    record%error = record%error + step%error
    record%moved_error = max(before + mean_square(record%error), 0.0_wp)
    record%stress = step%stress
    record%stress_integral = record%stress_integral + step%stress*dt
    record%stress_error = step%left*record%stress_error + step%stress_error
    record%stress_worst = max(record%stress_worst, stress_error(record, time))
    if (step%above) record%above = record%above + 1
  end subroutine note_path_step

  !> Error of the motion since the start over the motion.
  pure function motion_error(record) result(share)
    type(path_record_t), intent(in) :: record
    real(wp) :: share

    share = 0
    if (record%moved > 0) share = record%moved_error/record%moved
  end function motion_error

  !> Error of the stress at this time over its scale.
  pure function stress_error(record, time) result(share)
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: time   !! [time]
    real(wp) :: share
    real(wp) :: scale

    scale = stress_scale(record, record%stress, time)
    share = 0
    if (scale > 0) share = abs(record%stress_error)/scale
  end function stress_error

  !> What an error of the stress is compared with: the stress now, or a share of its mean over the time where that is more, as when
  !> a load passes through zero.
  pure function stress_scale(record, stress, time) result(scale)
    type(path_record_t), intent(in) :: record
    real(wp), intent(in) :: stress   !! root of the elastic energy now
    real(wp), intent(in) :: time     !! [time]
    real(wp) :: scale

    scale = stress
    if (time > 0) scale = max(scale, least_share*record%stress_integral/time)
  end function stress_scale

end module path_record
