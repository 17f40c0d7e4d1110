!> Zone points on the present contours, as defined by ZPNT cards.
module marked_points
  use arc_coordinates, only: crossings_of_arc, most_crossings
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, boundary_of_loop, closest_position, joint_after, &
                             kind_corner, kind_entry, kind_exit, point_on, position_t, size_of_boundary, turn_at
  use contour_match, only: position_of_side_point
  use corrected_contours, only: contour_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: pi, wp
  use locate_point, only: element_location_t, locate
  use offset_parabolas, only: exact_point
  use scene, only: is_solid, scene_t
  use shape_functions, only: quad8
  use text, only: to_text
  use transfer_mesh, only: build_mesh_trees, set_up_mesh, transfer_mesh_t
  use vectors, only: length_of
  use zone_marks, only: mark_corner, mark_crossing, mark_inside, mark_matter, zone_mark_t
  use zones, only: on_boundary, zone_point_t
  implicit none
  private
  public :: find_points

  !> A line that misses the contour by less than this share of its size passes through its end: symmetry lines meet it in spite of
  !> round-off.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> The points of all ZPNT cards.
  pure subroutine find_points(scene, x, pilots, contours, points, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)                             !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilots(:, :)                        !! (3, ndie) x, y, angle of the dies now [length and radian]
    type(contour_t), intent(in) :: contours(:)                  !! (ncontour)
    type(zone_point_t), allocatable, intent(out) :: points(:)   !! (npoint)
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: coordinates(2)
    logical :: alone, on(size(scene%groups), size(contours)), eligible(size(contours))
    integer :: k, z, c

    allocate (points(size(scene%remesher%marks)))
    do c = 1, size(contours)
      on(:, c) = bodies_at(scene, contours(c))
    end do
    do k = 1, size(points)
      associate (mark => scene%remesher%marks(k))
        points(k)%name = mark%name
        points(k)%stays = mark%stays
        points(k)%by_shape = mark%form == mark_corner
        alone = count([(any(scene%remesher%zones(z)%marks == k), z=1, size(scene%remesher%zones))]) == 1
        ! bodies may touch: a point is on the contours of the bodies whose zones have it
        eligible = .false.
        do z = 1, size(scene%remesher%zones)
          if (any(scene%remesher%zones(z)%marks == k)) eligible = eligible .or. on(scene%remesher%zones(z)%group, :)
        end do
        if (.not. any(eligible)) eligible = .true.
        coordinates = mark%x
        if (mark%die > 0) coordinates = carried(mark, scene%dies(mark%die)%pilot, pilots(:, mark%die))
        if (mark%form == mark_inside) then
          points(k)%x = coordinates
          if (mark%by_matter .and. size(x, 2) > 0) points(k)%x = material_point_inside(scene, x, coordinates)
          cycle
        else if (mark%form == mark_crossing) then
          call find_crossing(contours, eligible, mark%axis, coordinates(mark%axis), mark%pick, points(k), error)
        else if (mark%by_matter) then
          call find_material_point(scene%mesh%origin, x, contours, eligible, coordinates, points(k))
          if (mark%form /= mark_matter) &
            points(k)%position = nearest_joint(contours(points(k)%boundary)%boundary, points(k)%position, alone)
        else
          call find_joint(contours, eligible, coordinates, alone, points(k), error)
        end if
        if (allocated(error)) return
        points(k)%x = on_boundary(contours(points(k)%boundary)%boundary, points(k)%position)
      end associate
    end do
  end subroutine find_points

  !> Groups whose elements are inside a contour; that of its card when it has none yet.
  pure function bodies_at(scene, contour) result(on)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contour
    logical :: on(size(scene%groups))
    integer :: g, last

    on = .false.
    if (size(contour%loop%sides, 2) == 0) then
      on(scene%remesher%contours(contour%loop%body)%group) = .true.
      return
    end if
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      associate (n => size(scene%groups(g)%connectivity, 2))
        on(g) = any(contour%loop%element > last .and. contour%loop%element <= last + n)
        last = last + n
      end associate
    end do
  end function bodies_at

  !> Present coordinates of a point that moves with a die. A line keeps its direction: it is translated with the pilot, not rotated.
  pure function carried(mark, start, now) result(coordinates)
    type(zone_mark_t), intent(in) :: mark
    real(wp), intent(in) :: start(3), now(3)
    real(wp) :: coordinates(2), arm(2), c, s

    arm = mark%x - start(1:2)
    c = cos(now(3) - start(3))
    s = sin(now(3) - start(3))
    if (mark%form /= mark_crossing) arm = [c*arm(1) - s*arm(2), s*arm(1) + c*arm(2)]
    coordinates = now(1:2) + arm
  end function carried

  !> The material point of the contour that was initially nearest to a point.
  pure subroutine find_material_point(origin, x, contours, eligible, start, point)
    real(wp), intent(in) :: origin(:, :)   !! initial coordinates of the material point at each node (2, nnode) [length]
    real(wp), intent(in) :: x(:, :)
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: eligible(:)   !! contours that are searched (ncontour)
    real(wp), intent(in) :: start(2)
    type(zone_point_t), intent(inout) :: point
    type(boundary_curve_t) :: before
    type(position_t) :: position
    real(wp) :: distance, least
    logical :: first
    integer :: c

    least = huge(least)
    do c = 1, size(contours)
      if (.not. eligible(c)) cycle
      ! contours of bodies without a mesh have not changed
      first = size(contours(c)%loop%sides, 2) == 0
      before = contours(c)%boundary
      if (.not. first) before = boundary_of_loop(contours(c)%loop, origin, pi)
      position = closest_position(before, start)
      distance = length_of(point_on(before, position) - start)
      if (.not. distance < least) cycle
      least = distance
      point%boundary = c
      point%position = position
      if (.not. first) &
        point%position = position_of_side_point(contours(c)%loop, contours(c)%boundary, contours(c)%contacts, x, position%arc, &
                                                position%xi)
    end do
  end subroutine find_material_point

  !> Present coordinates of a material point inside the part: in its element, by the shape functions.
  pure function material_point_inside(scene, x, start) result(now)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :), start(2)
    real(wp) :: now(2), phi(8), dphi(2, 8)
    type(transfer_mesh_t) :: mesh
    type(element_location_t) :: location
    integer, allocatable :: nodes(:)
    integer :: g, n

    allocate (nodes(0))
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) nodes = [nodes, scene%groups(g)%connectivity]
    end do
    n = size(nodes)/8
    call set_up_mesh(scene%mesh%origin, reshape(nodes, [8, n]), spread(1, 1, n), spread(4, 1, n), .false., mesh)
    call build_mesh_trees(mesh)
    call locate(mesh, 1, start, 0.0_wp, location)
    call quad8(location%xi(1), location%xi(2), phi, dphi)
    now = matmul(x(:, mesh%connectivity(:, location%element)), phi)
  end function material_point_inside

  !> The corner, beginning or end of contact nearest to a point.
  pure subroutine find_joint(contours, eligible, target, alone, point, error)
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: eligible(:)   !! contours that are searched (ncontour)
    real(wp), intent(in) :: target(2)
    logical, intent(in) :: alone   !! one zone has the point
    type(zone_point_t), intent(inout) :: point
    type(error_t), allocatable, intent(out) :: error
    type(position_t) :: position
    real(wp) :: distance, least
    integer :: c, k

    least = huge(least)
    do c = 1, size(contours)
      if (.not. eligible(c)) cycle
      associate (boundary => contours(c)%boundary)
        do k = 1, size(boundary%arcs)
          if (.not. is_joint(boundary, k, alone)) cycle
          position = position_t(k, boundary%arcs(k)%range(1))
          distance = length_of(point_on(boundary, position) - target)
          if (.not. distance < least) cycle
          least = distance
          point%boundary = c
          point%position = position
        end do
      end associate
    end do
    if (point%boundary == 0) &
      call fail(error, exit_input, 'ZPNT '//trim(point%name)//': the contour has no corner and no end of contact', &
                'name the point by MATTER or ON')
  end subroutine find_joint

  !> Joints where zones may have a corner: ends of contact and corners. A single zone fills no re-entrant corner.
  pure function is_joint(boundary, k, alone) result(yes)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k       !! arc that begins there
    logical, intent(in) :: alone   !! one zone has the corner
    logical :: yes

    select case (boundary%kinds(k))
    case (kind_entry, kind_exit)
      yes = .true.
    case (kind_corner)
      yes = .not. alone .or. turn_at(boundary, k) > 0
    case default
      yes = .false.
    end select
  end function is_joint

  !> The corner, beginning or end of contact nearest along the boundary curve; the position itself where there is none.
  pure function nearest_joint(boundary, from, alone) result(position)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: from
    logical, intent(in) :: alone
    type(position_t) :: position
    real(wp) :: here, distance, least
    integer :: k

    position = from
    here = arc_length_at(boundary, from)
    least = huge(least)
    do k = 1, size(boundary%arcs)
      if (.not. is_joint(boundary, k, alone)) cycle
      distance = abs(boundary%arc_length(k - 1) - here)
      distance = min(distance, boundary_length(boundary) - distance)
      if (.not. distance < least) cycle
      least = distance
      position = position_t(k, boundary%arcs(k)%range(1))
    end do
  end function nearest_joint

  !> Where contours cross the line on which a coordinate has a value: the outermost crossing in one direction.
  pure subroutine find_crossing(contours, eligible, axis, value, pick, point, error)
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: eligible(:)   !! contours that are searched (ncontour)
    integer, intent(in) :: axis          !! 1: x, 2: y
    real(wp), intent(in) :: value        !! [length]
    integer, intent(in) :: pick          !! 1: largest other coordinate, -1: least
    type(zone_point_t), intent(inout) :: point
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: best, slack
    integer :: c, k

    best = -huge(best)
    do c = 1, size(contours)
      if (.not. eligible(c)) cycle
      slack = same*size_of_boundary(contours(c)%boundary)
      do k = 1, size(contours(c)%boundary%arcs)
        call cross_arc(c, contours(c)%boundary, k, axis, value, slack, pick, best, point)
      end do
    end do
    if (point%boundary == 0) call fail(error, exit_input, 'ZPNT '//trim(point%name)//': the contour does not cross '// &
                                    merge('x', 'y', axis == 1)//' = '//to_text(value), 'give a line that the part lies on')
  end subroutine find_crossing

  !> Crossings of one arc with the line.
  pure subroutine cross_arc(number, boundary, k, axis, value, slack, pick, best, point)
    integer, intent(in) :: number, k, axis, pick
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: value, slack
    real(wp), intent(inout) :: best
    type(zone_point_t), intent(inout) :: point
    real(wp) :: crossings(most_crossings), x(2)
    integer :: i, n

    associate (one => boundary%arcs(k))
      call crossings_of_arc(one, axis, value, slack, n, crossings)
      do i = 1, n
        x = exact_point(one, crossings(i))
        if (.not. pick*x(3 - axis) > best) cycle
        best = pick*x(3 - axis)
        point%boundary = number
        point%position = position_t(k, crossings(i))
        if (crossings(i) < one%range(2)) cycle
        point%position%arc = joint_after(boundary, k)
        point%position%xi = boundary%arcs(point%position%arc)%range(1)
      end do
    end associate
  end subroutine cross_arc

end module marked_points
