!> Stress that drives formulations of heat solved in turns with the mechanics, until both agree.
!>
!> One turn takes the measures x of the stress at the points, finds the temperatures and phases under them, then the mechanics,
!> whose stress has the measures g(x). Where a section is held a phase that forms lowers the mean stress that lets it form: to hand
!> g over as it is would diverge, at any length of step. x is advanced by Anderson's method instead: of the differences of f = g - x
!> between turns of the step, the combination that leaves least of f; of that a share is added, at each point after its own secant.
!> Source: D.G. Anderson, J. ACM 12 (1965) 547; H.F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
module stress_exchange
  use driver_values, only: stress_of_solution
  use drivers, only: hand_over_stress, stress_driver_count
  use equations, only: equations_t
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use strategy, only: coupling_converged
  use vectors, only: length_of
  implicit none
  private
  public :: stress_exchange_t, begin_exchange, advance_exchange, end_exchange

  !> So many differences are kept.
  integer, parameter :: most_differences = 12
  !> Share of what is left of f that is handed over: at first, and at least.
  real(wp), parameter :: first_share = 0.3_wp, least_share = 0.1_wp
  !> Turns agree to so many times what the solves find their unknowns to: a share of the temperature of a step is some ten times as
  !> much of its motion (BETA DEPS/ALPHA), and of that some times as much again while the body is held; of its stress it is more.
  real(wp), parameter :: slack_of_motion = 100.0_wp, slack_of_stress = 1000.0_wp
  !> A difference of which no more is left beside the others says nothing new.
  real(wp), parameter :: least_new = 1.0e-8_wp

  type :: stress_exchange_t
    !> Measures that the turn begins with, and g - x of the turn before.
    real(wp), allocatable :: x(:), f(:)   !! (npoint of all) [stress]
    !> Differences of x and f between turns, newest last.
    real(wp), allocatable :: by_x(:, :), by_f(:, :)   !! (npoint of all, most_differences) [stress]
    !> Share of what is left of f that is handed over, by the last difference at the point itself.
    real(wp), allocatable :: share(:)   !! (npoint of all) [-]
    integer :: n = 0
  end type stress_exchange_t

contains

  !> For a step that begins: the measures of the accepted stress, which is the trial state. Without such drivers, or where turns are
  !> not repeated, nothing.
  subroutine begin_exchange(scene, solution, equations, exchange)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(equations_t), intent(inout) :: equations
    type(stress_exchange_t), intent(out) :: exchange
    integer :: n

    if (scene%strategy%coupling /= coupling_converged) return
    n = stress_driver_count(equations%drivers)
    if (n == 0) return
    allocate (exchange%x(n), exchange%f(n))
    allocate (exchange%share(n), source=first_share)
    allocate (exchange%by_x(n, most_differences), exchange%by_f(n, most_differences))
    call stress_of_solution(scene, solution, equations%drivers, exchange%x)
    call hand_over_stress(exchange%x, equations%drivers)
  end subroutine begin_exchange

  !> After a turn: what is handed over next. The change of the turn is weighed, with that of the stress, to be comparable
  !> with what the solves find their unknowns to. Where nothing is handed over nothing changes.
  subroutine advance_exchange(scene, solution, equations, exchange, change)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(equations_t), intent(inout) :: equations
    type(stress_exchange_t), intent(inout) :: exchange
    real(wp), intent(inout) :: change   !! largest one of the turn, over DISPL; on return weighed, with that of the stress [-]
    real(wp), allocatable :: g(:), x(:), f(:)

    if (.not. allocated(exchange%x)) return
    allocate (g, mold=exchange%x)
    call stress_of_solution(scene, solution, equations%drivers, g)
    allocate (f, source=g - exchange%x)
    allocate (x, source=exchange%x)
    change = change/slack_of_motion
    if (length_of(g) > 0) change = max(change, length_of(f)/(slack_of_stress*length_of(g)))
    call keep_difference(f, exchange)
    exchange%f = f
    call combine(exchange, x, f)
    exchange%by_x(:, 1 + mod(exchange%n, most_differences)) = x + exchange%share*f - exchange%x
    exchange%x = x + exchange%share*f
    exchange%n = exchange%n + 1
    call hand_over_stress(exchange%x, equations%drivers)
  end subroutine advance_exchange

  !> The difference of f that goes with the last difference of x, which is there since it was handed over.
  pure subroutine keep_difference(f, exchange)
    real(wp), intent(in) :: f(:)   !! (npoint of all) [stress]
    type(stress_exchange_t), intent(inout) :: exchange
    integer :: i, k

    if (exchange%n == 0) return
    i = 1 + mod(exchange%n - 1, most_differences)
    exchange%by_f(:, i) = f - exchange%f
    do k = 1, size(f)
      if (.not. abs(exchange%by_f(k, i)) > 0) cycle
      exchange%share(k) = min(1.0_wp, max(least_share, -exchange%by_x(k, i)/exchange%by_f(k, i)))
    end do
  end subroutine keep_difference

  !> Newest first: what a difference adds to those before takes its part out of f, and moves x.
  pure subroutine combine(exchange, x, f)
    type(stress_exchange_t), intent(in) :: exchange
    real(wp), intent(inout) :: x(:), f(:)   !! (npoint of all) [stress]
    real(wp) :: direction(size(x), most_differences), motion(size(x), most_differences), before, share
    integer :: k, i, m

    m = 0
    do k = exchange%n, max(1, exchange%n - most_differences + 1), -1
      i = 1 + mod(k - 1, most_differences)
      direction(:, m + 1) = exchange%by_f(:, i)
      motion(:, m + 1) = exchange%by_x(:, i)
      before = length_of(direction(:, m + 1))
      call make_orthogonal(m, direction, motion)
      share = length_of(direction(:, m + 1))
      if (.not. share > least_new*before) cycle
      m = m + 1
      direction(:, m) = direction(:, m)/share
      motion(:, m) = motion(:, m)/share
      share = dot_product(direction(:, m), f)
      f = f - share*direction(:, m)
      x = x - share*motion(:, m)
    end do
  end subroutine combine

  !> Direction m + 1 orthogonal to the first m, and the motion that goes with it.
  pure subroutine make_orthogonal(m, direction, motion)
    integer, intent(in) :: m
    real(wp), intent(inout) :: direction(:, :), motion(:, :)   !! (npoint of all, ndifference) [stress]
    real(wp) :: share
    integer :: k

    do k = 1, m
      share = dot_product(direction(:, k), direction(:, m + 1))
      direction(:, m + 1) = direction(:, m + 1) - share*direction(:, k)
      motion(:, m + 1) = motion(:, m + 1) - share*motion(:, k)
    end do
  end subroutine make_orthogonal

  !> The step has ended: drivers follow the stress again.
  subroutine end_exchange(equations, exchange)
    type(equations_t), intent(inout) :: equations
    type(stress_exchange_t), intent(inout) :: exchange

    if (.not. allocated(exchange%x)) return
    call hand_over_stress(exchange%x(:0), equations%drivers)
  end subroutine end_exchange

end module stress_exchange
