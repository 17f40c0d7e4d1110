!> Power of welding torches in a step.
!>
!> A torch that crosses the plane is there for a moment, which may be shorter than a step: its power at the instants at which heat
!> flows (the end of the step, or those of the scheme) would tell little of its heat; so would that of one in the plane whose power
!> rises or falls. So the powers at these instants are scaled such that the step takes exactly what the torch leaves meanwhile.
module torch_steps
  use kinds, only: wp
  use scene, only: scene_t
  use weld_sources, only: mean_power, power_in_plane
  implicit none
  private
  public :: torch_powers, torch_step, torch_step_t

  !> What makes of the power of each source at an instant that which it has in the step.
  type :: torch_step_t
    !> A factor (nsource), and what is added: the mean, where all instants are outside the crossing (nsource) [power].
    real(wp), allocatable :: scale(:), plus(:)
  end type torch_step_t

contains

  !> Of a step from a time on, whose flows are those of some shares of it with their weights.
  pure subroutine torch_step(scene, from, dt, share, weight, step)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: from, dt              !! [time]
    real(wp), intent(in) :: share(:), weight(:)   !! (ninstant)
    type(torch_step_t), intent(out) :: step
    real(wp) :: mean, sum_of_rule
    integer :: k, i

    allocate (step%scale(size(scene%sources)), source=1.0_wp)
    allocate (step%plus(size(scene%sources)), source=0.0_wp)
    do k = 1, size(scene%sources)
      mean = mean_power(scene%sources(k), scene%multipliers, from, from + dt, scene%section(1))
      sum_of_rule = 0
      do i = 1, size(share)
        sum_of_rule = sum_of_rule &
                      + weight(i)*power_in_plane(scene%sources(k), scene%multipliers, from + share(i)*dt, scene%section(1))
      end do
      if (sum_of_rule > 0) then
        step%scale(k) = mean/sum_of_rule
      else
        step%plus(k) = mean
      end if
    end do
  end subroutine torch_step

  !> Power of each source at an instant, within a step where one is given.
  pure function torch_powers(scene, time, step) result(power)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time                        !! [time]
    type(torch_step_t), intent(in), optional :: step
    real(wp) :: power(size(scene%sources))              !! [power]
    integer :: k

    power = [(power_in_plane(scene%sources(k), scene%multipliers, time, scene%section(1)), k=1, size(power))]
    if (present(step)) power = step%scale*power + step%plus
  end function torch_powers

end module torch_steps
