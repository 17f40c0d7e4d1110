!> Dies: curves of parabolas, moved by a pilot when rigid, by the nodes of bodies when deformable.
!>
!> Along the curve the part is on the left and the die's body on the right (annex 3). A
!> piece is the isoparametric parabola through three points, y(xi) = sum_k phi_k(xi) Y_k; a segment
!> is one with its middle point in the middle. Pieces are stored in the axes of the pilot: a point
!> X of the die stands at `c + R(theta) X` when the pilot is at c and has turned by theta. A deformable
!> die is a curve of sides of bodies, traversed in the sense opposite to their contour; its pilot stays at the origin.
module dies
  use kinds, only: wp
  use parabolas, only: tangent_on
  use piecewise_curves, only: adjacent_piece, blunt, piecewise_curve_t, prepare_search
  use plane_vectors, only: cross, turned
  use vectors, only: length_of
  implicit none
  private
  public :: die_t, edge_turn, finish_die, is_deformable, is_straight, place_edges, place_on_nodes, present_die, in_pilot_axes
  public :: radius_on

  !> Distance from a straight line over its length, and from the axis over the size of the die, that is round-off of points as cards
  !> give them [-].
  real(wp), parameter :: straight = 1.0e-9_wp, at_axis = 1.0e-9_wp

  !> Cosine of the least turn of a deformable die at an edge of its body, 10 degrees, in the mesh as it began: sides that follow
  !> a curve turn by less where they meet, since a parabola over an arc of 80 degrees ends within 4 degrees of it.
  real(wp), parameter :: edge_turn = 0.985_wp

  !> Its pieces are stored in the axes of the pilot.
  type, extends(piecewise_curve_t) :: die_t
    character(len=:), allocatable :: name
    !> Corners of a rigid die that point to the part, open ends included, or edges of a deformable one in a step: the point, and
    !> the tangents before and behind it (x, y, t1x, t1y, t2x, t2y; ncorner), in the pilot's axes; the piece each belongs to, and
    !> the parent coordinate on it [-].
    real(wp), allocatable :: corners(:, :)
    integer, allocatable :: corner_piece(:)
    real(wp), allocatable :: corner_xi(:)
    !> Where the pilot stands at the start (x, y, angle).
    real(wp) :: pilot(3) = 0.0_wp
    !> Nodes of the pieces of a deformable die (3, npiece); not allocated for a rigid one.
    integer, allocatable :: nodes(:, :)
    !> Made in the run of sides of a body that have met, where no card gives them contact (folding_bodies).
    logical :: unasked = .false.
  end type die_t

