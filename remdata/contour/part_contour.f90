!> From the old mesh in its present shape, the dies and the ends of contact to the corrected contours of all bodies.
!>
!> Between a beginning and an end of contact the part's contour is replaced by the die's at the depth that carries the pressure.
!> This changes the part's volume slightly; a small uniform displacement of the free sides restores it. Sides with supports, on the
!> axis, in contact, and those that are dies of another body are not moved.
module part_contour
  use axis_nodes, only: limit_depths, put_on_axis
  use body_contact_ends, only: add_body_contact_ends
  use boundary_curves, only: boundary_curve_t, closest_position, joint_point, kind_entry, kind_exit, largest_gap, point_on, &
                             position_t, size_of_boundary
  use boundary_sides, only: find_loops, loop_t, loops_found, shared_by_three
  use contact_ends, only: contact_end_t
  use contact_intervals, only: side_point_t
  use contact_placement, only: contour_options_t, place_contacts
  use contour_assembly, only: assemble_boundary, contact_t
  use contour_laps, only: lap_t
  use folded_sides, only: fold_t, open_folds, own_sides
  use contour_volume, only: shift_sides, volume_inside, volume_of_loop
  use die_closest_points, only: point_on_side
  use errors, only: error_t, exit_bug, fail
  use kinds, only: wp
  use scene, only: axisymmetric, is_solid, scene_t, solid_elements
  use point_contacts, only: point_contact_t
  use refused_laps, only: refuse_laps
  use short_die_arcs, only: drop_short_die_arcs
  use short_free_sides, only: drop_short_grounds, drop_short_sides
  use small_laps, only: cut_small_laps
  use side_tags, only: find_tags, held_nodes, side_tags_t
  use solution, only: present_coordinates, solution_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: contour_options_t, contour_t, contour_report_t, build_contours

  !> Beginning or end of contact.
  type :: contact_limit_t
    integer :: kind = 0   !! `kind_entry` or `kind_exit`
    real(wp) :: point(2) = 0.0_wp   !! [length]
    !> Depth in the die: zero where the part leaves it, but not at a corner of the part [length].
    real(wp) :: depth = 0.0_wp
  end type contact_limit_t

  !> One loop of the old mesh, corrected.
  type :: contour_t
    type(loop_t) :: loop
    type(side_tags_t) :: tags
    type(boundary_curve_t) :: boundary
    !> Contact intervals that were replaced (`arc_t%interval` is their number).
    type(contact_t), allocatable :: contacts(:)
    !> Where contact is at a point.
    type(point_contact_t), allocatable :: points(:)
    !> Area, or volume per radian, inside the old loop and the boundary curve; negative around holes.
    real(wp) :: volume_before = 0.0_wp, volume_after = 0.0_wp
    !> Outward displacement of the free sides [length], and whether it restores the volume.
    real(wp) :: shift = 0.0_wp
    logical :: restored = .true.
    !> Largest distance from an old node of the loop to the boundary curve [length].
    real(wp) :: largest_move = 0.0_wp
    !> Small laps that were cut off.
    type(fold_t), allocatable :: laps(:)
  end type contour_t

  !> Results of the correction for all contours.
  type :: contour_report_t
    type(contact_limit_t), allocatable :: limits(:)
    type(lap_t), allocatable :: laps(:)
    !> Sides of a body that lie on other sides of it, and small laps that were cut off.
    type(fold_t), allocatable :: folds(:)
    !> Moves of the nodes of such sides (2, nnode), where there are any [length].
    real(wp), allocatable :: opened(:, :)
    !> Largest shift and move of all contours; largest relative change of volume of one [length, length, -].
    real(wp) :: largest_shift = 0.0_wp, largest_move = 0.0_wp, volume_error = 0.0_wp
    !> Largest distance from the contours to a kept end of contact as the solver found it, as a share of the contour.
    real(wp) :: off_ends = 0.0_wp
    !> Points of contact with nothing in contact beside them (2, n) [length].
    real(wp), allocatable :: points(:, :)
    !> Small gaps between contact intervals, whose ends are not among the limits.
    integer :: small_gaps = 0
    !> Contact intervals dropped because they run backwards along their die.
    integer :: backward_intervals = 0
  end type contour_report_t

  !> The boundary curve is closed within this share of its size.
  real(wp), parameter :: closed_within = 1.0e-9_wp

  !> The free sides are moved at most so many times, until the volume is the old one to the first of these shares; it is accepted
  !> when it is so to the second.
  integer, parameter :: most_shifts = 8
  real(wp), parameter :: same_volume = 1.0e-14_wp, kept_volume = 1.0e-13_wp

