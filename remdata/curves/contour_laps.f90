!> Laps: contours that cross themselves or each other, which a new mesh would close or separate.
!>
!> Arcs are approximated by chords; where chords cross, the crossing of the arcs is found by Newton's method. Two bodies in contact
!> overlap by the depth of contact: arcs that follow a deformable die may cross that die, and so may sides that face it, where
!> contact covers too little of a side to be a contact interval.
module contour_laps
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t, joint_after, joint_point, kind_entry, kind_exit
  use kinds, only: eps, wp
  use offset_parabolas, only: point_at, tangent_at
  use plane_vectors, only: cross
  use vectors, only: length_of
  implicit none
  private
  public :: lap_t, find_laps

  type :: lap_t
    !> Boundary curves and arcs that cross.
    integer :: boundaries(2) = 0, arcs(2) = 0
    real(wp) :: point(2) = 0.0_wp   !! [length]
  end type lap_t

  !> Chords of an arc.
  integer, parameter :: nchord = 8
  !> Ends of contact touch the die: crossings within this share of the arc from them are ignored.
  real(wp), parameter :: touching = 1.0e-6_wp
  !> Distance, in depths, from a corner in contact to where its free side leaves the die: sides at 20 degrees or more to it.
  real(wp), parameter :: oblique = 3.0_wp

