!> Boundary curves: the contour of a part as a closed sequence of exact arcs.
!>
!> Each arc has its own curve and its own range of xi, so that a position on the contour is an arc and a xi: nothing is deduced from
!> the order of nodes in a list, which annex 2 (fig. 4) shows to fail where contact begins and ends.
module boundary_curves
  use arcs, only: arc_t
  use ascending, only: count_up_to
  use boundary_sides, only: loop_t
  use kinds, only: wp
  use offset_parabolas, only: closest_xi, length_between, point_at, tangent_at, xi_at_length
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: boundary_curve_t, position_t, boundary_of_loop, close_boundary, point_on, turn_at, arc_length_at, &
    position_at_arc_length, closest_position
  public :: boundary_length, is_on_one_piece, largest_gap, joint_after, joint_point, size_of_boundary
  public :: kind_end, kind_corner, kind_entry, kind_exit, kind_joint

  !> Kind of a joint of the contour: end of a parabola, corner where the tangent turns, point where contact begins or ends, or
  !> smooth transition to another set of sides.
  integer, parameter :: kind_end = 2, kind_corner = 3, kind_entry = 4, kind_exit = 5, kind_joint = 6

  type :: boundary_curve_t
    type(arc_t), allocatable :: arcs(:)
    !> Kind of the joint at which each arc begins (n).
    integer, allocatable :: kinds(:)
    !> Arc length from the start of the curve to the end of each arc (0:n) [length].
    real(wp), allocatable :: arc_length(:)
    !> A corner is where the tangent turns by more than this [radian].
    real(wp) :: corner_turn = huge(1.0_wp)
  end type boundary_curve_t

  !> A position on a boundary curve.
  type :: position_t
    integer :: arc = 1
    real(wp) :: xi = -1.0_wp
  end type position_t

