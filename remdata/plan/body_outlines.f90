!> Bodies that are meshed from their contours alone: their boundaries, and the ends of elements along their contours.
!>
!> Contours are divided as the sides of zones are: from corner to corner, with an end of an element where contact begins or ends
!> and where another set of sides begins. The contours of a body together get an even number of elements: an odd number bounds no
!> mesh of quadrilaterals, since each has four sides and each inner side belongs to two.
module body_outlines
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, kind_corner, position_at_arc_length, turn_at
  use boundary_sides, only: loop_t
  use contour_divisions, only: divide_sides
  use contour_volume, only: volume_inside
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use part_contour, only: contour_options_t, contour_t
  use scene, only: is_solid, scene_t
  use side_curves, only: curve_t, draw_side, measure_density
  use size_field, only: size_field_t
  use zone_divisions, only: division_t, rounded_up
  use zones, only: follows_contour, zone_layout_t, zone_point_t, zone_side_t
  implicit none
  private
  public :: outline_t, find_outlines, refuse_inner_sets, lay_out_outlines, divide_outlines

  !> A body in one piece: its group in the scene, and its contours.
  type :: outline_t
    integer :: group = 0, material = 0
    !> The outer contour, then the holes.
    integer, allocatable :: boundaries(:)
  end type outline_t

  !> A contour has no fewer elements than this.
  integer, parameter :: fewest = 4

contains

  !> All bodies. Where two of them share sides, only zones can separate them.
  pure subroutine find_outlines(scene, material, contours, outlines, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)                         !! of each group of the scene, as for the sizes (ngroup)
    type(contour_t), intent(in) :: contours(:)                 !! (ncontour)
    type(outline_t), allocatable, intent(out) :: outlines(:)   !! (nbody)
    type(error_t), allocatable, intent(out) :: error
    integer :: body(size(contours)), c, n

    call refuse_shared_nodes(scene, error)
    if (.not. allocated(error)) call refuse_inner_sets(scene, contours, error)
    if (allocated(error)) return
    do c = 1, size(contours)
      body(c) = contours(c)%loop%body
      if (body(c) == 0) body(c) = c   ! a first mesh: a body is one contour
    end do
    n = maxval(body)
    allocate (outlines(n))
    do n = 1, size(outlines)
      allocate (outlines(n)%boundaries(0))
    end do
    do c = 1, size(contours)
      associate (outline => outlines(body(c)))
        if (volume_inside(contours(c)%boundary, .false.) > 0) then
          outline%boundaries = [c, outline%boundaries]
        else
          outline%boundaries = [outline%boundaries, c]
        end if
        outline%group = group_of(scene, contours(c)%loop, c)
        outline%material = material(outline%group)
      end associate
    end do
  end subroutine find_outlines

  pure subroutine refuse_shared_nodes(scene, error)
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    integer :: owner(size(scene%mesh%coordinates, 2)), g, e, k

    owner = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 8
          associate (node => scene%groups(g)%connectivity(k, e))
            if (owner(node) == 0) owner(node) = g
            if (owner(node) == g) cycle
            call fail(error, exit_input, 'remdata: the bodies '//scene%groups(owner(node))%name//' and '//scene%groups(g)%name// &
                      ' share sides: a mesh without zones does not keep what is between them', 'give ZONE cards')
            return
          end associate
        end do
      end do
    end do
  end subroutine refuse_shared_nodes

  !> Sets of sides are kept along contours only: one inside a body would be lost.
  pure subroutine refuse_inner_sets(scene, contours, error)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(error_t), allocatable, intent(out) :: error
    integer :: s, c, found

    do s = 1, size(scene%mesh%sides)
      found = 0
      do c = 1, size(contours)
        found = found + count(contours(c)%tags%on_set(s, :))
      end do
      if (found >= size(scene%mesh%sides(s)%nodes, 2)) cycle
      call fail(error, exit_input, 'remdata: the sides '//scene%mesh%sides(s)%name &
                //' lie inside a body: a new mesh does not keep them', &
                'name sides on the contour, or make the mesh of BLOCK cards')
      return
    end do
  end subroutine refuse_inner_sets

  !> Group of the body inside a contour.
  pure function group_of(scene, loop, number) result(group)
    type(scene_t), intent(in) :: scene
    type(loop_t), intent(in) :: loop
    integer, intent(in) :: number
    integer :: group
    integer :: last

    if (size(loop%element) == 0) then
      group = scene%remesher%contours(number)%group
      return
    end if
    last = 0
    do group = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(group))) cycle
      last = last + size(scene%groups(group)%connectivity, 2)
      if (loop%element(1) <= last) return
    end do
  end function group_of

  !> A body is treated as a zone with any number of sides, along its contours from corner to corner.
  pure subroutine lay_out_outlines(boundaries, outlines, layout)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(outline_t), intent(in) :: outlines(:)            !! (nbody)
    type(zone_layout_t), intent(out) :: layout
    type(zone_side_t) :: side
    type(zone_point_t), allocatable :: points(:)
    integer :: b, i, k, first

    allocate (layout%points(0), layout%sides(0), layout%zones(size(outlines)), layout%zone_sides(4, 0))
    side%form = follows_contour
    do b = 1, size(outlines)
      layout%zones(b)%material = outlines(b)%material
      side%zones(1) = b
      do i = 1, size(outlines(b)%boundaries)
        side%boundary = outlines(b)%boundaries(i)
        call corners_of(boundaries(side%boundary), side%boundary, points)
        first = size(layout%points)
        layout%points = [layout%points, points]
        do k = 1, size(points)
          side%points = first + [k, mod(k, size(points)) + 1]
          layout%sides = [layout%sides, side]
        end do
      end do
    end do
    allocate (layout%point_moves(size(layout%points)), source=.false.)
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
        call measure_density(boundaries, field, layout%zones(side%zones(1))%material, curves(s))
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
      if (mod(sum(pack(division%count, layout%sides%zones(1) == b)), 2) == 0) cycle
      s = neediest(curves, division%count, layout%sides%zones(1) == b)
      division%count(s) = division%count(s) + 1
    end do
    call divide_sides(layout, curves, division, field%limits%gradation, first, ends)
  end subroutine divide_outlines

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

end module body_outlines
