!> What each effect of a run was there for and what it cost, in `summary.json`.
module summary_effects
  use effects, only: effect_t
  use equations, only: equations_t
  use json_writer, only: json_t
  use kinds, only: i8, wp
  use scene, only: scene_t
  implicit none
  private
  public :: add_effects, add_seconds

contains

  !> Calls and seconds of each effect: an effect's time is that of its elements.
  subroutine add_effects(json, scene, equations)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer(i8) :: calls
    real(wp) :: seconds
    integer :: k

    call json%begin_object('effects')
    do k = 1, size(scene%effects)
      call booked(equations, scene%effects(k), calls, seconds)
      call json%begin_object(scene%effects(k)%name)
      call json%add('on', scene%effects(k)%on)
      call json%add('why', scene%effects(k)%why)
      call json%add('adds', scene%effects(k)%adds)
      if (len(scene%effects(k)%within) > 0) call json%add('within', scene%effects(k)%within)
      call json%add('calls', calls)
      call json%add('wall_s', seconds)
      call json%end_object()
    end do
    call json%end_object()
  end subroutine add_effects

  !> Calls and seconds in the ledger under the effect's name. An effect within another's loop is called
  !> whenever that is, and its seconds are among the other's.
  subroutine booked(equations, effect, calls, seconds)
    type(equations_t), intent(in) :: equations
    type(effect_t), intent(in) :: effect
    integer(i8), intent(out) :: calls
    real(wp), intent(out) :: seconds
    integer :: t

    calls = 0
    seconds = 0
    if (.not. effect%on) return
    do t = 1, equations%timers%size()
      if (equations%timers%name(t) == effect%within) calls = equations%timers%calls(t)
      if (equations%timers%name(t) /= effect%name) cycle
      calls = equations%timers%calls(t)
      seconds = equations%timers%seconds(t)
    end do
  end subroutine booked

  !> Where the rest of the time went.
  subroutine add_seconds(json, equations)
    type(json_t), intent(inout) :: json
    type(equations_t), intent(in) :: equations
    integer :: t

    call json%begin_object('seconds')
    do t = 1, equations%timers%size()
      call json%add(equations%timers%name(t), equations%timers%seconds(t))
    end do
    call json%end_object()
  end subroutine add_seconds

end module summary_effects
