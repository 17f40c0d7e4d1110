!> Runs of contact along a loop: from where contact begins to where it ends, in order.
!>
!> The solver finds the ends group by group (contact_ends). Here they are put in their order along the loop and paired. On
!> the axis a point of contact has no surface and is never found closed: a run whose last point before the axis is closed
!> goes on to it. A run that begins or ends almost in a node that new meshes have too does so in the node: no sliver is left
!> for a mesh to resolve, and the side it was found on is kept still (part_contour), so that the contour goes through both
!> places. Runs of two groups that overlap are cut in the middle of what they share, and one that lies inside another gives way.
!> A run that covers less than a share of one side is left as it is: the part's own contour carries its pressure just as well,
!> and no element would fit.
module contact_runs
  use boundary_sides, only: loop_t
  use contact_ends, only: contact_end_t
  use kinds, only: wp
  use quadrature, only: line_rule
  use scene, only: group_t, scene_t
  use side_tags, only: side_tags_t
  implicit none
  private
  public :: spot_t, run_t, find_runs, along, same_spot, sort_runs, turn_back, is_shared

  !> A place on a loop. Sides are counted on beyond the last one by a run across the start of the loop.
  type :: spot_t
    integer :: side = 0
    real(wp) :: xi = 0.0_wp
    !> Piece of the die there, 0 where it is not known.
    integer :: piece = 0
  end type spot_t

  type :: run_t
    integer :: group = 0
    type(spot_t) :: from, to
    !> Where the solver found the two, which may be a crumb away.
    type(spot_t) :: found(2)
    !> What follows is a pocket: contact with the same die goes on behind it (contact_gaps).
    logical :: pocket = .false.
  end type run_t

  !> Places closer than this, in sides, are one; runs begin and end in a node when they do so within it.
  real(wp), parameter :: same_place = 1.0e-9_wp

