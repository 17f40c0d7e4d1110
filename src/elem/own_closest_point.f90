!> The closest point of a body's own curve, for a point of a side that faces its own body (CNTDF).
!>
!> Nothing tells there by its place whether a point is behind the wall that it belongs to or in the side that it has met: both are
!> a depth. So a point goes on from the closest point of the last accepted instant, or takes the nearest gap. Only where it had none
!> in reach, as in a first step, a depth counts that was none on the mesh as it began. The two sides that meet in the ground of a
!> fold press on each other; beside any other corner a depth is the body itself.
module own_closest_point
  use closest_point, only: closest_point_t
  use contact_state, only: at_piece, at_xi
  use corner_faces, only: closest_on_piece
  use curve_search, only: closest_opposed_point, follow_closest_point, looks_at
  use dies, only: die_t
  use kept_side, only: beyond_all
  use kinds, only: pi, wp
  use parabolas, only: point_on, tangent_on
  use piecewise_curves, only: adjacent_piece
  use plane_vectors, only: angle_between, cross, right_of
  use scene, only: group_t, scene_t
  use side_points, only: contact_point_t, touching
  use vectors, only: length_of
  implicit none
  private
  public :: find_own_closest_point

  !> A point that was deeper behind a side of its body, on the mesh as it began, than this share of its own side is behind a wall:
  !> no depth of contact is as large.
  real(wp), parameter :: wall_thickness = 0.02_wp
  !> Cosine of the largest angle between the sides of a slot that is shut, about 10 degrees: no element has a corner as sharp.
  real(wp), parameter :: shut = 0.985_wp
  !> A closest point as far along its side was at the end of it (parent coordinate).
  real(wp), parameter :: at_corner = 0.999_wp

