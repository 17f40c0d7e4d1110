!> Arcs that follow a die from where contact begins to where it ends, at given depths.
!>
!> The depth d = p/AKP carries the contact pressure: on a contour at this depth in the die the first residual finds the pressures of
!> the previous mesh. Between the points where it is known the depth is linear in the arc length of the die. At a vertex of the die
!> the two curves at depth are cut at their intersection, or extended to it.
module arcs_on_die
  use arcs, only: arc_t, cut, straight
  use closest_point, only: closest_point_t
  use dies, only: die_t
  use kinds, only: eps, wp
  use offset_parabolas, only: length_between, point_at, tangent_at
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: placed_piece, follow_die

  !> Pieces are smooth at their joint where the tangent turns by less: the gap is this share of a depth.
  real(wp), parameter :: smooth_turn = 1.0e-7_wp
  !> Curves at a depth intersect within this many depths of a vertex, else a straight arc joins them: turns up to 120 degrees.
  real(wp), parameter :: longest_mitre = 2.0_wp
  !> A shorter range of xi is empty.
  real(wp), parameter :: shortest_range = 1.0e-12_wp

contains

  !> A piece of a die in its present position.
  pure function placed_piece(die, pilot, piece) result(arc)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)   !! (x, y, angle) of the die now [length and radian]
    integer, intent(in) :: piece
    type(arc_t) :: arc
    real(wp) :: turn(2, 2)
    integer :: i

    turn = reshape([cos(pilot(3)), sin(pilot(3)), -sin(pilot(3)), cos(pilot(3))], [2, 2])
    do i = 1, 3
      arc%points(:, i) = pilot(1:2) + matmul(turn, die%pieces(:, i, piece))
    end do
    arc%piece = piece
  end function placed_piece

  !> Arcs from the first closest point to the last. The points are sorted along the die; a closed die may be traversed across
  !> its start.
  pure subroutine follow_die(die, pilot, number, closest_points, arcs)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)                         !! (x, y, angle) of the die now [length and radian]
    integer, intent(in) :: number                            !! of the die
    type(closest_point_t), intent(in) :: closest_points(:)   !! (n) in their order along the die
    type(arc_t), allocatable, intent(out) :: arcs(:)         !! (narc)
    type(arc_t) :: list(2*size(closest_points) + 3*size(die%pieces, 3))
    integer :: k, n

    n = 0
    do k = 1, size(closest_points) - 1
      call add_arcs_between(die, pilot, number, closest_points(k), closest_points(k + 1), list, n)
    end do
    allocate (arcs, source=list(:n))
  end subroutine follow_die

  !> Arcs between two closest points, one for each piece between them.
  pure subroutine add_arcs_between(die, pilot, number, from, to, list, n)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)
    integer, intent(in) :: number
    type(closest_point_t), intent(in) :: from, to
    type(arc_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    type(arc_t) :: one
    real(wp) :: total, done, part
    integer :: count, i, pass, npiece

    npiece = size(die%pieces, 3)
    count = modulo(to%piece - from%piece, npiece) + 1
    if (count == 1 .and. to%xi < from%xi) count = npiece + 1
    total = 0
    do pass = 1, 2
      done = 0
      do i = 1, count
        one = placed_piece(die, pilot, modulo(from%piece + i - 2, npiece) + 1)
        one%die = number
        if (i == 1) one%range(1) = from%xi
        if (i == count) one%range(2) = to%xi
        if (one%range(2) - one%range(1) <= shortest_range) cycle
        part = length_between(one, one%range(1), one%range(2))
        if (pass == 1) then
          total = total + part
        else
          one%depth = from%d + (to%d - from%d)*[done, done + part]/total
          call append(one, list, n)
        end if
        done = done + part
      end do
    end do
  end subroutine add_arcs_between

  !> Append an arc, with the corner where the die has a vertex.
  pure subroutine append(one, list, n)
    type(arc_t), intent(in) :: one
    type(arc_t), intent(inout) :: list(:)
    integer, intent(inout) :: n
    type(arc_t) :: next, bridge
    real(wp) :: a, b
    logical :: met

    next = one
    do while (n > 0)
      if (list(n)%piece == next%piece .or. .not. is_vertex(list(n), next)) exit
      call meet(list(n), next, a, b, met)
      if (.not. met) then
        bridge = straight(point_at(list(n), list(n)%range(2)), point_at(next, next%range(1)))
        if (length_of(bridge%points(:, 3) - bridge%points(:, 1)) <= shortest_range*length_of(tangent_at(next, next%range(1)))) exit
        bridge%die = next%die
        bridge%piece = list(n)%piece
        n = n + 1
        list(n) = bridge
        exit
      else if (a - list(n)%range(1) > shortest_range) then
        list(n) = cut(list(n), list(n)%range(1), a)
        next = cut(next, b, next%range(2))
        exit
      end if
      ! the whole arc lies beyond the intersection
      n = n - 1
    end do
    n = n + 1
    list(n) = next
  end subroutine append

  !> The die turns between two arcs at a depth.
  pure function is_vertex(before, after) result(yes)
    type(arc_t), intent(in) :: before, after
    logical :: yes
    real(wp) :: one(2), other(2)

    one = flat_tangent(before, before%range(2))
    other = flat_tangent(after, after%range(1))
    yes = abs(after%depth(1)) > 0 .and. (abs(cross(one, other)) > smooth_turn*length_of(one)*length_of(other) &
                                         .or. dot_product(one, other) < 0)
  end function is_vertex

  !> Tangent of the die itself.
  pure function flat_tangent(arc, xi) result(tangent)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: xi
    real(wp) :: tangent(2)
    type(arc_t) :: flat

    flat = arc
    flat%depth = 0
    tangent = tangent_at(flat, xi)
  end function flat_tangent

  !> Intersection of two curves at depth near a vertex: Newton's method on X1(a) - X2(b) = 0.
  pure subroutine meet(before, after, a, b, met)
    type(arc_t), intent(in) :: before, after
    real(wp), intent(out) :: a, b
    logical, intent(out) :: met
    real(wp) :: gap(2), one(2), other(2), det, near, step(2)
    integer :: iteration
    integer, parameter :: most_iterations = 30

    a = before%range(2)
    b = after%range(1)
    near = longest_mitre*max(abs(before%depth(2)), abs(after%depth(1)))
    met = .false.
    do iteration = 1, most_iterations
      gap = point_at(before, a) - point_at(after, b)
      one = tangent_at(before, a)
      other = tangent_at(after, b)
      det = cross(one, other)
      if (.not. abs(det) > smooth_turn*length_of(one)*length_of(other)) return
      step = [-cross(gap, other), -cross(gap, one)]/det
      a = a + step(1)
      b = b + step(2)
      if (abs(a - before%range(2))*length_of(one) > 2*near .or. abs(b - after%range(1))*length_of(other) > 2*near) return
      met = maxval(abs(step)) <= 8*eps
      if (met) exit
    end do
    ! no intersection at an inverted cusp, or on an arc of no length
    met = length_of(gap) <= shortest_range*(length_of(one) + length_of(other)) .and. b < after%range(2) .and. &
          abs(a - before%range(2))*length_of(one) <= near .and. abs(b - after%range(1))*length_of(other) <= near
  end subroutine meet

end module arcs_on_die
