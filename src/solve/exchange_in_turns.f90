!> What drives heat and is found by the mechanics, where both are solved in turns until they agree: stress that acts on phases, and
!> conductances of contact.
!>
!> One turn takes such values x at the points, finds the temperatures and phases under them, then the mechanics, whose state has the
!> values g(x). Where a section is held a phase that forms lowers the mean stress that lets it form; where a part is pressed on a
!> die heat that leaves it lowers the pressure that lets it leave (J.R. Barber, J. Elast. 8 (1978) 409): to hand g over as it is
!> would diverge, or go to and fro, at any length of step. x is advanced by Anderson's method instead: of the differences of
!> f = g - x between turns of the step, the combination that leaves least of f; of that a share is added, at each point after its
!> own secant. Source: D.G. Anderson, J. ACM 12 (1965) 547; H.F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
module exchange_in_turns
  use contact_conductance, only: conductance_of_solution, conductance_count, hand_over, largest_conductances
  use driver_values, only: stress_of_solution
  use drivers, only: as_without_contact, hand_over_stress, not_handed, stress_driver_count
  use equations, only: equations_t
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: turns_t, begin_exchange, advance_exchange, end_exchange, hand_over_again, hand_over_reached

  !> So many differences are kept.
  integer, parameter :: most_differences = 12
  !> Share of what is left of f that is handed over: of stress at first, of conductance at first, and at least.
  real(wp), parameter :: first_share(2) = [0.3_wp, 1.0_wp], least_share = 0.1_wp
  !> Turns agree to so many times what the solves find their unknowns to: where stress acts, a share of the temperature of a step is
  !> some ten times as much of its motion (BETA DEPS/ALPHA), and of that some times as much again while the body is held; of its
  !> stress it is more. Pressures that bring heat are as much less exact than the motion.
  real(wp), parameter :: slack_of_motion = 100.0_wp, slack_of_values(2) = [1000.0_wp, 10.0_wp]
  !> A difference of which no more is left beside the others says nothing new.
  real(wp), parameter :: least_new = 1.0e-8_wp
  !> Values that differ by less than this share of them do not.
  real(wp), parameter :: least_difference = 1.0e-6_wp

  type :: turns_t
    !> Values that the turn begins with, `nstress` of stress, the rest of conductance, and g - x of the turn before.
    real(wp), allocatable :: x(:), f(:)   !! (nvalue) [stress], [power/area/temperature] or [-]
    integer :: nstress = 0
    !> Bounds of what is handed over.
    real(wp), allocatable :: largest(:)   !! (nvalue) as x
    !> What makes the values of both kinds alike in sums of squares.
    real(wp), allocatable :: weight(:)    !! (nvalue) 1/as x squared
    !> Differences of x and f between turns, newest last.
    real(wp), allocatable :: by_x(:, :), by_f(:, :)   !! (nvalue, most_differences) as x
    !> Share of what is left of f that is handed over, by the last difference at the point itself.
    real(wp), allocatable :: share(:)   !! (nvalue) [-]
    integer :: n = 0
  end type turns_t

