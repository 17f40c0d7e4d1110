!> From the old mesh in its present shape, the dies and the ends of contact to the corrected contours of all bodies.
!>
!> Between a beginning and an end of contact the part's contour is replaced by the die's at the depth that carries the
!> pressure. Contact so moves a little of the part's volume; the free sides give it back by one small shift. Sides with
!> supports, on the axis, in contact, and those that are dies of another body stay where they are.
module part_contour
  use boundary_sides, only: find_loops, loop_t, loops_found, shared_by_three
  use contact_ends, only: contact_end_t
  use contact_knots, only: point_of_spot
  use contact_placement, only: contour_options_t, place_contacts
  use contact_runs, only: spot_t
  use contour_assembly, only: assemble_chain, contact_t
  use contour_chain, only: chain_t, closest_place, joint_point, kind_entry, kind_exit, largest_gap, place_t, point_on, size_of_chain
  use contour_laps, only: find_laps, lap_t
  use contour_volume, only: shift_sides, volume_inside, volume_of_loop
  use errors, only: error_t, exit_bug, exit_no_convergence, fail
  use kinds, only: wp
  use loose_nodes, only: hold_nodes
  use meeting_places, only: add_meeting_places
  use scene, only: axisymmetric, is_solid, scene_t
  use side_tags, only: find_tags, held_nodes, side_tags_t
  use solution, only: solution_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: contour_options_t, contour_t, contour_report_t, contact_limit_t, build_contours

  !> Where contact begins or ends.
  type :: contact_limit_t
    !> `kind_entry` or `kind_exit`, contour, and the stretch that begins there.
    integer :: kind = 0, contour = 0, stretch = 0
    integer :: group = 0, die = 0
    !> The part's parabola: side of the loop, its middle node, place on it.
    integer :: side = 0, middle = 0
    real(wp) :: part_xi = 0.0_wp
    !> The die's parabola, and place on it.
    integer :: piece = 0
    real(wp) :: die_xi = 0.0_wp
    real(wp) :: point(2) = 0.0_wp   !! [length]
    !> Depth in the die: zero where the part leaves it, not so at a corner of the part [length].
    real(wp) :: depth = 0.0_wp
  end type contact_limit_t

  !> One loop of the old mesh, corrected.
  type :: contour_t
    type(loop_t) :: loop
    type(side_tags_t) :: tags
    type(chain_t) :: chain
    !> Runs of contact that were replaced (`stretch_t%run` counts them).
    type(contact_t), allocatable :: contacts(:)
    !> Area, or volume per radian, inside the old loop and the chain; negative around holes.
    real(wp) :: volume_before = 0.0_wp, volume_after = 0.0_wp
    !> Way of the free sides outwards, and whether it restores the volume [length].
    real(wp) :: shift = 0.0_wp
    logical :: restored = .true.
    !> Largest distance from an old node of the loop to the chain [length].
    real(wp) :: largest_move = 0.0_wp
  end type contour_t

  !> What the correction did, all contours together.
  type :: contour_report_t
    type(contact_limit_t), allocatable :: limits(:)
    type(lap_t), allocatable :: laps(:)
    !> Largest shift and move of all contours; largest relative change of volume of one [length, length, -].
    real(wp) :: largest_shift = 0.0_wp, largest_move = 0.0_wp, volume_error = 0.0_wp
    !> Largest distance from the contours to a place where the solver found an end of contact that is kept, a share of the contour.
    real(wp) :: off_ends = 0.0_wp
    !> Pockets between runs, whose ends are not among the limits.
    integer :: pockets = 0
    !> Runs left out because they go backwards along their die.
    integer :: backward_runs = 0
  end type contour_report_t

  !> The chain is closed within this share of its size.
  real(wp), parameter :: closed_within = 1.0e-9_wp

  !> The free sides are shifted so many times at most, until the volume is the old one to the first of these shares; it is kept
  !> when it is so to the second.
  integer, parameter :: most_shifts = 8
  real(wp), parameter :: same_volume = 1.0e-14_wp, kept_volume = 1.0e-13_wp

