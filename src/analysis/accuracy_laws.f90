!> How the errors of a scene fall with its mesh, its steps and its penetrations, measured by runs that differ in one of them
!> (pilots), and the cheapest fineness for an accuracy.
!>
!> Error of a quantity in a run: its difference to the exact one at instants that runs have in common, in the mean square, or at
!> the last of them where that is more, over the range of the quantity. With errors of order q in the size of the elements, two
!> runs whose elements differ by the factor 2 differ by D = E (2^q - 1), E the error of the finer one (L.F. Richardson, Phil.
!> Trans. R. Soc. A 210 (1911) 307-357); a third mesh gives q. Errors in time are of the order of the scheme in the length
!> that steps have, those of the penetration of order 1, as it is the pressure over the penalty. Of a quantity the three are added,
!> as if they had one sign.
!>
!> A penetration that is allowed as a share of the element's side falls with the mesh: twice as many elements along a line halve it.
!> What it adds to the values is taken away from them before meshes are compared; otherwise every difference of two meshes
!> would be of order 1, however fast the errors of the elements fall.
module accuracy_laws
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use accuracy_rules, only: fineness_t
  use cost_file, only: ntask
  use kinds, only: wp
  implicit none
  private
  public :: accuracy_law_t, sample_t, asked_for, choose_fineness, difference, errors_of, measure_laws
  public :: shortest_steps, steps_differ

  !> Orders in space that are believed: of the stress what a crack leaves at least; of forces, work and motions twice that
  !> (J. Nitsche, Abh. Math. Sem. Hamburg 36 (1971) 9-15); and the order of the stress where it is smooth. Without a third mesh
  !> that of smooth scenes, or that of scenes with contact, flow or phases.
  real(wp), parameter :: least_of_stress = 0.5_wp, least_order = 2*least_of_stress, largest_order = 2.0_wp, &
                         smooth_order = 2.0_wp, rough_order = 1.0_wp
  !> Differences of forces, work and motions may fall by twice the order of the stress where all is smooth, as above; elsewhere
  !> by the largest order that is believed. One that falls faster does so by chance, as where errors change their sign.
  real(wp), parameter :: fastest_smooth = 2*smooth_order, fastest_rough = largest_order
  !> Where steps hardly change in number, little is seen of their errors: less than this is not believed.
  real(wp), parameter :: least_shortening = 0.25_wp
  !> The errors of two runs tell those of their steps where one has so many times the steps of the other.
  real(wp), parameter :: least_growth = sqrt(2.0_wp)
  !> Differences below this share of the range are round-off.
  real(wp), parameter :: round_off = 1.0e-9_wp
  !> Times are the same when they are this close, over the last one.
  real(wp), parameter :: same_time = 1.0e-9_wp
  !> Share of what is asked that is used up, so that what the laws miss has room; and of that by penetration.
  real(wp), parameter :: used_share = 0.7_wp, depth_share = 0.35_wp
  !> Least factors of penetration and steps, largest of the mesh.
  real(wp), parameter :: least_depth = 1/64.0_wp, least_steps = 1/256.0_wp
  integer, parameter :: largest_mesh = 64
  !> Time over elements along a line, for the choice between mesh and steps: between loops (2) and factorisations (3).
  real(wp), parameter :: cost_exponent = 2.4_wp

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

  !> Errors of each quantity over its range.
  type :: accuracy_law_t
    !> On the finest mesh among the pilots, which has so many times the elements of the deck along a line.
    real(wp) :: mesh = 1.0_wp
    real(wp), allocatable :: space(:), order(:)   !! (nquantity) [-]
    !> Order between the two finest meshes, for meshes that are coarser than the finest.
    real(wp), allocatable :: coarse_order(:)      !! (nquantity) [-]
    !> With the steps and the penetrations of the deck.
    real(wp), allocatable :: time(:), depth(:)    !! (nquantity) [-]
    !> The latter on a mesh with so many times the elements of the deck along a line, and its order in the size of the elements.
    real(wp) :: depth_mesh = 1.0_wp, depth_order = 0.0_wp
    !> Over the factor that is asked of the lengths of steps.
    real(wp) :: time_order = 1.0_wp
    !> The order in space was measured by three meshes; there are two meshes at all.
    logical :: order_measured = .false., space_known = .false.
    !> Differences between the three meshes fall more slowly than errors of the least order that is believed, or grow: the meshes
    !> are too coarse to show how errors fall.
    logical, allocatable :: hidden(:)             !! (nquantity)
  end type accuracy_law_t