contains

  !> For a step that begins: the values of the accepted state, which is the trial state. Without such drivers nothing.
  subroutine begin_exchange(scene, solution, equations, exchange, contact_alone)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(equations_t), intent(inout) :: equations
    type(turns_t), intent(out) :: exchange
    logical, intent(in), optional :: contact_alone   !! conductances alone
    integer :: n, m

    n = stress_driver_count(equations%drivers)
    if (present(contact_alone)) n = merge(0, n, contact_alone)
    m = conductance_count(equations%drivers)
    if (n + m == 0) return
    exchange%nstress = n
    allocate (exchange%x(n + m), exchange%f(n + m), exchange%share(n + m), exchange%largest(n + m), exchange%weight(n + m))
    exchange%share(:n) = first_share(1)
    exchange%share(n + 1:) = first_share(2)
    exchange%largest = huge(1.0_wp)
    call largest_conductances(scene, equations%drivers, exchange%largest(n + 1:))
    allocate (exchange%by_x(n + m, most_differences), exchange%by_f(n + m, most_differences))
    call values_of_solution(scene, solution, equations, exchange, exchange%x)
    call hand_over_values(exchange, equations)
  end subroutine begin_exchange

  !> Values as the trial state has them.
  subroutine values_of_solution(scene, solution, equations, exchange, values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(equations_t), intent(in) :: equations
    type(turns_t), intent(in) :: exchange
    real(wp), intent(out) :: values(:)   !! (nvalue) as x

    associate (n => exchange%nstress)
      if (n > 0) call stress_of_solution(scene, solution, equations%drivers, values(:n))
      call conductance_of_solution(scene, solution, equations%drivers, values(n + 1:))
    end associate
  end subroutine values_of_solution

  !> Values drive the points from now on.
  pure subroutine hand_over_values(exchange, equations)
    type(turns_t), intent(in) :: exchange
    type(equations_t), intent(inout) :: equations

    associate (n => exchange%nstress)
      if (n > 0) call hand_over_stress(exchange%x(:n), equations%drivers)
      call hand_over(exchange%x(n + 1:), equations%drivers)
    end associate
  end subroutine hand_over_values

  !> What the trial state has is handed over, for a comparison; it differs from what was. Without such drivers nothing.
  subroutine hand_over_reached(scene, solution, equations, exchange, differ)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(equations_t), intent(inout) :: equations
    type(turns_t), intent(in) :: exchange
    logical, intent(out) :: differ
    type(turns_t) :: reached

    differ = .false.
    if (.not. allocated(exchange%x)) return
    reached%nstress = exchange%nstress
    allocate (reached%x, mold=exchange%x)
    call values_of_solution(scene, solution, equations, exchange, reached%x)
    differ = length_of(reached%x - exchange%x) > least_difference*length_of(reached%x)
    if (differ) call hand_over_values(reached, equations)
  end subroutine hand_over_reached

  !> What the turn was made with is handed over again; where contact knew nothing of a point, as heat has found it then.
  subroutine hand_over_again(equations, exchange)
    type(equations_t), intent(inout) :: equations
    type(turns_t), intent(in) :: exchange
    type(turns_t) :: again

    if (.not. allocated(exchange%x)) return
    again%nstress = exchange%nstress
    again%x = exchange%x
    associate (n => exchange%nstress)
      where (.not. again%x(n + 1:) > not_handed) again%x(n + 1:) = as_without_contact
    end associate
    call hand_over_values(again, equations)
  end subroutine hand_over_again

  !> After a turn: what is handed over next. The change of the turn is weighed, with that of the values, to be comparable
  !> with what the solves find their unknowns to. Where nothing is handed over nothing changes.
  subroutine advance_exchange(scene, solution, equations, exchange, change)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(equations_t), intent(inout) :: equations
    type(turns_t), intent(inout) :: exchange
    real(wp), intent(inout) :: change   !! largest one of the turn, over DISPL; on return weighed, with that of the values [-]
    real(wp), allocatable :: g(:), x(:), f(:)
    real(wp) :: whole
    integer :: first(2), last(2), k

    if (.not. allocated(exchange%x)) return
    allocate (g, mold=exchange%x)
    call values_of_solution(scene, solution, equations, exchange, g)
    ! contact that begins to know of a point, or knows no more of it
    where (min(g, exchange%x) <= not_handed .and. exchange%largest < huge(1.0_wp)) exchange%x = g
    allocate (f, source=g - exchange%x)
    allocate (x, source=exchange%x)
    first = [1, exchange%nstress + 1]
    last = [exchange%nstress, size(g)]
    if (exchange%nstress > 0) change = change/slack_of_motion
    do k = 1, 2
      if (last(k) < first(k)) cycle
      whole = length_of(g(first(k):last(k)))
      if (exchange%n == 0) exchange%weight(first(k):last(k)) = 1
      if (.not. whole > 0) cycle
      change = max(change, length_of(f(first(k):last(k)))/(slack_of_values(k)*whole))
      if (exchange%n == 0 .and. exchange%nstress > 0) exchange%weight(first(k):last(k)) = 1/whole**2
    end do
    call keep_difference(f, exchange)
    exchange%f = f
    call combine(exchange, x, f)
    x = x + exchange%share*f
    where (exchange%largest < huge(1.0_wp) .and. g > not_handed) x = min(max(x, 0.0_wp), exchange%largest)
    where (exchange%largest < huge(1.0_wp) .and. .not. g > not_handed) x = not_handed
    exchange%by_x(:, 1 + mod(exchange%n, most_differences)) = x - exchange%x
    exchange%x = x
    exchange%n = exchange%n + 1
    call hand_over_values(exchange, equations)
  end subroutine advance_exchange

  !> The difference of f that goes with the last difference of x, which is there since it was handed over.
  pure subroutine keep_difference(f, exchange)
    real(wp), intent(in) :: f(:)   !! (nvalue) as x
    type(turns_t), intent(inout) :: exchange
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
    type(turns_t), intent(in) :: exchange
    real(wp), intent(inout) :: x(:), f(:)   !! (nvalue) as x
    real(wp) :: direction(size(x), most_differences), motion(size(x), most_differences), before, share
    integer :: k, i, m

    m = 0
    do k = exchange%n, max(1, exchange%n - most_differences + 1), -1
      i = 1 + mod(k - 1, most_differences)
      direction(:, m + 1) = exchange%by_f(:, i)
      motion(:, m + 1) = exchange%by_x(:, i)
      before = size_of(exchange%weight, direction(:, m + 1))
      call make_orthogonal(exchange%weight, m, direction, motion)
      share = size_of(exchange%weight, direction(:, m + 1))
      if (.not. share > least_new*before) cycle
      m = m + 1
      direction(:, m) = direction(:, m)/share
      motion(:, m) = motion(:, m)/share
      share = dot_product(exchange%weight*direction(:, m), f)
      f = f - share*direction(:, m)
      x = x - share*motion(:, m)
    end do
  end subroutine combine

  !> Direction m + 1 orthogonal to the first m, and the motion that goes with it.
  pure subroutine make_orthogonal(weight, m, direction, motion)
    real(wp), intent(in) :: weight(:)   !! (nvalue)
    integer, intent(in) :: m
    real(wp), intent(inout) :: direction(:, :), motion(:, :)   !! (nvalue, ndifference) as x
    real(wp) :: share
    integer :: k

    do k = 1, m
      share = dot_product(weight*direction(:, k), direction(:, m + 1))
      direction(:, m + 1) = direction(:, m + 1) - share*direction(:, k)
      motion(:, m + 1) = motion(:, m + 1) - share*motion(:, k)
    end do
  end subroutine make_orthogonal

  !> Root of the weighed sum of squares.
  pure function size_of(weight, values) result(root)
    real(wp), intent(in) :: weight(:), values(:)   !! (nvalue)
    real(wp) :: root

    root = length_of(sqrt(weight)*values)
  end function size_of

  !> The step has ended: drivers follow the stress again.
  subroutine end_exchange(equations, exchange)
    type(equations_t), intent(inout) :: equations
    type(turns_t), intent(inout) :: exchange

    if (.not. allocated(exchange%x)) return
    if (exchange%nstress > 0) call hand_over_stress(exchange%x(:0), equations%drivers)
    call hand_over(exchange%x(:0), equations%drivers)
  end subroutine end_exchange

end module exchange_in_turns
