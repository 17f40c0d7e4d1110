!> Length of the steps, in LAGAMINE's tradition: after a step of n iterations the next is multiplied
!> by (NOPTI/n)**(1/NALPHA), between DMINMU and DMAXMU. Corners of multipliers, times of saving and
!> of new meshes, and the end are hit exactly.
module step_strategy
  use kinds, only: eps, wp
  use loads, only: multiplier_at
  use scene, only: scene_t
  use vectors, only: length_of
  use weld_sources, only: times_to_hit
  implicit none
  private
  public :: choose_step, after_success, after_failure, is_shortest

  !> A failed step is tried again with this share of its length.
  real(wp), parameter :: cutback = 0.5_wp
  !> A step is proposed with this share of the strain bound, so that it need not be cut back.
  real(wp), parameter :: foresight = 0.8_wp
  !> A time is reached when it is this close, relative to the end of the scene.
  real(wp), parameter :: reached = 64*eps

contains

  !> Length of the next step: what was proposed, no more than the largest and than dies may go, and no further than the
  !> next time to hit. Two equal steps rather than a long and a tiny one before such a time.
  pure function choose_step(scene, time, proposed) result(dt)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time, proposed
    real(wp) :: dt
    real(wp) :: left

    dt = min(proposed, scene%strategy%largest_step)
    left = next_time(scene, time) - time
    dt = min(dt, max(step_of_dies(scene, time, left), scene%strategy%least_step))
    if (left <= dt*(1 + reached)) then
      dt = left
    else if (left < 2*dt) then
      dt = 0.5_wp*left
    end if
  end function choose_step

  !> Length of a step in which the driven die that goes fastest goes as far as it may. Dies go evenly to the next corner.
  pure function step_of_dies(scene, time, left) result(dt)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time, left   !! now, and to the next time to hit [time]
    real(wp) :: dt
    real(wp) :: speed(2), fastest
    integer :: k, j

    dt = huge(dt)
    if (.not. scene%strategy%travel_bound > 0) return
    fastest = 0
    do k = 1, size(scene%die_motions)
      speed = 0
      do j = 1, size(scene%die_motions)
        associate (motion => scene%die_motions(j))
          if (motion%die /= scene%die_motions(k)%die .or. motion%component > 2) cycle
          associate (multiplier => scene%multipliers(motion%multiplier))
            speed(motion%component) = motion%amplitude*(multiplier_at(multiplier, time + left) - multiplier_at(multiplier, time)) &
                                      /left
          end associate
        end associate
      end do
      fastest = max(fastest, length_of(speed))
    end do
    if (fastest > 0) dt = scene%strategy%travel_bound/fastest
  end function step_of_dies

  !> The first time after `time` that must be hit.
  pure function next_time(scene, time) result(next)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time
    real(wp) :: next
    real(wp) :: after
    integer :: k

    next = scene%strategy%end_time
    after = time + reached*max(abs(next), abs(time))
    do k = 1, size(scene%multipliers)
      next = min(next, minval(scene%multipliers(k)%time, mask=scene%multipliers(k)%time > after))
    end do
    if (allocated(scene%sources)) then
      do k = 1, size(scene%sources)
        associate (times => times_to_hit(scene%sources(k)))
          next = min(next, minval(times, mask=times > after))
        end associate
      end do
    end if
    if (allocated(scene%strategy%save_times)) then
      next = min(next, minval(scene%strategy%save_times, mask=scene%strategy%save_times > after))
    end if
    if (allocated(scene%strategy%watch_times)) then
      next = min(next, minval(scene%strategy%watch_times, mask=scene%strategy%watch_times > after))
    end if
    if (allocated(scene%remesh%times)) next = min(next, minval(scene%remesh%times, mask=scene%remesh%times > after))
  end function next_time

  !> Proposal after an accepted step: by its iterations, and no longer than its strain increment and its error in time allow
  !> to foresee. A step shortened to hit a time does not shorten the proposal.
  pure function after_success(scene, dt, proposed, iterations, strain, growth, added, beyond_nopti, longer) result(next)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt, proposed
    integer, intent(in) :: iterations
    real(wp), intent(in) :: strain   !! largest strain increment of the step
    real(wp), intent(in), optional :: growth   !! largest factor by the error in time
    real(wp), intent(in), optional :: added    !! what counts as iterations beside them
    integer, intent(in), optional :: beyond_nopti   !! iterations that are aimed at beyond NOPTI (step_pace)
    real(wp), intent(in), optional :: longer   !! so many times as long as by iterations
    real(wp) :: next
    real(wp) :: factor, counted, aim

    associate (s => scene%strategy)
      counted = max(iterations, 1)
      if (present(added)) counted = counted + added
      aim = s%nopti
      if (present(beyond_nopti)) aim = aim + beyond_nopti
      factor = (aim/counted)**(1/s%nalpha)
      factor = min(max(factor, s%dminmu), s%dmaxmu)
      if (present(longer)) factor = factor*longer
      next = dt*factor
      if (dt < proposed .and. factor >= 1) next = max(next, min(proposed, s%largest_step))
      if (strain*next > foresight*s%strain_bound*dt) next = foresight*s%strain_bound/strain*dt
      if (present(growth)) next = min(next, min(growth, s%largest_step/dt)*dt)
      next = min(max(next, s%least_step), s%largest_step)
    end associate
  end function after_success

  !> Length to try after a failed step; `give_up` when that is below the least step.
  pure subroutine after_failure(scene, dt, next, give_up)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt
    real(wp), intent(out) :: next
    logical, intent(out) :: give_up

    next = cutback*dt
    give_up = is_shortest(scene, dt)
  end subroutine after_failure

  !> A step that fails cannot be cut back.
  pure logical function is_shortest(scene, dt)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt   !! [time]

    is_shortest = cutback*dt < scene%strategy%least_step
  end function is_shortest

end module step_strategy
