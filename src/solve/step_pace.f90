!> Steps that stay short although none fails: longer ones are tried.
!>
!> The rule of step_strategy takes iterations for a function of the length that rises steeply. Where every step takes a few, however
!> short it is, as where sides slide around a bend of a die, it makes steps shorter and shorter for nothing, and goes on with short
!> ones for ever: steps eight times as long may take less than twice the iterations. So after a number of short steps of which none
!> has failed, and which errors of the path would let grow, one that is much longer is made, and steps aim at more iterations, by
!> which they stay long. Where they become short again and take as many iterations over time as before, attempts that failed among
!> them, NOPTI counts again.
module step_pace
  use kinds, only: wp
  use pace_record, only: pace_t
  use strategy, only: strategy_t
  use text, only: to_text
  implicit none
  private
  public :: note_failed_attempt, note_pace

  !> A step is short below this share of the longest; so many of them are measured.
  real(wp), parameter :: short = 0.05_wp
  integer, parameter :: measured = 20
  !> Length that is tried over the present one, where errors let a step grow by more than twice; iterations that steps aim at then,
  !> over NOPTI, and no more than this share of those after which they are cut back.
  real(wp), parameter :: longer = 8.0_wp, room = 2.0_wp, aim = 1.6_wp, most = 0.5_wp
  !> A trial pays where it takes less than this share of the iterations.
  real(wp), parameter :: pays = 0.9_wp

contains

  !> After an accepted step: the factor by which the next one is longer than by the rule, and words for the listing where a trial
  !> begins or ends, else empty.
  pure subroutine note_pace(strategy, proposed, dt, iterations, growth, pace, factor, words)
    type(strategy_t), intent(in) :: strategy
    real(wp), intent(in) :: proposed, dt   !! length that was intended, and that was made [time]
    integer, intent(in) :: iterations      !! of the step, all of them
    real(wp), intent(in) :: growth         !! largest factor by errors in time
    type(pace_t), intent(inout) :: pace
    real(wp), intent(out) :: factor
    character(len=:), allocatable, intent(out) :: words
    real(wp) :: cost
    integer :: beyond

    words = ''
    factor = 1
    if (.not. proposed < short*strategy%largest_step) then
      pace = pace_t(beyond_nopti=pace%beyond_nopti)
      return
    end if
    pace%steps = pace%steps + 1
    pace%iterations = pace%iterations + iterations
    pace%time = pace%time + dt
    if (pace%settled .or. pace%steps < measured) return
    cost = pace%iterations/pace%time
    if (pace%cost > 0) then
      if (cost < pays*pace%cost) then
        pace = pace_t(beyond_nopti=pace%beyond_nopti)
        return
      end if
      words = 'as short again, steps take '//to_text(cost, 3)//' iterations per unit of time, before '//to_text(pace%cost, 3) &
              //': they aim at '//to_text(strategy%nopti)//' iterations again'
      pace = pace_t(settled=.true.)
    else if (growth > room) then
      beyond = min(nint(aim*strategy%nopti), int(most*strategy%max_iterations)) - strategy%nopti
      if (beyond <= pace%beyond_nopti) return
      pace = pace_t(beyond_nopti=beyond, cost=cost)
      factor = longer
      words = 'steps are shorter than '//to_text(100*short)//' % of the longest, though none fails, and take '//to_text(cost, 3) &
              //' iterations per unit of time: one of '//to_text(longer)//' times the length is tried, and they aim at ' &
              //to_text(strategy%nopti + beyond)//' iterations from here'
    end if
  end subroutine note_pace

  !> An attempt at a step has failed: steps are short for that, or its iterations are part of what those of a trial take.
  pure subroutine note_failed_attempt(iterations, pace)
    integer, intent(in) :: iterations
    type(pace_t), intent(inout) :: pace

    if (pace%cost > 0) then
      pace%iterations = pace%iterations + iterations
    else
      pace = pace_t(beyond_nopti=pace%beyond_nopti, settled=pace%settled)
    end if
  end subroutine note_failed_attempt

end module step_pace
