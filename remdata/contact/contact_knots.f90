!> Feet of a run of contact on its die: places and depths that the corrected contour goes through.
!>
!> The depth of an old point of contact in its die is what carries its pressure, p = multiplier + AKP d, so the contour that
!> runs through the old depths gives the old pressures back. Only integration points are asked: between them the old side
!> bends away from the die. At its ends the run goes through the part's own point, so that nothing opens there; so it does where the
!> solver found an end that was moved outwards (contact_runs).
!>
!> Feet are searched between those of the ends, along the die, and must follow each other: a point that folded back over its
!> neighbour gives no knot.
module contact_knots
  use boundary_sides, only: loop_t
  use contact_runs, only: along, run_t, spot_t
  use contact_stretches, only: knot_t, placed_piece
  use dies, only: die_t
  use kinds, only: eps, wp
  use quadrature, only: line_rule
  use side_tags, only: same_tags, side_tags_t
  use stretches, only: closest_xi, point_at, stretch_t, tangent_at
  use vectors, only: length_of
  implicit none
  private
  public :: section_t, begin_at_point, sections_of_run, point_of_spot, find_knot, way_between

  !> Part of a run on sides of one kind.
  type :: section_t
    integer :: side = 0   !! the first side it stands for
    type(knot_t), allocatable :: knots(:)
  end type section_t

  !> Pieces are followed past their ends, in half pieces, where a point lies behind a corner of the die.
  real(wp), parameter :: beyond = 2.0_wp
  !> A foot is one when its normal goes through the point within this share of the side.
  real(wp), parameter :: foot_accuracy = 1.0e-9_wp
  !> Knots closer than this, in half pieces, are one.
  real(wp), parameter :: same_knot = 1.0e-9_wp

