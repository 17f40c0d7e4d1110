!> The sides of zones as curves parametrised by arc length, with the lengths at which elements must end.
!>
!> A side along the contour has breaks at corners of the contour, where contact begins or ends, and where another set of sides
!> begins: these are ends of elements. A side along an interface has breaks at corners of the interface.
module side_curves
  use arcs, only: arc_t, straight
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, joint_after, kind_corner, kind_entry, kind_exit, &
                             kind_joint, point_on, position_at_arc_length, position_t
  use kinds, only: wp
  use offset_parabolas, only: exact_point, length_between, point_at, xi_at_length
  use size_field, only: size_at, size_field_t
  use vectors, only: length_of
  use zone_layout, only: side_arc_lengths
  use zones, only: coordinates_of, follows_contour, follows_interface, on_boundary, runs_curved, zone_layout_t, zone_point_t, &
                   zone_side_t, zone_t
  implicit none
  private
  public :: curve_t, snap_to_joints, draw_side, curve_point, has_course

  type :: curve_t
    integer :: boundary = 0
    !> Arc length on the boundary curve where it begins [length].
    real(wp) :: start = 0.0_wp
    !> Open curve along an interface, from the start to the end of the side.
    type(boundary_curve_t) :: path
    !> Straight line or parabola of a side inside.
    type(arc_t) :: line
    real(wp) :: ends(2, 2) = 0.0_wp   !! [length]
    real(wp) :: length = 0.0_wp       !! [length]
    !> Lengths where elements must end, both ends of the curve among them (0:npart).
    real(wp), allocatable :: breaks(:)
    !> Integral of 1/h: at lengths `at`, with breaks among them, `count` elements from the start.
    real(wp), allocatable :: at(:), count(:)
    !> Elements each part between breaks needs (npart).
    real(wp), allocatable :: needs(:)
  end type curve_t

  !> Breaks closer than this share of a boundary curve coincide, and so do an entry and a corner.
  real(wp), parameter :: same = 1.0e-9_wp
  !> No zone point beside a corner, and no entry or exit beside another break, leaves an element shorter than this share of the
  !> requested size.
  real(wp), parameter :: least_share = 0.1_wp