contains

  !> What the point had at the start of the step, or the nearest gap.
  pure subroutine find_own_closest_point(scene, group, element, die, pieces, may, point, phi, reach, committed, &
                                         closest)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: element            !! whose side it is
    type(die_t), intent(in) :: die            !! at the end of the step
    integer, intent(in) :: pieces(:)          !! (n) those that it may look at (list_opposed_pieces)
    logical, intent(in) :: may(:)             !! (npiece) that the side may meet
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: phi(3)            !! functions of the side at the point [-]
    real(wp), intent(in) :: reach             !! length of the side [length]
    real(wp), intent(in) :: committed(:)      !! (nstate) of the point [unit of each component]
    type(closest_point_t), intent(out) :: closest
    type(closest_point_t) :: same
    integer :: piece, end

    call closest_opposed_point(die, point%x, point%e_r, reach, pieces, may, -1.0_wp, closest)
    if (closest%piece > 0) then
      if (is_own_node(closest)) closest%piece = 0
    end if
    piece = nint(committed(at_piece))
    if (piece > 0) then
      call follow_from(die, point, reach, piece, committed(at_xi), same)
    else
      call closest_opposed_point(die, point%x, point%e_r, reach, pieces, may, 1.0_wp, same)
    end if
    call take(same, piece > 0, closest)
    if (closest%piece > 0 .or. die%closed) return
    ! flush with an open end of the curve, as on a line of symmetry
    do end = 1, size(may), max(size(may) - 1, 1)
      call closest_on_piece(die, end, point%x, merge(-1.0_wp, 1.0_wp, end == 1), beyond_all, same)
      if (same%piece == 0) cycle
      if (abs(same%d) < reach .and. looks_at(same, point%e_r)) call take(same, piece == end, closest)
    end do

  contains

    !> What the point met before is nearer than a gap where it is a depth. A depth that was not met before may be a wall, and one
    !> beside a common node the body itself.
    pure subroutine take(other, was_met, closest)
      type(closest_point_t), intent(in) :: other
      logical, intent(in) :: was_met
      type(closest_point_t), intent(inout) :: closest

      if (other%piece == 0) return
      if (.not. may(other%piece)) return
      if (is_own_node(other)) return
      if (closest%piece > 0 .and. other%d < 0 .and. other%d < closest%d) return
      if (other%d > 0) then
        if (is_next(other)) then
          if (.not. is_slot(die, group%connectivity(3, element) == scene%dies(group%die)%nodes(3, other%piece), other%piece)) return
        else if (.not. was_met) then
          if (is_wall(scene%mesh%coordinates(:, group%connectivity(:, element)), phi, &
                      scene%mesh%coordinates(:, scene%dies(group%die)%nodes(:, other%piece)), other, reach)) return
        end if
      end if
      closest = other
    end subroutine take

    !> The closest point is on a side that shares a node with that of the point.
    pure function is_next(found) result(next)
      type(closest_point_t), intent(in) :: found
      logical :: next

      associate (side => group%connectivity(:, element), other => scene%dies(group%die)%nodes(:, found%piece))
        next = side(1) == other(1) .or. side(3) == other(3)
      end associate
    end function is_next

    !> The point and its closest point are one node.
    pure function is_own_node(found) result(own)
      type(closest_point_t), intent(in) :: found
      logical :: own

      own = is_next(found) .and. abs(found%d) <= touching*reach
    end function is_own_node

  end subroutine find_own_closest_point

  !> The closest point from where it was. From a corner there are two ways, inside the body behind it: the side that is looked at.
  pure subroutine follow_from(die, point, reach, piece, xi, found)
    type(die_t), intent(in) :: die
    type(contact_point_t), intent(in) :: point
    real(wp), intent(in) :: reach   !! [length]
    integer, intent(in) :: piece
    real(wp), intent(in) :: xi      !! where it was on the piece [-]
    type(closest_point_t), intent(out) :: found
    type(closest_point_t) :: other
    integer :: next

    call follow_closest_point(die, point%x, point%e_r, reach, piece, xi, found)
    if (.not. abs(xi) >= at_corner) return
    next = adjacent_piece(die, piece, nint(xi))
    if (next == 0) return
    call follow_closest_point(die, point%x, point%e_r, reach, next, -anint(xi), other)
    if (other%piece == 0 .or. .not. other%d > 0) return
    if (found%piece > 0 .and. dot_product(found%normal, point%e_r) <= dot_product(other%normal, point%e_r)) return
    found = other
  end subroutine follow_from

  !> Point and closest point are on two faces of one wall.
  pure function is_wall(x, phi, y, far, reach) result(wall)
    real(wp), intent(in) :: x(2, 3), phi(3)   !! side of the point on the mesh as it began [length], its functions there [-]
    real(wp), intent(in) :: y(2, 3)           !! side of the closest point on that mesh [length]
    type(closest_point_t), intent(in) :: far
    real(wp), intent(in) :: reach             !! [length]
    logical :: wall
    real(wp) :: apart(2), across

    apart = matmul(x, phi) - point_on(y, far%xi)
    across = dot_product(apart, right_of(tangent_on(y, far%xi)))
    if (far%at_vertex) across = sign(length_of(apart), across)
    wall = across > wall_thickness*reach
  end function is_wall

  !> The side of the point and the one that it shares a node with have a slot between them, the ground of a fold, and no corner of
  !> the body: by their chords, since parabolas that press on each other may bulge beside that node, and by their tangents, since
  !> parabolas that turn back from their chords make a corner of the body there. A slot that is shut may have turned over by the
  !> depth of contact.
  pure function is_slot(die, at_end, found) result(slot)
    type(die_t), intent(in) :: die
    logical, intent(in) :: at_end   !! the node is the last one of the side
    integer, intent(in) :: found    !! piece with the closest point
    logical :: slot
    real(wp), dimension(2) :: before, after   ! from the node along the chords
    real(wp) :: opening                       ! between the tangents there [radian]
    integer :: first, next

    first = found
    if (.not. at_end) first = adjacent_piece(die, found, -1)
    next = adjacent_piece(die, first, 1)
    before = die%pieces(:, 1, first) - die%pieces(:, 3, first)
    after = die%pieces(:, 3, next) - die%pieces(:, 1, next)
    slot = cross(after, before) > 0 .or. dot_product(after, before) > shut*length_of(before)*length_of(after)
    if (.not. slot) return
    opening = angle_between(tangent_on(die%pieces(:, :, next), -1.0_wp), after) + angle_between(after, before) &
              + angle_between(before, -tangent_on(die%pieces(:, :, first), 1.0_wp))
    slot = opening < pi
  end function is_slot

end module own_closest_point
