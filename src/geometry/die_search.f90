!> The point of a die closest to a point of the part.
!>
!> The die's chain is oriented, so the side a point is on is known: with n the die's inner normal at
!> the closest point Y, d = (X - Y).n is the penetration, negative for a gap. Depth so measured is
!> continuous wherever the part's side turns, and linear in front of a flat die; the original
!> (annex 3, figs. 3-5) looks along the part's own normal instead, where a foot can appear at any
!> depth and several may compete. Only feet that face the part count (true contact, eq. 11): with
!> e_R the part's inner normal, e_R.n must be below `facing`.
!>
!> A foot that faces the part may lie behind another wall: a point beside a thin rib, on a side that
!> looks away from the rib, faces the rib's far wall. The closest foot of all tells whether the point
!> is inside the body; a foot that says otherwise is not taken. Only what came through a wall since
!> the last accepted instant still belongs to that wall: `follow_foot` goes on from the foot of that
!> instant, downhill in distance, so that a step cannot carry a point through a rib.
!>
!> Beyond the ends of an open chain there is no die. A tree of boxes over the chain is searched
!> nearest first; what is found is what trying all pieces in their order would find, to the last bit.
module die_search
  use die_feet, only: climb, end_slack, foot_at_vertex, foot_inside, foot_t, projections
  use kinds, only: eps, wp
  use piecewise_curves, only: adjacent_piece, box_gap, box_of_node, piecewise_curve_t
  implicit none
  private
  public :: foot_t, find_foot, find_foot_on, follow_foot, box_distance

  !> A side that faces away by less than this cosine may still lie on the die: a side that folds.
  real(wp), parameter :: facing = 0.9_wp
  !> Nodes waiting in a search are one for each row of the tree at most: pieces are counted by 32 bits.
  integer, parameter :: most_waiting = 40

  !> Which feet are looked for.
  type :: search_t
    real(wp) :: point(2)
    !> Inner normal of the part; whether only feet that face it count, and of them only gaps (-1) or penetrations (1).
    real(wp) :: e_r(2)
    logical :: narrow = .false.
    real(wp) :: sense = 0.0_wp
    !> Distance of the best foot so far.
    real(wp) :: best
    type(foot_t) :: foot
  end type search_t

