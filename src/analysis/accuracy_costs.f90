!> Steps, elements and seconds of a run of some fineness, as they grow between its pilots.
module accuracy_costs
  use accuracy_rules, only: fineness_t
  use cost_file, only: ntask
  use kinds, only: wp
  use pilot_differences, only: sample_t, shortest_steps
  use timers, only: ledger_t
  implicit none
  private
  public :: cost_of_elements, elements_of, expected_seconds, seconds_by_task

  !> How seconds go with the number of elements (closing_facts): tasks of elements, contact, factorisation; what is no task,
  !> such as files; and the remesher (its growth is measured by tests/bench/remdata_bench.py).
  real(wp), parameter :: task_exponents(ntask) = [1.0_wp, 0.5_wp, 1.5_wp, 0.0_wp, 1.0_wp]

contains

  !> Seconds and steps of a run, from the pilots. Steps that finer meshes ask for are added to those of shorter lengths. Seconds of
  !> a step are those of the finest pilot by tasks, times what evaluations a step grow from mesh to mesh and with stiffer contact,
  !> and fall with its length.
  pure subroutine expected_seconds(pilots, fineness, elements, seconds, steps)
    type(sample_t), intent(in) :: pilots(:)   !! (npilot)
    type(fineness_t), intent(in) :: fineness
    integer, intent(in) :: elements           !! of the run
    real(wp), intent(out) :: seconds          !! [s]
    integer, intent(out) :: steps
    integer, allocatable :: meshes(:)
    real(wp) :: by_mesh, by_length, growing, fewer, stiffer
    integer :: k, n, longer, shorter

    seconds = 0
    steps = 0
    meshes = pack([(k, k=1, size(pilots))], abs(pilots%fineness%steps - 1) + abs(pilots%fineness%depth - 1) <= 0)
    n = size(meshes)
    if (n == 0) return
    by_mesh = 0
    growing = 0
    if (n > 1) then
      by_mesh = growth(real(pilots(meshes(n - 1))%steps, wp), real(pilots(meshes(n))%steps, wp), 2.0_wp, 1.0_wp)
      growing = growth(per_step(pilots(meshes(n - 1))), per_step(pilots(meshes(n))), 2.0_wp, 0.5_wp)
    end if
    by_length = 1
    fewer = 0
    stiffer = 0
    call shortest_steps(pilots, meshes(1), longer, shorter)
    associate (first => pilots(meshes(1)), finest => pilots(meshes(n)), long => pilots(longer), short => pilots(shorter))
      do k = 1, size(pilots)
        if (pilots(k)%fineness%depth < 1) stiffer = growth(real(first%iterations, wp), real(pilots(k)%iterations, wp), &
                                                          1/pilots(k)%fineness%depth, 0.5_wp)
      end do
      if (shorter /= meshes(1)) then
        by_length = growth(real(long%steps, wp), real(short%steps, wp), long%fineness%steps/short%fineness%steps, 1.2_wp)
        fewer = growth(per_step(short), per_step(long), long%fineness%steps/short%fineness%steps, 0.5_wp)
      end if
      associate (finer => fineness%mesh/finest%fineness%mesh, longer_by => fineness%steps/short%fineness%steps)
        steps = nint(short%steps*longer_by**(-by_length) - first%steps + finest%steps*finer**by_mesh)
        seconds = finer**growing*per_step(short)/per_step(first)*longer_by**fewer*fineness%depth**(-stiffer)*steps/finest%steps &
                  *grown_seconds(finest%seconds, real(elements, wp)/finest%elements)
      end associate
    end associate
  end subroutine expected_seconds

  !> Elements of a run with so many of the deck's along a line: those of the pilot with that mesh, otherwise as they grow between
  !> the two finest ones. Blocks have the square; meshes of contours are finer where sides bend, whatever else is asked, so that
  !> theirs grow by less.
  pure function elements_of(pilots, mesh) result(elements)
    type(sample_t), intent(in) :: pilots(:)   !! (npilot)
    real(wp), intent(in) :: mesh              !! factor of the elements along a line
    integer :: elements
    real(wp) :: exponent
    integer :: k, finest, coarser

    finest = maxloc(pilots%fineness%mesh, 1)
    coarser = 0
    do k = 1, size(pilots)
      if (abs(pilots(k)%fineness%mesh - mesh) <= 0) then
        elements = pilots(k)%elements
        return
      end if
      if (.not. pilots(k)%fineness%mesh < pilots(finest)%fineness%mesh) cycle
      if (coarser == 0) coarser = k
      if (pilots(k)%fineness%mesh > pilots(coarser)%fineness%mesh) coarser = k
    end do
    exponent = 2
    associate (fine => pilots(finest))
      if (coarser > 0) exponent = growth(real(pilots(coarser)%elements, wp), real(fine%elements, wp), &
                                         fine%fineness%mesh/pilots(coarser)%fineness%mesh, 2.0_wp)
      elements = nint(fine%elements*(mesh/fine%fineness%mesh)**exponent)
    end associate
  end function elements_of

  !> Seconds by tasks with so many times the elements, in as many steps and iterations [s].
  pure function grown_seconds(seconds, factor) result(grown)
    real(wp), intent(in) :: seconds(ntask)   !! by tasks [s]
    real(wp), intent(in) :: factor
    real(wp) :: grown

    grown = sum(seconds*factor**task_exponents)
  end function grown_seconds

  !> Time over that of a run with so many times its elements, in as many steps and iterations; 1 where no seconds are known.
  pure function cost_of_elements(seconds, factor) result(cost)
    real(wp), intent(in) :: seconds(ntask)   !! by tasks [s]
    real(wp), intent(in) :: factor
    real(wp) :: cost

    cost = 1
    if (sum(seconds) > 0) cost = grown_seconds(seconds, factor)/sum(seconds)
  end function cost_of_elements

  !> Seconds of what has a timer, by tasks; those of no task and of the remesher have none.
  function seconds_by_task(timers) result(seconds)
    type(ledger_t), intent(in) :: timers
    real(wp) :: seconds(ntask)   !! [s]
    integer :: t, n

    seconds = 0
    do t = 1, timers%size()
      n = 1
      if (timers%name(t) == 'contact') n = 2
      if (timers%name(t) == 'factorisation') n = 3
      seconds(n) = seconds(n) + timers%seconds(t)
    end do
  end function seconds_by_task

  !> Exponent of a growth over a factor, from 0 up to a largest one.
  pure function growth(from, to, factor, largest) result(exponent)
    real(wp), intent(in) :: from, to, factor, largest
    real(wp) :: exponent

    exponent = min(max(log(to/from)/log(factor), 0.0_wp), largest)
  end function growth

  !> Evaluations of a step: one in each iteration, and one before the first, whose matrix the error of its path takes too.
  pure function per_step(sample) result(evaluations)
    type(sample_t), intent(in) :: sample
    real(wp) :: evaluations

    evaluations = 1 + real(max(sample%iterations, 1), wp)/max(sample%steps, 1)
  end function per_step

end module accuracy_costs
