!> Seams: curves inside a body along which its parts, groups of the scene, share sides. A mesh without zones keeps them.
!>
!> Each part is filled for itself between its share of the contours and its seams; both parts beside a seam have its nodes.
module body_seams
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, kind_corner, point_on, position_at_arc_length, &
                             position_t, size_of_boundary
  use corrected_contours, only: contour_t
  use kinds, only: wp
  use loop_group, only: group_of_element
  use material_interfaces, only: group_interfaces, interface_t, path_between
  use mesh, only: side_set_t
  use scene, only: scene_t
  use solution, only: solution_t
  use vectors, only: length_of
  use zones, only: follows_interface, zone_layout_t, zone_point_t, zone_side_t
  implicit none
  private
  public :: seams_t, add_seam_ends, find_seams, group_beside, lay_out_seams, mark_sets, marks_along_paths

  type :: seams_t
    !> Between groups of the scene: `materials` are their numbers.
    type(interface_t), allocatable :: interfaces(:)
    !> Group of the element at each side of each contour; 0 beyond its last (nside, ncontour).
    integer, allocatable :: groups(:, :)
  end type seams_t

  !> Tolerance of points and lengths, as a share of their curve.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> All seams of the mesh of a scene; none where there is no mesh yet.
  subroutine find_seams(scene, solution, contours, seams)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(seams_t), intent(out) :: seams
    integer :: c, k

    call group_interfaces(scene, solution, contours, seams%interfaces)
    allocate (seams%groups(maxval([0, (size(contours(c)%loop%element), c=1, size(contours))]), size(contours)), source=0)
    do c = 1, size(contours)
      do k = 1, size(contours(c)%loop%element)
        seams%groups(k, c) = group_of_element(scene, contours(c)%loop%element(k))
      end do
    end do
  end subroutine find_seams

  !> Group beside a contour between two of its points, one after the other.
  pure function group_beside(seams, boundary, number, from, to) result(group)
    type(seams_t), intent(in) :: seams
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: number   !! of the contour
    type(position_t), intent(in) :: from, to
    integer :: group
    type(position_t) :: middle
    real(wp) :: s(2)

    s = [arc_length_at(boundary, from), arc_length_at(boundary, to)]
    if (.not. s(2) > s(1)) s(2) = s(2) + boundary_length(boundary)
    middle = position_at_arc_length(boundary, 0.5_wp*sum(s))
    ! the face of a cut is no side of the old mesh: a body that is cut has no seams
    group = seams%groups(1, number)
    associate (side => boundary%arcs(middle%arc)%side)
      if (side <= count(seams%groups(:, number) > 0)) group = seams%groups(side, number)
    end associate
  end function group_beside

  !> Ends of seams on a contour become corners of it, in their order.
  pure subroutine add_seam_ends(seams, boundary, number, points)
    type(seams_t), intent(in) :: seams
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: number   !! of the contour
    type(zone_point_t), allocatable, intent(inout) :: points(:)   !! (npoint)
    type(zone_point_t) :: point
    type(zone_point_t), allocatable :: sorted(:)
    real(wp), allocatable :: s(:)
    integer :: i, e, k

    if (all([(all(seams%interfaces(i)%contour /= number), i=1, size(seams%interfaces))])) return
    point%boundary = number
    do i = 1, size(seams%interfaces)
      do e = 1, 2
        if (seams%interfaces(i)%contour(e) /= number) cycle
        point%position = seams%interfaces(i)%position(e)
        if (contour_point(boundary, number, points, point%position) == 0) points = [points, point]
      end do
    end do
    allocate (s(size(points)), sorted(size(points)))
    s = [(arc_length_at(boundary, points(k)%position), k=1, size(points))]
    do i = 1, size(points)
      k = minloc(s, 1)
      sorted(i) = points(k)
      s(k) = huge(s)
    end do
    call move_alloc(sorted, points)
  end subroutine add_seam_ends

  !> Number of the point on a contour at a position, 0 where there is none.
  pure function contour_point(boundary, number, points, position) result(k)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: number
    type(zone_point_t), intent(in) :: points(:)
    type(position_t), intent(in) :: position
    integer :: k
    real(wp) :: apart

    do k = 1, size(points)
      if (points(k)%boundary /= number) cycle
      apart = abs(arc_length_at(boundary, points(k)%position) - arc_length_at(boundary, position))
      if (min(apart, boundary_length(boundary) - apart) <= same*boundary_length(boundary)) return
    end do
    k = 0
  end function contour_point

  !> Sides along all seams, behind those of the contours; `outline` is the number of each group's outline. A closed seam has two.
  pure subroutine lay_out_seams(seams, outline, boundaries, layout)
    type(seams_t), intent(in) :: seams
    integer, intent(in) :: outline(:)                     !! (ngroup)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_layout_t), intent(inout) :: layout
    type(boundary_curve_t), allocatable :: paths(:)
    type(zone_side_t) :: side
    type(position_t) :: ends(2)
    integer :: i, e, n

    allocate (paths(2*size(seams%interfaces)))
    side%form = follows_interface
    n = 0
    do i = 1, size(seams%interfaces)
      associate (seam => seams%interfaces(i))
        side%zones = outline(seam%materials)
        if (seam%closed) then
          call halves_of(seam, ends)
          do e = 1, 2
            call find_inner(point_on(seam%curve, ends(e)), seam%curve, layout, side%points(e))
          end do
          do e = 1, 2
            n = n + 1
            paths(n) = path_between(seam, ends(e), ends(3 - e))
            side%path = n
            layout%sides = [layout%sides, side]
            side%points = side%points([2, 1])
          end do
        else
          n = n + 1
          paths(n) = seam%curve
          side%path = n
          do e = 1, 2
            if (seam%contour(e) > 0) then
              side%points(e) = contour_point(boundaries(seam%contour(e)), seam%contour(e), layout%points, seam%position(e))
            else
              call find_inner(end_of(seam%curve, e), seam%curve, layout, side%points(e))
            end if
          end do
          layout%sides = [layout%sides, side]
        end if
      end associate
    end do
    allocate (layout%paths, source=paths(:n))
  end subroutine lay_out_seams

  !> Two positions that divide a closed seam: a corner where it has one, and another or the position half-way around.
  pure subroutine halves_of(seam, ends)
    type(interface_t), intent(in) :: seam
    type(position_t), intent(out) :: ends(2)
    integer :: k, first

    first = max(1, findloc(seam%curve%kinds, kind_corner, 1))
    ends(1) = position_t(first, seam%curve%arcs(first)%range(1))
    do k = first + 1, size(seam%curve%kinds)
      if (seam%curve%kinds(k) /= kind_corner) cycle
      ends(2) = position_t(k, seam%curve%arcs(k)%range(1))
      return
    end do
    associate (length => boundary_length(seam%curve))
      ends(2) = position_at_arc_length(seam%curve, modulo(arc_length_at(seam%curve, ends(1)) + 0.5_wp*length, length))
    end associate
  end subroutine halves_of

  !> Number of the point inside the body at x; it is added where there is none.
  pure subroutine find_inner(x, curve, layout, number)
    real(wp), intent(in) :: x(2)   !! [length]
    type(boundary_curve_t), intent(in) :: curve
    type(zone_layout_t), intent(inout) :: layout
    integer, intent(out) :: number
    type(zone_point_t) :: point

    do number = 1, size(layout%points)
      if (layout%points(number)%boundary > 0) cycle
      if (length_of(layout%points(number)%x - x) <= same*size_of_boundary(curve)) return
    end do
    point%x = x
    layout%points = [layout%points, point]
  end subroutine find_inner

  pure function end_of(curve, which) result(x)
    type(boundary_curve_t), intent(in) :: curve
    integer, intent(in) :: which   !! 1 or 2
    real(wp) :: x(2)

    x = curve%arcs(1)%points(:, 1)
    if (which == 2) x = curve%arcs(size(curve%arcs))%points(:, 3)
  end function end_of

  !> How sets of sides lie along seams: 1 for a set with its part on the left of a seam, -1 on the right, 0 elsewhere. `whole` is
  !> false for a set that has sides inside a body other than those of whole seams.
  pure subroutine mark_sets(sides, contours, seams, on_seam, whole)
    type(side_set_t), intent(in) :: sides(:)     !! (nset)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(seams_t), intent(in) :: seams
    integer, intent(out) :: on_seam(:, :)        !! (nseam, nset)
    logical, intent(out) :: whole(:)             !! (nset)
    integer :: s, c, i, k, first, found, on_contours

    on_seam = 0
    do s = 1, size(sides)
      on_contours = 0
      do c = 1, size(contours)
        on_contours = on_contours + count(contours(c)%tags%on_set(s, :))
      end do
      found = on_contours
      do i = 1, size(seams%interfaces)
        associate (arcs => seams%interfaces(i)%curve%arcs)
          if (.not. all([(any(sides(s)%nodes(2, :) == arcs(k)%middle), k=1, size(arcs))])) cycle
          first = findloc(sides(s)%nodes(2, :), arcs(1)%middle, 1)
          on_seam(i, s) = merge(1, -1, sides(s)%nodes(1, first) == seams%interfaces(i)%first_node)
          found = found + size(arcs)
        end associate
      end do
      ! along the contour or along seams
      whole(s) = found >= size(sides(s)%nodes, 2) .and. (on_contours == 0 .or. all(on_seam(:, s) == 0))
    end do
  end subroutine mark_sets

  !> The marks of `mark_sets` for the paths of `lay_out_seams`: a closed seam has two.
  pure function marks_along_paths(sides, contours, seams) result(on_path)
    type(side_set_t), intent(in) :: sides(:)     !! (nset)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(seams_t), intent(in) :: seams
    integer, allocatable :: on_path(:, :)        !! (npath, nset)
    integer :: on_seam(size(seams%interfaces), size(sides)), i, n
    logical :: whole(size(sides))

    call mark_sets(sides, contours, seams, on_seam, whole)
    allocate (on_path(size(seams%interfaces) + count(seams%interfaces%closed), size(sides)))
    n = 0
    do i = 1, size(seams%interfaces)
      n = n + 1
      on_path(n, :) = on_seam(i, :)
      if (.not. seams%interfaces(i)%closed) cycle
      n = n + 1
      on_path(n, :) = on_seam(i, :)
    end do
  end function marks_along_paths

end module body_seams
