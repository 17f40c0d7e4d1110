!> The sides of outlines: contours from corner to corner and seams, laid out and divided as those of zones are.
!>
!> A body is treated as a zone with any number of sides, with an end of an element where contact begins or ends and where another
!> set of sides begins. The contours of a body together get an even number of elements: an odd number bounds no mesh of
!> quadrilaterals, since each has four sides and each inner side belongs to two.
module outline_sides
  use body_outlines, only: outline_t
  use body_seams, only: add_seam_ends, group_beside, lay_out_seams, seams_t
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, is_on_one_piece, kind_corner, &
                             position_at_arc_length, turn_at
  use contour_divisions, only: divide_sides
  use corrected_contours, only: contour_options_t
  use curve_divisions, only: measure_density
  use kinds, only: wp
  use side_curves, only: curve_t, draw_side
  use size_field, only: size_field_t
  use zone_divisions, only: division_t, rounded_up
  use zones, only: follows_contour, zone_layout_t, zone_point_t, zone_side_t
  implicit none
  private
  public :: lay_out_outlines, divide_outlines

  !> A contour has no fewer elements than this.
  integer, parameter :: fewest = 4

contains

  !> A body is treated as a zone with any number of sides, along its contours from corner to corner.
  !> Sides along seams come last.
  pure subroutine lay_out_outlines(boundaries, outlines, layout, seams)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(outline_t), intent(in) :: outlines(:)            !! (nbody)
    type(zone_layout_t), intent(out) :: layout
    type(seams_t), optional, intent(in) :: seams
    type(zone_side_t) :: side
    type(zone_point_t), allocatable :: points(:)
    logical :: laid_out(size(boundaries))
    integer :: b, i, k, n, first

    allocate (layout%points(0), layout%sides(0), layout%zones(size(outlines)), layout%zone_sides(4, 0))
    side%form = follows_contour
    laid_out = .false.
    do b = 1, size(outlines)
      layout%zones(b)%material = outlines(b)%material
      side%zones(1) = b
      do i = 1, size(outlines(b)%boundaries)
        side%boundary = outlines(b)%boundaries(i)
        if (laid_out(side%boundary)) cycle
        laid_out(side%boundary) = .true.
        call corners_of(boundaries(side%boundary), side%boundary, points)
        if (outlines(b)%has_seams) call add_seam_ends(seams, boundaries(side%boundary), side%boundary, points)
        first = size(layout%points)
        layout%points = [layout%points, points]
        do k = 1, size(points)
          n = mod(k, size(points)) + 1
          side%points = first + [k, n]
          if (outlines(b)%has_seams) side%zones(1) = &
            part_of(group_beside(seams, boundaries(side%boundary), side%boundary, points(k)%position, points(n)%position))
          layout%sides = [layout%sides, side]
        end do
      end do
    end do
    if (any(outlines%has_seams)) then
      n = maxval(outlines%group)
      call lay_out_seams(seams, [(part_of(k), k=1, n)], boundaries, layout)
    end if
    allocate (layout%point_moves(size(layout%points)), source=.false.)

  contains

    !> Number of the outline that is a group; 0 where none is.
    pure function part_of(group) result(number)
      integer, intent(in) :: group
      integer :: number

      number = findloc(outlines%has_seams .and. outlines%group == group, .true., 1)
    end function part_of

  end subroutine lay_out_outlines

  !> Corners of a contour in their order; a contour with less than two gets other points.
  pure subroutine corners_of(boundary, number, points)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: number
    type(zone_point_t), allocatable, intent(out) :: points(:)
    type(contour_options_t) :: options
    type(zone_point_t) :: point
    integer :: k

    allocate (points(0))
    point%boundary = number
    do k = 1, size(boundary%arcs)
      if (boundary%kinds(k) /= kind_corner .and. .not. abs(turn_at(boundary, k)) > options%corner_turn) cycle
      if (is_on_one_piece(boundary, k)) cycle
      point%position%arc = k
      point%position%xi = boundary%arcs(k)%range(1)
      points = [points, point]
    end do
    if (size(points) == 0) then
      point%position%arc = 1
      point%position%xi = boundary%arcs(1)%range(1)
      points = [point]
    end if
    if (size(points) > 1) return
    point%position = position_at_arc_length(boundary, arc_length_at(boundary, point%position) + 0.5_wp*boundary_length(boundary))
    points = [points, point]
  end subroutine corners_of

  !> Lengths from the start of side s of the layout to its ends of elements: ends(first(s)) ... ends(first(s + 1) - 1).
  pure subroutine divide_outlines(boundaries, outlines, layout, field, factor, all_even, curves, division, first, ends)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(outline_t), intent(in) :: outlines(:)            !! (nbody)
    type(zone_layout_t), intent(in) :: layout
    type(size_field_t), intent(in) :: field
    real(wp), intent(in) :: factor                         !! ratio of the sizes to the requested ones
    logical, intent(in) :: all_even  !! every side has an even number of elements, not only all of a body together
    type(curve_t), allocatable, intent(out) :: curves(:)   !! (nside)
    type(division_t), intent(out) :: division
    integer, allocatable, intent(out) :: first(:)   !! (nside + 1)
    real(wp), allocatable, intent(out) :: ends(:)   !! (first(nside + 1) - 1) [length]
    integer :: s, b, i

    allocate (curves(size(layout%sides)), division%count(size(layout%sides)), first(size(layout%sides) + 1))
    division%factor = factor
    do s = 1, size(curves)
      associate (side => layout%sides(s))
        call draw_side(boundaries, layout, side, field, curves(s))
        if (side%zones(2) > 0) then
          call measure_density(boundaries, field, layout%zones(side%zones(1))%material, curves(s), &
                               layout%zones(side%zones(2))%material)
        else
          call measure_density(boundaries, field, layout%zones(side%zones(1))%material, curves(s))
        end if
      end associate
      division%count(s) = sum(rounded_up(curves(s)%needs/factor))
      if (all_even) division%count(s) = division%count(s) + mod(division%count(s), 2)
    end do
    do b = 1, size(outlines)
      do i = 1, size(outlines(b)%boundaries)
        associate (of_contour => layout%sides%boundary == outlines(b)%boundaries(i))
          do while (sum(pack(division%count, of_contour)) < fewest)
            s = neediest(curves, division%count, of_contour)
            division%count(s) = division%count(s) + merge(2, 1, all_even)
          end do
        end associate
      end do
      associate (around => layout%sides%zones(1) == b .or. layout%sides%zones(2) == b)
        do while (sum(pack(division%count, around)) < fewest)
          s = neediest(curves, division%count, around)
          division%count(s) = division%count(s) + merge(2, 1, all_even)
        end do
        if (mod(sum(pack(division%count, around)), 2) > 0) call add_one_each(layout, curves, b, division%count)
      end associate
    end do
    call divide_sides(layout, curves, division, field%limits%gradation, first, ends)
  end subroutine divide_outlines

  !> One element more on sides that lead from an outline to the outside, through as few others as possible: their numbers stay even
  !> or odd, that of the outline changes. (An inclusion has no side that is no other's too.)
  pure subroutine add_one_each(layout, curves, outline, count)
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)   !! (nside)
    integer, intent(in) :: outline
    integer, intent(inout) :: count(:)       !! (nside)
    integer :: came_by(size(layout%zones)), queue(size(layout%zones)), s, b, i, n, other

    came_by = 0
    queue(1) = outline
    n = 1
    i = 0
    do while (i < n)
      i = i + 1
      b = queue(i)
      if (any(layout%sides%zones(1) == b .and. layout%sides%zones(2) == 0)) exit
      do s = 1, size(count)
        if (all(layout%sides(s)%zones /= b) .or. layout%sides(s)%zones(2) == 0) cycle
        other = sum(layout%sides(s)%zones) - b
        if (other == outline .or. came_by(other) > 0) cycle
        came_by(other) = s
        n = n + 1
        queue(n) = other
      end do
    end do
    s = neediest(curves, count, layout%sides%zones(1) == b .and. layout%sides%zones(2) == 0)
    do
      count(s) = count(s) + 1
      if (b == outline) return
      s = came_by(b)
      b = sum(layout%sides(s)%zones) - b
    end do
  end subroutine add_one_each

  !> The side with the largest need per element.
  pure function neediest(curves, count, among) result(most)
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: count(:)
    logical, intent(in) :: among(:)
    integer :: most
    integer :: s

    most = findloc(among, .true., 1)
    do s = most + 1, size(curves)
      if (among(s) .and. sum(curves(s)%needs)/count(s) > sum(curves(most)%needs)/count(most)) most = s
    end do
  end function neediest

end module outline_sides