contains

  !> Foot of a point, within `reach`.
  pure subroutine find_foot(curve, point, e_r, reach, foot)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)     !! inner normal of the part, in the pilot's axes
    real(wp), intent(in) :: reach      !! [length]
    type(foot_t), intent(out) :: foot
    type(search_t) :: search

    search%point = point
    search%e_r = e_r
    search%best = reach
    call search_tree(curve, search)
    if (search%foot%piece > 0) then
      if (.not. faces(search%foot, e_r)) then
        search%narrow = .true.
        search%sense = sign(1.0_wp, search%foot%d)
        search%best = reach
        search%foot = foot
        call search_tree(curve, search)
      end if
    end if
    foot = search%foot
  end subroutine find_foot

  pure function faces(foot, e_r) result(seen)
    type(foot_t), intent(in) :: foot
    real(wp), intent(in) :: e_r(2)
    logical :: seen

    seen = .not. dot_product(foot%normal, e_r) > facing
  end function faces

  !> Try all pieces that may hold a better foot, those nearest first.
  pure subroutine search_tree(curve, search)
    class(piecewise_curve_t), intent(in) :: curve
    type(search_t), intent(inout) :: search
    integer :: waiting(most_waiting), n, node, near, far
    real(wp) :: gaps(most_waiting), gap(2), slack, box(4)

    ! a computed depth may be less than the distance of the box by round-off, or by the slack at the ends of pieces
    box = box_of_node(curve, 1)
    slack = 4*end_slack*(maxval(abs(box)) + maxval(abs(search%point)))
    n = 1
    waiting(1) = 1
    gaps(1) = box_gap(box, [search%point, search%point])
    do while (n > 0)
      node = waiting(n)
      n = n - 1
      if (gaps(n + 1) > (search%best + slack)**2) cycle
      if (node > size(curve%tree, 2)) then
        call try_piece(curve, node - size(curve%tree, 2), search)
        cycle
      end if
      gap(1) = box_gap(box_of_node(curve, 2*node), [search%point, search%point])
      gap(2) = box_gap(box_of_node(curve, 2*node + 1), [search%point, search%point])
      near = merge(0, 1, gap(1) <= gap(2))
      far = 1 - near
      waiting(n + 1:n + 2) = 2*node + [far, near]
      gaps(n + 1:n + 2) = gap([far + 1, near + 1])
      n = n + 2
    end do
  end subroutine search_tree

  !> Feet on a piece, and at the vertex it ends with.
  pure subroutine try_piece(curve, k, search)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: k
    type(search_t), intent(inout) :: search
    type(foot_t) :: candidate
    real(wp) :: xi(3)
    integer :: n, r, next

    call projections(curve%pieces(:, :, k), search%point, n, xi)
    do r = 1, n
      call foot_inside(curve%pieces(:, :, k), search%point, xi(r), candidate)
      call take(candidate, k, search)
    end do
    next = adjacent_piece(curve, k, 1)
    if (next == 0) return
    call foot_at_vertex(curve%pieces(:, :, k), curve%pieces(:, :, next), search%point, candidate)
    call take(candidate, k, search)
  end subroutine try_piece

  !> The nearer of two feet; of two as near the one that faces the part, else the first along the chain.
  pure subroutine take(candidate, piece, search)
    type(foot_t), intent(in) :: candidate
    integer, intent(in) :: piece
    type(search_t), intent(inout) :: search
    logical :: seen, seen_before

    if (candidate%piece == 0 .or. abs(candidate%d) > search%best) return
    seen = faces(candidate, search%e_r)
    if (search%narrow .and. (candidate%d*search%sense < 0 .or. .not. seen)) return
    if (.not. abs(candidate%d) < search%best) then
      if (search%foot%piece == 0) return
      seen_before = faces(search%foot, search%e_r)
      if (seen_before .and. .not. seen) return
      if ((seen_before .eqv. seen) .and. piece >= search%foot%piece) return
    end if
    search%best = abs(candidate%d)
    search%foot = candidate
    search%foot%piece = piece
  end subroutine take

  !> Foot reached from a place of the chain by going along it as long as the point comes nearer; none when that leads to an
  !> end of the chain, beyond `reach`, or to where the die does not face the part.
  pure subroutine follow_foot(curve, point, e_r, reach, piece, xi, foot)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2), e_r(2), reach   !! as in `find_foot`
    integer, intent(in) :: piece                      !! where to begin
    real(wp), intent(in) :: xi
    type(foot_t), intent(out) :: foot
    type(foot_t) :: found
    real(wp) :: place, roots(3)
    integer :: k, next, way, n, steps

    k = piece
    place = xi
    way = merge(-1, 1, climb(curve%pieces(:, :, k), point, place) > 0)
    do steps = 1, size(curve%pieces, 3)
      if (box_gap(curve%boxes(:, k), [point, point]) > reach**2) return
      call projections(curve%pieces(:, :, k), point, n, roots)
      if (any(way*(roots(:n) - place) >= -end_slack)) then
        place = way*minval(way*roots(:n), mask=way*(roots(:n) - place) >= -end_slack)
        call foot_inside(curve%pieces(:, :, k), point, place, found)
        exit
      end if
      next = adjacent_piece(curve, k, way)
      if (next == 0) return
      if (way*climb(curve%pieces(:, :, next), point, -real(way, wp)) >= 0) then
        if (way < 0) k = next
        call foot_at_vertex(curve%pieces(:, :, k), curve%pieces(:, :, adjacent_piece(curve, k, 1)), point, found)
        exit
      end if
      k = next
      place = -way
    end do
    if (found%piece == 0 .or. .not. abs(found%d) < reach) return
    if (.not. faces(found, e_r)) return
    foot = found
    foot%piece = k
  end subroutine follow_foot

  !> Foot of a point on one piece, or up to `beyond` outside its ends; of several the one nearest to `from`.
  pure subroutine find_foot_on(curve, piece, point, from, beyond, foot)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece
    real(wp), intent(in) :: point(2)       !! in the pilot's axes [length]
    real(wp), intent(in) :: from, beyond   !! parent coordinates
    type(foot_t), intent(out) :: foot
    real(wp) :: roots(3)
    integer :: n

    call projections(curve%pieces(:, :, piece), point, n, roots, beyond)
    if (n == 0) return
    call foot_inside(curve%pieces(:, :, piece), point, roots(minloc(abs(roots(:n) - from), 1)), foot)
    if (foot%piece > 0) foot%piece = piece
  end subroutine find_foot_on

  !> Distance from a box (xmin, ymin, xmax, ymax) to the boxes of a die, in the pilot's axes; 0 when they meet.
  pure function box_distance(curve, box) result(distance)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: box(4)
    real(wp) :: distance
    real(wp) :: gaps(most_waiting), gap(2)
    integer :: waiting(most_waiting), n, node, near, far

    distance = huge(1.0_wp)
    n = 1
    waiting(1) = 1
    gaps(1) = box_gap(box_of_node(curve, 1), box)
    do while (n > 0)
      node = waiting(n)
      n = n - 1
      if (.not. gaps(n + 1) < distance) cycle
      if (node > size(curve%tree, 2)) then
        distance = gaps(n + 1)
        cycle
      end if
      gap(1) = box_gap(box_of_node(curve, 2*node), box)
      gap(2) = box_gap(box_of_node(curve, 2*node + 1), box)
      near = merge(0, 1, gap(1) <= gap(2))
      far = 1 - near
      waiting(n + 1:n + 2) = 2*node + [far, near]
      gaps(n + 1:n + 2) = gap([far + 1, near + 1])
      n = n + 2
    end do
    distance = sqrt(distance)
  end function box_distance

end module die_search
