!> The point of a curve of parabolas closest to a point; for contact, the one that faces the part.
!>
!> A die's curve is oriented, so the side a point is on is known: with n the die's inner normal at
!> the closest point Y, d = (X - Y).n is the penetration, negative for a gap. Depth so measured is
!> continuous wherever the part's side turns, and linear in front of a flat die; the original
!> (annex 3, figs. 3-5) searches along the part's own normal instead, where an intersection can appear at any
!> depth and several may compete. Only closest points that face the part count (true contact, eq. 11): with
!> e_R the part's inner normal, e_R.n must be below `facing`.
!>
!> A closest point that faces the part may lie behind another wall: a point beside a thin rib, on a side that
!> faces away from the rib, faces the rib's far wall. The closest point of all shows whether the point
!> is inside the body; one that contradicts it is not taken. Only what came through a wall since
!> the last accepted instant still belongs to that wall: `follow_closest_point` continues from the closest point of that
!> instant, in the direction of decreasing distance, so that a step cannot carry a point through a rib.
!>
!> Beyond the ends of an open curve there is no die. A tree of boxes over the curve is searched
!> nearest first; what is found is what trying all pieces in their order would find, to the last bit.
module curve_search
  use closest_point, only: closest_at_vertex, closest_point_t, closest_within_piece, distance_slope, end_slack, stationary_points, &
                           whole_piece
  use corner_faces, only: keep_to_face, leave_beside
  use curve_boxes, only: box_gap, box_of_node, start_at_root, wait_below, waiting_nodes_t
  use kinds, only: wp
  use piecewise_curves, only: adjacent_piece, piecewise_curve_t
  implicit none
  private
  public :: closest_facing_point, closest_opposed_point, closest_on_pieces, follow_closest_point, looks_at
  public :: opposed, slack_of

  !> A side that faces away by less than this cosine may still lie on the die: a side that folds.
  real(wp), parameter :: facing = 0.9_wp
  !> Sides of one curve look at each other when the product of their inner normals is below this.
  real(wp), parameter :: opposed = -0.1_wp

  !> Which closest points are sought.
  type :: search_t
    real(wp) :: point(2)
    !> Inner normal of the part; whether only points that face it count, and of them only gaps (-1) or penetrations (1).
    real(wp) :: e_r(2)
    logical :: narrow = .false.
    real(wp) :: sense = 0.0_wp
    !> Product of the normals up to which a point faces the part.
    real(wp) :: limit = facing
    !> Distance of the best one so far [length].
    real(wp) :: best
    type(closest_point_t) :: closest
  end type search_t