contains

  !> Runs of a loop in the order of their beginnings; only the last may go across the start of the loop.
  pure subroutine find_runs(scene, loop, tags, lasting, ends, closed, least, runs)
    type(scene_t), intent(in) :: scene
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    logical, intent(in) :: lasting(:)            !! a new mesh has a node where the side ends, too (nside)
    type(contact_end_t), intent(in) :: ends(:)   !! of all groups
    logical, intent(in) :: closed(:)             !! for each group: some of its points are in contact
    real(wp), intent(in) :: least                !! shortest run that counts, in sides
    type(run_t), allocatable, intent(out) :: runs(:)
    type(run_t) :: list(size(ends) + size(scene%groups))
    integer :: side_at(size(scene%mesh%coordinates, 2)), g, k, n, before

    side_at = 0
    side_at(loop%sides(2, :)) = [(k, k=1, size(loop%sides, 2))]
    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. .not. closed(g)) cycle
      before = n
      call pair_ends(scene%groups(g), g, side_at, size(loop%sides, 2), ends, list, n)
      if (n == before .and. all(tags%on_group(g, :)) .and. all(ends%group /= g)) then
        ! a ring of contact, without end
        n = n + 1
        list(n)%group = g
        list(n)%from = spot_t(1, -1.0_wp)
        list(n)%to = spot_t(size(loop%sides, 2), 1.0_wp)
      end if
      do k = before + 1, n
        call reach_axis(scene%groups(g), tags, size(loop%sides, 2), list(k))
      end do
    end do
    call keep(along(list(:n)%to) - along(list(:n)%from) >= least, list, n)
    do k = 1, n
      list(k)%found = [list(k)%from, list(k)%to]
      call snap(lasting, least, list(k))
    end do
    call sort_runs(list(:n))
    call part_overlaps(size(loop%sides, 2), list, n)
    call keep(along(list(:n)%to) - along(list(:n)%from) >= least, list, n)
    allocate (runs, source=list(:n))
  end subroutine find_runs

  !> Sides from the start of the loop.
  elemental function along(spot) result(s)
    type(spot_t), intent(in) :: spot
    real(wp) :: s

    s = spot%side - 1 + 0.5_wp*(1 + spot%xi)
  end function along

  elemental function same_spot(one, other) result(same)
    type(spot_t), intent(in) :: one, other
    logical :: same

    same = abs(along(one) - along(other)) <= same_place
  end function same_spot

  !> Another run ends where one begins (which = 1), or begins where it ends (2), or a pocket is between them.
  pure function is_shared(runs, k, which, nside) result(shared)
    type(run_t), intent(in) :: runs(:)   !! in their order along the loop
    integer, intent(in) :: k, which, nside
    logical :: shared
    real(wp) :: apart
    integer :: i

    if (which == 1) then
      shared = runs(modulo(k - 2, size(runs)) + 1)%pocket
    else
      shared = runs(k)%pocket
    end if
    do i = 1, size(runs)
      apart = merge(along(runs(k)%from) - along(runs(i)%to), along(runs(i)%from) - along(runs(k)%to), which == 1)
      shared = shared .or. abs(modulo(apart + 0.5_wp, real(nside, wp)) - 0.5_wp) <= same_place
    end do
  end function is_shared

  !> Runs of one group: each beginning goes with the end that follows it around the loop.
  pure subroutine pair_ends(group, number, side_at, nside, ends, list, n)
    type(group_t), intent(in) :: group
    integer, intent(in) :: number, side_at(:), nside
    type(contact_end_t), intent(in) :: ends(:)
    type(run_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    type(spot_t) :: from, to, spot
    integer :: i, j

    do i = 1, size(ends)
      if (ends(i)%group /= number .or. .not. ends(i)%begins) cycle
      from = spot_of(ends(i))
      if (from%side == 0) cycle
      to = spot_t()
      do j = 1, size(ends)
        if (ends(j)%group /= number .or. ends(j)%begins) cycle
        spot = spot_of(ends(j))
        if (spot%side == 0) cycle
        if (along(spot) < along(from) - same_place) spot%side = spot%side + nside
        if (to%side > 0 .and. along(spot) >= along(to)) cycle
        to = spot
      end do
      if (to%side == 0) cycle
      if (from%xi >= 1 - 2*same_place) from = spot_t(from%side + 1, -1.0_wp, from%piece)
      if (to%xi <= -1 + 2*same_place) to = spot_t(to%side - 1, 1.0_wp, to%piece)
      if (from%xi <= -1 + 2*same_place) from%xi = -1
      if (to%xi >= 1 - 2*same_place) to%xi = 1
      if (along(to) <= along(from)) cycle
      n = n + 1
      list(n)%group = number
      list(n)%from = from
      list(n)%to = to
      call turn_back(nside, list(n))
    end do

  contains

    pure function spot_of(one) result(spot)
      type(contact_end_t), intent(in) :: one
      type(spot_t) :: spot

      spot = spot_t(side_at(group%connectivity(2, one%side)), one%place, one%piece)
    end function spot_of

  end subroutine pair_ends

  !> Extend a run over the last part of a side to the axis, where no point with a surface is left.
  pure subroutine reach_axis(group, tags, nside, run)
    type(group_t), intent(in) :: group
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: nside
    type(run_t), intent(inout) :: run
    real(wp), allocatable :: xi(:), weight(:)

    call line_rule(group%npoint, xi, weight)
    if (tags%on_axis(wrapped(run%to%side + 1, nside)) .and. .not. any(xi > run%to%xi .and. xi < 1)) run%to%xi = 1
    if (tags%on_axis(wrapped(run%from%side - 1, nside)) .and. .not. any(xi < run%from%xi .and. xi > -1)) run%from%xi = -1
  end subroutine reach_axis

  !> Move ends of a run to lasting nodes that are nearer than `least`.
  pure subroutine snap(lasting, least, run)
    logical, intent(in) :: lasting(:)
    real(wp), intent(in) :: least   !! [sides]
    type(run_t), intent(inout) :: run

    if (run%from%xi > 1 - 2*least .and. lasts(run%from%side)) then
      run%from = spot_t(run%from%side + 1, -1.0_wp, run%from%piece)
    else if (run%from%xi < -1 + 2*least .and. lasts(run%from%side - 1)) then
      run%from%xi = -1
    end if
    if (run%to%xi < -1 + 2*least .and. lasts(run%to%side - 1)) then
      run%to = spot_t(run%to%side - 1, 1.0_wp, run%to%piece)
    else if (run%to%xi > 1 - 2*least .and. lasts(run%to%side)) then
      run%to%xi = 1
    end if
    call turn_back(size(lasting), run)

  contains

    pure function lasts(side) result(yes)
      integer, intent(in) :: side
      logical :: yes

      yes = lasting(wrapped(side, size(lasting)))
    end function lasts

  end subroutine snap

  !> Count sides from the first one where a run begins beyond the last.
  elemental subroutine turn_back(nside, run)
    integer, intent(in) :: nside
    type(run_t), intent(inout) :: run

    if (run%from%side <= nside) return
    run%from%side = run%from%side - nside
    run%to%side = run%to%side - nside
    run%found%side = run%found%side - nside
  end subroutine turn_back

  !> Number of a side that is counted on around the loop.
  pure function wrapped(side, nside) result(k)
    integer, intent(in) :: side, nside
    integer :: k

    k = modulo(side - 1, nside) + 1
  end function wrapped

  pure subroutine keep(which, list, n)
    logical, intent(in) :: which(:)
    type(run_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    integer :: k, kept

    kept = 0
    do k = 1, n
      if (.not. which(k)) cycle
      kept = kept + 1
      list(kept) = list(k)
    end do
    n = kept
  end subroutine keep

  !> By their beginnings; of two that begin together the longer comes first. There are few: by insertion.
  pure subroutine sort_runs(runs)
    type(run_t), intent(inout) :: runs(:)
    type(run_t) :: one
    integer :: i, k

    do i = 2, size(runs)
      one = runs(i)
      do k = i - 1, 1, -1
        if (along(runs(k)%from) < along(one%from) .or. same_spot(runs(k)%from, one%from) &
            .and. along(runs(k)%to) >= along(one%to)) exit
        runs(k + 1) = runs(k)
      end do
      runs(k + 1) = one
    end do
  end subroutine sort_runs

  !> Make runs stand one after the other around the loop.
  pure subroutine part_overlaps(nside, list, n)
    integer, intent(in) :: nside
    type(run_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    logical :: stays(n)
    integer :: i, k

    stays = .true.
    do i = 1, n
      do k = 1, n
        if (i == k .or. .not. (stays(i) .and. stays(k))) cycle
        call part_two(list(i), list(k), stays(k))
      end do
    end do
    call keep(stays, list, n)
    call turn_back(nside, list(:n))
    call sort_runs(list(:n))

  contains

    !> What `next` shares with `run`, which begins before it, is halved.
    pure subroutine part_two(run, next, stays)
      type(run_t), intent(inout) :: run, next
      logical, intent(inout) :: stays
      real(wp) :: middle
      integer :: turn

      do turn = 0, nside, nside
        associate (begins => along(next%from) + turn, ends => along(next%to) + turn)
          if (begins < along(run%from) - same_place .or. begins >= along(run%to) - same_place) cycle
          if (ends <= along(run%to) + same_place) then
            stays = .false.
            return
          end if
          middle = 0.5_wp*(begins + along(run%to))
          run%to = spot_at(middle)
          run%found(2) = run%to
          next%from = spot_at(middle - turn)
          next%found(1) = next%from
        end associate
      end do
    end subroutine part_two

    pure function spot_at(s) result(spot)
      real(wp), intent(in) :: s
      type(spot_t) :: spot

      spot%side = floor(s) + 1
      spot%xi = 2*(s - floor(s)) - 1
    end function spot_at

  end subroutine part_overlaps

end module contact_runs