contains

  !> Of quantities whose ranges are known. Pilots are ordered by their mesh where they differ in that alone.
  pure subroutine measure_laws(runs, scales, with_stress, smooth, of_sides, time_order, law)
    type(sample_t), intent(in) :: runs(:)     !! (npilot)
    real(wp), intent(in) :: scales(:)         !! (ncolumn) [unit of each column]
    logical, intent(in) :: with_stress        !! the error of the stress is the last quantity
    logical, intent(in) :: smooth             !! no contact, flow or phases
    logical, intent(in) :: of_sides           !! penetrations are allowed as shares of the sides of elements
    real(wp), intent(in) :: time_order        !! of the errors in time
    type(accuracy_law_t), intent(out) :: law
    type(sample_t) :: pilots(size(runs))
    integer, allocatable :: meshes(:)
    real(wp) :: now(size(scales)), before(size(scales))
    integer :: k, n, first, longer, shorter

    n = size(scales) + merge(1, 0, with_stress)
    allocate (law%space(n), law%time(n), law%depth(n), source=0.0_wp)
    allocate (law%hidden(n), source=.false.)
    allocate (law%order(n), source=merge(smooth_order, rough_order, smooth))
    allocate (law%coarse_order, source=law%order)
    law%time_order = time_order
    pilots = runs
    meshes = pack([(k, k=1, size(pilots))], abs(pilots%fineness%steps - 1) + abs(pilots%fineness%depth - 1) <= 0)
    if (size(meshes) == 0) return
    first = meshes(1)
    law%depth_mesh = pilots(first)%fineness%mesh
    if (of_sides) law%depth_order = 1
    if (of_sides) call take_away_depth(runs, first, pilots)
    law%mesh = pilots(meshes(size(meshes)))%fineness%mesh
    law%space_known = size(meshes) > 1
    law%order_measured = size(meshes) > 2
    n = size(scales)
    if (law%space_known) then
      now = difference(pilots(meshes(size(meshes) - 1)), pilots(meshes(size(meshes))), scales)
      if (law%order_measured) then
        before = difference(pilots(meshes(size(meshes) - 2)), pilots(meshes(size(meshes) - 1)), scales)
        now = max(now, before/2**merge(fastest_smooth, fastest_rough, smooth))
        law%hidden(:n) = now > round_off .and. now > before/2**least_order
        law%order(:n) = observed_order(before, now, least_order)
        law%coarse_order(:n) = law%order(:n)
      end if
      law%space(:n) = now/(2**law%order(:n) - 1)
      if (with_stress) then
        law%space(n + 1) = pilots(meshes(size(meshes)))%stress
        law%order(n + 1) = observed_order(pilots(meshes(size(meshes) - 1))%stress, law%space(n + 1), least_of_stress)
        law%coarse_order(n + 1) = max(log(pilots(meshes(size(meshes) - 1))%stress/law%space(n + 1))/log(2.0_wp), 0.0_wp)
      end if
    else if (with_stress) then
      law%space(n + 1) = pilots(first)%stress
    end if
    do k = 1, size(pilots)
      associate (other => pilots(k)%fineness)
        if (abs(other%mesh - pilots(first)%fineness%mesh) > 0) cycle
        if (other%depth < 1) law%depth(:n) = difference(runs(first), runs(k), scales)/(1 - other%depth)
      end associate
    end do
    call shortest_steps(pilots, first, longer, shorter)
    if (shorter == first) return
    law%time_order = time_order*shortening(pilots(longer), pilots(shorter))
    law%time(:n) = difference(pilots(longer), pilots(shorter), scales) &
                   /(pilots(longer)%fineness%steps**law%time_order - pilots(shorter)%fineness%steps**law%time_order)
  end subroutine measure_laws

  !> Values of runs as they would be without penetration: what a quarter of it changes on the mesh of the first, at instants that
  !> both runs have, linear between them; over the factor of the elements along a line on other meshes.
  pure subroutine take_away_depth(runs, first, pilots)
    type(sample_t), intent(in) :: runs(:)         !! (npilot)
    integer, intent(in) :: first
    type(sample_t), intent(inout) :: pilots(:)    !! (npilot)
    real(wp), allocatable :: times(:), effect(:, :), now(:)
    integer, allocatable :: rows(:, :)
    integer :: stiff, k, i

    stiff = 0
    do k = 1, size(runs)
      if (runs(k)%fineness%depth < 1 .and. abs(runs(k)%fineness%mesh - runs(first)%fineness%mesh) <= 0) stiff = k
    end do
    if (stiff == 0) return
    call common_rows(runs(first), runs(stiff), rows)
    if (size(rows, 2) == 0) return
    times = runs(first)%time(rows(1, :))
    effect = (runs(first)%values(:, rows(1, :)) - runs(stiff)%values(:, rows(2, :)))/(1 - runs(stiff)%fineness%depth)
    ! a cell of another operation has no number
    where (.not. ieee_is_finite(effect)) effect = 0
    do k = 1, size(pilots)
      associate (fineness => runs(k)%fineness, values => pilots(k)%values)
        do i = 1, size(values, 2)
          now = between(times, effect, runs(k)%time(i))
          values(:, i) = values(:, i) - now*fineness%depth*runs(first)%fineness%mesh/fineness%mesh
        end do
      end associate
    end do
  end subroutine take_away_depth

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

  !> Order of two errors, or differences, of meshes that differ by the factor 2.
  elemental function observed_order(coarse, fine, least) result(order)
    real(wp), intent(in) :: coarse, fine, least   !! [-]
    real(wp) :: order

    order = largest_order
    if (fine > round_off .and. coarse > 0) order = min(max(log(coarse/fine)/log(2.0_wp), least), largest_order)
  end function observed_order

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

  !> Errors in space, in time and of penetration of every quantity.
  pure subroutine errors_of(law, fineness, space, time, depth)
    type(accuracy_law_t), intent(in) :: law
    type(fineness_t), intent(in) :: fineness
    real(wp), intent(out) :: space(:), time(:), depth(:)   !! (nquantity) [-]

    space = law%space*(law%mesh/fineness%mesh)**merge(law%coarse_order, law%order, fineness%mesh < law%mesh)
    time = law%time*fineness%steps**law%time_order
    depth = law%depth*fineness%depth*(law%depth_mesh/fineness%mesh)**law%depth_order
  end subroutine errors_of

  !> What would have to be asked for an error to be expected.
  pure function asked_for(error) result(asked)
    real(wp), intent(in) :: error   !! [-]
    real(wp) :: asked

    asked = error/used_share
  end function asked_for

  !> The cheapest fineness whose errors are below what is asked; never coarser than the deck, nor than the third mesh where one
  !> was needed: steps that a scene chooses by itself differ from mesh to mesh, and their errors may hide those of the mesh.
  !> `met` is false where none is found: then the mesh is that of the finest pilot, with steps as if half of what is asked were left
  !> for them.
  pure subroutine choose_fineness(law, asked, divisible, fineness, met, parts)
    type(accuracy_law_t), intent(in) :: law
    real(wp), intent(in) :: asked         !! [-]
    logical, intent(in) :: divisible      !! the mesh can be made finer
    type(fineness_t), intent(out) :: fineness
    logical, intent(out) :: met
    integer, intent(in), optional :: parts   !! factors of the mesh are whole over this (default: whole)
    real(wp), dimension(size(law%space)) :: space, time, depth
    type(fineness_t) :: trial
    real(wp) :: left, cost, least
    integer :: m, k, coarsest, over

    met = .false.
    least = huge(least)
    over = 1
    if (present(parts)) over = parts
    coarsest = over
    if (law%order_measured) coarsest = nint(max(law%mesh, 1.0_wp))*over
    do m = coarsest, merge(largest_mesh*over, coarsest, divisible)
      trial = fineness_t(real(m, wp)/over, 1.0_wp, 1.0_wp)
      trial%depth = depth_within(law, trial, asked)
      call errors_of(law, trial, space, time, depth)
      do k = 1, size(space)
        left = used_share*asked - space(k) - depth(k)
        if (.not. left > 0) exit
        if (time(k) > left) trial%steps = min(trial%steps, (left/time(k))**(1/law%time_order))
      end do
      if (k <= size(space) .or. trial%steps < least_steps) cycle
      cost = trial%mesh**cost_exponent/trial%steps
      if (met .and. .not. cost < least) cycle
      least = cost
      fineness = trial
      met = .true.
    end do
    if (met) return
    fineness = fineness_t(max(law%mesh, 1.0_wp), 1.0_wp, 1.0_wp)
    fineness%depth = depth_within(law, fineness, asked)
    call errors_of(law, fineness, space, time, depth)
    left = used_share*asked/2
    if (maxval(time) > left) fineness%steps = max((left/maxval(time))**(1/law%time_order), least_steps)
  end subroutine choose_fineness

  !> Factor of the penetration that leaves its share of what is asked, on the mesh of a fineness.
  pure function depth_within(law, fineness, asked) result(factor)
    type(accuracy_law_t), intent(in) :: law
    type(fineness_t), intent(in) :: fineness   !! with penetrations as the deck has them
    real(wp), intent(in) :: asked              !! [-]
    real(wp) :: factor
    real(wp), dimension(size(law%space)) :: space, time, depth

    call errors_of(law, fineness, space, time, depth)
    factor = 1
    if (maxval(depth) > depth_share*used_share*asked) factor = max(depth_share*used_share*asked/maxval(depth), least_depth)
  end function depth_within

end module accuracy_laws
