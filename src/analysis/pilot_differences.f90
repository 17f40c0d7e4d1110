!> Runs that differ in their fineness (pilots): how far their results are apart, and which of them differ in their steps.
!>
!> The difference of a quantity between two runs is taken at instants that both have, in the mean square, or at the last of them
!> where that is more, over the range of the quantity.
module pilot_differences
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use accuracy_rules, only: fineness_t
  use cost_file, only: ntask
  use kinds, only: wp
  implicit none
  private
  public :: sample_t, between, common_rows, difference, round_off, shortening, shortest_steps, steps_differ

  !> Where steps hardly change in number, little is seen of their errors: less than this is not believed.
  real(wp), parameter :: least_shortening = 0.25_wp
  !> The errors of two runs tell those of their steps where one has so many times the steps of the other.
  real(wp), parameter :: least_growth = sqrt(2.0_wp)
  !> Differences below this share of the range are round-off.
  real(wp), parameter :: round_off = 1.0e-9_wp
  !> Times are the same when they are this close, over the last one.
  real(wp), parameter :: same_time = 1.0e-9_wp

  !> A run of some fineness: what it cost, and its judged quantities.
  type :: sample_t
    type(fineness_t) :: fineness
    integer :: elements = 0, steps = 0, iterations = 0
    !> Seconds of processor by tasks [s].
    real(wp) :: seconds(ntask) = 0.0_wp
    !> Estimated error of the stress; below 0 where there is none.
    real(wp) :: stress = -1.0_wp
    real(wp), allocatable :: time(:)        !! (nrow) [time]
    real(wp), allocatable :: values(:, :)   !! (ncolumn, nrow) [unit of each column]
  end type sample_t

contains

  !> Difference of each quantity between two runs, over its range.
  pure function difference(a, b, scales) result(d)
    type(sample_t), intent(in) :: a, b
    real(wp), intent(in) :: scales(:)   !! (ncolumn) [unit of each column]
    real(wp) :: d(size(scales))
    real(wp) :: one(size(scales)), last(size(scales))
    integer, allocatable :: rows(:, :)
    integer :: k

    d = 0
    last = 0
    call common_rows(a, b, rows)
    do k = 1, size(rows, 2)
      one = (a%values(:, rows(1, k)) - b%values(:, rows(2, k)))/scales
      ! a cell of another operation has no number
      where (.not. ieee_is_finite(one)) one = 0
      d = d + one**2
      last = abs(one)
    end do
    d = max(sqrt(d/max(size(rows, 2), 1)), last)
    where (d < round_off) d = 0
  end function difference

  !> Rows of two runs at the instants that they have in common.
  pure subroutine common_rows(a, b, rows)
    type(sample_t), intent(in) :: a, b
    integer, allocatable, intent(out) :: rows(:, :)   !! (2, n) of the one and of the other
    integer :: found(2, size(a%time)), i, j, n
    real(wp) :: tolerance

    n = 0
    i = 1
    j = 1
    tolerance = same_time*max(maxval(abs(a%time)), maxval(abs(b%time)))
    do while (i <= size(a%time) .and. j <= size(b%time))
      if (a%time(i) < b%time(j) - tolerance) then
        i = i + 1
      else if (b%time(j) < a%time(i) - tolerance) then
        j = j + 1
      else
        n = n + 1
        found(:, n) = [i, j]
        i = i + 1
        j = j + 1
      end if
    end do
    rows = found(:, :n)
  end subroutine common_rows

  !> Linear between instants; from nothing at the start, constant behind the last.
  pure function between(times, values, time) result(now)
    real(wp), intent(in) :: times(:), time    !! (n) ascending [time]
    real(wp), intent(in) :: values(:, :)      !! (ncolumn, n) [unit of each column]
    real(wp) :: now(size(values, 1))
    real(wp) :: start
    integer :: k

    k = count(times < time) + 1
    if (k > size(times)) then
      now = values(:, size(times))
    else if (k == 1) then
      now = values(:, 1)*max(time, 0.0_wp)/max(times(1), tiny(1.0_wp))
    else
      start = times(k - 1)
      now = values(:, k - 1) + (values(:, k) - values(:, k - 1))*(time - start)/(times(k) - start)
    end if
  end function between

  !> The pilots with the shortest and the next longer steps, on the mesh of the first and with its penetration; the first one where
  !> there is no other. Those whose number of steps hardly differs from that of the shortest are passed over, but the first.
  pure subroutine shortest_steps(pilots, first, longer, shorter)
    type(sample_t), intent(in) :: pilots(:)   !! (npilot)
    integer, intent(in) :: first
    integer, intent(out) :: longer, shorter
    integer :: k

    shorter = first
    do k = 1, size(pilots)
      if (alike(k) .and. pilots(k)%fineness%steps < pilots(shorter)%fineness%steps) shorter = k
    end do
    longer = first
    do k = 1, size(pilots)
      if (alike(k) .and. pilots(k)%fineness%steps < pilots(longer)%fineness%steps &
          .and. steps_differ(pilots(k), pilots(shorter))) longer = k
    end do

  contains

    pure logical function alike(k)
      integer, intent(in) :: k

      alike = abs(pilots(k)%fineness%mesh - pilots(first)%fineness%mesh) + abs(pilots(k)%fineness%depth - 1) <= 0
    end function alike

  end subroutine shortest_steps

  !> The second run has so many more steps that their errors can be seen from the difference. Steps that a largest length does not
  !> limit, as they grow from a short first one or follow instants that are hit, hardly change with it.
  pure logical function steps_differ(coarse, fine)
    type(sample_t), intent(in) :: coarse, fine   !! that differ in the length of their steps

    steps_differ = fine%steps >= least_growth*coarse%steps
  end function steps_differ

  !> How far steps really get shorter when they are asked to be: the exponent of their number over the factor. Instants that are
  !> hit, events and steps that grow from a short first one make them shorter already, so that they change by less.
  pure function shortening(coarse, fine) result(exponent)
    type(sample_t), intent(in) :: coarse, fine   !! that differ in the length of their steps
    real(wp) :: exponent

    exponent = 1
    if (min(coarse%steps, fine%steps) == 0) return
    exponent = log(real(coarse%steps, wp)/fine%steps)/log(fine%fineness%steps/coarse%fineness%steps)
    exponent = min(max(exponent, least_shortening), 1.0_wp)
  end function shortening

end module pilot_differences