contains

  !> Closest point that faces the part, within `reach`.
  pure subroutine closest_facing_point(curve, point, e_r, reach, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)     !! inner normal of the part, in the pilot's axes [-]
    real(wp), intent(in) :: reach      !! [length]
    type(closest_point_t), intent(out) :: closest
    type(search_t) :: search

    search%point = point
    search%e_r = e_r
    search%best = reach
    call search_tree(curve, search)
    if (search%closest%piece > 0) then
      if (.not. faces(search%closest, e_r, facing)) then
        search%narrow = .true.
        search%sense = sign(1.0_wp, search%closest%d)
        search%best = reach
        search%closest = closest
        call search_tree(curve, search)
      end if
    end if
    closest = search%closest
    if (closest%piece == 0) return
    call keep_to_face(curve, point, e_r, reach, closest)
    if (closest%d > -end_slack*reach) call leave_beside(curve, point, e_r, reach, closest)
  end subroutine closest_facing_point

  !> Closest point of a curve to a point of its own: on the given pieces, where they look at each other, as a gap or as a depth.
  pure subroutine closest_opposed_point(curve, point, e_r, reach, pieces, may, sense, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)    !! [length]
    real(wp), intent(in) :: e_r(2)      !! inner normal of the part [-]
    real(wp), intent(in) :: reach       !! [length]
    integer, intent(in) :: pieces(:)    !! (n) that are looked at (list_opposed_pieces)
    logical, intent(in) :: may(:)       !! (npiece) a vertex is met where both pieces that it joins may be
    real(wp), intent(in) :: sense       !! -1 for a gap, 1 for a depth
    type(closest_point_t), intent(out) :: closest
    type(search_t) :: search
    real(wp) :: slack
    integer :: i

    if (size(pieces) == 0) return
    search%point = point
    search%e_r = e_r
    search%best = reach
    search%narrow = .true.
    search%sense = sense
    search%limit = opposed
    slack = slack_of(curve, point)
    do i = 1, size(pieces)
      if (box_gap(curve%boxes(:, pieces(i)), [point, point]) > (search%best + slack)**2) cycle
      call try_leaf(curve, pieces(i), search, may)
    end do
    closest = search%closest
  end subroutine closest_opposed_point

  !> A side of one curve and a closest point of the same look at each other.
  pure function looks_at(closest, e_r) result(yes)
    type(closest_point_t), intent(in) :: closest
    real(wp), intent(in) :: e_r(2)   !! inner normal of the side [-]
    logical :: yes

    yes = faces(closest, e_r, opposed)
  end function looks_at

  !> Closest point of all on adjacent pieces and the vertices between them, whichever way it faces.
  pure subroutine closest_on_pieces(curve, point, first, count, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)   !! [length]
    integer, intent(in) :: first       !! piece
    integer, intent(in) :: count       !! of pieces; across the start of a closed curve when they are more than follow
    type(closest_point_t), intent(out) :: closest
    type(search_t) :: search
    integer :: k, i

    search%point = point
    ! every closest point faces a part that has no normal
    search%e_r = 0
    search%best = huge(search%best)
    associate (npiece => size(curve%pieces, 3), slack => slack_of(curve, point))
      do i = 1, count
        k = modulo(first + i - 2, npiece) + 1
        if (sqrt(box_gap(curve%boxes(:, k), [point, point])) > search%best + slack) cycle
        call try_piece(curve, k, search)
        if (i < count .or. count == npiece) call try_vertex(curve, k, search)
      end do
    end associate
    closest = search%closest
  end subroutine closest_on_pieces

  !> A computed depth may be less than the distance of the box by round-off, or by the slack at the ends of pieces [length].
  pure function slack_of(curve, point) result(slack)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)
    real(wp) :: slack

    slack = 4*end_slack*(maxval(abs(box_of_node(curve, 1))) + maxval(abs(point)))
  end function slack_of

  pure function faces(closest, e_r, limit) result(seen)
    type(closest_point_t), intent(in) :: closest
    real(wp), intent(in) :: e_r(2), limit
    logical :: seen

    seen = .not. dot_product(closest%normal, e_r) > limit
  end function faces

  !> Try all pieces that may hold a closer point, those nearest first.
  pure subroutine search_tree(curve, search)
    class(piecewise_curve_t), intent(in) :: curve
    type(search_t), intent(inout) :: search
    type(waiting_nodes_t) :: waiting
    real(wp) :: slack
    integer :: node

    slack = slack_of(curve, search%point)
    call start_at_root(curve, [search%point, search%point], waiting)
    do while (waiting%n > 0)
      node = waiting%node(waiting%n)
      waiting%n = waiting%n - 1
      if (waiting%gap(waiting%n + 1) > (search%best + slack)**2) cycle
      if (node > size(curve%tree, 2)) then
        call try_leaf(curve, node - size(curve%tree, 2), search)
      else
        call wait_below(curve, [search%point, search%point], node, waiting)
      end if
    end do
  end subroutine search_tree

  !> A piece and the vertex that it ends with, which belongs to the next one too.
  pure subroutine try_leaf(curve, piece, search, may)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece
    type(search_t), intent(inout) :: search
    logical, intent(in), optional :: may(:)   !! (npiece) a vertex is tried where both pieces that it joins may be
    integer :: next

    call try_piece(curve, piece, search)
    if (present(may)) then
      next = adjacent_piece(curve, piece, 1)
      if (next == 0) return
      if (.not. may(next)) return
    end if
    call try_vertex(curve, piece, search)
  end subroutine try_leaf

  !> Closest points on a piece.
  pure subroutine try_piece(curve, k, search)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: k
    type(search_t), intent(inout) :: search
    type(closest_point_t) :: candidate
    real(wp) :: xi(3)
    integer :: n, r

    call stationary_points(curve%pieces(:, :, k), search%point, whole_piece, n, xi)
    do r = 1, n
      call closest_within_piece(curve%pieces(:, :, k), search%point, xi(r), candidate)
      call take(candidate, k, search)
    end do
  end subroutine try_piece

  !> Closest point at the vertex that a piece ends with.
  pure subroutine try_vertex(curve, k, search)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: k
    type(search_t), intent(inout) :: search
    type(closest_point_t) :: candidate
    integer :: next

    next = adjacent_piece(curve, k, 1)
    if (next == 0) return
    call closest_at_vertex(curve%pieces(:, :, k), curve%pieces(:, :, next), search%point, candidate)
    call take(candidate, k, search)
  end subroutine try_vertex

  !> The nearer of two; of two as near the one that faces the part, else the first along the curve.
  pure subroutine take(candidate, piece, search)
    type(closest_point_t), intent(in) :: candidate
    integer, intent(in) :: piece
    type(search_t), intent(inout) :: search
    logical :: seen, seen_before

    if (candidate%piece == 0 .or. abs(candidate%d) > search%best) return
    seen = faces(candidate, search%e_r, search%limit)
    if (search%narrow .and. (candidate%d*search%sense < 0 .or. .not. seen)) return
    if (.not. abs(candidate%d) < search%best) then
      if (search%closest%piece == 0) return
      seen_before = faces(search%closest, search%e_r, search%limit)
      if (seen_before .and. .not. seen) return
      if ((seen_before .eqv. seen) .and. piece >= search%closest%piece) return
    end if
    search%best = abs(candidate%d)
    search%closest = candidate
    search%closest%piece = piece
  end subroutine take

  !> Closest point reached from a position on the curve by going along it as long as the distance decreases; none when that leads
  !> to an end of the curve, beyond `reach`, or to where the die does not face the part.
  pure subroutine follow_closest_point(curve, point, e_r, reach, piece, xi, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)     !! inner normal of the part, in the pilot's axes [-]
    real(wp), intent(in) :: reach      !! [length]
    integer, intent(in) :: piece       !! where to begin
    real(wp), intent(in) :: xi         !! there [-]
    type(closest_point_t), intent(out) :: closest
    type(closest_point_t) :: found
    real(wp) :: here, roots(3)
    integer :: k, next, way, n, steps

    k = piece
    here = xi
    way = merge(-1, 1, distance_slope(curve%pieces(:, :, k), point, here) > 0)
    do steps = 1, size(curve%pieces, 3)
      if (box_gap(curve%boxes(:, k), [point, point]) > reach**2) return
      call stationary_points(curve%pieces(:, :, k), point, whole_piece, n, roots)
      if (any(way*(roots(:n) - here) >= -end_slack)) then
        here = way*minval(way*roots(:n), mask=way*(roots(:n) - here) >= -end_slack)
        call closest_within_piece(curve%pieces(:, :, k), point, here, found)
        exit
      end if
      next = adjacent_piece(curve, k, way)
      if (next == 0) return
      if (way*distance_slope(curve%pieces(:, :, next), point, -real(way, wp)) >= 0) then
        if (way < 0) k = next
        call closest_at_vertex(curve%pieces(:, :, k), curve%pieces(:, :, adjacent_piece(curve, k, 1)), point, found)
        exit
      end if
      k = next
      here = -way
    end do
    if (found%piece == 0 .or. .not. abs(found%d) < reach) return
    if (.not. faces(found, e_r, facing)) return
    closest = found
    closest%piece = k
    call keep_to_face(curve, point, e_r, reach, closest)
    if (closest%d > -end_slack*reach) call leave_beside(curve, point, e_r, reach, closest)
  end subroutine follow_closest_point

end module curve_search
