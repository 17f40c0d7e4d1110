!> The sides that the zones of a part share.
!>
!> A side that two zones name by the same two corners is one side. A side of a single zone follows the contour; both zones and
!> boundary curves have the part on their left, so it runs forward along the curve from corner to corner. All of every boundary
!> curve must be followed once: then the zones fill the part. A side between two materials follows the path of their interface.
module zone_layout
  use block_mesh, only: polygon_area
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use text, only: to_text
  use zones, only: as_found, coordinates_of, follows_contour, runs_straight, zone_layout_t, zone_point_t, zone_side_t, zone_t
  implicit none
  private
  public :: lay_out, side_arc_lengths

  !> Tolerance of lengths along a boundary curve, and of the area of a zone relative to the square of its extent.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> Find the sides, and check that the zones fill the part.
  pure subroutine lay_out(boundaries, points, zones, layout, error, paths)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_point_t), intent(in) :: points(:)           !! (npoint)
    type(zone_t), intent(in) :: zones(:)                  !! (nzone)
    type(zone_layout_t), intent(out) :: layout
    type(error_t), allocatable, intent(out) :: error
    type(boundary_curve_t), optional, intent(in) :: paths(:)   !! (npath) of sides along interfaces
    integer :: z

    if (present(paths)) allocate (layout%paths, source=paths)
    allocate (layout%points, source=points)
    allocate (layout%zones, source=zones)
    do z = 1, size(zones)
      call check_corners(boundaries, points, zones(z), z, error)
      if (allocated(error)) return
      call make_counter_clockwise(boundaries, points, z, layout%zones(z), error)
      if (allocated(error)) return
    end do
    call find_sides(layout, error)
    if (.not. allocated(error)) call follow_boundaries(boundaries, layout, error)
    if (.not. allocated(error)) call find_movable_sides(layout)
  end subroutine lay_out

  !> Arc lengths at which a side along a boundary curve begins and ends [length]; the end may lie past the start of the curve.
  pure function side_arc_lengths(boundaries, layout, side) result(arc_length)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_layout_t), intent(in) :: layout
    type(zone_side_t), intent(in) :: side
    real(wp) :: arc_length(2)

    associate (boundary => boundaries(side%boundary))
      arc_length(1) = arc_length_at(boundary, layout%points(side%points(1))%position)
      arc_length(2) = arc_length_at(boundary, layout%points(side%points(2))%position)
      if (.not. arc_length(2) - arc_length(1) > same*boundary_length(boundary)) &
        arc_length(2) = arc_length(2) + boundary_length(boundary)
    end associate
  end function side_arc_lengths

  pure subroutine check_corners(boundaries, points, zone, number, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_point_t), intent(in) :: points(:)
    type(zone_t), intent(in) :: zone
    integer, intent(in) :: number
    type(error_t), allocatable, intent(out) :: error
    integer :: k

    if (any(zone%corners < 1) .or. any(zone%corners > size(points))) then
      call fail(error, exit_input, name_of_zone(zone, number)//' has a corner that is no zone point, expected 1 to ' &
                //to_text(size(points)))
      return
    end if
    do k = 1, 4
      if (count(zone%corners == zone%corners(k)) > 1) then
        call fail(error, exit_input, name_of_zone(zone, number)//' has point '//name_of_point(points, zone%corners(k)) &
                  //' twice among its corners, expected four different points')
        return
      end if
      if (points(zone%corners(k))%boundary > size(boundaries)) then
        call fail(error, exit_input, 'zone point '//name_of_point(points, zone%corners(k))//' is on a contour that does not exist')
        return
      end if
    end do
  end subroutine check_corners

  !> Sort the corners counter-clockwise, beginning with the same one.
  pure subroutine make_counter_clockwise(boundaries, points, number, zone, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_point_t), intent(in) :: points(:)
    integer, intent(in) :: number
    type(zone_t), intent(inout) :: zone
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: x(2, 4), area
    integer :: k

    do k = 1, 4
      x(:, k) = coordinates_of(boundaries, points(zone%corners(k)))
    end do
    area = polygon_area(x)
    if (abs(area) <= same*sum((maxval(x, 2) - minval(x, 2))**2)) then
      call fail(error, exit_input, name_of_zone(zone, number)//' has no area between its corners')
    else if (area < 0) then
      zone%corners = zone%corners([1, 4, 3, 2])
      zone%form = zone%form([4, 3, 2, 1])
      zone%middle = zone%middle(:, [4, 3, 2, 1])
      zone%path = zone%path([4, 3, 2, 1])
    end if
  end subroutine make_counter_clockwise

  !> Sides by their corners, in the order in which zones name them first.
  pure subroutine find_sides(layout, error)
    type(zone_layout_t), intent(inout) :: layout
    type(error_t), allocatable, intent(out) :: error
    type(zone_side_t) :: list(4*size(layout%zones))
    integer :: latest(size(layout%points)), before(4*size(layout%zones))
    integer :: z, k, s, n, ends(2)

    allocate (layout%zone_sides(4, size(layout%zones)))
    ! sides with the same lower point form a linked list, so that the search is limited to the sides of a point
    latest = 0
    n = 0
    do z = 1, size(layout%zones)
      do k = 1, 4
        ends = layout%zones(z)%corners([k, mod(k, 4) + 1])
        s = latest(minval(ends))
        do while (s > 0)
          if (maxval(list(s)%points) == maxval(ends)) exit
          s = before(s)
        end do
        if (s == 0) then
          n = n + 1
          s = n
          before(n) = latest(minval(ends))
          latest(minval(ends)) = n
          list(n)%points = ends
          list(n)%zones(1) = z
          list(n)%local(1) = k
        else if (list(s)%zones(2) > 0 .or. any(list(s)%points /= ends([2, 1]))) then
          call fail(error, exit_input, name_of_zone(layout%zones(list(s)%zones(1)), list(s)%zones(1))//' and ' &
                    //name_of_zone(layout%zones(z), z)//' overlap at ' &
                    //side_name(layout%points, list(s))//', expected one zone on either side of it')
          return
        else
          list(s)%zones(2) = z
          list(s)%local(2) = k
        end if
        layout%zone_sides(k, z) = s
        if (layout%zones(z)%form(k) == as_found) cycle
        list(s)%form = layout%zones(z)%form(k)
        list(s)%middle = layout%zones(z)%middle(:, k)
        list(s)%path = layout%zones(z)%path(k)
      end do
    end do
    allocate (layout%sides, source=list(:n))
  end subroutine find_sides

  !> The sides that follow boundary curves, and whether all of every curve is followed once.
  pure subroutine follow_boundaries(boundaries, layout, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_layout_t), intent(inout) :: layout
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: followed(size(boundaries)), arc_length(2)
    integer :: s, c

    followed = 0
    do s = 1, size(layout%sides)
      associate (side => layout%sides(s))
        side%moves = side%form == as_found .and. side%zones(2) > 0
        if (side%form == as_found) side%form = merge(follows_contour, runs_straight, side%zones(2) == 0)
        if (side%zones(2) > 0 .neqv. side%form /= follows_contour) then
          call fail(error, exit_input, side_name(layout%points, side)//' follows the contour although two zones share it,' &
                    //' or does not although it belongs to one zone')
          return
        end if
        if (side%form /= follows_contour) cycle
        c = layout%points(side%points(1))%boundary
        if (c == 0 .or. layout%points(side%points(2))%boundary /= c) then
          call fail(error, exit_input, side_name(layout%points, side)//' of ' &
                    //name_of_zone(layout%zones(side%zones(1)), side%zones(1)) &
                    //' has no second zone and not both ends on one contour')
          return
        end if
        side%boundary = c
        arc_length = side_arc_lengths(boundaries, layout, side)
        followed(c) = followed(c) + arc_length(2) - arc_length(1)
      end associate
    end do
    do c = 1, size(boundaries)
      if (abs(followed(c) - boundary_length(boundaries(c))) <= same*size(layout%sides)*boundary_length(boundaries(c))) cycle
      call fail(error, exit_input, 'sides of zones follow '//to_text(followed(c))//' of the length ' &
                //to_text(boundary_length(boundaries(c)))//' of contour '//to_text(c)//', expected all of it once', &
                'a side from one corner to the next runs along the contour with the part on its left')
      return
    end do
  end subroutine follow_boundaries

  !> Movable sides are those without a specified form, between zones of one material; points inside move when all their sides do.
  !> Where other than four sides meet in a fixed point, these sides are fixed too: smoothed, they would close up on it.
  pure subroutine find_movable_sides(layout)
    type(zone_layout_t), intent(inout) :: layout
    integer :: sides_at(size(layout%points)), s
    logical :: changed

    sides_at = 0
    do s = 1, size(layout%sides)
      associate (side => layout%sides(s))
        sides_at(side%points) = sides_at(side%points) + 1
        if (side%moves) side%moves = layout%zones(side%zones(1))%material == layout%zones(side%zones(2))%material
      end associate
    end do
    allocate (layout%point_moves(size(layout%points)))
    layout%point_moves = layout%points%boundary == 0 .and. .not. layout%points%stays
    do
      changed = .false.
      do s = 1, size(layout%sides)
        associate (side => layout%sides(s))
          if (side%moves) then
            side%moves = .not. any(layout%points(side%points)%boundary == 0 .and. sides_at(side%points) /= 4 &
                                   .and. .not. layout%point_moves(side%points))
            changed = changed .or. .not. side%moves
          else
            changed = changed .or. any(layout%point_moves(side%points))
            layout%point_moves(side%points) = .false.
          end if
        end associate
      end do
      if (.not. changed) exit
    end do
  end subroutine find_movable_sides

  pure function side_name(points, side) result(name)
    type(zone_point_t), intent(in) :: points(:)
    type(zone_side_t), intent(in) :: side
    character(len=:), allocatable :: name

    name = 'the side between zone points '//name_of_point(points, side%points(1))//' and '//name_of_point(points, side%points(2))
  end function side_name

  !> A point by its name on the card.
  pure function name_of_point(points, k) result(name)
    type(zone_point_t), intent(in) :: points(:)
    integer, intent(in) :: k
    character(len=:), allocatable :: name

    name = to_text(k)
    if (points(k)%name /= '') name = trim(points(k)%name)
  end function name_of_point

  pure function name_of_zone(zone, number) result(name)
    type(zone_t), intent(in) :: zone
    integer, intent(in) :: number
    character(len=:), allocatable :: name

    name = 'zone '//to_text(number)
    if (zone%name /= '') name = 'zone '//trim(zone%name)
  end function name_of_zone

end module zone_layout
