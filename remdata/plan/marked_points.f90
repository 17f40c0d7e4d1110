!> Points of zones on the present contours, from what ZPNT cards say of them.
module marked_points
  use contour_chain, only: arc_at, chain_length, chain_of_loop, chain_t, closest_place, joint_after, kind_corner, kind_entry, &
                           kind_exit, place_t, point_on, size_of_chain, turn_at
  use contour_match, only: place_of_old
  use contour_places, only: xi_at_coordinate
  use errors, only: error_t, exit_input, fail
  use kinds, only: pi, wp
  use locate_point, only: locate, location_t => place_t
  use part_contour, only: contour_t
  use scene, only: is_solid, scene_t
  use shape_functions, only: quad8
  use stretches, only: turning_places
  use text, only: to_text
  use transfer_mesh, only: plant_mesh_trees, set_up_mesh, transfer_mesh_t
  use vectors, only: length_of
  use zone_marks, only: mark_corner, mark_crossing, mark_inside, mark_matter, zone_mark_t
  use zones, only: exact_point, on_chain, zone_point_t
  implicit none
  private
  public :: find_points

  !> A line that misses the contour by this share of its size passes its end: symmetry lines are met in spite of round-off.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> The points of all ZPNT cards.
  pure subroutine find_points(scene, x, pilots, contours, points, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)                 !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilots(:, :)            !! of the dies now (3, ndie)
    type(contour_t), intent(in) :: contours(:)
    type(zone_point_t), allocatable, intent(out) :: points(:)
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: place(2)
    logical :: alone, on(size(scene%groups), size(contours)), mine(size(contours))
    integer :: k, z, c

    allocate (points(size(scene%remesher%marks)))
    do c = 1, size(contours)
      on(:, c) = bodies_at(scene, contours(c), c)
    end do
    do k = 1, size(points)
      associate (mark => scene%remesher%marks(k))
        points(k)%name = mark%name
        points(k)%stays = mark%stays
        points(k)%by_shape = mark%form == mark_corner
        alone = count([(any(scene%remesher%zones(z)%marks == k), z=1, size(scene%remesher%zones))]) == 1
        ! bodies may touch: a point is on the contours of the bodies whose zones have it
        mine = .false.
        do z = 1, size(scene%remesher%zones)
          if (any(scene%remesher%zones(z)%marks == k)) mine = mine .or. on(scene%remesher%zones(z)%group, :)
        end do
        if (.not. any(mine)) mine = .true.
        place = mark%x
        if (mark%die > 0) place = carried(mark, scene%dies(mark%die)%pilot, pilots(:, mark%die))
        if (mark%form == mark_inside) then
          points(k)%x = place
          if (mark%by_matter .and. size(x, 2) > 0) points(k)%x = matter_inside(scene, x, place)
          cycle
        else if (mark%form == mark_crossing) then
          call find_crossing(contours, mine, mark%axis, place(mark%axis), mark%pick, points(k), error)
        else if (mark%by_matter) then
          call find_matter(scene%mesh%origin, x, contours, mine, place, points(k))
          if (mark%form /= mark_matter) &
            points(k)%place = nearest_joint(contours(points(k)%chain)%chain, points(k)%place, alone)
        else
          call find_joint(contours, mine, place, alone, points(k), error)
        end if
        if (allocated(error)) return
        points(k)%x = on_chain(contours(points(k)%chain)%chain, points(k)%place)
      end associate
    end do
  end subroutine find_points

  !> Groups whose elements a contour goes along; that of its card when it has none yet.
  pure function bodies_at(scene, contour, number) result(on)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contour
    integer, intent(in) :: number              !! among the contours
    logical :: on(size(scene%groups))
    integer :: g, last

    on = .false.
    if (size(contour%loop%sides, 2) == 0) then
      on(scene%remesher%contours(number)%group) = .true.
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

  !> Where a place that rides on a die is now. A line keeps its direction: it goes with the pilot, and does not turn with it.
  pure function carried(mark, start, now) result(place)
    type(zone_mark_t), intent(in) :: mark
    real(wp), intent(in) :: start(3), now(3)
    real(wp) :: place(2), arm(2), c, s

    arm = mark%x - start(1:2)
    c = cos(now(3) - start(3))
    s = sin(now(3) - start(3))
    if (mark%form /= mark_crossing) arm = [c*arm(1) - s*arm(2), s*arm(1) + c*arm(2)]
    place = now(1:2) + arm
  end function carried

  !> The matter of the contour that was nearest to a place at the start.
  pure subroutine find_matter(origin, x, contours, mine, start, point)
    real(wp), intent(in) :: origin(:, :)   !! where the matter of each node was (2, nnode) [length]
    real(wp), intent(in) :: x(:, :)
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: mine(:)           !! contours that count
    real(wp), intent(in) :: start(2)
    type(zone_point_t), intent(inout) :: point
    type(chain_t) :: before
    type(place_t) :: place
    real(wp) :: distance, least
    logical :: first
    integer :: c

    least = huge(least)
    do c = 1, size(contours)
      if (.not. mine(c)) cycle
      ! contours of bodies without a mesh are what they were
      first = size(contours(c)%loop%sides, 2) == 0
      before = contours(c)%chain
      if (.not. first) before = chain_of_loop(contours(c)%loop, origin, pi)
      place = closest_place(before, start)
      distance = length_of(point_on(before, place) - start)
      if (.not. distance < least) cycle
      least = distance
      point%chain = c
      point%place = place
      if (.not. first) &
        point%place = place_of_old(contours(c)%loop, contours(c)%chain, contours(c)%contacts, x, place%stretch, place%xi)
    end do
  end subroutine find_matter

  !> Where matter from inside the part is now: in the element it was in, by the shape functions.
  pure function matter_inside(scene, x, start) result(now)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :), start(2)
    real(wp) :: now(2), phi(8), dphi(2, 8)
    type(transfer_mesh_t) :: mesh
    type(location_t) :: place
    integer, allocatable :: nodes(:)
    integer :: g, n

    allocate (nodes(0))
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) nodes = [nodes, scene%groups(g)%connectivity]
    end do
    n = size(nodes)/8
    call set_up_mesh(scene%mesh%origin, reshape(nodes, [8, n]), spread(1, 1, n), spread(4, 1, n), .false., mesh)
    call plant_mesh_trees(mesh)
    call locate(mesh, 1, start, 0.0_wp, place)
    call quad8(place%xi(1), place%xi(2), phi, dphi)
    now = matmul(x(:, mesh%connectivity(:, place%element)), phi)
  end function matter_inside

  !> The corner, beginning or end of contact nearest to a place.
  pure subroutine find_joint(contours, mine, target, alone, point, error)
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: mine(:)           !! contours that count
    real(wp), intent(in) :: target(2)
    logical, intent(in) :: alone             !! one zone has the point
    type(zone_point_t), intent(inout) :: point
    type(error_t), allocatable, intent(out) :: error
    type(place_t) :: place
    real(wp) :: distance, least
    integer :: c, k

    least = huge(least)
    do c = 1, size(contours)
      if (.not. mine(c)) cycle
      associate (chain => contours(c)%chain)
        do k = 1, size(chain%stretches)
          if (.not. is_joint(chain, k, alone)) cycle
          place = place_t(k, chain%stretches(k)%range(1))
          distance = length_of(point_on(chain, place) - target)
          if (.not. distance < least) cycle
          least = distance
          point%chain = c
          point%place = place
        end do
      end associate
    end do
    if (point%chain == 0) &
      call fail(error, exit_input, 'ZPNT '//trim(point%name)//': the contour has no corner, and contact begins and ends nowhere', &
                'name the point by MATTER or ON')
  end subroutine find_joint

  !> Places where zones may have a corner: where contact begins or ends, and corners. One zone alone fills no re-entrant corner.
  pure function is_joint(chain, k, alone) result(yes)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: k           !! stretch that begins there
    logical, intent(in) :: alone       !! one zone has the corner
    logical :: yes

    select case (chain%kinds(k))
    case (kind_entry, kind_exit)
      yes = .true.
    case (kind_corner)
      yes = .not. alone .or. turn_at(chain, k) > 0
    case default
      yes = .false.
    end select
  end function is_joint

  !> The corner, beginning or end of contact nearest along the chain; the place itself where there is none.
  pure function nearest_joint(chain, from, alone) result(place)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: from
    logical, intent(in) :: alone
    type(place_t) :: place
    real(wp) :: here, way, least
    integer :: k

    place = from
    here = arc_at(chain, from)
    least = huge(least)
    do k = 1, size(chain%stretches)
      if (.not. is_joint(chain, k, alone)) cycle
      way = abs(chain%arc(k - 1) - here)
      way = min(way, chain_length(chain) - way)
      if (.not. way < least) cycle
      least = way
      place = place_t(k, chain%stretches(k)%range(1))
    end do
  end function nearest_joint

  !> Where contours cross the line on which a coordinate has a value: of all places the one outermost to one hand.
  pure subroutine find_crossing(contours, mine, axis, value, pick, point, error)
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: mine(:)           !! contours that count
    integer, intent(in) :: axis                !! 1: x, 2: y
    real(wp), intent(in) :: value              !! [length]
    integer, intent(in) :: pick                !! 1: largest other coordinate, -1: least
    type(zone_point_t), intent(inout) :: point
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: best, slack
    integer :: c, k

    best = -huge(best)
    do c = 1, size(contours)
      if (.not. mine(c)) cycle
      slack = same*size_of_chain(contours(c)%chain)
      do k = 1, size(contours(c)%chain%stretches)
        call cross_stretch(c, contours(c)%chain, k, axis, value, slack, pick, best, point)
      end do
    end do
    if (point%chain == 0) call fail(error, exit_input, 'ZPNT '//trim(point%name)//': the contour does not cross '// &
                                    merge('x', 'y', axis == 1)//' = '//to_text(value), 'give a line that the part lies on')
  end subroutine find_crossing

  !> Crossings of one stretch, between the places where its coordinate turns back.
  pure subroutine cross_stretch(number, chain, k, axis, value, slack, pick, best, point)
    integer, intent(in) :: number, k, axis, pick
    type(chain_t), intent(in) :: chain
    real(wp), intent(in) :: value, slack
    real(wp), intent(inout) :: best
    type(zone_point_t), intent(inout) :: point
    real(wp) :: turns(3), knots(5), crossings(8), ends(2, 2), x(2), low, high
    integer :: n, i, found

    associate (one => chain%stretches(k))
      call turning_places(one, axis, n, turns)
      knots(1) = one%range(1)
      knots(2:n + 1) = turns(:n)
      knots(n + 2) = one%range(2)
      found = 0
      do i = 1, n + 1
        ends(:, 1) = exact_point(one, knots(i))
        ends(:, 2) = exact_point(one, knots(i + 1))
        low = minval(ends(axis, :))
        high = maxval(ends(axis, :))
        if (value < low - slack .or. value > high + slack) cycle
        ! a stretch that lies on the line counts by its ends
        crossings(found + 1:found + 2) = knots(i:i + 1)
        if (high - low > slack) &
          crossings(found + 1:found + 2) = xi_at_coordinate(one, axis, min(max(value, low), high), knots(i), knots(i + 1))
        found = found + 2
      end do
      do i = 1, found
        x = exact_point(one, crossings(i))
        if (.not. pick*x(3 - axis) > best) cycle
        best = pick*x(3 - axis)
        point%chain = number
        point%place = place_t(k, crossings(i))
        if (crossings(i) < one%range(2)) cycle
        point%place%stretch = joint_after(chain, k)
        point%place%xi = chain%stretches(point%place%stretch)%range(1)
      end do
    end associate
  end subroutine cross_stretch

end module marked_points