contains

  !> Move the points into the pilot's axes, make the boxes, list the corners.
  pure subroutine finish_die(die)
    type(die_t), intent(inout) :: die
    integer :: k, i

    do k = 1, size(die%pieces, 3)
      do i = 1, 3
        die%pieces(:, i, k) = die%pieces(:, i, k) - die%pilot(1:2)
      end do
    end do
    call prepare_search(die)
    if (.not. is_deformable(die)) call list_corners(die)
  end subroutine finish_die

  !> Radius of a place on a rigid die of an axisymmetric scene at the start, 0 where it is round-off.
  pure function radius_on(die, x) result(radius)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: x   !! in the pilot's axes [length]
    real(wp) :: radius          !! [length]

    radius = x + die%pilot(1)
    if (abs(radius) <= at_axis*max(maxval(abs(die%pieces)), abs(die%pilot(1)))) radius = 0
  end function radius_on

  !> Vertices where the curve turns right, away from the part. At an open end the body is taken to go down at a right angle.
  pure subroutine list_corners(die)
    type(die_t), intent(inout) :: die
    real(wp) :: list(6, size(die%pieces, 3) + 1), t1(2), t2(2)
    integer :: piece(size(die%pieces, 3) + 1)
    integer :: k, n, npiece

    npiece = size(die%pieces, 3)
    n = 0
    t1 = 0
    do k = 0, npiece
      if (k == 0 .and. (die%closed .or. npiece == 0)) cycle
      if (k > 0) t1 = end_tangent(die%pieces(:, :, k), 1)
      if (k < npiece) then
        t2 = end_tangent(die%pieces(:, :, k + 1), -1)
      else if (die%closed) then
        t2 = end_tangent(die%pieces(:, :, 1), -1)
      else
        t2 = [t1(2), -t1(1)]
      end if
      if (k == 0) t1 = [-t2(2), t2(1)]
      if (cross(t1, t2) > -blunt .and. dot_product(t1, t2) > 0) cycle
      if (cross(t1, t2) > 0) cycle
      n = n + 1
      piece(n) = k
      list(1:2, n) = die%pieces(:, 1, max(k, 1))
      if (k > 0) list(1:2, n) = die%pieces(:, 3, k)
      list(3:6, n) = [t1, t2]
    end do
    die%corners = list(:, :n)
    die%corner_piece = max(piece(:n), 1)
    die%corner_xi = merge(-1.0_wp, 1.0_wp, piece(:n) == 0)
  end subroutine list_corners

  !> Unit tangent at the start (-1) or end (1) of a piece.
  pure function end_tangent(piece, xi) result(t)
    real(wp), intent(in) :: piece(2, 3)
    integer, intent(in) :: xi
    real(wp) :: t(2)

    t = tangent_on(piece, real(xi, wp))
    t = t/length_of(t)
  end function end_tangent

  elemental function is_deformable(die) result(yes)
    type(die_t), intent(in) :: die
    logical :: yes

    yes = allocated(die%nodes)
  end function is_deformable

  !> All of a die lies on one straight line, to the last bits of its points.
  pure function is_straight(die) result(yes)
    type(die_t), intent(in) :: die
    logical :: yes
    real(wp) :: along(2), way(2)
    integer :: k, i

    yes = .not. die%closed .and. size(die%pieces, 3) > 0
    if (.not. yes) return
    along = die%pieces(:, 3, size(die%pieces, 3)) - die%pieces(:, 1, 1)
    do k = 1, size(die%pieces, 3)
      do i = 2, 3
        way = die%pieces(:, i, k) - die%pieces(:, 1, k)
        yes = yes .and. abs(cross(along, way)) <= straight*dot_product(along, along) .and. dot_product(along, way) > 0
      end do
    end do
  end function is_straight

  !> Put the pieces of a deformable die where its nodes are.
  pure subroutine place_on_nodes(coordinates, die)
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) of all nodes [length]
    type(die_t), intent(inout) :: die
    integer :: k

    do k = 1, size(die%nodes, 2)
      die%pieces(:, :, k) = coordinates(:, die%nodes(:, k))
    end do
    call finish_die(die)
  end subroutine place_on_nodes

  !> Edges of a deformable die that has been placed on its nodes, as its corners: the mesh as it began says which they are.
  !> Its ends are none, since the curve may go on as another body, or end on a line of symmetry.
  pure subroutine place_edges(first, die)
    real(wp), intent(in) :: first(:, :)   !! (2, nnode) nodes of the mesh as it began [length]
    type(die_t), intent(inout) :: die
    real(wp) :: list(6, size(die%pieces, 3)), t1(2), t2(2)
    integer :: piece(size(die%pieces, 3)), k, next, n

    n = 0
    do k = 1, size(die%nodes, 2)
      next = adjacent_piece(die, k, 1)
      if (next == 0) cycle
      t1 = end_tangent(first(:, die%nodes(:, k)), 1)
      t2 = end_tangent(first(:, die%nodes(:, next)), -1)
      if (cross(t1, t2) > 0 .or. dot_product(t1, t2) > edge_turn) cycle
      n = n + 1
      piece(n) = k
      list(:, n) = [die%pieces(:, 3, k), end_tangent(die%pieces(:, :, k), 1), end_tangent(die%pieces(:, :, next), -1)]
    end do
    die%corners = list(:, :n)
    die%corner_piece = piece(:n)
    die%corner_xi = [(1.0_wp, k=1, n)]
  end subroutine place_edges

  !> Points in the axes of a die's pilot [length].
  pure function in_pilot_axes(points, pilot) result(local)
    real(wp), intent(in) :: points(:, :)   !! (2, npoint) [length]
    real(wp), intent(in) :: pilot(3)       !! (x, y, angle) of the die now [length and radian]
    real(wp) :: local(2, size(points, 2))
    integer :: k

    do k = 1, size(points, 2)
      local(:, k) = turned(points(:, k) - pilot(1:2), -pilot(3))
    end do
  end function in_pilot_axes

  !> The die as its nodes now are; a rigid one is as it was: its pilot moves it.
  pure function present_die(die, coordinates) result(now)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) of all nodes [length]
    type(die_t) :: now

    now = die
    if (is_deformable(now)) call place_on_nodes(coordinates, now)
  end function present_die

end module dies
