!> Gaps between two runs of contact with one die that are too narrow for a contour of their own.
!>
!> Behind a side that folds onto a die, or where points chatter, contact opens by less than the solver's own depth. Two runs
!> with such a gap between them become one: the contour keeps its distance from the die there (a depth below zero), but no
!> beginning and no end of contact is left for a mesh to resolve. A pocket is wider but as short as an element or two, as a coarse
!> side leaves where it folds: it keeps its shape, and its ends are none for the mesh either.
module contact_gaps
  use boundary_sides, only: loop_t
  use contact_knots, only: find_knot, point_of_spot
  use contact_runs, only: along, run_t, same_spot, sort_runs, spot_t, turn_back
  use contact_stretches, only: knot_t
  use dies, only: die_t, present_die
  use kinds, only: wp
  use scene, only: scene_t
  use side_tags, only: side_tags_t
  use solution, only: solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: close_gaps, mark_pockets

  !> Places of a side that are looked at.
  real(wp), parameter :: places(5) = [-1.0_wp, -0.5_wp, 0.0_wp, 0.5_wp, 1.0_wp]

contains

  pure subroutine close_gaps(scene, solution, loop, tags, x, widest, runs)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)                       !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: widest                        !! gap that is closed, share of the side
    type(run_t), allocatable, intent(inout) :: runs(:)    !! in their order along the loop
    integer :: into(size(runs)), i, next, n, nside
    logical :: stays
    type(run_t), allocatable :: list(:)

    if (size(runs) < 2) return
    n = size(runs)
    nside = size(loop%sides, 2)
    into = 0
    do i = 1, n
      ! the run that has taken the next one's place, if that was joined already
      next = mod(i, n) + 1
      do while (into(next) > 0)
        next = into(next)
      end do
      if (next == i .or. scene%groups(runs(i)%group)%die /= scene%groups(runs(next)%group)%die) cycle
      if (.not. is_narrow(scene, solution, loop, x, widest, runs(i), begins_after(runs(i), runs(next), nside))) cycle
      call join_runs(tags, nside, runs(i), runs(next), stays)
      if (.not. stays) into(i) = next
    end do
    allocate (list, source=pack(runs, into == 0))
    call move_alloc(list, runs)
    call turn_back(nside, runs)
    call sort_runs(runs)
  end subroutine close_gaps

  !> Mark runs that a pocket follows.
  pure subroutine mark_pockets(scene, solution, loop, x, widest, longest, runs)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)            !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: widest, longest    !! width, share of the side, and length, in sides
    type(run_t), intent(inout) :: runs(:)      !! in their order along the loop
    type(spot_t) :: until
    integer :: i, next

    do i = 1, size(runs)
      next = mod(i, size(runs)) + 1
      if (next == i .or. scene%groups(runs(i)%group)%die /= scene%groups(runs(next)%group)%die) cycle
      until = begins_after(runs(i), runs(next), size(loop%sides, 2))
      if (same_spot(until, runs(i)%to) .or. along(until) - along(runs(i)%to) > longest) cycle
      runs(i)%pocket = is_narrow(scene, solution, loop, x, widest, runs(i), until)
    end do
  end subroutine mark_pockets

  !> Where the next run begins, counted on from the end of a run.
  pure function begins_after(run, next, nside) result(spot)
    type(run_t), intent(in) :: run, next
    integer, intent(in) :: nside
    type(spot_t) :: spot

    spot = next%from
    if (along(spot) < along(run%to)) spot%side = spot%side + nside
  end function begins_after

  !> The part is near the die all the way between a run and the next one.
  pure function is_narrow(scene, solution, loop, x, widest, run, until) result(narrow)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :), widest
    type(run_t), intent(in) :: run
    type(spot_t), intent(in) :: until
    logical :: narrow
    type(die_t) :: die
    type(knot_t) :: knot
    type(spot_t) :: spot
    logical :: sound
    real(wp) :: chord
    integer :: k, i, side, number

    narrow = .true.
    number = scene%groups(run%group)%die
    die = present_die(scene%dies(number), x)
    associate (pilot => solution%pilots(:, number))
      do k = run%to%side, until%side
        side = modulo(k - 1, size(loop%sides, 2)) + 1
        chord = length_of(x(:, loop%sides(3, side)) - x(:, loop%sides(1, side)))
        do i = 1, size(places)
          spot = spot_t(k, places(i))
          if (along(spot) <= along(run%to) .or. along(spot) >= along(until)) cycle
          call find_knot(die, pilot, point_of_spot(loop, x, spot), [1, size(die%pieces, 3)], .true., knot, sound)
          narrow = narrow .and. sound .and. abs(knot%depth) <= widest*chord
          if (.not. narrow) return
        end do
      end do
    end associate
  end function is_narrow

  !> Join two runs: into the second one when they are of one group, else they meet where the group of the first one ends.
  pure subroutine join_runs(tags, nside, run, next, stays)
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: nside
    type(run_t), intent(inout) :: run, next
    logical, intent(out) :: stays   !! the first one
    type(spot_t) :: until
    integer :: k, last, side

    stays = .true.
    until = begins_after(run, next, nside)
    last = run%to%side
    do k = run%to%side + 1, until%side
      side = modulo(k - 1, nside) + 1
      if (k == until%side .and. until%xi <= -1) exit
      if (last == k - 1 .and. tags%on_group(run%group, side)) then
        last = k
      else if (.not. tags%on_group(next%group, side)) then
        return
      end if
    end do
    if (run%group == next%group) then
      if (last < until%side - merge(1, 0, until%xi <= -1)) return
      next%to%side = next%to%side + until%side - next%from%side
      next%found(2)%side = next%found(2)%side + until%side - next%from%side
      next%from = run%from
      next%found(1) = run%found(1)
      stays = .false.
    else if (last < until%side) then
      run%to = spot_t(last, 1.0_wp)
      run%found(2) = run%to
      next%from = spot_t(modulo(last, nside) + 1, -1.0_wp)
      next%found(1) = next%from
      if (next%from%side > next%to%side) then
        next%to%side = next%to%side + nside
        next%found(2)%side = next%found(2)%side + nside
      end if
    end if
  end subroutine join_runs

end module contact_gaps