contains

  !> Zone points on a contour are moved to a corner of it, or to an end of contact, that is so near that no element fits
  !> between, unless they are fixed.
  pure subroutine snap_to_joints(boundaries, zones, field, points)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_t), intent(in) :: zones(:)                  !! (nzone)
    type(size_field_t), intent(in) :: field
    type(zone_point_t), intent(inout) :: points(:)   !! (npoint)
    real(wp) :: most
    integer :: z, i, k

    do z = 1, size(zones)
      do i = 1, 4
        associate (point => points(zones(z)%corners(i)))
          if (point%boundary == 0 .or. point%stays) cycle
          associate (boundary => boundaries(point%boundary))
            most = least_share*size_at(field, zones(z)%material, on_boundary(boundary, point%position))
            k = joint_near(boundary, arc_length_at(boundary, point%position), [kind_corner], most)
            if (k == 0) k = joint_near(boundary, arc_length_at(boundary, point%position), [kind_entry, kind_exit], most)
            if (k > 0) point%position = position_t(k, boundary%arcs(k)%range(1))
          end associate
        end associate
      end do
    end do
  end subroutine snap_to_joints

  !> The first arc that begins with a joint of one of these kinds, no further along the boundary than `most` from an arc length; 0
  !> where there is none.
  pure function joint_near(boundary, arc_length, kinds, most) result(k)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: arc_length, most   !! [length]
    integer, intent(in) :: kinds(:)            !! (n)
    integer :: k
    real(wp) :: apart

    do k = 1, size(boundary%arcs)
      if (all(boundary%kinds(k) /= kinds)) cycle
      apart = modulo(boundary%arc_length(k - 1) - arc_length, boundary_length(boundary))
      if (.not. min(apart, boundary_length(boundary) - apart) > most) return
    end do
    k = 0
  end function joint_near

  !> The curve of a side, with its breaks.
  pure subroutine draw_side(boundaries, layout, side, field, curve)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_layout_t), intent(in) :: layout
    type(zone_side_t), intent(in) :: side
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(out) :: curve
    real(wp) :: arc_length(2)
    integer :: i

    do i = 1, 2
      curve%ends(:, i) = coordinates_of(boundaries, layout%points(side%points(i)))
    end do
    if (side%form == follows_contour) then
      curve%boundary = side%boundary
      arc_length = side_arc_lengths(boundaries, layout, side)
      curve%start = arc_length(1)
      curve%length = arc_length(2) - arc_length(1)
      call find_breaks(boundaries(side%boundary), field, layout%zones(side%zones(1))%material, curve)
      return
    end if
    if (side%form == follows_interface) then
      call draw_path(layout%paths(side%path), field, layout%zones(side%zones(1))%material, curve)
      return
    end if
    curve%line = straight(curve%ends(:, 1), curve%ends(:, 2))
    if (side%form == runs_curved) curve%line%points(:, 2) = side%middle
    curve%length = length_between(curve%line, -1.0_wp, 1.0_wp)
    allocate (curve%breaks(0:1), source=[0.0_wp, curve%length])
  end subroutine draw_side

  !> A path in the direction of the side, with its corners as breaks.
  pure subroutine draw_path(path, field, material, curve)
    type(boundary_curve_t), intent(in) :: path
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    type(curve_t), intent(inout) :: curve
    real(wp) :: start(2)

    curve%path = path
    start = point_on(path, position_t(1, path%arcs(1)%range(1)))
    if (length_of(start - curve%ends(:, 1)) > length_of(start - curve%ends(:, 2))) curve%path = reversed(path)
    curve%length = boundary_length(curve%path)
    call find_breaks(curve%path, field, material, curve)
  end subroutine draw_path

  !> An open curve in the opposite direction.
  pure function reversed(path) result(back)
    type(boundary_curve_t), intent(in) :: path
    type(boundary_curve_t) :: back
    integer :: k, n

    n = size(path%arcs)
    allocate (back%arcs(n), back%kinds(n), back%arc_length(0:n))
    do k = 1, n
      back%arcs(k) = path%arcs(n + 1 - k)
      back%arcs(k)%points = back%arcs(k)%points(:, [3, 2, 1])
      back%arcs(k)%range = -back%arcs(k)%range([2, 1])
      back%arcs(k)%depth = back%arcs(k)%depth([2, 1])
    end do
    back%kinds(1) = path%kinds(1)
    back%kinds(2:) = path%kinds(n:2:-1)
    back%arc_length = path%arc_length(n) - path%arc_length(n:0:-1)
  end function reversed

  !> Whether a curve follows a contour or an interface, so that each of its parts gets the elements it needs.
  pure elemental function has_course(curve) result(yes)
    type(curve_t), intent(in) :: curve
    logical :: yes

    yes = curve%boundary > 0 .or. allocated(curve%path%arcs)
  end function has_course

  !> Corners between the ends of the curve, then joints, entries and exits that are not too close to others.
  pure subroutine find_breaks(boundary, field, material, curve)
    type(boundary_curve_t), intent(in) :: boundary
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    type(curve_t), intent(inout) :: curve
    real(wp) :: found(0:size(boundary%arcs) + 1), s, apart
    integer :: k, n, pass, i

    found(0:1) = [0.0_wp, curve%length]
    n = 1
    do pass = 1, 2
      do k = 1, size(boundary%arcs)
        if (pass == 1 .and. boundary%kinds(k) /= kind_corner) cycle
        if (pass == 2 .and. all(boundary%kinds(k) /= [kind_joint, kind_entry, kind_exit])) cycle
        s = modulo(boundary%arc_length(k - 1) - curve%start, boundary_length(boundary))
        if (s >= curve%length) cycle
        apart = same*boundary_length(boundary)
        if (pass == 2) apart = max(apart, least_share*size_at(field, material, &
                                                              point_at(boundary%arcs(k), boundary%arcs(k)%range(1))))
        if (minval(abs(found(:n) - s)) <= apart) cycle
        i = count(found(:n) < s)
        found(i + 1:n + 1) = found(i:n)
        found(i) = s
        n = n + 1
      end do
    end do
    allocate (curve%breaks(0:n), source=found(0:n))
  end subroutine find_breaks

  !> Point at an arc length from the start [length]; on a contour also its position. The ends are exactly those of the side.
  pure subroutine curve_point(boundaries, curve, s, x, position)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(curve_t), intent(in) :: curve
    real(wp), intent(in) :: s
    real(wp), intent(out) :: x(2)   !! [length]
    type(position_t), intent(out) :: position
    type(position_t) :: along

    if (curve%boundary > 0) then
      position = position_at_arc_length(boundaries(curve%boundary), curve%start + s)
      ! a break is the start of an arc, not the end of the previous one
      associate (boundary => boundaries(curve%boundary))
        if (abs(boundary%arc_length(position%arc) - modulo(curve%start + s, boundary_length(boundary))) &
            <= same*boundary_length(boundary)) then
          position%arc = joint_after(boundary, position%arc)
          position%xi = boundary%arcs(position%arc)%range(1)
        end if
      end associate
      x = on_boundary(boundaries(curve%boundary), position)
    else if (.not. s > 0) then
      x = curve%ends(:, 1)
    else if (.not. s < curve%length) then
      x = curve%ends(:, 2)
    else if (allocated(curve%path%arcs)) then
      along = position_at_arc_length(curve%path, s)
      x = on_boundary(curve%path, along)
    else
      x = exact_point(curve%line, xi_at_length(curve%line, s))
    end if
  end subroutine curve_point

end module side_curves