contains

  !> Corrected contours of all loops. `error` tells laps and meshes whose sides do not fit; the report is filled as far as it
  !> goes.
  subroutine build_contours(scene, solution, ends, options, contours, report, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), intent(in) :: ends(:)           !! of the checkpoint
    type(contour_options_t), intent(in) :: options
    type(contour_t), allocatable, intent(out) :: contours(:)
    type(contour_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(loop_t), allocatable :: loops(:)
    integer, allocatable :: connectivity(:, :)
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), sunk(2, size(scene%mesh%coordinates, 2))
    logical :: held(size(x, 2))
    type(spot_t), allocatable :: places(:)
    integer :: status, node, k, i

    sunk = scene%mesh%coordinates + solution%displacement
    x = sunk
    call hold_nodes(scene, solution, x)
    call gather_solids(scene, connectivity)
    call find_loops(connectivity, size(x, 2), loops, status, node)
    allocate (contours(size(loops)), report%limits(0), report%laps(0))
    if (status /= loops_found) then
      call fail(error, exit_bug, 'contour: the side with middle node '//to_text(scene%mesh%labels(node))// &
                trim(merge(' belongs to three elements       ', ' is walked alike by two elements ', status == shared_by_three)))
      return
    end if
    held = held_nodes(scene) .or. in_two_places(loops, size(x, 2))
    do k = 1, size(loops)
      contours(k)%loop = loops(k)
      call find_tags(scene, loops(k), x, contours(k)%tags)
      call place_contacts(scene, solution, x, ends, options, contours(k)%loop, contours(k)%tags, contours(k)%contacts, &
                          report%backward_runs)
    end do
    do k = 1, size(loops)
      places = [spot_t ::]
      do i = 1, size(loops)
        call add_meeting_places(contours(i)%contacts, scene%dies, loops(k), places)
      end do
      call correct(scene, x, sunk, held, options, places, contours(k))
      call list_limits(k, contours(k), report%limits)
      report%off_ends = max(report%off_ends, off_ends(contours(k), x)/size_of_chain(contours(k)%chain))
      report%pockets = report%pockets + count([(contours(k)%contacts(i)%run%pocket, i=1, size(contours(k)%contacts))])
      if (largest_gap(contours(k)%chain) > closed_within*size_of_chain(contours(k)%chain)) &
        call fail(error, exit_bug, 'contour '//to_text(k)//' is not closed')
      if (allocated(error)) return
    end do
    report%largest_shift = maxval([0.0_wp, abs(contours%shift)])
    report%largest_move = maxval([0.0_wp, contours%largest_move])
    report%volume_error = maxval([0.0_wp, abs(contours%volume_after - contours%volume_before)/abs(contours%volume_before)])
    call refuse_laps(scene, contours, report%laps, error)
  end subroutine build_contours

  !> Nodes that loops pass more than once: where two of them touch they must not come apart.
  pure function in_two_places(loops, nnode) result(twice)
    type(loop_t), intent(in) :: loops(:)
    integer, intent(in) :: nnode
    logical :: twice(nnode), once(nnode)
    integer :: k, i

    once = .false.
    twice = .false.
    do k = 1, size(loops)
      do i = 1, size(loops(k)%sides, 2)
        twice(loops(k)%sides(1, i)) = once(loops(k)%sides(1, i))
        once(loops(k)%sides(1, i)) = .true.
      end do
    end do
  end function in_two_places

  !> Elements of all bodies in one list.
  pure subroutine gather_solids(scene, connectivity)
    type(scene_t), intent(in) :: scene
    integer, allocatable, intent(out) :: connectivity(:, :)
    integer :: g, n

    n = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) n = n + size(scene%groups(g)%connectivity, 2)
    end do
    allocate (connectivity(8, n))
    n = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      connectivity(:, n + 1:n + size(scene%groups(g)%connectivity, 2)) = scene%groups(g)%connectivity
      n = n + size(scene%groups(g)%connectivity, 2)
    end do
  end subroutine gather_solids

  !> The chain, and the shift of the free sides that keeps the volume.
  pure subroutine correct(scene, x, sunk, held, options, places, contour)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :), sunk(:, :)   !! nodes now, and where loose ones are (2, nnode) [length]
    logical, intent(in) :: held(:)   !! nodes that stay where they are
    type(contour_options_t), intent(in) :: options
    type(spot_t), intent(in) :: places(:)   !! where contact with other bodies begins or ends
    type(contour_t), intent(inout) :: contour
    real(wp) :: moved(2, size(x, 2))
    logical :: may_move(size(contour%loop%sides, 2)), round
    type(place_t) :: place
    real(wp) :: shift, gain
    logical :: moves
    integer :: k, i

    round = scene%plane_state == axisymmetric
    contour%volume_before = volume_of_loop(contour%loop, sunk, round)
    call assemble_chain(contour%loop, contour%tags, x, options%corner_turn, places, contour%contacts, contour%chain)
    contour%volume_after = volume_inside(contour%chain, round)
    if (size(contour%contacts) == 0) return
    moved = x
    may_move = .not. (contour%tags%on_axis .or. any(contour%tags%on_die, 1))
    do k = 1, size(contour%contacts)
      associate (run => contour%contacts(k)%run)
        do i = min(run%from%side, run%found(1)%side), max(run%to%side, run%found(2)%side)
          may_move(modulo(i - 1, size(may_move)) + 1) = .false.
        end do
      end associate
    end do
    ! where the contour follows a die beyond the end of contact, what it leaves of a side depends on where the side lies
    do i = 1, most_shifts
      gain = contour%volume_before - contour%volume_after
      if (i > 1 .and. abs(gain) <= same_volume*abs(contour%volume_before)) exit
      call shift_sides(contour%loop, may_move, held, round, gain, moved, shift, moves)
      if (.not. moves) exit
      contour%shift = contour%shift + shift
      call assemble_chain(contour%loop, contour%tags, moved, options%corner_turn, places, contour%contacts, contour%chain)
      contour%volume_after = volume_inside(contour%chain, round)
    end do
    contour%restored = abs(contour%volume_before - contour%volume_after) <= kept_volume*abs(contour%volume_before)
    do k = 1, size(may_move)
      do i = 1, 2
        place = closest_place(contour%chain, x(:, contour%loop%sides(i, k)))
        contour%largest_move = max(contour%largest_move, &
                                   length_of(point_on(contour%chain, place) - x(:, contour%loop%sides(i, k))))
      end do
    end do
  end subroutine correct

  !> Largest distance from a contour to where the solver found ends of contact that are kept [length].
  pure function off_ends(contour, x) result(off)
    type(contour_t), intent(in) :: contour
    real(wp), intent(in) :: x(:, :)
    real(wp) :: off
    real(wp) :: point(2)
    integer :: k, i

    off = 0
    do k = 1, size(contour%contacts)
      associate (contact => contour%contacts(k))
        do i = 1, 2
          if (.not. merge(contact%begins, contact%ends, i == 1)) cycle
          point = point_of_spot(contour%loop, x, contact%run%found(i))
          off = max(off, length_of(point_on(contour%chain, closest_place(contour%chain, point)) - point))
        end do
      end associate
    end do
  end function off_ends

  !> Beginnings and ends of contact of a contour, added to those before.
  pure subroutine list_limits(number, contour, limits)
    integer, intent(in) :: number
    type(contour_t), intent(in) :: contour
    type(contact_limit_t), allocatable, intent(inout) :: limits(:)
    type(contact_limit_t) :: one
    integer :: k

    do k = 1, size(contour%contacts)
      associate (contact => contour%contacts(k))
        if (contact%begins) then
          one = limit_at(contact%run%from%side, contact%run%from%xi, 1)
          limits = [limits, one]
        end if
        if (contact%ends) then
          one = limit_at(contact%run%to%side, contact%run%to%xi, 2)
          limits = [limits, one]
        end if
      end associate
    end do

  contains

    pure function limit_at(side, xi, which) result(limit)
      integer, intent(in) :: side, which
      real(wp), intent(in) :: xi
      type(contact_limit_t) :: limit

      associate (contact => contour%contacts(k))
        limit%kind = merge(kind_entry, kind_exit, which == 1)
        limit%contour = number
        limit%stretch = merge(contact%first, contact%next, which == 1)
        limit%group = contact%run%group
        limit%die = contact%number
        limit%side = modulo(side - 1, size(contour%loop%sides, 2)) + 1
        limit%middle = contour%loop%sides(2, limit%side)
        limit%part_xi = xi
        limit%point = joint_point(contour%chain, limit%stretch)
        associate (section => contact%sections(merge(1, size(contact%sections), which == 1)))
          associate (knot => section%knots(merge(1, size(section%knots), which == 1)))
            limit%piece = knot%piece
            limit%die_xi = knot%xi
            limit%depth = knot%depth
          end associate
        end associate
      end associate
    end function limit_at

  end subroutine list_limits

  !> A contour that crosses itself or another one cannot be meshed.
  subroutine refuse_laps(scene, contours, laps, error)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contours(:)
    type(lap_t), allocatable, intent(inout) :: laps(:)
    type(error_t), allocatable, intent(out) :: error
    type(chain_t) :: chains(size(contours))
    integer, allocatable :: on_die(:, :)
    logical, allocatable :: faces(:, :, :)
    integer :: k, i, g

    allocate (on_die(maxval([1, (size(contours(k)%loop%sides, 2), k=1, size(contours))]), size(contours)), source=0)
    allocate (faces(size(scene%dies), size(on_die, 1), size(contours)), source=.false.)
    do k = 1, size(contours)
      chains(k) = contours(k)%chain
      do i = 1, size(contours(k)%loop%sides, 2)
        on_die(i, k) = findloc(contours(k)%tags%on_die(:, i), .true., 1)
        do g = 1, size(scene%groups)
          if (scene%groups(g)%die > 0 .and. contours(k)%tags%on_group(g, i)) faces(scene%groups(g)%die, i, k) = .true.
        end do
      end do
    end do
    call find_laps(chains, on_die, faces, laps)
    if (size(laps) == 0) return
    call fail(error, exit_no_convergence, 'the contour has '//to_text(size(laps))//' lap'//trim(merge('s', ' ', size(laps) > 1)) &
              //', the first at x = '//to_text(laps(1)%point(1))//', y = '//to_text(laps(1)%point(2)), &
              'remesh earlier, before the sides fold over each other, or let these sides face a die')
  end subroutine refuse_laps

end module part_contour
