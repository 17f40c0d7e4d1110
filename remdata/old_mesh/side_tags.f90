!> Tags of each side of a loop: the sets it belongs to, the elements and supports on it, whether it may move.
!>
!> A side is identified by its middle node. A new mesh creates the same sets, contact elements, pressures and supports on the arcs
!> that replace a side (`arc_t%side`).
module side_tags
  use boundary_curves, only: boundary_curve_t, boundary_of_loop, joint_after, kind_corner
  use boundary_sides, only: loop_t
  use dies, only: is_deformable
  use kinds, only: wp
  use placed_walls, only: place_walls, placed_wall_t
  use scene, only: axisymmetric, scene_t
  implicit none
  private
  public :: side_tags_t, find_tags, same_supports, same_tags, held_nodes, kept_corners

  !> Numbers are those of the scene's lists.
  type :: side_tags_t
    logical, allocatable :: on_set(:, :)        !! of sides (nset, nside)
    logical, allocatable :: on_group(:, :)      !! elements of 3 nodes (ngroup, nside)
    logical, allocatable :: on_fixation(:, :)   !! (nfixation, nside)
    logical, allocatable :: on_die(:, :)        !! deformable dies that the side is a piece of (ndie, nside)
    logical, allocatable :: on_axis(:)          !! (nside)
    logical, allocatable :: on_wall(:)          !! free ones on a wall, the axis or another (nside)
  end type side_tags_t

  !> A radius, or a distance from a wall, below this share of the largest one is zero.
  real(wp), parameter :: no_radius = 1.0e-9_wp

contains

  pure subroutine find_tags(scene, loop, x, tags)
    type(scene_t), intent(in) :: scene
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    type(side_tags_t), intent(out) :: tags
    type(placed_wall_t), allocatable :: walls(:)
    integer :: side_at(size(x, 2)), n, k, w

    n = size(loop%sides, 2)
    side_at = 0
    side_at(loop%sides(2, :)) = [(k, k=1, n)]
    allocate (tags%on_set(size(scene%mesh%sides), n), tags%on_group(size(scene%groups), n), &
              tags%on_fixation(size(scene%fixations), n), tags%on_die(size(scene%dies), n), source=.false.)
    allocate (tags%on_axis(n), tags%on_wall(n), source=.false.)
    do k = 1, size(scene%mesh%sides)
      call mark(scene%mesh%sides(k)%nodes(2, :), tags%on_set(k, :))
    end do
    do k = 1, size(scene%groups)
      if (size(scene%groups(k)%connectivity, 1) == 3) call mark(scene%groups(k)%connectivity(2, :), tags%on_group(k, :))
    end do
    do k = 1, size(scene%fixations)
      call mark(scene%fixations(k)%nodes, tags%on_fixation(k, :))
    end do
    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) call mark(scene%dies(k)%nodes(2, :), tags%on_die(k, :))
    end do
    if (scene%plane_state == axisymmetric) then
      do k = 1, n
        tags%on_axis(k) = all(abs(x(1, loop%sides(:, k))) <= no_radius*maxval(abs(x(1, loop%sides(2, :)))))
      end do
    end if
    tags%on_wall = tags%on_axis
    call place_walls(scene, x, walls)
    do w = 1, size(walls)
      if (walls(w)%number == 0 .or. .not. walls(w)%acts_on(loop%sides(1, 1))) cycle
      associate (d => abs(x(walls(w)%component, :) - walls(w)%place))
        do k = 1, n
          tags%on_wall(k) = tags%on_wall(k) .or. (.not. any(tags%on_fixation(:, k)) .and. &
                                                  all(d(loop%sides(:, k)) <= no_radius*maxval(d(loop%sides(2, :)))))
        end do
      end associate
    end do

  contains

    pure subroutine mark(middles, on)
      integer, intent(in) :: middles(:)
      logical, intent(inout) :: on(:)
      integer :: i

      do i = 1, size(middles)
        if (side_at(middles(i)) > 0) on(side_at(middles(i))) = .true.
      end do
    end subroutine mark

  end subroutine find_tags

  !> Two sides are of the same sets, elements, supports and dies.
  pure function same_tags(tags, one, other) result(same)
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: one, other
    logical :: same

    same = all(tags%on_set(:, one) .eqv. tags%on_set(:, other)) .and. &
           all(tags%on_group(:, one) .eqv. tags%on_group(:, other)) .and. same_supports(tags, one, other)
  end function same_tags

  !> Two sides have the same supports, are pieces of the same deformable dies, and both lie on a wall or neither does.
  pure function same_supports(tags, one, other) result(same)
    type(side_tags_t), intent(in) :: tags
    integer, intent(in) :: one, other
    logical :: same

    same = all(tags%on_fixation(:, one) .eqv. tags%on_fixation(:, other)) .and. &
           all(tags%on_die(:, one) .eqv. tags%on_die(:, other)) .and. (tags%on_wall(one) .eqv. tags%on_wall(other))
  end function same_supports

  !> Kept corners: whether a new mesh has a node where each side ends, too, because the tags change there or the contour turns.
  pure function kept_corners(loop, tags, x, turn) result(kept)
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: turn      !! of a corner [radian]
    logical :: kept(size(loop%sides, 2))
    type(boundary_curve_t) :: boundary
    integer :: k, next

    boundary = boundary_of_loop(loop, x, turn)
    do k = 1, size(kept)
      next = joint_after(boundary, k)
      kept(k) = boundary%kinds(next) == kind_corner .or. .not. same_tags(tags, k, next)
    end do
  end function kept_corners

  !> Nodes with supports and imposed motions.
  pure function held_nodes(scene) result(held)
    type(scene_t), intent(in) :: scene
    logical :: held(size(scene%mesh%coordinates, 2))
    integer :: k

    held = .false.
    do k = 1, size(scene%fixations)
      held(scene%fixations(k)%nodes) = .true.
    end do
  end function held_nodes

end module side_tags
