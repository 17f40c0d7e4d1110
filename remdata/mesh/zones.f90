!> Quadrilateral zones of a part: their corners, and the sides they share.
!>
!> A side that two zones name by the same two corners is one side. A side of a single zone follows the contour; both zones and
!> chains have the part on their left, so it runs forward along the chain from corner to corner. All of every chain must be
!> followed once: then the zones fill the part. A side between two materials follows the path their interface takes.
module zones
  use block_mesh, only: polygon_area
  use contour_chain, only: arc_at, chain_length, chain_t, place_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use stretches, only: point_at, stretch_t
  use text, only: to_text
  use zone_marks, only: name_length
  implicit none
  private
  public :: zone_point_t, zone_t, plan_t, side_t, layout_t, lay_out, coordinates_of, on_chain, exact_point, arc_along
  public :: as_found, follows_contour, runs_straight, runs_curved, follows_interface

  !> What a side of a zone is: the contour where one zone has it and straight where two have it, or what is said of it.
  integer, parameter :: as_found = 0, follows_contour = 1, runs_straight = 2, runs_curved = 3, follows_interface = 4

  !> A point where zones have corners: a place on a chain, or coordinates inside the part.
  type :: zone_point_t
    integer :: chain = 0             !! 0: inside
    type(place_t) :: place
    real(wp) :: x(2) = 0.0_wp        !! [length], read inside only
    !> Unless the user wants a point where it is, it moves inside when lines are smoothed, and on a contour to a corner close by.
    logical :: stays = .false.
    !> It is where the contour has a corner, not a place or a matter that was asked for.
    logical :: by_shape = .false.
    !> As cards name it.
    character(len=name_length) :: name = ''
  end type zone_point_t

  type :: zone_t
    !> Zone points in order around the zone, either way round. Side k goes from corner k to the next.
    integer :: corners(4) = 0
    !> Zones of one material may move the side between them when lines are smoothed.
    integer :: material = 1
    integer :: form(4) = as_found
    !> Where a curved side, a parabola, is halfway [length].
    real(wp) :: middle(2, 4) = 0.0_wp
    !> Paths of sides along interfaces.
    integer :: path(4) = 0
    !> As cards name it.
    character(len=name_length) :: name = ''
  end type zone_t

  !> Zones of a scene on its contours.
  type :: plan_t
    type(zone_point_t), allocatable :: points(:)
    type(zone_t), allocatable :: zones(:)
    !> Group of the scene each zone's elements are of, and its four sets of sides (0: none).
    integer, allocatable :: group(:), sets(:, :)
    !> Open chains that sides between materials follow, from one corner to the next or back.
    type(chain_t), allocatable :: paths(:)
  end type plan_t

  type :: side_t
    !> Corners, in the direction of the first zone.
    integer :: points(2) = 0
    integer :: form = as_found
    integer :: chain = 0             !! that it follows, else 0
    integer :: path = 0              !! along an interface, else 0
    real(wp) :: middle(2) = 0.0_wp
    !> Zones on its left and on its right, 0 where there is none, and which of their sides it is.
    integer :: zones(2) = 0, local(2) = 0
    !> Smoothing may move it.
    logical :: moves = .false.
  end type side_t

  !> Zones, counter-clockwise, and all their sides.
  type :: layout_t
    type(zone_point_t), allocatable :: points(:)
    type(zone_t), allocatable :: zones(:)
    type(side_t), allocatable :: sides(:)
    integer, allocatable :: zone_sides(:, :)   !! (4, nzone)
    logical, allocatable :: point_moves(:)     !! (npoint)
    type(chain_t), allocatable :: paths(:)
  end type layout_t

  !> Lengths along a chain that differ by less are one; zones that small against the square of their extent have no area.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> Find the sides, and refuse zones that do not fill the part.
  pure subroutine lay_out(chains, points, zones, layout, error, paths)
    type(chain_t), intent(in) :: chains(:)
    type(zone_point_t), intent(in) :: points(:)
    type(zone_t), intent(in) :: zones(:)
    type(layout_t), intent(out) :: layout
    type(error_t), allocatable, intent(out) :: error
    type(chain_t), optional, intent(in) :: paths(:)   !! of sides along interfaces
    integer :: z

    if (present(paths)) allocate (layout%paths, source=paths)
    allocate (layout%points, source=points)
    allocate (layout%zones, source=zones)
    do z = 1, size(zones)
      call check_corners(chains, points, zones(z), z, error)
      if (allocated(error)) return
      call turn_left(chains, points, z, layout%zones(z), error)
      if (allocated(error)) return
    end do
    call find_sides(layout, error)
    if (.not. allocated(error)) call follow_chains(chains, layout, error)
    if (.not. allocated(error)) call find_what_moves(layout)
  end subroutine lay_out

  !> Coordinates of a zone point [length].
  pure function coordinates_of(chains, point) result(x)
    type(chain_t), intent(in) :: chains(:)
    type(zone_point_t), intent(in) :: point
    real(wp) :: x(2)

    x = point%x
    if (point%chain > 0) x = on_chain(chains(point%chain), point%place)
  end function coordinates_of

  !> Point of a chain; a stretch along X or Y keeps its other coordinate to the last bit, as axes and symmetry lines must.
  pure function on_chain(chain, place) result(x)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: place
    real(wp) :: x(2)

    x = exact_point(chain%stretches(place%stretch), place%xi)
  end function on_chain

  pure function exact_point(stretch, xi) result(x)
    type(stretch_t), intent(in) :: stretch
    real(wp), intent(in) :: xi
    real(wp) :: x(2)
    integer :: i

    x = point_at(stretch, xi)
    if (any(abs(stretch%depth) > 0)) return
    do i = 1, 2
      if (maxval(stretch%points(i, :)) > minval(stretch%points(i, :))) cycle
      x(i) = stretch%points(i, 1)
    end do
  end function exact_point

  !> Arc lengths at which a side along a chain begins and ends [length]; the end may lie past the start of the chain.
  pure function arc_along(chains, layout, side) result(arc)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(side_t), intent(in) :: side
    real(wp) :: arc(2)

    associate (chain => chains(side%chain))
      arc(1) = arc_at(chain, layout%points(side%points(1))%place)
      arc(2) = arc_at(chain, layout%points(side%points(2))%place)
      if (.not. arc(2) - arc(1) > same*chain_length(chain)) arc(2) = arc(2) + chain_length(chain)
    end associate
  end function arc_along

  pure subroutine check_corners(chains, points, zone, number, error)
    type(chain_t), intent(in) :: chains(:)
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
      if (points(zone%corners(k))%chain > size(chains)) then
        call fail(error, exit_input, 'zone point '//name_of_point(points, zone%corners(k))//' is on a contour that does not exist')
        return
      end if
    end do
  end subroutine check_corners

  !> Bring the corners into counter-clockwise order, from the same first one.
  pure subroutine turn_left(chains, points, number, zone, error)
    type(chain_t), intent(in) :: chains(:)
    type(zone_point_t), intent(in) :: points(:)
    integer, intent(in) :: number
    type(zone_t), intent(inout) :: zone
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: x(2, 4), area
    integer :: k

    do k = 1, 4
      x(:, k) = coordinates_of(chains, points(zone%corners(k)))
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
  end subroutine turn_left

  !> Sides by their corners, in the order in which zones name them first.
  pure subroutine find_sides(layout, error)
    type(layout_t), intent(inout) :: layout
    type(error_t), allocatable, intent(out) :: error
    type(side_t) :: list(4*size(layout%zones))
    integer :: latest(size(layout%points)), before(4*size(layout%zones))
    integer :: z, k, s, n, ends(2)

    allocate (layout%zone_sides(4, size(layout%zones)))
    ! sides that have the same lower point hang on one thread, so that the search costs what a point has of sides
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
                    //name_of_zone(layout%zones(z), z)//' lie on the same hand of ' &
                    //side_name(layout%points, list(s))//', expected one on either hand')
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

  !> The sides that follow chains, and whether all of every chain is followed once.
  pure subroutine follow_chains(chains, layout, error)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(inout) :: layout
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: followed(size(chains)), arc(2)
    integer :: s, c

    followed = 0
    do s = 1, size(layout%sides)
      associate (side => layout%sides(s))
        side%moves = side%form == as_found .and. side%zones(2) > 0
        if (side%form == as_found) side%form = merge(follows_contour, runs_straight, side%zones(2) == 0)
        if (side%zones(2) > 0 .neqv. side%form /= follows_contour) then
          call fail(error, exit_input, side_name(layout%points, side)//' is said to follow the contour where two zones share it,' &
                    //' or not to where one zone has it')
          return
        end if
        if (side%form /= follows_contour) cycle
        c = layout%points(side%points(1))%chain
        if (c == 0 .or. layout%points(side%points(2))%chain /= c) then
          call fail(error, exit_input, side_name(layout%points, side)//' of ' &
                    //name_of_zone(layout%zones(side%zones(1)), side%zones(1)) &
                    //' has no second zone and not both ends on one contour')
          return
        end if
        side%chain = c
        arc = arc_along(chains, layout, side)
        followed(c) = followed(c) + arc(2) - arc(1)
      end associate
    end do
    do c = 1, size(chains)
      if (abs(followed(c) - chain_length(chains(c))) <= same*size(layout%sides)*chain_length(chains(c))) cycle
      call fail(error, exit_input, 'sides of zones follow '//to_text(followed(c))//' of the length ' &
                //to_text(chain_length(chains(c)))//' of contour '//to_text(c)//', expected all of it once', &
                'a side from one corner to the next runs along the contour with the part on its left')
      return
    end do
  end subroutine follow_chains

  !> Sides move of which nothing was said, between zones of one material; points inside with all their sides. Where other than
  !> four sides meet in a point that stays, they stay with it: smoothed, they would close up on it.
  pure subroutine find_what_moves(layout)
    type(layout_t), intent(inout) :: layout
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
    layout%point_moves = layout%points%chain == 0 .and. .not. layout%points%stays
    do
      changed = .false.
      do s = 1, size(layout%sides)
        associate (side => layout%sides(s))
          if (side%moves) then
            side%moves = .not. any(layout%points(side%points)%chain == 0 .and. sides_at(side%points) /= 4 &
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
  end subroutine find_what_moves

  pure function side_name(points, side) result(name)
    type(zone_point_t), intent(in) :: points(:)
    type(side_t), intent(in) :: side
    character(len=:), allocatable :: name

    name = 'the side between zone points '//name_of_point(points, side%points(1))//' and '//name_of_point(points, side%points(2))
  end function side_name

  !> A point as the user knows it.
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

end module zones