contains

  !> Where a side dives into the die so steeply that a corner would be left at the first point in contact, a crumb behind the
  !> beginning, or at the last one before the end, the run begins or ends in the point, and the corner with it.
  !> Ends that are shared with another run stay, and so does a run that nothing much would be left of.
  pure subroutine begin_at_point(npoint, loop, x, die, pilot, least, turn, shared, run)
    integer, intent(in) :: npoint        !! rule of the group's points
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)      !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)
    real(wp), intent(in) :: least        !! crumb [sides]
    real(wp), intent(in) :: turn         !! that makes a corner [radian]
    logical, intent(in) :: shared(2)
    type(run_t), intent(inout) :: run
    type(run_t) :: moved
    type(spot_t) :: point
    real(wp), allocatable :: xi(:), weight(:)

    call line_rule(npoint, xi, weight)
    moved = run
    point = run%from
    point%xi = minval(xi, mask=xi > run%from%xi)
    if (point%xi < min(1.0_wp, run%from%xi + 2*least) .and. .not. shared(1)) then
      if (is_steep(run%from, point)) moved%from = point
    end if
    point = run%to
    point%xi = maxval(xi, mask=xi < run%to%xi)
    if (point%xi > max(-1.0_wp, run%to%xi - 2*least) .and. .not. shared(2)) then
      if (is_steep(run%to, point)) moved%to = point
    end if
    if (along(moved%to) - along(moved%from) >= least) run = moved

  contains

    pure function is_steep(edge, inside) result(yes)
      type(spot_t), intent(in) :: edge, inside
      logical :: yes
      type(knot_t) :: knots(2)
      real(wp) :: ends(2, 2)
      integer :: k
      logical :: sound(2)

      ends(:, 1) = point_of_spot(loop, x, edge)
      ends(:, 2) = point_of_spot(loop, x, inside)
      do k = 1, 2
        call find_knot(die, pilot, ends(:, k), [1, size(die%pieces, 3)], .true., knots(k), sound(k))
      end do
      yes = all(sound) .and. knots(2)%depth - knots(1)%depth > sin(turn)*length_of(ends(:, 2) - ends(:, 1))
    end function is_steep

  end subroutine begin_at_point

  !> Sections of a run with their knots; none when the run goes backwards along the die.
  pure subroutine sections_of_run(run, npoint, loop, tags, x, die, pilot, sections)
    type(run_t), intent(in) :: run
    integer, intent(in) :: npoint               !! rule of the group's points
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)             !! nodes now (2, nnode) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)
    type(section_t), allocatable, intent(out) :: sections(:)
    type(section_t) :: list(run%to%side - run%from%side + 1)
    type(knot_t) :: start, finish, before, after
    type(spot_t) :: spot, from
    integer :: k, n, nside, whole(2)

    nside = size(loop%sides, 2)
    n = 0
    whole = [1, size(die%pieces, 3)]
    start = foot(point_of_spot(loop, x, run%from), around(run%from%piece), .true.)
    finish = foot(point_of_spot(loop, x, run%to), around(run%to%piece), .false.)
    whole = [start%piece, finish%piece]
    allocate (sections(0))
    if (.not. way_between(die, start, finish) > same_knot) return
    from = run%from
    do k = run%from%side, run%to%side
      if (k < run%to%side) then
        if (same_tags(tags, wrapped(k), wrapped(k + 1))) cycle
        spot = spot_t(k, 1.0_wp)
        before = foot(point_of_spot(loop, x, spot), whole, .false.)
        after = foot(point_of_spot(loop, x, spot), whole, .true.)
        ! where a set of sides folded back over another one it has no place left
        if (.not. (way_between(die, start, before) > same_knot .and. way_between(die, after, finish) > same_knot)) cycle
      else
        spot = run%to
        before = finish
      end if
      n = n + 1
      list(n)%side = wrapped(from%side)
      call list_knots(from, spot, start, before, list(n)%knots)
      start = after
      from = spot_t(k + 1, -1.0_wp)
    end do
    deallocate (sections)
    allocate (sections, source=list(:n))

  contains

    pure function wrapped(side) result(k)
      integer, intent(in) :: side
      integer :: k

      k = modulo(side - 1, nside) + 1
    end function wrapped

    !> Pieces beside one that is known.
    pure function around(piece) result(pieces)
      integer, intent(in) :: piece
      integer :: pieces(2)

      pieces = [1, size(die%pieces, 3)]
      if (piece == 0) return
      if (.not. die%closed) then
        pieces = min(max([piece - 1, piece + 1], 1), pieces(2))
      else if (pieces(2) > 3) then
        pieces = modulo([piece - 2, piece], pieces(2)) + 1
      end if
    end function around

    pure function foot(point, pieces, begins) result(knot)
      real(wp), intent(in) :: point(2)
      integer, intent(in) :: pieces(2)
      logical, intent(in) :: begins
      type(knot_t) :: knot
      logical :: sound

      call find_knot(die, pilot, point, pieces, begins, knot, sound)
    end function foot

    !> The ends, and between them the feet of integration points that follow each other.
    pure subroutine list_knots(first, last, start, finish, knots)
      type(spot_t), intent(in) :: first, last
      type(knot_t), intent(in) :: start, finish
      type(knot_t), allocatable, intent(out) :: knots(:)
      type(knot_t) :: list((abs(npoint) + 1)*(last%side - first%side + 1) + 4)
      real(wp), allocatable :: xi(:), weight(:)
      integer :: k, p, n

      call line_rule(npoint, xi, weight)
      n = 1
      list(1) = start
      call follow(run%found(1), first, last, finish, list, n)
      do k = first%side, last%side
        do p = 1, size(xi)
          call follow(spot_t(k, xi(p)), first, last, finish, list, n)
        end do
      end do
      call follow(run%found(2), first, last, finish, list, n)
      n = n + 1
      list(n) = finish
      allocate (knots, source=list(:n))
    end subroutine list_knots

    !> Add the foot of a place within a section, if it lies behind those before.
    pure subroutine follow(spot, first, last, finish, list, n)
      type(spot_t), intent(in) :: spot, first, last
      type(knot_t), intent(in) :: finish
      type(knot_t), intent(inout) :: list(:)
      integer, intent(inout) :: n
      type(knot_t) :: knot
      logical :: sound

      if (along(spot) <= along(first) .or. along(spot) >= along(last)) return
      call find_knot(die, pilot, point_of_spot(loop, x, spot), [list(1)%piece, finish%piece], .true., knot, sound)
      if (.not. sound) return
      if (.not. (way_between(die, list(n), knot) > same_knot .and. way_between(die, knot, finish) > same_knot)) return
      n = n + 1
      list(n) = knot
    end subroutine follow

  end subroutine sections_of_run

  !> Point of a side [length].
  pure function point_of_spot(loop, x, spot) result(point)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :)
    type(spot_t), intent(in) :: spot
    real(wp) :: point(2)
    type(stretch_t) :: side

    side%points = x(:, loop%sides(:, modulo(spot%side - 1, size(loop%sides, 2)) + 1))
    point = point_at(side, spot%xi)
  end function point_of_spot

  !> Half pieces of the die from one knot to another, below zero when the other lies behind; the short way on a closed die.
  pure function way_between(die, from, to) result(way)
    type(die_t), intent(in) :: die
    type(knot_t), intent(in) :: from, to
    real(wp) :: way
    integer :: npiece

    npiece = size(die%pieces, 3)
    way = 2*(to%piece - from%piece) + (to%xi - from%xi)
    if (.not. die%closed) return
    if (way > npiece) way = way - 2*npiece
    if (way <= -npiece) way = way + 2*npiece
  end function way_between

  !> Closest foot of a point on some pieces, and its depth. In a corner of the die, where no normal of a piece goes through the
  !> point, the piece before the corner is followed on where contact ends, the piece behind it where contact begins.
  pure subroutine find_knot(die, pilot, point, pieces, begins, knot, sound)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3), point(2)
    integer, intent(in) :: pieces(2)       !! first and last; across the start of a closed die when the last is lower
    logical, intent(in) :: begins
    type(knot_t), intent(out) :: knot
    logical, intent(out) :: sound          !! the point lies over the piece, not in a corner
    type(stretch_t) :: one
    real(wp) :: xi, distance, least, normal(2), slack, local(2)
    integer :: k, piece, npiece, count

    associate (way => point - pilot(1:2), c => cos(pilot(3)), s => sin(pilot(3)))
      local = [c*way(1) + s*way(2), -s*way(1) + c*way(2)]
    end associate
    slack = 16*eps*max(maxval(abs(point)), maxval(abs(pilot(1:2))), maxval(abs(local)))
    npiece = size(die%pieces, 3)
    count = modulo(pieces(2) - pieces(1), npiece) + 1
    if (.not. die%closed .and. pieces(2) < pieces(1)) count = 1
    least = huge(least)
    do k = 0, count - 1
      piece = modulo(pieces(1) + k - 1, npiece) + 1
      if (length_of(max(die%boxes(1:2, piece) - local, local - die%boxes(3:4, piece), 0.0_wp)) > least + slack) cycle
      one = placed_piece(die, pilot, piece)
      xi = closest_xi(one, point)
      distance = length_of(point_at(one, xi) - point)
      ! the point of a vertex is that of two pieces
      if (distance > least + slack .or. distance >= least - slack .and. .not. begins) cycle
      least = distance
      knot%piece = piece
      knot%xi = xi
    end do
    one = placed_piece(die, pilot, knot%piece)
    sound = is_over()
    if (.not. sound) then
      one%range = [-beyond, beyond]
      knot%xi = closest_xi(one, point)
    end if
    normal = tangent_at(one, knot%xi)
    normal = [normal(2), -normal(1)]/length_of(normal)
    knot%depth = dot_product(point - point_at(one, knot%xi), normal)

  contains

    pure function is_over() result(yes)
      logical :: yes
      real(wp) :: tangent(2)

      tangent = tangent_at(one, knot%xi)
      yes = abs(dot_product(point - point_at(one, knot%xi), tangent)) <= foot_accuracy*dot_product(tangent, tangent)
    end function is_over

  end subroutine find_knot

end module contact_knots
