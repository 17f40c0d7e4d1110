!> Crossings of two arcs.
!>
!> Arcs are approximated by chords; where chords cross, the crossing of the arcs is found by Newton's method. So one is missed
!> beside an end of an arc that lies between the other one and its chord, unless it is looked for wherever chords come as near as
!> arcs are off them.
module arc_crossings
  use box_tree, only: box_tree_t, build_tree, items_meeting
  use kinds, only: eps, wp
  use offset_parabolas, only: offset_parabola_t, point_at, tangent_at
  use parabolas, only: bend_of
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: box_around, crossings_between, extent, find_meeting_arcs, most_crossings, touching

  !> Chords of an arc.
  integer, parameter :: nchord = 8
  !> Crossings that are listed: two parabolas have four.
  integer, parameter :: most_crossings = 8
  !> Round-off of a crossing, as a share of an arc.
  real(wp), parameter :: touching = 1.0e-6_wp

contains

  !> Box around an arc (xmin, ymin, xmax, ymax) [length].
  pure function box_around(arc) result(box)
    class(offset_parabola_t), intent(in) :: arc
    real(wp) :: box(4)
    real(wp) :: p(2, 0:nchord)

    p = chord_points(arc)
    box = [minval(p, 2) - off_chords(arc), maxval(p, 2) + off_chords(arc)]
  end function box_around

  !> How far an arc is off its chords at most: an eighth of its second derivative by the square of a chord's range.
  pure function off_chords(arc) result(distance)
    class(offset_parabola_t), intent(in) :: arc
    real(wp) :: distance   !! [length]

    distance = length_of(bend_of(arc%points))*((arc%range(2) - arc%range(1))/nchord)**2/8
  end function off_chords

  !> Pairs of arcs whose boxes meet, the lower number first, in its order.
  pure subroutine find_meeting_arcs(arcs, pairs)
    class(offset_parabola_t), intent(in) :: arcs(:)     !! (narc)
    integer, allocatable, intent(out) :: pairs(:, :)    !! (2, npair)
    type(box_tree_t) :: tree
    real(wp) :: boxes(4, size(arcs))
    integer :: meeting(size(arcs)), found, i, n
    integer, allocatable :: list(:, :), longer(:, :)

    do i = 1, size(arcs)
      boxes(:, i) = box_around(arcs(i))
    end do
    call build_tree(boxes, [(i, i=1, size(arcs))], tree)
    ! every arc of a contour meets its neighbours
    allocate (list(2, 2*size(arcs)))
    n = 0
    do i = 1, size(arcs)
      call items_meeting(tree, boxes(:, i), found, meeting)
      associate (others => pack(meeting(:found), meeting(:found) > i))
        if (n + size(others) > size(list, 2)) then
          allocate (longer(2, 2*(n + size(others))))
          longer(:, :n) = list(:, :n)
          call move_alloc(longer, list)
        end if
        list(1, n + 1:n + size(others)) = i
        list(2, n + 1:n + size(others)) = others
        n = n + size(others)
      end associate
    end do
    pairs = list(:, :n)
  end subroutine find_meeting_arcs

  pure function chord_points(arc) result(p)
    class(offset_parabola_t), intent(in) :: arc
    real(wp) :: p(2, 0:nchord)
    integer :: k

    do k = 0, nchord
      p(:, k) = point_at(arc, arc%range(1) + (arc%range(2) - arc%range(1))*k/nchord)
    end do
  end function chord_points

  !> Parent coordinates at which two arcs cross, in the order of the first one's chords; a joint that they share may be among them.
  pure subroutine crossings_between(one, two, n, xi, at_ends)
    class(offset_parabola_t), intent(in) :: one, two
    integer, intent(out) :: n
    real(wp), intent(out) :: xi(:, :)   !! (2, most_crossings) on the one and on the other, the first n [-]
    logical, intent(in), optional :: at_ends   !! those beside ends too
    real(wp) :: p(2, 0:nchord), q(2, 0:nchord)
    real(wp) :: off, found(2), same(2)
    logical :: crossed
    integer :: i, k, m

    n = 0
    p = chord_points(one)
    q = chord_points(two)
    off = 0
    if (present(at_ends)) then
      if (at_ends) off = off_chords(one) + off_chords(two)
    end if
    same = touching*[one%range(2) - one%range(1), two%range(2) - two%range(1)]
    do i = 1, nchord
      do k = 1, nchord
        if (.not. (chords_cross(p(:, i - 1:i), q(:, k - 1:k)) .or. chords_are_near(p(:, i - 1:i), q(:, k - 1:k), off))) cycle
        found = [one%range(1) + (one%range(2) - one%range(1))*(i - 0.5_wp)/nchord, &
                 two%range(1) + (two%range(2) - two%range(1))*(k - 0.5_wp)/nchord]
        call refine_crossing(one, two, found, crossed)
        ! several chords are near one crossing
        if (crossed) crossed = .not. any([(all(abs(xi(:, m) - found) <= same), m=1, n)])
        if (.not. crossed) cycle
        n = n + 1
        xi(:, n) = found
        if (n == size(xi, 2)) return
      end do
    end do
  end subroutine crossings_between

  !> Chord of an arc's parabola [length].
  pure function extent(arc) result(length)
    class(offset_parabola_t), intent(in) :: arc
    real(wp) :: length

    length = length_of(arc%points(:, 3) - arc%points(:, 1))
  end function extent

  !> The ends of each chord lie on either side of the other one; points on a chord count as left of it.
  pure function chords_cross(p, q) result(yes)
    real(wp), intent(in) :: p(2, 2), q(2, 2)
    logical :: yes
    real(wp) :: a(2), b(2)

    a = p(:, 2) - p(:, 1)
    b = q(:, 2) - q(:, 1)
    yes = (cross(a, q(:, 1) - p(:, 1)) < 0 .neqv. cross(a, q(:, 2) - p(:, 1)) < 0) .and. &
          (cross(b, p(:, 1) - q(:, 1)) < 0 .neqv. cross(b, p(:, 2) - q(:, 1)) < 0)
  end function chords_cross

  !> An end of one chord is within a distance of the other chord.
  pure function chords_are_near(p, q, distance) result(yes)
    real(wp), intent(in) :: p(2, 2), q(2, 2), distance   !! [length]
    logical :: yes
    integer :: k

    yes = .false.
    if (.not. distance > 0 .or. any(min(p(:, 1), p(:, 2)) - distance > max(q(:, 1), q(:, 2))) &
        .or. any(min(q(:, 1), q(:, 2)) - distance > max(p(:, 1), p(:, 2)))) return
    do k = 1, 2
      yes = yes .or. distance_to_chord(p(:, k), q) <= distance .or. distance_to_chord(q(:, k), p) <= distance
    end do
  end function chords_are_near

  pure function distance_to_chord(point, chord) result(distance)
    real(wp), intent(in) :: point(2), chord(2, 2)
    real(wp) :: distance
    real(wp) :: along(2), share

    along = chord(:, 2) - chord(:, 1)
    share = dot_product(point - chord(:, 1), along)/max(dot_product(along, along), tiny(1.0_wp))
    distance = length_of(point - chord(:, 1) - min(max(share, 0.0_wp), 1.0_wp)*along)
  end function distance_to_chord

  !> Newton's method on X1(a) - X2(b) = 0 from where the chords cross.
  pure subroutine refine_crossing(one, two, xi, met)
    class(offset_parabola_t), intent(in) :: one, two
    real(wp), intent(inout) :: xi(2)
    logical, intent(out) :: met
    real(wp) :: gap(2), a(2), b(2), det, step(2), slack(2)
    integer :: iteration
    integer, parameter :: most_iterations = 30

    slack = touching*[one%range(2) - one%range(1), two%range(2) - two%range(1)]
    met = .false.
    do iteration = 1, most_iterations
      gap = point_at(one, xi(1)) - point_at(two, xi(2))
      a = tangent_at(one, xi(1))
      b = tangent_at(two, xi(2))
      det = cross(a, b)
      if (.not. abs(det) > eps*length_of(a)*length_of(b)) return
      step = [-cross(gap, b), -cross(gap, a)]/det
      xi = min(max(xi + step, [one%range(1), two%range(1)]), [one%range(2), two%range(2)])
      if (maxval(abs(step)) <= 64*eps) exit
    end do
    gap = point_at(one, xi(1)) - point_at(two, xi(2))
    met = all(abs(step) <= slack) .and. length_of(gap) <= touching*min(extent(one), extent(two))
  end subroutine refine_crossing

end module arc_crossings