contains

  !> All crossings, sorted by boundary curves and arcs.
  pure subroutine find_laps(boundaries, on_die, faces, laps)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    integer, intent(in) :: on_die(:, :)                   !! deformable die that a side is a piece of, or 0 (nside, nboundary)
    logical, intent(in) :: faces(:, :, :)                 !! a side has elements of contact with a die (ndie, nside, nboundary)
    type(lap_t), allocatable, intent(out) :: laps(:)      !! (nlap)
    real(wp), allocatable :: boxes(:, :)
    integer, allocatable :: boundary_of(:), arc_of(:)
    type(lap_t) :: one
    logical :: crossed
    integer :: c, i, k, n

    n = 0
    do c = 1, size(boundaries)
      n = n + size(boundaries(c)%arcs)
    end do
    allocate (boxes(4, n), boundary_of(n), arc_of(n), laps(0))
    n = 0
    do c = 1, size(boundaries)
      do k = 1, size(boundaries(c)%arcs)
        n = n + 1
        boundary_of(n) = c
        arc_of(n) = k
        boxes(:, n) = box_of(boundaries(c)%arcs(k))
      end do
    end do
    do i = 1, n
      do k = i + 1, n
        if (any(boxes(1:2, i) > boxes(3:4, k)) .or. any(boxes(1:2, k) > boxes(3:4, i))) cycle
        one%boundaries = boundary_of([i, k])
        one%arcs = arc_of([i, k])
        if (may_touch(boundaries, on_die, faces, one)) cycle
        call find_crossing(boundaries(one%boundaries(1)), boundaries(one%boundaries(2)), one, crossed)
        if (crossed) crossed = .not. is_end_of_die(boundaries, on_die, one)
        if (crossed) laps = [laps, one]
      end do
    end do
  end subroutine find_laps

  !> Box around the points that the chords join (xmin, ymin, xmax, ymax).
  pure function box_of(arc) result(box)
    type(arc_t), intent(in) :: arc
    real(wp) :: box(4)
    real(wp) :: p(2, 0:nchord)

    p = chord_points(arc)
    box = [minval(p, 2), maxval(p, 2)]
  end function box_of

  pure function chord_points(arc) result(p)
    type(arc_t), intent(in) :: arc
    real(wp) :: p(2, 0:nchord)
    integer :: k

    do k = 0, nchord
      p(:, k) = point_at(arc, arc%range(1) + (arc%range(2) - arc%range(1))*k/nchord)
    end do
  end function chord_points

  !> One arc follows the deformable die that the other arc is a side of, or belongs to a side that faces it.
  pure function may_touch(boundaries, on_die, faces, lap) result(may)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    integer, intent(in) :: on_die(:, :)
    logical, intent(in) :: faces(:, :, :)
    type(lap_t), intent(in) :: lap
    logical :: may
    integer :: k, other

    may = .false.
    do k = 1, 2
      other = 3 - k
      associate (one => boundaries(lap%boundaries(k))%arcs(lap%arcs(k)), &
                 die => on_die(boundaries(lap%boundaries(other))%arcs(lap%arcs(other))%side, lap%boundaries(other)))
        if (die == 0) cycle
        may = may .or. one%die == die .or. faces(die, one%side, lap%boundaries(k))
      end associate
    end do
  end function may_touch

  !> One arc continues past the end of the deformable die that it follows and crosses the side behind it.
  pure function is_end_of_die(boundaries, on_die, lap) result(yes)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    integer, intent(in) :: on_die(:, :)
    type(lap_t), intent(in) :: lap
    logical :: yes
    integer :: k, i, n, die, arc, before

    yes = .false.
    do k = 1, 2
      die = boundaries(lap%boundaries(k))%arcs(lap%arcs(k))%die
      if (die == 0) cycle
      associate (other => boundaries(lap%boundaries(3 - k)), on => on_die(:, lap%boundaries(3 - k)))
        n = size(other%arcs)
        do i = 0, 1
          arc = modulo(lap%arcs(3 - k) + i - 1, n) + 1
          before = modulo(arc - 2, n) + 1
          if (on(other%arcs(arc)%side) /= die .and. on(other%arcs(before)%side) /= die) cycle
          yes = yes .or. length_of(joint_point(other, arc) - lap%point) &
                <= oblique*maxval(abs(boundaries(lap%boundaries(k))%arcs(lap%arcs(k))%depth))
        end do
      end associate
    end do
  end function is_end_of_die

  !> The first crossing of two arcs, other than a joint that they share.
  pure subroutine find_crossing(boundary, other, lap, crossed)
    type(boundary_curve_t), intent(in) :: boundary, other
    type(lap_t), intent(inout) :: lap
    logical, intent(out) :: crossed
    real(wp) :: p(2, 0:nchord), q(2, 0:nchord), xi(2)
    logical :: follow
    integer :: i, k

    crossed = .false.
    follow = lap%boundaries(1) == lap%boundaries(2) .and. (joint_after(boundary, lap%arcs(1)) == lap%arcs(2) .or. &
                                                   joint_after(boundary, lap%arcs(2)) == lap%arcs(1))
    associate (one => boundary%arcs(lap%arcs(1)), two => other%arcs(lap%arcs(2)))
      p = chord_points(one)
      q = chord_points(two)
      do i = 1, nchord
        do k = 1, nchord
          if (.not. chords_cross(p(:, i - 1:i), q(:, k - 1:k))) cycle
          xi = [one%range(1) + (one%range(2) - one%range(1))*(i - 0.5_wp)/nchord, &
                two%range(1) + (two%range(2) - two%range(1))*(k - 0.5_wp)/nchord]
          call refine_crossing(one, two, xi, crossed)
          if (.not. crossed) cycle
          lap%point = point_at(one, xi(1))
          crossed = .not. (is_shared(one, two, follow, lap%point) .or. is_end_of_contact(boundary, lap%arcs(1), lap%point) &
                           .or. is_end_of_contact(other, lap%arcs(2), lap%point))
          if (crossed) return
        end do
      end do
    end associate
  end subroutine find_crossing

  !> The point is the joint of two consecutive arcs, or a node that two loops have in common.
  pure function is_shared(one, two, follow, point) result(shared)
    type(arc_t), intent(in) :: one, two
    logical, intent(in) :: follow
    real(wp), intent(in) :: point(2)
    logical :: shared
    real(wp) :: p(2), q(2)
    integer :: i, k

    shared = .false.
    do i = 1, 2
      do k = 1, 2
        p = point_at(one, one%range(i))
        q = point_at(two, two%range(k))
        if (.not. follow .and. any(abs(p - q) > 0)) cycle
        shared = shared .or. max(length_of(p - point), length_of(q - point)) <= touching*min(extent(one), extent(two))
      end do
    end do
  end function is_shared

  !> The point is an end of contact on an arc, within a distance of the order of the depth.
  pure function is_end_of_contact(boundary, k, point) result(yes)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    real(wp), intent(in) :: point(2)
    logical :: yes
    real(wp) :: slack
    integer :: joint, before

    yes = .false.
    do joint = 1, size(boundary%kinds)
      if (boundary%kinds(joint) /= kind_entry .and. boundary%kinds(joint) /= kind_exit) cycle
      before = merge(size(boundary%kinds), joint - 1, joint == 1)
      if (joint /= k .and. before /= k) cycle
      slack = touching*extent(boundary%arcs(k)) + oblique*max(abs(boundary%arcs(joint)%depth(1)), &
                                                               abs(boundary%arcs(before)%depth(2)))
      yes = yes .or. length_of(joint_point(boundary, joint) - point) <= slack
    end do
  end function is_end_of_contact

  pure function extent(arc) result(length)
    type(arc_t), intent(in) :: arc
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

  !> Newton's method on X1(a) - X2(b) = 0 from where the chords cross.
  pure subroutine refine_crossing(one, two, xi, met)
    type(arc_t), intent(in) :: one, two
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

end module contour_laps
