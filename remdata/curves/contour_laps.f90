!> Laps: contours that cross themselves or each other, which a new mesh would close or separate.
!>
!> Two bodies in contact overlap by the depth of contact: arcs that follow a deformable die may cross that die, and so may sides
!> that face it, where contact covers too little of a side to be a contact interval.
module contour_laps
  use arc_crossings, only: box_around, crossings_between, extent, most_crossings, touching
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t, joint_after, joint_point, kind_entry, kind_exit
  use kinds, only: wp
  use offset_parabolas, only: point_at
  use touching_sectors, only: sectors_overlap
  use vectors, only: length_of
  implicit none
  private
  public :: lap_t, find_laps

  type :: lap_t
    !> Boundary curves and arcs that cross.
    integer :: boundaries(2) = 0, arcs(2) = 0
    real(wp) :: point(2) = 0.0_wp   !! [length]
  end type lap_t

  !> Distance, in depths, from a corner in contact to where its free side leaves the die: sides at 20 degrees or more to it.
  real(wp), parameter :: oblique = 3.0_wp
  !> Distance of the points of contact on a side that faces a body, over the side (contact_rule: 33 points at least).
  real(wp), parameter :: pitch = 1.0_wp/32

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
        boxes(:, n) = box_around(boundaries(c)%arcs(k))
      end do
    end do
    do i = 1, n
      do k = i + 1, n
        if (any(boxes(1:2, i) > boxes(3:4, k)) .or. any(boxes(1:2, k) > boxes(3:4, i))) cycle
        one%boundaries = boundary_of([i, k])
        one%arcs = arc_of([i, k])
        if (may_touch(boundaries, on_die, faces, one)) cycle
        call find_crossing(boundaries(one%boundaries(1)), boundaries(one%boundaries(2)), one, crossed)
        if (crossed) crossed = .not. (is_end_of_die(boundaries, on_die, one) .or. is_end_of_pair(boundaries, on_die, faces, one))
        if (crossed) laps = [laps, one]
      end do
    end do
  end subroutine find_laps

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

  !> Two bodies cross beside the end of what they touch with: a corner of one is in the side of the other, or both corners overlap.
  !> The points of contact, a pitch apart, need not see it, and it may be no contact interval.
  pure function is_end_of_pair(boundaries, on_die, faces, lap) result(yes)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    integer, intent(in) :: on_die(:, :)
    logical, intent(in) :: faces(:, :, :)
    type(lap_t), intent(in) :: lap
    logical :: yes
    integer :: k, d, i, j, sides(3, 2)

    yes = .false.
    if (lap%boundaries(1) == lap%boundaries(2)) return
    do k = 1, 2
      sides(:, k) = sides_beside(boundaries(lap%boundaries(k)), lap%arcs(k), lap%point)
    end do
    do k = 1, 2
      do i = 1, 3
        do j = 1, 3
          if (sides(i, k) == 0 .or. sides(j, 3 - k) == 0) cycle
          d = on_die(sides(j, 3 - k), lap%boundaries(3 - k))
          if (d > 0) yes = yes .or. faces(d, sides(i, k), lap%boundaries(k))
        end do
      end do
    end do
  end function is_end_of_pair

  !> Sides of an arc and of those before and after it whose joint is near a point, 0 where it is not.
  pure function sides_beside(boundary, k, point) result(sides)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    real(wp), intent(in) :: point(2)   !! [length]
    integer :: sides(3)
    integer :: before, next

    before = modulo(k - 2, size(boundary%arcs)) + 1
    next = joint_after(boundary, k)
    sides = [0, boundary%arcs(k)%side, 0]
    if (is_near(k, before)) sides(1) = boundary%arcs(before)%side
    if (is_near(next, next)) sides(3) = boundary%arcs(next)%side

  contains

    pure function is_near(joint, other) result(near)
      integer, intent(in) :: joint, other   !! the arc that begins at the joint, the arc beyond it
      logical :: near

      near = length_of(joint_point(boundary, joint) - point) <= pitch*min(extent(boundary%arcs(k)), extent(boundary%arcs(other)))
    end function is_near

  end function sides_beside

  !> The first crossing of two arcs, other than a joint that they share, or a point in which two bodies only touch.
  pure subroutine find_crossing(boundary, other, lap, crossed)
    type(boundary_curve_t), intent(in) :: boundary, other
    type(lap_t), intent(inout) :: lap
    logical, intent(out) :: crossed
    real(wp) :: xi(2, most_crossings)
    logical :: follow
    integer :: i, n

    crossed = .false.
    follow = lap%boundaries(1) == lap%boundaries(2) .and. (joint_after(boundary, lap%arcs(1)) == lap%arcs(2) .or. &
                                                   joint_after(boundary, lap%arcs(2)) == lap%arcs(1))
    associate (one => boundary%arcs(lap%arcs(1)), two => other%arcs(lap%arcs(2)))
      call crossings_between(one, two, n, xi)
      do i = 1, n
        lap%point = point_at(one, xi(1, i))
        crossed = .not. (is_shared(one, two, follow, lap%point) .or. is_end_of_contact(boundary, lap%arcs(1), lap%point) &
                         .or. is_end_of_contact(other, lap%arcs(2), lap%point))
        if (crossed .and. lap%boundaries(1) /= lap%boundaries(2)) &
          crossed = sectors_overlap(boundary, lap%arcs(1), xi(1, i), other, lap%arcs(2), xi(2, i))
        if (crossed) return
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

end module contour_laps
