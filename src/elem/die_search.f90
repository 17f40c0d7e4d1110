!> Where the normal of a part's side meets a die (annex 3, sec. 4, figs. 3-5).
!>
!> From a point x of the part, with the part's inner normal e_R, the ray y = x + d e_R crosses the
!> die's chain where (Y(xi) - x).e_T = 0, a quadratic for every piece. With n the die's inner
!> normal a crossing with e_R.n < 0 leaves the die (a true contact, eq. 11), one with e_R.n > 0
!> enters it (a false one). The chain is oriented, so the side the point is on is known: when the
!> first crossing ahead leaves the die the point is inside, at depth d > 0; otherwise, when the
!> first crossing behind leaves the die, the point is outside, at the gap d < 0.
module die_search
  use dies, only: die_t
  use kinds, only: eps, wp
  implicit none
  private
  public :: foot_t, find_foot, box_distance

  !> Foot of a point on a die, in the pilot's axes.
  type :: foot_t
    !> Piece met, 0 when none is.
    integer :: piece = 0
    real(wp) :: xi = 0.0_wp
    !> Penetration, negative for a gap [length].
    real(wp) :: d = 0.0_wp
    !> Inner normal of the die there.
    real(wp) :: normal(2) = 0.0_wp
  end type foot_t

  !> Crossings flatter than this sine are no contact: the ray runs along the die.
  real(wp), parameter :: grazing = 1.0e-3_wp
  !> Ends of pieces belong to both neighbours, within round-off of xi.
  real(wp), parameter :: end_slack = 64*eps

contains

  !> Foot of a point, within `reach` ahead and behind.
  pure subroutine find_foot(die, point, e_r, reach, foot)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)     !! inner normal of the part, in the pilot's axes
    real(wp), intent(in) :: reach      !! [length]
    type(foot_t), intent(out) :: foot
    type(foot_t) :: ahead, behind, crossing
    real(wp) :: xi(2), low(2), high(2), cosine
    logical :: ahead_leaves, behind_leaves
    integer :: k, r, n

    low = min(point - reach*e_r, point + reach*e_r)
    high = max(point - reach*e_r, point + reach*e_r)
    ahead%d = reach
    behind%d = -reach
    ahead_leaves = .false.
    behind_leaves = .false.
    do k = 1, size(die%pieces, 3)
      if (any(die%boxes(1:2, k) > high) .or. any(die%boxes(3:4, k) < low)) cycle
      call crossings(die%pieces(:, :, k), point, e_r, n, xi)
      do r = 1, n
        call at_crossing(die%pieces(:, :, k), point, e_r, xi(r), crossing, cosine)
        if (abs(cosine) < grazing) cycle
        crossing%piece = k
        if (crossing%d >= 0 .and. crossing%d < ahead%d) then
          ahead = crossing
          ahead_leaves = cosine < 0
        else if (crossing%d < 0 .and. crossing%d > behind%d) then
          behind = crossing
          behind_leaves = cosine < 0
        end if
      end do
    end do
    if (ahead_leaves) then
      foot = ahead
    else if (behind_leaves) then
      foot = behind
    end if
  end subroutine find_foot

  !> Roots xi in [-1, 1] of (Y(xi) - point).e_T = 0.
  pure subroutine crossings(piece, point, e_r, n, xi)
    real(wp), intent(in) :: piece(2, 3), point(2), e_r(2)
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(2)
    real(wp) :: e_t(2), a, b, c, delta, q, roots(2), scale
    integer :: i, m

    e_t = [e_r(2), -e_r(1)]
    a = 0.5_wp*dot_product(piece(:, 1) - 2*piece(:, 2) + piece(:, 3), e_t)
    b = 0.5_wp*dot_product(piece(:, 3) - piece(:, 1), e_t)
    c = dot_product(piece(:, 2) - point, e_t)
    scale = maxval(abs(piece(:, 3) - piece(:, 1)))
    m = 0
    if (abs(a) <= 16*eps*scale) then
      if (abs(b) > 16*eps*scale) then
        m = 1
        roots(1) = -c/b
      end if
    else
      delta = b*b - 4*a*c
      if (delta >= 0) then
        q = -0.5_wp*(b + sign(sqrt(delta), b))
        m = 1
        roots(1) = q/a
        if (abs(q) > 0) then
          m = 2
          roots(2) = c/q
        end if
      end if
    end if
    n = 0
    do i = 1, m
      if (abs(roots(i)) > 1 + end_slack) cycle
      n = n + 1
      xi(n) = roots(i)
    end do
  end subroutine crossings

  !> Depth along the ray, the die's inner normal, and the cosine between the two.
  pure subroutine at_crossing(piece, point, e_r, xi, foot, cosine)
    real(wp), intent(in) :: piece(2, 3), point(2), e_r(2), xi
    type(foot_t), intent(out) :: foot
    real(wp), intent(out) :: cosine
    real(wp) :: y(2), tangent(2)

    y = 0.5_wp*xi*(xi - 1)*piece(:, 1) + (1 - xi*xi)*piece(:, 2) + 0.5_wp*xi*(xi + 1)*piece(:, 3)
    tangent = (xi - 0.5_wp)*piece(:, 1) - 2*xi*piece(:, 2) + (xi + 0.5_wp)*piece(:, 3)
    tangent = tangent/norm2(tangent)
    foot%xi = xi
    foot%d = dot_product(y - point, e_r)
    foot%normal = [tangent(2), -tangent(1)]
    cosine = dot_product(foot%normal, e_r)
  end subroutine at_crossing

  !> Distance from a box (xmin, ymin, xmax, ymax) to the boxes of a die, in the pilot's axes; 0 when they meet.
  pure function box_distance(die, box) result(distance)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: box(4)
    real(wp) :: distance
    integer :: k

    distance = huge(1.0_wp)
    do k = 1, size(die%boxes, 2)
      distance = min(distance, norm2(max(die%boxes(1:2, k) - box(3:4), box(1:2) - die%boxes(3:4, k), 0.0_wp)))
    end do
  end function box_distance

end module die_search
