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
  use kinds, only: wp
  use pilot_differences, only: between, common_rows, difference, round_off, sample_t, shortening, shortest_steps
  implicit none
  private
  public :: accuracy_law_t, errors_of, measure_laws

  !> Orders in space that are believed: of the stress what a crack leaves at least; of forces, work and motions twice that
  !> (J. Nitsche, Abh. Math. Sem. Hamburg 36 (1971) 9-15); and the order of the stress where it is smooth. Without a third mesh
  !> that of smooth scenes, or that of scenes with contact, flow or phases.
  real(wp), parameter :: least_of_stress = 0.5_wp, least_order = 2*least_of_stress, largest_order = 2.0_wp, &
                         smooth_order = 2.0_wp, rough_order = 1.0_wp
  !> Differences of forces, work and motions may fall by twice the order of the stress where all is smooth, as above; elsewhere
  !> by the largest order that is believed. One that falls faster does so by chance, as where errors change their sign.
  real(wp), parameter :: fastest_smooth = 2*smooth_order, fastest_rough = largest_order

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

  !> Order of two errors, or differences, of meshes that differ by the factor 2.
  elemental function observed_order(coarse, fine, least) result(order)
    real(wp), intent(in) :: coarse, fine, least   !! [-]
    real(wp) :: order

    order = largest_order
    if (fine > round_off .and. coarse > 0) order = min(max(log(coarse/fine)/log(2.0_wp), least), largest_order)
  end function observed_order

  !> Errors in space, in time and of penetration of every quantity.
  pure subroutine errors_of(law, fineness, space, time, depth)
    type(accuracy_law_t), intent(in) :: law
    type(fineness_t), intent(in) :: fineness
    real(wp), intent(out) :: space(:), time(:), depth(:)   !! (nquantity) [-]

    space = law%space*(law%mesh/fineness%mesh)**merge(law%coarse_order, law%order, fineness%mesh < law%mesh)
    time = law%time*fineness%steps**law%time_order
    depth = law%depth*fineness%depth*(law%depth_mesh/fineness%mesh)**law%depth_order
  end subroutine errors_of

end module accuracy_laws
