!> From the old mesh in its present shape, the dies and the ends of contact to the corrected contours of all bodies.
!>
!> Between a beginning and an end of contact the part's contour is replaced by the die's at the depth that carries the pressure
!> (contact_placement, contour_assembly), and the part keeps its volume (volume_correction).
module part_contour
  use axis_nodes, only: limit_depths
  use body_contact_ends, only: add_body_contact_ends
  use boundary_curves, only: closest_position, joint_point, kind_entry, kind_exit, largest_gap, point_on, size_of_boundary
  use boundary_sides, only: find_loops, loop_t, loops_found, shared_by_three
  use contact_ends, only: contact_end_t
  use contact_placement, only: place_contacts
  use corrected_contours, only: contact_limit_t, contour_options_t, contour_report_t, contour_t, some_contours
  use die_closest_points, only: point_on_side
  use errors, only: error_t, exit_bug, fail
  use folded_sides, only: open_folds
  use kinds, only: wp
  use loop_intervals, only: side_point_t
  use placed_walls, only: lay_sides, place_walls, placed_wall_t, put_on_walls
  use refused_laps, only: refuse_laps
  use scene, only: is_solid, scene_t, solid_elements
  use side_tags, only: find_tags, held_nodes
  use solution, only: present_coordinates, solution_t
  use text, only: to_text
  use vectors, only: length_of
  use volume_correction, only: keep_volume
  implicit none
  private
  public :: contour_options_t, build_contours

  !> The boundary curve is closed within this share of its size.
  real(wp), parameter :: closed_within = 1.0e-9_wp

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
    type(placed_wall_t), allocatable :: walls(:)
    integer :: status, node, k, i

    uncorrected = present_coordinates(scene, solution)
    x = uncorrected
    call limit_depths(scene, solution, x)
    call open_folds(scene, solution, x, report%folds, report%opened)
    ! what opens folds is taken back on the new mesh: free sides make no room for it
    if (allocated(report%opened)) uncorrected = uncorrected + report%opened
    call place_walls(scene, uncorrected, walls)
    call put_on_walls(walls, x, nodes_of_walls(walls, size(x, 2)))
    call gather_solids(scene, connectivity)
    call find_loops(connectivity, size(x, 2), loops, status, node)
    allocate (contours(size(loops)), report%limits(0), report%laps(0), report%points(2, 0))
    if (status /= loops_found) then
      call fail(error, exit_bug, 'contour: the side with middle node '//to_text(scene%mesh%labels(node))// &
                trim(merge(' belongs to three elements             ', ' has the same direction in two elements', &
                           status == shared_by_three)))
      return
    end if
    do k = 1, size(loops)
      call lay_sides(walls, loops(k)%sides, nodes_of_walls(walls, size(x, 2)), x)
    end do
    held = held_nodes(scene) .or. repeated_nodes(loops, size(x, 2))
    held = held .or. nodes_on_walls(walls, loops, x)
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
      call keep_volume(scene, x, uncorrected, held, options, joints, contours(k))
      report%folds = [report%folds, contours(k)%laps]
    end do
    call drop_closed_holes(contours)
    do k = 1, size(contours)
      call list_limits(contours(k), report%limits)
      do i = 1, size(contours(k)%points)
        report%points = reshape([report%points, contours(k)%points(i)%point], [2, size(report%points, 2) + 1])
      end do
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

  !> Leave out holes whose sides have met all around: cutting off their laps has left a point of them.
  pure subroutine drop_closed_holes(contours)
    type(contour_t), allocatable, intent(inout) :: contours(:)   !! (ncontour)
    type(contour_t), allocatable :: left(:)
    real(wp) :: extent(size(contours))
    logical :: stays(size(contours))
    integer :: k

    do k = 1, size(contours)
      extent(k) = size_of_boundary(contours(k)%boundary)
    end do
    stays = extent > closed_within*maxval(extent)
    if (all(stays)) return
    allocate (left, source=some_contours(contours, stays))
    call move_alloc(left, contours)
  end subroutine drop_closed_holes

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

  !> Nodes that must not cross each of the walls.
  pure function nodes_of_walls(walls, nnode) result(acts_on)
    type(placed_wall_t), intent(in) :: walls(:)
    integer, intent(in) :: nnode
    logical :: acts_on(nnode, size(walls))
    integer :: k

    do k = 1, size(walls)
      acts_on(:, k) = walls(k)%acts_on
    end do
  end function nodes_of_walls

  !> Nodes of the loops at which a contour meets a wall: a shift of the sides must not move them across it.
  pure function nodes_on_walls(walls, loops, x) result(meets)
    type(placed_wall_t), intent(in) :: walls(:)
    type(loop_t), intent(in) :: loops(:)
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) now [length]
    logical :: meets(size(x, 2))
    integer :: w, k, i

    meets = .false.
    do w = 1, size(walls)
      do k = 1, size(loops)
        do i = 1, 2
          associate (nodes => loops(k)%sides(i, :), wall => walls(w))
            meets(nodes) = meets(nodes) .or. (wall%acts_on(nodes) .and. &
                                              .not. wall%side*(x(wall%component, nodes) - wall%place) > 0)
          end associate
        end do
      end do
    end do
  end function nodes_on_walls

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