contains

  !> Corrected contours of all loops. `error` reports laps and inconsistent meshes; the report is filled up to the failure.
  subroutine build_contours(scene, solution, ends, options, contours, report, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), intent(in) :: ends(:)   !! (nend) of the checkpoint
    type(contour_options_t), intent(in) :: options
    type(contour_t), allocatable, intent(out) :: contours(:)   !! (ncontour)
    type(contour_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(loop_t), allocatable :: loops(:)
    integer, allocatable :: connectivity(:, :)
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), uncorrected(2, size(scene%mesh%coordinates, 2))
    logical :: held(size(x, 2))
    type(side_point_t), allocatable :: joints(:)
    integer :: status, node, k, i

    uncorrected = present_coordinates(scene, solution)
    x = uncorrected
    call limit_depths(scene, solution, x)
    call open_folds(scene, solution, x, report%folds, report%opened)
    ! what opens folds is taken back on the new mesh: free sides make no room for it
    if (allocated(report%opened)) uncorrected = uncorrected + report%opened
    if (scene%plane_state == axisymmetric) call put_on_axis(x)
    call gather_solids(scene, connectivity)
    call find_loops(connectivity, size(x, 2), loops, status, node)
    allocate (contours(size(loops)), report%limits(0), report%laps(0), report%points(2, 0))
    if (status /= loops_found) then
      call fail(error, exit_bug, 'contour: the side with middle node '//to_text(scene%mesh%labels(node))// &
                trim(merge(' belongs to three elements             ', ' has the same direction in two elements', &
                           status == shared_by_three)))
      return
    end if
    held = held_nodes(scene) .or. repeated_nodes(loops, size(x, 2))
    if (scene%plane_state == axisymmetric) held = held .or. nodes_on_axis(loops, x)
    do k = 1, size(loops)
      contours(k)%loop = loops(k)
      call find_tags(scene, loops(k), x, contours(k)%tags)
      call place_contacts(scene, solution, x, ends, options, contours(k)%loop, contours(k)%tags, contours(k)%contacts, &
                          contours(k)%points, report%backward_intervals)
    end do
    do k = 1, size(loops)
      joints = contours(k)%points%place
      do i = 1, size(loops)
        call add_body_contact_ends(contours(i)%contacts, scene%dies, loops(k), joints)
      end do
      call correct(scene, x, uncorrected, held, options, joints, contours(k))
      call list_limits(contours(k), report%limits)
      do i = 1, size(contours(k)%points)
        report%points = reshape([report%points, contours(k)%points(i)%point], [2, size(report%points, 2) + 1])
      end do
      report%folds = [report%folds, contours(k)%laps]
      report%off_ends = max(report%off_ends, off_ends(contours(k), x)/size_of_boundary(contours(k)%boundary))
      report%small_gaps = report%small_gaps + count([(contours(k)%contacts(i)%interval%small_gap, i=1, size(contours(k)%contacts))])
      if (largest_gap(contours(k)%boundary) > closed_within*size_of_boundary(contours(k)%boundary)) &
        call fail(error, exit_bug, 'contour '//to_text(k)//' is not closed')
      if (allocated(error)) return
    end do
    report%largest_shift = maxval([0.0_wp, abs(contours%shift)])
    report%largest_move = maxval([0.0_wp, contours%largest_move])
    report%volume_error = maxval([0.0_wp, abs(contours%volume_after - contours%volume_before)/abs(contours%volume_before)])
    call refuse_laps(scene, contours%boundary, contours%loop, contours%tags, report%laps, error)
  end subroutine build_contours

  !> Nodes that loops pass more than once: where two of them touch they must not separate.
  pure function repeated_nodes(loops, nnode) result(twice)
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
  end function repeated_nodes

  !> Nodes of the loops at which a contour meets the axis: a shift of the sides must not move them across it.
  pure function nodes_on_axis(loops, x) result(meets)
    type(loop_t), intent(in) :: loops(:)
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) now [length]
    logical :: meets(size(x, 2))
    integer :: k, i

    meets = .false.
    do k = 1, size(loops)
      do i = 1, 2
        meets(loops(k)%sides(i, :)) = .not. x(1, loops(k)%sides(i, :)) > 0
      end do
    end do
  end function nodes_on_axis

  !> Elements of all bodies in one list.
  pure subroutine gather_solids(scene, connectivity)
    type(scene_t), intent(in) :: scene
    integer, allocatable, intent(out) :: connectivity(:, :)
    integer :: g, n

    allocate (connectivity(8, solid_elements(scene)))
    n = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      connectivity(:, n + 1:n + size(scene%groups(g)%connectivity, 2)) = scene%groups(g)%connectivity
      n = n + size(scene%groups(g)%connectivity, 2)
    end do
  end subroutine gather_solids

  !> The boundary curve, and the displacement of the free sides that keeps the volume.
  pure subroutine correct(scene, x, uncorrected, held, options, joints, contour)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)             !! (2, nnode) now, those on the axis limited in depth [length]
    real(wp), intent(in) :: uncorrected(:, :)   !! (2, nnode) now, with folds opened [length]
    logical, intent(in) :: held(:)              !! (nnode) fixed nodes
    type(contour_options_t), intent(in) :: options
    type(side_point_t), intent(in) :: joints(:)   !! (njoint) ends of contact with other bodies
    type(contour_t), intent(inout) :: contour
    real(wp) :: moved(2, size(x, 2))
    logical :: may_move(size(contour%loop%sides, 2)), own(size(may_move)), round
    type(position_t) :: position
    real(wp) :: shift, gain
    logical :: moves
    integer :: k, i

    round = scene%plane_state == axisymmetric
    own = own_sides(scene, contour%tags)
    contour%volume_before = volume_of_loop(contour%loop, uncorrected, round)
    call draw_boundary(x, own, options, joints, contour)
    contour%volume_after = volume_inside(contour%boundary, round)
    if (size(contour%contacts) + size(contour%points) == 0) return
    moved = x
    may_move = .not. (contour%tags%on_axis .or. any(contour%tags%on_die, 1))
    do k = 1, size(contour%contacts)
      associate (interval => contour%contacts(k)%interval)
        do i = min(interval%from%side, interval%found(1)%side), max(interval%to%side, interval%found(2)%side)
          may_move(modulo(i - 1, size(may_move)) + 1) = .false.
        end do
      end associate
    end do
    may_move(contour%points%place%side) = .false.
    ! where the contour follows a die past the end of contact, the rest of a side depends on the position of the side
    do i = 1, most_shifts
      gain = contour%volume_before - contour%volume_after
      if (i > 1 .and. abs(gain) <= same_volume*abs(contour%volume_before)) exit
      call shift_sides(contour%loop, may_move, held, round, gain, moved, shift, moves)
      if (.not. moves) exit
      contour%shift = contour%shift + shift
      call draw_boundary(moved, own, options, joints, contour)
      contour%volume_after = volume_inside(contour%boundary, round)
    end do
    contour%restored = abs(contour%volume_before - contour%volume_after) <= kept_volume*abs(contour%volume_before)
    do k = 1, size(may_move)
      do i = 1, 2
        position = closest_position(contour%boundary, x(:, contour%loop%sides(i, k)))
        contour%largest_move = max(contour%largest_move, &
                                   length_of(point_on(contour%boundary, position) - x(:, contour%loop%sides(i, k))))
      end do
    end do
  end subroutine correct

  !> The boundary curve of a contour with its nodes at x.
  pure subroutine draw_boundary(x, own, options, joints, contour)
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) [length]
    logical, intent(in) :: own(:)     !! (nside) sides that face their own body
    type(contour_options_t), intent(in) :: options
    type(side_point_t), intent(in) :: joints(:)   !! (njoint) ends of contact with other bodies
    type(contour_t), intent(inout) :: contour

    call assemble_boundary(contour%loop, contour%tags, x, options%corner_turn, joints, contour%contacts, contour%boundary)
    if (options%least_free > 0) then
      call drop_short_die_arcs(options%least_free, contour%tags, contour%contacts, contour%boundary)
      call drop_short_sides(options%least_free, contour%tags, contour%contacts, contour%boundary)
      call drop_short_grounds(options%least_free, own, contour%tags, contour%contacts, contour%boundary)
    end if
    contour%laps = [fold_t ::]
    if (options%longest_lap > 0) &
      call cut_small_laps(options%longest_lap, contour%tags, contour%contacts, contour%boundary, contour%laps)
  end subroutine draw_boundary

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
          point = point_on_side(contour%loop, x, contact%interval%found(i))
          off = max(off, length_of(point_on(contour%boundary, closest_position(contour%boundary, point)) - point))
        end do
      end associate
    end do
  end function off_ends

  !> Beginnings and ends of contact of a contour, added to those before.
  pure subroutine list_limits(contour, limits)
    type(contour_t), intent(in) :: contour
    type(contact_limit_t), allocatable, intent(inout) :: limits(:)
    type(contact_limit_t) :: one
    integer :: k

    do k = 1, size(contour%contacts)
      associate (contact => contour%contacts(k), boundary => contour%boundary)
        if (contact%begins) then
          one = contact_limit_t(kind_entry, joint_point(boundary, contact%first), contact%sections(1)%closest_points(1)%d)
          limits = [limits, one]
        end if
        if (contact%ends) then
          associate (section => contact%sections(size(contact%sections)))
            one = contact_limit_t(kind_exit, joint_point(boundary, contact%next), &
                                  section%closest_points(size(section%closest_points))%d)
          end associate
          limits = [limits, one]
        end if
      end associate
    end do
  end subroutine list_limits

end module part_contour