contains

  !> The boundary curve of a loop without contact: its sides as they are.
  pure function boundary_of_loop(loop, coordinates, corner_turn) result(boundary)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: coordinates(:, :)   !! of all nodes (2, nnode) [length]
    real(wp), intent(in) :: corner_turn         !! a corner is where the tangent turns by more than this [radian]
    type(boundary_curve_t) :: boundary
    integer :: k

    allocate (boundary%arcs(size(loop%sides, 2)), boundary%kinds(size(loop%sides, 2)))
    do k = 1, size(boundary%arcs)
      boundary%arcs(k)%points = coordinates(:, loop%sides(:, k))
      boundary%arcs(k)%middle = loop%sides(2, k)
      boundary%arcs(k)%side = k
    end do
    boundary%kinds = kind_end
    call close_boundary(corner_turn, boundary)
  end function boundary_of_loop

  !> Corners among the ends and joints, and arc lengths.
  pure subroutine close_boundary(corner_turn, boundary)
    real(wp), intent(in) :: corner_turn   !! [radian]
    type(boundary_curve_t), intent(inout) :: boundary
    integer :: k

    boundary%corner_turn = corner_turn
    if (allocated(boundary%arc_length)) deallocate (boundary%arc_length)
    allocate (boundary%arc_length(0:size(boundary%arcs)))
    boundary%arc_length(0) = 0
    do k = 1, size(boundary%arcs)
      if (any(boundary%kinds(k) == [kind_end, kind_joint]) .and. abs(turn_at(boundary, k)) > corner_turn &
          .and. .not. is_on_one_piece(boundary, k)) boundary%kinds(k) = kind_corner
      associate (s => boundary%arcs(k))
        boundary%arc_length(k) = boundary%arc_length(k - 1) + length_between(s, s%range(1), s%range(2))
      end associate
    end do
  end subroutine close_boundary

  !> Both arcs where arc k begins lie on one piece of a die. They turn there by their depths alone, as where a side has come off the
  !> die between a corner of it and its next node: no corner of the part, which would be kept in place of that of the die beside it.
  pure function is_on_one_piece(boundary, k) result(yes)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    logical :: yes

    associate (before => boundary%arcs(modulo(k - 2, size(boundary%arcs)) + 1), behind => boundary%arcs(k))
      yes = behind%die > 0 .and. before%die == behind%die .and. before%piece == behind%piece
    end associate
  end function is_on_one_piece

  !> Point where arc k begins [length]: a node of the part where one of the two adjacent arcs ends with a whole side.
  pure function joint_point(boundary, k) result(point)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    real(wp) :: point(2)
    integer :: last

    last = merge(size(boundary%arcs), k - 1, k == 1)
    associate (before => boundary%arcs(last), after => boundary%arcs(k))
      if (before%middle > 0 .and. .not. before%range(2) < 1) then
        point = before%points(:, 3)
      else if (after%middle > 0 .and. .not. after%range(1) > -1) then
        point = after%points(:, 1)
      else
        point = point_at(after, after%range(1))
      end if
    end associate
  end function joint_point

  !> Number of the next arc.
  pure function joint_after(boundary, k) result(next)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    integer :: next

    next = mod(k, size(boundary%arcs)) + 1
  end function joint_after

  !> Angle by which the tangent turns where arc k begins, positive to the left [radian].
  pure function turn_at(boundary, k) result(turn)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    real(wp) :: turn
    real(wp) :: before(2), after(2)
    integer :: last

    last = merge(size(boundary%arcs), k - 1, k == 1)
    before = tangent_at(boundary%arcs(last), boundary%arcs(last)%range(2))
    after = tangent_at(boundary%arcs(k), boundary%arcs(k)%range(1))
    turn = atan2(cross(before, after), dot_product(before, after))
  end function turn_at

  pure function point_on(boundary, position) result(point)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: position
    real(wp) :: point(2)

    point = point_at(boundary%arcs(position%arc), position%xi)
  end function point_on

  pure function boundary_length(boundary) result(length)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp) :: length

    length = boundary%arc_length(size(boundary%arcs))
  end function boundary_length

  !> Arc length from the start of the curve [length].
  pure function arc_length_at(boundary, position) result(arc_length)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: position
    real(wp) :: arc_length

    associate (s => boundary%arcs(position%arc))
      arc_length = boundary%arc_length(position%arc - 1) + length_between(s, s%range(1), position%xi)
    end associate
  end function arc_length_at

  !> Position at an arc length from the start, modulo the length of the curve.
  pure function position_at_arc_length(boundary, arc_length) result(position)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: arc_length   !! [length]
    type(position_t) :: position
    real(wp) :: rest
    integer :: before

    rest = modulo(arc_length, boundary_length(boundary))
    before = count_up_to(boundary%arc_length(1:size(boundary%arcs) - 1), rest)
    position%arc = before + 1
    position%xi = xi_at_length(boundary%arcs(before + 1), rest - boundary%arc_length(before))
  end function position_at_arc_length

  !> Position closest to a point; of two equally close ones the first along the curve.
  pure function closest_position(boundary, target) result(position)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: target(2)   !! [length]
    type(position_t) :: position
    real(wp) :: xi, distance, least
    integer :: k

    least = huge(least)
    do k = 1, size(boundary%arcs)
      associate (s => boundary%arcs(k))
        ! no point of an arc is farther from its start than the arc is long
        if (length_of(point_at(s, s%range(1)) - target) - (boundary%arc_length(k) - boundary%arc_length(k - 1)) > least) cycle
        xi = closest_xi(s, target)
        distance = length_of(point_at(s, xi) - target)
      end associate
      if (.not. distance < least) cycle
      least = distance
      position = position_t(k, xi)
    end do
  end function closest_position

  !> Largest gap between an arc and the next one [length].
  pure function largest_gap(boundary) result(gap)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp) :: gap
    integer :: k

    gap = 0
    do k = 1, size(boundary%arcs)
      associate (s => boundary%arcs(k), next => boundary%arcs(joint_after(boundary, k)))
        gap = max(gap, length_of(point_at(next, next%range(1)) - point_at(s, s%range(2))))
      end associate
    end do
  end function largest_gap

  !> Diagonal of the box around the ends and middle points of the arcs [length].
  pure function size_of_boundary(boundary) result(extent)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp) :: extent
    real(wp) :: low(2), high(2), point(2)
    integer :: k, i

    low = huge(low)
    high = -huge(high)
    do k = 1, size(boundary%arcs)
      associate (s => boundary%arcs(k))
        do i = 0, 2
          point = point_at(s, s%range(1) + 0.5_wp*i*(s%range(2) - s%range(1)))
          low = min(low, point)
          high = max(high, point)
        end do
      end associate
    end do
    extent = length_of(high - low)
  end function size_of_boundary

end module boundary_curves
